//! A blob in many laboratories around a nominal one: a distribution instead of one seed.

use crate::simulation::{Setting, Simulation, SimulationError, simulate_in};
use firmware_sim::config::SwarmConfig;
use firmware_sim::lab::run_seed;
#[cfg(doc)]
use firmware_sim::metrics::Caging;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use grn_optimisers::statistics::wilson;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::ops::{ControlFlow, RangeInclusive};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// The share of realities in which a controller must work.
pub const ENOUGH_REALITIES: f64 = 0.95;

/// What came out in one reality.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reality {
    /// Its number.
    pub number: u64,
    /// Whether every bar was met.
    pub works: bool,
    /// Share of the time after settling in which targets were caged.
    pub caged_share: f64,
    /// The ring error of the robots, see [`Caging::pen`].
    pub pen: f64,
    /// Share of robots' time after settling within d_min and d_max of a target.
    pub in_band_share: f64,
    /// Share of robots' time in touch with something.
    pub contact_share: f64,
    /// Robots off the pattern at the end, as a share.
    pub lost_share: f64,
    /// When all targets were caged for the first time and stayed so for two seconds; seconds from the start.
    pub formed_at_s: Option<f64>,
    /// J, see [`Caging::cost`].
    pub cost: f64,
    /// Share of the time after forming in which every target was encircled; 0 if the swarm never formed.
    pub encircled_share: f64,
    /// Median radial error as a share of the ring's radius; `None` if it is unknown or the swarm never formed.
    pub radial_error_share: Option<f64>,
    /// When the swarm had formed again after the last fault, seconds from the start; `None` without one or if it never did.
    pub reformed_at_s: Option<f64>,
    /// Share of the time after that in which every target was encircled; 0 if it never formed again, `None` without a fault.
    pub reformed_encircled_share: Option<f64>,
    /// Robots off the pattern at the end.
    pub lost_robots: usize,
    /// Robots that left the pattern and came back.
    pub strayed_robots: usize,
    /// How often a robot began to touch a wall.
    pub wall_contacts: u64,
    /// How often a pair of robots began to touch.
    pub peer_contacts: u64,
}

impl Reality {
    /// What came out of the run in reality `number`.
    fn of(number: u64, simulation: &Simulation) -> Reality {
        let (metrics, caging) = (&simulation.metrics, &simulation.caging);
        let last = metrics.recoveries.last();
        Reality {
            number,
            works: simulation.verdict().works(),
            caged_share: caging.caged_share,
            pen: caging.pen,
            in_band_share: caging.in_band_share,
            contact_share: caging.contact_share,
            lost_share: simulation.lost_share(),
            formed_at_s: caging.formed_at_s,
            cost: caging.cost(),
            encircled_share: metrics.encircled_share.unwrap_or(0.0),
            radial_error_share: simulation.radial_error_share(),
            reformed_at_s: last.and_then(|last| last.reformed_at_s),
            reformed_encircled_share: last.map(|last| last.encircled_share.unwrap_or(0.0)),
            lost_robots: metrics.lost_robots,
            strayed_robots: metrics.strayed_robots,
            wall_contacts: metrics.wall_contacts,
            peer_contacts: metrics.peer_contacts,
        }
    }

    /// Worse ones first: those that do not work, then those that cost more.
    fn by_badness(&self, other: &Reality) -> Ordering {
        let works = self.works.cmp(&other.works);
        works.then(other.cost.total_cmp(&self.cost)).then(self.number.cmp(&other.number))
    }
}

/// What came out in all of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Robustness {
    /// By number.
    pub realities: Vec<Reality>,
}

impl Robustness {
    /// In how many it works.
    pub fn works(&self) -> usize {
        self.realities.iter().filter(|reality| reality.works).count()
    }

    /// The 95 % interval (Wilson) of the share in which it works.
    pub fn interval(&self) -> (f64, f64) {
        wilson(self.works(), self.realities.len())
    }

    /// The mean of a measure; NaN without realities.
    pub fn mean(&self, measure: impl Fn(&Reality) -> f64) -> f64 {
        self.realities.iter().map(measure).sum::<f64>() / self.realities.len() as f64
    }

    /// The mean time to form in those realities in which the swarm formed.
    pub fn mean_formed_at_s(&self) -> Option<f64> {
        let times: Vec<f64> = self.realities.iter().filter_map(|reality| reality.formed_at_s).collect();
        (!times.is_empty()).then(|| times.iter().sum::<f64>() / times.len() as f64)
    }

    /// Whether it works in at least [`ENOUGH_REALITIES`] of them.
    pub fn is_enough(&self) -> bool {
        self.works() as f64 >= ENOUGH_REALITIES * self.realities.len() as f64
    }

    /// The worst ones, worst first.
    pub fn worst(&self, count: usize) -> Vec<&Reality> {
        let mut sorted: Vec<&Reality> = self.realities.iter().collect();
        sorted.sort_by(|a, b| a.by_badness(b));
        sorted.truncate(count);
        sorted
    }

