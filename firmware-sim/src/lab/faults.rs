//! `[faults]`: what fails while robots work, by rate or at given times.

use grn_input::{InputError, Range};
use serde::{Deserialize, Serialize};

/// The longest time that a file can name, seconds: the longest run.
const LONGEST_S: f64 = 3.6e6;
/// The shortest time that a fault can last, seconds: one frame.
const SHORTEST_S: f64 = 0.03125;

/// What can happen to a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FaultKind {
    /// It stands still where it is, silent, and computes nothing.
    Stop,
    /// Somebody sets it down elsewhere, turned anyhow. Its controller is not told.
    Carried,
    /// Its controller begins anew; it is still and silent for a second meanwhile.
    Reboot,
    /// It neither hears nor is heard.
    Radio,
    /// One of its wheels does not turn.
    Wheel,
    /// One of its proximity sensors reads nothing.
    SensorDead,
    /// One of its proximity sensors reads as if it were touched.
    SensorShorted,
    /// The tracking system takes it for being some decimetres elsewhere.
    TrackerJump,
    /// It stands at its start, switched off, and joins later.
    Late,
}

/// `[faults]`: what fails while robots work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Faults {
    /// Stops, for each robot and hour; so for all rates.
    pub stop_per_hour: f64,
    /// Robots carried away.
    pub carried_per_hour: f64,
    /// Reboots.
    pub reboot_per_hour: f64,
    /// Losses of radio.
    pub radio_per_hour: f64,
    /// Stuck wheels.
    pub wheel_per_hour: f64,
    /// Dead sensors.
    pub sensor_dead_per_hour: f64,
    /// Shorted sensors.
    pub sensor_shorted_per_hour: f64,
    /// Jumps of the tracking system.
    pub tracker_jump_per_hour: f64,
    /// Mean length of what comes by rate and ends, seconds: everything but being carried away and rebooting.
    pub lasts_s: f64,
    /// What happens at given times.
    pub at: Vec<ScheduledFault>,
}

/// `[[faults.at]]`: one fault at a given time, of one robot or of a share of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScheduledFault {
    /// What happens.
    pub kind: FaultKind,
    /// To which robot, by its number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robot: Option<usize>,
    /// Or to which share of the robots, at least one; the seed says which.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// When it begins, seconds from the start; when a late robot joins.
    pub at_s: f64,
    /// How long it lasts, seconds; for good if it is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lasts_s: Option<f64>,
}

impl Default for Faults {
    /// None.
    fn default() -> Self {
        Faults {
            stop_per_hour: 0.0,
            carried_per_hour: 0.0,
            reboot_per_hour: 0.0,
            radio_per_hour: 0.0,
            wheel_per_hour: 0.0,
            sensor_dead_per_hour: 0.0,
            sensor_shorted_per_hour: 0.0,
            tracker_jump_per_hour: 0.0,
            lasts_s: 10.0,
            at: Vec::new(),
        }
    }
}

impl FaultKind {
    /// Its name, as in files.
    pub const fn name(self) -> &'static str {
        match self {
            FaultKind::Stop => "stop",
            FaultKind::Carried => "carried",
            FaultKind::Reboot => "reboot",
            FaultKind::Radio => "radio",
            FaultKind::Wheel => "wheel",
            FaultKind::SensorDead => "sensor_dead",
            FaultKind::SensorShorted => "sensor_shorted",
            FaultKind::TrackerJump => "tracker_jump",
            FaultKind::Late => "late",
        }
    }

    /// Whether how long it takes is its own affair.
    fn has_its_own_length(self) -> bool {
        matches!(self, FaultKind::Carried | FaultKind::Reboot | FaultKind::Late)
    }
}

impl Faults {
    /// What comes by rate: the kind, and how often for each robot and hour.
    pub fn rates(&self) -> [(FaultKind, f64); 8] {
        [
            (FaultKind::Stop, self.stop_per_hour),
            (FaultKind::Carried, self.carried_per_hour),
            (FaultKind::Reboot, self.reboot_per_hour),
            (FaultKind::Radio, self.radio_per_hour),
            (FaultKind::Wheel, self.wheel_per_hour),
            (FaultKind::SensorDead, self.sensor_dead_per_hour),
            (FaultKind::SensorShorted, self.sensor_shorted_per_hour),
            (FaultKind::TrackerJump, self.tracker_jump_per_hour),
        ]
    }

    /// Checks what is scheduled for so many robots.
    pub(super) fn check(&self, robots: usize) -> Result<(), InputError> {
        self.at.iter().enumerate().try_for_each(|(place, fault)| fault.check(&format!("faults.at[{place}]"), robots))
    }
}

