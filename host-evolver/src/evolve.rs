//! Algorithm 1 of the paper: MOGP-NSGA-II over structures, DE/rand/1/bin over each structure's θ (model page, section 5).
//!
//! Every individual has a stream of random numbers of its own, named by (run seed, generation, place), so the result
//! does not depend on threads, and an interrupted run goes on from its last whole generation to the same end.

use crate::objective::{Evaluation, Judge, World};
use crate::search::bounds::Bounds;
use crate::search::nsga2::{self, Scores, Standing};
use crate::search::{de, knee};
use crate::tree::Tree;
use crate::variation::{Grammar, MotifSet};
use grn_core::network::THETA_RANGE;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

/// A tree whose structure its generation already has is drawn again at most so often.
const REDRAWS: usize = 20;

/// Everything that decides a run besides the scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Budget: evaluations of f2, all counted.
    pub evaluations: usize,
    /// Individuals in a generation.
    pub population: usize,
    /// Motifs to build with.
    pub motifs: MotifSet,
    /// Least and greatest depth of a tree, in edges.
    pub depth: (usize, usize),
    /// Steepness k of every sigmoid.
    pub steepness: f32,
    /// Probability that an offspring has two parents instead of one.
    pub crossover: f64,
    /// Probability that an offspring is mutated.
    pub mutation: f64,
    /// Differential evolution of each new individual's θ.
    pub de: DeSettings,
}

/// Parameters of DE/rand/1/bin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeSettings {
    /// Vectors: NP.
    pub population: usize,
    /// Differential weight F.
    pub weight: f64,
    /// Crossover probability CR.
    pub crossover: f64,
    /// Generations of trials after the initial vectors.
    pub generations: usize,
}

impl Default for Settings {
    /// The paper's settings for the channel.
    fn default() -> Self {
        Settings {
            seed: 1,
            evaluations: 4000,
            population: 40,
            motifs: MotifSet::All,
            depth: (1, 4),
            steepness: 1.0,
            crossover: 1.0,
            mutation: 0.1,
            de: DeSettings { population: 10, weight: 0.5, crossover: 0.9, generations: 1 },
        }
    }
}

/// Settings that no run can have.
#[derive(Clone, Debug, PartialEq)]
pub struct SettingsError(String);

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for SettingsError {}

impl Settings {
    /// Evaluations one individual costs.
    pub fn evaluations_each(&self) -> usize {
        self.de.population * (1 + self.de.generations)
    }

    fn differential_evolution(&self) -> Result<de::Settings, SettingsError> {
        let DeSettings { population, weight, crossover, generations } = self.de;
        de::Settings::new(population, weight, crossover, generations).map_err(|error| SettingsError(error.to_string()))
    }

    fn check(&self) -> Result<(), SettingsError> {
        self.differential_evolution()?;
        let least = self.population * self.evaluations_each();
        let faults = [
            (self.population < 2, format!("population = {}: at least 2 are needed", self.population)),
            (
                self.evaluations < least,
                format!("evaluations = {}: the first generation alone takes {least}", self.evaluations),
            ),
            (!(0.0..=1.0).contains(&self.crossover), format!("crossover = {} is no probability", self.crossover)),
            (!(0.0..=1.0).contains(&self.mutation), format!("mutation = {} is no probability", self.mutation)),
            (
                self.depth.0 < 1 || self.depth.0 > self.depth.1 || self.depth.1 > 4,
                format!("depth = {:?}: 1 ≤ least ≤ greatest ≤ 4 is needed", self.depth),
            ),
        ];
        match faults.into_iter().find(|(faulty, _)| *faulty) {
            Some((_, fault)) => Err(SettingsError(fault)),
            None => Ok(()),
        }
    }
}

/// A tuned tree and what it is worth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Individual {
    /// The tree with its θ.
    pub tree: Tree,
    /// f2 in [0, 2].
    pub f2: f64,
    /// Constraint violation, 0 for a feasible model.
    pub violation: f64,
}

impl Individual {
    fn new(tree: Tree, evaluation: Evaluation) -> Self {
        Individual { tree, f2: evaluation.f2, violation: evaluation.violation }
    }

    /// (f1, f2) and the violation, for Deb's rule.
    pub fn scores(&self) -> Scores<2> {
        Scores { objectives: [self.tree.size() as f64, self.f2], violation: self.violation }
    }

    /// Whether it encloses every target everywhere without coming too close to a wall.
    pub fn is_feasible(&self) -> bool {
        self.violation == 0.0
    }
}

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

/// A run of the search in one world.
pub struct Search<'w> {
    world: &'w World,
    settings: Settings,
    grammar: Grammar,
    de: de::Settings,
    state: State,
}

