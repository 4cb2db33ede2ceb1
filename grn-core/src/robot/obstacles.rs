//! The obstacle points a robot keeps in mind: the nearest ones it saw or heard of, with their age, one in every square
//! of 32 mm: a point seen again and again, a few millimetres off, must not crowd out the others.

use super::message::ObstacleReport;
use super::position::{Millimetres, metres, squared_distance};
use crate::bounded::{filled, largest_of};
use crate::geometry::Point;
use crate::scalar::Scalar;
use heapless::Vec;

/// The most obstacle points kept in mind: the nearest ones.
pub const MAX_OBSTACLES: usize = 16;
/// An obstacle point is forgotten at this age, in units of 8 ticks: 10 s.
const FORGET_UNITS: u8 = 40;
/// Distances are measured four times a second. How far the robot may move meanwhile, noise of its position included,
/// millimetres.
const SLACK: u32 = 50;
/// A wall whose nearest known point is at this distance, 120 mm squared, may be felt: it is within 65 mm, and points on it
/// are told some way apart.
const CLOSE: u32 = 120 * 120;
/// The side of a square that keeps one point: 2^5 mm.
const CELL_LOG2: u32 = 5;
/// Slots of the hash table, several times as many as points, so that few cells share one.
const SLOTS: usize = 128;

/// The known points. A dozen arrive in a tick, nearly all of them known already.
///
/// Distances are compared in whole millimetres, the unit of messages, and from where the robot was when ages were last
/// counted. In the quarter of a second since then it has moved 36 mm at most, less than [`SLACK`].
#[derive(Clone, Debug)]
pub struct ObstacleMap<S> {
    known: Vec<ObstacleReport, MAX_OBSTACLES>,
    /// How far from `here` each of them is, squared, mm².
    squares: Vec<u32, MAX_OBSTACLES>,
    /// The points, in metres, that can be the nearest until distances are measured again.
    near: Vec<Point<S>, MAX_OBSTACLES>,
    /// By a hash of the cell: which known point to compare with first.
    slots: [u8; SLOTS],
    here: Millimetres,
    farthest: usize,
    largest: u32,
    /// How far from `here` the nearest is, squared, mm², as of the last [`find_near`](Self::find_near).
    nearest: u32,
    /// Points were learned since [`find_near`](Self::find_near) last looked.
    stale: bool,
}

impl<S: Scalar> ObstacleMap<S> {
    pub fn new() -> Self {
        ObstacleMap {
            known: Vec::new(),
            squares: Vec::new(),
            near: Vec::new(),
            slots: [0; SLOTS],
            here: Millimetres::default(),
            farthest: 0,
            largest: 0,
            nearest: u32::MAX,
            stale: false,
        }
    }

    pub fn known(&self) -> &[ObstacleReport] {
        &self.known
    }

    /// The points, in metres, one of which is the nearest, as of the last [`find_near`](Self::find_near).
    pub fn near(&self) -> &[Point<S>] {
        &self.near
    }

    /// Whether one of them can be on what the proximity sensors feel.
    pub fn is_close(&self) -> bool {
        self.nearest < CLOSE
    }

    /// Counts one unit of age, and measures distances from `here` from now on.
    pub fn grow_older(&mut self, here: Millimetres) {
        for obstacle in &mut self.known {
            obstacle.age = obstacle.age.saturating_add(1);
        }
        if self.known.iter().any(|obstacle| obstacle.age > FORGET_UNITS) {
            self.known.retain(|obstacle| obstacle.age <= FORGET_UNITS);
        }
        self.here = here;
        self.squares = filled(self.known.iter().map(|known| squared_distance(known.position, here)));
        self.find_farthest();
        self.stale = true;
    }

    /// Takes a point in, if it is not forgotten and nearer than one of the known.
    pub fn learn(&mut self, told: &ObstacleReport) {
        let cell = cell(told.position);
        // Multiplicative hashing: the upper bits of the product depend on all of both coordinates.
        let slot = (cell.wrapping_mul(0x9e37_79b1) >> (u32::BITS - SLOTS.ilog2())) as usize;
        let first = self.slots.get(slot).and_then(|&index| self.known.get_mut(usize::from(index)));
        if let Some(known) = first
            && self::cell(known.position) == cell
        {
            known.age = known.age.min(told.age);
            return;
        }
        let too_far = || self.known.is_full() && squared_distance(told.position, self.here) > self.largest;
        if told.age > FORGET_UNITS || too_far() {
            return;
        }
        if let Some(index) = self.place(told)
            && let Some(slot) = self.slots.get_mut(slot)
        {
            *slot = index as u8;
        }
    }

