//! What a robot knows of the world: its own sightings and what others broadcast, with their age.

use super::epuck2::TICKS_PER_SECOND;
use super::message::{MAX_REPORTED_OBSTACLES, ObstacleReport, TargetReport};
use super::percept::{MAX_TARGETS, Millimetres, Percept, Sighting};
use crate::geometry::{Point, Vector};
use crate::scalar::Scalar;
use heapless::Vec;

/// The most obstacle points kept in mind: the nearest ones.
pub const MAX_OBSTACLES: usize = 16;
/// The most neighbours kept in mind: the nearest ones.
pub const MAX_NEIGHBOURS: usize = 8;

/// A target nobody has seen for 5 s is forgotten; one sighting more than 255 ticks old cannot be reported.
const FORGET_TARGET_TICKS: u8 = 5 * TICKS_PER_SECOND as u8;
/// A neighbour not heard for 1 s is forgotten.
const FORGET_NEIGHBOUR_TICKS: u8 = TICKS_PER_SECOND as u8;
/// Obstacle ages are counted in units of 8 ticks; forgotten after 10 s.
const OBSTACLE_AGE_UNIT: u32 = 8;
const FORGET_OBSTACLE_UNITS: u8 = (10 * TICKS_PER_SECOND as u32 / OBSTACLE_AGE_UNIT) as u8;

/// Everything known, in world metres, extrapolated to the current tick.
///
/// Who is nearer is decided in whole millimetres, which messages are in anyway: alike for every number type, and without
/// a square root for each of the many points that arrive in a tick.
#[derive(Clone, Debug)]
pub struct Knowledge<S> {
    targets: Vec<KnownTarget<S>, MAX_TARGETS>,
    obstacles: Vec<KnownObstacle, MAX_OBSTACLES>,
    obstacle_points: Vec<Point<S>, MAX_OBSTACLES>,
    neighbours: Vec<Neighbour<S>, MAX_NEIGHBOURS>,
    tick: u32,
}

/// A target as this robot knows it.
#[derive(Clone, Copy, Debug)]
pub struct KnownTarget<S> {
    /// Which target.
    pub target: u8,
    /// Expected position now.
    pub position: Point<S>,
    /// Estimated velocity, metres per second.
    pub velocity: Vector<S>,
    age: u8,
}

#[derive(Clone, Copy, Debug)]
struct KnownObstacle {
    position: Millimetres,
    age: u8,
}

/// Another robot nearby.
#[derive(Clone, Copy, Debug)]
pub struct Neighbour<S> {
    robot: u8,
    /// Where it was when last heard.
    pub position: Point<S>,
    place: Millimetres,
    age: u8,
}

/// What every obstacle point that arrives in a tick is compared with. There are dozens a tick, so the comparisons are over
/// whole arrays and without branches.
struct Comparison {
    here: Millimetres,
    /// Coordinates of the known points, packed; those from `known` on mean nothing.
    keys: [u32; MAX_OBSTACLES],
    known: usize,
    /// Squared distances of the known points from here, mm².
    squares: [u64; MAX_OBSTACLES],
    farthest: usize,
    largest: u64,
}

impl Comparison {
    fn new(obstacles: &[KnownObstacle], here: Millimetres) -> Self {
        let (keys, squares) = ([0; MAX_OBSTACLES], [0; MAX_OBSTACLES]);
        let mut comparison = Comparison { here, keys, known: 0, squares, farthest: 0, largest: 0 };
        for (index, obstacle) in obstacles.iter().enumerate() {
            comparison.put(index, obstacle.position);
        }
        comparison.known = obstacles.len();
        comparison.find_farthest();
        comparison
    }

    fn key(position: Millimetres) -> u32 {
        (u32::from(position.x as u16) << 16) | u32::from(position.y as u16)
    }

    fn put(&mut self, index: usize, position: Millimetres) {
        if let (Some(key), Some(square)) = (self.keys.get_mut(index), self.squares.get_mut(index)) {
            *key = Self::key(position);
            *square = squared_distance(position, self.here);
        }
    }

    fn find_farthest(&mut self) {
        (self.farthest, self.largest) = largest_of(self.squares.into_iter());
    }

