//! How near robots come to walls.

use crate::geometry::{Walls, length_squared};
use grn_core::geometry::Point;

/// The least distance to walls so far. A robot whose distance was d somewhere needs no new look until it has moved so far
/// from there that it can be nearer than the least.
#[derive(Clone, Debug)]
pub(super) struct Clearance {
    least: f64,
    /// By robot where it was looked at, and its distance there.
    looks: Vec<(Point<f64>, f64)>,
}

impl Clearance {
    pub fn new() -> Self {
        Clearance { least: f64::INFINITY, looks: Vec::new() }
    }

    pub fn observe(&mut self, robots: impl Iterator<Item = Point<f64>>, walls: &Walls) {
        if walls.is_empty() {
            return;
        }
        for (robot, position) in robots.enumerate() {
            if let Some(&(place, distance)) = self.looks.get(robot) {
                let spare = distance - self.least;
                if spare > 0.0 && length_squared(position - place) < spare * spare {
                    continue;
                }
            }
            let look = (position, walls.signed_distance(position));
            self.least = self.least.min(look.1);
            match self.looks.get_mut(robot) {
                Some(old) => *old = look,
                None => self.looks.push(look),
            }
        }
    }

    /// For walls that have moved.
    pub fn forget_places(&mut self) {
        self.looks.clear();
    }

    /// Metres; `None` if there are no walls.
    pub fn least(&self) -> Option<f64> {
        self.least.is_finite().then_some(self.least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polygon;
    use crate::random::{Component, Stream};
    use grn_core::geometry::Vector;

    #[test]
    fn the_least_is_that_of_looking_at_everyone_always() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Vector::new(x, y));
        let walls = Walls::new(vec![Polygon::new(square.to_vec()).unwrap()]);
        let mut stream = Stream::new(1, Component::Placement, 0);
        for _ in 0..200 {
            let mut robots: Vec<Point<f64>> = (0..5).map(|_| Vector::new(stream.symmetric() * 4.0, 1.5)).collect();
            let (mut clearance, mut least) = (Clearance::new(), f64::INFINITY);
            for _ in 0..100 {
                clearance.observe(robots.iter().copied(), &walls);
                least = robots.iter().map(|&robot| walls.signed_distance(robot)).fold(least, f64::min);
                assert_eq!(clearance.least(), Some(least));
                for robot in &mut robots {
                    *robot = *robot + Vector::new(stream.symmetric(), stream.symmetric()) * 0.1;
                }
            }
        }
        let mut free = Clearance::new();
        free.observe([Vector::ZERO].into_iter(), &Walls::default());
        assert_eq!(free.least(), None);
    }
}
