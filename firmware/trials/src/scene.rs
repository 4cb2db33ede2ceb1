//! The scene in which costs are measured: all a robot can perceive in one tick.

use grn_core::bounded::filled;
use grn_core::robot::percept::{HEADING_UNIT, NOMINAL_TICK_US};
use grn_core::robot::{Fix, Heard, Message, Millimetres, ObstacleReport, Percept, Sighting, TargetReport};

/// Two targets, eight obstacle points and eight neighbours.
const TARGETS: [Millimetres; 2] = [Millimetres { x: 150, y: 60 }, Millimetres { x: -220, y: 180 }];
const NEIGHBOURS: u8 = 8;

/// Obstacle points 40 mm apart on a wall to the north, each in a square of the robot's map of its own.
fn obstacle(number: u8) -> Millimetres {
    Millimetres { x: 40 * i16::from(number) - 140, y: 300 }
}

/// What a mother robot at the origin perceives in the hardest tick: it sees both targets and all points itself, and hears
/// all neighbours at once, each with a target and four of the points.
pub fn everything() -> Percept {
    // Every field by name, so that a new one is missed here and its costs are measured.
    Percept {
        fix: Some(Fix { position: [0, 0], heading: [HEADING_UNIT, 0], age_ms: 0 }),
        elapsed_us: NOMINAL_TICK_US,
        proximity: [120, 250, u16::MAX, u16::MAX, u16::MAX, u16::MAX, u16::MAX, u16::MAX],
        targets: filled((0..).zip(TARGETS).map(|(target, position)| Sighting { target, position })),
        obstacles: filled((0..8).map(obstacle)),
        heard: filled((0..NEIGHBOURS).map(neighbour)),
    }
}

/// The same with all obstacle points farther north by this many millimetres.
pub fn everything_farther(north: i16) -> Percept {
    let mut percept = everything();
    let told =
        percept.heard.iter_mut().flat_map(|heard| &mut heard.message.obstacles).map(|report| &mut report.position);
    for position in percept.obstacles.iter_mut().chain(told) {
        position.y += north;
    }
    percept
}

/// The same with one neighbour heard in a tick, each in its turn.
pub fn in_turn(tick: u32) -> Percept {
    let mut percept = everything();
    percept.heard = filled([neighbour((tick % u32::from(NEIGHBOURS)) as u8)]);
    percept
}

/// The same place, where only two proximity sensors feel something.
pub fn nothing() -> Percept {
    let mut percept = Percept::nothing();
    (percept.fix, percept.proximity) = (everything().fix, everything().proximity);
    percept
}

fn neighbour(number: u8) -> Heard {
    let (column, row) = (i16::from(number % 4), i16::from(number / 4));
    let message = Message {
        sender: u16::from(number) + 1,
        position: Millimetres { x: 90 * column - 140, y: 160 * row - 80 },
        target: (0..).zip(TARGETS).nth(usize::from(number % 2)).map(|(target, position)| TargetReport {
            target,
            position,
            velocity: [0, 0],
            age: 3,
        }),
        obstacles: filled((0..4).map(|point| ObstacleReport { position: obstacle((number + point) % 8), age: 1 })),
    };
    Heard { message, age_ms: 0 }
}
