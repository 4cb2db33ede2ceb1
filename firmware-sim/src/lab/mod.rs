//! A laboratory: the conditions that robots work under, apart from the world and from their controller.
//!
//! A TOML file of a few tables, of which each may be left out. What is left out is as in the laboratory that the file is based on,
//! [`Shipped::Ideal`] if it names none. Lengths are real metres, in which a robot is 7 cm across; they are not scaled with the world.
//!
//! Two words have one meaning throughout: a *noise* is the standard deviation of an error that is drawn anew every time (a sum of
//! four uniform draws, near enough to a normal distribution, and never farther off than 3.5 deviations); a *gain* is the half-width of
//! the uniform distribution from which each robot's own factor is drawn once, around 1.

mod faults;
mod file;
mod limits;
mod packets;
mod reality;
mod shipped;

pub use faults::{FaultKind, Faults, ScheduledFault};
pub use file::{find, parse, set, write};
pub use packets::{MOST_PACKETS, packets};
pub use reality::{RealitySpread, run_seed};
pub use shipped::Shipped;

use serde::{Deserialize, Serialize};

/// The most robots in a swarm.
pub const MAX_ROBOTS: usize = 10_000;

/// The conditions of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Laboratory {
    /// What it is called, in reports.
    pub name: String,
    /// The shipped laboratory that what a file leaves out is taken from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base: Option<String>,
    /// The swarm.
    pub robots: Robots,
    /// What is solid besides walls and robots.
    pub bodies: Bodies,
    /// How robots learn where they are.
    pub localisation: Localisation,
    /// How robots hear each other.
    pub radio: Radio,
    /// What mother robots see.
    pub sighting: Sighting,
    /// The ring of proximity sensors.
    pub proximity: Proximity,
    /// How wheels turn commands into motion.
    pub wheels: Wheels,
    /// When robots think.
    pub timing: Timing,
    /// What fails while robots work.
    pub faults: Faults,
    /// How laboratories of this kind differ from each other.
    pub realities: RealitySpread,
}

/// `[robots]`: the swarm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Robots {
    /// How many, 1..=[`MAX_ROBOTS`].
    pub count: usize,
    /// How many of them, the first ones, are mother robots with a far sense; 1..=`count`.
    pub mothers: usize,
}

/// `[bodies]`: what is solid besides walls and robots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Bodies {
    /// Radius of a target's body, metres; 0 if targets are only places. Proximity sensors feel it, and it pushes robots away.
    pub target_radius_m: f64,
}

/// `[localisation]`: how robots learn where they are.
///
/// A tracking system measures a robot's pose `rate_hz` times a second. The robot gets it `latency_s` later, with an error
/// that has two parts: noise, drawn anew each time, and drift, which wanders slowly and is the same for one robot from one moment
/// to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Localisation {
    /// Poses a second.
    pub rate_hz: f64,
    /// Age of a pose when the robot gets it, seconds. The robot is told this age.
    pub latency_s: f64,
    /// Noise of each coordinate, metres.
    pub noise_m: f64,
    /// Noise of the heading, degrees.
    pub noise_deg: f64,
    /// Standard deviation of the drift of each coordinate, metres.
    pub drift_m: f64,
    /// Standard deviation of the drift of the heading, degrees.
    pub drift_deg: f64,
    /// How long a drift takes to be forgotten, seconds: its correlation falls to 1/e in this time.
    pub drift_s: f64,
    /// Probability that a pose is not measured, as when the robot is hidden.
    pub dropout: f64,
    /// Mean length of a row of dropouts, seconds; 0 if they are independent of each other.
    pub dropout_s: f64,
}

/// `[radio]`: how robots hear each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Radio {
    /// Farthest reception, metres.
    pub range_m: f64,
    /// Noise of the range of each reception, as a share of `range_m`.
    pub range_noise: f64,
    /// Probability that a receiver in range misses a message.
    pub loss: f64,
    /// Mean length of a row of losses of one receiver, seconds; 0 if losses are independent of each other.
    pub burst_s: f64,
    /// How long a message is on its way, seconds. The receiver knows it.
    pub latency_s: f64,
    /// The most bytes that a radio's packet holds; 0 for no limit. Messages that are longer are sent in fragments, one every 1/32 s.
    pub payload_bytes: usize,
    /// Whether a wall between two robots stops messages.
    pub walls_block: bool,
    /// Whether a robot between two robots stops messages.
    pub bodies_block: bool,
    /// Probability that a message comes back to its sender.
    pub echo: f64,
    /// Probability that a message arrives with a wrong byte. Its checksum tells the receiver, who drops it, but not always.
    pub corruption: f64,
}

/// `[sighting]`: what mother robots see.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Sighting {
    /// Noise of each coordinate of a target or wall point, metres.
    pub noise_m: f64,
    /// Whether a mother tells places relative to where she believes to be, so that they carry the error of her own pose. If not,
    /// the tracking system tells her the places themselves.
    pub own_pose_error: bool,
}

