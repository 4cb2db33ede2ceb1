//! The same bits everywhere: here on the host with debug assertions; `cargo xtask target` runs the same trials in other
//! builds and on four emulated cores.

#[test]
fn digests_are_the_golden_ones() -> Result<(), Box<dyn std::error::Error>> {
    let (path, text) = grn_tests::golden::digests();
    assert_eq!(std::fs::read_to_string(&path)?, text, "{} is not what this machine gives", path.display());
    Ok(())
}
