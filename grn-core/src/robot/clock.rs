//! Time as the controller counts it: in ticks of 1/32 s, however often it is ticked.

use super::percept::NOMINAL_TICK_US;
use crate::scalar::Scalar;

/// Counts ticks of 1/32 s from the times between percepts: exactly one for each that came on time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Clock {
    tick: u32,
    rest_us: u32,
}

/// How long ago the last tick of the controller was.
#[derive(Clone, Copy, Debug)]
pub struct Pace<S> {
    /// Seconds.
    pub seconds: S,
    /// Ticks of 1/32 s that have ended since, at most 8.
    pub ticks: u32,
    /// The largest gain, 1/s, with which a controlled quantity surely comes to rest: half of its error in one step. None is
    /// needed at the nominal pace, which gains are made for.
    stiffest: Option<S>,
}

impl<S: Scalar> Pace<S> {
    /// A gain, 1/s, held to what this pace allows.
    pub fn held(&self, gain: S) -> S {
        self.stiffest.map_or(gain, |stiffest| gain.min(stiffest))
    }
}

impl Clock {
    /// The present tick, counted from 0; it wraps around.
    pub fn tick(&self) -> u32 {
        self.tick
    }

    /// Lets time pass.
    pub fn advance<S: Scalar>(&mut self, elapsed_us: u32) -> Pace<S> {
        self.rest_us += elapsed_us;
        let ticks = self.rest_us / NOMINAL_TICK_US;
        self.rest_us -= ticks * NOMINAL_TICK_US;
        self.tick = self.tick.wrapping_add(ticks);
        let seconds = S::from_millionths(elapsed_us as i32);
        let stiffest = (elapsed_us > NOMINAL_TICK_US).then(|| S::ONE.over_power_of_two(1) / seconds);
        Pace { seconds, ticks, stiffest }
    }
}

/// Milliseconds as ticks of 1/32 s, to the nearest.
pub fn ticks_of(milliseconds: u16) -> u32 {
    (u32::from(milliseconds) * 32 + 500) / 1000
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_counted_however_often_time_is_told() {
        for (elapsed_us, held) in [(1_000, 60.0), (31_250, 60.0), (32_000, 15.625), (100_000, 5.0), (250_000, 2.0)] {
            let mut clock = Clock::default();
            let mut ticks = 0;
            for step in 1..=1000_u64 {
                let pace = clock.advance::<f64>(elapsed_us);
                ticks += u64::from(pace.ticks);
                assert_eq!(ticks, step * u64::from(elapsed_us) * 32 / 1_000_000);
                assert!(pace.ticks <= 8 && (pace.held(60.0) - held).abs() < 1e-12 && pace.held(1.0) == 1.0);
            }
            assert_eq!(u64::from(clock.tick()), ticks);
        }
        assert_eq!(Clock::default().advance::<f32>(NOMINAL_TICK_US).seconds, 0.03125);
    }

    #[test]
    fn milliseconds_are_rounded_to_ticks() {
        assert_eq!([0, 15, 16, 31, 47, 100, 1000, u16::MAX].map(ticks_of), [0, 0, 1, 1, 2, 3, 32, 2097]);
    }
}
