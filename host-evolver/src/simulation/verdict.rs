//! Whether a controller works: what the swarm is for, each measure with its bar.

use core::f64::consts::TAU;
use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::Ring;
use serde::Serialize;

/// Share of the time after settling in which targets must be caged.
pub const ENOUGH_CAGED: f64 = 0.95;
/// Share of robots' moments that must lie in the ring's band: most of them. Where walls leave no room for a ring, the others line
/// the walls nearer to the target, or stretch ahead and behind.
pub const ENOUGH_IN_BAND: f64 = 0.5;
/// Most of robots' time in contact: a little over a second in a minute. One touch is no failure, to lean on a wall is.
pub const MOST_CONTACT: f64 = 0.02;
/// Most robots lost at the end, as a share: none of 12, one of 20.
pub const MOST_LOST: f64 = 0.05;
/// How fast a swarm forms at least, metres per second: a robot's usual speed on its way.
const FORMING_SPEED: f64 = 0.1;

/// How long a swarm may take to form, seconds from the start: until the targets set out, and then as long as a robot takes to
/// drive once around a ring of radius d_max, metres.
pub fn time_to_form_s(config: &SwarmConfig, ring: Ring) -> f64 {
    config.settle_s + TAU * ring.d_max / FORMING_SPEED
}

/// Whether a run met each of the bars for a working controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Verdict {
    /// Targets caged at least [`ENOUGH_CAGED`] of the time.
    pub caged: bool,
    /// Robots in the band at least [`ENOUGH_IN_BAND`] of their time.
    pub in_band: bool,
    /// Robots in contact at most [`MOST_CONTACT`] of their time.
    pub clear: bool,
    /// At most [`MOST_LOST`] of the robots off the pattern at the end.
    pub together: bool,
    /// Formed in time.
    pub formed: bool,
}

impl Verdict {
    /// All of it.
    pub fn works(self) -> bool {
        let Verdict { caged, in_band, clear, together, formed } = self;
        caged && in_band && clear && together && formed
    }
}
