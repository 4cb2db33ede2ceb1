//! When robots think.
//!
//! The simulator moves in frames of 1/32 s. A robot's control ticks come when its own clock says so: at the beginning of every frame in
//! the ideal laboratory, in general somewhere within a frame, or in no or several moments of it.

use crate::lab;
use crate::random::{Component, Stream};

/// A frame, microseconds.
pub const FRAME_US: u64 = 31_250;
/// A frame, seconds.
pub const FRAME_S: f64 = FRAME_US as f64 * 1e-6;

/// How many frames a delay takes, to the nearest.
pub fn frames_in(seconds: f64) -> u64 {
    (seconds / FRAME_S + 0.5) as u64
}

/// One robot's clock.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    tick_ns: u64,
    resolution_ns: u64,
    /// True time for time by this clock.
    rate: f64,
    phase_us: u64,
    /// Number of the next tick, what the clock shows then, and for how long it has gone on since the tick before.
    tick: u64,
    shown_ns: u64,
    since_us: u32,
    next_us: u64,
}

impl Clock {
    /// Robot number `robot`'s.
    pub fn new(timing: &lab::Timing, seed: u64, robot: usize) -> Self {
        let lab::Timing { tick_s, resolution_s, skew, in_phase } = *timing;
        let mut stream = Stream::new(seed, Component::Timing, robot);
        let rate = 1.0 + skew * stream.symmetric();
        let phase = if in_phase { 0.0 } else { stream.unit() * tick_s };
        let phase_us = (phase * 1e6) as u64;
        let [tick_ns, resolution_ns] = [tick_s, resolution_s].map(|seconds| (seconds * 1e9 + 0.5) as u64);
        let since_us = (tick_ns / 1000) as u32;
        Clock { tick_ns, resolution_ns, rate, phase_us, tick: 0, shown_ns: 0, since_us, next_us: phase_us }
    }

    /// When the robot thinks next, microseconds since the start.
    pub fn next_us(&self) -> u64 {
        self.next_us
    }

    /// Goes on to the next tick; how long the one that begins now is by this clock since the last, microseconds.
    pub fn tick(&mut self) -> u32 {
        let since_us = self.since_us;
        self.tick += 1;
        let exact_ns = self.tick * self.tick_ns;
        // A coarse clock shows the last of its steps.
        let shown_ns = if self.resolution_ns > 1 { exact_ns - exact_ns % self.resolution_ns } else { exact_ns };
        self.since_us = ((shown_ns - self.shown_ns) / 1000) as u32;
        self.shown_ns = shown_ns;
        self.next_us = self.phase_us
            + if self.rate == 1.0 { shown_ns / 1000 } else { (shown_ns as f64 * self.rate * 1e-3) as u64 };
        since_us
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (moment, elapsed) of this many ticks.
    fn ticks(timing: lab::Timing, count: usize) -> Vec<(u64, u32)> {
        let mut clock = Clock::new(&timing, 1, 3);
        (0..count).map(|_| (clock.next_us(), clock.tick())).collect()
    }

    #[test]
    fn ideal_ticks_begin_frames() {
        let ideal = ticks(lab::Timing::default(), 100);
        assert!((0..).zip(&ideal).all(|(frame, tick)| *tick == (frame * FRAME_US, FRAME_US as u32)));
    }

    #[test]
    fn a_clock_of_milliseconds_gives_31_31_31_and_32() {
        let coarse = ticks(lab::Timing { resolution_s: 0.001, ..lab::Timing::default() }, 9);
        let elapsed: Vec<u32> = coarse.iter().map(|tick| tick.1).collect();
        assert_eq!(elapsed, [31_250, 31_000, 31_000, 31_000, 32_000, 31_000, 31_000, 31_000, 32_000]);
        assert_eq!(coarse[8].0, 250_000);
    }

    #[test]
    fn clocks_are_out_of_phase_and_skewed_as_asked() {
        let timing = lab::Timing { tick_s: 0.1, skew: 0.01, in_phase: false, ..lab::Timing::default() };
        let skewed = ticks(timing, 1000);
        let (first, last) = (skewed[0], skewed[999]);
        assert!(first.0 > 0 && first.0 < 100_000);
        let rate = (last.0 - first.0) as f64 / 99_900_000.0;
        assert!(rate != 1.0 && (rate - 1.0).abs() <= 0.01, "{rate}");
        assert!(skewed.iter().all(|tick| tick.1 == 100_000), "by its own clock a tick is a tick");
    }

    #[test]
    fn delays_are_rounded_to_frames() {
        assert_eq!([0.0, 0.01, 0.02, 0.1, 0.3, 1.0].map(frames_in), [0, 0, 1, 3, 10, 32]);
    }
}
