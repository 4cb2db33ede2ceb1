//! What a robot knows of the world: its own sightings and what others broadcast, with their age.

use super::clock::{Pace, ticks_of};
use super::epuck2::TICKS_PER_SECOND;
use super::message::{BROADCAST_PERIOD, MAX_REPORTED_OBSTACLES, Message, ObstacleReport, TargetReport};
use super::neighbours::{Neighbour, Neighbours};
use super::obstacles::ObstacleMap;
use super::percept::{Heard, MAX_TARGETS, Percept, Sighting};
use super::position::{metres, millimetres};
use crate::bounded::filled;
use crate::geometry::{Point, Vector};
use crate::scalar::Scalar;
use heapless::Vec;

/// A target nobody has seen for 5 s is forgotten; one sighting more than 255 ticks old cannot be reported.
const FORGET_TARGET_TICKS: u8 = 5 * TICKS_PER_SECOND as u8;
/// A target this far from where it was expected, in x or y, 25 cm, has jumped: no error that a swarm can work with is larger.
const FAR_UM: i32 = 250_000;
/// A sighting counts for no longer than so many ticks, half of it then. More would not come to rest.
const MOST_TICKS_AT_ONCE: u32 = 4;
/// A report that is so many ticks more recent, half a second, counts wholly; every one that is more recent counts for a quarter.
const WHOLE: i32 = TICKS_PER_SECOND as i32 / 2;
const LEAST_PART: i32 = WHOLE / 4;
/// Obstacle ages are counted in units of 8 ticks; that often neighbours are forgotten, too.
const OBSTACLE_AGE_UNIT: u32 = 8;

/// Everything known, in world metres, extrapolated to the current tick.
#[derive(Clone, Debug)]
pub struct Knowledge<S> {
    targets: Vec<KnownTarget<S>, MAX_TARGETS>,
    obstacles: ObstacleMap<S>,
    neighbours: Neighbours<S>,
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

impl<S: Scalar> Default for Knowledge<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Scalar> Knowledge<S> {
    /// Of a robot that knows nothing yet.
    pub fn new() -> Self {
        Knowledge { targets: Vec::new(), obstacles: ObstacleMap::new(), neighbours: Neighbours::new() }
    }

    /// The targets that it knows, where they are expected to be now.
    pub fn targets(&self) -> &[KnownTarget<S>] {
        &self.targets
    }

    /// The obstacle points of which one is the nearest.
    pub fn obstacles(&self) -> &[Point<S>] {
        self.obstacles.near()
    }

    /// The robots nearby.
    pub fn neighbours(&self) -> &Neighbours<S> {
        &self.neighbours
    }

    /// Whether what pushes the robot at `here` this way can be a neighbour or a wall that it knows.
    pub fn knows_what_pushes(&self, here: Point<S>, push: Vector<S>) -> bool {
        let seen_from = self.neighbours.seen_from(here);
        let pushes = |neighbour: &Neighbour<S>| {
            let offset = neighbour.offset(seen_from);
            // Within 45° of the way it pushes.
            offset.cross(push).abs() < offset.dot(push)
        };
        let mut close_neighbours = self.neighbours.known().iter().filter(|neighbour| neighbour.was_close());
        let on_this_side = |&point: &Point<S>| (here - point).dot(push) > S::ZERO;
        close_neighbours.any(pushes) || (self.obstacles.is_close() && self.obstacles().iter().any(on_this_side))
    }

    /// Lets everything known grow older, up to the clock's tick `now`: targets move on, and the neighbours with the
    /// robot's own target, whose `velocity` (metres per second) is given. The robot is at `here`.
    pub fn grow_older(&mut self, pace: &Pace<S>, now: u32, velocity: Vector<S>, here: Point<S>) {
        self.neighbours.carry(velocity * pace.seconds);
        let mut oldest = 0;
        for target in &mut self.targets {
            target.age = target.age.saturating_add(pace.ticks as u8);
            target.position = target.position + target.velocity * pace.seconds;
            oldest = oldest.max(target.age);
        }
        if oldest > FORGET_TARGET_TICKS {
            self.targets.retain(|target| target.age <= FORGET_TARGET_TICKS);
        }
        // One of the ticks that have begun is a multiple of the unit.
        let last = now.wrapping_sub(1);
        if last % OBSTACLE_AGE_UNIT < pace.ticks {
            self.obstacles.grow_older(millimetres(here));
            self.neighbours.forget(last);
        }
    }

