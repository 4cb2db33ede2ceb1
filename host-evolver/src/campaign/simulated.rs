//! The knees of a campaign's runs in simulated laboratories.

use super::job::{Job, Product};
use super::part::{self, Part};
use super::plan::{Place, Plan, slug};
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
    /// Where the world stands in the plan.
    pub place: Place,
    world: &'p Scenario,
    simulate: &'p Simulate,
    /// Whether robots follow the rules of its method instead.
    follows_rules: bool,
    blob: Blob,
    /// The same as bytes.
    bytes: Vec<u8>,
    folder: PathBuf,
}

impl<'p> Knee<'p> {
    /// The knees of all runs, if they are to be simulated, each in all worlds that it is simulated in.
    ///
    /// # Errors
    /// A damaged run, or a knee that no blob of the scale holds.
    pub fn all(plan: &'p Plan, campaign: &Path) -> Result<Vec<Knee<'p>>, FileError> {
        let Some(simulate) = &plan.simulate else { return Ok(Vec::new()) };
        let mut knees = Vec::new();
        for unit in Unit::all(plan) {
            let path = campaign.join(unit.folder(plan)).join("knee.grn");
            let blob = Blob { scale: simulate.scale, ..read_blob(&path)? };
            let bytes = files::blob_bytes(&blob).map_err(|error| FileError::new(&path, error))?;
            knees.extend(plan.simulated_in(unit.scenario).into_iter().map(|place| Knee {
                unit,
                place,
                world: plan.world(place),
                simulate,
                follows_rules: plan.methods[unit.method].method.follows_rules(),
                blob: blob.clone(),
                bytes: bytes.clone(),
                folder: Self::folder(plan, unit, place),
            }));
        }
        Ok(knees)
    }

    /// The folder, within the campaign's, of what is simulated with the knees of a run's scenario and method in a world. The only
    /// training world needs none of its own.
    pub fn folder(plan: &Plan, unit: Unit, place: Place) -> PathBuf {
        let planned = &plan.scenarios[unit.scenario];
        let folder = Path::new(Self::FOLDER).join(slug(&planned.name)).join(slug(&plan.methods[unit.method].name));
        match place {
            Place::Scenario(..) if planned.worlds.len() == 1 => folder,
            _ => folder.join(slug(plan.world(place).name())),
        }
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
        let rules = if self.follows_rules { "by rules\n" } else { "" };
        [run, rules.into(), self.world.to_toml(), lab::write(lab)].concat()
    }

    fn worth(&self) -> u64 {
        self.simulate.worth()
    }

    fn job(&self) -> Job {
        Job::Simulations { world: self.place, method: self.unit.method, knee: self.bytes.clone() }
    }

    fn csv(&self, product: Product) -> Option<Vec<u8>> {
        match product {
            Product::Simulations(csv) => Some(csv),
            _ => None,
        }
    }
}
