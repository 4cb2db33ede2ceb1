//! What a campaign's folder answers for besides its units: tables and figures, and how many seeds they tell of.

use super::plan::Plan;
use crate::files::{self, Contents, FileError, Ledger, Owner};
use serde::{Deserialize, Serialize};
use std::path::Path;

const MANIFEST: &str = "manifest.json";

/// Folders in a campaign's folder.
pub(super) const BELOW: [&str; 4] = ["runs", "simulations", "trials", "typical"];

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Manifest {
    grn: String,
    campaign: String,
    seeds: u64,
    /// Whether all tables and figures are there.
    finished: bool,
    /// Tables and figures with the SHA-256 of each; of a campaign that is not finished, those that may be there.
    files: Ledger,
}

impl Manifest {
    /// The manifest of a folder that is to hold a campaign: of what is there of it, or a new one. It is written.
    ///
    /// # Errors
    /// A folder with other things, of another version or of a campaign with more seeds.
    pub(super) fn begin(plan: &Plan, folder: &Path) -> Result<Manifest, FileError> {
        let path = folder.join(MANIFEST);
        let new = |files| Manifest {
            grn: files::VERSION.into(),
            campaign: plan.name.clone(),
            seeds: plan.seeds,
            finished: false,
            files,
        };
        if files::owner(folder) == Some(Owner::Run) {
            let fault =
                "is the folder of a run of grn evolve, and this is a campaign; choose another folder with --out";
            return Err(FileError::new(folder, fault));
        }
        let manifest = if path.exists() {
            let found = read(&path)?;
            if found.seeds > plan.seeds {
                let (there, now) = (found.seeds, plan.seeds);
                let fault = format!(
                    "seeds is {there} there and {now} now: a campaign can be extended, not shortened; write seeds = {there} or \
                     more, or choose another folder with --out and take the runs over with --merge"
                );
                return Err(FileError::new(path, fault));
            }
            new(found.files)
        } else {
            if let Some(name) = files::first_foreign(folder, &|name| BELOW.contains(&name))? {
                let fault = format!("holds other things ({name}); choose an empty or new folder with --out");
                return Err(FileError::new(folder, fault));
            }
            new(Ledger::default())
        };
        files::write(&path, files::json(&manifest))?;
        Ok(manifest)
    }

    /// Brings the folder to hold these tables and figures and none of another campaign that was there before.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(super) fn publish(&self, folder: &Path, contents: &Contents) -> Result<(), FileError> {
        let write = |files: &Ledger, finished: bool| {
            let manifest = Manifest { files: files.clone(), finished, ..self.clone() };
            files::write(&folder.join(MANIFEST), files::json(&manifest))
        };
        self.files.publish(folder, contents, write).map(drop)
    }

    /// Refuses a folder whose tables and figures are not all there as they were written.
    ///
    /// # Errors
    /// No campaign, one that is not finished, or a file that was changed.
    pub(super) fn check_finished(folder: &Path) -> Result<(), FileError> {
        let path = folder.join(MANIFEST);
        let found = read(&path)?;
        if !found.finished {
            return Err(FileError::new(path, "this campaign is not finished; run it to its end"));
        }
        match found.files.first_damaged(folder) {
            Some(name) => Err(FileError::new(folder.join(name), "missing or changed; run the campaign again")),
            None => Ok(()),
        }
    }
}

/// Without it nobody knows which tables and figures are ours, so the folder is left to the user; its runs are still good.
fn read(path: &Path) -> Result<Manifest, FileError> {
    let manifest = files::check_version(path).and_then(|()| files::read_json(path));
    manifest.map_err(|error| {
        if error.is_damage() {
            FileError::damaged(path, "choose another folder with --out and take the runs over with --merge")
        } else {
            error
        }
    })
}
