//! What cannot work, known before anything is simulated.

use core::f64::consts::{PI, TAU};
use firmware_sim::config::SwarmConfig;
use firmware_sim::geometry::Walls;
use firmware_sim::scenario::{Scenario, Scene};
use grn_core::geometry::Point;
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
    // Several targets have a ring each.
    if robots as f64 > most * world.targets().len() as f64 {
        doubts.push(format!(
            "{robots} robots find no room on the ring: its longest one, of {:.2} m, holds {most} bodies; take fewer robots or a larger \
             scale",
            TAU * ring.d_max
        ));
    }
    let body = 2.0 * BODY_RADIUS;
    if let Some((width, target)) = narrowest(&world)
        && width < body
    {
        doubts.push(format!(
            "target {} goes through a passage {width:.3} m wide, where no robot can follow: a body is {body:.2} m across; take a scale of \
             at least {:.2}",
            target + 1,
            scale * body / width.max(f64::MIN_POSITIVE)
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

/// The narrowest passage between walls that a target goes through: how wide, metres, and which target.
fn narrowest(world: &Scenario) -> Option<(f64, usize)> {
    let at = |moment: u32| Scene::of(world, f64::from(moment) / f64::from(MOMENTS));
    let of_scene = |scene: Scene| {
        let width = |(number, place): (usize, &Option<Point<f64>>)| Some((width_at(scene.walls(), (*place)?)?, number));
        scene.targets().iter().enumerate().filter_map(width).min_by(|a, b| a.0.total_cmp(&b.0))
    };
    (0..=MOMENTS).map(at).filter_map(of_scene).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// How wide it is from the nearest wall across this place to the wall on the other side, if there is one near enough to matter.
fn width_at(walls: &Walls, place: Point<f64>) -> Option<f64> {
    let (nearest, _) = walls.nearest_boundary(place)?;
    let from_wall = place - nearest;
    Some(from_wall.length() + walls.ray(place, from_wall.direction()?, 2.0 * BODY_RADIUS)?)
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
        // A passage of 1.6 m, and robots of 7 cm.
        let small = told("adaptive/narrow", 12, 0.04);
        assert!(
            small.iter().any(|doubt| doubt.contains("0.064 m wide") && doubt.contains("at least 0.04")),
            "{small:?}"
        );
        assert!(!told("adaptive/narrow", 12, 0.044).iter().any(|doubt| doubt.contains("wide")));
        assert!(
            !told("adaptive/corner", 12, 0.04).iter().any(|doubt| doubt.contains("wide")),
            "one wall is no passage"
        );
    }
}