    /// The nearest-rank quantile of a measure, sorted from good to bad by the caller's numbers; `None` without realities.
    pub fn quantile(&self, share: f64, measure: impl Fn(&Reality) -> f64) -> Option<f64> {
        let mut values: Vec<f64> = self.realities.iter().map(measure).collect();
        values.sort_by(f64::total_cmp);
        let rank = (share * values.len() as f64).ceil().max(1.0) as usize;
        values.get(rank.saturating_sub(1)).copied()
    }
}

/// The run in reality number `number` of an experiment with this configuration.
#[must_use]
pub fn reality(config: &SwarmConfig, number: u64) -> SwarmConfig {
    let lab = config.lab.reality(config.seed, number);
    SwarmConfig { seed: run_seed(config.seed, number), lab, ..config.clone() }
}

/// Runs `blob` in these realities, on the threads of the pool that this is called in; the result does not depend on how many there
/// are. `done` is called after each. `Ok(None)` if `stop` was set.
///
/// # Errors
/// [`SimulationError`]: of several, that of the reality with the lowest number.
pub fn try_all(
    blob: &Blob,
    scenario: &Scenario,
    config: &SwarmConfig,
    number_type: NumberType,
    numbers: RangeInclusive<u64>,
    stop: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Result<Option<Robustness>, SimulationError> {
    let watch = |_| if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let setting = Setting::new(blob, scenario, config)?;
    try_each(config, numbers, &|reality| {
        let simulation = simulate_in(&setting, reality, number_type, &mut (), watch)?;
        done();
        Ok(simulation)
    })
}

/// What comes out in these realities when `simulate` runs each, as [`try_all`] does it for a blob.
///
/// # Errors
/// As of [`try_all`]; `Ok(None)` if a run was stopped.
pub(crate) fn try_each(
    config: &SwarmConfig,
    numbers: RangeInclusive<u64>,
    simulate: &(dyn Fn(SwarmConfig) -> Result<Option<Simulation>, SimulationError> + Sync),
) -> Result<Option<Robustness>, SimulationError> {
    let one = |number| {
        let simulation = simulate(reality(config, number))?;
        Ok(simulation.map(|simulation| Reality::of(number, &simulation)))
    };
    let numbers: Vec<u64> = numbers.collect();
    let results: Vec<Result<Option<Reality>, SimulationError>> = numbers.into_par_iter().map(one).collect();
    let realities: Option<Vec<Reality>> = results.into_iter().collect::<Result<_, _>>()?;
    Ok(realities.map(|realities| Robustness { realities }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reality_of(number: u64, works: bool, encircled_share: f64, error: Option<f64>) -> Reality {
        Reality {
            number,
            works,
            caged_share: encircled_share,
            pen: 0.05,
            in_band_share: 0.9,
            contact_share: 0.0,
            lost_share: 0.0,
            formed_at_s: Some(1.0),
            cost: 1.05 - encircled_share,
            encircled_share,
            radial_error_share: error,
            reformed_at_s: None,
            reformed_encircled_share: None,
            lost_robots: 0,
            strayed_robots: 0,
            wall_contacts: 0,
            peer_contacts: 0,
        }
    }

    #[test]
    fn the_worst_are_named_and_the_rate_has_an_interval() {
        let failed = |number: u64| (number == 7).then_some(0.4).or((number == 50).then_some(0.9));
        let one = |number| match failed(number) {
            Some(share) => reality_of(number, false, share, Some(0.02)),
            None if number == 3 => reality_of(number, false, 1.0, None),
            None => reality_of(number, true, 1.0, Some(0.01 + number as f64 * 1e-4)),
        };
        let robustness = Robustness { realities: (1..=100).map(one).collect() };
        assert_eq!(robustness.works(), 97);
        let (low, high) = robustness.interval();
        assert_eq!(format!("{:.1} to {:.1} %", low * 100.0, high * 100.0), "91.5 to 99.0 %");
        assert!(robustness.is_enough());
        let worst: Vec<u64> = robustness.worst(4).iter().map(|reality| reality.number).collect();
        assert_eq!(worst, [7, 50, 3, 1]);
        assert_eq!(robustness.quantile(0.5, |reality| reality.encircled_share), Some(1.0));
        assert_eq!(robustness.quantile(0.01, |reality| reality.encircled_share), Some(0.4));
    }

    #[test]
    fn a_reality_is_the_same_whenever_it_is_drawn() {
        let nominal = SwarmConfig { lab: firmware_sim::lab::Shipped::Hostile.laboratory(), ..SwarmConfig::default() };
        assert_eq!(reality(&nominal, 0), nominal);
        assert_eq!(reality(&nominal, 5), reality(&nominal, 5));
        let drawn: Vec<SwarmConfig> = (1..=200).map(|number| reality(&nominal, number)).collect();
        assert!(drawn.iter().all(|config| config.check().is_ok()), "every reality is possible");
        let losses: Vec<f64> = drawn.iter().map(|config| config.lab.radio.loss).collect();
        assert!(losses.iter().all(|loss| (0.4..=0.6).contains(loss)));
        assert!(losses.iter().any(|&loss| loss < 0.43) && losses.iter().any(|&loss| loss > 0.57));
        assert!(drawn.windows(2).all(|pair| pair[0].seed != pair[1].seed));
    }
}