    /// Takes in the percept of robot number `own` in tick `now`, `ticks` after the last one; it is at `here`, and its own target
    /// moves at `velocity`.
    ///
    /// Of the messages heard in a tick, only one has its obstacle points learned. That bounds the time of a tick, and costs
    /// little: walls stand still or are slow, so the other points can be learned when they are told again.
    /// Some radios (a broadcast over UDP, for one) give the robot its own messages back; it ignores them. It would
    /// otherwise take itself for a neighbour that it must keep away from.
    pub fn update(&mut self, percept: &Percept, here: Point<S>, own: u16, [now, ticks]: [u32; 2], velocity: Vector<S>) {
        let (at, here) = (here, millimetres(here));
        let part = S::from_ratio(ticks.min(MOST_TICKS_AT_ONCE) as i32, 8);
        for sighting in &percept.targets {
            self.see_target(*sighting, part, at);
        }
        for &position in &percept.obstacles {
            self.obstacles.learn(&ObstacleReport { position, age: 0 });
        }
        let mut own_messages = 0;
        for &Heard { ref message, age_ms } in &percept.heard {
            if message.sender == own {
                own_messages += 1;
                continue;
            }
            if let Some(report) = &message.target {
                self.hear_of_target(report, age_ms, at);
            }
            let mut carried = self.neighbours.carried();
            if age_ms > 0 {
                carried = carried - velocity * seconds(age_ms);
            }
            self.neighbours.meet(message.sender, message.position, carried, here, now);
        }
        let turn = whose_turn(now, percept.heard.len() - own_messages);
        let chosen = match own_messages {
            0 => percept.heard.get(turn),
            _ => percept.heard.iter().filter(|heard| heard.message.sender != own).nth(turn),
        };
        for report in chosen.into_iter().flat_map(|heard| &heard.message.obstacles) {
            self.obstacles.learn(report);
        }
        self.obstacles.find_near();
    }

    /// An alpha-beta filter: a sighting corrects a `part` of the surprise, an eighth for each tick of 1/32 s since the last one, and
    /// the velocity by twice that a second. After a right-angled turn the target is expected off by up
    /// to its way in a quarter of a second, and where it is again after one and a half. One that has jumped is followed at once.
    fn see_target(&mut self, sighting: Sighting, part: S, here: Point<S>) {
        let seen = metres(sighting.position);
        match self.targets.iter_mut().find(|known| known.target == sighting.target) {
            Some(known) => {
                let surprise = seen - known.position;
                if is_far(surprise) {
                    known.position = seen;
                } else {
                    known.position = known.position + surprise * part;
                    known.velocity = known.velocity + surprise * (part + part);
                }
                known.age = 0;
            }
            None => {
                let new = KnownTarget { target: sighting.target, position: seen, velocity: Vector::ZERO, age: 0 };
                self.keep(new, here);
            }
        }
    }

    /// A report that is more recent than what the robot knows of that target corrects it: by a quarter of the difference, or
    /// the larger part that the time between both is of half a second.
    ///
    /// Each mother tells where targets are from where she believes to be. Those who hear several of them so come to know the
    /// mean, which is less off than any of them, and all the same one; if the last report replaced the others, robots would
    /// follow now this mother's error, now that one's.
    ///
    /// It is older by the time it was on its way, and by one tick at least: else robots would tell each other for ever
    /// what nobody sees any more.
    fn hear_of_target(&mut self, report: &TargetReport, age_ms: u16, here: Point<S>) {
        let on_its_way = if age_ms == 0 { 1 } else { ticks_of(age_ms).clamp(1, u32::from(u8::MAX)) as u8 };
        let age = report.age.saturating_add(on_its_way);
        let known = self.targets.iter_mut().find(|known| known.target == report.target);
        if age > FORGET_TARGET_TICKS || known.as_ref().is_some_and(|known| age >= known.age) {
            return;
        }
        let [east, north] = report.velocity.map(|mm| S::from_millionths(i32::from(mm) * 1000));
        let (velocity, mut position) = (Vector::new(east, north), metres(report.position));
        if age_ms > 0 {
            position = position + velocity * seconds(age_ms);
        }
        let told = KnownTarget { target: report.target, position, velocity, age };
        match known {
            Some(known) if !is_far(told.position - known.position) => {
                let part = S::from_ratio(i32::from(known.age - age).clamp(LEAST_PART, WHOLE), WHOLE);
                known.position = known.position + (told.position - known.position) * part;
                known.velocity = known.velocity + (told.velocity - known.velocity) * part;
                known.age = age;
            }
            Some(known) => *known = told,
            None => self.keep(told, here),
        }
    }

