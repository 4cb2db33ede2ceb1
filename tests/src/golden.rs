//! Files under test, and how a person writes them anew on purpose: `cargo xtask bless`.

use firmware_sim::scenario::Morphogen;
use grn_core::field::Kernel;
use grn_core::scalar::Q8_24;
use host_evolver::files::blob_bytes;
use host_evolver::model::deploy;
use host_evolver::model::published::PUBLISHED;
use std::path::PathBuf;

/// A path in the repository.
pub fn repository(path: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The morphogens of the model page.
pub fn morphogen() -> Morphogen {
    Morphogen { kernel: Kernel::Gaussian, target_width: 1.5, obstacle_width: 0.9, level: 0.5 }
}

/// Anything that keeps a golden file from being made.
pub type GoldenError = Box<dyn std::error::Error>;

/// The file of digests that every machine must give, and its text as this one gives it.
pub fn digests() -> (PathBuf, Vec<u8>) {
    let [f32, fixed] = [
        grn_trials::digests::<f32>().lines::<f32>().to_string(),
        grn_trials::digests::<Q8_24>().lines::<Q8_24>().to_string(),
    ];
    (repository("tests/golden/digest.txt"), (f32 + &fixed).into_bytes())
}

/// The blobs of the printed models that ship in `models/`: path and bytes.
///
/// # Errors
/// Whatever keeps a printed model from being a valid blob.
pub fn shipped_models() -> Result<Vec<(PathBuf, Vec<u8>)>, GoldenError> {
    PUBLISHED
        .iter()
        .map(|model| {
            let blob = deploy::blob(model.network()?, &morphogen(), deploy::DEFAULT_SCALE);
            Ok((repository(&format!("models/{}.grn", model.name)), blob_bytes(&blob)?))
        })
        .collect()
}
