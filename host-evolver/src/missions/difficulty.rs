//! How much a world rewards a pattern that adapts.
//!
//! Two designers who know the whole world draw a pattern for it. One draws the same circle around every target at every moment. The
//! other draws around every target at every moment a closed pattern that is star-shaped as seen from it: on each ray from the target
//! the point with the least error. Both keep [`SMALLEST_CLEARANCE`] from walls, and no wall is inside what they draw. f2 takes points
//! at equal arc length, so that of a pattern is the mean of the error along it. The difference is what there is to gain.

use crate::evaluation::{CANDIDATES_PER_RING, SMALLEST_CLEARANCE, Terms};
use core::f64::consts::TAU;
use firmware_sim::geometry::Walls;
use firmware_sim::scenario::Scenario;
use grn_core::geometry::{Point, Vector};

/// Radii that are tried are so far apart, metres.
const STEP: f64 = 0.02;
/// The largest one, beyond the ring's d_max, metres.
const BEYOND: f64 = 0.5;
/// For rounding: walls that are drawn at the clearance itself do not count as too near.
const SLACK: f64 = 1e-9;

/// What the two designers achieve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difficulty {
    /// The best circle's radius, metres.
    pub circle_radius: f64,
    /// Its f2, in [0, 2].
    pub circle_f2: f64,
    /// f2 of the best star-shaped pattern, at most `circle_f2`.
    pub star_f2: f64,
}

impl Difficulty {
    /// The difficulty of a world; `None` if there is no room for any circle.
    ///
    /// f2 is taken as of the nearest target, since a circle around each of several targets is what is wanted of it; with a single
    /// target that is the paper's f2.
    pub fn of(scenario: &Scenario) -> Option<Difficulty> {
        let terms = Terms::of(scenario.ring());
        let radii = ((scenario.ring().d_max + BEYOND) / STEP) as usize;
        let mut circles = vec![0.0; radii];
        let (mut room, mut star, mut rings) = (radii, 0.0, 0.0);
        for time in scenario.snapshot_times() {
            let (targets, walls) = (scenario.targets_at(time), scenario.walls_at(time));
            let moment = Moment { obstacles: Scenario::obstacle_points(&walls, &targets), targets, walls };
            for &target in &moment.targets {
                let farthest = moment.walls.signed_distance(target) - SMALLEST_CLEARANCE + SLACK;
                room = (0..room).take_while(|&step| radius(step) <= farthest).count();
                if room == 0 {
                    return None;
                }
                let near = moment.around(target, radius(radii) + terms.obstacle.reach());
                let mut ring = Vec::with_capacity(CANDIDATES_PER_RING);
                for ray in 0..CANDIDATES_PER_RING {
                    let (sin, cos) = libm::sincos(TAU * ray as f64 / CANDIDATES_PER_RING as f64);
                    let places = (0..radii).map(|step| target + Vector::new(cos, sin) * radius(step));
                    let mut best = (f64::INFINITY, target);
                    // No wall is nearer to the target than this.
                    let mut free = farthest;
                    for ((circle, place), radius) in circles.iter_mut().zip(places).zip((0..radii).map(radius)) {
                        if radius > free {
                            free = radius + moment.walls.signed_distance(place) - SMALLEST_CLEARANCE + SLACK;
                        }
                        if radius > free {
                            break;
                        }
                        let error = moment.error(place, &near, &terms);
                        *circle += error;
                        if error < best.0 {
                            best = (error, place);
                        }
                    }
                    ring.push(best);
                }
                star += moment.mean_along(&ring, &near, &terms);
                rings += 1.0;
            }
        }
        let circles = circles.into_iter().take(room).enumerate();
        let (step, sum) = circles.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let circle_f2 = sum / (rings * CANDIDATES_PER_RING as f64);
        // Circles are star-shaped, too.
        Some(Difficulty { circle_radius: radius(step), circle_f2, star_f2: (star / rings).min(circle_f2) })
    }

