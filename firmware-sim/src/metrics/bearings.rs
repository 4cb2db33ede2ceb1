//! Robots' bearings about a target, in order, and the gaps between them.
//!
//! A bearing is told by where its ray leaves the square |x| + |y| = 1, as the way along it from due east: 0..4, one for
//! each quadrant. That costs one division, and sorts as the angle does.

use crate::geometry::length_squared;
use core::f64::consts::TAU;
use grn_core::geometry::{Point, Vector};

/// Ways nearer to each other than this are one bearing, so that rounding makes no whole turn of none.
const EQUAL: f64 = 1e-9;

/// Bearings in 0..=4, in rising order; the space is used again.
#[derive(Clone, Debug, Default)]
pub struct Bearings(Vec<f64>);

/// The way along the square to where the ray through `offset`, which is not zero, leaves it.
fn along_square(offset: Vector<f64>) -> f64 {
    let east = offset.x / (offset.x.abs() + offset.y.abs());
    if offset.y >= 0.0 { 1.0 - east } else { 3.0 + east }
}

/// The point of the square after this way.
fn on_square(way: f64) -> Vector<f64> {
    let north = if way < 3.0 { 1.0 - (way - 1.0).abs() } else { way - 4.0 };
    Vector::new((way - 2.0).abs() - 1.0, north)
}

/// The direction `to` as `from` sees it, turned so that `from` is due east.
fn turn([from, to]: [f64; 2]) -> Vector<f64> {
    let (from, to) = (on_square(from), on_square(to));
    Vector::new(from.dot(to), from.cross(to))
}

/// The angle of a turn to the left, radians in [0, 2π).
fn angle(turn: Vector<f64>) -> f64 {
    let angle = libm::atan2(turn.y, turn.x);
    if angle < 0.0 { angle + TAU } else { angle }
}

impl Bearings {
    /// Takes the bearings of `robots` about `target`. Robots exactly at the target have none.
    pub fn take(&mut self, target: Point<f64>, robots: impl IntoIterator<Item = Point<f64>>) {
        let offsets = robots.into_iter().map(|robot| robot - target).filter(|&offset| length_squared(offset) > 0.0);
        self.0.clear();
        self.0.extend(offsets.map(along_square));
        self.0.sort_unstable_by(f64::total_cmp);
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Neighbours, around the whole turn, that have not the same bearing.
    fn neighbours(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let ends = self.0.first().zip(self.0.last());
        let wrap = ends.filter(|(first, last)| *first + 4.0 - *last > EQUAL).map(|(&first, &last)| [last, first]);
        let pairs = self.0.windows(2).map(|pair| [pair[0], pair[1]]).filter(|[from, to]| to - from > EQUAL);
        pairs.chain(wrap)
    }

    fn are_distinct(&self) -> bool {
        self.neighbours().nth(1).is_some()
    }

    /// The largest gap between neighbours, radians in (0, 2π]; 2π with fewer than two distinct bearings.
    pub fn largest_gap(&self) -> f64 {
        if !self.are_distinct() {
            return TAU;
        }
        let largest = self.neighbours().map(turn).map(|turn| (along_square(turn), turn));
        largest.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(TAU, |(_, turn)| angle(turn))
    }

    /// The gaps between neighbours, radians; one whole turn with fewer than two distinct bearings.
    pub fn gaps(&self) -> impl Iterator<Item = f64> + '_ {
        let distinct = self.are_distinct();
        let gaps = self.neighbours().filter(move |_| distinct).map(|pair| angle(turn(pair)));
        gaps.chain((!distinct).then_some(TAU))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Component, Stream};
    use core::f64::consts::PI;

    #[test]
    fn the_way_along_the_square_is_undone_and_rises_with_the_angle() {
        let mut before = -1.0;
        for step in 0..4000 {
            let way = f64::from(step) * 1e-3;
            let point = on_square(way);
            assert!(
                (along_square(point * 3.0) - way).abs() < 1e-14 && (point.x.abs() + point.y.abs() - 1.0).abs() < 1e-14
            );
            let angle = angle(point);
            assert!(angle > before, "{way}");
            before = angle;
        }
    }

    #[test]
    fn robots_behind_each_other_have_one_bearing() {
        let behind = [(1.0, 3.0), (0.1, 0.3), (0.7, 2.1), (-0.3, -0.9), (-0.9, -2.7), (3e-6, 9e-6)];
        let mut bearings = Bearings::default();
        let mut gap = |robots: &[(f64, f64)]| {
            bearings.take(Vector::ZERO, robots.iter().map(|&(x, y)| Vector::new(x, y)));
            (bearings.largest_gap(), bearings.gaps().count())
        };
        assert_eq!(gap(&behind[..3]), (TAU, 1));
        let (both, count) = gap(&behind);
        assert!((both - PI).abs() < 1e-12 && count == 2);
        assert_eq!(gap(&[(1.0, 0.0), (1.0, -1e-20), (2.0, 0.0)]), (TAU, 1));
        assert_eq!((gap(&[]), gap(&[(0.0, 0.0)]), gap(&[(2.0, 1.0)])), ((TAU, 1), (TAU, 1), (TAU, 1)));
    }

    #[test]
    fn gaps_are_differences_of_angles() {
        let mut stream = Stream::new(7, Component::Placement, 0);
        let mut bearings = Bearings::default();
        for count in (2..60).cycle().take(2000) {
            let robots: Vec<Point<f64>> =
                (0..count).map(|_| Vector::new(stream.symmetric(), stream.symmetric() * 0.3)).collect();
            bearings.take(Vector::ZERO, robots.iter().copied());
            let mut angles: Vec<f64> = robots.iter().map(|p| libm::atan2(p.y, p.x)).collect();
            angles.sort_by(f64::total_cmp);
            let wrap = angles[0] + TAU - angles[count - 1];
            let mut expected: Vec<f64> = angles.windows(2).map(|pair| pair[1] - pair[0]).chain([wrap]).collect();
            let mut found: Vec<f64> = bearings.gaps().collect();
            assert!((bearings.largest_gap() - expected.iter().copied().fold(0.0, f64::max)).abs() < 1e-13);
            expected.sort_by(f64::total_cmp);
            found.sort_by(f64::total_cmp);
            assert!(found.iter().zip(&expected).all(|(found, expected)| (found - expected).abs() < 1e-13));
        }
    }
}
