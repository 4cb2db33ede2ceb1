//! Algorithm 1 of the paper: MOGP-NSGA-II over structures, DE/rand/1/bin over each structure's θ (model page, section 5).
//!
//! How a generation works:
//!
//! 1. [`Search::advance`] takes the trees it can still afford: ramped half-and-half at first, then tournaments by rank and
//!    crowding, crossover and mutation; a structure that the generation already has is drawn again.
//! 2. Each tree's θ are tuned by DE for f2 under Deb's rule, whatever the objectives.
//! 3. The objectives see the tuned model once, and their values stay with the individual.
//! 4. Parents and offspring compete; of equal structures only the best stays.
//!
//! Every individual has a stream of random numbers of its own, named by (run seed, generation, place), so the result
//! does not depend on threads, and an interrupted run goes on from its last whole generation to the same end.

use super::front::{FrontMember, front_hypervolume};
use super::individual::Individual;
use super::objective::Candidate;
use super::ranking;
use super::settings::{Settings, SettingsError};
use super::state::{Milestone, State};
use crate::evaluation::{Evaluation, Evaluator, Model, World};
use crate::model::tree::Tree;
use crate::model::variation::{Grammar, Variation};
use grn_core::network::THETA_RANGE;
use grn_optimisers::bounds::Bounds;
use grn_optimisers::de::{self, Wanted};
use grn_optimisers::knee::{self, Knee};
use grn_optimisers::nsga2::{self, Standing};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};
use std::sync::atomic::{self, AtomicBool};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A tree whose structure its generation already has is drawn again at most this often.
const REDRAWS: usize = 20;

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

/// A run of the search in one world.
pub struct Search<'w> {
    world: &'w World,
    settings: Settings,
    variation: Box<dyn Variation + 'w>,
    de: de::Settings,
    state: State,
    /// Idle ones, kept for their working memory and for what they know of the world's hard moments.
    evaluators: Mutex<Vec<Evaluator<'w>>>,
}

impl<'w> Search<'w> {
    /// A run with the paper's variation, at its beginning or at a saved state.
    ///
    /// # Errors
    /// Settings that make no sense, with the value and what is needed.
    pub fn new(world: &'w World, settings: Settings, state: Option<State>) -> Result<Self, SettingsError> {
        let theta = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
        let grammar = Grammar::new(settings.motifs, settings.depth, theta);
        Search::with(world, settings, Box::new(grammar), state)
    }

    /// A run with other variation.
    ///
    /// # Errors
    /// Settings that make no sense, with the value and what is needed.
    pub fn with(
        world: &'w World,
        settings: Settings,
        variation: Box<dyn Variation + 'w>,
        state: Option<State>,
    ) -> Result<Self, SettingsError> {
        settings.check()?;
        let de = settings.differential_evolution()?;
        let evaluators = Mutex::new(Vec::new());
        Ok(Search { world, settings, variation, de, state: state.unwrap_or_default(), evaluators })
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
            if stop.load(atomic::Ordering::Relaxed) {
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
        let standings = ranking::standings(&self.state.population.iter().collect::<Vec<_>>());
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
        let (tree, evaluation) = match tuned {
            Some(best) => (tree.with_thetas(&best.best), best.fitness),
            None => (tree.clone(), Evaluation::NO_PATTERN),
        };
        let model = evaluator.model_of(&tree, self.settings.steepness);
        let candidate = Candidate { tree: &tree, model: model.as_ref(), evaluation, world: self.world };
        let objectives = self.settings.objectives.values(&candidate);
        Individual::new(tree, objectives, evaluation)
    }

    fn milestone(&self) -> Milestone {
        let feasible = self.state.population.iter().filter(|individual| individual.is_feasible());
        Milestone {
            evaluations: self.state.evaluations,
            best_f2: feasible.clone().map(|individual| individual.f2).min_by(f64::total_cmp),
            feasible: feasible.clone().count(),
            front: self.front_places().iter().filter(|&&place| self.state.population[place].is_feasible()).count(),
            hypervolume: front_hypervolume(feasible.map(Individual::point)),
        }
    }

    /// The places in the population of the non-dominated set, by their objectives in order; of equal ones the first.
    fn front_places(&self) -> Vec<usize> {
        let population = &self.state.population;
        let mut places = ranking::non_dominated(&population.iter().collect::<Vec<_>>());
        let objectives = |place: usize| &population[place].objectives;
        places.sort_by(|&a, &b| lexicographic(objectives(a), objectives(b)));
        places.dedup_by(|&mut later, &mut first| lexicographic(objectives(first), objectives(later)).is_eq());
        places
    }

    /// The non-dominated set, by its objectives in order: fewest nodes first for the paper's. All feasible, unless nothing
    /// is: then the individuals of least violation. Its knees are those of the first two objectives.
    pub fn front(&self) -> Vec<FrontMember> {
        let front: Vec<&Individual> =
            self.front_places().into_iter().map(|place| &self.state.population[place]).collect();
        let points: Vec<[f64; 2]> = front.iter().map(|one| [one.objectives[0], one.objectives[1]]).collect();
        let knees = knee::knees(&points);
        let member = |(individual, knee): (&Individual, Knee)| {
            Some(FrontMember {
                network: individual.tree.network(self.settings.steepness).ok()?,
                nodes: individual.tree.size(),
                f2: individual.f2,
                further: self.settings.objectives.further(&individual.objectives),
                violation: individual.violation,
                knee,
            })
        };
        // Trees whose networks cannot be made have no evaluation that could put them on a front.
        front.into_iter().zip(knees).filter_map(member).collect()
    }

    /// The individuals of the last population that are not on the front.
    pub fn others(&self) -> Vec<&Individual> {
        let front = self.front_places();
        let population = self.state.population.iter().enumerate();
        population.filter(|(place, _)| !front.contains(place)).map(|(_, individual)| individual).collect()
    }

    /// NSGA-II survival among parents and offspring, of each structure only the best.
    fn survivors(&self, parents: Vec<Individual>, offspring: Vec<Individual>) -> Vec<Individual> {
        let mut places = HashMap::new();
        let mut unique: Vec<Individual> = Vec::new();
        for individual in parents.into_iter().chain(offspring) {
            match places.get(&individual.tree.structure()) {
                Some(&place) => {
                    let standing: &mut Individual = &mut unique[place];
                    if ranking::dominates(&individual, standing) {
                        *standing = individual;
                    }
                }
                None => {
                    places.insert(individual.tree.structure(), unique.len());
                    unique.push(individual);
                }
            }
        }
        let survivors = ranking::survivors(&unique.iter().collect::<Vec<_>>(), self.settings.population);
        survivors.into_iter().map(|place| unique[place].clone()).collect()
    }
}

fn lexicographic(a: &[f64], b: &[f64]) -> Ordering {
    a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}