    /// By how much the f2 of the star is less than that of the circle.
    pub fn gain(&self) -> f64 {
        self.circle_f2 - self.star_f2
    }
}

fn radius(step: usize) -> f64 {
    (step + 1) as f64 * STEP
}

/// A world at one instant.
struct Moment {
    targets: Vec<Point<f64>>,
    walls: Walls,
    obstacles: Vec<Point<f64>>,
}

impl Moment {
    /// The obstacle points that are not farther from a point than this.
    fn around(&self, point: Point<f64>, distance: f64) -> Vec<Point<f64>> {
        let is_near = |other: &Point<f64>| (*other - point).dot(*other - point) <= distance * distance;
        self.obstacles.iter().copied().filter(is_near).collect()
    }

    /// The pattern error of a point, from which all obstacle points that matter are among those that are `near`.
    fn error(&self, point: Point<f64>, near: &[Point<f64>], terms: &Terms) -> f64 {
        let squared = |&other: &Point<f64>| (point - other).dot(point - other);
        let nearest = self.targets.iter().map(squared).fold(f64::INFINITY, f64::min);
        let to_obstacles: f64 = near.iter().map(|obstacle| terms.obstacle.at(squared(obstacle))).sum();
        terms.target.at(nearest) + to_obstacles / self.obstacles.len().max(1) as f64
    }

    /// The mean error along the closed line through points whose errors are known, by Simpson's rule between neighbours.
    fn mean_along(&self, ring: &[(f64, Point<f64>)], near: &[Point<f64>], terms: &Terms) -> f64 {
        let (mut sum, mut whole) = (0.0, 0.0);
        for (place, &(error, here)) in ring.iter().enumerate() {
            let (next_error, next) = ring[(place + 1) % ring.len()];
            let length = (next - here).length();
            let middle = self.error((here + next) * 0.5, near, terms);
            sum += length * (error + 4.0 * middle + next_error) / 6.0;
            whole += length;
        }
        sum / whole
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shipped(name: &str) -> Scenario {
        Scenario::load(format!("{}/../scenarios/adaptive/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
    }

    #[test]
    fn the_shipped_worlds_are_as_difficult_as_an_independent_program_found_them() {
        // Another program, with other radii and other points. It went another way from ray to ray where the best radius jumps, which it does
        // most in the corner.
        const NEAR: [f64; 2] = [0.05, 0.125];
        let expected = [
            ("narrow", 1.116, 0.323),
            ("tight", 0.342, 0.173),
            ("hourglass", 0.995, 0.098),
            ("doorway", 0.999, 0.104),
            ("columns", 1.229, 0.297),
            ("corner", 1.277, 0.342),
        ];
        let found = expected.map(|(name, ..)| Difficulty::of(&shipped(name)).unwrap());
        let near = |found: f64, expected: f64, share: f64| (found - expected).abs() <= share * expected;
        let good = expected.iter().zip(&found).all(|(&(_, circle, star), found)| {
            near(found.circle_f2, circle, NEAR[0]) && near(found.star_f2, star, NEAR[1])
        });
        assert!(good, "{expected:?}\n{found:?}");
    }

    #[test]
    fn moving_worlds_reward_adaptation_and_open_country_does_not() {
        for name in ["sliding-door", "sweeping-bar", "drifting-disc"] {
            let found = Difficulty::of(&shipped(name)).unwrap();
            assert!(found.gain() > 0.5 && found.circle_radius < 0.8, "{name}: {found:?}");
        }
        let open = Scenario::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/open.toml")).unwrap();
        let found = Difficulty::of(&open).unwrap();
        assert!(found.gain() < 1e-3 && (found.circle_radius - 1.5).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn without_room_there_is_no_circle() {
        let text = shipped("narrow").to_toml().replace("9.8]", "9.05]");
        assert_eq!(Difficulty::of(&Scenario::parse(&text).unwrap()), None);
    }
}
