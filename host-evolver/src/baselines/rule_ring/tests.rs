//! The rules in closed loop.

use super::*;
use crate::simulation::usual_config;
use firmware_sim::lab::Laboratory;

fn scenario(name: &str) -> Scenario {
    Scenario::load(format!("{}/../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// The rules on the usual twelve robots at the usual scale.
fn simulated(name: &str, seed: u64) -> Simulation {
    let config = SwarmConfig { seed, ..usual_config(0.25, Laboratory::default()) };
    simulate(&scenario(name), config, &mut (), |_| ControlFlow::Continue(())).unwrap().unwrap()
}

#[test]
fn in_the_open_the_robots_form_a_ring_and_keep_it() {
    for seed in 1..=3 {
        let simulation = simulated("open", seed);
        let caging = &simulation.caging;
        assert!(simulation.verdict().works(), "seed {seed}: {caging:?}");
        assert!(caging.in_band_share > 0.95 && caging.contact_share < 0.001, "seed {seed}: {caging:?}");
        let error = simulation.radial_error_share().unwrap();
        assert!(error < 0.05, "seed {seed}: off the ring by {error} of its radius");
    }
}

#[test]
fn between_walls_the_robots_keep_clear_and_come_along() {
    // Walls beside the ring, columns in its place, and a corridor that it does not fit in.
    for (name, caged, lost) in [("channel", 0.9, 0), ("adaptive/columns", 0.8, 1), ("adaptive/tight", 0.9, 1)] {
        let simulation = simulated(name, 1);
        let caging = &simulation.caging;
        assert!(caging.caged_share > caged, "{name}: {caging:?}");
        assert!(caging.contact_share < 0.01, "{name}: {caging:?}");
        assert!(simulation.metrics.lost_robots <= lost, "{name}: {} lost", simulation.metrics.lost_robots);
    }
    // A corridor too narrow for two rows: nobody jams in its mouth.
    let simulation = simulated("adaptive/narrow", 1);
    assert!(simulation.metrics.lost_robots <= 1 && simulation.caging.contact_share < 0.01, "{:?}", simulation.caging);
}

#[test]
fn the_same_seed_gives_the_same_run_whatever_the_threads() {
    let scenario = scenario("adaptive/tight");
    let config = usual_config(0.25, Laboratory::default());
    let stop = AtomicBool::new(false);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| try_all(&scenario, &config, 1..=2, &stop)).unwrap().unwrap()
    };
    let (one, two) = (on(1), on(2));
    assert_eq!(one, two);
    assert_ne!(one.realities[0].cost, one.realities[1].cost, "realities differ");
    stop.store(true, Ordering::Relaxed);
    assert!(try_all(&scenario, &config, 1..=2, &stop).unwrap().is_none());
}
