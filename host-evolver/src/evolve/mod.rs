//! Algorithm 1 of the paper: MOGP-NSGA-II over structures, DE/rand/1/bin over each structure's θ (model page, section 5).
//!
//! Every individual has a stream of random numbers of its own, named by (run seed, generation, place), so the result
//! does not depend on threads, and an interrupted run goes on from its last whole generation to the same end.

pub mod eh_grn;
mod individual;
pub mod objective;
mod settings;
#[cfg(test)]
mod tests;

pub use individual::Individual;
pub use settings::{DeSettings, Settings, SettingsError};

use crate::evaluation::{Evaluation, Evaluator, Model, World};
use crate::model::tree::Tree;
use crate::model::variation::{Grammar, Variation};
use grn_core::network::THETA_RANGE;
use grn_optimisers::bounds::Bounds;
use grn_optimisers::de::{self, Wanted};
use grn_optimisers::hypervolume::hypervolume;
use grn_optimisers::knee;
use grn_optimisers::nsga2::{self, Scores, Standing};
use objective::{Nodes, Objective, RingError, scores};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A tree whose structure its generation already has is drawn again at most so often.
const REDRAWS: usize = 20;

/// The state between two generations: all that a run needs to go on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Generations done; the first is the initial population.
    pub generation: u32,
    /// Evaluations of f2 spent.
    pub evaluations: usize,
    /// The current population.
    pub population: Vec<Individual>,
    /// One line a generation.
    pub history: Vec<Milestone>,
}

/// How far a run had come after a generation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Milestone {
    /// Evaluations of f2 spent.
    pub evaluations: usize,
    /// Best f2 of a feasible individual, if there is one.
    pub best_f2: Option<f64>,
    /// Feasible individuals in the population.
    pub feasible: usize,
    /// Individuals on the feasible non-dominated front.
    pub front: usize,
    /// Of the feasible individuals, in (f1, f2): the share of the box below [`REFERENCE`] that they dominate.
    pub hypervolume: f64,
}

/// The nodes and the f2 beyond which a model counts for nothing in a hypervolume.
pub const REFERENCE: [f64; 2] = [32.0, 0.2];

/// The share of the box from the origin to [`REFERENCE`] that feasible (f1, f2) dominate, within [0, 1].
pub fn front_hypervolume(points: impl Iterator<Item = [f64; 2]>) -> f64 {
    hypervolume(&points.collect::<Vec<_>>(), REFERENCE) / (REFERENCE[0] * REFERENCE[1])
}

/// What [`Search::advance`] did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Advance {
    /// A generation more.
    Generation,
    /// Nothing: the budget is spent.
    Finished,
    /// Nothing: it was asked to stop.
    Interrupted,
}

/// The paper's two objectives.
pub const PAPER: [&dyn Objective; 2] = [&Nodes, &RingError];

/// A run of the search in one world for `M` objectives.
pub struct Search<'w, const M: usize = 2> {
    world: &'w World,
    settings: Settings,
    objectives: [&'w dyn Objective; M],
    variation: Box<dyn Variation + 'w>,
    de: de::Settings,
    state: State,
    /// Idle ones, kept for their working memory and for what they know of the world's hard moments.
    evaluators: Mutex<Vec<Evaluator<'w>>>,
}

impl<'w> Search<'w> {
    /// A run for the paper's objectives with the paper's variation, at its beginning or at a saved state.
    ///
    /// # Errors
    /// Settings that make no sense, with the value and what is needed.
    pub fn new(world: &'w World, settings: Settings, state: Option<State>) -> Result<Self, SettingsError> {
        let theta = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
        let grammar = Grammar::new(settings.motifs, settings.depth, theta);
        Search::with(world, settings, PAPER, Box::new(grammar), state)
    }
}

