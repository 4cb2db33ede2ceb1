//! The knees of a campaign's runs in simulated laboratories.

use super::part;
use super::plan::{Plan, slug};
use super::simulate::Simulate;
use super::unit::Unit;
use crate::files::{self, FileError, read_blob};
use crate::realities::{self, Reality};
use crate::simulation::SimulationError;
use firmware_sim::lab;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

pub const FOLDER: &str = "simulations";

/// A knee and where it is simulated.
pub struct Knee<'p> {
    /// The run that it is of.
    pub unit: Unit,
    scenario: &'p Scenario,
    simulate: &'p Simulate,
    blob: Blob,
    folder: PathBuf,
}

impl<'p> Knee<'p> {
    /// The knees of all runs, if they are to be simulated.
    ///
    /// # Errors
    /// A damaged run, or a knee that no blob of the scale holds.
    pub fn all(plan: &'p Plan, campaign: &Path) -> Result<Vec<Knee<'p>>, FileError> {
        let Some(simulate) = &plan.simulate else { return Ok(Vec::new()) };
        let knee = |unit: Unit| {
            let path = campaign.join(unit.folder(plan)).join("knee.grn");
            let blob = Blob { scale: simulate.scale, ..read_blob(&path)? };
            files::blob_bytes(&blob).map_err(|error| FileError::new(&path, error))?;
            let scenario = &plan.scenarios[unit.scenario].scenario;
            let method = slug(&plan.methods[unit.method].name);
            let folder = Path::new(FOLDER).join(slug(scenario.name())).join(method);
            Ok(Knee { unit, scenario, simulate, blob, folder })
        };
        Unit::all(plan).into_iter().map(knee).collect()
    }

    /// The realities of the knee, none if it cannot drive a robot: read if they were simulated before and the file is whole,
    /// else simulated; `notice` hears of damage. `None` if stopped.
    ///
    /// # Errors
    /// A file that cannot be read or written, or a swarm that cannot be set up.
    pub fn realities(
        &self,
        campaign: &Path,
        stop: &AtomicBool,
        notice: &dyn Fn(&str),
    ) -> Result<Option<Vec<Reality>>, FileError> {
        let path = campaign.join(self.path());
        part::read_or_make(&path, &self.origin(), notice, || {
            let &Knee { scenario, simulate, ref blob, .. } = self;
            let numbers = 1..=simulate.realities;
            match realities::try_all(blob, scenario, &simulate.config(), simulate.number, numbers, stop, &|| ()) {
                Ok(robustness) => Ok(robustness.map(|robustness| files::csv_records(&robustness.realities))),
                // Some runs find nothing that drives a robot: that is a result, too.
                Err(SimulationError::Load(_) | SimulationError::NoPattern(_)) => Ok(Some(Vec::new())),
                Err(error) => Err(FileError::new(&path, error)),
            }
        })
    }

    /// What the simulations are made from.
    fn origin(&self) -> String {
        let Simulate { lab, realities, seed, scale, speed_m_per_s, number } = self.simulate;
        let identity: String = self.blob.identity().iter().map(|byte| format!("{byte:02x}")).collect();
        let run = format!("{} {identity} {realities} {seed} {scale} {speed_m_per_s} {number}\n", files::VERSION);
        [run, self.scenario.to_toml(), lab::write(lab)].concat()
    }

    /// Their file.
    pub fn path(&self) -> PathBuf {
        self.folder.join(part::name(self.unit.seed, &self.origin()))
    }
}