    /// Finds those that can be the nearest: every other one is more than 2 [`SLACK`] farther away from `here`, hence
    /// farther away from any place within [`SLACK`] of it.
    pub fn find_near(&mut self) {
        if !self.stale {
            return;
        }
        self.stale = false;
        self.nearest = self.squares.iter().copied().min().unwrap_or(u32::MAX);
        let limit = (self.nearest.isqrt() + 2 * SLACK).saturating_pow(2);
        let near = self.known.iter().zip(&self.squares).filter(|&(_, &square)| square <= limit);
        self.near = filled(near.map(|(known, _)| metres(known.position)));
    }

    /// Keeps the point if there is room or it is nearer than the farthest; returns its index.
    fn place(&mut self, told: &ObstacleReport) -> Option<usize> {
        let cell = cell(told.position);
        if let Some(index) = self.known.iter().position(|known| self::cell(known.position) == cell) {
            let known = self.known.get_mut(index)?;
            known.age = known.age.min(told.age);
            return Some(index);
        }
        let square = squared_distance(told.position, self.here);
        let index = if self.known.push(*told).is_ok() {
            // Both lists have the same length, so there is room.
            let _ = self.squares.push(square);
            self.known.len() - 1
        } else if square < self.largest {
            *self.known.get_mut(self.farthest)? = *told;
            *self.squares.get_mut(self.farthest)? = square;
            self.farthest
        } else {
            return None;
        };
        self.stale = true;
        // Only a full map must know which point is the farthest: the one to replace.
        if self.known.is_full() {
            self.find_farthest();
        }
        Some(index)
    }

    fn find_farthest(&mut self) {
        (self.farthest, self.largest) = largest_of(self.squares.iter().copied());
    }
}

/// The square a point is in: both coordinates without the bits that tell where in it.
fn cell(Millimetres { x, y }: Millimetres) -> u32 {
    const MASK: u32 = 0x0001_0001 * ((u16::MAX >> CELL_LOG2) << CELL_LOG2) as u32;
    ((u32::from(y as u16) << 16) | u32::from(x as u16)) & MASK
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(x: i16, age: u8) -> ObstacleReport {
        ObstacleReport { position: Millimetres { x, y: 5 }, age }
    }

    #[test]
    fn the_nearest_are_kept_once_each() {
        let mut map = ObstacleMap::<f32>::new();
        map.grow_older(Millimetres { x: 0, y: 5 });
        for x in (0..100).rev().chain(0..100) {
            map.learn(&told(x * 32 + 3, 3));
            map.learn(&told(x * 32 + 9, 3));
        }
        map.find_near();
        let mut kept: std::vec::Vec<i16> = map.known().iter().map(|known| known.position.x).collect();
        kept.sort_unstable();
        assert_eq!(kept, (0..16).map(|x| x * 32 + 3).collect::<std::vec::Vec<_>>());
        // Of 3, 35, … 483 mm, those of up to 103.
        let near: std::vec::Vec<f32> = map.near().iter().map(|point| libm::roundf(point.x * 1000.0)).collect();
        assert_eq!((near.len(), near.iter().copied().fold(0.0, f32::max)), (4, 99.0));
        assert!(near.contains(&3.0) && map.near().iter().all(|point| (point.y - 0.005).abs() < 1e-6));
    }

    #[test]
    fn the_fresher_age_stands_until_it_is_forgotten() {
        let mut map = ObstacleMap::<f32>::new();
        let here = Millimetres::default();
        map.learn(&told(1, 7));
        map.learn(&told(1, 2));
        map.learn(&told(1, 9));
        map.learn(&told(99, FORGET_UNITS + 1));
        assert_eq!(map.known().iter().map(|known| known.age).collect::<std::vec::Vec<_>>(), [2]);
        for _ in 2..FORGET_UNITS {
            map.grow_older(here);
        }
        map.find_near();
        assert_eq!((map.known().len(), map.near().len()), (1, 1));
        map.grow_older(here);
        map.find_near();
        assert!(map.near().is_empty() && map.known().is_empty());
    }
}