/// `[proximity]`: the ring of proximity sensors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Proximity {
    /// What a sensor returns for a distance.
    pub response: Response,
    /// Noise of a distance, metres.
    pub noise_m: f64,
    /// How much the noise grows with distance, metres per metre.
    pub noise_growth: f64,
    /// Gain of each sensor.
    pub gain: f64,
    /// How far to both sides of a sensor's bearing its two other rays look, degrees; 0 for one ray.
    pub aperture_deg: f64,
    /// Bearings of the sensors from the heading, degrees, left positive.
    pub bearings_deg: [f64; grn_core::robot::epuck2::PROXIMITY_SENSORS],
}

/// What a sensor returns for a distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Response {
    /// The distance itself.
    Distance,
    /// The table of Webots' e-puck, with its noise, rounded to whole counts.
    Webots,
    /// The polynomial of ARGoS' e-puck2, 197.9 d² - 30.5 d + 1.01 with d in metres, where it falls; no noise.
    Argos,
    /// Enki's e-puck, 3731 (c - x₀²) / (x² - 2 x₀ x + c) with x in centimetres, x₀ = 0.3 and c = 0.7; noise 10, rounded.
    Enki,
}

/// `[wheels]`: how wheels turn commands into motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Wheels {
    /// Gain of the left wheel, the right wheel and the axle.
    pub gain: f64,
    /// Half-width of the uniform distribution of each wheel's own extra speed while it is driven, steps per second.
    pub bias: f64,
    /// Noise of the way a wheel rolls in one frame, as a share of it: slip.
    pub noise: f64,
    /// Commands slower than this do not turn the wheel, steps per second.
    pub dead_zone: f64,
}

/// `[timing]`: when robots think.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Timing {
    /// Time between two control ticks by the robot's clock, seconds.
    pub tick_s: f64,
    /// Step of the clock that ticks wait for, seconds; 0 for an exact one. With 0.001, ticks of 1/32 s come after 31, 31, 31 and 32 ms.
    pub resolution_s: f64,
    /// Gain of the robots' clocks.
    pub skew: f64,
    /// Whether all robots think at the same moments.
    pub in_phase: bool,
}

impl Default for Laboratory {
    /// The ideal one.
    fn default() -> Self {
        Laboratory {
            name: Shipped::Ideal.name().to_owned(),
            base: None,
            robots: Robots::default(),
            bodies: Bodies::default(),
            localisation: Localisation::default(),
            radio: Radio::default(),
            sighting: Sighting::default(),
            proximity: Proximity::default(),
            wheels: Wheels::default(),
            timing: Timing::default(),
            faults: Faults::default(),
            realities: RealitySpread::default(),
        }
    }
}

impl Default for Robots {
    fn default() -> Self {
        Robots { count: 12, mothers: 2 }
    }
}

impl Default for Localisation {
    fn default() -> Self {
        Localisation {
            rate_hz: 32.0,
            latency_s: 0.0,
            noise_m: 0.001,
            noise_deg: 0.5,
            drift_m: 0.0,
            drift_deg: 0.0,
            drift_s: 30.0,
            dropout: 0.0,
            dropout_s: 0.0,
        }
    }
}

impl Default for Radio {
    fn default() -> Self {
        Radio {
            range_m: 0.7,
            range_noise: 0.0,
            loss: 0.1,
            burst_s: 0.0,
            latency_s: 0.0,
            payload_bytes: 0,
            walls_block: false,
            bodies_block: false,
            echo: 0.0,
            corruption: 0.0,
        }
    }
}

impl Default for Sighting {
    fn default() -> Self {
        Sighting { noise_m: 0.002, own_pose_error: false }
    }
}

impl Default for Proximity {
    fn default() -> Self {
        Proximity {
            response: Response::Distance,
            noise_m: 0.001,
            noise_growth: 0.0,
            gain: 0.0,
            aperture_deg: 0.0,
            bearings_deg: grn_core::robot::epuck2::PROXIMITY_BEARINGS_DEG.map(f64::from),
        }
    }
}

impl Default for Timing {
    fn default() -> Self {
        Timing { tick_s: 1.0 / 32.0, resolution_s: 0.0, skew: 0.0, in_phase: true }
    }
}

impl Laboratory {
    /// The ideal laboratory, without any noise or loss.
    pub fn perfect() -> Self {
        let ideal = Laboratory::default();
        Laboratory {
            name: "perfect".to_owned(),
            localisation: Localisation { noise_m: 0.0, noise_deg: 0.0, ..ideal.localisation },
            radio: Radio { loss: 0.0, ..ideal.radio },
            sighting: Sighting { noise_m: 0.0, ..ideal.sighting },
            proximity: Proximity { noise_m: 0.0, ..ideal.proximity.clone() },
            ..ideal
        }
    }
}
