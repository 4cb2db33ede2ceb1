//! Where a mission's robots begin: behind the targets, each around its own.

use super::draw::rounded;
use crate::geometry::{Walls, length_squared};
use crate::random::Stream;
use grn_core::geometry::{Point, Vector};

/// From where to where around a target's start, metres.
const RING: [f64; 2] = [0.6, 3.2];
/// Between two robots' centres, and from them to walls, metres: an e-puck2 is 0.28 m across at scale 0.25.
const APART: f64 = 0.36;
const FROM_WALLS: f64 = 0.3;
/// Misses in a row after which the ring is made wider.
const PATIENCE: u32 = 200;

/// `count` places, the first for the first target, and so on in turn. `starts` are the targets' starts and the unit vectors of their ways
/// there.
pub(super) fn starts(
    count: usize,
    targets: &[(Point<f64>, Vector<f64>)],
    walls: &Walls,
    region: [f64; 2],
    stream: &mut Stream,
) -> Vec<Point<f64>> {
    let mut places: Vec<Point<f64>> = Vec::with_capacity(count);
    let [inner, mut outer] = RING;
    let mut misses = 0;
    while places.len() < count {
        let (start, way) = targets[places.len() % targets.len()];
        let (radius, bearing) = stream.in_ring([inner, outer]);
        let behind = if bearing.dot(way) > 0.0 { -bearing } else { bearing };
        let at = start + behind * radius;
        let at = Vector::new(rounded(at.x), rounded(at.y));
        let inside = |metres: f64, side: f64| (FROM_WALLS..=side - FROM_WALLS).contains(&metres);
        let is_free = inside(at.x, region[0])
            && inside(at.y, region[1])
            && places.iter().all(|&other| length_squared(other - at) >= APART * APART)
            && walls.signed_distance(at) >= FROM_WALLS;
        if is_free {
            places.push(at);
            misses = 0;
            continue;
        }
        misses += 1;
        if misses == PATIENCE {
            misses = 0;
            outer *= 1.1;
        }
    }
    places
}
