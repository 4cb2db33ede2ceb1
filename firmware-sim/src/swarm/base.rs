//! The base station of a run: whom it sends, whom it calls home, what it tells them.
//!
//! Once a second it does this:
//!
//! 1. Robots that have come near the pattern are of the swarm; those that are back at their places are switched off.
//! 2. It needs ⌈circumference / spacing⌉ robots, mothers at least. Those that broke down do not count: it hears from them no more.
//! 3. If fewer are out, it sends others: first those on their way home, then those at their places, mothers first.
//! 4. If more are out than needed and a reserve, it calls the spare ones home that have the shortest way; mothers stay.
//! 5. It tells every robot that is out of one target, in turn, as the swarm told the base.

use super::unit::{Order, Unit};
use crate::base_station::{BaseRecord, Circumference, Dispatch, Dispatched, PatternSize, no_pattern};
use crate::brain::Brain;
use crate::faults::{Absences, FaultPlan};
use crate::geometry::length_squared;
use crate::lab::Laboratory;
use crate::timing::FRAME_S;
use crate::units::millimetres;
use core::f64::consts::TAU;
use grn_core::geometry::{Point, Vector};
use grn_core::robot::epuck2::{MAX_WHEEL_SPEED, METRES_PER_STEP};
use grn_core::robot::{Message, Millimetres, TargetReport};
use grn_input::InputError;
use std::sync::Arc;

/// The base's number in messages; no robot has it.
const BASE: u16 = u16::MAX;
/// A robot this near its place is back, metres.
const BACK_M: f64 = 0.1;
/// Nearer to a target than so many radii of an average ring a robot is at the pattern.
const NEAR: f64 = 1.5;
/// A robot that takes longer than this to join counts as one of the swarm all the same, and as lost: seconds, and the slowest
/// that it may drive, metres per second.
const PATIENCE_S: f64 = 10.0;
const SLOWEST: f64 = MAX_WHEEL_SPEED as f64 * METRES_PER_STEP / 3.0;
/// What is older than this, in ticks, robots have forgotten, too.
const FORGOTTEN: u64 = 160;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Duty {
    AtBase,
    /// On its way to the pattern; of the swarm from this frame on at the latest.
    Joining {
        until: u64,
    },
    Serving,
    CalledHome,
}

pub(super) struct BaseStation {
    spacing_m: f64,
    reserve: f64,
    mothers: usize,
    circumference: Arc<Circumference>,
    size: Option<PatternSize>,
    absences: Absences,
    places: Vec<Point<f64>>,
    position: Point<f64>,
    duties: Vec<Duty>,
    off_duty: Vec<bool>,
    /// The newest report of each target, and the frame in which it was heard.
    heard: Vec<Option<(TargetReport, u64)>>,
    pub record: BaseRecord,
}

impl BaseStation {
    /// The one of this laboratory, if it has one, with all robots at their places.
    ///
    /// # Errors
    /// It has one, and the circumference is not known.
    pub fn of(
        lab: &Laboratory,
        circumference: Option<Arc<Circumference>>,
        faults: &FaultPlan,
        places: &[Point<f64>],
        targets: usize,
    ) -> Result<Option<Self>, InputError> {
        if !lab.base_station.sends {
            return Ok(None);
        }
        let circumference = circumference.ok_or_else(no_pattern)?;
        let robots = places.len();
        Ok(Some(BaseStation {
            spacing_m: lab.base_station.spacing_m,
            reserve: lab.base_station.reserve,
            mothers: lab.robots.mothers,
            circumference,
            size: None,
            absences: faults.absences(),
            position: places.iter().fold(Vector::ZERO, |sum, &place| sum + place) * (1.0 / robots as f64),
            places: places.to_vec(),
            duties: vec![Duty::AtBase; robots],
            off_duty: vec![true; robots],
            heard: vec![None; targets],
            record: BaseRecord::default(),
        }))
    }

    /// Who is not one of the swarm now.
    pub fn off_duty(&self) -> &[bool] {
        &self.off_duty
    }

    /// What a robot is to do.
    fn order(&self, robot: usize) -> Order {
        match self.duties[robot] {
            Duty::AtBase => Order::Wait,
            Duty::Joining { .. } | Duty::Serving => Order::Form,
            Duty::CalledHome => Order::Home(millimetres(self.places[robot])),
        }
    }

    /// What the swarm says of a target reaches the base, however far away it is.
    pub fn hear(&mut self, report: TargetReport, frame: u64) {
        let Some(known) = self.heard.get_mut(usize::from(report.target)) else { return };
        if known.is_none_or(|(known, heard)| aged(known.age, frame - heard) >= u64::from(report.age)) {
            *known = Some((report, frame));
        }
    }

    /// What the base tells a robot that is out.
    fn tell(&self, robot: usize, frame: u64) -> Option<Message> {
        if matches!(self.duties[robot], Duty::AtBase) || self.heard.is_empty() {
            return None;
        }
        let turn = (robot as u64 + (frame as f64 * FRAME_S) as u64) % self.heard.len() as u64;
        let (report, heard) = self.heard[turn as usize]?;
        let age = aged(report.age, frame - heard);
        if age > FORGOTTEN {
            return None;
        }
        let since = (frame - heard) as f64 * FRAME_S;
        let [x, y] = report.velocity.map(|speed| f64::from(speed) * 1e-3 * since);
        let moved = metres(report.position) + Vector::new(x, y);
        let target = TargetReport { position: millimetres(moved), age: age as u8, ..report };
        Some(Message {
            sender: BASE,
            position: millimetres(self.position),
            target: Some(target),
            obstacles: heapless::Vec::new(),
        })
    }

