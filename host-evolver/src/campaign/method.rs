//! The ways to a model that a campaign can compare. Another is a variant of [`Method`] and its run.

use crate::evaluation::World;
use crate::evolve::eh_grn::{self, Progress, Structure};
use crate::evolve::{Advance, Knee, Search, Settings};
use crate::model::describe;
use crate::model::variation::MotifSet;
use grn_core::network::Network;
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
        /// Generations of DE that an individual gets, if not one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        de_generations: Option<usize>,
    },
    /// EH-GRN with CMA-ES.
    EhGrn {
        /// Which printed structure.
        structure: Structure,
    },
}

/// A model of a front.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The model.
    pub network: Network<f32>,
    /// f1.
    pub nodes: usize,
    /// f2.
    pub f2: f64,
    /// Constraint violation, 0 if feasible.
    pub violation: f64,
    /// Whether it is a knee of its front; the only member of a front is.
    pub knee: Knee,
}

impl Solution {
    /// Prefix notation with θ.
    pub fn expression(&self) -> String {
        describe::expression(&self.network)
    }
}

/// What a run leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The non-dominated models, fewest nodes first, at least one.
    pub front: Vec<Solution>,
    /// One entry a generation.
    pub history: Vec<Progress>,
}

impl Method {
    fn settings(motifs: MotifSet, de_generations: Option<usize>, evaluations: usize, seed: u64) -> Settings {
        let mut settings = Settings { seed, evaluations, motifs, ..Settings::default() };
        settings.de.generations = de_generations.unwrap_or(settings.de.generations);
        settings
    }

    /// Whether it can work with that budget; if not, what is wrong.
    pub(super) fn check(&self, evaluations: usize) -> Result<(), String> {
        match *self {
            Method::Mogp { motifs, de_generations } => {
                Method::settings(motifs, de_generations, evaluations, 1).check().map_err(|error| error.to_string())
            }
            Method::EhGrn { .. } if evaluations < eh_grn::POPULATION => {
                Err(format!("evaluations = {evaluations}: one generation takes {}", eh_grn::POPULATION))
            }
            Method::EhGrn { .. } => Ok(()),
        }
    }

    /// Runs it; `None` if it was stopped. The outcome depends on its arguments only.
    pub fn run(&self, world: &World, evaluations: usize, seed: u64, stop: &AtomicBool) -> Option<Outcome> {
        match *self {
            Method::Mogp { motifs, de_generations } => {
                mogp(world, Method::settings(motifs, de_generations, evaluations, seed), stop)
            }
            Method::EhGrn { structure } => baseline(world, structure, evaluations, seed, stop),
        }
    }
}

fn mogp(world: &World, settings: Settings, stop: &AtomicBool) -> Option<Outcome> {
    let steepness = settings.steepness;
    let mut search = Search::new(world, settings, None).ok()?;
    loop {
        match search.advance(stop, &|_| ()) {
            Advance::Generation => {}
            Advance::Finished => break,
            Advance::Interrupted => return None,
        }
    }
    let solution = |member: crate::evolve::FrontMember| {
        Some(Solution {
            network: member.individual.tree.network(steepness).ok()?,
            nodes: member.individual.tree.size(),
            f2: member.individual.f2,
            violation: member.individual.violation,
            knee: member.knee,
        })
    };
    let front = search.front().into_iter().map(solution).collect::<Option<_>>()?;
    let history = search.state().history.iter();
    let progress = history.map(|milestone| Progress {
        evaluations: milestone.evaluations,
        best_f2: milestone.best_f2,
        hypervolume: milestone.hypervolume,
    });
    Some(Outcome { front, history: progress.collect() })
}

fn baseline(world: &World, structure: Structure, evaluations: usize, seed: u64, stop: &AtomicBool) -> Option<Outcome> {
    let (tuned, history) = eh_grn::search(structure, world, evaluations, seed, stop)?;
    let front = vec![Solution {
        network: structure.network(&tuned.thetas)?,
        nodes: structure.nodes(),
        f2: tuned.evaluation.f2,
        violation: tuned.evaluation.violation,
        knee: Knee { angle: true, utility: true },
    }];
    Some(Outcome { front, history })
}
