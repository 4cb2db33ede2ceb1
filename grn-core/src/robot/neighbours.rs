//! The neighbours a robot keeps in mind: the nearest ones, each where it was when last heard, moved along with the target
//! since then.

use super::epuck2::TICKS_PER_SECOND;
use super::position::{Millimetres, metres, squared_distance};
use crate::bounded::largest_of;
use crate::geometry::{Point, Vector};
use crate::scalar::Scalar;
use heapless::Vec;

/// The most neighbours kept in mind: the nearest ones.
pub const MAX_NEIGHBOURS: usize = 8;

/// A neighbour is forgotten when it was not heard for this many ticks, 1 s.
const FORGET_TICKS: u32 = TICKS_PER_SECOND as u32;

/// A neighbour at this distance, 130 mm squared, may be felt: two radii and the push's range, 100 mm, and a little way for
/// both since it was heard.
const CLOSE: u32 = 130 * 130;

/// No square: nobody is that far away.
const NOT_MEASURED: u32 = u32::MAX;

/// Another robot nearby.
#[derive(Clone, Copy, Debug)]
pub struct Neighbour<S> {
    robot: u16,
    /// Where it was when last heard, metres, less how far the swarm had come by then.
    place: Point<S>,
    /// How far away it was then, squared, mm².
    square: u32,
    /// The tick.
    heard: u32,
}

impl<S: Scalar> Neighbour<S> {
    /// From it to a place that [`Neighbours::seen_from`] gave.
    pub fn offset(&self, seen_from: Point<S>) -> Vector<S> {
        seen_from - self.place
    }

    /// Whether it can be what the proximity sensors feel.
    pub fn was_close(&self) -> bool {
        self.square < CLOSE
    }
}

/// The known neighbours. Several are heard in a tick, most of them known already.
#[derive(Clone, Debug)]
pub struct Neighbours<S> {
    known: Vec<Neighbour<S>, MAX_NEIGHBOURS>,
    /// By the low byte of a robot's number: which of the known to compare with first.
    places: [u8; 1 << u8::BITS],
    /// Whether a robot was met whose number is more than a byte, so that others may end in the same byte.
    crowded: bool,
    /// Which of the known is the farthest, and its square; [`NOT_MEASURED`] if that must be found again.
    farthest: usize,
    largest: u32,
    /// How far the swarm has come with its target since neighbours were last forgotten, metres.
    carried: Vector<S>,
}

impl<S: Scalar> Default for Neighbours<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Scalar> Neighbours<S> {
    /// Of a robot that has heard nobody.
    pub fn new() -> Self {
        Neighbours {
            known: Vec::new(),
            places: [0; 1 << u8::BITS],
            crowded: false,
            farthest: 0,
            largest: NOT_MEASURED,
            carried: Vector::ZERO,
        }
    }

    /// The swarm moves by so many metres, and the neighbours with it.
    pub fn carry(&mut self, moved: Vector<S>) {
        self.carried = self.carried + moved;
    }

    /// How far the swarm has come since neighbours were last forgotten, metres.
    pub fn carried(&self) -> Vector<S> {
        self.carried
    }

    /// Where a robot at `here` is among the [known](Self::known), which stay where they were heard.
    pub fn seen_from(&self, here: Point<S>) -> Point<S> {
        here - self.carried
    }

    /// The neighbours kept in mind, each where it was heard: see [`Neighbour::offset`].
    pub fn known(&self) -> &[Neighbour<S>] {
        &self.known
    }

    /// Hears in tick `now`, itself at `here`, that `robot` was at `place` when the swarm had come as far as `carried`, as
    /// [`carried`](Self::carried) has it now.
    pub fn meet(&mut self, robot: u16, place: Millimetres, carried: Vector<S>, here: Millimetres, now: u32) {
        let square = squared_distance(place, here);
        let index = match self.index_of(robot) {
            Some(index) => index,
            None if !self.known.is_full() => self.known.len(),
            None => {
                if self.largest == NOT_MEASURED {
                    self.measure();
                }
                if square >= self.largest {
                    return;
                }
                self.farthest
            }
        };
        let met = Neighbour { robot, place: metres(place) - carried, square, heard: now };
        match self.known.get_mut(index) {
            Some(known) => *known = met,
            // There is room: in a full list the index above is that of a known neighbour.
            None => drop(self.known.push(met)),
        }
        self.note(robot, index);
        // Only a full list is asked for its farthest, and seldom.
        if index == self.farthest {
            self.largest = NOT_MEASURED;
        } else if square > self.largest {
            (self.farthest, self.largest) = (index, square);
        }
    }

    /// Forgets neighbours that were last heard too long ago.
    pub fn forget(&mut self, now: u32) {
        // Here and not in every tick; and the swarm may go far, so that its way must not add up.
        for known in &mut self.known {
            known.place = known.place + self.carried;
        }
        self.carried = Vector::ZERO;
        let fresh = |known: &Neighbour<S>| now.wrapping_sub(known.heard) < FORGET_TICKS;
        if self.known.iter().all(fresh) {
            return;
        }
        self.known.retain(fresh);
        for index in 0..self.known.len() {
            if let Some(robot) = self.known.get(index).map(|known| known.robot) {
                self.note(robot, index);
            }
        }
        self.largest = NOT_MEASURED;
    }

