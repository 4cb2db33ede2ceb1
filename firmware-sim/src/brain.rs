//! What drives a robot: the controller under test, seen from the simulator.

use core::error::Error;
use core::fmt;
use grn_core::network::DEFAULT_GENES;
use grn_core::robot::{Command, Controller, Millimetres, Percept};
use grn_core::scalar::Scalar;
use std::sync::Arc;

/// A robot's controller. The flashed controller, a scripted one for tests or one behind a link are all brains.
pub trait Brain: Send {
    /// One control tick: what the robot perceives → what it does until the next tick.
    ///
    /// # Errors
    /// [`BrainError`] when there is no answer, such as from a remote brain whose link broke; it ends the run.
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError>;

    /// The same for a robot that its base station calls home to this place.
    ///
    /// # Errors
    /// [`BrainError`] if it cannot, as brains that do not say how; it ends the run.
    fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, BrainError> {
        let _ = (percept, home);
        Err(BrainError::new("this brain cannot be called home; simulate it without a base station"))
    }

    /// Begins anew, as after its robot was switched off and on: it knows nothing of before.
    ///
    /// # Errors
    /// [`BrainError`] if it cannot, as brains that do not say how; it ends the run.
    fn reboot(&mut self) -> Result<(), BrainError> {
        Err(BrainError::new("this brain cannot begin anew; simulate it without the fault reboot"))
    }
}

impl<B: Brain + ?Sized> Brain for Box<B> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        (**self).tick(percept)
    }

    fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, BrainError> {
        (**self).tick_home(percept, home)
    }

    fn reboot(&mut self) -> Result<(), BrainError> {
        (**self).reboot()
    }
}

/// The robot's own controller, unchanged. A percept that it refuses ends the run: no robot can have it.
impl<S: Scalar, const N: usize> Brain for Controller<S, N> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        Controller::tick(self, percept).map_err(BrainError::new)
    }

    fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, BrainError> {
        Controller::tick_home(self, percept, home).map_err(BrainError::new)
    }
}

/// A robot's own controller that can begin anew.
#[derive(Clone, Debug)]
pub struct Onboard<S, const N: usize = DEFAULT_GENES> {
    running: Controller<S, N>,
    /// As it was loaded; all robots of a swarm share it.
    loaded: Arc<Controller<S, N>>,
    robot: u16,
}

impl<S: Scalar, const N: usize> Onboard<S, N> {
    /// The controller that was loaded, on robot number `robot`.
    pub fn new(loaded: &Arc<Controller<S, N>>, robot: u16) -> Self {
        Onboard { running: Controller::clone(loaded).on_robot(robot), loaded: Arc::clone(loaded), robot }
    }
}

impl<S: Scalar, const N: usize> Brain for Onboard<S, N> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        Brain::tick(&mut self.running, percept)
    }

    fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, BrainError> {
        Brain::tick_home(&mut self.running, percept, home)
    }

    fn reboot(&mut self) -> Result<(), BrainError> {
        self.running = Controller::clone(&self.loaded).on_robot(self.robot);
        Ok(())
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
