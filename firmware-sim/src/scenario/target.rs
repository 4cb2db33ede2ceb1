//! A target.

use super::{Path, Presence};
use grn_core::geometry::Point;

/// What is to be surrounded.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    pub(super) path: Path,
    pub(super) presence: Presence,
}

impl Target {
    /// Its way.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// When it is there.
    pub fn presence(&self) -> &Presence {
        &self.presence
    }

    /// Where it is at a time, 0 to 1; `None` while it is not there.
    pub fn at(&self, time: f64) -> Option<Point<f64>> {
        self.presence.holds(time).then(|| self.path.at(time))
    }

    #[must_use]
    pub(super) fn scaled(&self, factor: f64) -> Target {
        Target { path: self.path.scaled(factor), presence: self.presence.clone() }
    }
}
