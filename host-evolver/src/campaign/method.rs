//! The ways to a model that a campaign can compare. Another is a variant of [`Method`] and its run.

use crate::evaluation::World;
use crate::evolve::eh_grn::{self, Structure};
use crate::evolve::{Advance, FrontMember, Milestone, Objectives, Search, Settings, Task};
use crate::model::variation::MotifSet;
use grn_optimisers::knee::Knee;
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;

/// An algorithm with what it leaves open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "algorithm", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Method {
    /// MOGP-NSGA-II with DE, the paper's Algorithm 1.
    Mogp {
        /// Motifs to build with.
        motifs: MotifSet,
        /// Generations of DE for each individual; one if not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        de_generations: Option<usize>,
        /// What is minimised; nodes and f2 if not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        objectives: Option<Objectives>,
    },
    /// EH-GRN with CMA-ES.
    EhGrn {
        /// Which printed structure.
        structure: Structure,
    },
}

/// What a run leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The non-dominated models, fewest nodes first, at least one.
    pub front: Vec<FrontMember>,
    /// One entry a generation.
    pub history: Vec<Milestone>,
}

impl Method {
    /// The settings of a search, if it is one.
    fn settings(&self, evaluations: usize, seed: u64) -> Option<Settings> {
        let Method::Mogp { motifs, de_generations, objectives } = self else { return None };
        let mut settings = Settings { seed, evaluations, motifs: *motifs, ..Settings::default() };
        settings.de.generations = de_generations.unwrap_or(settings.de.generations);
        settings.objectives = objectives.clone().unwrap_or(settings.objectives);
        Some(settings)
    }

    /// What its fronts are fronts of.
    pub fn objectives(&self) -> Objectives {
        match self {
            Method::Mogp { objectives: Some(objectives), .. } => objectives.clone(),
            Method::Mogp { objectives: None, .. } | Method::EhGrn { .. } => Objectives::paper(),
        }
    }

    /// The evaluations that its first generation takes.
    pub(super) fn least_evaluations(&self) -> usize {
        self.settings(0, 1).map_or(eh_grn::POPULATION, |settings| settings.least_evaluations())
    }

    /// Runs it; `None` if it was stopped. The outcome depends on its arguments only.
    pub fn run(&self, task: &Task, evaluations: usize, seed: u64, stop: &AtomicBool) -> Option<Outcome> {
        match self {
            Method::Mogp { .. } => mogp(task, self.settings(evaluations, seed)?, stop),
            Method::EhGrn { structure } => baseline(&task.worlds()[0], *structure, evaluations, seed, stop),
        }
    }
}

fn mogp(task: &Task, settings: Settings, stop: &AtomicBool) -> Option<Outcome> {
    let mut search = Search::new(task, settings, None).ok()?;
    loop {
        match search.advance(stop, &|_| ()) {
            Advance::Generation => {}
            Advance::Finished => break,
            Advance::Interrupted => return None,
        }
    }
    Some(Outcome { front: search.confirmed_front(stop)?, history: search.state().history.clone() })
}

fn baseline(world: &World, structure: Structure, evaluations: usize, seed: u64, stop: &AtomicBool) -> Option<Outcome> {
    let (tuned, history) = eh_grn::search(structure, world, evaluations, seed, stop)?;
    let front = vec![FrontMember {
        network: structure.network(&tuned.thetas)?,
        nodes: structure.nodes(),
        f2: tuned.evaluation.f2,
        further: Vec::new(),
        violation: tuned.evaluation.violation,
        knee: Knee { angle: true, utility: true, parsimony: false },
    }];
    Some(Outcome { front, history })
}
