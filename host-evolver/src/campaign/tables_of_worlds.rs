//! What became of models in worlds: the lines of trials and of simulations, of each world and of all worlds of a group.

use super::plan::{Place, Plan};
use super::rows::{INFEASIBLE, SimulationRow, SimulationSummary, TransferRow};
use super::simulate::Simulate;
use super::trial::Trial;
use super::unit::Unit;
use crate::realities::{Reality, Robustness};
use firmware_sim::metrics::WORST_COST;
use grn_optimisers::statistics::{bootstrap_rate, quartiles, wilson};

/// The realities of a knee in a world.
type Simulated = ((Unit, Place), Vec<Reality>);

/// The mean of a measure; `None` without realities, of a knee that cannot drive a robot.
fn mean(realities: &[Reality], measure: impl Fn(&Reality) -> f64) -> Option<f64> {
    (!realities.is_empty()).then(|| realities.iter().map(measure).sum::<f64>() / realities.len() as f64)
}

/// Mean and highest of the costs J of a run's knee in its training worlds, each the mean over realities; `None` if it was not
/// simulated, or cannot drive a robot.
pub(super) fn costs(unit: Unit, simulations: &[Simulated]) -> Option<(f64, f64)> {
    let own = simulations.iter().filter(|((of, place), _)| *of == unit && matches!(place, Place::Scenario(..)));
    let costs: Vec<f64> = own.map(|(_, realities)| mean(realities, |reality| reality.cost)).collect::<Option<_>>()?;
    let worst = costs.iter().copied().reduce(f64::max)?;
    Some((costs.iter().sum::<f64>() / costs.len() as f64, worst))
}

/// The 95 % interval of a success rate over runs and worlds; a single trial has none.
fn interval(succeeded: &[Vec<bool>]) -> Option<(f64, f64)> {
    let worlds = succeeded.iter().map(Vec::len).max().unwrap_or(0);
    let successes = succeeded.iter().flatten().filter(|&&success| success).count();
    let count: usize = succeeded.iter().map(Vec::len).sum();
    let independent = succeeded.len().max(worlds);
    match successes {
        _ if count <= 1 => None,
        _ if succeeded.len() == 1 => Some(wilson(successes, count)),
        0 => Some(wilson(0, independent)),
        _ if successes == count => Some(wilson(independent, independent)),
        _ => Some(bootstrap_rate(succeeded)),
    }
}

/// One line for each source of models and group of worlds, followed by one for each of its worlds where the campaign names several.
pub(super) fn transfer_rows(plan: &Plan, trials: &[((&str, &str), Vec<Trial>)]) -> Vec<TransferRow> {
    let mut rows = Vec::new();
    for group in trials.chunk_by(|((a, _), _), ((b, _), _)| a == b) {
        let Some(((name, _), _)) = group.first() else { continue };
        rows.extend(rows_of_group(name, "", group));
        let is_random = plan.transfers.iter().any(|planned| planned.random && planned.name == *name);
        if group.len() > 1 && !is_random {
            rows.extend(group.iter().flat_map(|of_world| {
                let ((_, world), _) = of_world;
                rows_of_group(name, world, std::slice::from_ref(of_world))
            }));
        }
    }
    rows
}

