//! Laboratories around a nominal one.
//!
//! Nobody measures a laboratory to the last digit, and tomorrow it is another. A *reality* is a laboratory whose conditions are drawn
//! around the nominal one, with its own start, its own robots and its own noise. Reality number n is the same whenever it is drawn.

use super::Laboratory;
use super::limits::{InRealities, NUMBERS};
use crate::random::{Component, Stream};
use serde::{Deserialize, Serialize};

/// `[realities]`: how laboratories of this kind differ from each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RealitySpread {
    /// Each condition is multiplied by its own factor from the uniform distribution over 1 ± this.
    pub spread: f64,
}

impl Default for RealitySpread {
    fn default() -> Self {
        RealitySpread { spread: 0.2 }
    }
}

/// The seed of the run in reality number `number` of an experiment with this seed; reality 0 has the experiment's own.
pub fn run_seed(seed: u64, number: u64) -> u64 {
    if number == 0 { seed } else { Stream::new(seed, Component::Reality, number as usize).seed() }
}

impl Laboratory {
    /// Reality number `number` of an experiment with this seed; 0 is the nominal laboratory itself.
    ///
    /// Noises, drifts, latencies, losses, gains, the radio's range and the rate of localisation vary, within the range of each.
    #[must_use]
    pub fn reality(&self, seed: u64, number: u64) -> Laboratory {
        let mut drawn = self.clone();
        if number == 0 {
            return drawn;
        }
        let mut stream = Stream::new(run_seed(seed, number), Component::Reality, 0);
        let spread = self.realities.spread;
        for condition in NUMBERS.iter().filter(|number| number.in_realities == InRealities::Varies) {
            let value = (condition.of)(&mut drawn);
            let factor = 1.0 + spread * stream.symmetric();
            *value = (*value * factor).clamp(condition.range.low, condition.range.high);
        }
        drawn
    }
}
