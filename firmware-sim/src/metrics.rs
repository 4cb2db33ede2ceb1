//! What a run is worth: encirclement, distance from the pattern, contacts, clearance and spacing, measured while it goes on.
//!
//! Contacts and clearance are measured in every tick. Encirclement, spacing and distances from the pattern, which cost as much
//! as to simulate, are measured [`MEASUREMENTS_PER_SECOND`] times a second, of every robot at the same moments. The moments
//! below are these.

mod bearings;
mod caging;
mod clearance;
mod flood;
mod recovery;
mod samples;
mod whereabouts;

use crate::faults::Absences;
use crate::geometry::{Walls, length_squared};
use crate::scenario::{Course, Scenario, Scene};
use crate::trace::{Frame, Observer, metres};
pub use bearings::Bearings;
pub use caging::{CONTACT_WEIGHT, Caging, CagingMeter};
use clearance::Clearance;
use core::f64::consts::{PI, TAU};
pub use flood::{ESCAPE, GUARDED};
use grn_core::geometry::Point;
use recovery::Forming;
pub use recovery::Recovery;
use samples::{Errors, Mean};
use serde::{Deserialize, Serialize};
use whereabouts::Whereabouts;
pub use whereabouts::{LEFT_AFTER_S, NEAR_TARGET, ON_PATTERN};

/// A target is encircled while every gap between neighbouring robots' bearings about it is below this, degrees.
pub const MAX_GAP_DEG: f64 = 90.0;
/// The swarm has formed once every target stays encircled for this long, seconds.
pub const FORMED_FOR_S: f64 = 2.0;
/// How often encirclement, spacing and distances from the pattern are measured, as far as whole ticks allow.
pub const MEASUREMENTS_PER_SECOND: u16 = 4;

/// The walls among which robots move.
#[derive(Clone, Copy, Debug)]
pub enum WallsOfRun<'a> {
    /// The same ones all the time.
    Fixed(&'a Walls),
    /// Those of a world that takes its course.
    Changing(&'a Scenario, Course),
}

/// What metrics need to know besides the frames.
#[derive(Clone, Debug)]
pub struct MetricsOptions<'a> {
    /// Walls, in real metres, as the trace is.
    pub walls: WallsOfRun<'a>,
    /// Radius of the pattern around a lone target in free space, real metres.
    pub ring_radius_m: f64,
    /// Ticks per second, at least 1.
    pub ticks_per_second: u16,
    /// The ticks in which something disturbed the swarm, rising: [faults](crate::faults::FaultPlan::disturbances), and targets and
    /// walls that came or went.
    pub disturbances: &'a [u64],
    /// When which robot is out of service. Then it counts only as something that others may touch, and when it is back it is to
    /// reach the pattern anew.
    pub absences: &'a Absences,
}

/// The measures of one run. "After forming" is from [`formed_at_s`](Metrics::formed_at_s) to the end; what needs a
/// formed swarm is `None` without one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// How long the run was, seconds.
    pub duration_s: f64,
    /// The first time from which every target stayed encircled for at least [`FORMED_FOR_S`]; seconds from the start.
    pub formed_at_s: Option<f64>,
    /// Share of the moments after forming in which every target that was there was encircled.
    pub encircled_share: Option<f64>,
    /// The same for every target by itself, of the moments in which it was there; `None` if it never was.
    pub encircled_share_by_target: Option<Vec<Option<f64>>>,
    /// Share of all moments of the run in which every target was encircled.
    pub encircled_share_of_run: f64,
    /// The largest angular gap about any target after forming, degrees.
    pub largest_gap_deg: Option<f64>,
    /// Median distance of robots from the pattern over robots and moments after forming, metres; an unknown
    /// distance is longer than any other, and `None` if it is the median.
    pub radial_error_median_m: Option<f64>,
    /// Its 95th percentile, likewise.
    pub radial_error_p95_m: Option<f64>,
    /// Share of robots and moments after forming for which the distance from the pattern is unknown.
    pub radial_error_unknown_share: Option<f64>,
    /// Robots that are off the pattern (see [`ON_PATTERN`]) at the end of the run, for [`LEFT_AFTER_S`] already or since the
    /// start.
    pub lost_robots: usize,
    /// Robots that were off the pattern for [`LEFT_AFTER_S`] after they had reached it, and came back.
    pub strayed_robots: usize,
    /// How often a robot began to touch a wall, or a target with a body.
    pub wall_contacts: u64,
    /// How often a pair of robots began to touch.
    pub peer_contacts: u64,
    /// Time in contact with these, summed over robots, seconds.
    pub wall_contact_s: f64,
    /// Time in contact, summed over pairs of robots, seconds.
    pub peer_contact_s: f64,
    /// The least distance between a robot's centre and a wall over the whole run, metres; `None` without walls.
    pub min_wall_clearance_m: Option<f64>,
    /// Evenness of spacing after forming, 0 to 1, averaged over targets and moments: the entropy of the angular gaps
    /// between the robots nearest to a target, as a share of that of equal gaps. `None` too when no target has two.
    pub spacing_evenness: Option<f64>,
    /// What became of the swarm after each disturbance, robots that are out of service left out of account.
    pub recoveries: Vec<Recovery>,
}