impl<'w, const M: usize> Search<'w, M> {
    /// A run for other objectives, or with other variation; θ are tuned for f2 all the same.
    ///
    /// # Errors
    /// Settings that make no sense, with the value and what is needed.
    pub fn with(
        world: &'w World,
        settings: Settings,
        objectives: [&'w dyn Objective; M],
        variation: Box<dyn Variation + 'w>,
        state: Option<State>,
    ) -> Result<Self, SettingsError> {
        settings.check()?;
        let de = settings.differential_evolution()?;
        let fresh = State { generation: 0, evaluations: 0, population: Vec::new(), history: Vec::new() };
        let (state, evaluators) = (state.unwrap_or(fresh), Mutex::new(Vec::new()));
        Ok(Search { world, settings, objectives, variation, de, state, evaluators })
    }

    fn evaluators(&self) -> MutexGuard<'_, Vec<Evaluator<'w>>> {
        self.evaluators.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The state after the last whole generation.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The run's settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Runs one generation on the current thread pool. `tuned` is called after each individual with its evaluation;
    /// once `stop` is set the generation is dropped.
    pub fn advance(&mut self, stop: &AtomicBool, tuned: &(dyn Fn(&Individual) + Sync)) -> Advance {
        let affordable = (self.settings.evaluations - self.state.evaluations) / self.settings.evaluations_each();
        let brood = self.breed(affordable.min(self.settings.population));
        if brood.is_empty() {
            return Advance::Finished;
        }
        let tune = |(tree, mut rng): (Tree, ChaCha8Rng)| {
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let mut evaluator = self.evaluators().pop().unwrap_or_else(|| Evaluator::new(self.world));
            let individual = self.tune(&mut evaluator, &tree, &mut rng);
            self.evaluators().push(evaluator);
            tuned(&individual);
            Some(individual)
        };
        let offspring: Option<Vec<Individual>> = brood.into_par_iter().with_max_len(1).map(tune).collect();
        let Some(offspring) = offspring else { return Advance::Interrupted };
        self.state.evaluations += offspring.len() * self.settings.evaluations_each();
        self.state.generation += 1;
        let parents = std::mem::take(&mut self.state.population);
        self.state.population = self.survivors(parents, offspring);
        self.state.history.push(self.milestone());
        Advance::Generation
    }

    /// The next trees to tune, each with its own random stream; no structure twice, if it can be helped.
    fn breed(&self, count: usize) -> Vec<(Tree, ChaCha8Rng)> {
        let standings = nsga2::standings(&self.scores(&self.state.population));
        let mut structures = HashSet::new();
        let individual = |place: usize| {
            let mut rng = ChaCha8Rng::seed_from_u64(self.settings.seed);
            rng.set_stream(u64::from(self.state.generation) << 32 | place as u64);
            let mut draw = || {
                if standings.is_empty() {
                    self.variation.create(place, &mut rng)
                } else {
                    self.offspring(&standings, &mut rng)
                }
            };
            let mut tree = draw();
            for _ in 0..REDRAWS {
                if !structures.contains(&tree.structure()) {
                    break;
                }
                tree = draw();
            }
            structures.insert(tree.structure());
            (tree, rng)
        };
        (0..count).map(individual).collect()
    }

    fn scores(&self, individuals: &[Individual]) -> Vec<Scores<M>> {
        individuals.iter().map(|individual| scores(individual, &self.objectives)).collect()
    }

    fn offspring(&self, standings: &[Standing], rng: &mut ChaCha8Rng) -> Tree {
        let mut parent = || &self.state.population[nsga2::tournament(rng, standings)].tree;
        let (mother, father) = (parent(), parent());
        let child = if rng.random_bool(self.settings.crossover) {
            self.variation.cross(mother, father, rng)
        } else {
            mother.clone()
        };
        if rng.random_bool(self.settings.mutation) { self.variation.mutate(&child, rng) } else { child }
    }

    /// DE over θ, starting from the θ the tree has inherited; fitness is f2 under Deb's rule.
    fn tune(&self, evaluator: &mut Evaluator<'w>, tree: &Tree, rng: &mut ChaCha8Rng) -> Individual {
        let inherited = tree.thetas();
        let (low, high) = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
        let evaluate = |vectors: &[Vec<f64>], wanted: Wanted<'_, Evaluation>| {
            let model = |thetas: &Vec<f64>| evaluator.model_of(&tree.with_thetas(thetas), self.settings.steepness);
            let models: Vec<Option<Model>> = vectors.iter().map(model).collect();
            match wanted {
                Wanted::All => evaluator.evaluate_best(&models, models.len(), None),
                Wanted::Best(rival) => evaluator.evaluate_best(&models, 1, rival),
                Wanted::Winners(rivals) => {
                    let one = |(model, rival)| evaluator.evaluate_best(std::slice::from_ref(model), 1, Some(rival))[0];
                    models.iter().zip(rivals).map(one).collect()
                }
            }
        };
        let tuned = Bounds::cube(inherited.len(), low, high).ok().and_then(|bounds| {
            de::minimise_together(&self.de, &bounds, &[inherited], rng, evaluate, Evaluation::is_as_good_as).ok()
        });
        match tuned {
            Some(best) => Individual::new(tree.with_thetas(&best.best), best.fitness),
            None => Individual::new(tree.clone(), Evaluation::NO_PATTERN),
        }
    }

    fn milestone(&self) -> Milestone {
        let feasible = self.state.population.iter().filter(|individual| individual.is_feasible());
        Milestone {
            evaluations: self.state.evaluations,
            best_f2: feasible.clone().map(|individual| individual.f2).min_by(f64::total_cmp),
            feasible: feasible.clone().count(),
            front: self.front().iter().filter(|member| member.individual.is_feasible()).count(),
            hypervolume: front_hypervolume(feasible.map(Individual::point)),
        }
    }

    /// The non-dominated set with its knees in (f1, f2), fewest nodes first. All feasible, unless nothing is: then the
    /// individuals of least violation.
    pub fn front(&self) -> Vec<FrontMember> {
        let population = &self.state.population;
        let mut front: Vec<&Individual> =
            nsga2::non_dominated(&self.scores(population)).into_iter().map(|place| &population[place]).collect();
        front.sort_by(|a, b| a.tree.size().cmp(&b.tree.size()).then(a.f2.total_cmp(&b.f2)));
        front.dedup_by_key(|individual| scores(individual, &self.objectives).objectives.map(f64::to_bits));
        let points: Vec<[f64; 2]> = front.iter().map(|individual| individual.point()).collect();
        let by_angle = knee::knee_by_angle(&points, knee::Neighbours::Nearest);
        let by_utility = knee::knee_by_utility(&points);
        let members = front.into_iter().enumerate().map(|(place, individual)| FrontMember {
            individual: individual.clone(),
            knee: Knee { angle: by_angle == Some(place), utility: by_utility == Some(place) },
        });
        members.collect()
    }

    /// NSGA-II survival among parents and offspring, of each structure only the best.
    fn survivors(&self, parents: Vec<Individual>, offspring: Vec<Individual>) -> Vec<Individual> {
        let mut places = HashMap::new();
        let mut unique: Vec<Individual> = Vec::new();
        for individual in parents.into_iter().chain(offspring) {
            match places.get(&individual.tree.structure()) {
                Some(&place) => {
                    let standing: &mut Individual = &mut unique[place];
                    if scores(&individual, &self.objectives).dominates(&scores(standing, &self.objectives)) {
                        *standing = individual;
                    }
                }
                None => {
                    places.insert(individual.tree.structure(), unique.len());
                    unique.push(individual);
                }
            }
        }
        let survivors = nsga2::survivors(&self.scores(&unique), self.settings.population);
        survivors.into_iter().map(|place| unique[place].clone()).collect()
    }
}

/// Which of Branke's methods calls a front member a knee.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Knee {
    /// The angle-based method.
    pub angle: bool,
    /// The marginal-utility method; this knee is the one that is deployed.
    pub utility: bool,
}

impl fmt::Display for Knee {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match (self.angle, self.utility) {
            (true, true) => "angle+utility",
            (true, false) => "angle",
            (false, true) => "utility",
            (false, false) => "",
        })
    }
}

/// A member of the non-dominated front.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontMember {
    /// The model.
    pub individual: Individual,
    /// Whether it is a knee.
    pub knee: Knee,
}
