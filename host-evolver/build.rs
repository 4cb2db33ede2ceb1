//! Tells the program which commit it is built from.

use std::path::Path;
use std::process::Command;

/// The first line that git prints, if there is git, a checkout, and this crate is in it.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?;
    text.lines().next().filter(|line| !line.is_empty()).map(str::to_owned)
}

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // A package that was unpacked below somebody else's checkout does not have that one's commit.
    let is_tracked = git(&["ls-files", "Cargo.toml"]).is_some();
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).filter(|_| is_tracked);
    if commit.is_some() {
        let branch = git(&["symbolic-ref", "--quiet", "HEAD"]).unwrap_or_default();
        for name in ["HEAD", "logs/HEAD", &branch].into_iter().filter(|name| !name.is_empty()) {
            // Cargo would build again and again for a file that does not exist.
            if let Some(path) = git(&["rev-parse", "--git-path", name]).filter(|path| Path::new(path).exists()) {
                println!("cargo::rerun-if-changed={path}");
            }
        }
    }
    println!("cargo::rustc-env=GRN_COMMIT={}", commit.as_deref().unwrap_or("unknown"));
}
