//! The folder of an evolution run: manifest, checkpoint, results.
//!
//! Everything in it is written whole or not at all and depends only on scenario and settings, so an interrupted and
//! resumed run leaves the same bytes as one left alone, and an extended one those of a run that was as long from the start.

mod checkpoint;
mod manifest;

pub use manifest::Manifest;

use crate::evaluation::Model;
use crate::evolve::{FrontMember, Search, State, Task};
use crate::figures::{self, Pictures};
use crate::files::{self, Contents, FileError, FolderLock, Ledger, Owner};
use crate::model::deploy;
use crate::results;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use manifest::MANIFEST;
use std::path::{Path, PathBuf};

const CHECKPOINT: &str = "checkpoint.json";

/// What belongs to one of a run's worlds: `scenario.toml`, or of several `scenario-1.toml`, `scenario-2.toml`, ….
pub fn of_world(stem: &str, place: usize, worlds: usize, ending: &str) -> String {
    if worlds == 1 { format!("{stem}{ending}") } else { format!("{stem}-{}{ending}", place + 1) }
}

/// Folders in the folder of a run in so many worlds.
fn below(worlds: usize) -> Vec<String> {
    let simulations = (0..worlds).map(|place| of_world("simulation", place, worlds, ""));
    std::iter::once("front".to_owned()).chain(simulations).collect()
}

/// The folder of one run, which nobody else writes meanwhile.
pub struct RunFolder {
    lock: FolderLock,
    manifest: Manifest,
    /// What the user should hear.
    notices: Vec<String>,
}

/// What a search has found, ready to be written.
pub struct Results {
    /// Files by their path in the run's folder.
    pub contents: Contents,
    /// The blob of the knee that is deployed.
    pub knee: Blob,
    /// Pictures that cannot be drawn, and why.
    pub not_drawn: Vec<String>,
}

impl RunFolder {
    /// Begins a run in a new or empty folder; `command` is told to others who want it.
    ///
    /// # Errors
    /// A folder that holds a run or something else already, that somebody else writes, or that cannot be written.
    pub fn create(folder: &Path, command: &str, manifest: Manifest, task: &Task) -> Result<Self, FileError> {
        let lock = FolderLock::take(folder, command)?;
        let path = folder.join(MANIFEST);
        if path.exists() {
            let fault = match files::owner(folder) {
                Some(Owner::Campaign) => "this is the folder of a campaign; choose another folder with --out",
                _ => "a run is here already; continue it with --resume, or choose another folder with --out",
            };
            return Err(FileError::new(path, fault));
        }
        if let Some(name) = files::first_foreign(folder, &|_| false)? {
            let fault = format!("holds other things ({name}); choose an empty or new folder with --out");
            return Err(FileError::new(folder, fault));
        }
        let below = below(task.worlds().len());
        files::remove_unfinished(&lock, &below)?;
        let inside = below.iter().map(|folder| match folder.as_str() {
            "front" => PathBuf::from("front/00-31-nodes.grn"),
            simulation => Path::new(simulation).join("metrics.json"),
        });
        files::probe_folder(&lock, &inside.collect::<Vec<_>>())?;
        let run = RunFolder { lock, manifest, notices: Vec::new() };
        run.write_manifest(&run.manifest)?;
        run.write_scenarios(task)?;
        Ok(run)
    }

    /// Continues a run, perhaps with a larger budget; files that a killed process left half-written go. The state is `None`
    /// before the first checkpoint. A run that was killed before it could write anything begins anew.
    ///
    /// # Errors
    /// No run, one made with another scenario, other settings or another version, a longer one, damaged files, or a folder
    /// that somebody else writes.
    pub fn resume(
        folder: &Path,
        command: &str,
        manifest: Manifest,
        task: &Task,
    ) -> Result<(Self, Option<State>), FileError> {
        if !folder.join(MANIFEST).exists() {
            let is_leftover = folder.is_dir()
                && !files::entries(folder)?.is_empty()
                && files::first_foreign(folder, &|_| false)?.is_none();
            if is_leftover {
                return Ok((RunFolder::create(folder, command, manifest, task)?, None));
            }
            let way_out = "no run is here to go on with; mend --out, or leave out --resume to begin one";
            return Err(FileError::new(folder, way_out));
        }
        let lock = FolderLock::take(folder, command)?;
        let found = manifest.matching(folder)?;
        files::remove_unfinished(&lock, &below(task.worlds().len()))?;
        let path = folder.join(CHECKPOINT);
        let identity = found.identity();
        let state = match path.exists() {
            true => Some(checkpoint::load(&path, &identity, &found.settings)?),
            false => None,
        };
        let mut notices = Vec::new();
        if found.finished && state.is_none() {
            notices.push(format!("{} is missing: the search begins anew", path.display()));
        }
        if found.finished {
            let damaged = found.files.names().filter(|name| !found.files.holds(folder, name));
            let told = |name| format!("{} is missing or was changed: it is written anew", folder.join(name).display());
            notices.extend(damaged.map(told));
        }
        let run = RunFolder { lock, manifest: Manifest { files: found.files, ..manifest }, notices };
        run.write_manifest(&run.manifest)?;
        run.write_scenarios(task)?;
        // Whoever has changed nothing but the ends of its lines gets the same bytes as others.
        state.iter().try_for_each(|state| checkpoint::save(&path, &identity, state))?;
        Ok((run, state))
    }

