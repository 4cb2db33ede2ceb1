//! Percepts for a robot that walks where its commands lead, past targets, obstacles and other robots: all in integers.

use crate::random::Random;
use grn_core::bounded::filled;
use grn_core::robot::percept::{MAX_HEARD, MAX_SEEN_OBSTACLES, NOMINAL_TICK_US};
use grn_core::robot::{Command, Fix, Heard, Message, Millimetres, ObstacleReport, Percept, Sighting, TargetReport};

/// One robot's walk.
#[derive(Clone, Debug)]
pub struct Walk {
    random: Random,
    tick: i32,
    /// Micrometres.
    position: [i32; 2],
    /// (cos, sin) in units of 2^-14.
    heading: [i32; 2],
    /// Whether the robot sees targets and obstacles itself, or only hears of them.
    sees: bool,
    /// Whether localisation, radio and timer are not as they should be.
    irregular: bool,
    /// Time from one tick to the next.
    elapsed_us: u32,
}

const UNIT: i32 = 1 << 14;

impl Walk {
    /// The walk of this seed.
    pub fn new(seed: u32) -> Self {
        let mut random = Random::new(!seed);
        let position = [(); 2].map(|()| random.between(-300_000, 300_000));
        let sees = random.once_in(2);
        let irregular = random.once_in(2);
        let elapsed_us = match random.below(4) {
            0 if irregular => 10_000 + random.below(100_000),
            _ => NOMINAL_TICK_US,
        };
        Walk { random, tick: 0, position, heading: [UNIT, 0], sees, irregular, elapsed_us }
    }

    /// What the robot perceives now.
    pub fn percept(&mut self) -> Percept {
        let near = |metre: i32, random: &mut Random| metre.wrapping_add(random.between(-2000, 2000));
        let [x, y] = self.position;
        let (seen, points) = if self.sees { (2, self.random.below(MAX_SEEN_OBSTACLES as u32 + 1)) } else { (0, 0) };
        let messages = self.random.below(MAX_HEARD as u32 + 1);
        // Some walks have fixes in all ticks and ticks on time, in the others fixes lack for a while, are old, or jump.
        let (fixed, jumps) = if self.irregular {
            (self.random.once_in(3) && self.tick % 64 < 44, self.random.once_in(9))
        } else {
            (true, false)
        };
        let fix = Fix {
            position: [near(x, &mut self.random) + if jumps { 400_000 } else { 0 }, near(y, &mut self.random)],
            heading: self.heading.map(|component| component as i16),
            age_ms: if self.irregular { self.random.below(700) as u16 } else { 0 },
        };
        Percept {
            fix: fixed.then_some(fix),
            elapsed_us: self.elapsed_us,
            proximity: [(); 8].map(|()| if self.random.once_in(12) { self.random.below(500) as u16 } else { u16::MAX }),
            targets: filled((0..seen).map(|target| Sighting { target, position: self.target(target, 8) })),
            obstacles: filled((0..points).map(|_| self.obstacle())),
            heard: filled((0..messages).map(|_| self.heard())),
        }
    }

    /// Moves the robot for one tick.
    ///
    /// A step is 129 µm and there are 32 ticks a second; wheels are 53 mm apart.
    pub fn follow(&mut self, command: &Command) {
        self.tick += 1;
        let (left, right) = (i32::from(command.left), i32::from(command.right));
        let advance = (left + right) * 129 / 64;
        let ([x, y], [cos, sin]) = (self.position, self.heading);
        let moved = |from: i32, component: i32| from + advance * (component / 16) / (UNIT / 16);
        self.position = [moved(x, cos), moved(y, sin)];
        // Radians in units of 2^-14: 129 µm / 53 mm / 32 · 2^14 = 1.246 a step of difference.
        let turn = (right - left) * 1246 / 1000;
        let turned = [cos - sin * turn / UNIT, sin + cos * turn / UNIT];
        let length = turned.map(|component| component * component).iter().sum::<i32>().unsigned_abs().isqrt();
        let length = (length as i32).max(1);
        self.heading = turned.map(|component| component * UNIT / length);
    }

    /// Where a target is, give or take some `noise` in millimetres: they move east slowly and start over.
    fn target(&mut self, target: u8, noise: i32) -> Millimetres {
        let along = self.tick % 512;
        let (x, y) = if target == 0 { (along / 2 - 100, 80) } else { (400 - along / 4, -350) };
        self.near(x, y, noise)
    }

    /// A point of one of two walls.
    fn obstacle(&mut self) -> Millimetres {
        let along = self.random.between(-500, 500);
        if self.random.once_in(2) { self.near(along, 400, 3) } else { self.near(650, along, 3) }
    }

    fn near(&mut self, x: i32, y: i32, noise: i32) -> Millimetres {
        let [x, y] = [x, y].map(|mm| mm.wrapping_add(self.random.between(-noise, noise)) as i16);
        Millimetres { x, y }
    }

    fn heard(&mut self) -> Heard {
        let age_ms = if self.irregular { self.random.below(600) as u16 } else { 0 };
        Heard { message: self.message(), age_ms }
    }

    fn message(&mut self) -> Message {
        let [x, y] = self.position.map(|micrometres| micrometres / 1000);
        let target = self.random.below(2) as u8;
        let points = self.random.below(5);
        Message {
            sender: self.random.below(12) as u16 * 100,
            position: self.near(x, y, 250),
            target: (!self.random.once_in(4)).then(|| TargetReport {
                target,
                position: self.target(target, 12),
                velocity: [16, 0],
                age: self.random.below(40) as u8,
            }),
            obstacles: filled(
                (0..points).map(|_| ObstacleReport { position: self.obstacle(), age: self.random.below(44) as u8 }),
            ),
        }
    }
}
