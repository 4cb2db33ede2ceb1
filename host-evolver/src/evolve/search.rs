//! Algorithm 1 of the paper: MOGP-NSGA-II over structures, DE/rand/1/bin over each structure's θ (model page, section 5).
//!
//! How a generation works:
//!
//! 1. [`Search::advance`] takes the trees it can still afford: ramped half-and-half at first, then tournaments by rank and
//!    crowding, crossover and mutation; a structure that the generation already has is drawn again.
//! 2. Each tree's θ are tuned by DE for f2 under Deb's rule, whatever the objectives.
//! 3. Parents and offspring compete; of equal structures only the best stays. If an objective is made from simulated runs, the
//!    feasible ones are tried first (see `trials`).
//!
//! Every individual has a stream of random numbers of its own, named by (run seed, generation, place), so the result
//! does not depend on threads, and an interrupted run goes on from its last whole generation to the same end.

use super::front::{FrontMember, front_hypervolume};
use super::individual::Individual;
use super::ranking;
use super::refinement::{MOST_REFINED, refined};
use super::settings::{Settings, SettingsError};
use super::state::{Milestone, State};
use super::task::Task;
use super::trials::Trials;
use crate::evaluation::{Evaluation, Evaluator, Model};
use crate::model::tree::Tree;
use crate::model::variation::{Grammar, Variation};
use grn_core::network::THETA_RANGE;
use grn_optimisers::bounds::Bounds;
use grn_optimisers::de::{self, Wanted};
use grn_optimisers::knee::{self, Knee};
use grn_optimisers::nsga2::{self, Standing};
use grn_optimisers::parsimony::{Tried, parsimonious};
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

