//! Models tried on swarms: the closed loop as something to be minimised.
//!
//! A trial of a model is a simulated run in every world, in one reality of the laboratory; what it costs is the mean of
//! [J](firmware_sim::metrics::Caging::cost). Trials of the same number have the same conditions for all models, so that these can be
//! compared (common random numbers).
//!
//! Trials are spent where they decide something, by racing (Maron and Moore 1994; for policies Heidrich-Meisner and Igel 2009):
//! every feasible model has [a few](FIRST), and who is on the front of all gets twice as many, until everybody there has all that
//! there are. Who only had luck in the first ones leaves the front on the way.

use super::individual::Individual;
use super::ranking;
use super::settings::Settings;
use super::task::Task;
use crate::model::deploy;
use crate::realities;
use crate::simulation::{Setting, cost};
use firmware_sim::config::SwarmConfig;
use firmware_sim::metrics::WORST_COST;
use grn_core::network::Network;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Trials that every feasible model has.
const FIRST: usize = 2;
/// The first reality of those that no search sees: the front is judged in them.
const FRESH: u64 = 1_000_001;
/// How long a tick is at least in the trials of the search, seconds.
const DRAFT_TICK_S: f64 = 0.1;

/// A trial as the search makes it: robots think ten times a second at most, which halves what it takes. Where targets are caged, J
/// differs by about 0.01 from that with ticks of 1/32 s, by which a front is judged in the end.
fn draft(swarm: &SwarmConfig) -> SwarmConfig {
    let mut draft = swarm.clone();
    draft.lab.timing.tick_s = draft.lab.timing.tick_s.max(DRAFT_TICK_S);
    draft
}

/// Tries models of one run of the search.
pub(super) struct Trials<'a> {
    pub task: &'a Task,
    pub settings: &'a Settings,
    pub stop: &'a AtomicBool,
    /// Is called after each trial.
    pub done: &'a (dyn Fn() + Sync),
}

impl Trials<'_> {
    /// Gives the feasible ones of `individuals` their first trials, and then those on the front of all more and more. Once a run alone
    /// makes sure that a model's mean cost will exceed `hopeless`, it is broken off, and costs what is sure by then. `None` if stopped.
    pub fn race(&self, individuals: &mut [Individual], hopeless: f64) -> Option<()> {
        let most = self.settings.realities;
        let untried = |individual: &Individual| individual.is_feasible() && individual.trials.is_empty();
        let first: Vec<usize> = (0..individuals.len()).filter(|&place| untried(&individuals[place])).collect();
        self.extend(individuals, &first, FIRST.min(most), hopeless)?;
        loop {
            let front = ranking::non_dominated(&individuals.iter().collect::<Vec<_>>());
            let wants_more = |&place: &usize| {
                let individual: &Individual = &individuals[place];
                individual.is_feasible() && individual.trials.len() < most
            };
            let contenders: Vec<usize> = front.into_iter().filter(wants_more).collect();
            let trials = |place: &usize| individuals[*place].trials.len();
            let Some(least) = contenders.iter().map(trials).min() else { return Some(()) };
            let behind: Vec<usize> = contenders.iter().copied().filter(|place| trials(place) == least).collect();
            self.extend(individuals, &behind, (2 * least).min(most), hopeless)?;
        }
    }

    /// Brings the individuals at `places` to so many trials; runs are broken off as in a [race](Self::race).
    pub fn extend(&self, individuals: &mut [Individual], places: &[usize], count: usize, hopeless: f64) -> Option<()> {
        let jobs = places.iter().flat_map(|&place| {
            let done = individuals[place].trials.len();
            (done..count).map(move |trial| (place, trial as u64 + 1))
        });
        let jobs: Vec<(usize, u64)> = jobs.collect();
        let steepness = self.settings.steepness;
        let draft = draft(self.task.swarm());
        let individuals_now: &[Individual] = individuals;
        let one = |&(place, reality): &(usize, u64)| {
            let individual = &individuals_now[place];
            let known: f64 = individual.trials.iter().sum();
            let most = hopeless * count as f64 - known;
            let network = individual.tree.network(steepness).ok();
            network.map_or(Some(WORST_COST), |network| self.trial(&draft, &network, reality, most))
        };
        let costs: Option<Vec<f64>> = jobs.par_iter().with_max_len(1).map(one).collect();
        for (&(place, _), cost) in jobs.iter().zip(costs?) {
            individuals[place].trials.push(cost);
        }
        for &place in places {
            individuals[place].value_trials(&self.settings.objectives);
        }
        Some(())
    }

    /// The costs of a model in realities that the search has not seen; `None` if stopped.
    pub fn fresh(&self, networks: &[Network<f32>]) -> Option<Vec<Vec<f64>>> {
        let count = self.settings.realities;
        let jobs: Vec<(usize, u64)> =
            (0..networks.len() * count).map(|job| (job / count.max(1), FRESH + (job % count.max(1)) as u64)).collect();
        let swarm = self.task.swarm();
        let one = |&(model, reality): &(usize, u64)| self.trial(swarm, &networks[model], reality, f64::INFINITY);
        let costs: Option<Vec<f64>> = jobs.par_iter().with_max_len(1).map(one).collect();
        Some(costs?.chunks(count.max(1)).map(<[f64]>::to_vec).collect())
    }

    /// The mean cost of the runs in one reality; once it is sure to exceed `most`, what is sure by then. `None` if stopped.
    fn trial(&self, swarm: &SwarmConfig, network: &Network<f32>, reality: u64, most: f64) -> Option<f64> {
        let swarm = realities::reality(swarm, reality);
        let worlds = self.task.worlds().len() as f64;
        let mut sum = 0.0;
        for scenario in self.task.scenarios() {
            if self.stop.load(Relaxed) {
                return None;
            }
            let left = most * worlds - sum;
            if left < 0.0 {
                break;
            }
            let blob = deploy::blob(network.clone(), &scenario.morphogen(), self.task.scale());
            let swarm = scenario.configured(swarm.clone());
            let run = Setting::new(&blob, scenario, &swarm).and_then(|setting| cost(&setting, swarm.clone(), left));
            sum += run.unwrap_or(WORST_COST);
        }
        (self.done)();
        Some(sum / worlds)
    }
}