    /// Which known point is exactly here, if any.
    fn position_of(&self, position: Millimetres) -> Option<usize> {
        let key = Self::key(position);
        let bits =
            self.keys.iter().zip(0_u32..).fold(0, |bits, (&known, index)| bits | (u32::from(known == key) << index));
        let index = bits.trailing_zeros() as usize;
        (index < self.known).then_some(index)
    }
}

/// The first of the largest numbers: its index and itself; (0, 0) for none.
fn largest_of(numbers: impl Iterator<Item = u64>) -> (usize, u64) {
    numbers.enumerate().reduce(|a, b| if b.1 > a.1 { b } else { a }).unwrap_or((0, 0))
}

/// The squared distance between two places, mm².
fn squared_distance(a: Millimetres, b: Millimetres) -> u64 {
    let square = |a: i16, b: i16| u64::from(a.abs_diff(b)) * u64::from(a.abs_diff(b));
    square(a.x, b.x) + square(a.y, b.y)
}

pub(super) fn metres<S: Scalar>(position: Millimetres) -> Point<S> {
    let metre = |mm: i16| S::from_ratio(i32::from(mm), 1000);
    Vector::new(metre(position.x), metre(position.y))
}

fn millimetres<S: Scalar>(position: Point<S>) -> Millimetres {
    let mm = |metres: S| metres.times_to_i32(1000).clamp(-32_767, 32_767) as i16;
    Millimetres { x: mm(position.x), y: mm(position.y) }
}

impl<S: Scalar> Knowledge<S> {
    pub fn new() -> Self {
        Knowledge {
            targets: Vec::new(),
            obstacles: Vec::new(),
            obstacle_points: Vec::new(),
            neighbours: Vec::new(),
            tick: 0,
        }
    }

    pub fn targets(&self) -> &[KnownTarget<S>] {
        &self.targets
    }

    pub fn obstacles(&self) -> &[Point<S>] {
        &self.obstacle_points
    }

    pub fn neighbours(&self) -> &[Neighbour<S>] {
        &self.neighbours
    }

    /// Takes one tick's percept in; `here` is the robot's own position.
    pub fn update(&mut self, percept: &Percept, here: Point<S>) {
        self.grow_older();
        for sighting in &percept.targets {
            self.see_target(*sighting);
        }
        if percept.obstacles.is_empty() && percept.heard.is_empty() {
            return;
        }
        let here = millimetres(here);
        let mut comparison = Comparison::new(&self.obstacles, here);
        for &position in &percept.obstacles {
            self.learn_obstacle(KnownObstacle { position, age: 0 }, &mut comparison);
        }
        for message in &percept.heard {
            if let Some(report) = &message.target {
                self.hear_of_target(report);
            }
            for &ObstacleReport { position, age } in &message.obstacles {
                self.learn_obstacle(KnownObstacle { position, age }, &mut comparison);
            }
            self.meet(message.sender, message.position, here);
        }
    }

    fn grow_older(&mut self) {
        self.tick = self.tick.wrapping_add(1);
        for target in &mut self.targets {
            target.age = target.age.saturating_add(1);
            target.position = target.position + target.velocity * S::from_ratio(1, i32::from(TICKS_PER_SECOND));
        }
        self.targets.retain(|target| target.age <= FORGET_TARGET_TICKS);
        for neighbour in &mut self.neighbours {
            neighbour.age = neighbour.age.saturating_add(1);
        }
        if self.neighbours.iter().any(|neighbour| neighbour.age > FORGET_NEIGHBOUR_TICKS) {
            self.neighbours.retain(|neighbour| neighbour.age <= FORGET_NEIGHBOUR_TICKS);
        }
        if self.tick.is_multiple_of(OBSTACLE_AGE_UNIT) {
            for obstacle in &mut self.obstacles {
                obstacle.age = obstacle.age.saturating_add(1);
            }
            if self.obstacles.iter().any(|obstacle| obstacle.age > FORGET_OBSTACLE_UNITS) {
                self.obstacles.retain(|obstacle| obstacle.age <= FORGET_OBSTACLE_UNITS);
                self.obstacle_points.clear();
                self.obstacle_points.extend(self.obstacles.iter().map(|obstacle| metres(obstacle.position)));
            }
        }
    }

