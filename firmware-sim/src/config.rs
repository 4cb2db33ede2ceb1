//! What a simulation run is told besides the scenario.

use crate::radio::RadioConfig;
use crate::sensors::Noise;
use core::fmt;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The most robots in a swarm: senders are numbered in a byte.
pub const MAX_ROBOTS: usize = 250;

/// A run: swarm, scale, timing, radio and noise. Metres are real ones, in which a robot is 7 cm across, unless stated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SwarmConfig {
    /// How many robots, 1..=[`MAX_ROBOTS`].
    pub robots: usize,
    /// How many of them, the first ones, are mother robots with a far sense; 1..=`robots`.
    pub mothers: usize,
    /// Determines everything random; equal seeds give equal traces, byte for byte.
    pub seed: u64,
    /// Real metres per metre of the scenario, in (0, 10]; the scaled region must fit a message's ±32.767 m.
    pub scale: f64,
    /// Real speed of the target with the longest path, metres per second, in (0, 0.127] (what a message can tell); the
    /// others are slower in proportion, so that all arrive together.
    pub target_speed_m_per_s: f64,
    /// How long the targets rest at their starts while the pattern forms, seconds, 0..=3600.
    pub settle_s: f64,
    /// How far wheel diameters and axle differ between robots: relative half-width of a uniform distribution, 0..=0.2.
    pub variation: f64,
    /// The radio.
    pub radio: RadioConfig,
    /// Sensor noise.
    pub noise: Noise,
    /// Robots that break down during the run; none by default.
    pub stops: Vec<Stop>,
}

/// A robot that breaks down: from a tick on its wheels stand still and it neither sends nor computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Which one, below the number of robots.
    pub robot: usize,
    /// The first tick without it.
    pub tick: u64,
}

impl Default for SwarmConfig {
    /// 20 robots, 2 of them mothers, at a quarter of the scenario's scale; targets rest for 10 s and then move at
    /// 20 mm/s; equal bodies; the usual radio and noise.
    fn default() -> Self {
        SwarmConfig {
            robots: 20,
            mothers: 2,
            seed: 1,
            scale: 0.25,
            target_speed_m_per_s: 0.02,
            settle_s: 10.0,
            variation: 0.0,
            radio: RadioConfig::default(),
            noise: Noise::default(),
            stops: Vec::new(),
        }
    }
}

impl SwarmConfig {
    /// Checks every field against the range in its documentation.
    ///
    /// # Errors
    /// [`ConfigError`] for the first field out of range.
    pub fn check(&self) -> Result<(), ConfigError> {
        let whole = |field, value: usize, right, expected: String| {
            if right { Ok(()) } else { Err(ConfigError { field, value: value.to_string(), expected }) }
        };
        let real = |field, value: f64, right, expected: &str| {
            // 5e-324 and 1e300 as they are, not in hundreds of zeros.
            let shown = || format!("{value:?}").trim_end_matches(".0").to_owned();
            let fault = || ConfigError { field, value: shown(), expected: expected.to_owned() };
            if value.is_finite() && right { Ok(()) } else { Err(fault()) }
        };
        let &SwarmConfig {
            robots,
            mothers,
            seed: _,
            scale,
            target_speed_m_per_s,
            settle_s,
            variation,
            radio,
            noise,
            ref stops,
        } = self;
        whole("robots", robots, (1..=MAX_ROBOTS).contains(&robots), format!("must be in 1..={MAX_ROBOTS}"))?;
        whole("mothers", mothers, (1..=robots).contains(&mothers), format!("must be in 1..={robots} (robots)"))?;
        real("scale", scale, scale > 0.0 && scale <= 10.0, "must be above 0 and at most 10")?;
        let speed = target_speed_m_per_s;
        real(
            "target_speed_m_per_s",
            speed,
            speed > 0.0 && speed <= 0.127,
            "must be above 0 and at most 0.127 m/s (a robot's top speed is 0.142 m/s)",
        )?;
        real("settle_s", settle_s, (0.0..=3600.0).contains(&settle_s), "must be 0 to 3600 seconds")?;
        real("variation", variation, (0.0..=0.2).contains(&variation), "must be 0 to 0.2 (a share)")?;
        let RadioConfig { range_m, loss } = radio;
        real("radio.range_m", range_m, range_m > 0.0 && range_m <= 1000.0, "must be above 0 and at most 1000 metres")?;
        real("radio.loss", loss, (0.0..=1.0).contains(&loss), "must be a probability, 0 to 1")?;
        let Noise { position_m, heading_deg, proximity_m, sighting_m } = noise;
        for (field, value) in
            [("noise.position_m", position_m), ("noise.proximity_m", proximity_m), ("noise.sighting_m", sighting_m)]
        {
            real(field, value, (0.0..=1.0).contains(&value), "must be 0 to 1 metre")?;
        }
        real("noise.heading_deg", heading_deg, (0.0..45.0).contains(&heading_deg), "must be 0 to below 45 degrees")?;
        stops.iter().try_for_each(|stop| {
            whole("stops.robot", stop.robot, stop.robot < robots, format!("must be below {robots} (robots)"))
        })
    }

