//! Random numbers: one independent, portable stream per component of the simulator.

use rand::Rng;
use rand_pcg::Pcg32;

/// Who draws; each (run seed, component, index) has a stream of its own, so that a change in one component's draws
/// leaves the others' as they were.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Component {
    /// Where robots start.
    Placement = 1,
    /// Per-robot differences between bodies.
    Variation = 2,
    /// Sensor noise of one robot.
    Sensors = 3,
    /// Messages lost by one receiver.
    Radio = 4,
}

/// A stream of random numbers (PCG XSH-RR 64/32).
#[derive(Clone, Debug)]
pub struct Stream(Pcg32);

impl Stream {
    /// The stream of this component in the run with this seed; `index` tells robots apart.
    pub fn new(seed: u64, component: Component, index: usize) -> Self {
        let stream = (u64::from(component as u8) << 56) | index as u64;
        Stream(Pcg32::new(mixed(seed), mixed(stream)))
    }

    /// Uniform in [0, 1), a multiple of 2^-32.
    pub fn unit(&mut self) -> f64 {
        f64::from(self.0.next_u32()) * (1.0 / 4_294_967_296.0)
    }

    /// Triangular in (-1, 1) with its peak at 0; standard deviation 1/√6.
    pub fn triangular(&mut self) -> f64 {
        self.unit() - self.unit()
    }

    /// Uniform in [-1, 1).
    pub fn symmetric(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }
}

/// SplitMix64's finaliser: neighbouring seeds give unrelated states.
fn mixed(seed: u64) -> u64 {
    let mut z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_repeatable_and_apart() {
        let draw = |seed, component, index| {
            let mut stream = Stream::new(seed, component, index);
            [stream.unit(), stream.unit(), stream.unit()]
        };
        assert_eq!(draw(1, Component::Radio, 0), draw(1, Component::Radio, 0));
        let others = [draw(2, Component::Radio, 0), draw(1, Component::Sensors, 0), draw(1, Component::Radio, 1)];
        assert!(others.iter().all(|other| *other != draw(1, Component::Radio, 0)));
    }

    #[test]
    fn moments_are_right() {
        let mut stream = Stream::new(7, Component::Placement, 0);
        let n = 100_000;
        let draws: Vec<f64> = (0..n).map(|_| stream.triangular()).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(n);
        let variance = draws.iter().map(|d| d * d).sum::<f64>() / f64::from(n);
        assert!(mean.abs() < 0.006 && (variance - 1.0 / 6.0).abs() < 0.003, "{mean} {variance}");
    }
}
