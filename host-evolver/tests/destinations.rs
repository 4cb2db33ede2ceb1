//! `--out` at devices, pipes, links and places where no file can be.
#![cfg(unix)]

mod support;

use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;
use support::*;

fn draw(out: &Path) -> Command {
    let mut command = grn();
    command.arg("draw").arg(model()).arg(channel()).arg("--out").arg(out);
    command
}

fn scatter(out: &Path) -> Command {
    let mut command = grn();
    command.arg("scatter").arg(channel()).args(["--density", "0.01", "--out"]).arg(out);
    command
}

fn fifo(path: &Path) -> Outcome {
    assert!(Command::new("mkfifo").arg(path).status()?.success());
    Ok(())
}

#[test]
fn a_pipe_gets_the_bytes_and_stays_a_pipe() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let (file, pipe) = (scratch.path().join("file"), scratch.path().join("pipe"));
    fifo(&pipe)?;
    for command in [draw, scatter] {
        assert_code(&command(&file).output()?, 0);
        let reader = {
            let pipe = pipe.clone();
            std::thread::spawn(move || std::fs::read(pipe))
        };
        assert_code(&command(&pipe).output()?, 0);
        assert_eq!(reader.join().map_err(|_| "no reader")??, std::fs::read(&file)?);
        assert!(std::fs::metadata(&pipe)?.file_type().is_fifo());
    }
    Ok(())
}

#[test]
fn a_pipe_that_nobody_reads_is_refused_in_time() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let pipe = scratch.path().join("pipe");
    fifo(&pipe)?;
    assert_refused(&draw(&pipe).output()?, &["pipe", "nobody reads"]);
    assert!(std::fs::metadata(&pipe)?.file_type().is_fifo());
    Ok(())
}

#[test]
fn devices_take_what_they_can_and_stay() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let to = |device: &str| guest(scratch.path())?.args(["draw", "blob.grn", "channel.toml", "--out", device]).output();
    assert_code(&to("/dev/null")?, 0);
    assert!(std::fs::metadata("/dev/null")?.file_type().is_char_device());
    let output = to("/dev/full")?;
    assert_code(&output, 3);
    assert!(text(&output.stderr).contains("/dev/full: cannot be written"), "{}", text(&output.stderr));
    // What /dev/stdout is, without what a faulty program could destroy.
    let standard_output = scratch.path().join("stdout");
    symlink("/proc/self/fd/1", &standard_output)?;
    let output = draw(&standard_output).output()?;
    assert_code(&output, 0);
    assert!(std::fs::symlink_metadata(&standard_output)?.is_symlink());
    assert!(text(&output.stdout).contains("</svg>"));
    Ok(())
}

#[test]
fn a_link_stays_and_its_target_is_written() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let path = |name: &str| scratch.path().join(name);
    std::fs::create_dir(path("deep"))?;
    std::fs::write(path("deep/old"), "old")?;
    symlink("deep/old", path("link"))?;
    symlink("link", path("link-to-link"))?;
    symlink("deep/new", path("dangling"))?;
    for (link, target) in [("link", "deep/old"), ("link-to-link", "deep/old"), ("dangling", "deep/new")] {
        assert_code(&draw(&path(link)).output()?, 0);
        assert!(std::fs::symlink_metadata(path(link))?.is_symlink(), "{link}");
        assert!(std::fs::read_to_string(path(target))?.contains("</svg>"), "{link}");
        std::fs::write(path("deep/old"), "old")?;
    }
    symlink("circle", path("circle"))?;
    assert_refused(&draw(&path("circle")).output()?, &["circle", "cannot be written"]);
    assert_eq!(std::fs::read_dir(path("deep"))?.count(), 2, "nothing else is left");
    Ok(())
}

#[test]
fn a_file_keeps_its_permissions_and_folders_are_refused() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let file = scratch.path().join("private");
    std::fs::write(&file, "old")?;
    std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o600))?;
    assert_code(&draw(&file).output()?, 0);
    assert_eq!(std::fs::metadata(&file)?.mode() & 0o777, 0o600);
    for out in
        [scratch.path(), Path::new("/proc/nothing/x.svg"), &file.join("x.svg"), &scratch.path().join("x".repeat(300))]
    {
        assert_refused(&draw(out).output()?, &["cannot be written"]);
        assert_refused(&scatter(out).output()?, &["cannot be written"]);
    }
    assert_eq!(std::fs::read_dir(scratch.path())?.count(), 1, "nothing else is left");
    Ok(())
}

#[test]
fn flash_refuses_what_is_no_folder() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let pipe = scratch.path().join("pipe");
    fifo(&pipe)?;
    let output = grn().arg("flash").arg(model()).arg("--out").arg(&pipe).output()?;
    assert_refused(&output, &["cannot be written"]);
    let output = guest(scratch.path())?.args(["flash", "blob.grn", "--out", "/dev/null"]).output()?;
    assert_refused(&output, &["cannot be written"]);
    assert!(std::fs::metadata(&pipe)?.file_type().is_fifo());
    Ok(())
}
