//! What a trace is of.

use crate::config::SwarmConfig;
use crate::scenario::{Course, Scenario};
use grn_core::robot::epuck2::TICKS_PER_SECOND;

const TARGET_BYTES: usize = 8;
const ROBOT_BYTES: usize = 16;
const CONTACT_BYTES: usize = 16;

/// What a trace is of.
#[derive(Clone, Debug, PartialEq)]
pub struct TraceHeader {
    /// The scenario's name.
    pub scenario: String,
    /// The run's seed.
    pub seed: u64,
    /// Real metres per metre of the scenario.
    pub scale: f64,
    /// How long targets rest at first, seconds.
    pub settle_s: f64,
    /// Real speed of the target with the longest path, metres per second.
    pub target_speed_m_per_s: f64,
    /// Ticks per second.
    pub ticks_per_second: u16,
    /// Ticks from one frame to the next, at least 1.
    pub ticks_per_frame: u32,
    /// How many robots.
    pub robots: u16,
    /// How many of them, the first ones, are mothers.
    pub mothers: u16,
    /// How many targets.
    pub targets: u16,
}

impl TraceHeader {
    /// Of a run of this swarm in this scenario, with every tick.
    pub fn of(scenario: &Scenario, config: &SwarmConfig) -> Self {
        TraceHeader {
            scenario: scenario.name().to_owned(),
            seed: config.seed,
            scale: config.scale,
            settle_s: config.settle_s,
            target_speed_m_per_s: config.target_speed_m_per_s,
            ticks_per_second: TICKS_PER_SECOND,
            ticks_per_frame: 1,
            robots: config.lab.robots.count as u16,
            mothers: config.lab.robots.mothers as u16,
            targets: scenario.targets().len() as u16,
        }
    }

    /// When in the run its world, which is in real metres, is at which time.
    pub fn course(&self, world: &Scenario) -> Course {
        Course::new(self.settle_s, world.travel_s(self.target_speed_m_per_s))
    }

    /// What a frame takes, in memory and in the layout.
    pub(super) fn bytes_per_frame(&self) -> usize {
        usize::from(self.targets) * TARGET_BYTES + usize::from(self.robots) * ROBOT_BYTES + CONTACT_BYTES
    }
}
