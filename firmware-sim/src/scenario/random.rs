//! Worlds of round obstacles thrown at random, with the way of every target kept free.

use super::file::ScenarioFile;
use super::{Disc, Path, Scenario};
use crate::geometry::{Polygon, Walls, nearest_on_segment};
use crate::random::{Component, Stream};
use core::f64::consts::TAU;
use grn_core::geometry::{Point, Vector};
use grn_input::{InputError, Range};
use serde::{Deserialize, Serialize};

/// Corners of the polygon that stands for a round obstacle; it lies within the circle by less than 0.5 % of the radius.
const CORNERS: usize = 32;
/// Obstacles thrown for each one that finds no room before the world counts as full.
const THROWS: usize = 20_000;
/// Comparisons of obstacles with each other and with points of paths before the world counts as full: about a second.
const MOST_COMPARISONS: usize = 300_000_000;
/// The most obstacles, so that their corners stay within the points that walls may have, with room for chance.
const MOST_OBSTACLES: f64 = 600.0;

/// Share of the region that obstacles may cover; equal discs thrown at random jam at 0.547.
pub const DENSITY: Range<f64> = Range::new(0.001, 0.5, "(a share of the region)");
/// Radii of obstacles.
pub const RADIUS: Range<f64> = Range::new(0.01, 100.0, "metres");
/// What may be kept free around paths.
pub const CLEARANCE: Range<f64> = Range::new(0.01, 100.0, "metres");

/// How to throw obstacles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RandomObstacles {
    /// Which world of those with the same other numbers.
    pub seed: u64,
    /// Share of the region that obstacles cover, in [`DENSITY`]; the last one thrown may exceed it.
    pub density: f64,
    /// Least and greatest radius, metres, in [`RADIUS`]; radii are uniform between.
    pub radius: [f64; 2],
    /// No obstacle is nearer than this to a target's path, metres, in [`CLEARANCE`].
    pub clearance: f64,
}

impl RandomObstacles {
    /// Checks the numbers for a world of this region, metres; keys begin with `prefix`.
    ///
    /// # Errors
    /// A number out of range, or obstacles so small that too many are needed.
    pub fn check(&self, prefix: &str, region: [f64; 2]) -> Result<(), InputError> {
        let [least, greatest] = self.radius;
        let key = |name: &str| format!("{prefix}{name}");
        DENSITY.check(&key("density"), self.density)?;
        RADIUS.check(&key("radius[0]"), least)?;
        RADIUS.check(&key("radius[1]"), greatest)?;
        CLEARANCE.check(&key("clearance"), self.clearance)?;
        if greatest < least {
            let expected = format!("the greatest radius must be at least the least, {least:?}");
            return Err(InputError::new(key("radius[1]"), format!("{greatest:?}"), expected));
        }
        // Radii are uniform between the two.
        let mean_square = (least * least + least * greatest + greatest * greatest) / 3.0;
        let count = self.density * region[0] * region[1] / (TAU / 2.0 * mean_square);
        if count > MOST_OBSTACLES {
            let expected = format!(
                "about {count:.0} obstacles of this size are needed, and at most {MOST_OBSTACLES} are thrown; make them \
                 larger, or the density less"
            );
            return Err(InputError::new(key("radius[0]"), format!("{least:?}"), expected));
        }
        Ok(())
    }
}

fn is_clear_of(disc: &Disc, path: &Path, clearance: f64) -> bool {
    let points = path.points();
    let ends = points.windows(2).map(|pair| (pair[0], pair[1])).chain(points.first().map(|&only| (only, only)));
    let nearest = |(start, end)| (nearest_on_segment(start, end, disc.centre) - disc.centre).length();
    ends.map(nearest).all(|distance| distance >= disc.radius + clearance)
}

fn overlap(a: &Disc, b: &Disc) -> bool {
    (a.centre - b.centre).length() <= a.radius + b.radius
}

/// Fewer corners than of a disc in a file, as there are many of them.
fn outline(disc: &Disc) -> Vec<Point<f64>> {
    let corner = |place: usize| {
        let (sin, cos) = libm::sincos(TAU * place as f64 / CORNERS as f64);
        disc.centre + Vector::new(cos, sin) * disc.radius
    };
    (0..CORNERS).map(corner).collect()
}

