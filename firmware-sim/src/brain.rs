//! What drives a robot: the controller under test, seen from the simulator.

use core::error::Error;
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
        Controller::tick(self, percept).map_err(BrainError::new)
    }
}

/// Why a brain gave no command.
#[derive(Debug)]
pub struct BrainError(Box<dyn Error + Send + Sync>);

impl BrainError {
    /// With this reason: words for the user, or the error that kept the brain from answering.
    pub fn new(reason: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        BrainError(reason.into())
    }

    /// The reason, of its own type.
    pub fn reason(&self) -> &(dyn Error + Send + Sync + 'static) {
        self.0.as_ref()
    }
}

impl fmt::Display for BrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Error for BrainError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.0.source()
    }
}
