//! Corners: where walls meet or face each other x2 has a crease, and a contour a corner between two lattice edges.

use super::lanes::{Lanes, WIDTH};
use grn_core::geometry::{Point, Vector};

/// A chord that may miss the contour by more than this is looked into, metres.
const SUSPECT: f64 = 0.01;
/// The same where x2 has a crease: there a chord can miss a corner by more than the turns at its ends tell.
const SUSPECT_AT_CREASE: f64 = 0.006;
/// A chord that misses the contour by more than this is split, metres.
const TOLERATED: f64 = 0.006;
/// A chord that missed it by less leaves halves that follow it: those of an arc miss it by a quarter.
const HALVES_FOLLOW: f64 = 2.5 * TOLERATED;
/// A chord is halved at most this many times.
const DEEPEST: u32 = 4;

/// Where the contour is looked for across a chord, in lengths of the chord: beside its middle, and on both sides.
const LOOKED_AT: [f64; WIDTH] = [0.0, 0.1, -0.1, 0.3, -0.3, 1.0, -1.0, 2.0];

/// The ring, inside to its right, with more points where it turns sharply; `errors` is the exact pattern error.
pub(super) fn with_corners(
    ring: Vec<Point<f64>>,
    is_at_crease: impl Fn(Point<f64>) -> bool,
    errors: impl Fn(&[Point<f64>; WIDTH]) -> Lanes,
) -> Vec<Point<f64>> {
    let count = ring.len();
    let is_suspect = |place: usize| {
        may_miss(&ring, place, SUSPECT_AT_CREASE)
            && (may_miss(&ring, place, SUSPECT) || is_at_crease((ring[place] + ring[(place + 1) % count]) * 0.5))
    };
    let suspects: Vec<usize> = (0..count).filter(|&place| is_suspect(place)).collect();
    let missing = missing(&ring, &suspects, &errors);
    if missing.is_empty() {
        return ring;
    }
    let mut sharp = Vec::with_capacity(2 * count);
    for place in 0..count {
        sharp.push(ring[place]);
        if missing.contains(&place) {
            split(ring[place], ring[(place + 1) % count], DEEPEST, &errors, &mut sharp);
        }
    }
    sharp
}

/// The suspects that do miss the contour, judged by the pattern error in the chord's middle and just beside it.
fn missing(ring: &[Point<f64>], suspects: &[usize], errors: &impl Fn(&[Point<f64>; WIDTH]) -> Lanes) -> Vec<usize> {
    let mut missing = Vec::new();
    for places in suspects.chunks(WIDTH) {
        let chords: [_; WIDTH] = std::array::from_fn(|lane| {
            let place = places[lane.min(places.len() - 1)];
            (ring[place], ring[(place + 1) % ring.len()])
        });
        let middles = chords.map(|(from, to)| (from + to) * 0.5);
        let here = errors(&middles).0;
        let beside = errors(&std::array::from_fn(|lane| {
            let (from, to) = chords[lane];
            middles[lane] + inwards_of(to - from) * if here[lane] < 0.0 { TOLERATED } else { -TOLERATED }
        }));
        let misses = |lane: &usize| (here[*lane] < 0.0) == (beside.0[*lane] < 0.0);
        missing.extend((0..places.len()).filter(misses).map(|lane| places[lane]));
    }
    missing
}

/// The unit vector to the right of `along`, where the inside is.
fn inwards_of(along: Vector<f64>) -> Vector<f64> {
    let length = along.length();
    if length == 0.0 { Vector::new(0.0, 0.0) } else { Vector::new(along.y, -along.x) * (1.0 / length) }
}

/// Whether the chord from the point at `place` may miss the contour by a distance: by a quarter of its length times the turn at an end.
fn may_miss(ring: &[Point<f64>], place: usize, distance: f64) -> bool {
    let at = |offset: usize| ring[(place + offset) % ring.len()];
    let (before, chord, after) = (at(0) - at(ring.len() - 1), at(1) - at(0), at(2) - at(1));
    let exceeds = |side: Vector<f64>| {
        let area = side.cross(chord);
        area * area > 16.0 * distance * distance * side.dot(side) || side.dot(chord) < 0.0
    };
    exceeds(before) || exceeds(after)
}

