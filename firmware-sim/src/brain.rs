//! What drives a robot: the controller under test, seen from the simulator.

use core::fmt;
use grn_core::robot::{Command, Controller, Percept};
use grn_core::scalar::Scalar;

/// A robot's controller. The flashed controller, a scripted one for tests or one behind a link are all brains.
pub trait Brain: Send {
    /// One control tick: what the robot perceives → what it does until the next tick.
    ///
    /// # Errors
    /// [`BrainError`] when there is no answer, such as from a remote brain whose link broke; it ends the run.
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError>;
}

impl<B: Brain + ?Sized> Brain for Box<B> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        (**self).tick(percept)
    }
}

/// The robot's own controller, unchanged. A percept that it refuses ends the run: no robot can have it.
impl<S: Scalar, const N: usize> Brain for Controller<S, N> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        Controller::tick(self, percept).map_err(|error| BrainError::new(error.to_string()))
    }
}

/// Why a brain gave no command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrainError(String);

impl BrainError {
    /// With this reason, in words for the user.
    pub fn new(reason: impl Into<String>) -> Self {
        BrainError(reason.into())
    }
}

impl fmt::Display for BrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl core::error::Error for BrainError {}