impl ScheduledFault {
    fn check(&self, table: &str, robots: usize) -> Result<(), InputError> {
        let key = |name: &str| format!("{table}.{name}");
        match (self.robot, self.share) {
            (None, None) => {
                let way_out =
                    "is missing; say which robot, or give the share of them that it happens to (share = 0.25)";
                return Err(InputError::new(key("robot"), "", way_out));
            }
            (Some(robot), Some(share)) => {
                let way_out = format!("the fault has robot = {robot} too; leave one of them out");
                return Err(InputError::new(key("share"), format!("{share:?}"), way_out));
            }
            (Some(robot), None) => {
                let last = robots.saturating_sub(1);
                Range::new(0, last, "(robots are counted from 0)").check(&key("robot"), robot)?;
            }
            (None, Some(share)) => {
                Range::new(0.001, 1.0, "(of the robots; 1 for all)").check(&key("share"), share)?;
            }
        }
        Range::new(0.0, LONGEST_S, "seconds").check(&key("at_s"), self.at_s)?;
        let Some(lasts_s) = self.lasts_s else { return Ok(()) };
        if self.kind.has_its_own_length() {
            let way_out = match self.kind {
                FaultKind::Late => "a robot that is late joins at at_s; leave this out",
                _ => "how long this takes cannot be chosen; leave it out",
            };
            return Err(InputError::new(key("lasts_s"), format!("{lasts_s:?}"), way_out));
        }
        Range::new(SHORTEST_S, LONGEST_S, "seconds (leave it out if it is for good)")
            .check(&key("lasts_s"), lasts_s)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::lab::{parse, set, write};

    #[test]
    fn what_cannot_be_is_refused_where_it_stands() {
        for (fault, expected) in [
            (
                "kind = \"stpo\"\nrobot = 1\nat_s = 1.0",
                "2:8: faults.at[0].kind = \"stpo\": unknown name; did you mean stop?",
            ),
            ("kind = \"stop\"\nat_s = 1.0", "1:1: faults.at[0].robot: is missing; say which robot, or give the share"),
            (
                "kind = \"stop\"\nrobot = 1\nshare = 0.5\nat_s = 1.0",
                "4:9: faults.at[0].share = 0.5: the fault has robot = 1 too",
            ),
            (
                "kind = \"stop\"\nrobot = 12\nat_s = 1.0",
                "3:9: faults.at[0].robot = 12: must be a number from 0 to 11 (robots",
            ),
            ("kind = \"stop\"\nrobot = -1\nat_s = 1.0", "3:9: faults.at[0].robot = -1: "),
            (
                "kind = \"stop\"\nshare = 1.5\nat_s = 1.0",
                "3:9: faults.at[0].share = 1.5: must be a number from 0.001 to 1",
            ),
            (
                "kind = \"stop\"\nrobot = 1\nat_s = -1.0",
                "4:8: faults.at[0].at_s = -1.0: must be a number from 0 to 3600000",
            ),
            (
                "kind = \"stop\"\nrobot = 1\nat_s = 1.0\nlasts_s = -2.0",
                "5:11: faults.at[0].lasts_s = -2.0: must be a number",
            ),
            (
                "kind = \"late\"\nrobot = 1\nat_s = 1.0\nlasts_s = 2.0",
                "5:11: faults.at[0].lasts_s = 2.0: a robot that is late",
            ),
            (
                "kind = \"reboot\"\nrobot = 1\nat_s = 1.0\nlasts_s = 2.0",
                "5:11: faults.at[0].lasts_s = 2.0: how long this takes",
            ),
            ("kind = \"stop\"\nrobot = 1", "1:1: faults.at[0].at_s: is missing"),
            ("kind = \"stop\"\nrobto = 1\nat_s = 1.0", "3:1: faults.at[0].robto: unknown key; did you mean robot?"),
        ] {
            let error = parse(&format!("[[faults.at]]\n{fault}\n")).unwrap_err().to_string();
            assert!(error.starts_with(&format!("line {expected}")), "{fault}\n{error}");
        }
        let error = parse("[faults]\nstop_per_hour = -1.0\n").unwrap_err().to_string();
        assert!(error.starts_with("line 2:17: faults.stop_per_hour = -1.0: must be a number from 0 to 60"), "{error}");
    }

    #[test]
    fn a_schedule_is_read_written_and_set() {
        let text = "[faults]\nlasts_s = 5.0\n[[faults.at]]\nkind = \"sensor_dead\"\nshare = 0.25\nat_s = 30.0\nlasts_s = 10.0\n";
        let parsed = parse(text).unwrap();
        assert_eq!(parse(&write(&parsed)).unwrap(), parsed);
        let assignment = "faults.at=[{ kind = \"sensor_dead\", share = 0.25, at_s = 30.0, lasts_s = 10.0 }]";
        let given = set(set(Default::default(), assignment).unwrap(), "faults.lasts_s=5").unwrap();
        assert_eq!(given.faults, parsed.faults);
    }
}
