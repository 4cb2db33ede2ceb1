//! The circle that the rules aim at, as a model: for measuring how well they keep to it, and what its f2 is.

use crate::model::deploy;
use crate::simulation::SimulationError;
use firmware_sim::scenario::Morphogen;
use grn_core::blob::Blob;
use grn_core::field::Kernel;
use grn_core::motif::Motif;
use grn_core::network::{Gene, Network, NetworkError, STEEPNESS_RANGE, Source, THETA_RANGE};
use grn_input::InputError;

/// A network whose pattern is the circle of this radius, metres of the model, around a lone target, whatever the obstacles. Its only gene is
/// σ(k (x1 - θ)) with the steepest k. A radius that the morphogen cannot tell, of many widths or almost none, becomes the next one
/// that it can.
///
/// # Errors
/// None: the gene is in all ranges.
pub fn circle(radius: f64, morphogen: &Morphogen) -> Result<Network<f32>, NetworkError> {
    let (_, steepness) = STEEPNESS_RANGE;
    let at_ring = morphogen.kernel.concentration(radius / morphogen.target_width);
    // Of the way from M without a target to M at one, the share that M has come at the ring: it falls with θ.
    let share = |theta: f64| {
        let expressed = |x1: f64| 1.0 / (1.0 + libm::exp(f64::from(steepness) * (theta - x1)));
        (expressed(at_ring) - expressed(0.0)) / (expressed(1.0) - expressed(0.0))
    };
    let (mut low, mut high) = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
    for _ in 0..f64::MANTISSA_DIGITS {
        let middle = (low + high) / 2.0;
        if share(middle) > morphogen.level {
            low = middle;
        } else {
            high = middle;
        }
    }
    let theta = low as f32;
    Network::new(steepness, [Gene { motif: Motif::Pos, inputs: [Source::X1].into_iter().collect(), theta }])
}

/// The blob of that circle which runs are measured against. σ_t is half the radius, so narrow that circles around two targets hardly
/// bulge towards each other.
pub(super) fn ruler_of(radius: f64, scale: f32) -> Result<Blob, SimulationError> {
    let target_width = radius / 2.0;
    let morphogen = Morphogen { kernel: Kernel::Gaussian, target_width, obstacle_width: target_width, level: 0.5 };
    let network = circle(radius, &morphogen)
        .map_err(|error| SimulationError::Config(InputError::new("ring", format!("{radius:?}"), error.to_string())))?;
    Ok(deploy::blob(network, &morphogen, scale))
}
