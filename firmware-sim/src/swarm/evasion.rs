//! Targets that leave their paths for robots.

use crate::scenario::{Evasion, Scenario, Scene};
use grn_core::geometry::{Point, Vector};

/// By target how far it is from where its path has it, metres.
#[derive(Debug)]
pub(super) struct Evasions(Vec<Vector<f64>>);

impl Evasions {
    /// All targets on their paths.
    pub fn new(targets: usize) -> Self {
        Evasions(vec![Vector::ZERO; targets])
    }

    /// Lets the targets of a scene evade robots, which are at these places, for one frame, in which a target goes `step` metres at the
    /// speed that the run gives its targets. A target that is not there begins on its path when it comes again.
    pub fn step(&mut self, world: &Scenario, scene: &mut Scene, robots: &[Point<f64>], step: f64) {
        for (number, (target, offset)) in world.targets().iter().zip(&mut self.0).enumerate() {
            let Some(evasion) = target.evasion() else { continue };
            let Some(on_path) = target.at(scene.time()) else {
                *offset = Vector::ZERO;
                continue;
            };
            *offset = evaded(&evasion, *offset, on_path, robots, step * evasion.speed);
            scene.put_target(number, on_path + *offset);
        }
    }
}

/// Where a target goes from its offset, at most `step` metres: away from the robots that are near, or else back to its path.
fn evaded(
    evasion: &Evasion,
    offset: Vector<f64>,
    on_path: Point<f64>,
    robots: &[Point<f64>],
    step: f64,
) -> Vector<f64> {
    let here = on_path + offset;
    let mut away = Vector::ZERO;
    let mut is_near = false;
    for &robot in robots {
        let from_robot = here - robot;
        let distance = from_robot.length();
        if distance < evasion.distance {
            is_near = true;
            // The nearer the more; those on opposite sides hold it in its place.
            let urgency = 1.0 - distance / evasion.distance;
            away = away + from_robot.direction().unwrap_or(Vector::ZERO) * urgency;
        }
    }
    if !is_near {
        return offset * (1.0 - step / offset.length().max(step));
    }
    let wanted = offset + away * (step / away.length().max(1.0));
    // Coming back onto the edge of what it can reach makes no step longer.
    wanted * (evasion.reach / wanted.length().max(evasion.reach))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVASION: Evasion = Evasion { distance: 1.0, reach: 0.3, speed: 1.0 };

    /// Its offset after so many steps of 1 cm on a path that rests at the origin.
    fn after(steps: u32, from: [f64; 2], robots: &[Point<f64>]) -> Vector<f64> {
        let start = Vector::new(from[0], from[1]);
        (0..steps).fold(start, |offset, _| evaded(&EVASION, offset, Vector::ZERO, robots, 0.01))
    }

    #[test]
    fn it_goes_as_far_as_it_may_and_back_when_it_is_alone() {
        let chased = after(500, [0.0, 0.0], &[Vector::new(-0.4, 0.0)]);
        assert!((chased - Vector::new(0.3, 0.0)).length() < 1e-9, "{chased:?}");
        let far = [Vector::new(-5.0, 0.0)];
        assert!((after(10, [0.3, 0.0], &far) - Vector::new(0.2, 0.0)).length() < 1e-12);
        assert_eq!(after(31, [0.3, 0.0], &far), Vector::ZERO);
        assert_eq!(after(1, [0.0, 0.0], &far), Vector::ZERO);
        // Who surrounds it holds it, and who stands on it does not make it vanish.
        let around = [[0.5, 0.0], [-0.5, 0.0], [0.0, 0.5], [0.0, -0.5]].map(|[x, y]| Vector::new(x, y));
        assert_eq!(after(100, [0.0, 0.0], &around), Vector::ZERO);
        assert_eq!(after(1, [0.1, 0.0], &[Vector::new(0.1, 0.0)]), Vector::new(0.1, 0.0));
    }
}