    /// Keeps a target that was not known; if there is no room, in the place of the one farthest from `here` if it is nearer than that.
    /// So each robot of a swarm that follows many targets knows those around it.
    fn keep(&mut self, new: KnownTarget<S>, here: Point<S>) {
        let Err(new) = self.targets.push(new) else { return };
        let squared = |known: &KnownTarget<S>| (known.position - here).square();
        let mut farthest: Option<&mut KnownTarget<S>> = None;
        for known in &mut self.targets {
            if farthest.as_ref().is_none_or(|farthest| squared(known) > squared(farthest)) {
                farthest = Some(known);
            }
        }
        if let Some(farthest) = farthest
            && squared(&new) < squared(farthest)
        {
            *farthest = new;
        }
    }

    /// What robot number `sender` at `here` broadcasts, if one of the `ticks` ticks that have begun, of which `now` is the last, is its turn.
    #[inline]
    pub fn message(&self, sender: u16, here: Point<S>, [now, ticks]: [u32; 2], percept: &Percept) -> Option<Message> {
        let turn = now.wrapping_add(u32::from(sender));
        if turn % BROADCAST_PERIOD >= ticks {
            return None;
        }
        let (target, obstacles) = self.report(turn / BROADCAST_PERIOD, percept);
        Some(Message { sender, position: millimetres(here), target, obstacles })
    }

    /// What to tell the others: one target in turn, and obstacle points in turn, own sightings first.
    fn report(&self, turn: u32, percept: &Percept) -> (Option<TargetReport>, Vec<ObstacleReport, 4>) {
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
            let count = self.obstacles.known().len();
            filled(turns.take(count).filter_map(|turn| nth_in_turn(self.obstacles.known(), turn)).copied())
        } else {
            let count = percept.obstacles.len();
            let seen = turns.take(count).filter_map(|turn| nth_in_turn(&percept.obstacles, turn));
            filled(seen.map(|&position| ObstacleReport { position, age: 0 }))
        };
        (target, obstacles)
    }
}

/// Which one of so many messages has its obstacle points learned in tick `now`.
///
/// Robots speak periodically, so the same ones are heard together again and again, and each repeats its points with a
/// period of its own. If the choice were periodic too, the periods could match and some points would never be learned.
/// Multiples of the golden ratio, modulo 1, are spread evenly and have no period.
fn whose_turn(now: u32, messages: usize) -> usize {
    const GOLDEN_RATIO_Q32: u32 = 0x9e37_79b9;
    let share = (now / BROADCAST_PERIOD).wrapping_mul(GOLDEN_RATIO_Q32);
    ((u64::from(share) * messages as u64) >> u32::BITS) as usize
}

/// Whether a target was not only seen badly but is elsewhere: [`FAR_UM`] or more in x or y.
fn is_far<S: Scalar>(Vector { x, y }: Vector<S>) -> bool {
    let limit = S::from_millionths(FAR_UM);
    x.abs() >= limit || y.abs() >= limit
}

/// Milliseconds as seconds.
fn seconds<S: Scalar>(milliseconds: u16) -> S {
    S::from_millionths(i32::from(milliseconds) * 1000)
}

fn nth_in_turn<T>(items: &[T], turn: u32) -> Option<&T> {
    let index = turn.checked_rem(items.len() as u32)?;
    items.get(index as usize)
}

#[cfg(test)]
mod tests {
    use super::super::clock::Clock;
    use super::super::percept::NOMINAL_TICK_US;
    use super::*;
    use crate::robot::{Message, Millimetres};

    /// Ticks of 1/32 s, each with its number, what is seen of target 0 and which reports of it are heard: positions, metres.
    struct Robot {
        knowledge: Knowledge<f32>,
        clock: Clock,
    }

