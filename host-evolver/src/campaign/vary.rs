//! The same world with one number changed: for asking what a result hangs on.

use firmware_sim::scenario::{InputError, Morphogen, Ring, Scenario};
use grn_core::field::Kernel;
use serde::Deserialize;

/// Both widths under the exponential kernel, metres: as in public code of this family.
const EXPONENTIAL_WIDTH: f64 = 1.0;

/// Factors by which one number at a time is multiplied. The unchanged world always comes first.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Variations {
    /// Of σ_o.
    #[serde(default)]
    obstacle_width: Vec<f64>,
    /// Of the level fraction c.
    #[serde(default)]
    level: Vec<f64>,
    /// Of k1, k2 and k3 together.
    #[serde(default)]
    steepness: Vec<f64>,
    /// Of every length of region, paths and walls, while the model's lengths stay: channels get wider or narrower.
    #[serde(default)]
    world: Vec<f64>,
    /// Whether the exponential kernel is tried, both widths 1 m.
    #[serde(default)]
    exponential_kernel: bool,
}

impl Variations {
    /// The world and its variations; their names say what was changed.
    pub fn of(&self, scenario: &Scenario) -> Result<Vec<Scenario>, InputError> {
        let (morphogen, ring) = (scenario.morphogen(), scenario.ring());
        let mut all = vec![scenario.clone()];
        let name = |what: &str, factor: f64| format!("{}, {what} x {factor}", scenario.name());
        for &factor in &self.obstacle_width {
            let changed = Morphogen { obstacle_width: morphogen.obstacle_width * factor, ..morphogen };
            all.push(scenario.with(&name("obstacle width", factor), changed, ring)?);
        }
        for &factor in &self.level {
            let changed = Morphogen { level: morphogen.level * factor, ..morphogen };
            all.push(scenario.with(&name("level", factor), changed, ring)?);
        }
        for &factor in &self.steepness {
            let changed = Ring { steepness: ring.steepness * factor, ..ring };
            all.push(scenario.with(&name("steepness", factor), morphogen, changed)?);
        }
        for &factor in &self.world {
            all.push(scenario.scaled(factor).with(&name("world", factor), morphogen, ring)?);
        }
        if self.exponential_kernel {
            let changed = Morphogen {
                kernel: Kernel::Exponential,
                target_width: EXPONENTIAL_WIDTH,
                obstacle_width: EXPONENTIAL_WIDTH,
                ..morphogen
            };
            all.push(scenario.with(&format!("{}, exponential kernel", scenario.name()), changed, ring)?);
        }
        Ok(all)
    }
}