/// A run of the search.
pub struct Search<'w> {
    task: &'w Task,
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
    pub fn new(task: &'w Task, settings: Settings, state: Option<State>) -> Result<Self, SettingsError> {
        let theta = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
        let grammar = Grammar::new(settings.motifs, settings.depth, theta);
        Search::with(task, settings, Box::new(grammar), state)
    }

    /// A run with other variation.
    ///
    /// # Errors
    /// Settings that make no sense, with the value and what is needed.
    pub fn with(
        task: &'w Task,
        settings: Settings,
        variation: Box<dyn Variation + 'w>,
        state: Option<State>,
    ) -> Result<Self, SettingsError> {
        settings.check()?;
        let de = settings.differential_evolution()?;
        let evaluators = Mutex::new(Vec::new());
        Ok(Search { task, settings, variation, de, state: state.unwrap_or_default(), evaluators })
    }

    fn evaluators(&self) -> MutexGuard<'_, Vec<Evaluator<'w>>> {
        self.evaluators.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The state after the last whole generation.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What it is for.
    pub fn task(&self) -> &'w Task {
        self.task
    }

    /// The run's settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Runs one generation on the current thread pool. `tuned` is called after each individual with its evaluation;
    /// once `stop` is set the generation is dropped.
    pub fn advance(&mut self, stop: &AtomicBool, tuned: &(dyn Fn(&Individual) + Sync)) -> Advance {
        let affordable = self.settings.searching_evaluations().saturating_sub(self.state.evaluations)
            / self.settings.evaluations_each();
        let brood = self.breed(affordable.min(self.settings.population));
        if brood.is_empty() {
            return Advance::Finished;
        }
        let tune = |(tree, mut rng): (Tree, ChaCha8Rng)| {
            if stop.load(atomic::Ordering::Relaxed) {
                return None;
            }
            let mut evaluator = self.evaluators().pop().unwrap_or_else(|| self.task.evaluator(&self.settings));
            let individual = self.tune(&mut evaluator, &tree, &mut rng);
            self.evaluators().push(evaluator);
            tuned(&individual);
            Some(individual)
        };
        let offspring: Option<Vec<Individual>> = brood.into_par_iter().with_max_len(1).map(tune).collect();
        let Some(offspring) = offspring else { return Advance::Interrupted };
        let spent = offspring.len() * self.settings.evaluations_each();
        let mut rivals: Vec<Individual> = self.state.population.iter().cloned().chain(offspring).collect();
        if self.settings.objectives.need_trials() {
            let hopeless = self.hopeless();
            if self.trials(stop).race(&mut rivals, hopeless).is_none() {
                return Advance::Interrupted;
            }
        }
        self.state.population = self.survivors(rivals);
        self.state.evaluations += spent;
        self.state.generation += 1;
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
        Individual::new(tree, &self.settings.objectives, evaluation)
    }

    fn milestone(&self) -> Milestone {
        let feasible = self.state.population.iter().filter(|individual| individual.is_feasible());
        Milestone {
            evaluations: self.state.evaluations,
            best_f2: feasible.clone().map(|individual| individual.f2).min_by(f64::total_cmp),
            best_cost: feasible.clone().filter_map(Individual::cost).min_by(f64::total_cmp),
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
        // Trees whose networks cannot be made have no evaluation that could put them on a front.
        front.into_iter().zip(knees).filter_map(|(individual, knee)| self.member(individual, knee)).collect()
    }

    /// The individuals of the last population that are not on the front.
    pub fn others(&self) -> Vec<&Individual> {
        let front = self.front_places();
        let population = self.state.population.iter().enumerate();
        population.filter(|(place, _)| !front.contains(place)).map(|(_, individual)| individual).collect()
    }

    /// NSGA-II survival, of each structure only the best.
    fn survivors(&self, rivals: Vec<Individual>) -> Vec<Individual> {
        let mut places = HashMap::new();
        let mut unique: Vec<Individual> = Vec::new();
        for individual in rivals {
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

    fn trials<'a>(&'a self, stop: &'a AtomicBool) -> Trials<'a> {
        Trials { task: self.task, settings: &self.settings, stop }
    }

    /// A run that costs more than the worst of the population decides nothing any more.
    fn hopeless(&self) -> f64 {
        let population = &self.state.population;
        let costs = population.iter().filter_map(Individual::cost);
        let is_full = population.len() == self.settings.population && population.iter().all(|one| one.cost().is_some());
        if is_full { costs.fold(0.0, f64::max) } else { f64::INFINITY }
    }

    /// The front of a run whose objectives are made from trials, judged by trials that the search has not seen; its knee is the
    /// simplest member that is as good as the best. Of another run [`front`](Self::front). `None` if stopped.
    pub fn confirmed_front(&self, stop: &AtomicBool) -> Option<Vec<FrontMember>> {
        if !self.settings.objectives.need_trials() {
            return Some(self.front());
        }
        let places = self.front_places().into_iter();
        let mut members: Vec<Individual> = places.map(|place| self.state.population[place].clone()).collect();
        members.retain(|member| member.tree.network(self.settings.steepness).is_ok());
        if !members.iter().all(Individual::is_feasible) {
            return Some(self.front());
        }
        let network = |member: &Individual| member.tree.network(self.settings.steepness).ok();
        self.refine(&mut members, stop)?;
        let networks: Vec<_> = members.iter().filter_map(network).collect();
        for (member, costs) in members.iter_mut().zip(self.trials(stop).fresh(&networks)?) {
            member.trials = costs;
            member.value_trials(&self.settings.objectives);
        }
        let front = ranking::non_dominated(&members.iter().collect::<Vec<_>>());
        let mut front: Vec<&Individual> = front.into_iter().map(|place| &members[place]).collect();
        front.sort_by(|a, b| lexicographic(&a.objectives, &b.objectives));
        let tried = front.iter().map(|one| Tried { complexity: one.tree.size() as f64, costs: &one.trials });
        let chosen = parsimonious(&tried.collect::<Vec<_>>());
        let knee = |place: usize| Knee { parsimony: chosen == Some(place), ..Knee::default() };
        Some(front.iter().enumerate().filter_map(|(place, member)| self.member(member, knee(place))).collect())
    }

    /// Refines the best of these. `None` if stopped.
    fn refine(&self, members: &mut [Individual], stop: &AtomicBool) -> Option<()> {
        let mut best: Vec<usize> = (0..members.len()).collect();
        best.sort_by(|&a, &b| members[a].cost().partial_cmp(&members[b].cost()).unwrap_or(Ordering::Equal));
        best.truncate(MOST_REFINED);
        let each = self.settings.refining_evaluations() / best.len().max(1);
        let mut evaluator = self.task.evaluator(&self.settings);
        for (nth, &place) in best.iter().enumerate() {
            members[place] = refined(&self.trials(stop), &mut evaluator, &members[place], each, nth as u64)?;
        }
        Some(())
    }

    /// `None` for a tree whose network cannot be made.
    fn member(&self, individual: &Individual, knee: Knee) -> Option<FrontMember> {
        Some(FrontMember {
            network: individual.tree.network(self.settings.steepness).ok()?,
            nodes: individual.tree.size(),
            f2: individual.f2,
            further: self.settings.objectives.further(&individual.objectives),
            violation: individual.violation,
            knee,
        })
    }
}

fn lexicographic(a: &[f64], b: &[f64]) -> Ordering {
    a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}
