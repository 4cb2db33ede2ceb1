//! The baseline: an EH-GRN of fixed structure whose 13 θ are found by CMA-ES.

use super::front::front_hypervolume;
use super::state::Milestone;
use crate::evaluation::{Constraints, Evaluation, Evaluator, Model, World};
use crate::model::describe;
use crate::model::published::{PUBLISHED, Published};
use grn_core::network::{Network, THETA_RANGE};
use grn_optimisers::bounds::Bounds;
use grn_optimisers::cmaes::{self, Cmaes};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};

/// Samples in a generation of CMA-ES, as in the paper.
pub const POPULATION: usize = 40;
/// Initial step size: three tenths of the range of θ.
const SIGMA: f64 = 0.6;

/// One of the two printed structures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub enum Structure {
    /// That of task 1.
    Task1,
    /// That of task 2.
    Task2,
}

impl TryFrom<u8> for Structure {
    type Error = String;
    fn try_from(number: u8) -> Result<Self, String> {
        match number {
            1 => Ok(Structure::Task1),
            2 => Ok(Structure::Task2),
            _ => Err(format!("structure {number}: the paper prints 1 (of task 1) and 2 (of task 2)")),
        }
    }
}

impl From<Structure> for u8 {
    fn from(structure: Structure) -> u8 {
        match structure {
            Structure::Task1 => 1,
            Structure::Task2 => 2,
        }
    }
}

impl Structure {
    fn published(self) -> &'static Published {
        let name = format!("eh-grn-{}", u8::from(self));
        PUBLISHED.iter().find(|published| published.name == name).unwrap_or(&PUBLISHED[PUBLISHED.len() - 1])
    }

    /// The network with θ in the order of its genes; `None` for a wrong number of them, or one out of range.
    pub fn network(self, thetas: &[f64]) -> Option<Network<f32>> {
        (thetas.len() == self.published().gene_count()).then(|| self.published().with_thetas(thetas).ok()).flatten()
    }

    /// f1, counted as for a tree: genes and the inputs they read.
    pub fn nodes(self) -> usize {
        self.published().network().map_or(0, |network| describe::tree_size(&network))
    }
}

/// The best θ that a run has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuned {
    /// θ in the order of the genes.
    pub thetas: Vec<f64>,
    /// What the model is worth.
    pub evaluation: Evaluation,
}

/// Searches θ with a budget of `evaluations` for the least mean of f2 in `worlds`, at least one, whose morphogens are the same. CMA-ES starts at a random mean, and again at another whenever it has
/// nothing left to learn. Returns `None` if it was stopped.
///
/// CMA-ES learns from the better half of a generation only (no negative weights, as in the version that the paper
/// cites). So the worse half is evaluated only until it is sure to be worse.
pub fn search(
    structure: Structure,
    worlds: &[World],
    evaluations: usize,
    seed: u64,
    stop: &AtomicBool,
) -> Option<(Tuned, Vec<Milestone>)> {
    let (low, high) = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
    let dimension = structure.published().gene_count();
    let bounds = Bounds::cube(dimension, low, high).ok()?;
    let settings = cmaes::Settings::new(POPULATION, SIGMA, evaluations.max(1)).ok()?.passive();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut evaluator = Evaluator::among(worlds, Constraints::PAPER);
    let level = worlds.first()?.scenario().morphogen().level;
    let mut best: Option<Tuned> = None;
    let mut history = Vec::new();
    let mut spent = 0;
    let mut cma = Cmaes::new(&settings, &bounds, &bounds.sample(&mut rng)).ok()?;
    while spent < evaluations {
        if stop.load(Ordering::Relaxed) {
            return None;
        }
        if cma.stop().is_some() {
            cma = Cmaes::new(&settings, &bounds, &bounds.sample(&mut rng)).ok()?;
        }
        let mut population = cma.ask(&mut rng);
        population.truncate(evaluations - spent);
        let found = evaluate_all(structure, &mut evaluator, level, &population);
        spent += population.len();
        let order = cmaes::rank(&found, Evaluation::is_as_good_as);
        let champion = order[0];
        if best.as_ref().is_none_or(|best| !best.evaluation.is_as_good_as(&found[champion])) {
            best = Some(Tuned { thetas: population[champion].clone(), evaluation: found[champion] });
        }
        if order.len() == POPULATION {
            cma.tell(&order);
        }
        history.extend(best.as_ref().map(|best| milestone(structure.nodes(), spent, &best.evaluation)));
    }
    best.map(|best| (best, history))
}

/// The evaluation of each vector; only those of the better half are exact.
fn evaluate_all(
    structure: Structure,
    evaluator: &mut Evaluator<'_>,
    level: f64,
    population: &[Vec<f64>],
) -> Vec<Evaluation> {
    let model = |thetas: &Vec<f64>| structure.network(thetas).and_then(|network| Model::new(&network, level).ok());
    let models: Vec<Option<Model>> = population.iter().map(model).collect();
    evaluator.evaluate_best(&models, POPULATION / 2, None)
}

/// How far a search has come whose best model has so many nodes.
pub(crate) fn milestone(nodes: usize, evaluations: usize, best: &Evaluation) -> Milestone {
    let feasible = best.is_feasible().then_some(best.f2);
    let point = feasible.map(|f2| [nodes as f64, f2]);
    let count = usize::from(feasible.is_some());
    let hypervolume = front_hypervolume(point.into_iter());
    Milestone { evaluations, best_f2: feasible, best_cost: None, feasible: count, front: count, hypervolume }
}

#[cfg(test)]
mod tests {
    use super::*;
    use firmware_sim::scenario::Scenario;

    #[test]
    fn both_structures_have_nineteen_nodes() {
        assert_eq!([Structure::Task1, Structure::Task2].map(Structure::nodes), [19, 19]);
        assert!(Structure::try_from(3).is_err());
        assert!(Structure::Task1.network(&[0.5; 12]).is_none() && Structure::Task1.network(&[2.1; 13]).is_none());
    }

    #[test]
    fn a_search_is_repeatable_and_its_result_is_what_the_model_is_worth() {
        let worlds = [world("channel")];
        let run = |seed| search(Structure::Task2, &worlds, 410, seed, &AtomicBool::new(false)).unwrap();
        let (tuned, history) = run(1);
        assert_eq!((&tuned, &history), (&run(1).0, &run(1).1));
        assert_ne!(tuned.thetas, run(2).0.thetas);
        assert_eq!(history.last().unwrap().evaluations, 410);
        let model = Model::new(&Structure::Task2.network(&tuned.thetas).unwrap(), 0.5).unwrap();
        assert_eq!(Evaluator::new(&worlds[0]).evaluate(&model), tuned.evaluation);
        assert!(search(Structure::Task2, &worlds, 410, 1, &AtomicBool::new(true)).is_none());
    }

    #[test]
    fn in_several_worlds_the_mean_counts() {
        let worlds = [world("open"), world("channel")];
        let (tuned, _) = search(Structure::Task2, &worlds, 400, 1, &AtomicBool::new(false)).unwrap();
        let model = Model::new(&Structure::Task2.network(&tuned.thetas).unwrap(), 0.5).unwrap();
        let alone = worlds.each_ref().map(|world| Evaluator::new(world).evaluate(&model).f2);
        assert!(alone[0] != alone[1], "{alone:?}");
        assert!((tuned.evaluation.f2 - (alone[0] + alone[1]) / 2.0).abs() < 1e-12, "{alone:?} {tuned:?}");
    }

    fn world(name: &str) -> World {
        let path = format!("{}/../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        World::new(Scenario::load(path).unwrap())
    }
}
