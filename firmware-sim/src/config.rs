//! What a simulation run is told besides the scenario.

use crate::lab::Laboratory;
use grn_input::{InputError, Range};
use serde::{Deserialize, Serialize};

/// A run: the laboratory, scale and timing. Metres are real ones, in which a robot is 7 cm across.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SwarmConfig {
    /// Determines everything random; equal seeds give equal traces, byte for byte.
    pub seed: u64,
    /// Real metres per metre of the scenario, in (0, 10]; the scaled region must fit a message's ±32.767 m.
    pub scale: f64,
    /// Real speed of the target with the longest path, metres per second, in (0, 0.127] (what a message can tell); the
    /// others are slower in proportion, so that all arrive together. In a world whose targets have times of their own, or whose
    /// walls move, the greatest speed of anything; without effect in one that says how long it takes itself.
    pub target_speed_m_per_s: f64,
    /// How long the targets rest at their starts while the pattern forms, seconds, 0..=3600.
    pub settle_s: f64,
    /// Conditions.
    pub lab: Laboratory,
}

impl Default for SwarmConfig {
    /// The ideal laboratory at a quarter of the scenario's scale; targets rest for 10 s and then move at 20 mm/s.
    fn default() -> Self {
        SwarmConfig { seed: 1, scale: 0.25, target_speed_m_per_s: 0.02, settle_s: 10.0, lab: Laboratory::default() }
    }
}

impl SwarmConfig {
    /// The same with so many robots, two of them mothers, or one if there is only one.
    #[must_use]
    pub fn with_robots(mut self, count: usize) -> Self {
        self.lab.robots.count = count;
        self.lab.robots.mothers = count.min(2);
        self
    }

    /// Checks every field against the range in its documentation.
    ///
    /// # Errors
    /// The first field out of range; those of the laboratory by their key there.
    pub fn check(&self) -> Result<(), InputError> {
        let &SwarmConfig { seed: _, scale, target_speed_m_per_s, settle_s, ref lab } = self;
        lab.clone().checked()?;
        above_zero("scale", scale, 10.0, "")?;
        above_zero("target_speed_m_per_s", target_speed_m_per_s, 0.127, " m/s (a robot's top speed is 0.142 m/s)")?;
        Range::new(0.0, 3600.0, "seconds").check("settle_s", settle_s)?;
        Ok(())
    }
}

fn above_zero(key: &str, value: f64, most: f64, unit: &str) -> Result<(), InputError> {
    if value > 0.0 && value <= most {
        return Ok(());
    }
    Err(InputError::new(key, format!("{value:?}"), format!("must be above 0 and at most {most}{unit}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_field() {
        let good = SwarmConfig::default();
        assert!(good.check().is_ok());
        let lab = |set: &dyn Fn(&mut Laboratory)| {
            let mut config = good.clone();
            set(&mut config.lab);
            config
        };
        let cases = [
            (lab(&|lab| lab.robots.count = 0), "robots.count", "0"),
            (lab(&|lab| lab.robots.mothers = 0), "robots.mothers", "0"),
            (lab(&|lab| lab.robots.mothers = 13), "robots.mothers", "13"),
            (lab(&|lab| lab.radio.loss = 1.5), "radio.loss", "1.5"),
            (lab(&|lab| lab.radio.range_m = 0.0), "radio.range_m", "0.0"),
            (lab(&|lab| lab.radio.payload_bytes = 3), "radio.payload_bytes", "3"),
            (lab(&|lab| lab.localisation.noise_deg = 46.0), "localisation.noise_deg", "46.0"),
            (lab(&|lab| lab.localisation.rate_hz = f64::NAN), "localisation.rate_hz", "NaN"),
            (lab(&|lab| lab.proximity.bearings_deg[3] = 181.0), "proximity.bearings_deg[3]", "181.0"),
            (lab(&|lab| lab.wheels.gain = 0.3), "wheels.gain", "0.3"),
            (lab(&|lab| lab.timing.tick_s = 0.3), "timing.tick_s", "0.3"),
            (SwarmConfig { scale: f64::NAN, ..good.clone() }, "scale", "NaN"),
            (SwarmConfig { target_speed_m_per_s: 0.2, ..good.clone() }, "target_speed_m_per_s", "0.2"),
            (SwarmConfig { target_speed_m_per_s: 1e300, ..good.clone() }, "target_speed_m_per_s", "1e300"),
            (SwarmConfig { target_speed_m_per_s: -5e-324, ..good.clone() }, "target_speed_m_per_s", "-5e-324"),
            (SwarmConfig { settle_s: -1.0, ..good.clone() }, "settle_s", "-1.0"),
        ];
        for (config, key, value) in cases {
            let error = config.check().unwrap_err();
            assert_eq!((error.key(), error.value()), (key, value));
            assert!(error.expected().contains("must be") || error.expected().contains("are needed"), "{error}");
        }
    }
}
