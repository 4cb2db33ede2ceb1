//! Tells the program its version with the commit it was built from, so that results can be traced to their source.

use std::process::Command;

/// What a build depends on: a change there is a change of the program.
const SOURCES: [&str; 4] = ["../grn-core", "../crates", "../firmware-sim", "../host-evolver"];

fn main() {
    let version = env!("CARGO_PKG_VERSION");
    println!("cargo:rustc-env=GRN_VERSION={version} ({})", commit().unwrap_or_else(|| "unknown commit".into()));
}

/// The commit that the sources are of, marked if they were changed since; `None` outside this repository.
fn commit() -> Option<String> {
    let in_packet = std::fs::read_to_string(".cargo_vcs_info.json").ok();
    if let Some(sha1) = in_packet.as_deref().and_then(|info| info.split("\"sha1\": \"").nth(1)) {
        return sha1.get(..12).map(String::from);
    }
    // Whoever unpacked the sources inside a repository of their own did not commit them there.
    if !std::path::Path::new("../.git").exists() {
        return None;
    }
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    println!("cargo:rerun-if-changed={}", git(&["rev-parse", "--git-path", "logs/HEAD"])?);
    SOURCES.iter().for_each(|source| println!("cargo:rerun-if-changed={source}"));
    let changed = git(&[&["status", "--porcelain", "--"], &SOURCES[..]].concat())?;
    Some(if changed.is_empty() { commit } else { format!("{commit}, modified") })
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
