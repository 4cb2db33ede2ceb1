//! What a swarm is for: that targets stay caged, robots in the ring's band, and nobody touches anything. And what a run costs
//! that falls short of it.
//!
//! Caging, distances and the time to form are measured once a second, contacts in every tick. Nothing of it asks what pattern a
//! model makes, so controllers of any kind are measured alike, and it is cheap enough for evolution to run on.

use super::flood::Flood;
use crate::faults::Absences;
use crate::geometry::length_squared;
use crate::scenario::{Course, Ring, Scenario, Scene};
use crate::trace::{Frame, Observer, metres};
use grn_core::geometry::Point;
use serde::{Deserialize, Serialize};

/// The swarm has formed once all targets have been caged at so many moments in a row.
const FORMED_AFTER: u64 = 3;
/// How much more a share of robots' time in contact costs than an equal share of time with a target not caged.
pub const CONTACT_WEIGHT: f64 = 5.0;

/// What a run was worth by what the swarm is for. Shares are of the time after settling.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Caging {
    /// Share of moments in which targets were caged, averaged over the targets that were there.
    pub caged_share: f64,
    /// The ring error of the robots themselves: of each the terms sig(d, d_max, k) + sig(d_min, d, k) of the paper's f2, with its
    /// distance d from the nearest target, averaged over robots and moments; in [0, 2].
    pub pen: f64,
    /// Share of robots' moments at distances of d_min to d_max from the nearest target.
    pub in_band_share: f64,
    /// Share of robots' time, settling included, in touch with a wall, a target or another robot.
    pub contact_share: f64,
    /// Since when, at first, all targets were caged for two seconds; seconds from the start, settling included.
    pub formed_at_s: Option<f64>,
}

impl Caging {
    /// J = pen + (1 - caged) + 5 contact.
    pub fn cost(&self) -> f64 {
        self.pen + (1.0 - self.caged_share) + CONTACT_WEIGHT * self.contact_share
    }
}

/// Sums over a run.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    moments: u64,
    caged: f64,
    robots: u64,
    pen: f64,
    in_band: u64,
    ticks: u64,
    touching: f64,
}

/// Measures [`Caging`] while a run goes on.
pub struct CagingMeter<'a> {
    world: &'a Scenario,
    course: Course,
    absences: &'a Absences,
    ticks_per_second: u64,
    ring: Ring,
    scene: Scene,
    flood: Flood,
    /// Moments from the end of settling to the end of the run.
    all_moments: u64,
    sums: Sums,
    /// Since when all targets are caged, in seconds, and for how many moments.
    caged_since: Option<(u64, u64)>,
    formed_at_s: Option<u64>,
    targets: Vec<Point<f64>>,
    robots: Vec<Point<f64>>,
}

impl<'a> CagingMeter<'a> {
    /// Of a run in `world`, which is in real metres and takes this course, that begins; robots count while they are in service.
    pub fn new(world: &'a Scenario, course: Course, absences: &'a Absences, ticks_per_second: u16) -> Self {
        CagingMeter {
            world,
            course,
            absences,
            ticks_per_second: u64::from(ticks_per_second),
            ring: world.ring(),
            scene: Scene::of(world, 0.0),
            flood: Flood::new(world.fixed_walls(), world.ring().d_max),
            all_moments: (course.end_s() as u64).saturating_sub(course.seconds_at(0.0).ceil() as u64) + 1,
            sums: Sums::default(),
            caged_since: None,
            formed_at_s: None,
            targets: Vec::new(),
            robots: Vec::new(),
        }
    }

    /// What the run was worth so far; of one without a moment nothing was good.
    pub fn caging(&self) -> Caging {
        let Sums { moments, caged, robots, pen, in_band, ticks, touching } = self.sums;
        let share = |sum: f64, count: u64, of_none: f64| if count == 0 { of_none } else { sum / count as f64 };
        Caging {
            caged_share: share(caged, moments, 0.0),
            pen: share(pen, robots, WORST_PEN),
            in_band_share: share(in_band as f64, robots, 0.0),
            contact_share: share(touching, ticks, 0.0),
            formed_at_s: self.formed_at_s.map(|second| second as f64),
        }
    }

    /// The cost that the whole run will have at least, whatever comes: what was bad so far stays bad.
    pub fn least_cost(&self) -> f64 {
        let Sums { moments, caged, robots, pen, .. } = self.sums;
        let of_all = 1.0 / self.all_moments.max(1) as f64;
        let mean_pen = if robots == 0 { 0.0 } else { pen / robots as f64 };
        ((moments as f64 - caged) + mean_pen * moments as f64) * of_all
    }

    fn observe_moment(&mut self, second: u64, settling: bool) {
        let caged = self
            .targets
            .iter()
            .filter(|&&target| self.flood.is_caged(target, self.robots.iter().copied(), self.scene.walls()));
        let (caged, all) = (caged.count(), self.targets.len());
        self.caged_since = match self.caged_since {
            _ if caged < all => None,
            Some((since, moments)) => Some((since, moments + 1)),
            None => Some((second, 1)),
        };
        let formed = self.caged_since.filter(|&(_, moments)| moments >= FORMED_AFTER).map(|(since, _)| since);
        self.formed_at_s = self.formed_at_s.or(formed);
        if settling {
            return;
        }
        self.sums.moments += 1;
        self.sums.caged += caged as f64 / all as f64;
        for &robot in &self.robots {
            let squared = self.targets.iter().map(|&target| length_squared(robot - target));
            let distance = squared.fold(f64::INFINITY, f64::min).sqrt();
            let Ring { d_min, d_max, steepness, .. } = self.ring;
            self.sums.robots += 1;
            self.sums.pen += sigmoid((distance - d_max) * steepness) + sigmoid((d_min - distance) * steepness);
            self.sums.in_band += u64::from((d_min..=d_max).contains(&distance));
        }
    }
}

/// The ring error of a robot that is nowhere.
const WORST_PEN: f64 = 1.0;

fn sigmoid(x: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-x))
}

impl Observer for CagingMeter<'_> {
    fn observe(&mut self, frame: &Frame<'_>) {
        let contacts = frame.contacts;
        let touching = f64::from(contacts.walls + 2 * contacts.peers).min(frame.robots.len() as f64);
        if frame.tick > 0 {
            self.sums.ticks += 1;
            self.sums.touching += touching / frame.robots.len() as f64;
        }
        if !frame.tick.is_multiple_of(self.ticks_per_second) {
            return;
        }
        let second = frame.tick / self.ticks_per_second;
        self.targets.clear();
        self.targets.extend(frame.targets_um.iter().flatten().map(|&target| metres(target)));
        if self.targets.is_empty() {
            return;
        }
        let in_service = frame.robots.iter().enumerate().filter(|&(robot, _)| {
            !frame.off_duty.get(robot).is_some_and(|off| *off)
                && self.absences.none_in(robot, frame.tick..frame.tick + 1)
        });
        self.robots.clear();
        self.robots.extend(in_service.map(|(_, state)| metres(state.position_um)));
        self.scene.move_to(self.world, self.course.time_at(second as f64));
        self.observe_moment(second, (second as f64) < self.course.seconds_at(0.0));
    }
}
