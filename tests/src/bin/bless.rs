//! Writes golden files anew: `bless models`, then `bless digest`, whose program holds the models and so has to be built after
//! them. Run it on purpose, look at the difference, and say in the commit why it changed.

use grn_tests::golden::{GoldenError, digests, shipped_models};

fn main() -> Result<(), GoldenError> {
    let files = match std::env::args().nth(1).as_deref() {
        Some("models") => shipped_models()?,
        Some("digest") => vec![digests()],
        other => return Err(format!("bless models or bless digest, not {other:?}").into()),
    };
    for (path, bytes) in files {
        host_evolver::files::write(&path, &bytes)?;
        println!("{} ({} bytes)", path.display(), bytes.len());
    }
    Ok(())
}
