//! The world at one moment, and those who watch it.

use crate::contacts::ContactCounts;
use grn_core::geometry::{Point, Vector};

/// A robot in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RobotState {
    /// True position, micrometres, (east, north).
    pub position_um: [i32; 2],
    /// True heading (cos, sin) in units of 2^-14.
    pub heading_q14: [i16; 2],
    /// The commands (left, right) that led here, steps per second; 0 in frame 0.
    pub wheels: [i16; 2],
}

/// One moment of a run.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// How many ticks led here; 0 at the start.
    pub tick: u64,
    /// Targets' positions, micrometres; `None` while a target is not there.
    pub targets_um: &'a [Option<[i32; 2]>],
    /// The robots.
    pub robots: &'a [RobotState],
    /// Contacts in the tick that ended here; in a trace that has not every tick, events are those since the frame before.
    pub contacts: ContactCounts,
}

/// Micrometres → metres.
pub fn metres([x, y]: [i32; 2]) -> Point<f64> {
    Vector::new(f64::from(x) * 1e-6, f64::from(y) * 1e-6)
}

/// Watches a run: records or measures it while it goes on, so that nobody need keep all of it.
pub trait Observer {
    /// Sees the start, and then the world after every tick.
    fn observe(&mut self, frame: &Frame<'_>);
}

/// Nobody watches.
impl Observer for () {
    fn observe(&mut self, _: &Frame<'_>) {}
}

/// Two watch.
impl<A: Observer + ?Sized, B: Observer + ?Sized> Observer for (&mut A, &mut B) {
    fn observe(&mut self, frame: &Frame<'_>) {
        self.0.observe(frame);
        self.1.observe(frame);
    }
}
