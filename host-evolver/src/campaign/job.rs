//! What a campaign computes, apart from where: a job goes to whoever makes it, and its product comes back.

use super::method::{Method, Outcome};
use super::plan::{Place, Plan};
use super::unit::Unit;
use crate::baselines::rule_ring;
use crate::evaluation::{Evaluation, Evaluator, Model, World};
use crate::evolve::{FrontMember, Task, TaskError};
use crate::files::{self, Contents, FileError};
use crate::model::deploy::{self, DEFAULT_SCALE};
use crate::realities;
use crate::results;
use crate::simulation::SimulationError;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is to be made, with all that it depends on besides the plan.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Job {
    /// A run.
    Run(Unit),
    /// Models, given as blobs, tried in a world.
    Trials {
        /// The world.
        world: Place,
        /// The models.
        models: Vec<Vec<u8>>,
    },
    /// The realities of a knee.
    Simulations {
        /// The world.
        world: Place,
        /// The place of the method that has found it.
        method: usize,
        /// Its blob.
        knee: Vec<u8>,
    },
}

/// What a job leaves.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Product {
    /// The files of a run, without its manifest.
    Run(Contents),
    /// f2 and violation of each model.
    Trials(Vec<(f64, f64)>),
    /// The realities as CSV; nothing if the knee cannot drive a robot.
    Simulations(Vec<u8>),
}

/// Why a job cannot be made. What it is about is known to who wants it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Refusal {
    fault: String,
    is_internal: bool,
}

impl Refusal {
    /// As the fault of a file that was to be made.
    pub fn about(self, path: &Path) -> FileError {
        match self {
            Refusal { fault, is_internal: true } => FileError::internal(path, fault),
            Refusal { fault, is_internal: false } => FileError::new(path, fault),
        }
    }

    /// A product of another job than was asked for, or the like.
    pub fn internal(fault: impl std::fmt::Display) -> Refusal {
        Refusal { fault: fault.to_string(), is_internal: true }
    }
}

impl From<FileError> for Refusal {
    fn from(error: FileError) -> Refusal {
        Refusal { fault: error.to_string(), is_internal: error.is_internal() }
    }
}

/// Makes a plan's jobs, on the threads of the pool that it is called in.
pub struct Maker<'p> {
    plan: &'p Plan,
    /// What runs in each scenario are for; many runs share one.
    tasks: Vec<OnceLock<Result<Task, TaskError>>>,
}

impl<'p> Maker<'p> {
    /// Makes jobs of this plan.
    pub fn new(plan: &'p Plan) -> Maker<'p> {
        Maker { plan, tasks: plan.scenarios.iter().map(|_| OnceLock::new()).collect() }
    }

    /// Makes a job; `None` if `stop` was set. The product depends on plan and job only.
    ///
    /// # Errors
    /// Why it cannot be made.
    pub fn make(&self, job: &Job, stop: &AtomicBool) -> Result<Option<Product>, Refusal> {
        match job {
            &Job::Run(unit) => Ok(self.run(unit, stop)?.map(Product::Run)),
            Job::Trials { world, models } => Ok(trials(self.plan.world(*world), models, stop)?.map(Product::Trials)),
            Job::Simulations { world, method, knee } => {
                let method = &self.plan.methods[*method].method;
                Ok(self.simulations(self.plan.world(*world), method, knee, stop)?.map(Product::Simulations))
            }
        }
    }

    fn run(&self, unit: Unit, stop: &AtomicBool) -> Result<Option<Contents>, Refusal> {
        let planned = &self.plan.scenarios[unit.scenario];
        let task = self.tasks[unit.scenario].get_or_init(|| self.plan.task(unit.scenario));
        let task = task.as_ref().map_err(Refusal::internal)?;
        let method = &self.plan.methods[unit.method].method;
        let Some(Outcome { front, history }) = method.run(task, planned.evaluations, unit.seed, stop) else {
            return Ok(None);
        };
        let morphogen = planned.worlds[0].morphogen();
        let blob_of = |member: &FrontMember| deploy::blob(member.network.clone(), &morphogen, DEFAULT_SCALE);
        let (contents, _) = results::contents(&method.objectives(), &front, &history, blob_of, "")?;
        Ok(Some(contents))
    }

    fn simulations(
        &self,
        scenario: &Scenario,
        method: &Method,
        knee: &[u8],
        stop: &AtomicBool,
    ) -> Result<Option<Vec<u8>>, Refusal> {
        let blob = Blob::decode(knee).map_err(Refusal::internal)?;
        let Some(simulate) = &self.plan.simulate else { return Err(Refusal::internal("nothing is simulated")) };
        let (config, numbers) = (scenario.configured(simulate.config()), 1..=simulate.realities);
        let tried = if method.follows_rules() {
            rule_ring::try_all(scenario, &config, numbers, stop)
        } else {
            realities::try_all(&blob, scenario, &config, simulate.number, numbers, stop, &|| ())
        };
        match tried {
            Ok(robustness) => Ok(robustness.map(|robustness| files::csv_records(&robustness.realities))),
            // Some runs find nothing that drives a robot: that is a result, too.
            Err(SimulationError::Load(_) | SimulationError::NoPattern(_)) => Ok(Some(Vec::new())),
            Err(error) => Err(Refusal { fault: error.to_string(), is_internal: false }),
        }
    }
}

fn trials(scenario: &Scenario, models: &[Vec<u8>], stop: &AtomicBool) -> Result<Option<Vec<(f64, f64)>>, Refusal> {
    let world = World::new(scenario.clone());
    let mut evaluator = Evaluator::new(&world);
    let mut evaluations = Vec::new();
    for bytes in models {
        if stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let blob: Blob = Blob::decode(bytes).map_err(Refusal::internal)?;
        let model = Model::new(&blob.network, scenario.morphogen().level).ok();
        let Evaluation { f2, violation } = model.map_or(Evaluation::NO_PATTERN, |model| evaluator.evaluate(&model));
        evaluations.push((f2, violation));
    }
    Ok(Some(evaluations))
}