impl Scenario {
    /// The same world with round obstacles in the place of its walls. They do not overlap and leave every target's path
    /// the stated clearance on both sides, so that a target can pass. The name gets the seed.
    ///
    /// # Errors
    /// Numbers out of the ranges of [`RandomObstacles`], or a density for which there is no room.
    pub fn with_random_obstacles(&self, obstacles: &RandomObstacles) -> Result<Scenario, InputError> {
        obstacles.check("", self.region)?;
        let mut stream = Stream::new(obstacles.seed, Component::Obstacles, 0);
        let [width, height] = self.region;
        let [least, greatest] = obstacles.radius;
        let wanted = obstacles.density * width * height;
        let points: usize = self.targets.iter().map(|target| target.path.points().len()).sum();
        let (mut discs, mut covered, mut missed, mut comparisons) = (Vec::<Disc>::new(), 0.0, 0, 0);
        while covered < wanted {
            comparisons += points + discs.len();
            let radius = least + (greatest - least) * stream.unit();
            let disc = Disc { centre: Vector::new(width * stream.unit(), height * stream.unit()), radius };
            let is_clear = self.targets.iter().all(|target| is_clear_of(&disc, &target.path, obstacles.clearance));
            if is_clear && !discs.iter().any(|other| overlap(&disc, other)) {
                covered += TAU / 2.0 * radius * radius;
                missed = 0;
                discs.push(disc);
                continue;
            }
            missed += 1;
            if missed == THROWS || comparisons > MOST_COMPARISONS {
                let reached =
                    format!("no room beyond {:.3}; less density or clearance is needed", covered / (width * height));
                return Err(InputError::new("density", obstacles.density, reached));
            }
        }
        let polygon = |(place, disc): (usize, &Disc)| {
            Polygon::new(outline(disc))
                .map_err(|_| InputError::new(format!("obstacle {place}"), disc.radius, "too small"))
        };
        let walls = discs.iter().enumerate().map(polygon).collect::<Result<_, _>>()?;
        let name = format!("{}-{}", self.name, obstacles.seed);
        let world = Scenario {
            name,
            fixed_walls: Walls::new(walls),
            fixed_discs: Vec::new(),
            moving_walls: Vec::new(),
            ..self.clone()
        };
        Scenario::try_from(ScenarioFile::from(world))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open() -> Scenario {
        Scenario::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/open.toml")).unwrap()
    }

    const SOME: RandomObstacles = RandomObstacles { seed: 1, density: 0.05, radius: [0.3, 0.9], clearance: 1.75 };

    #[test]
    fn the_way_stays_free_and_the_density_is_met() {
        for seed in 0..50 {
            let obstacles = RandomObstacles { seed, ..SOME };
            let world = open().with_random_obstacles(&obstacles).unwrap();
            assert_eq!(world, open().with_random_obstacles(&obstacles).unwrap());
            for step in 0..=500 {
                for target in world.targets_at(f64::from(step) / 500.0) {
                    let clearance = world.fixed_walls().signed_distance(target);
                    assert!(clearance >= SOME.clearance, "world {seed}: {clearance} m at {target:?}");
                }
            }
            let covered: f64 = world.fixed_walls().polygons().map(Polygon::area).sum();
            let share = covered / (world.region()[0] * world.region()[1]);
            assert!((0.0495..0.0545).contains(&share), "world {seed} is covered to {share}");
            assert_eq!(Scenario::parse(&world.to_toml()).unwrap(), world);
        }
        let other = open().with_random_obstacles(&RandomObstacles { seed: 2, ..SOME }).unwrap();
        assert_ne!(open().with_random_obstacles(&SOME).unwrap().fixed_walls(), other.fixed_walls());
    }

    #[test]
    fn impossible_worlds_are_refused() {
        for (obstacles, words) in [
            (RandomObstacles { density: 0.0, ..SOME }, "density"),
            (RandomObstacles { density: f64::NAN, ..SOME }, "density"),
            (RandomObstacles { density: 0.5, clearance: 9.0, ..SOME }, "no room"),
            (RandomObstacles { radius: [0.9, 0.3], ..SOME }, "radius[1]"),
            (RandomObstacles { clearance: -1.0, ..SOME }, "clearance"),
            (RandomObstacles { radius: [0.01, 0.01], ..SOME }, "radius[0] = 0.01: about 99472 obstacles"),
            (RandomObstacles { radius: [1e-6, 1e-6], ..SOME }, "radius[0] = 1e-6: must be"),
            (RandomObstacles { radius: [0.3, f64::INFINITY], ..SOME }, "radius[1] = inf: must be"),
        ] {
            let error = open().with_random_obstacles(&obstacles).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