/// One line for each source of models. Every world has the same models, in the same order.
fn rows_of_group(transfer: &str, world: &str, worlds: &[((&str, &str), Vec<Trial>)]) -> Vec<TransferRow> {
    let Some((_, first)) = worlds.first() else { return Vec::new() };
    let models: Vec<usize> = (0..first.len()).collect();
    let source = |model: usize| (&first[model].scenario, &first[model].method);
    let row = |runs: &[usize]| {
        let trials = |model: usize| worlds.iter().filter_map(move |(_, trials)| trials.get(model));
        let succeeded: Vec<Vec<bool>> =
            runs.iter().map(|&run| trials(run).map(|trial| trial.violation == 0.0).collect()).collect();
        let count: usize = succeeded.iter().map(Vec::len).sum();
        let successes = succeeded.iter().flatten().filter(|&&success| success).count();
        let interval = interval(&succeeded);
        let f2 = |trial: &Trial| if trial.violation == 0.0 { trial.f2 } else { INFEASIBLE + trial.violation };
        let all: Vec<f64> = runs.iter().flat_map(|&run| trials(run)).map(f2).collect();
        let (from, method) = source(runs[0]);
        TransferRow {
            transfer: transfer.into(),
            world: world.into(),
            from: from.clone(),
            method: method.clone(),
            runs: runs.len(),
            worlds: worlds.len(),
            successes,
            rate: successes as f64 / count.max(1) as f64,
            low: interval.map(|ends| ends.0),
            high: interval.map(|ends| ends.1),
            median_f2: quartiles(&all).map_or(f64::NAN, |quartiles| quartiles.median),
        }
    };
    models.chunk_by(|&a, &b| source(a) == source(b)).map(row).collect()
}

/// The lines of all knees in all worlds, and those of each scenario and method: in the training worlds, then in those of each
/// transfer, all worlds of which come before each by itself where there are several.
pub(super) fn simulation_rows(
    plan: &Plan,
    simulate: &Simulate,
    simulations: &[Simulated],
) -> (Vec<SimulationRow>, Vec<SimulationSummary>) {
    let rows = simulations.iter().map(|simulated| simulation_row(plan, simulate, simulated)).collect();
    let mut summaries = Vec::new();
    // Runs come by scenario and method.
    for of_method in simulations.chunk_by(|((a, _), _), ((b, _), _)| (a.scenario, a.method) == (b.scenario, b.method)) {
        let Some(((unit, _), _)) = of_method.first() else { continue };
        let places = plan.simulated_in(unit.scenario);
        for group in places.chunk_by(|&a, &b| transfer_of(plan, a) == transfer_of(plan, b)) {
            summaries.push(simulation_summary(plan, simulate, of_method, group));
            if group.len() > 1 {
                let each = group.iter().map(std::slice::from_ref);
                summaries.extend(each.map(|place| SimulationSummary {
                    world: plan.world(place[0]).name().into(),
                    ..simulation_summary(plan, simulate, of_method, place)
                }));
            }
        }
    }
    (rows, summaries)
}

/// The name of the transfer that a world is of; empty for a training world.
fn transfer_of(plan: &Plan, place: Place) -> &str {
    match place {
        Place::Scenario(..) => "",
        Place::Transfer(transfer, _) => &plan.transfers[transfer].name,
    }
}

fn simulation_row(plan: &Plan, simulate: &Simulate, ((unit, place), realities): &Simulated) -> SimulationRow {
    let count = simulate.realities as usize;
    // A knee that cannot drive a robot works nowhere.
    let works = realities.iter().filter(|reality| reality.works).count();
    let (low, high) = wilson(works, count);
    let error = |reality: &Reality| reality.radial_error_share.unwrap_or(f64::INFINITY);
    let median = Robustness { realities: realities.clone() }.quantile(0.5, error);
    SimulationRow {
        scenario: plan.scenarios[unit.scenario].name.clone(),
        method: plan.methods[unit.method].name.clone(),
        seed: unit.seed,
        transfer: transfer_of(plan, *place).into(),
        world: plan.world(*place).name().into(),
        laboratory: simulate.lab.name.clone(),
        realities: count,
        works,
        rate: works as f64 / count as f64,
        low,
        high,
        caged: mean(realities, |reality| reality.caged_share).unwrap_or(0.0),
        cost: mean(realities, |reality| reality.cost),
        radial_error: median.filter(|error| error.is_finite()),
    }
}

