//! What a run was made from, and which files it has left.

use crate::evolve::{Settings, Task};
use crate::files::{self, FileError, Ledger, Owner};
use firmware_sim::lab::Laboratory;
use firmware_sim::scenario::Scenario;
use grn_core::blob::FORMAT_VERSION;
use serde::{Deserialize, Serialize};
use std::path::Path;

pub(super) const MANIFEST: &str = "manifest.json";

/// A world that a run evolves for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Its name.
    pub name: String,
    /// SHA-256 of its canonical text, hexadecimal; the text lies beside the manifest.
    pub sha256: String,
}

/// What a run was made from; equal ones give equal results. And the files that it has left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Version of this software.
    pub grn: String,
    /// Blob format version.
    pub blob_format: u8,
    /// The worlds that it evolves for, in order.
    pub scenarios: Vec<Origin>,
    /// Settings of the search, seed included.
    pub settings: Settings,
    /// World metres per model metre of the blobs.
    pub scale: f32,
    /// The laboratory in which models are tried and the knee is simulated, whole.
    pub laboratory: Laboratory,
    /// Whether all files are there.
    pub finished: bool,
    /// The files with the SHA-256 of each; of a run that is not finished, those that it may have written.
    pub files: Ledger,
}

impl Manifest {
    /// The manifest of a run by this software, at its beginning.
    pub fn new(task: &Task, settings: Settings) -> Self {
        let origin =
            |scenario: &Scenario| Origin { name: scenario.name().into(), sha256: files::sha256(scenario.to_toml()) };
        Manifest {
            grn: files::VERSION.into(),
            blob_format: FORMAT_VERSION,
            scenarios: task.scenarios().map(origin).collect(),
            settings,
            scale: task.scale(),
            laboratory: task.swarm().lab.clone(),
            finished: false,
            files: Ledger::default(),
        }
    }

    /// What is the same for every length of the run and however far it has come: whose checkpoints fit.
    pub(super) fn identity(&self) -> String {
        let mut settings = self.settings.clone();
        settings.evaluations = 0;
        files::json(&Manifest { settings, finished: false, files: Ledger::default(), ..self.clone() })
    }

    /// The manifest in a run's folder, if that can become the run of this one: it is the same, or a shorter one.
    ///
    /// # Errors
    /// A damaged manifest, or the difference by name with both values.
    pub(super) fn matching(&self, folder: &Path) -> Result<Manifest, FileError> {
        let path = folder.join(MANIFEST);
        if files::owner(folder) == Some(Owner::Campaign) {
            let fault =
                "is the folder of a campaign, and this is a run of grn evolve; choose another folder with --out";
            return Err(FileError::new(folder, fault));
        }
        files::check_version(&path)?;
        let found: Manifest = files::read_json(&path)?;
        let mut ours = Manifest { finished: found.finished, files: found.files.clone(), ..self.clone() };
        ours.settings.evaluations = found.settings.evaluations;
        if let Some(difference) = files::difference(&ours, &found) {
            let way_out = "give the same settings to --resume, or choose another folder with --out";
            return Err(FileError::new(path, format!("not the same run: {difference}; {way_out}")));
        }
        let (budget, asked) = (found.settings.evaluations, self.settings.evaluations);
        if budget > asked {
            return Err(FileError::new(
                path,
                format!(
                    "settings.evaluations is {budget} there and {asked} now: a run can be extended, not shortened; give \
                     --evaluations {budget} or more to --resume, or choose another folder with --out"
                ),
            ));
        }
        Ok(found)
    }
}
