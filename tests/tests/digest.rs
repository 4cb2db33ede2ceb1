//! The same bits everywhere: here on the host with debug assertions; `cargo xtask target` runs the same trials in other
//! builds and on four emulated cores.

#[test]
fn digests_are_the_golden_ones() -> Result<(), Box<dyn std::error::Error>> {
    let (path, bytes) = grn_tests::golden::digests();
    let [golden, found] = [std::fs::read(&path)?, bytes].map(String::from_utf8);
    assert_eq!(golden?, found?, "{} is not what this machine gives", path.display());
    Ok(())
}
