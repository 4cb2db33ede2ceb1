//! What is published can be: every crate that is not for this repository alone makes a package of its own.

use std::path::Path;
use std::process::Command;

#[test]
fn every_library_crate_makes_a_package() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    // Building what was packed once more is left to a release: it compiles everything again.
    cargo.args([
        "package",
        "--workspace",
        "--exclude",
        "grn-tests",
        "--exclude",
        "grn-python",
        "--exclude",
        "xtask",
        "--no-verify",
        "--allow-dirty",
    ]);
    let output = cargo.current_dir(root).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    for name in ["grn-core", "grn-input", "grn-optimisers", "grn-figures", "grn-link", "firmware-sim", "host-evolver"] {
        assert!(said.contains(&format!("Packaging {name} v")), "{name} was not packed:\n{said}");
    }
}
