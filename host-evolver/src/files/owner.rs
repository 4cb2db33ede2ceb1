//! Whose folder it is: a run's or a campaign's, as its manifest tells.

use super::error::FileError;
use std::path::{Path, PathBuf};

/// Folders within those of runs and campaigns that hold their own files only.
const FILLED: [&str; 6] = ["front", "simulation", "simulations", "runs", "trials", "typical"];
/// How those of the worlds of a run in several begin.
const SIMULATION_OF_WORLD: &str = "simulation-";

/// What a folder holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// A run of `grn evolve`.
    Run,
    /// A campaign.
    Campaign,
}

impl Owner {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Owner::Run => "a run of grn evolve",
            Owner::Campaign => "a campaign",
        }
    }
}

/// Whose the folder is; `None` if it has no manifest of ours, or one too damaged to tell.
pub fn owner(folder: &Path) -> Option<Owner> {
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("manifest.json")).ok()?).ok()?;
    manifest.get("grn")?;
    if manifest.get("campaign").is_some() {
        return Some(Owner::Campaign);
    }
    manifest.get("scenarios").map(|_| Owner::Run)
}

/// Refuses a folder that a run or a campaign further up fills with its own files.
pub(super) fn check_place(folder: &Path) -> Result<(), FileError> {
    let Some(place) = resolved(folder) else { return Ok(()) };
    for above in place.ancestors().skip(1) {
        let Some(first) = place.strip_prefix(above).ok().and_then(|below| below.components().next()) else { continue };
        let name = first.as_os_str().to_string_lossy();
        let filled = (FILLED.contains(&&*name) || name.starts_with(SIMULATION_OF_WORLD)).then_some(name);
        if let Some((name, owner)) = filled.zip(owner(above)) {
            let (above, owner) = (above.display(), owner.words());
            let fault = format!("{name} in {above} is filled by {owner}; choose a folder elsewhere with --out");
            return Err(FileError::new(folder, fault));
        }
    }
    Ok(())
}

/// The path without links and `..`, of a folder that need not be there yet.
fn resolved(folder: &Path) -> Option<PathBuf> {
    let whole = std::path::absolute(folder).ok()?;
    let existing = whole.ancestors().find_map(|above| Some((above, above.canonicalize().ok()?)));
    let (above, canonical) = existing?;
    Some(canonical.join(whole.strip_prefix(above).ok()?))
}