    /// What the user should hear of the folder.
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// The path of something in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.lock.folder().join(name)
    }

    fn write_manifest(&self, manifest: &Manifest) -> Result<(), FileError> {
        files::write(&self.path(MANIFEST), files::json(manifest))
    }

    fn write_scenarios(&self, task: &Task) -> Result<(), FileError> {
        scenarios(task).iter().try_for_each(|(name, text)| files::write(&self.path(name), text))
    }

    /// Saves the state after a generation. Not that after a last one which the budget cuts short: from there the run could
    /// not be extended.
    ///
    /// # Errors
    /// What the operating system says.
    pub fn save(&self, state: &State) -> Result<(), FileError> {
        if !checkpoint::is_whole(state, &self.manifest.settings) {
            return Ok(());
        }
        checkpoint::save(&self.path(CHECKPOINT), &self.manifest.identity(), state)
    }

    /// Front, blobs and pictures of a search that is done.
    ///
    /// # Errors
    /// A model that no blob can hold.
    pub fn results(&self, search: &Search<'_>, front: &[FrontMember]) -> Result<Results, FileError> {
        let task = search.task();
        let first = task.worlds()[0].scenario();
        let blob_of = |member: &FrontMember| deploy::blob(member.network.clone(), &first.morphogen(), task.scale());
        let State { history, .. } = search.state();
        let (mut contents, knee) = results::contents(&search.settings().objectives, front, history, blob_of, "front/")?;
        contents.extend(scenarios(task).into_iter().map(|(name, text)| (name, text.into_bytes())));
        let mut pictures = Pictures::default();
        pictures
            .add("pareto.svg", figures::front(&search.settings().objectives, front, &search.others(), &first.ring()));
        pictures.add("tree.svg", Ok(figures::tree(&knee.network)));
        pictures.add("grn.svg", figures::grn(&knee.network));
        if let Ok(model) = Model::new(&knee.network, first.morphogen().level) {
            let worlds = task.worlds();
            for (place, world) in worlds.iter().enumerate() {
                let name = of_world("pattern", place, worlds.len(), ".svg");
                pictures.add(&name, figures::pattern(world, &model));
            }
        }
        contents.extend(pictures.contents);
        let not_drawn = pictures.not_drawn;
        Ok(Results { contents, knee, not_drawn })
    }

    /// Writes results to which others are to come.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn add(&mut self, contents: &Contents) -> Result<(), FileError> {
        let write = |files: &Ledger| self.write_manifest(&Manifest { files: files.clone(), ..self.manifest.clone() });
        self.manifest.files = self.manifest.files.add(self.lock.folder(), contents, write)?;
        Ok(())
    }

    /// Brings the folder to hold these results, all of them, and nothing of a shorter run.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn finish(&mut self, contents: &Contents) -> Result<(), FileError> {
        let write = |files: &Ledger, finished: bool| {
            self.write_manifest(&Manifest { files: files.clone(), finished, ..self.manifest.clone() })
        };
        self.manifest.files = self.manifest.files.publish(self.lock.folder(), contents, write)?;
        Ok(())
    }
}

/// The worlds' files and their canonical texts.
fn scenarios(task: &Task) -> Vec<(String, String)> {
    let count = task.worlds().len();
    let file =
        |(place, scenario): (usize, &Scenario)| (of_world("scenario", place, count, ".toml"), scenario.to_toml());
    task.scenarios().enumerate().map(file).collect()
}
