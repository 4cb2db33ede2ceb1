//! Some of a swarm's robots, for which one thread thinks at a time.

use super::StepError;
use super::unit::{Surroundings, Unit};
use crate::body::Pose;
use crate::brain::Brain;
use crate::radio::Letter;
use crate::trace::RobotState;

/// How many robots a part has; the last may have fewer.
pub(super) const PART: usize = 64;
/// From so many robots on it pays to let several threads think for them.
pub(super) const CROWD: usize = 256;

/// A part of the swarm with its number, its robots, their poses and their states.
pub(super) type Numbered<'a, B> = (usize, (&'a mut Part, ((&'a mut [Unit<B>], &'a mut [Pose]), &'a mut [RobotState])));

/// What the robots of a part did in a frame. It lies close together in memory, where the robots of a crowd are far apart: who
/// goes through all of them has it at hand.
#[derive(Debug, Default)]
pub(super) struct Part {
    /// What they broadcast, with their numbers.
    pub letters: Vec<(u16, Letter)>,
    /// Pairs of robots so near that bodies can meet, each by the one with the lower number.
    pub near: Vec<(u16, u16)>,
    /// Those near one robot.
    neighbours: Vec<u16>,
}

impl Part {
    /// One frame of these robots, of which the first has the number `first`. Their wheel commands are recorded in `states`.
    ///
    /// # Errors
    /// That of the first brain that fails.
    pub fn frame<B: Brain>(
        &mut self,
        first: usize,
        units: &mut [Unit<B>],
        poses: &mut [Pose],
        states: &mut [RobotState],
        around: &Surroundings<'_>,
    ) -> Result<(), StepError> {
        self.letters.clear();
        self.near.clear();
        for (robot, ((unit, pose), state)) in (first..).zip(units.iter_mut().zip(poses).zip(states)) {
            let letter = unit.frame(pose, around, &mut self.neighbours);
            let number = robot as u16;
            if let Some(letter) = letter.map_err(|source| StepError { robot, tick: around.frame, source })? {
                self.letters.push((number, letter));
            }
            self.near.extend(self.neighbours.iter().filter(|&&other| number < other).map(|&other| (number, other)));
            state.wheels = unit.wheels;
        }
        Ok(())
    }
}
