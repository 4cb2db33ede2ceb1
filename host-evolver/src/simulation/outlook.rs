//! What cannot work, known before anything is simulated.

use core::f64::consts::{PI, TAU};
use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::{Scenario, Scene};
use grn_core::robot::epuck2::BODY_RADIUS;

/// How many moments of the targets' way are looked at.
const MOMENTS: u32 = 200;

/// Reasons why a swarm with this configuration cannot cage the targets of this world, whatever runs on it; each a sentence with its
/// way out.
pub fn doubts(scenario: &Scenario, config: &SwarmConfig) -> Vec<String> {
    let world = scenario.scaled(config.scale);
    let (ring, robots, scale) = (world.ring(), config.lab.robots.count, config.scale);
    let middle = (ring.d_min + ring.d_max) / 2.0;
    let spacing = TAU * middle / robots as f64;
    let range = config.lab.radio.range_m;
    let mut doubts = Vec::new();
    if spacing > range && robots > 1 {
        let enough = (TAU * middle / range).ceil();
        doubts.push(format!(
            "robots on the ring will not hear each other: {robots} of them are {spacing:.2} m apart, and radio.range_m is {range}; \
             take at least {enough} robots, a scale of at most {:.2}, or a longer range",
            scale * range / spacing
        ));
    }
    let most = (TAU * ring.d_max / (2.0 * BODY_RADIUS)).floor();
    if robots as f64 > most {
        doubts.push(format!(
            "{robots} robots find no room on the ring: its longest one, of {:.2} m, holds {most} bodies; take fewer robots or a larger \
             scale",
            TAU * ring.d_max
        ));
    }
    if let Some((clearance, target)) = narrowest(&world)
        && clearance < BODY_RADIUS
    {
        doubts.push(format!(
            "no robot passes between target {} and a wall where they are {clearance:.3} m apart: a body is {:.2} m across; take a scale \
             of at least {:.2}",
            target + 1,
            2.0 * BODY_RADIUS,
            scale * BODY_RADIUS / clearance.max(f64::MIN_POSITIVE)
        ));
    }
    // Gaps between discs of d_max / 4 let a target through.
    let shut = PI / libm::asin((ring.d_max / 4.0 / ring.d_min).min(1.0));
    if (robots as f64) < shut.floor() && world.fixed_walls().is_empty() && !world.walls_change() {
        doubts.push(format!(
            "{robots} robots leave gaps in every ring from d_min to d_max, and a target leaves through them: take at least {}",
            shut.floor()
        ));
    }
    doubts
}

/// Where a target comes nearest to a wall: how near, metres, and which target.
fn narrowest(world: &Scenario) -> Option<(f64, usize)> {
    let at = |moment: u32| Scene::of(world, f64::from(moment) / f64::from(MOMENTS));
    let of_scene = |scene: Scene| {
        let targets: Vec<_> = scene.targets().to_vec();
        let near = |(number, place)| (scene.walls().signed_distance(place), number);
        let there = targets.into_iter().enumerate().filter_map(|(number, place)| Some((number, place?)));
        there.map(near).min_by(|a, b| a.0.total_cmp(&b.0))
    };
    (0..=MOMENTS).map(at).filter_map(of_scene).min_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use firmware_sim::lab::Laboratory;

    fn scenario(name: &str) -> Scenario {
        Scenario::load(format!("{}/../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
    }

    fn told(name: &str, robots: usize, scale: f64) -> Vec<String> {
        let config = SwarmConfig { scale, lab: Laboratory::default(), ..SwarmConfig::default() };
        doubts(&scenario(name), &config.with_robots(robots))
    }

    #[test]
    fn what_works_raises_no_doubt() {
        assert_eq!(told("channel", 12, 0.25), Vec::<String>::new());
        assert_eq!(told("open", 20, 0.5), Vec::<String>::new());
    }

    #[test]
    fn what_cannot_work_is_told_with_a_way_out() {
        let sparse = told("channel", 12, 1.0);
        assert_eq!(sparse.len(), 1);
        assert!(sparse[0].contains("0.79 m apart") && sparse[0].contains("at least 14 robots"), "{}", sparse[0]);
        assert_eq!(told("channel", 14, 1.0), Vec::<String>::new(), "the way out leads out");
        let full = told("open", 60, 0.25);
        assert!(full[0].contains("60 robots") && full[0].contains("holds 44 bodies"), "{}", full[0]);
        let few = told("open", 3, 0.25);
        assert!(few.last().is_some_and(|few| few.contains("leave gaps")), "{few:?}");
        let small = told("compound-channel", 12, 0.015);
        assert!(small.iter().any(|doubt| doubt.contains("no robot passes")), "{small:?}");
    }
}
