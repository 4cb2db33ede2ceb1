//! A network with its pattern, in the host's reference precision.

use super::lanes::Lanes;
use grn_core::network::{DEFAULT_GENES, Network};
use grn_core::pattern::{NoPattern, Pattern};

/// A network that has a pattern.
#[derive(Clone, Debug)]
pub struct Model {
    network: Network<f64, DEFAULT_GENES>,
    pattern: Pattern<f64>,
}

impl Model {
    /// The model of a robot's network, with level fraction c.
    ///
    /// # Errors
    /// [`NoPattern`] if the network hardly tells a target from empty space.
    pub fn new(network: &Network<f32, DEFAULT_GENES>, level_fraction: f64) -> Result<Model, NoPattern> {
        let network = network.cast();
        let pattern = Pattern::of(&network, level_fraction)?;
        Ok(Model { network, pattern })
    }

    /// The network in `f64`.
    pub fn network(&self) -> &Network<f64, DEFAULT_GENES> {
        &self.network
    }

    /// Level and orientation.
    pub fn pattern(&self) -> &Pattern<f64> {
        &self.pattern
    }

    /// The pattern error φ of the steady state: ≥ 0 inside.
    pub fn error(&self, x1: f64, x2: f64) -> f64 {
        self.pattern.error(self.network.steady_state(x1, x2))
    }

    /// The same at eight places.
    pub(super) fn errors(&self, x1: Lanes, x2: Lanes) -> Lanes {
        let m = self.network.steady_morphogen([x1, x2]);
        let (level, per_contrast) = (self.pattern.level(), 1.0 / self.pattern.contrast());
        (m - Lanes::splat(level)) * Lanes::splat(per_contrast)
    }
}
