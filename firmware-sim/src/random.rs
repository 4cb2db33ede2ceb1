//! Random numbers: one independent, portable stream per component of the simulator.

use core::f64::consts::TAU;
use grn_core::geometry::Vector;
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
    /// Where random obstacles lie.
    Obstacles = 5,
    /// What power loss leaves in a flash.
    Flash = 6,
    /// What happens to bytes on a wire.
    Wire = 7,
    /// What distinguishes one laboratory from the next.
    Reality = 8,
    /// Differences between proximity sensors.
    ProximityGain = 9,
    /// Errors and gaps of one robot's poses.
    Localisation = 10,
    /// Clocks.
    Timing = 11,
    /// Slip of one robot's wheels.
    Wheels = 12,
    /// Wrong bytes of messages.
    Corruption = 13,
    /// What goes wrong with robots.
    Faults = 14,
    /// What missions are drawn.
    Missions = 15,
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

    /// A seed for a run of its own.
    pub fn seed(&mut self) -> u64 {
        (u64::from(self.0.next_u32()) << 32) | u64::from(self.0.next_u32())
    }

    /// A unit vector, all directions alike.
    pub fn direction(&mut self) -> Vector<f64> {
        let (sin, cos) = libm::sincos(self.unit() * TAU);
        Vector::new(cos, sin)
    }

    /// A place between two circles around the origin, uniform by area: its distance, and its direction as a unit vector.
    pub fn in_ring(&mut self, [inner, outer]: [f64; 2]) -> (f64, Vector<f64>) {
        let radius = (inner * inner + self.unit() * (outer * outer - inner * inner)).sqrt();
        (radius, self.direction())
    }

    /// Uniform in [0, 1), a multiple of 2^-32.
    pub fn unit(&mut self) -> f64 {
        f64::from(self.0.next_u32()) * (1.0 / 4_294_967_296.0)
    }

    /// Nearly a standard normal distribution: the sum of four uniform draws, less its mean, times √3. Never beyond 2 √3.
    pub fn normal(&mut self) -> f64 {
        let [one, other] = [self.0.next_u32(), self.0.next_u32()];
        let sum = [one >> 16, one & 0xffff].map(|half| half as i32).iter().sum::<i32>();
        let less = [other >> 16, other & 0xffff].map(|half| half as i32).iter().sum::<i32>();
        const SQRT_3: f64 = 1.732_050_807_568_877_2;
        f64::from(sum - less) * (SQRT_3 / 65_536.0)
    }

    /// Uniform in [-1, 1).
    pub fn symmetric(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }
}

/// Random numbers by time and index, in any order.
#[derive(Clone, Copy, Debug)]
pub struct DrawSeries(u64);

impl DrawSeries {
    /// Those of this component, for one `index`, such as a robot.
    pub fn new(seed: u64, component: Component, index: usize) -> Self {
        let stream = (u64::from(component as u8) << 56) | index as u64;
        DrawSeries(mixed(seed ^ mixed(stream)))
    }

    /// Those of one moment.
    pub fn at(self, time: u64) -> Draws {
        Draws(mixed(self.0.wrapping_add(time)))
    }
}

/// Random numbers by index, in any order: the sequence of a SplitMix64 generator.
#[derive(Clone, Copy, Debug)]
pub struct Draws(u64);

impl Draws {
    /// Draw number `index`: uniform over all `u32`.
    pub fn at(self, index: u32) -> u32 {
        (mixed(self.0.wrapping_add(u64::from(index).wrapping_mul(0x9e37_79b9_7f4a_7c15))) >> 32) as u32
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
    fn draws_by_index_are_uniform_and_unrelated() {
        let n = 20_000u32;
        let low = |draw: u32| u32::from(draw < 1 << 30);
        let (mut first, mut second, mut both) = (0, 0, 0);
        for time in 0..u64::from(n) {
            let draws = DrawSeries::new(3, Component::Radio, 0).at(time);
            let (a, b) = (low(draws.at(0)), low(draws.at(1)));
            (first, second, both) = (first + a, second + b, both + a * b);
        }
        let share = |count: u32| f64::from(count) / f64::from(n);
        assert!((share(first) - 0.25).abs() < 0.01 && (share(second) - 0.25).abs() < 0.01, "{first} {second}");
        assert!((share(both) - 0.0625).abs() < 0.006, "{both}");
    }

    #[test]
    fn moments_are_right() {
        let mut stream = Stream::new(7, Component::Placement, 0);
        let n = 100_000;
        let draws: Vec<f64> = (0..n).map(|_| stream.normal()).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(n);
        let variance = draws.iter().map(|d| d * d).sum::<f64>() / f64::from(n);
        assert!(mean.abs() < 0.01 && (variance - 1.0).abs() < 0.015, "{mean} {variance}");
        assert!(draws.iter().all(|d| d.abs() <= 3.465) && draws.iter().any(|d| *d > 3.0));
    }
}