    /// Decides what robots are to do from this frame on, and tells them.
    pub fn decide<B: Brain>(
        &mut self,
        frame: u64,
        positions: &[Point<f64>],
        targets: &[Option<Point<f64>>],
        units: &mut [Unit<B>],
    ) {
        let targets: Vec<Point<f64>> = targets.iter().flatten().copied().collect();
        self.direct(frame, positions, &targets);
        for (robot, unit) in units.iter_mut().enumerate() {
            unit.obey(self.order(robot), self.tell(robot, frame));
        }
    }

    fn direct(&mut self, frame: u64, positions: &[Point<f64>], targets: &[Point<f64>]) {
        self.size = self.circumference.at(frame).or(self.size);
        self.note_arrivals(frame, positions, targets);
        let needed = self.needed();
        let out = self.out(frame).count();
        let most = needed + (self.reserve * needed as f64).ceil() as usize;
        if out < needed {
            self.send(needed - out, frame, positions, targets);
        } else if out > most {
            self.call_home(out - most, frame, positions);
        }
        let out = self.out(frame).count();
        self.record.most_needed = self.record.most_needed.max(needed);
        self.record.most_out = self.record.most_out.max(out);
        self.record.short_s += if out < needed { 1.0 } else { 0.0 };
        for (off, duty) in self.off_duty.iter_mut().zip(&self.duties) {
            *off = *duty != Duty::Serving;
        }
    }

    fn needed(&self) -> usize {
        let robots = self.size.map_or(0, |size| (size.circumference_m / self.spacing_m).ceil() as usize);
        robots.max(self.mothers)
    }

    /// Those that do their part or are on their way to it.
    fn out(&self, frame: u64) -> impl Iterator<Item = usize> {
        let is_out = move |&robot: &usize| {
            matches!(self.duties[robot], Duty::Joining { .. } | Duty::Serving) && self.is_fit(robot, frame)
        };
        (0..self.duties.len()).filter(is_out)
    }

    fn is_fit(&self, robot: usize, frame: u64) -> bool {
        self.absences.none_in(robot, frame..frame + 1)
    }

    fn note_arrivals(&mut self, frame: u64, positions: &[Point<f64>], targets: &[Point<f64>]) {
        let radius = self.size.map_or(0.0, |size| size.circumference_m / (TAU * size.rings.max(1) as f64));
        for (robot, &here) in positions.iter().enumerate() {
            match self.duties[robot] {
                Duty::Joining { until } if frame >= until || nearest(targets, here) < NEAR * radius => {
                    self.set(robot, Duty::Serving, Dispatch::Joined, frame);
                }
                Duty::CalledHome if (here - self.places[robot]).length() < BACK_M => {
                    self.set(robot, Duty::AtBase, Dispatch::Back, frame);
                }
                _ => {}
            }
        }
    }

    fn send(&mut self, count: usize, frame: u64, positions: &[Point<f64>], targets: &[Point<f64>]) {
        let this = &*self;
        let with = |duty: Duty| {
            let fit = move |&robot: &usize| this.duties[robot] == duty && this.is_fit(robot, frame);
            (0..this.duties.len()).filter(fit)
        };
        let chosen: Vec<usize> = with(Duty::CalledHome).chain(with(Duty::AtBase)).take(count).collect();
        for robot in chosen {
            let patience = PATIENCE_S + nearest(targets, positions[robot]) / SLOWEST;
            let until = frame.saturating_add((patience / FRAME_S) as u64);
            self.set(robot, Duty::Joining { until }, Dispatch::Sent, frame);
        }
    }

    fn call_home(&mut self, count: usize, frame: u64, positions: &[Point<f64>]) {
        let way = |robot: usize| length_squared(positions[robot] - self.places[robot]);
        let mut spare: Vec<usize> = self.out(frame).filter(|&robot| robot >= self.mothers).collect();
        spare.sort_by(|&a, &b| way(a).total_cmp(&way(b)));
        for robot in spare.into_iter().take(count) {
            self.set(robot, Duty::CalledHome, Dispatch::CalledHome, frame);
        }
    }

    fn set(&mut self, robot: usize, duty: Duty, what: Dispatch, frame: u64) {
        self.duties[robot] = duty;
        self.record.dispatched.push(Dispatched { at_s: frame as f64 * FRAME_S, robot, what });
    }
}

fn aged(age: u8, frames: u64) -> u64 {
    u64::from(age) + frames
}

fn nearest(targets: &[Point<f64>], here: Point<f64>) -> f64 {
    targets.iter().map(|&target| (target - here).length()).fold(f64::INFINITY, f64::min)
}

fn metres(Millimetres { x, y }: Millimetres) -> Point<f64> {
    Vector::new(f64::from(x) * 1e-3, f64::from(y) * 1e-3)
}