    /// An alpha-beta filter: sightings correct the position by 2/5 and the velocity by 1/32 of the surprise per tick.
    fn see_target(&mut self, sighting: Sighting) {
        let seen = metres(sighting.position);
        match self.targets.iter_mut().find(|known| known.target == sighting.target) {
            Some(known) => {
                let surprise = seen - known.position;
                known.position = known.position + surprise * S::from_ratio(2, 5);
                known.velocity = known.velocity + surprise * S::from_ratio(i32::from(TICKS_PER_SECOND), 32);
                known.age = 0;
            }
            None => {
                let known = KnownTarget { target: sighting.target, position: seen, velocity: Vector::ZERO, age: 0 };
                // A fifth target does not fit and is left out: percepts hold at most four.
                let _ = self.targets.push(known);
            }
        }
    }

    /// The fresher of report and own knowledge stands.
    fn hear_of_target(&mut self, report: &TargetReport) {
        let age = report.age.saturating_add(1);
        let known = self.targets.iter_mut().find(|known| known.target == report.target);
        if age > FORGET_TARGET_TICKS || known.as_ref().is_some_and(|known| age >= known.age) {
            return;
        }
        let [east, north] = report.velocity.map(|mm| S::from_ratio(i32::from(mm), 1000));
        let told = KnownTarget {
            target: report.target,
            position: metres(report.position),
            velocity: Vector::new(east, north),
            age,
        };
        match known {
            Some(known) => *known = told,
            None => {
                let _ = self.targets.push(told);
            }
        }
    }

    fn learn_obstacle(&mut self, told: KnownObstacle, comparison: &mut Comparison) {
        if told.age > FORGET_OBSTACLE_UNITS {
            return;
        }
        if let Some(index) = comparison.position_of(told.position) {
            if let Some(known) = self.obstacles.get_mut(index) {
                known.age = known.age.min(told.age);
            }
            return;
        }
        let index = if self.obstacles.push(told).is_ok() {
            let _ = self.obstacle_points.push(metres(told.position));
            comparison.known += 1;
            self.obstacles.len() - 1
        } else if squared_distance(told.position, comparison.here) < comparison.largest {
            let index = comparison.farthest;
            if let (Some(known), Some(point)) = (self.obstacles.get_mut(index), self.obstacle_points.get_mut(index)) {
                *known = told;
                *point = metres(told.position);
            }
            index
        } else {
            return;
        };
        comparison.put(index, told.position);
        comparison.find_farthest();
    }

    fn meet(&mut self, robot: u8, place: Millimetres, here: Millimetres) {
        let met = || Neighbour { robot, position: metres(place), place, age: 0 };
        if let Some(known) = self.neighbours.iter_mut().find(|known| known.robot == robot) {
            *known = met();
            return;
        }
        if !self.neighbours.is_full() {
            let _ = self.neighbours.push(met());
            return;
        }
        let (farthest, square) = largest_of(self.neighbours.iter().map(|known| squared_distance(known.place, here)));
        if squared_distance(place, here) < square
            && let Some(farthest) = self.neighbours.get_mut(farthest)
        {
            *farthest = met();
        }
    }

    /// What to tell the others: one target in turn, and obstacle points in turn, own sightings first.
    pub fn report(&self, turn: u32, percept: &Percept) -> (Option<TargetReport>, Vec<ObstacleReport, 4>) {
        let target = nth_in_turn(&self.targets, turn).map(|known| TargetReport {
            target: known.target,
            position: millimetres(known.position),
            velocity: [known.velocity.x, known.velocity.y]
                .map(|metres| metres.times_to_i32(1000).clamp(-127, 127) as i8),
            age: known.age,
        });
        let first = turn.wrapping_mul(MAX_REPORTED_OBSTACLES as u32);
        let turns = (0..MAX_REPORTED_OBSTACLES as u32).map(|k| first.wrapping_add(k));
        let obstacles = if percept.obstacles.is_empty() {
            let count = self.obstacles.len();
            turns
                .take(count)
                .filter_map(|turn| nth_in_turn(&self.obstacles, turn))
                .map(|known| ObstacleReport { position: known.position, age: known.age })
                .collect()
        } else {
            let count = percept.obstacles.len();
            turns
                .take(count)
                .filter_map(|turn| nth_in_turn(&percept.obstacles, turn))
                .map(|&position| ObstacleReport { position, age: 0 })
                .collect()
        };
        (target, obstacles)
    }
}

fn nth_in_turn<T>(items: &[T], turn: u32) -> Option<&T> {
    let index = turn.checked_rem(items.len() as u32)?;
    items.get(index as usize)
}
