//! How a swarm recovers from disturbances.

use serde::{Deserialize, Serialize};

/// What became of the swarm after one disturbance, until the next one or the end of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recovery {
    /// When it was disturbed, seconds from the start.
    pub disturbed_at_s: f64,
    /// The first time after that from which every target stayed encircled for at least
    /// [`FORMED_FOR_S`](super::FORMED_FOR_S); seconds from the start. `None` if it never was again.
    pub reformed_at_s: Option<f64>,
    /// Share of the moments after that in which every target was encircled.
    pub encircled_share: Option<f64>,
}

/// Finds the first moment from which something stays as it should for long enough, and counts from there.
#[derive(Clone, Debug, Default)]
pub(super) struct Forming {
    /// Since when it has been good without a break, or since when it has formed.
    since: Option<u64>,
    formed: bool,
    moments: u64,
    good: u64,
}

impl Forming {
    /// One moment; it has formed after `needed` good ticks in a row.
    pub fn observe(&mut self, tick: u64, good: bool, needed: u64) {
        if !good && !self.formed {
            *self = Forming::default();
            return;
        }
        let since = *self.since.get_or_insert(tick);
        self.formed |= tick - since >= needed;
        self.moments += 1;
        self.good += u64::from(good);
    }

    /// Whether the present moment counts if it has formed or will turn out to have.
    pub fn may_have_formed(&self) -> bool {
        self.since.is_some()
    }

    /// The tick from which on it was good for long enough.
    pub fn formed_at(&self) -> Option<u64> {
        self.since.filter(|_| self.formed)
    }

    /// Share of the moments from then on that were good.
    pub fn good_share(&self) -> Option<f64> {
        self.formed.then(|| self.good as f64 / self.moments as f64)
    }
}
