//! The paper's printed models against reference numbers made by an independent double-precision program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::scenario::Scenario;
use grn_core::field::{Field, Kernel};
use grn_core::network::Network;
use grn_core::pattern::Pattern;
use grn_core::scalar::Scalar;
use host_evolver::evaluation::{Model, Tracer, World};
use host_evolver::model::published::PUBLISHED;
use serde_json::Value;

fn golden() -> Value {
    serde_json::from_str(include_str!("../golden/published-models.json")).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn levels_agree<S: Scalar>(network: &Network<f32>, expected: &Value, tolerance: f64) {
    let network = network.cast::<S>();
    let m = |x1| network.steady_state(x1, S::ZERO).to_f64();
    let level = Pattern::of(&network, S::from_f32(0.5)).unwrap().level().to_f64();
    for (key, got) in [("M00", m(S::ZERO)), ("M10", m(S::ONE)), ("level", level)] {
        let error = (got - number(&expected[key])).abs();
        assert!(error < tolerance, "{} {key}: off by {error:e}", S::NAME);
    }
}

#[test]
fn levels_and_radii() {
    for model in &PUBLISHED {
        let expected = &golden()["models"][model.name];
        let network = model.network().unwrap();
        levels_agree::<f64>(&network, expected, 1e-6);
        levels_agree::<f32>(&network, expected, 2e-6);
        levels_agree::<grn_core::scalar::Q8_24>(&network, expected, 2e-6);
        let model = Model::new(&network, 0.5).unwrap();
        let field = Field::new(Kernel::Gaussian, 1.5, 0.9);
        let radius = model.pattern().free_space_radius(model.network(), &field).unwrap();
        let error = radius - number(&expected["free_space_radius_m"]);
        assert!(error.abs() < 0.01, "free-space radius off by {error}");
    }
}

#[test]
fn patterns_in_every_scenario() {
    for scenario in ["channel", "channel-two-targets", "compound-channel"] {
        let path = format!("{}/../scenarios/{scenario}.toml", env!("CARGO_MANIFEST_DIR"));
        let world = World::new(Scenario::load(path).unwrap());
        for model in &PUBLISHED {
            let expected = &golden()["models"][model.name]["scenarios"][scenario];
            pattern_agrees(&world, &Model::new(&model.network().unwrap(), 0.5).unwrap(), expected, model.name);
        }
    }
}

fn pattern_agrees(world: &World, model: &Model, expected: &Value, name: &str) {
    let mut tracer = Tracer::new(world);
    let (mut lost, mut rings) = (Vec::new(), Vec::new());
    let (mut radius_min, mut radius_max, mut clearance_min) = (f64::INFINITY, 0.0_f64, f64::INFINITY);
    for (index, (snapshot, contours)) in tracer.trace_all(model).enumerate() {
        rings.push(contours.rings.len() as u64);
        if contours.enclosed.contains(&false) {
            lost.push(index as u64);
        }
        for &point in contours.rings.iter().flatten() {
            let radius = snapshot.targets.iter().map(|&t| (point - t).length()).fold(f64::INFINITY, f64::min);
            radius_min = radius_min.min(radius);
            radius_max = radius_max.max(radius);
            clearance_min = clearance_min.min(snapshot.walls().signed_distance(point));
        }
    }
    let list =
        |key: &str| -> Vec<u64> { expected[key].as_array().unwrap().iter().map(|v| v.as_u64().unwrap()).collect() };
    let place = format!("{name} in {}", world.scenario().name());
    assert_eq!(lost, list("not_enclosed_at"), "{place}: snapshots that leak");
    assert_eq!(rings, list("rings"), "{place}: rings");
    for (key, got) in [("radius_min_m", radius_min), ("radius_max_m", radius_max), ("clearance_min_m", clearance_min)] {
        let error = got - number(&expected[key]);
        println!("{place}: {key} {got:.4}, off by {error:+.4}");
        assert!(error.abs() < 0.05, "{place}: {key} is {got}, off by {error}");
    }
}
