//! The terms of f2, tabulated.

use super::distance_table::{DistanceTable, Sigmoid};
use firmware_sim::scenario::Ring;

/// How far off the terms may be, both tabulated and summed.
const ROUNDING: f64 = 1e-6;

/// The terms of f2 as functions of a distance.
#[derive(Clone, Debug)]
pub(crate) struct Terms {
    /// No snapshot's f2 is below: the terms of a point midway between d_min and d_max from every target, 2 sig(-(d_max - d_min) / 2, 0, k).
    pub(super) least: f64,
    /// sig(d, d_max, k1) + sig(d_min, d, k2).
    pub(crate) target: DistanceTable,
    /// sig(d_obstacle, d, k3).
    pub(crate) obstacle: DistanceTable,
}

impl Terms {
    pub(crate) fn of(ring: Ring) -> Terms {
        let rising = |threshold: f64| Sigmoid { threshold, slope: ring.steepness };
        let falling = |threshold: f64| Sigmoid { threshold, slope: -ring.steepness };
        Terms {
            least: 2.0 * rising(ring.d_max).at((ring.d_min + ring.d_max) / 2.0) - ROUNDING,
            target: DistanceTable::new(vec![rising(ring.d_max), falling(ring.d_min)]),
            obstacle: DistanceTable::new(vec![falling(ring.d_obstacle)]),
        }
    }
}
