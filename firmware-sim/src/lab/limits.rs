//! What the numbers of a laboratory may be.

use super::Laboratory;
use super::packets::check_payload;
use grn_input::{InputError, Range, check_name};

/// Whether a number differs from one reality to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InRealities {
    Varies,
    Stays,
}
use InRealities::{Stays, Varies};

/// A number of a laboratory.
pub(super) struct Number {
    /// With a dot, as in a file.
    key: &'static str,
    pub of: fn(&mut Laboratory) -> &mut f64,
    pub range: Range<f64>,
    pub in_realities: InRealities,
}

macro_rules! number {
    ($table:ident . $key:ident, $low:expr, $high:expr, $unit:expr, $in_realities:expr) => {
        Number {
            key: concat!(stringify!($table), ".", stringify!($key)),
            of: |laboratory| &mut laboratory.$table.$key,
            range: Range::new($low, $high, $unit),
            in_realities: $in_realities,
        }
    };
}

/// Every number but whole ones. The order is part of what the number of a reality means: add new ones at the end.
///
/// Errors of places beyond a metre leave a swarm of robots 7 cm across no shape. Of times on the way as much is kept of each robot's
/// past.
pub(super) const NUMBERS: [Number; 41] = [
    number!(bodies.target_radius_m, 0.0, 0.5, "metres", Stays),
    number!(localisation.rate_hz, 0.1, 1000.0, "per second", Varies),
    number!(localisation.latency_s, 0.0, 2.0, "seconds", Varies),
    number!(localisation.noise_m, 0.0, 1.0, "metres", Varies),
    number!(localisation.noise_deg, 0.0, 45.0, "degrees", Varies),
    number!(localisation.drift_m, 0.0, 1.0, "metres", Varies),
    number!(localisation.drift_deg, 0.0, 45.0, "degrees", Varies),
    number!(localisation.drift_s, 1.0, 36_000.0, "seconds", Varies),
    number!(localisation.dropout, 0.0, 1.0, "(a probability)", Varies),
    number!(localisation.dropout_s, 0.0, 60.0, "seconds", Varies),
    number!(radio.range_m, 0.01, 1000.0, "metres", Varies),
    number!(radio.range_noise, 0.0, 0.25, "(a share)", Varies),
    number!(radio.loss, 0.0, 1.0, "(a probability)", Varies),
    number!(radio.burst_s, 0.0, 60.0, "seconds", Varies),
    number!(radio.latency_s, 0.0, 2.0, "seconds", Varies),
    number!(radio.echo, 0.0, 1.0, "(a probability)", Varies),
    number!(radio.corruption, 0.0, 1.0, "(a probability)", Varies),
    number!(sighting.noise_m, 0.0, 1.0, "metres", Varies),
    number!(proximity.noise_m, 0.0, 0.05, "metres", Varies),
    number!(proximity.noise_growth, 0.0, 1.0, "metres per metre", Varies),
    number!(proximity.gain, 0.0, 0.2, "(a share)", Varies),
    number!(wheels.gain, 0.0, 0.2, "(a share)", Varies),
    number!(wheels.bias, 0.0, 100.0, "steps per second", Varies),
    number!(wheels.noise, 0.0, 0.2, "(a share)", Varies),
    number!(wheels.dead_zone, 0.0, 500.0, "steps per second (the top speed is 1100)", Varies),
    number!(timing.tick_s, 0.01, 0.2, "seconds", Stays),
    number!(timing.resolution_s, 0.0, 0.01, "seconds", Stays),
    number!(timing.skew, 0.0, 0.05, "(a share)", Varies),
    number!(realities.spread, 0.0, 0.9, "(a share)", Stays),
    number!(faults.stop_per_hour, 0.0, 60.0, "per robot and hour", Varies),
    number!(faults.carried_per_hour, 0.0, 60.0, "per robot and hour", Varies),
    number!(faults.reboot_per_hour, 0.0, 60.0, "per robot and hour", Varies),
    number!(faults.radio_per_hour, 0.0, 60.0, "per robot and hour", Varies),
    number!(faults.wheel_per_hour, 0.0, 60.0, "per robot and hour", Varies),
    number!(faults.sensor_dead_per_hour, 0.0, 60.0, "per robot and hour", Varies),
    number!(faults.sensor_shorted_per_hour, 0.0, 60.0, "per robot and hour", Varies),
    number!(faults.tracker_jump_per_hour, 0.0, 60.0, "per robot and hour", Varies),
    number!(faults.lasts_s, 0.1, 100_000.0, "seconds", Varies),
    number!(proximity.aperture_deg, 0.0, 45.0, "degrees", Stays),
    // Narrower than a robot and some room, no ring could be.
    number!(base_station.spacing_m, 0.08, 10.0, "metres", Stays),
    number!(base_station.reserve, 0.0, 1.0, "(a share)", Stays),
];

impl Laboratory {
    /// The laboratory, if every number of it is possible.
    ///
    /// # Errors
    /// The first key whose value is out of its range, with that range.
    pub fn checked(mut self) -> Result<Laboratory, InputError> {
        check_name("name", &self.name)?;
        Range::new(1, super::MAX_ROBOTS, "(a whole one)").check("robots.count", self.robots.count)?;
        let mothers = Range::new(1, self.robots.count, "(a whole one, at most robots.count)");
        mothers.check("robots.mothers", self.robots.mothers)?;
        for number in &NUMBERS {
            let value = *(number.of)(&mut self);
            number.range.check(number.key, value)?;
        }
        for (sensor, bearing) in self.proximity.bearings_deg.iter().enumerate() {
            let key = format!("proximity.bearings_deg[{sensor}]");
            Range::new(-180.0, 180.0, "degrees").check(&key, *bearing)?;
        }
        self.faults.check(self.robots.count)?;
        check_payload(self.radio.payload_bytes)?;
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::{Table, Value};

    #[test]
    fn every_number_has_a_range() {
        let whole = Table::try_from(Laboratory::default()).unwrap();
        for (table, values) in whole.iter().filter_map(|(table, value)| Some((table, value.as_table()?))) {
            for (key, _) in values.iter().filter(|(_, value)| matches!(value, Value::Float(_))) {
                let key = format!("{table}.{key}");
                assert!(NUMBERS.iter().any(|number| number.key == key), "{key} is in no row of NUMBERS");
            }
        }
    }
}