/// Entropy of the gaps over that of equal ones, in [0, 1]; `None` with fewer than two bearings.
fn evenness(bearings: &Bearings) -> Option<f64> {
    if bearings.count() < 2 {
        return None;
    }
    let shares = bearings.gaps().map(|gap| gap / TAU);
    let entropy: f64 = shares.map(|share| -share * libm::log(share)).sum();
    Some((entropy / libm::log(bearings.count() as f64)).clamp(0.0, 1.0))
}

/// Is the largest gap, radians, small enough to encircle? Exactly 90° is not; positions are rounded to micrometres, so
/// rounding errors of an angle do not count.
pub fn encircles(largest_gap: f64) -> bool {
    largest_gap < MAX_GAP_DEG * PI / 180.0 - 1e-9
}

/// What gives the distance (metres) of a position from the pattern that belongs to these targets' positions so many seconds from
/// the start, or `None` where it is not known.
pub trait PatternDistance: FnMut(Point<f64>, &[Point<f64>], f64) -> Option<f64> {}

impl<F: FnMut(Point<f64>, &[Point<f64>], f64) -> Option<f64>> PatternDistance for F {}

/// Measures a run while it is observed.
pub struct Meter<'a, D> {
    options: MetricsOptions<'a>,
    pattern_distance: D,
    /// Ticks from one moment to the next.
    stride: u64,
    moments: u64,
    encircled_moments: u64,
    forming: Forming,
    after: AfterForming,
    robots: Vec<Whereabouts>,
    contact_ticks: [u64; 2],
    contact_events: [u64; 2],
    clearance: Clearance,
    /// The world at the present moment, if its walls change.
    scene: Option<Scene>,
    recoveries: Vec<(u64, Forming)>,
    last_tick: u64,
    /// Who was none of the swarm at the last moment, as the base station says.
    off_duty: Vec<bool>,
    space: Space,
}

/// Working space.
#[derive(Default)]
struct Space {
    bearings: Bearings,
    /// The targets that are there, and the number of each.
    targets: Vec<Point<f64>>,
    numbers: Vec<usize>,
    /// The robots that are in service.
    robots: Vec<(usize, Point<f64>)>,
    gaps: Vec<f64>,
}

/// What counts once the swarm has formed; collected from when it may have.
#[derive(Default)]
struct AfterForming {
    /// By target in how many moments it was there, and in how many of these it was encircled.
    there: Vec<u64>,
    encircled: Vec<u64>,
    largest_gap: f64,
    errors: Errors,
    evenness: Mean,
}

impl AfterForming {
    fn clear(&mut self) {
        self.there.clear();
        self.encircled.clear();
        self.largest_gap = 0.0;
        self.errors.clear();
        self.evenness = Mean::default();
    }
}

impl<'a, D: FnMut(Point<f64>, &[Point<f64>], f64) -> Option<f64>> Meter<'a, D> {
    /// Of a run that begins. `pattern_distance` is a [`PatternDistance`].
    pub fn new(options: MetricsOptions<'a>, pattern_distance: D) -> Self {
        Meter {
            stride: u64::from(options.ticks_per_second / MEASUREMENTS_PER_SECOND).max(1),
            scene: match options.walls {
                WallsOfRun::Changing(world, _) if world.walls_change() => Some(Scene::of(world, 0.0)),
                _ => None,
            },
            options,
            pattern_distance,
            moments: 0,
            encircled_moments: 0,
            forming: Forming::default(),
            after: AfterForming::default(),
            robots: Vec::new(),
            contact_ticks: [0; 2],
            contact_events: [0; 2],
            clearance: Clearance::new(),
            recoveries: Vec::new(),
            last_tick: 0,
            off_duty: Vec::new(),
            space: Space::default(),
        }
    }

