//! What goes wrong in a run, and when: all of it is drawn before the run begins.

use crate::lab::{FaultKind, Faults, Laboratory, ScheduledFault};
use crate::random::{Component, Stream};
use crate::timing::{FRAME_S, frames_in};
use core::f64::consts::TAU;
use core::ops::Range;
use grn_core::geometry::Vector;
use grn_core::robot::epuck2::PROXIMITY_SENSORS;
use grn_input::InputError;
use std::collections::BTreeSet;

/// How long a robot takes to reboot, frames: a second.
const REBOOT_FRAMES: u64 = 32;
/// How far a tracking system that jumps is off, metres.
const JUMP_M: [f64; 2] = [0.1, 0.3];
/// The most faults that rates may make expected in a run; they are all kept and reported.
const MOST_EXPECTED: f64 = 1e5;
/// Streams of robots come before those of scheduled faults.
const SCHEDULED: usize = 1 << 32;

/// Something that goes wrong with one robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The first frame in which it does.
    pub from: u64,
    /// Which robot.
    pub robot: usize,
    /// What.
    pub kind: FaultKind,
    /// The first frame in which it no longer does; `None` if it is for good.
    pub until: Option<u64>,
    /// What else is left to chance about it: which wheel or sensor, where to.
    pub(crate) lot: u64,
}

impl Fault {
    fn new(kind: FaultKind, robot: usize, from: u64, frames: Option<u64>, lot: u64) -> Self {
        let (from, until) = match kind {
            FaultKind::Carried => (from, Some(from + 1)),
            FaultKind::Reboot => (from, Some(from + REBOOT_FRAMES)),
            FaultKind::Late => (0, Some(from)),
            _ => (from, frames.map(|frames| from + frames.max(1))),
        };
        Fault { from, robot, kind, until, lot }
    }

    /// Which wheel (0 left, 1 right) or proximity sensor has it, if one of them has.
    pub fn part(&self) -> Option<usize> {
        match self.kind {
            FaultKind::Wheel => Some((self.lot % 2) as usize),
            FaultKind::SensorDead | FaultKind::SensorShorted => Some((self.lot % PROXIMITY_SENSORS as u64) as usize),
            _ => None,
        }
    }

    /// What is drawn anew about it.
    pub(crate) fn stream(&self) -> Stream {
        Stream::new(self.lot, Component::Faults, self.robot)
    }

    /// By how much poses are off while the tracking system jumps, metres.
    pub(crate) fn jump(&self) -> Vector<f64> {
        let mut stream = self.stream();
        let (sin, cos) = libm::sincos(stream.unit() * TAU);
        let [least, most] = JUMP_M;
        Vector::new(cos, sin) * (least + stream.unit() * (most - least))
    }

    /// Whether the robot is out of the swarm's service meanwhile: it cannot do its part, so it is not judged by it.
    fn suspends(&self) -> bool {
        use FaultKind::{Carried, Late, Reboot, Stop, Wheel};
        matches!(self.kind, Stop | Carried | Reboot | Wheel | Late)
    }

    /// The moment in which it disturbs the swarm: a robot that is late does so when it joins.
    fn disturbs_at(&self) -> u64 {
        if self.kind == FaultKind::Late { self.until.unwrap_or(0) } else { self.from }
    }
}

/// Everything that goes wrong in a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaultPlan(Vec<Fault>);

impl FaultPlan {
    /// What is scheduled in this laboratory, and what chance adds in the run of `frames` frames with this seed.
    ///
    /// # Errors
    /// [`InputError`] when the rates would make more than 100,000 faults.
    pub fn drawn(lab: &Laboratory, seed: u64, frames: u64) -> Result<Self, InputError> {
        let (faults, robots) = (&lab.faults, lab.robots.count);
        let hours = frames as f64 * FRAME_S / 3600.0;
        let expected = faults.rates().map(|(_, rate)| rate).iter().sum::<f64>() * robots as f64 * hours;
        if expected > MOST_EXPECTED {
            let way_out = format!(
                "{robots} robots would have about {expected:.0} faults in a run of {hours:.1} hours; lower the rates or shorten the \
                 run, so that they are at most {MOST_EXPECTED:.0}"
            );
            return Err(InputError::new("faults", "", way_out));
        }
        let mut plan = Vec::new();
        for (place, scheduled) in faults.at.iter().enumerate() {
            let mut stream = Stream::new(seed, Component::Faults, SCHEDULED + place);
            plan.extend(of_schedule(scheduled, robots, &mut stream));
        }
        for robot in 0..robots {
            for (kind, per_hour) in faults.rates().into_iter().filter(|&(_, per_hour)| per_hour > 0.0) {
                let mut stream = Stream::new(seed, Component::Faults, robot * 16 + kind as usize);
                by_rate(kind, robot, per_hour, faults, frames, &mut stream, &mut plan);
            }
        }
        plan.sort_by_key(|fault| (fault.from, fault.robot, fault.kind));
        Ok(FaultPlan(plan))
    }

    /// All faults, by when they begin, then by robot.
    pub fn faults(&self) -> &[Fault] {
        &self.0
    }