/// The line of a scenario's method, whose simulations these are, in the worlds at these places, at least one.
fn simulation_summary(
    plan: &Plan,
    simulate: &Simulate,
    of_method: &[Simulated],
    places: &[Place],
) -> SimulationSummary {
    let count = simulate.realities as usize;
    // Of each knee the realities in every world.
    let knees: Vec<Vec<&[Reality]>> = of_method
        .chunk_by(|((a, _), _), ((b, _), _)| a == b)
        .map(|knee| {
            let here = knee.iter().filter(|((_, place), _)| places.contains(place));
            here.map(|(_, realities)| realities.as_slice()).collect()
        })
        .collect();
    let works = |realities: &[Reality]| match realities {
        [] => vec![false; count],
        realities => realities.iter().map(|reality| reality.works).collect(),
    };
    let succeeded: Vec<Vec<bool>> =
        knees.iter().map(|worlds| worlds.iter().flat_map(|realities| works(realities)).collect()).collect();
    let works = succeeded.iter().flatten().filter(|&&works| works).count();
    let interval = interval(&succeeded);
    let caged = |realities: &[Reality]| mean(realities, |reality| reality.caged_share).unwrap_or(0.0);
    let cost = |realities: &[Reality]| mean(realities, |reality| reality.cost).unwrap_or(WORST_COST);
    let (caged, worst_caged) = mean_and_worst(&knees, caged, f64::min);
    let (cost, worst_cost) = mean_and_worst(&knees, cost, f64::max);
    let (scenario, method) = of_method.first().map_or((0, 0), |((unit, _), _)| (unit.scenario, unit.method));
    SimulationSummary {
        scenario: plan.scenarios[scenario].name.clone(),
        method: plan.methods[method].name.clone(),
        transfer: transfer_of(plan, places[0]).into(),
        world: String::new(),
        laboratory: simulate.lab.name.clone(),
        runs: knees.len(),
        worlds: places.len(),
        realities: count,
        works,
        rate: works as f64 / succeeded.iter().map(Vec::len).sum::<usize>().max(1) as f64,
        low: interval.map(|ends| ends.0),
        high: interval.map(|ends| ends.1),
        caged,
        worst_caged,
        cost,
        worst_cost,
    }
}

/// The mean of a measure over knees and worlds, and over knees that of each in its worst world.
fn mean_and_worst(
    knees: &[Vec<&[Reality]>],
    measure: impl Fn(&[Reality]) -> f64,
    worse: impl Fn(f64, f64) -> f64,
) -> (f64, f64) {
    let of_worlds = |worlds: &Vec<&[Reality]>| -> (f64, f64) {
        let values: Vec<f64> = worlds.iter().map(|realities| measure(realities)).collect();
        let worst = values.iter().copied().reduce(&worse).unwrap_or(f64::NAN);
        (values.iter().sum::<f64>() / values.len() as f64, worst)
    };
    let all: Vec<(f64, f64)> = knees.iter().map(of_worlds).collect();
    let over_knees = |part: fn(&(f64, f64)) -> f64| all.iter().map(part).sum::<f64>() / all.len() as f64;
    (over_knees(|(mean, _)| *mean), over_knees(|(_, worst)| *worst))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_tell_what_was_sampled() {
        assert_eq!(interval(&[vec![true]]), None, "one trial tells of no spread");
        let (low, high) = interval(&[vec![true, false, true, true]]).unwrap();
        assert!(low < 0.75 && 0.75 < high);
        let (low, high) = interval(&vec![vec![false; 200]; 30]).unwrap();
        assert!(low == 0.0 && (0.015..0.02).contains(&high), "30 runs of 200 worlds are not 6000 trials: {high}");
        let (low, high) = interval(&vec![vec![true]; 30]).unwrap();
        assert!((0.88..0.89).contains(&low) && high == 1.0, "{low}");
        let (low, high) = interval(&[vec![true, false], vec![true, true], vec![false, false]]).unwrap();
        assert!(low < 0.5 && 0.5 < high);
    }
}