    /// Ticks of so many seconds, rounded up.
    fn ticks(&self, seconds: f64) -> u64 {
        (seconds * f64::from(self.options.ticks_per_second)).ceil() as u64
    }

    fn seconds(&self, ticks: u64) -> f64 {
        ticks as f64 / f64::from(self.options.ticks_per_second)
    }

    /// After how many moments off the pattern a robot has left it.
    fn left_after(&self) -> usize {
        self.ticks(LEFT_AFTER_S).div_ceil(self.stride) as usize
    }

    fn observe_encirclement(&mut self, tick: u64, targets_in_all: usize) {
        let Space { bearings, targets, robots, gaps, .. } = &mut self.space;
        gaps.clear();
        for &target in targets.iter() {
            bearings.take(target, robots.iter().map(|&(_, position)| position));
            gaps.push(bearings.largest_gap());
        }
        let encircled = gaps.iter().all(|&gap| encircles(gap));
        self.moments += 1;
        self.encircled_moments += u64::from(encircled);
        let needed = self.ticks(FORMED_FOR_S);
        self.forming.observe(tick, encircled, needed);
        if self.options.disturbances.get(self.recoveries.len()).is_some_and(|&disturbed| tick >= disturbed) {
            self.recoveries.push((tick, Forming::default()));
        }
        if let Some((_, reforming)) = self.recoveries.last_mut() {
            reforming.observe(tick, encircled, needed);
        }
        if !self.forming.may_have_formed() {
            self.after.clear();
            return;
        }
        let AfterForming { there, encircled, largest_gap, .. } = &mut self.after;
        there.resize(targets_in_all, 0);
        encircled.resize(targets_in_all, 0);
        for (&target, &gap) in self.space.numbers.iter().zip(&self.space.gaps) {
            there[target] += 1;
            encircled[target] += u64::from(encircles(gap));
            *largest_gap = largest_gap.max(gap);
        }
    }

    fn observe_distances(&mut self, tick: u64) {
        let seconds = self.seconds(tick);
        let left_after = self.left_after();
        let counts = self.forming.may_have_formed();
        let Space { bearings, targets, robots, .. } = &mut self.space;
        let ring_radius = self.options.ring_radius_m;
        for &(robot, position) in robots.iter() {
            let distance = (self.pattern_distance)(position, targets, seconds).filter(|distance| !distance.is_nan());
            let on_pattern = distance.is_some_and(|distance| distance < ON_PATTERN * ring_radius);
            let reach = NEAR_TARGET * ring_radius;
            let near_target = || targets.iter().any(|&target| length_squared(position - target) < reach * reach);
            self.robots[robot].observe(on_pattern || near_target(), left_after);
            if counts {
                self.after.errors.add(distance);
            }
        }
        if counts {
            for target in 0..targets.len() {
                let near = robots.iter().map(|&(_, position)| position);
                bearings.take(targets[target], near.filter(|&robot| nearest(targets, robot) == Some(target)));
                if let Some(value) = evenness(bearings) {
                    self.after.evenness.add(value);
                }
            }
        }
    }

