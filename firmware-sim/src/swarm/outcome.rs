//! How a run goes on and ends.

use crate::brain::BrainError;
use core::fmt;

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Ticks simulated since the swarm was made.
    pub tick: u64,
    /// The tick at which this run ends.
    pub end: u64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All ticks are simulated.
    Finished,
    /// The callback asked to stop.
    Interrupted,
}

/// A brain failed.
#[derive(Debug)]
pub struct StepError {
    /// Whose brain.
    pub robot: usize,
    /// In which tick.
    pub tick: u64,
    /// Why.
    pub source: BrainError,
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "robot {} gave no command in tick {}: {}", self.robot, self.tick, self.source)
    }
}

impl core::error::Error for StepError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        Some(&self.source)
    }
}