    fn index_of(&mut self, robot: u16) -> Option<usize> {
        let is_it = |known: &Neighbour<S>| known.robot == robot;
        let index = self.places.get(usize::from(robot as u8)).copied().map(usize::from)?;
        if self.known.get(index).is_some_and(is_it) {
            return Some(index);
        }
        self.crowded |= robot > u16::from(u8::MAX);
        if self.crowded { self.known.iter().position(is_it) } else { None }
    }

    fn note(&mut self, robot: u16, index: usize) {
        if let Some(place) = self.places.get_mut(usize::from(robot as u8)) {
            *place = index as u8;
        }
    }

    fn measure(&mut self) {
        (self.farthest, self.largest) = largest_of(self.known.iter().map(|known| known.square));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Millimetres = Millimetres { x: 0, y: 0 };

    fn meet(neighbours: &mut Neighbours<f32>, robot: u16, x: i16, now: u32) {
        neighbours.meet(robot, Millimetres { x, y: 0 }, Vector::ZERO, HERE, now);
    }

    fn robots(neighbours: &Neighbours<f32>) -> std::vec::Vec<u16> {
        let mut robots: std::vec::Vec<u16> = neighbours.known().iter().map(|known| known.robot).collect();
        robots.sort_unstable();
        robots
    }

    #[test]
    fn the_nearest_are_kept_where_they_were_last_heard() {
        let mut neighbours = Neighbours::new();
        for robot in (0..=255).rev() {
            meet(&mut neighbours, robot, 100 + robot as i16, 1);
        }
        assert_eq!(robots(&neighbours), [0, 1, 2, 3, 4, 5, 6, 7]);
        // The farthest comes nearer, so that another one is the farthest; then the nearest goes away.
        meet(&mut neighbours, 7, 20, 2);
        meet(&mut neighbours, 9, 30, 2);
        assert_eq!(robots(&neighbours), [0, 1, 2, 3, 4, 5, 7, 9]);
        meet(&mut neighbours, 0, 900, 3);
        meet(&mut neighbours, 200, 800, 3);
        assert_eq!(robots(&neighbours), [1, 2, 3, 4, 5, 7, 9, 200]);
        let seven = neighbours.known().iter().find(|known| known.robot == 7).map(|known| known.place.x);
        assert_eq!(seven, Some(0.02));
    }

    #[test]
    fn robots_whose_numbers_end_in_the_same_byte_are_told_apart() {
        let mut neighbours = Neighbours::new();
        let alike = [5, 0x105, 0xff05, 0x205, 0x305, 0x405, 0x505, 0x605];
        for (robot, x) in alike.into_iter().zip([100, 110, 120, 130, 140, 150, 160, 170]) {
            meet(&mut neighbours, robot, x, 1);
        }
        let mut sorted = alike.to_vec();
        sorted.sort_unstable();
        assert_eq!(robots(&neighbours), sorted);
        // One of them moves, one is crowded out by another number, and a third is still the same.
        meet(&mut neighbours, 0x105, 20, 2);
        meet(&mut neighbours, 7, 30, 2);
        meet(&mut neighbours, 5, 40, 2);
        sorted.retain(|&robot| robot != 0x605);
        assert_eq!(robots(&neighbours), [&[5, 7], &sorted[1..]].concat());
    }

    #[test]
    fn they_move_on_with_the_swarm() {
        let mut neighbours = Neighbours::<f32>::new();
        let here = Vector::new(0.0, 0.0);
        let offset = |neighbours: &Neighbours<f32>| neighbours.known()[0].offset(neighbours.seen_from(here)).x;
        neighbours.carry(Vector::new(3.0, 0.0));
        // It was at 100 mm, and the swarm has moved by 10 mm since.
        let then = neighbours.carried() - Vector::new(0.01, 0.0);
        neighbours.meet(1, Millimetres { x: 100, y: 0 }, then, HERE, 1);
        assert!((offset(&neighbours) + 0.11).abs() < 1e-6);
        for tick in 2..30 {
            neighbours.carry(Vector::new(0.001, 0.0));
            if tick % 8 == 0 {
                neighbours.forget(tick);
            }
        }
        assert!((offset(&neighbours) + 0.138).abs() < 1e-6, "{}", offset(&neighbours));
    }

    #[test]
    fn who_falls_silent_is_forgotten() {
        let mut neighbours = Neighbours::new();
        meet(&mut neighbours, 1, 500, 10);
        meet(&mut neighbours, 2, 400, 20);
        meet(&mut neighbours, 3, 300, 10);
        neighbours.forget(41);
        assert_eq!(robots(&neighbours), [1, 2, 3]);
        neighbours.forget(42);
        assert_eq!(robots(&neighbours), [2]);
        meet(&mut neighbours, 3, 100, 43);
        meet(&mut neighbours, 2, 200, 43);
        neighbours.measure();
        assert_eq!((robots(&neighbours), neighbours.largest), (std::vec![2, 3], 200 * 200));
    }
}