    /// The faults of each of so many robots, by when they begin.
    pub fn by_robot(&self, robots: usize) -> Vec<Vec<Fault>> {
        let mut by_robot = vec![Vec::new(); robots];
        self.0.iter().for_each(|fault| by_robot[fault.robot].push(*fault));
        by_robot
    }

    /// The ticks in which something goes wrong while the swarm is under way, or a robot joins it; rising.
    pub fn disturbances(&self) -> Vec<u64> {
        let ticks: BTreeSet<u64> = self.0.iter().map(Fault::disturbs_at).filter(|&tick| tick > 0).collect();
        ticks.into_iter().collect()
    }

    /// When which robot is out of service.
    pub fn absences(&self) -> Absences {
        let mut absences = Absences::default();
        for fault in self.0.iter().filter(|fault| fault.suspends()) {
            // The world after a frame is still what the fault has made of it.
            absences.add(fault.robot, fault.from..fault.until.map_or(u64::MAX, |until| until + 1));
        }
        absences
    }
}

fn of_schedule(scheduled: &ScheduledFault, robots: usize, stream: &mut Stream) -> Vec<Fault> {
    let &ScheduledFault { kind, robot, share, at_s, lasts_s } = scheduled;
    let mut numbers: Vec<usize> = match robot {
        Some(robot) => vec![robot],
        None => (0..robots).collect(),
    };
    if let Some(share) = share {
        let chosen = ((share * robots as f64 + 0.5) as usize).clamp(1, robots);
        for place in 0..chosen {
            let other = place + (stream.unit() * (robots - place) as f64) as usize;
            numbers.swap(place, other);
        }
        numbers.truncate(chosen);
        numbers.sort_unstable();
    }
    let mut fault = |robot| Fault::new(kind, robot, frames_in(at_s), lasts_s.map(frames_in), stream.seed());
    numbers.into_iter().map(&mut fault).collect()
}

/// A Poisson process; while a fault lasts the same one does not begin again.
fn by_rate(
    kind: FaultKind,
    robot: usize,
    per_hour: f64,
    faults: &Faults,
    frames: u64,
    stream: &mut Stream,
    plan: &mut Vec<Fault>,
) {
    let mut now = 0.0;
    loop {
        now += exponential(3600.0 / per_hour, stream);
        let (lasts_s, lot) = (exponential(faults.lasts_s, stream), stream.seed());
        let fault = Fault::new(kind, robot, frames_in(now), Some(frames_in(lasts_s)), lot);
        if fault.from >= frames {
            return;
        }
        now = fault.until.map_or(now, |until| now.max(until as f64 * FRAME_S));
        plan.push(fault);
    }
}

/// From the exponential distribution with this mean.
fn exponential(mean: f64, stream: &mut Stream) -> f64 {
    -libm::log(1.0 - stream.unit()) * mean
}

/// When which robot is out of service: broken down, on its way from one place to another, not there yet.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Absences {
    /// By robot, apart from each other, rising. Robots beyond the list's end are never absent.
    robots: Vec<Vec<Range<u64>>>,
}

impl Absences {
    /// Adds ticks in which a robot is out of service; for one robot in the order of their beginnings.
    pub fn add(&mut self, robot: usize, ticks: Range<u64>) {
        if robot >= self.robots.len() {
            self.robots.resize(robot + 1, Vec::new());
        }
        let known = &mut self.robots[robot];
        match known.last_mut() {
            Some(last) if ticks.start <= last.end => last.end = last.end.max(ticks.end),
            _ => known.push(ticks),
        }
    }