/// Adds points between `from` and `to`, so that chords follow the contour.
fn split(
    from: Point<f64>,
    to: Point<f64>,
    depth: u32,
    errors: &impl Fn(&[Point<f64>; WIDTH]) -> Lanes,
    points: &mut Vec<Point<f64>>,
) {
    let chord = to - from;
    let middle = from + chord * 0.5;
    let Some(found) = crossing(middle, chord, errors) else { return };
    let missed_by = (found - middle).length();
    if depth == 0 || missed_by < TOLERATED {
        return;
    }
    if missed_by < HALVES_FOLLOW {
        points.push(found);
        return;
    }
    split(from, found, depth - 1, errors, points);
    points.push(found);
    split(found, to, depth - 1, errors, points);
}

/// Where the contour crosses the perpendicular to `along` through `point`, within once or twice the length of `along`.
fn crossing(
    point: Point<f64>,
    along: Vector<f64>,
    errors: &impl Fn(&[Point<f64>; WIDTH]) -> Lanes,
) -> Option<Point<f64>> {
    let length = along.length();
    if length == 0.0 {
        return None;
    }
    let inwards = inwards_of(along);
    let at = |distances: [f64; WIDTH]| errors(&distances.map(|distance| point + inwards * distance)).0;
    let distances = LOOKED_AT.map(|share| share * length);
    let found = at(distances);
    let outwards = found[0] >= 0.0;
    let on_the_way = |&(distance, _): &(f64, f64)| if outwards { distance <= 0.0 } else { distance >= 0.0 };
    let bracket = first_change(distances.into_iter().zip(found).filter(on_the_way))?;
    let estimate = bracket.root();
    if estimate.abs() < 0.5 * TOLERATED {
        return Some(point + inwards * estimate);
    }
    let (near, far) = (bracket.near, bracket.far);
    let between = std::array::from_fn(|lane| near.0 + (far.0 - near.0) * (lane + 1) as f64 / (WIDTH + 1) as f64);
    let finer = between.into_iter().zip(at(between));
    let bracket = first_change(std::iter::once(near).chain(finer).chain([far]))?;
    Some(point + inwards * bracket.root())
}

/// Two places, each with its error, between which the sign changes.
struct Bracket {
    near: (f64, f64),
    far: (f64, f64),
}

impl Bracket {
    /// The root of the straight line through both.
    fn root(&self) -> f64 {
        let (near, far) = (self.near, self.far);
        near.0 + (far.0 - near.0) * near.1 / (near.1 - far.1)
    }
}

/// The first two consecutive places of different signs.
fn first_change(mut places: impl Iterator<Item = (f64, f64)>) -> Option<Bracket> {
    let mut near = places.next()?;
    for far in places {
        if (far.1 < 0.0) != (near.1 < 0.0) {
            return Some(Bracket { near, far });
        }
        near = far;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_squares_corners_are_found_and_a_circle_is_left_alone() {
        // Inside is |x| + |y| ≤ 1; no point given is near a corner.
        let mut ring: Vec<_> = (0..4)
            .flat_map(|side| {
                let (from, to) = ([(1, 0), (0, 1), (-1, 0), (0, -1)][side], [(0, 1), (-1, 0), (0, -1), (1, 0)][side]);
                let corner = |(x, y): (i32, i32)| Vector::new(f64::from(x), f64::from(y));
                [0.1, 0.3, 0.5, 0.7, 0.9].map(|t| corner(from) * (1.0 - t) + corner(to) * t)
            })
            .collect();
        ring.reverse();
        let sharp = with_corners(ring, |_| false, |points| Lanes(points.map(|p| 1.0 - p.x.abs() - p.y.abs())));
        let off = |corner: Point<f64>| sharp.iter().map(|&p| (p - corner).length()).fold(f64::INFINITY, f64::min);
        for corner in [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0), Vector::new(-1.0, 0.0), Vector::new(0.0, -1.0)] {
            assert!(off(corner) < 0.01, "{} m from a corner", off(corner));
        }
        let circle: Vec<_> = (0..60)
            .map(|i| f64::from(i) * std::f64::consts::TAU / 60.0)
            .map(|angle| Vector::new(1.5 * libm::cos(angle), 1.5 * libm::sin(angle)))
            .collect();
        assert_eq!(with_corners(circle.clone(), |_| false, |_| unreachable!("no corner to look into")), circle);
    }
}
