//! What tests that drive the command share.
#![allow(dead_code, reason = "every test file uses a part of it")]

pub mod desk;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

pub type Outcome = Result<(), Box<dyn std::error::Error>>;

pub fn grn() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_grn"));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// The command as a user who may not do everything, in a folder with a blob and a world: as root a faulty program could
/// replace the machine's own devices, and nothing is read-only.
#[cfg(unix)]
pub fn guest(folder: &Path) -> std::io::Result<Command> {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o755))?;
    let program = folder.join("grn");
    std::fs::copy(env!("CARGO_BIN_EXE_grn"), &program)?;
    std::fs::copy(model(), folder.join("blob.grn"))?;
    std::fs::copy(channel(), folder.join("channel.toml"))?;
    let is_root = text(&Command::new("id").arg("-u").output()?.stdout).trim() == "0";
    let mut command = Command::new(if is_root { Path::new("setpriv") } else { &program });
    if is_root {
        command.args(["--reuid", "65534", "--clear-groups"]).arg(&program);
    }
    command.current_dir(folder).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    Ok(command)
}

pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

pub fn model() -> PathBuf {
    repository("models/nand-xnor.grn")
}

pub fn channel() -> PathBuf {
    repository("scenarios/channel.toml")
}

/// `grn evolve --paper` in the channel with the budget of so many whole generations.
pub fn evolve(folder: &Path, generations: usize, more: &[&str]) -> Command {
    let mut command = grn();
    command.arg("evolve").arg(channel()).arg("--paper").arg("--out").arg(folder);
    command.arg("--evaluations").arg((generations * 800).to_string()).args(more);
    command
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[track_caller]
pub fn assert_code(output: &Output, code: i32) {
    assert_eq!(output.status.code(), Some(code), "{}\n{}", text(&output.stdout), text(&output.stderr));
}

/// A run that came to its end, whatever the answer.
#[track_caller]
pub fn assert_answered(output: &Output) {
    assert!(matches!(output.status.code(), Some(0 | 1)), "{:?}: {}", output.status, text(&output.stderr));
}

#[track_caller]
pub fn assert_refused(output: &Output, words: &[&str]) {
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    for word in words {
        assert!(message.contains(word), "{word:?} is not in {message:?}");
    }
}

/// Everything in a folder and below, by path.
pub fn content(folder: &Path) -> std::io::Result<Vec<(PathBuf, Vec<u8>)>> {
    fn collect(folder: &Path, top: &Path, found: &mut Vec<(PathBuf, Vec<u8>)>) -> std::io::Result<()> {
        for entry in std::fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                collect(&path, top, found)?;
            } else {
                found.push((path.strip_prefix(top).unwrap_or(&path).to_owned(), std::fs::read(&path)?));
            }
        }
        Ok(())
    }
    let mut found = Vec::new();
    collect(folder, folder, &mut found)?;
    found.sort();
    Ok(found)
}

/// The names of what two folders hold differently.
pub fn different(ours: &Path, theirs: &Path) -> std::io::Result<Vec<PathBuf>> {
    let (ours, theirs) = (content(ours)?, content(theirs)?);
    let only = |a: &[(PathBuf, Vec<u8>)], b: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> {
        a.iter().filter(|entry| !b.contains(entry)).map(|(path, _)| path.clone()).collect()
    };
    let mut names = [only(&ours, &theirs), only(&theirs, &ours)].concat();
    names.sort();
    names.dedup();
    Ok(names)
}
