//! Worlds of round obstacles thrown at random, with the way of every target kept free.

use super::{Path, Scenario, ScenarioError};
use crate::geometry::{Polygon, Walls, nearest_on_segment};
use crate::random::{Component, Stream};
use core::f64::consts::TAU;
use grn_core::geometry::{Point, Vector};
use serde::{Deserialize, Serialize};

/// Corners of the polygon that stands for a round obstacle; it lies within the circle by less than 0.5 % of the radius.
const CORNERS: usize = 32;
/// Obstacles thrown for each one that finds no room before the world counts as full.
const THROWS: usize = 20_000;

/// How to throw obstacles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RandomObstacles {
    /// Which world of those with the same other numbers.
    pub seed: u64,
    /// Share of the region that obstacles cover, within (0, 0.5]; the last one thrown may exceed it.
    pub density: f64,
    /// Least and greatest radius, metres, positive; radii are uniform between.
    pub radius: [f64; 2],
    /// No obstacle is nearer than this to a target's path, metres, positive.
    pub clearance: f64,
}

impl RandomObstacles {
    fn check(&self) -> Result<(), ScenarioError> {
        let [least, greatest] = self.radius;
        let fault = |place: &str, value: f64, expected: &str| Err(ScenarioError::new(place, value, expected));
        match () {
            () if !(self.density > 0.0 && self.density <= 0.5) => {
                fault("density", self.density, "a share above 0 and at most 0.5 is needed")
            }
            () if !(least > 0.0 && least.is_finite()) => {
                fault("radius[0]", least, "must be a positive length in metres")
            }
            () if !(greatest >= least && greatest.is_finite()) => {
                fault("radius[1]", greatest, "must be at least radius[0] and finite")
            }
            () if !(self.clearance > 0.0 && self.clearance.is_finite()) => {
                fault("clearance", self.clearance, "must be a positive length in metres")
            }
            () => Ok(()),
        }
    }
}

struct Disc {
    centre: Point<f64>,
    radius: f64,
}

impl Disc {
    fn is_clear_of(&self, path: &Path, clearance: f64) -> bool {
        let points = path.points();
        let ends = points.windows(2).map(|pair| (pair[0], pair[1])).chain(points.first().map(|&only| (only, only)));
        let nearest = |(start, end)| (nearest_on_segment(start, end, self.centre) - self.centre).length();
        ends.map(nearest).all(|distance| distance >= self.radius + clearance)
    }

    fn overlaps(&self, other: &Disc) -> bool {
        (self.centre - other.centre).length() <= self.radius + other.radius
    }

    fn outline(&self) -> Vec<Point<f64>> {
        let corner = |place: usize| {
            let (sin, cos) = libm::sincos(TAU * place as f64 / CORNERS as f64);
            self.centre + Vector::new(cos, sin) * self.radius
        };
        (0..CORNERS).map(corner).collect()
    }
}

impl Scenario {
    /// The same world with round obstacles in the place of its walls. They do not overlap and leave every target's path
    /// the stated clearance on both sides, so that a target can pass. The name gets the seed.
    ///
    /// # Errors
    /// Numbers out of the ranges of [`RandomObstacles`], or a density for which there is no room.
    pub fn with_random_obstacles(&self, obstacles: &RandomObstacles) -> Result<Scenario, ScenarioError> {
        obstacles.check()?;
        let mut stream = Stream::new(obstacles.seed, Component::Obstacles, 0);
        let [width, height] = self.region;
        let [least, greatest] = obstacles.radius;
        let wanted = obstacles.density * width * height;
        let (mut discs, mut covered, mut missed) = (Vec::<Disc>::new(), 0.0, 0);
        while covered < wanted {
            let radius = least + (greatest - least) * stream.unit();
            let disc = Disc { centre: Vector::new(width * stream.unit(), height * stream.unit()), radius };
            let is_clear = self.targets.iter().all(|path| disc.is_clear_of(path, obstacles.clearance));
            if is_clear && !discs.iter().any(|other| disc.overlaps(other)) {
                covered += TAU / 2.0 * radius * radius;
                missed = 0;
                discs.push(disc);
                continue;
            }
            missed += 1;
            if missed == THROWS {
                let reached =
                    format!("no room beyond {:.3}; less density or clearance is needed", covered / (width * height));
                return Err(ScenarioError::new("density", obstacles.density, reached));
            }
        }
        let polygon = |(place, disc): (usize, &Disc)| {
            Polygon::new(disc.outline())
                .map_err(|_| ScenarioError::new(format!("obstacle {place}"), disc.radius, "too small"))
        };
        let walls = discs.iter().enumerate().map(polygon).collect::<Result<_, _>>()?;
        let name = format!("{}-{}", self.name, obstacles.seed);
        Ok(Scenario { name, walls: Walls::new(walls), ..self.clone() })
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
                    let clearance = world.walls().signed_distance(target);
                    assert!(clearance >= SOME.clearance, "world {seed}: {clearance} m at {target:?}");
                }
            }
            let covered: f64 = world.walls().polygons().iter().map(Polygon::area).sum();
            let share = covered / (world.region()[0] * world.region()[1]);
            assert!((0.0495..0.0545).contains(&share), "world {seed} is covered to {share}");
            assert_eq!(Scenario::parse(&world.to_toml()).unwrap(), world);
        }
        let other = open().with_random_obstacles(&RandomObstacles { seed: 2, ..SOME }).unwrap();
        assert_ne!(open().with_random_obstacles(&SOME).unwrap().walls(), other.walls());
    }

    #[test]
    fn impossible_worlds_are_refused() {
        for (obstacles, words) in [
            (RandomObstacles { density: 0.0, ..SOME }, "density"),
            (RandomObstacles { density: f64::NAN, ..SOME }, "density"),
            (RandomObstacles { density: 0.5, clearance: 9.0, ..SOME }, "no room"),
            (RandomObstacles { radius: [0.9, 0.3], ..SOME }, "radius[1]"),
            (RandomObstacles { clearance: -1.0, ..SOME }, "clearance"),
        ] {
            let error = open().with_random_obstacles(&obstacles).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
