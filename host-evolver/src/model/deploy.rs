//! From a model to the blob a robot runs.

use firmware_sim::scenario::Morphogen;
use grn_core::blob::{Blob, FieldParameters, Gains};
use grn_core::dynamics::Step;
use grn_core::network::Network;

/// World metres per model metre when nothing else is said: a laboratory arena of 5 m for the paper's 20 m.
pub const DEFAULT_SCALE: f32 = 0.25;
/// GRN seconds per second when nothing else is said.
pub const DEFAULT_TIME_SCALE: f32 = 4.0;
/// The GRN time that passes in one control tick, so that a tick is one RK4 step when nothing else is said. Genes
/// relax at rate 1, so that RK4 errs by h⁴/120 of the change, 2e-6, half of what Q8.24's sigmoid may.
pub const DEFAULT_STEP: Step = Step::EIGHTH;

/// A blob with the scenario's morphogens and the default motion law.
pub fn blob(network: Network<f32>, morphogen: &Morphogen, scale: f32) -> Blob {
    Blob {
        network,
        field: FieldParameters {
            kernel: morphogen.kernel,
            target_width: morphogen.target_width as f32,
            obstacle_width: morphogen.obstacle_width as f32,
        },
        level_fraction: morphogen.level as f32,
        scale,
        step: DEFAULT_STEP,
        time_scale: DEFAULT_TIME_SCALE,
        gains: Gains::default(),
    }
}