    /// What the run that was observed is worth.
    pub fn metrics(&self) -> Metrics {
        let left_after = self.left_after();
        let working = || {
            let robots = self.robots.iter().enumerate();
            let now = self.last_tick..self.last_tick + 1;
            let present = robots.filter(move |(robot, _)| {
                self.options.absences.none_in(*robot, now.clone()) && !self.off_duty.get(*robot).is_some_and(|off| *off)
            });
            present.map(|(_, robot)| robot)
        };
        let formed_at = self.forming.formed_at();
        let after = formed_at.map(|_| &self.after);
        let by_target = |after: &AfterForming| {
            let counts = after.encircled.iter().zip(&after.there);
            counts.map(|(&encircled, &there)| (there > 0).then(|| encircled as f64 / there as f64)).collect()
        };
        let recovery = |(tick, reforming): &(u64, Forming)| Recovery {
            disturbed_at_s: self.seconds(*tick),
            reformed_at_s: reforming.formed_at().map(|tick| self.seconds(tick)),
            encircled_share: reforming.good_share(),
        };
        let ([wall_contacts, peer_contacts], [walls, peers]) = (self.contact_events, self.contact_ticks);
        Metrics {
            duration_s: self.seconds(self.last_tick),
            formed_at_s: formed_at.map(|tick| self.seconds(tick)),
            encircled_share: self.forming.good_share(),
            encircled_share_by_target: after.map(by_target),
            encircled_share_of_run: self.encircled_moments as f64 / self.moments.max(1) as f64,
            largest_gap_deg: after.map(|after| after.largest_gap.to_degrees()),
            radial_error_median_m: after.and_then(|after| after.errors.percentile(50)),
            radial_error_p95_m: after.and_then(|after| after.errors.percentile(95)),
            radial_error_unknown_share: after.map(|after| after.errors.unknown_share()),
            lost_robots: working().filter(|robot| robot.is_lost(left_after)).count(),
            strayed_robots: working().filter(|robot| robot.has_strayed(left_after)).count(),
            wall_contacts,
            peer_contacts,
            wall_contact_s: self.seconds(walls),
            peer_contact_s: self.seconds(peers),
            min_wall_clearance_m: self.clearance.least(),
            spacing_evenness: after.and_then(|after| after.evenness.get()),
            recoveries: self.recoveries.iter().map(recovery).collect(),
        }
    }
}

impl<D: FnMut(Point<f64>, &[Point<f64>], f64) -> Option<f64>> Observer for Meter<'_, D> {
    fn observe(&mut self, frame: &Frame<'_>) {
        self.last_tick = frame.tick;
        if frame.tick.is_multiple_of(self.stride) {
            let Space { targets, numbers, robots, .. } = &mut self.space;
            targets.clear();
            targets.extend(frame.targets_um.iter().flatten().map(|&target| metres(target)));
            let there = (0..).zip(frame.targets_um).filter(|(_, target)| target.is_some()).map(|(number, _)| number);
            if !there.clone().eq(numbers.iter().copied()) {
                numbers.clear();
                numbers.extend(there);
                // The pattern is another one: every robot has to reach it anew.
                self.robots.iter_mut().for_each(Whereabouts::suspend);
            }
            robots.clear();
            self.robots.resize(frame.robots.len(), Whereabouts::default());
            let since = (frame.tick + 1).saturating_sub(self.stride);
            for (robot, (state, whereabouts)) in frame.robots.iter().zip(&mut self.robots).enumerate() {
                let off_duty = frame.off_duty.get(robot).is_some_and(|off| *off);
                if !off_duty && self.options.absences.none_in(robot, since..frame.tick + 1) {
                    robots.push((robot, metres(state.position_um)));
                } else {
                    whereabouts.suspend();
                }
            }
            self.observe_encirclement(frame.tick, frame.targets_um.len());
            self.observe_distances(frame.tick);
        }
        self.off_duty.clear();
        self.off_duty.extend(frame.off_duty);
        let contacts = frame.contacts;
        for (sum, count) in self.contact_events.iter_mut().zip([contacts.wall_events, contacts.peer_events]) {
            *sum += u64::from(count);
        }
        for (sum, count) in self.contact_ticks.iter_mut().zip([contacts.walls, contacts.peers]) {
            *sum += u64::from(count);
        }
        let robots = frame.robots.iter().map(|robot| metres(robot.position_um));
        match (self.options.walls, &mut self.scene) {
            (WallsOfRun::Changing(world, course), Some(scene)) => {
                scene.move_to(world, course.time_at(frame.tick as f64 / f64::from(self.options.ticks_per_second)));
                self.clearance.forget_places();
                self.clearance.observe(robots, scene.walls());
            }
            (WallsOfRun::Changing(world, _), None) => self.clearance.observe(robots, world.fixed_walls()),
            (WallsOfRun::Fixed(walls), _) => self.clearance.observe(robots, walls),
        }
    }
}

/// The nearest of the targets, by number.
fn nearest(targets: &[Point<f64>], robot: Point<f64>) -> Option<usize> {
    let distances = targets.iter().map(|&target| length_squared(robot - target));
    distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(nearest, _)| nearest)
}

#[cfg(test)]
mod tests;
