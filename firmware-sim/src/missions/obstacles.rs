//! What stands in the way, by class. The clearance of the way is kept by construction: nothing is nearer to it at any moment.

use super::class::Class;
use super::draw::{centimetres, chance, rounded, rounded_up, side, whole};
use super::layout::{Layout, Moves, Obstacle, Shape, block};
use crate::random::Stream;
use core::f64::consts::FRAC_PI_8;
use grn_core::geometry::{Point, Vector};

/// How far the region reaches to both sides of a straight way, metres.
const HALF_WIDTH: f64 = 9.0;
/// Free way before and behind obstacles, metres: a ring and its robots have room there.
const APPROACH: f64 = 3.0;
/// What the region keeps around both ends of the way, metres: room for robots that start there.
const END: f64 = 4.0;
/// The part of the way in whose middle something moves, metres.
const MOVING_LENGTH: f64 = 4.0;
/// Nothing moves at more than this share of the targets' speed.
const SLOWER: f64 = 0.9;
/// When a moving obstacle sets out and stops.
const MOVES: [f64; 2] = [0.05, 0.95];

/// What is known of a mission before its obstacles are drawn.
pub(super) struct Plan {
    /// No wall is nearer to the way at any moment, metres.
    pub clearance: f64,
    /// From the last target's start to the first one's, along the way, metres.
    pub convoy: f64,
}

/// The layout, and how far along the way each target goes, metres.
pub(super) fn drawn(class: Class, plan: &Plan, stream: &mut Stream) -> (Layout, f64) {
    let from = plan.convoy + APPROACH;
    if class == Class::Corner {
        return corner(plan, from, stream);
    }
    let (length, obstacles) = match class {
        Class::Corridor => corridor(plan, from, stream),
        Class::Door => doors(plan, from, stream),
        Class::Columns => columns(plan, from, stream),
        Class::SlidingDoor | Class::SweepingBar | Class::DriftingDisc | Class::Corner => (MOVING_LENGTH, Vec::new()),
    };
    let travel = rounded(from + length + APPROACH);
    let middle = rounded(from + length / 2.0);
    let obstacles = match class {
        Class::SlidingDoor => sliding_door(plan, middle, travel, stream),
        Class::SweepingBar => vec![sweeping_bar(plan, middle, travel, stream)],
        Class::DriftingDisc => vec![drifting_disc(plan, middle, travel, stream)],
        _ => obstacles,
    };
    let end = rounded(plan.convoy + travel);
    let region = [Vector::new(-END, -HALF_WIDTH), Vector::new(rounded(end + END), HALF_WIDTH)];
    (Layout { way: vec![Vector::ZERO, Vector::new(end, 0.0)], obstacles, region }, travel)
}

fn corridor(plan: &Plan, from: f64, stream: &mut Stream) -> (f64, Vec<Obstacle>) {
    let length = centimetres(stream, [3.0, 8.0]);
    (length, both_walls(from, from + length, [-plan.clearance, plan.clearance]))
}

/// Walls from here to there along the way, with a gap from south to north between them.
fn both_walls(west: f64, east: f64, [south, north]: [f64; 2]) -> Vec<Obstacle> {
    vec![Obstacle::block([west, north], [east, HALF_WIDTH]), Obstacle::block([west, -HALF_WIDTH], [east, south])]
}

fn doors(plan: &Plan, from: f64, stream: &mut Stream) -> (f64, Vec<Obstacle>) {
    let thick = centimetres(stream, [0.2, 0.6]);
    let spacing = centimetres(stream, [3.0, 5.0]);
    let count = whole(stream, 1, 3);
    let door = |number: usize| {
        let west = from + number as f64 * spacing;
        // The way goes through the middle of every other door, and past one jamb of the others.
        let wider = if chance(stream, 0.5) { centimetres(stream, [0.0, 1.0]) } else { 0.0 };
        let gap = [plan.clearance, rounded(plan.clearance + wider)];
        let gap = if chance(stream, 0.5) { [-gap[0], gap[1]] } else { [-gap[1], gap[0]] };
        both_walls(west, west + thick, gap)
    };
    (rounded((count - 1) as f64 * spacing + thick), (0..count).flat_map(door).collect())
}

fn columns(plan: &Plan, from: f64, stream: &mut Stream) -> (f64, Vec<Obstacle>) {
    let spacing = centimetres(stream, [1.2, 2.5]);
    let count = whole(stream, 3, 8);
    let column = |number: usize| {
        let radius = centimetres(stream, [0.2, 0.6]);
        // Half of them touch the clearance.
        let farther = if chance(stream, 0.5) { centimetres(stream, [0.0, 0.6]) } else { 0.0 };
        let beside = side(stream) * rounded(disc_offset(plan.clearance, radius) + farther);
        Obstacle::fixed(Shape::Disc(Vector::new(from + number as f64 * spacing, beside), radius))
    };
    (rounded((count - 1) as f64 * spacing), (0..count).map(column).collect())
}

/// How far from the way a disc's centre must be. What stands for a disc is a little larger in places.
fn disc_offset(clearance: f64, radius: f64) -> f64 {
    ((clearance + radius * DISC_EXCESS) * 100.0).ceil() / 100.0
}

