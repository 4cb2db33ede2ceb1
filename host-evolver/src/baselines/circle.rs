//! A circle as a model, which knows nothing of obstacles.

use crate::model::deploy;
use crate::simulation::SimulationError;
use firmware_sim::scenario::Morphogen;
use grn_core::blob::Blob;
use grn_core::motif::Motif;
use grn_core::network::{Gene, Network, NetworkError, STEEPNESS_RANGE, Source, THETA_RANGE};
use grn_input::InputError;

/// A network whose pattern at the morphogen's level is the circle of this radius, metres of the model, around a lone target, whatever the
/// obstacles. Its only gene is σ(k (x1 - θ)) with the steepest k. A radius of many σ_t becomes the largest that the morphogen can
/// tell; one far below σ_t leaves the model without a contrast that makes a pattern.
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

/// A blob whose pattern around a lone target is a circle of this radius, metres of the model: robots with it keep to the circle, whatever
/// stands in the way. It has a level of its own, which tells small radii that [`circle`] cannot. The circles of several
/// targets merge where their morphogens add up, as the patterns of every model do.
///
/// Levels are from 0.01 to 0.99 only: a radius that is much smaller or larger than σ_t becomes the nearest possible one.
///
/// # Errors
/// None: the gene is in all ranges.
pub fn circle_blob(radius: f64, morphogen: &Morphogen, scale: f32) -> Result<Blob, SimulationError> {
    let gene = Gene { motif: Motif::Neg, inputs: [Source::X1].into_iter().collect(), theta: 0.5 };
    let network = Network::<f32>::new(1.0, [gene]).map_err(|error| {
        SimulationError::Config(InputError::new("radius", format!("{radius:?}"), error.to_string()))
    })?;
    let exact = network.cast::<f64>();
    let m = |x1: f64| exact.steady_state(x1, 0.0);
    let at_ring = morphogen.kernel.concentration(radius / morphogen.target_width);
    let share = (m(at_ring) - m(0.0)) / (m(1.0) - m(0.0));
    let blob = deploy::blob(network, morphogen, scale);
    Ok(Blob { level_fraction: (share as f32).clamp(0.01, 0.99), ..blob })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::{Evaluator, Model, World};
    use crate::figures::perfect_circle;
    use crate::files::blob_bytes;
    use firmware_sim::scenario::Scenario;
    use grn_core::pattern::Pattern;

    #[test]
    fn the_circle_has_the_radius_in_every_morphogen() {
        let open = Scenario::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/open.toml")).unwrap();
        let (usual, ring) = (open.morphogen(), open.ring());
        let check = |blob: Blob, radius: f64| {
            let pattern = Pattern::of(&blob.network, blob.level_fraction).unwrap();
            let found = pattern.free_space_radius(&blob.network, &blob.field.field(1.0)).unwrap();
            assert!((f64::from(found) - radius).abs() < 0.002 * radius, "{radius}: {found}");
            blob_bytes(&blob).unwrap();
        };
        for (radius, target_width, level) in [(1.5, 1.5, 0.5), (0.8, 1.5, 0.3), (2.5, 1.2, 0.7), (0.3, 0.15, 0.5)] {
            let morphogen = Morphogen { target_width, level, ..usual };
            check(deploy::blob(circle(radius, &morphogen).unwrap(), &morphogen, 1.0), radius);
            check(circle_blob(radius, &morphogen, 1.0).unwrap(), radius);
        }
        for radius in [0.3, 0.55, 2.3] {
            check(circle_blob(radius, &usual, 1.0).unwrap(), radius);
        }
        // Of many widths: the largest that the morphogen can tell.
        let network = circle(30.0, &usual).unwrap();
        assert_eq!(network.genes()[0].theta, 0.0);
        // In the open it is as good as a circle can be.
        let network = circle((ring.d_min + ring.d_max) / 2.0, &usual).unwrap();
        let found = Evaluator::new(&World::new(open)).evaluate(&Model::new(&network, usual.level).unwrap());
        let best = perfect_circle(&ring);
        assert!(found.is_feasible() && found.f2 < best + 0.01, "{found:?}, at best {best}");
    }
}
