//! Writes the golden files anew. Run it on purpose, look at the difference, and say in the commit why it changed.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (path, bytes) in grn_tests::golden::shipped_models()? {
        host_evolver::files::write(&path, &bytes)?;
        println!("{} ({} bytes)", path.display(), bytes.len());
    }
    let (path, text) = grn_tests::golden::digests();
    host_evolver::files::write(&path, text.as_bytes())?;
    println!("{}", path.display());
    Ok(())
}