    /// Whether the robot is in service in all of these ticks.
    pub fn none_in(&self, robot: usize, ticks: Range<u64>) -> bool {
        self.robots.get(robot).is_none_or(|known| {
            let begun = known.partition_point(|known| known.start < ticks.end);
            known[..begun].last().is_none_or(|known| known.end <= ticks.start)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOUR: u64 = 3600 * 32;

    fn lab(faults: Faults, robots: usize) -> Laboratory {
        let mut lab = Laboratory { faults, ..Laboratory::default() };
        lab.robots.count = robots;
        lab
    }

    fn scheduled(kind: FaultKind, robot: Option<usize>, share: Option<f64>, lasts_s: Option<f64>) -> Faults {
        Faults { at: vec![ScheduledFault { kind, robot, share, at_s: 30.0, lasts_s }], ..Faults::default() }
    }

    #[test]
    fn faults_come_as_often_and_last_as_long_as_asked() {
        let faults = Faults { stop_per_hour: 6.0, radio_per_hour: 2.0, lasts_s: 20.0, ..Faults::default() };
        let plan = FaultPlan::drawn(&lab(faults, 100), 1, 10 * HOUR).unwrap();
        let of = |kind| plan.faults().iter().filter(|fault| fault.kind == kind).collect::<Vec<_>>();
        let (stops, radios) = (of(FaultKind::Stop), of(FaultKind::Radio));
        assert_eq!(stops.len() + radios.len(), plan.faults().len());
        // Of an hour, 6 times 20 s are stops already.
        let expected = 6000.0 / (1.0 + 6.0 * 20.0 / 3600.0);
        assert!((stops.len() as f64 / expected - 1.0).abs() < 0.03, "{}", stops.len());
        assert!((radios.len() as f64 / 2000.0 - 1.0).abs() < 0.06, "{}", radios.len());
        let length = stops.iter().map(|stop| stop.until.unwrap() - stop.from).sum::<u64>() as f64 * FRAME_S;
        assert!((length / stops.len() as f64 / 20.0 - 1.0).abs() < 0.05, "{length}");
        assert!(plan.faults().is_sorted_by_key(|fault| fault.from));
        let by_robot = plan.by_robot(100);
        assert_eq!(by_robot.iter().map(Vec::len).sum::<usize>(), plan.faults().len());
        for own in by_robot {
            let stops: Vec<_> = own.iter().filter(|fault| fault.kind == FaultKind::Stop).collect();
            assert!(stops.windows(2).all(|pair| pair[1].from >= pair[0].until.unwrap()));
        }
    }

    #[test]
    fn a_longer_run_or_another_rate_changes_nothing_that_was() {
        let faults = Faults { stop_per_hour: 6.0, ..Faults::default() };
        let short = FaultPlan::drawn(&lab(faults.clone(), 20), 1, HOUR).unwrap();
        let long = FaultPlan::drawn(&lab(faults.clone(), 20), 1, 2 * HOUR).unwrap();
        assert_eq!(long.faults()[..short.faults().len()], *short.faults());
        let more = FaultPlan::drawn(&lab(Faults { wheel_per_hour: 5.0, ..faults.clone() }, 20), 1, HOUR).unwrap();
        let stops: Vec<_> = more.faults().iter().filter(|fault| fault.kind == FaultKind::Stop).copied().collect();
        assert_eq!(stops, short.faults());
        assert_ne!(FaultPlan::drawn(&lab(faults, 20), 2, HOUR).unwrap(), short);
    }

    #[test]
    fn a_share_of_the_robots_is_drawn_by_seed() {
        let drawn = |share, seed| {
            let plan = FaultPlan::drawn(&lab(scheduled(FaultKind::Stop, None, Some(share), None), 12), seed, HOUR);
            plan.unwrap().faults().iter().map(|fault| fault.robot).collect::<Vec<_>>()
        };
        assert_eq!((drawn(0.25, 1).len(), drawn(0.001, 1).len(), drawn(1.0, 1).len()), (3, 1, 12));
        assert_eq!(drawn(0.25, 1), drawn(0.25, 1));
        let all: BTreeSet<usize> = (1..=30).flat_map(|seed| drawn(0.25, seed)).collect();
        assert_eq!(all.len(), 12);
        assert!((1..=30).all(|seed| drawn(0.25, seed).windows(2).all(|pair| pair[0] < pair[1])));
    }

    #[test]
    fn absences_are_those_of_robots_that_cannot_do_their_part() {
        let absent = |kind, lasts_s| {
            let plan = FaultPlan::drawn(&lab(scheduled(kind, Some(3), None, lasts_s), 12), 1, HOUR).unwrap();
            let absences = plan.absences();
            assert!((0..12).filter(|&robot| robot != 3).all(|robot| absences.none_in(robot, 0..u64::MAX)));
            let ticks: Vec<u64> = (0..2000).filter(|&tick| !absences.none_in(3, tick..tick + 1)).collect();
            (ticks.first().copied(), ticks.len(), plan.disturbances())
        };
        assert_eq!(absent(FaultKind::Stop, None), (Some(960), 1040, vec![960]));
        assert_eq!(absent(FaultKind::Stop, Some(10.0)), (Some(960), 321, vec![960]));
        assert_eq!(absent(FaultKind::Wheel, Some(1.0)), (Some(960), 33, vec![960]));
        assert_eq!(absent(FaultKind::Reboot, None), (Some(960), 33, vec![960]));
        assert_eq!(absent(FaultKind::Carried, None), (Some(960), 2, vec![960]));
        assert_eq!(absent(FaultKind::Late, None), (Some(0), 961, vec![960]));
        for kind in [FaultKind::Radio, FaultKind::SensorDead, FaultKind::SensorShorted, FaultKind::TrackerJump] {
            assert_eq!(absent(kind, None), (None, 0, vec![960]), "{kind:?}");
        }
        let mut absences = Absences::default();
        [(5..10), (8..9), (10..12), (20..30)].into_iter().for_each(|ticks| absences.add(1, ticks));
        let away: Vec<u64> = (0..40).filter(|&tick| !absences.none_in(1, tick..tick + 1)).collect();
        assert_eq!(away, (5..12).chain(20..30).collect::<Vec<_>>());
        assert!(absences.none_in(1, 12..20) && !absences.none_in(1, 12..21) && !absences.none_in(1, 11..20));
    }

    #[test]
    fn more_faults_than_can_be_told_are_refused() {
        let faults = Faults { stop_per_hour: 60.0, ..Faults::default() };
        let error = FaultPlan::drawn(&lab(faults, 250), 1, 10 * HOUR).unwrap_err().to_string();
        assert!(error.contains("about 150000 faults in a run of 10.0 hours; lower the rates"), "{error}");
    }
}
