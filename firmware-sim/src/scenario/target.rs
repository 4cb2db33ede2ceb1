//! A target.

use super::{Evasion, Path, Presence};
use grn_core::geometry::Point;

/// What is to be surrounded.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    pub(super) path: Path,
    pub(super) presence: Presence,
    pub(super) evasion: Option<Evasion>,
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

    /// How it leaves its path for robots, if it does.
    pub fn evasion(&self) -> Option<Evasion> {
        self.evasion
    }

    /// Where its path has it at a time, 0 to 1; `None` while it is not there.
    pub fn at(&self, time: f64) -> Option<Point<f64>> {
        self.presence.holds(time).then(|| self.path.at(time))
    }

    #[must_use]
    pub(super) fn scaled(&self, factor: f64) -> Target {
        Target {
            path: self.path.scaled(factor),
            presence: self.presence.clone(),
            evasion: self.evasion.map(|evasion| evasion.scaled(factor)),
        }
    }
}
