//! The folder of an evolution run: manifest, checkpoint, results.
//!
//! Everything in it is written whole or not at all and depends only on scenario and settings, so an interrupted and
//! resumed run leaves the same bytes as one left alone.

use crate::evaluation::{Model, World};
use crate::evolve::{Search, Settings, State, deployed};
use crate::figures;
use crate::files::{self, FileError};
use crate::model::deploy;
use crate::model::describe;
use crate::results;
use firmware_sim::scenario::Scenario;
use grn_core::blob::{Blob, FORMAT_VERSION};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};

const MANIFEST: &str = "manifest.json";
const CHECKPOINT: &str = "checkpoint.json";

/// What a run was made from; equal manifests give equal results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Version of this software.
    pub grn: String,
    /// Blob format version.
    pub blob_format: u8,
    /// Name of the scenario.
    pub scenario: String,
    /// SHA-256 of the scenario's canonical text, hexadecimal; the text lies beside the manifest.
    pub scenario_sha256: String,
    /// Settings of the search, seed included.
    pub settings: Settings,
    /// World metres per model metre of the blobs.
    pub scale: f32,
}

impl Manifest {
    /// The manifest of a run by this software.
    pub fn new(scenario: &Scenario, settings: Settings, scale: f32) -> Self {
        Manifest {
            grn: env!("CARGO_PKG_VERSION").into(),
            blob_format: FORMAT_VERSION,
            scenario: scenario.name().into(),
            scenario_sha256: files::sha256(scenario.to_toml()),
            settings,
            scale,
        }
    }
}

/// Why a run folder cannot be used or filled.
#[derive(Debug)]
pub enum RunError {
    /// A file in it.
    File(FileError),
    /// A picture could not be drawn.
    Figure(&'static str, grn_figures::FigureError),
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RunError::File(error) => error.fmt(f),
            RunError::Figure(name, error) => write!(f, "{name} cannot be drawn: {error}"),
        }
    }
}

impl std::error::Error for RunError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            RunError::File(error) => error.source(),
            RunError::Figure(..) => None,
        }
    }
}

impl From<FileError> for RunError {
    fn from(error: FileError) -> Self {
        RunError::File(error)
    }
}

/// The folder of one run.
pub struct RunFolder {
    folder: PathBuf,
}

impl RunFolder {
    /// Begins a run in a new or empty folder.
    ///
    /// # Errors
    /// A folder that holds a run already, or cannot be written.
    pub fn create(folder: &Path, manifest: &Manifest, scenario: &Scenario) -> Result<Self, RunError> {
        let run = RunFolder { folder: folder.to_owned() };
        let path = run.path(MANIFEST);
        if path.exists() {
            let way_out = "a run is here already; continue it with --resume, or choose another folder with --out";
            return Err(FileError::new(path, way_out).into());
        }
        files::write(&run.path("scenario.toml"), scenario.to_toml())?;
        files::write(&path, files::json(manifest))?;
        Ok(run)
    }

    /// Continues a run, or begins it if the folder does not hold one yet; files that a killed process left half-written
    /// go. The state is `None` before the first checkpoint.
    ///
    /// # Errors
    /// A run made with another scenario, other settings or another version, or damaged files.
    pub fn resume(folder: &Path, manifest: &Manifest, scenario: &Scenario) -> Result<(Self, Option<State>), RunError> {
        let run = RunFolder { folder: folder.to_owned() };
        let path = run.path(MANIFEST);
        if !path.exists() {
            return Ok((RunFolder::create(folder, manifest, scenario)?, None));
        }
        let found: Manifest = files::read_json(&path)?;
        if let Some(difference) = files::difference(manifest, &found) {
            let way_out = "give the same settings to --resume, or choose another folder with --out";
            return Err(FileError::new(path, format!("not the same run: {difference}; {way_out}")).into());
        }
        files::remove_unfinished(folder)?;
        let checkpoint = run.path(CHECKPOINT);
        let state = if checkpoint.exists() { Some(files::read_json(&checkpoint)?) } else { None };
        Ok((run, state))
    }

    /// The path of something in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Saves the state after a generation.
    ///
    /// # Errors
    /// What the operating system says.
    pub fn save(&self, state: &State) -> Result<(), RunError> {
        Ok(files::write(&self.path(CHECKPOINT), files::json(state))?)
    }

    /// Writes front, blobs and pictures; returns the blob of the knee that is deployed.
    ///
    /// # Errors
    /// A file that cannot be written or a picture that cannot be drawn.
    pub fn finish(&self, search: &Search<'_>, world: &World, scale: f32) -> Result<Blob, RunError> {
        let front = search.front();
        let mut knee = None;
        let mut blobs = Vec::new();
        for (place, member) in front.iter().enumerate() {
            let blob = deploy::blob(member.network.clone(), &world.scenario().morphogen(), scale);
            let name = format!("front/{place:02}-{}-nodes.grn", member.nodes);
            files::write_blob(&self.path(&name), &blob)?;
            blobs.push(name);
            if place == deployed(&front) {
                knee = Some(blob);
            }
        }
        results::write_front(&self.folder, &search.settings().objectives, &front, &blobs)?;
        results::write_history(&self.folder, &search.state().history)?;
        let knee = knee.ok_or_else(|| FileError::new(self.path("front.csv"), "the front is empty"))?;
        files::write_blob(&self.path("knee.grn"), &knee)?;
        self.draw("pareto.svg", figures::pareto(&front, &search.others(), &world.scenario().ring()))?;
        self.draw("tree.svg", grn_figures::tree(&describe::syntax_tree(&knee.network)))?;
        self.draw("grn.svg", grn_figures::grn(&describe::graph(&knee.network)))?;
        if let Ok(model) = Model::new(&knee.network, world.scenario().morphogen().level) {
            self.draw("pattern.svg", figures::pattern(world, &model))?;
        }
        Ok(knee)
    }

    /// Writes a picture.
    ///
    /// # Errors
    /// A picture that could not be drawn or written.
    pub fn draw(&self, name: &'static str, figure: Result<String, grn_figures::FigureError>) -> Result<(), RunError> {
        let svg = figure.map_err(|error| RunError::Figure(name, error))?;
        Ok(files::write(&self.path(name), svg)?)
    }
}
