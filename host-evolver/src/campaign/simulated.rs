//! The knees of a campaign's runs in simulated laboratories.

use super::job::{Job, Product};
use super::part::{self, Part};
use super::plan::{Plan, slug};
use super::simulate::Simulate;
use super::unit::Unit;
use crate::files::{self, FileError, read_blob};
use crate::realities::Reality;
use firmware_sim::lab;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use std::path::{Path, PathBuf};

/// A knee and where it is simulated.
pub struct Knee<'p> {
    /// The run that it is of.
    pub unit: Unit,
    scenario: &'p Scenario,
    simulate: &'p Simulate,
    blob: Blob,
    /// The same as bytes.
    bytes: Vec<u8>,
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
            let bytes = files::blob_bytes(&blob).map_err(|error| FileError::new(&path, error))?;
            let scenario = &plan.scenarios[unit.scenario].scenario;
            let method = slug(&plan.methods[unit.method].name);
            let folder = Path::new(Self::FOLDER).join(slug(scenario.name())).join(method);
            Ok(Knee { unit, scenario, simulate, blob, bytes, folder })
        };
        Unit::all(plan).into_iter().map(knee).collect()
    }
}

/// The realities of a knee; none if it cannot drive a robot.
impl Part for Knee<'_> {
    type Record = Reality;
    const FOLDER: &'static str = "simulations";

    fn path(&self) -> PathBuf {
        self.folder.join(part::name(self.unit.seed, &self.origin()))
    }

    fn origin(&self) -> String {
        let Simulate { lab, realities, seed, scale, speed_m_per_s, number } = self.simulate;
        let identity: String = self.blob.identity().iter().map(|byte| format!("{byte:02x}")).collect();
        let run = format!("{} {identity} {realities} {seed} {scale} {speed_m_per_s} {number}\n", files::VERSION);
        [run, self.scenario.to_toml(), lab::write(lab)].concat()
    }

    fn worth(&self) -> u64 {
        self.simulate.worth()
    }

    fn job(&self) -> Job {
        Job::Simulations { scenario: self.unit.scenario, knee: self.bytes.clone() }
    }

    fn csv(&self, product: Product) -> Option<Vec<u8>> {
        match product {
            Product::Simulations(csv) => Some(csv),
            _ => None,
        }
    }
}
