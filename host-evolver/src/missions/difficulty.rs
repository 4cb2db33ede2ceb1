//! How much a world rewards a pattern that adapts.
//!
//! Two designers who know the whole world draw a pattern for it. One draws the same circle around every target at every moment. The
//! other draws around every target at every moment the best pattern that is star-shaped as seen from it, and closed. Both keep
//! [`SMALLEST_CLEARANCE`] from walls, and no wall is inside what they draw. The difference of their f2 is what there is to gain.

use crate::evaluation::{CANDIDATES_PER_RING, SMALLEST_CLEARANCE};
use core::f64::consts::TAU;
use firmware_sim::geometry::Walls;
use firmware_sim::scenario::{Ring, Scenario};
use grn_core::geometry::{Point, Vector};

/// Radii that are tried are so far apart, metres.
const STEP: f64 = 0.01;
/// The largest one, beyond the ring's d_max, metres.
const BEYOND: f64 = 0.5;
/// Squared distances for which a term is tabulated are so far apart, square metres: interpolated terms are off by less than 1e-5.
const TABLE_STEP: f64 = 0.002;
/// At this many multiples of 1 / k beyond its threshold a sigmoid is 0 or 1.
const SATURATED: f64 = 20.0;
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
    /// target that is the paper's f2. It is the mean of the points on 48 rays from each target.
    pub fn of(scenario: &Scenario) -> Option<Difficulty> {
        let terms = Terms::of(scenario.ring());
        let radii = ((scenario.ring().d_max + BEYOND) / STEP) as usize;
        let mut circles = vec![0.0; radii];
        let (mut room, mut star, mut rays) = (radii, 0.0, 0.0);
        for time in scenario.snapshot_times() {
            let (targets, walls) = (scenario.targets_at(time), scenario.walls_at(time));
            let moment = Moment { obstacles: Scenario::obstacle_points(&walls, &targets), targets, walls };
            for &target in &moment.targets {
                for ray in 0..CANDIDATES_PER_RING {
                    let (sin, cos) = libm::sincos(TAU * ray as f64 / CANDIDATES_PER_RING as f64);
                    let way = Vector::new(cos, sin);
                    let errors = (0..radii).map(|step| moment.error(target + way * radius(step), &terms));
                    let (mut reached, mut best) = (0, f64::INFINITY);
                    for (circle, error) in circles.iter_mut().zip(errors.map_while(|error| error)) {
                        *circle += error;
                        best = best.min(error);
                        reached += 1;
                    }
                    room = room.min(reached);
                    star += best;
                    rays += 1.0;
                }
            }
        }
        let circles = circles.into_iter().take(room).enumerate();
        let (step, sum) = circles.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Difficulty { circle_radius: radius(step), circle_f2: sum / rays, star_f2: star / rays })
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
    /// The pattern error of a point; `None` if a wall is too near.
    fn error(&self, point: Point<f64>, terms: &Terms) -> Option<f64> {
        if self.walls.signed_distance(point) < SMALLEST_CLEARANCE - SLACK {
            return None;
        }
        let squared = |&other: &Point<f64>| (point - other).dot(point - other);
        let nearest = self.targets.iter().map(squared).fold(f64::INFINITY, f64::min);
        let to_obstacles: f64 = self.obstacles.iter().map(|obstacle| terms.obstacle.at(squared(obstacle))).sum();
        Some(terms.target.at(nearest) + to_obstacles / self.obstacles.len().max(1) as f64)
    }
}

/// The terms of f2 (model page, section 4), tabulated over squared distances.
struct Terms {
    target: Table,
    obstacle: Table,
}

impl Terms {
    fn of(ring: Ring) -> Terms {
        let Ring { d_min, d_max, d_obstacle, steepness } = ring;
        let sigmoid = |beyond: f64| 1.0 / (1.0 + libm::exp(-steepness * beyond));
        let saturated = SATURATED / steepness;
        Terms {
            target: Table::of(d_max + saturated, |d| sigmoid(d - d_max) + sigmoid(d_min - d)),
            obstacle: Table::of(d_obstacle + saturated, |d| sigmoid(d_obstacle - d)),
        }
    }
}

/// A function of a distance that is constant beyond the last one in the table.
struct Table(Vec<f64>);

impl Table {
    fn of(farthest: f64, function: impl Fn(f64) -> f64) -> Table {
        let entries = (farthest * farthest / TABLE_STEP) as usize + 2;
        Table((0..entries).map(|entry| function((entry as f64 * TABLE_STEP).sqrt())).collect())
    }

    fn at(&self, squared: f64) -> f64 {
        let place = squared * (1.0 / TABLE_STEP);
        let entry = (place as usize).min(self.0.len() - 2);
        let share = (place - entry as f64).min(1.0);
        self.0[entry] + (self.0[entry + 1] - self.0[entry]) * share
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
        // Another program, with other radii and another way of following the outlines.
        for (name, circle, star) in [
            ("narrow", 1.116, 0.323),
            ("tight", 0.342, 0.173),
            ("hourglass", 0.995, 0.098),
            ("doorway", 0.999, 0.104),
            ("columns", 1.229, 0.297),
            ("corner", 1.277, 0.342),
        ] {
            let found = Difficulty::of(&shipped(name)).unwrap();
            let near = |found: f64, expected: f64| (found - expected).abs() <= 0.02 * expected + 0.003;
            assert!(near(found.circle_f2, circle) && near(found.star_f2, star), "{name}: {found:?}");
        }
    }

    #[test]
    fn moving_worlds_reward_adaptation_and_open_country_does_not() {
        for name in ["sliding-door", "sweeping-bar", "drifting-disc"] {
            let found = Difficulty::of(&shipped(name)).unwrap();
            assert!(found.gain() > 0.5 && found.circle_radius < 0.76, "{name}: {found:?}");
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