/// As [`Polygon::disc`](crate::geometry::Polygon::disc) says.
const DISC_EXCESS: f64 = 1.000_61;

/// A block around whose edge the way goes to the north.
fn corner(plan: &Plan, from: f64, stream: &mut Stream) -> (Layout, f64) {
    let clearance = plan.clearance;
    let side = centimetres(stream, [3.0, 6.0]);
    // Around the edge as around an octagon, whose sides are as near to it as the walls are.
    let cut = rounded_up(clearance * libm::tan(FRAC_PI_8));
    let edge: Point<f64> = Vector::new(from + side, clearance);
    let north = edge.y + side + APPROACH + plan.convoy;
    let way = [[0.0, 0.0], [edge.x + cut, 0.0], [edge.x + clearance, edge.y - cut], [edge.x + clearance, north]];
    let layout = Layout {
        way: way.map(|[x, y]| Vector::new(x, y)).to_vec(),
        obstacles: vec![Obstacle::block([from, edge.y], [edge.x, edge.y + side])],
        region: [Vector::new(-END, -END), Vector::new(rounded(edge.x + clearance + END), rounded(north + END))],
    };
    (layout, 2.0 * side + from + APPROACH)
}

/// A door in a thin wall, whose leaves go between the clearance and wide open.
fn sliding_door(plan: &Plan, west: f64, travel: f64, stream: &mut Stream) -> Vec<Obstacle> {
    let thick = centimetres(stream, [0.2, 0.6]);
    let stroke = centimetres(stream, [1.0, 2.5]);
    let strokes = strokes(stroke, travel, stream);
    let begins_open = usize::from(chance(stream, 0.5));
    let leaf = |side: f64| {
        let narrow = side * plan.clearance;
        let wide = side * (plan.clearance + stroke);
        let jamb = |stroke: usize| if (stroke + begins_open).is_multiple_of(2) { narrow } else { wide };
        let first = jamb(0);
        let far = first + side * (HALF_WIDTH - plan.clearance);
        let shape = block([west, first.min(far)], [west + thick, first.max(far)]);
        let path = (0..=strokes).map(|stroke| Vector::new(west, jamb(stroke))).collect();
        Obstacle { shape, moves: Moves { path, turn_deg: Vec::new(), times: even_times(strokes) } }
    };
    vec![leaf(1.0), leaf(-1.0)]
}

/// How often something goes a stretch of this length, metres, to or fro: no faster than targets that go `travel`.
fn strokes(length: f64, travel: f64, stream: &mut Stream) -> usize {
    let most = (MOVES[1] - MOVES[0]) * SLOWER * travel / length;
    whole(stream, 1, (most as usize).clamp(1, 8))
}

/// The times at which each of so many strokes begins, and the last one ends.
fn even_times(strokes: usize) -> Vec<f64> {
    let time = |stroke: usize| MOVES[0] + (MOVES[1] - MOVES[0]) * stroke as f64 / strokes as f64;
    (0..=strokes).map(|stroke| (time(stroke) * 1e4).round() / 1e4).collect()
}

/// A bar on a hinge, whose tip comes down to the clearance.
fn sweeping_bar(plan: &Plan, middle: f64, travel: f64, stream: &mut Stream) -> Obstacle {
    let length = centimetres(stream, [1.2, 2.2]);
    let half = centimetres(stream, [0.1, 0.2]);
    let turn = whole(stream, 40, 80) as f64;
    let reach = rounded_up((length * length + half * half).sqrt());
    let hinge = Vector::new(middle, plan.clearance + reach);
    let strokes = strokes(reach * 2.0 * turn.to_radians(), travel, stream);
    let first = side(stream);
    let turn_deg = (0..=strokes).map(|stroke| if stroke.is_multiple_of(2) { first * turn } else { -first * turn });
    Obstacle {
        shape: block([middle - half, hinge.y - length], [middle + half, hinge.y]),
        moves: Moves { path: vec![hinge], turn_deg: turn_deg.collect(), times: even_times(strokes) },
    }
}

/// A disc that comes from ahead, goes along the way at the clearance, and away again.
fn drifting_disc(plan: &Plan, middle: f64, travel: f64, stream: &mut Stream) -> Obstacle {
    let radius = centimetres(stream, [0.3, 0.7]);
    let near = disc_offset(plan.clearance, radius);
    // It goes at most this far in the whole run: up to a half along the way, and a quarter to come and to go.
    let room = SLOWER * travel;
    let along = rounded(room * (0.2 + 0.3 * stream.unit()));
    let slant = rounded((room * 0.2).min(2.0));
    let far = rounded(near + slant * (0.3 + 0.4 * stream.unit()));
    let east = rounded(middle + along / 2.0);
    let places = [[east + slant, far], [east, near], [east - along, near], [east - along - slant, far]];
    let path: Vec<Point<f64>> = places.map(|[x, y]| Vector::new(x, y)).to_vec();
    let moves = Moves { path: path.clone(), ..Moves::default() };
    Obstacle { shape: Shape::Disc(path[0], radius), moves }
}