    impl Robot {
        fn new() -> Self {
            Robot { knowledge: Knowledge::new(), clock: Clock::default() }
        }

        /// Where it expects the target after a tick in which it sees it, or hears others who do, at these places, mm.
        fn tick(&mut self, seen: Option<[i16; 2]>, heard: &[(u16, i16)]) -> Point<f32> {
            let pace = self.clock.advance::<f32>(NOMINAL_TICK_US);
            self.knowledge.grow_older(&pace, self.clock.tick(), Vector::ZERO, Vector::ZERO);
            let mut percept = Percept::nothing();
            let sighting = |[x, y]: [i16; 2]| Sighting { target: 0, position: Millimetres { x, y } };
            percept.targets.extend(seen.map(sighting));
            percept.heard.extend(heard.iter().map(|&(sender, x)| {
                let position = Millimetres { x, y: 0 };
                let target = Some(TargetReport { target: 0, position, velocity: [0; 2], age: 0 });
                Heard { message: Message { sender, position, target, obstacles: Vec::new() }, age_ms: 0 }
            }));
            let now = [self.clock.tick(), pace.ticks];
            self.knowledge.update(&percept, Vector::ZERO, 9, now, Vector::ZERO);
            self.knowledge.targets()[0].position
        }
    }

    #[test]
    fn of_two_mothers_who_disagree_the_mean_is_believed() {
        // The second speaks 1, 4 or 7 ticks after the first.
        for later in [1, 4, 7] {
            let mut robot = Robot::new();
            let mut expected = std::vec::Vec::new();
            for tick in 0..320 {
                expected.push(match tick % 8 {
                    0 => robot.tick(None, &[(1, 50)]).x,
                    turn if turn == later => robot.tick(None, &[(2, -50)]).x,
                    _ => robot.tick(None, &[]).x,
                });
            }
            assert!(expected[160..].iter().all(|x| x.abs() < 0.03), "{later}: {:?}", &expected[312..]);
        }
    }

    #[test]
    fn of_many_targets_the_nearest_are_known() {
        let mut robot = Robot::new();
        let report = |target: u8| {
            let position = Millimetres { x: 1000 * i16::from(target), y: 0 };
            let target = Some(TargetReport { target, position, velocity: [0; 2], age: 0 });
            Heard { message: Message { sender: 1, position, target, obstacles: Vec::new() }, age_ms: 0 }
        };
        // The robot drives along a row of ten targets, of which it hears one after the other.
        for (metres, expected) in [(0.0, [0, 1, 2, 3]), (5.0, [4, 5, 6, 7]), (9.0, [6, 7, 8, 9])] {
            for tick in 0..100_u32 {
                let pace = robot.clock.advance::<f32>(NOMINAL_TICK_US);
                robot.knowledge.grow_older(&pace, robot.clock.tick(), Vector::ZERO, Vector::ZERO);
                let mut percept = Percept::nothing();
                percept.heard.push(report((tick * 7 % 10) as u8)).unwrap();
                let here = Vector::new(metres + 0.1, 0.0);
                robot.knowledge.update(&percept, here, 9, [robot.clock.tick(), pace.ticks], Vector::ZERO);
            }
            let mut known: std::vec::Vec<u8> = robot.knowledge.targets().iter().map(|known| known.target).collect();
            known.sort_unstable();
            assert_eq!(known, expected, "at {metres} m");
        }
    }

    #[test]
    fn a_target_that_turns_or_jumps_is_followed() {
        let mut robot = Robot::new();
        // 96 mm/s to the east for 5 s, then to the north.
        let place = |tick: i16| if tick < 160 { [3 * tick, 0] } else { [480, 3 * (tick - 160)] };
        let error = |expected: Point<f32>, [x, y]: [i16; 2]| {
            (expected - Vector::new(f32::from(x) * 1e-3, f32::from(y) * 1e-3)).length()
        };
        for tick in 0..320 {
            let off = error(robot.tick(Some(place(tick)), &[]), place(tick));
            let most = if (96..160).contains(&tick) || tick >= 208 { 0.003 } else { 0.024 };
            assert!(off < most, "{tick}: {off}");
        }
        let jumped = [-500, 700];
        assert!(error(robot.tick(Some(jumped), &[]), jumped) < 1e-6);
    }
}
