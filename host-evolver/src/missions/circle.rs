//! A controller that keeps to a circle, whatever stands in the way: the baseline of those that adapt.

use crate::model::deploy;
use firmware_sim::scenario::Morphogen;
use grn_core::blob::Blob;
use grn_core::motif::Motif;
use grn_core::network::{Gene, Network, NetworkError, Source};

/// The network NEG(x1), which knows nothing of obstacles.
#[derive(Clone, Debug)]
pub struct Circle {
    network: Network<f32>,
}

impl Circle {
    /// The network.
    ///
    /// # Errors
    /// None: θ is 1/2.
    pub fn new() -> Result<Circle, NetworkError> {
        let gene = Gene { motif: Motif::Neg, inputs: [Source::X1].into_iter().collect(), theta: 0.5 };
        Ok(Circle { network: Network::new(1.0, [gene])? })
    }

    /// The blob whose level is such that its pattern around a lone target is a circle of this radius, metres of the scenario. The
    /// circles of several targets merge where their morphogens add up, as the patterns of every model do.
    ///
    /// A blob holds levels from 0.01 to 0.99 only; a radius that is much smaller or larger than σ_t becomes the nearest possible one.
    pub fn blob(&self, morphogen: &Morphogen, radius: f64, scale: f32) -> Blob {
        let mut blob = deploy::blob(self.network.clone(), morphogen, scale);
        let x1 = blob.field.field::<f64>(1.0).target_concentration(radius);
        let exact = self.network.cast::<f64>();
        let m = |x1: f64| exact.steady_state(x1, 0.0);
        let share = (m(x1) - m(0.0)) / (m(1.0) - m(0.0));
        blob.level_fraction = (share as f32).clamp(0.01, 0.99);
        blob
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::blob_bytes;
    use crate::simulation::PatternRuler;
    use firmware_sim::scenario::Scenario;

    #[test]
    fn its_ring_has_the_radius() {
        let world = Scenario::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/adaptive/narrow.toml")).unwrap();
        for radius in [0.3, 0.55, 0.75, 1.5, 2.3] {
            let blob = Circle::new().unwrap().blob(&world.morphogen(), radius, 0.25);
            blob_bytes(&blob).unwrap();
            let ring = PatternRuler::new(&blob, &world).unwrap().ring_radius();
            assert!((ring - radius * 0.25).abs() < 1e-4, "{ring} instead of {radius}");
        }
    }
}