impl<'w> Search<'w> {
    /// A run at its beginning, or at a saved state.
    ///
    /// # Errors
    /// Settings that make no sense, with the value and what is needed.
    pub fn new(world: &'w World, settings: Settings, state: Option<State>) -> Result<Self, SettingsError> {
        settings.check()?;
        let de = settings.differential_evolution()?;
        let theta = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
        let grammar = Grammar::new(settings.motifs, settings.depth, theta);
        let fresh = State { generation: 0, evaluations: 0, population: Vec::new(), history: Vec::new() };
        Ok(Search { world, settings, grammar, de, state: state.unwrap_or(fresh) })
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
        let tune = |judge: &mut Judge<'w>, (tree, mut rng): (Tree, ChaCha8Rng)| {
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let individual = self.tune(judge, &tree, &mut rng);
            tuned(&individual);
            Some(individual)
        };
        let offspring: Option<Vec<Individual>> =
            brood.into_par_iter().with_max_len(1).map_init(|| Judge::new(self.world), tune).collect();
        let Some(offspring) = offspring else { return Advance::Interrupted };
        self.state.evaluations += offspring.len() * self.settings.evaluations_each();
        self.state.generation += 1;
        let parents = std::mem::take(&mut self.state.population);
        self.state.population = survivors(parents, offspring, self.settings.population);
        self.state.history.push(self.milestone());
        Advance::Generation
    }

    /// The next trees to tune, each with its own random stream; no structure twice, if it can be helped.
    fn breed(&self, count: usize) -> Vec<(Tree, ChaCha8Rng)> {
        let scores: Vec<_> = self.state.population.iter().map(Individual::scores).collect();
        let standings = nsga2::standings(&scores);
        let mut structures = HashSet::new();
        let individual = |place: usize| {
            let mut rng = ChaCha8Rng::seed_from_u64(self.settings.seed);
            rng.set_stream(u64::from(self.state.generation) << 32 | place as u64);
            let mut draw = || {
                if standings.is_empty() {
                    self.grammar.ramped(place, &mut rng)
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
            self.grammar.cross(mother, father, rng)
        } else {
            mother.clone()
        };
        if rng.random_bool(self.settings.mutation) { self.grammar.mutate(&child, rng) } else { child }
    }

    /// DE over θ, starting from the θ the tree has inherited; fitness is f2 under Deb's rule.
    fn tune(&self, judge: &mut Judge<'w>, tree: &Tree, rng: &mut ChaCha8Rng) -> Individual {
        let inherited = tree.thetas();
        let (low, high) = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
        let evaluate = |thetas: &[f64], rival: Option<&Evaluation>| {
            judge.judge_tree(&tree.with_thetas(thetas), self.settings.steepness, rival)
        };
        let tuned = Bounds::cube(inherited.len(), low, high).ok().and_then(|bounds| {
            de::minimise(&self.de, &bounds, &[inherited], rng, evaluate, Evaluation::is_as_good_as).ok()
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
            feasible: feasible.count(),
            front: self.front().iter().filter(|member| member.individual.is_feasible()).count(),
        }
    }

    /// The non-dominated set with its knees, fewest nodes first. All feasible, unless nothing is: then the individuals
    /// of least violation.
    pub fn front(&self) -> Vec<FrontMember> {
        front_of(&self.state.population)
    }
}

/// NSGA-II survival among parents and offspring, of each structure only the best.
fn survivors(parents: Vec<Individual>, offspring: Vec<Individual>, count: usize) -> Vec<Individual> {
    let mut places = HashMap::new();
    let mut unique: Vec<Individual> = Vec::new();
    for individual in parents.into_iter().chain(offspring) {
        match places.get(&individual.tree.structure()) {
            Some(&place) => {
                let standing: &mut Individual = &mut unique[place];
                if individual.scores().dominates(&standing.scores()) {
                    *standing = individual;
                }
            }
            None => {
                places.insert(individual.tree.structure(), unique.len());
                unique.push(individual);
            }
        }
    }
    let scores: Vec<_> = unique.iter().map(Individual::scores).collect();
    nsga2::survivors(&scores, count).into_iter().map(|place| unique[place].clone()).collect()
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

fn front_of(population: &[Individual]) -> Vec<FrontMember> {
    let scores: Vec<_> = population.iter().map(Individual::scores).collect();
    let mut front: Vec<&Individual> =
        nsga2::non_dominated(&scores).into_iter().map(|place| &population[place]).collect();
    front.sort_by(|a, b| a.tree.size().cmp(&b.tree.size()).then(a.f2.total_cmp(&b.f2)));
    front.dedup_by_key(|individual| (individual.tree.size(), individual.f2.to_bits()));
    let points: Vec<[f64; 2]> = front.iter().map(|individual| individual.scores().objectives).collect();
    let by_angle = knee::knee_by_angle(&points, knee::Neighbours::Nearest);
    let by_utility = knee::knee_by_utility(&points);
    let members = front.into_iter().enumerate().map(|(place, individual)| FrontMember {
        individual: individual.clone(),
        knee: Knee { angle: by_angle == Some(place), utility: by_utility == Some(place) },
    });
    members.collect()
}

#[cfg(test)]
mod tests;