    /// For every robot the first tick in which it stands still for good, if it does.
    pub fn stop_ticks(&self) -> Vec<Option<u64>> {
        let first = |robot| self.stops.iter().filter(|stop| stop.robot == robot).map(|stop| stop.tick).min();
        (0..self.robots).map(first).collect()
    }

    /// The ticks in which a robot breaks down while the swarm is under way, rising.
    pub fn disturbances(&self) -> Vec<u64> {
        let ticks: BTreeSet<u64> = self.stops.iter().map(|stop| stop.tick).filter(|&tick| tick > 0).collect();
        ticks.into_iter().collect()
    }
}

/// A field of a run's configuration that cannot be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigError {
    /// The field, with dots for nested ones.
    pub field: &'static str,
    /// Its value.
    pub value: String,
    /// What would be right.
    pub expected: String,
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: {}", self.field, self.value, self.expected)
    }
}

impl core::error::Error for ConfigError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_field() {
        let good = SwarmConfig::default();
        assert_eq!(good.check(), Ok(()));
        let radio = |range_m, loss| SwarmConfig { radio: RadioConfig { range_m, loss }, ..good.clone() };
        let cases = [
            (SwarmConfig { robots: 0, ..good.clone() }, "robots", "0"),
            (SwarmConfig { robots: 251, ..good.clone() }, "robots", "251"),
            (SwarmConfig { mothers: 0, ..good.clone() }, "mothers", "0"),
            (SwarmConfig { mothers: 21, ..good.clone() }, "mothers", "21"),
            (SwarmConfig { scale: f64::NAN, ..good.clone() }, "scale", "NaN"),
            (SwarmConfig { target_speed_m_per_s: 0.2, ..good.clone() }, "target_speed_m_per_s", "0.2"),
            (SwarmConfig { target_speed_m_per_s: 1e300, ..good.clone() }, "target_speed_m_per_s", "1e300"),
            (SwarmConfig { target_speed_m_per_s: -5e-324, ..good.clone() }, "target_speed_m_per_s", "-5e-324"),
            (SwarmConfig { settle_s: -1.0, ..good.clone() }, "settle_s", "-1"),
            (SwarmConfig { variation: 0.3, ..good.clone() }, "variation", "0.3"),
            (SwarmConfig { stops: vec![Stop { robot: 20, tick: 0 }], ..good.clone() }, "stops.robot", "20"),
            (radio(0.0, 0.1), "radio.range_m", "0"),
            (radio(0.7, 1.5), "radio.loss", "1.5"),
            (
                SwarmConfig { noise: Noise { heading_deg: 45.0, ..Noise::NONE }, ..good.clone() },
                "noise.heading_deg",
                "45",
            ),
            (
                SwarmConfig { noise: Noise { sighting_m: -0.1, ..Noise::NONE }, ..good.clone() },
                "noise.sighting_m",
                "-0.1",
            ),
        ];
        for (config, field, value) in cases {
            let error = config.check().unwrap_err();
            assert_eq!((error.field, error.value.as_str()), (field, value));
            assert!(error.to_string().starts_with(&format!("{field} = {value}: must be ")), "{error}");
        }
    }
}
