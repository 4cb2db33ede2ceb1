//! The objective's fast contours against plain marching squares on a 0.05 m grid.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::config::SwarmConfig;
use firmware_sim::geometry::{Bounds, nearest_on_segment};
use firmware_sim::scenario::Scenario;
use grn_core::geometry::{Point, Vector};
use host_evolver::evaluation::{Contours, Evaluator, Model, Snapshot, Tracer, World};
use host_evolver::evolve::{Advance, Search, Settings, Task};
use host_evolver::model::published::PUBLISHED;
use plain::Plain;
use std::sync::atomic::AtomicBool;

#[path = "../../host-evolver/benches/plain/mod.rs"]
mod plain;

/// Largest distance of either contour's points from the other contour, metres.
const FARTHEST: f64 = 0.02;
/// The same for random trees in the compound channel, where a contour may turn sharply between two walls: a corner
/// there is cut by up to this much.
const FARTHEST_AT_SHARP_CORNERS: f64 = 0.05;
/// Largest difference between f2 on the fast and on the plain contour.
const F2_TOLERANCE: f64 = 0.01;
/// Spacings of the plain grid, metres; the finer ones only where the coarser shows another topology.
const STEPS: [f64; 3] = [0.05, 0.025, 0.0125];

fn worlds() -> [World; 3] {
    ["channel", "channel-two-targets", "compound-channel"].map(|name| {
        let path = format!("{}/../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        World::new(Scenario::load(path).unwrap())
    })
}

/// The printed models and the individuals of a search's first generation.
fn models(world: &World) -> Vec<(String, Model)> {
    let settings = Settings { seed: 5, population: 32, evaluations: 32 * 20, ..Settings::default() };
    let task = Task::in_one(world.scenario().clone(), SwarmConfig::default());
    let mut search = Search::new(&task, settings, None).unwrap();
    assert_eq!(search.advance(&AtomicBool::new(false), &|_| {}), Advance::Generation);
    let printed = PUBLISHED.iter().map(|published| (published.name.to_owned(), published.network().unwrap()));
    let trees = search.state().population.iter().map(|individual| &individual.tree);
    let networks = printed.chain(trees.map(|tree| (tree.to_string(), tree.network(1.0).unwrap())));
    networks.filter_map(|(name, network)| Some((name, Model::new(&network, 0.5).ok()?))).collect()
}

fn plain_pattern(world: &World, model: &Model, snapshot: &Snapshot, step: f64) -> Plain {
    let near = Bounds::around(snapshot.targets.iter().copied()).unwrap();
    let margin = Vector::new(3.5, 3.5);
    let pattern = plain::trace(world, model, snapshot, [near.low - margin, near.high + margin], step);
    if !pattern.cut_off {
        return pattern;
    }
    let [width, height] = world.scenario().region();
    plain::trace(world, model, snapshot, [Vector::new(-5.0, -5.0), Vector::new(width + 5.0, height + 5.0)], step)
}

fn same_topology(fast: &Contours, plain: &Plain) -> bool {
    fast.enclosed == plain.enclosed && fast.rings.len() == plain.rings.len()
}

fn distance_to(rings: &[Vec<Point<f64>>], point: Point<f64>) -> f64 {
    let segments = rings.iter().flat_map(|ring| (0..ring.len()).map(move |i| (ring[i], ring[(i + 1) % ring.len()])));
    segments.map(|(a, b)| (nearest_on_segment(a, b, point) - point).length()).fold(f64::INFINITY, f64::min)
}

fn allowed(world: &World, name: &str) -> f64 {
    let printed = PUBLISHED.iter().any(|published| published.name == name);
    if world.scenario().name() == "compound-channel" && !printed { FARTHEST_AT_SHARP_CORNERS } else { FARTHEST }
}

fn farthest(from: &[Vec<Point<f64>>], to: &[Vec<Point<f64>>]) -> f64 {
    from.iter().flatten().map(|&point| distance_to(to, point)).fold(0.0, f64::max)
}

#[test]
fn fast_contours_are_the_plain_ones() {
    let (mut largest, mut largest_f2, mut finer, mut faults) = (0.0_f64, 0.0_f64, 0, Vec::new());
    for world in &worlds() {
        let models = models(world);
        assert!(models.len() >= 25, "only {} models", models.len());
        let mut tracer = Tracer::new(world);
        for (name, model) in &models {
            let mut f2 = 0.0;
            for (index, (snapshot, fast)) in tracer.trace_all(model).enumerate() {
                let place = format!("{name} in {} at {index}", world.scenario().name());
                let patterns = STEPS.iter().map(|&step| plain_pattern(world, model, snapshot, step)).enumerate();
                let mut patterns = patterns.skip_while(|(_, plain)| !same_topology(&fast, plain));
                let Some((level, plain)) = patterns.next() else {
                    eprintln!("{place}: {} rings, {:?}", fast.rings.len(), fast.enclosed);
                    faults.push(format!("{place}: {} rings, {:?}", fast.rings.len(), fast.enclosed));
                    continue;
                };
                finer += usize::from(level > 0);
                f2 += plain::evaluate(world, snapshot, &plain)[0];
                let apart = farthest(&fast.rings, &plain.rings).max(farthest(&plain.rings, &fast.rings));
                if apart > allowed(world, name) {
                    faults.push(format!("{place}: {apart:.4} m apart"));
                }
                largest = largest.max(apart);
            }
            let difference = (f2 / world.snapshots().len() as f64 - Evaluator::new(world).evaluate(model).f2).abs();
            largest_f2 = largest_f2.max(difference);
            if difference > F2_TOLERANCE {
                faults.push(format!("{name} in {}: f2 off by {difference}", world.scenario().name()));
            }
        }
    }
    println!("largest distance {largest:.4} m, largest difference of f2 {largest_f2:.5}, finer grids {finer}");
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn an_evaluation_depends_on_nothing_but_the_model() {
    for world in &worlds() {
        let models = models(world);
        let mut kept = Evaluator::new(world);
        let forward: Vec<_> = models.iter().map(|(_, model)| kept.evaluate(model)).collect();
        for (place, (name, model)) in models.iter().enumerate().rev() {
            assert_eq!(kept.evaluate(model), forward[place], "{name} evaluated again");
            assert_eq!(Evaluator::new(world).evaluate(model), forward[place], "{name} evaluated afresh");
        }
    }
}
