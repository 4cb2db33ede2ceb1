//! Where `--out` and `--merge` may point, and what is left if something is in the way.
#![cfg(unix)]

mod support;

use std::path::{Path, PathBuf};
use std::process::Command;
use support::*;

fn simulate(out: &Path, more: &[&str]) -> Command {
    let mut command = grn();
    command.arg("simulate").arg(model()).arg(channel()).arg("--out").arg(out).args(more);
    command
}

fn campaign(folder: &Path, out: &Path, motifs: &str) -> std::io::Result<Command> {
    let plan = folder.join(format!("{motifs}.toml"));
    let text = format!(
        "name = \"c\"\nseeds = 2\n[[scenario]]\nfile = {:?}\nevaluations = 400\n[[method]]\nname = \"m\"\n\
         algorithm = \"mogp\"\nmotifs = {motifs:?}\nde_generations = 0\n",
        channel().display().to_string()
    );
    std::fs::write(&plan, text)?;
    let mut command = grn();
    command.arg("campaign").arg(plan).arg("--out").arg(out);
    Ok(command)
}

fn flash(out: &Path) -> Command {
    let mut command = grn();
    command.arg("flash").arg(model()).arg("--out").arg(out);
    command
}

fn names(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    Ok(content(folder)?.into_iter().map(|(path, _)| path).collect())
}

#[test]
fn a_run_and_a_campaign_are_not_taken_for_each_other_nor_called_damaged() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let (run, other) = (scratch.path().join("run"), scratch.path().join("other"));
    assert_answered(&evolve(&run, 1, &[]).output()?);
    assert_code(&campaign(scratch.path(), &other, "all")?.args(["--shard", "1/2"]).output()?, 0);
    let before = (content(&run)?, content(&other)?);
    for more in [&[][..], &["--resume"]] {
        let output = evolve(&other, 1, more).output()?;
        assert_refused(&output, &["other", "folder of a campaign", "--out"]);
        assert!(!text(&output.stderr).contains("delete"), "a campaign is not to be deleted: {}", text(&output.stderr));
    }
    let output = campaign(scratch.path(), &run, "all")?.output()?;
    assert_refused(&output, &["run", "a run of grn evolve", "--out"]);
    assert!(!text(&output.stderr).contains("damaged"), "{}", text(&output.stderr));
    assert_eq!((content(&run)?, content(&other)?), before);
    Ok(())
}

#[test]
fn nothing_is_written_among_the_files_of_a_run_or_campaign() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let (run, other) = (scratch.path().join("run"), scratch.path().join("other"));
    assert_answered(&evolve(&run, 1, &[]).output()?);
    assert_code(&campaign(scratch.path(), &other, "all")?.args(["--shard", "1/2"]).output()?, 0);
    std::os::unix::fs::symlink(run.join("simulation"), scratch.path().join("link"))?;
    let before = (content(&run)?, content(&other)?);
    for place in ["run/simulation", "run/front/", "link", "other/runs", "other/runs/channel/m/002", "other/trials/new"]
    {
        let place = scratch.path().join(place);
        assert_refused(&simulate(&place, &[]).output()?, &["is filled by", "--out"]);
        assert_refused(&evolve(&place, 1, &[]).output()?, &["is filled by", "--out"]);
        assert_refused(&flash(&place).output()?, &["is filled by", "--out"]);
    }
    for place in [&run, &other] {
        assert_refused(&flash(place).output()?, &["folder of a run or campaign", "--out"]);
    }
    assert_eq!((content(&run)?, content(&other)?), before);
    assert_answered(&simulate(&run.join("another"), &[]).output()?);
    Ok(())
}

#[test]
fn a_refused_merge_has_made_and_copied_nothing() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let path = |name: &str| scratch.path().join(name);
    for (name, motifs) in [("good", "all"), ("foreign", "binary")] {
        assert_code(&campaign(scratch.path(), &path(name), motifs)?.args(["--shard", "1/2"]).output()?, 0);
    }
    std::fs::create_dir(path("empty"))?;
    let reasons = [("foreign", "motifs"), ("empty", "no campaign"), ("missing", "no such folder")];
    for (other, reason) in reasons {
        let out = path("out");
        let mut command = campaign(scratch.path(), &out, "all")?;
        let output = command.arg("--merge").arg(path("good")).arg("--merge").arg(path(other)).output()?;
        assert_refused(&output, &[other, reason]);
        assert!(!out.exists(), "{other}");
    }
    Ok(())
}

#[test]
fn what_is_no_folder_is_named() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let path = |name: &str| scratch.path().join(name);
    std::fs::write(path("file"), "mine")?;
    std::os::unix::fs::symlink("nowhere", path("dangling"))?;
    for (name, what) in
        [("file", "it is a file"), ("dangling", "a link that leads to nothing"), ("/dev/null", "device")]
    {
        for mut command in [evolve(&path(name), 1, &[]), simulate(&path(name), &[])] {
            assert_refused(&command.output()?, &[name, what, "no folder", "--out"]);
        }
    }
    assert_eq!(std::fs::read_to_string(path("file"))?, "mine");
    assert!(!path("nowhere").exists());
    Ok(())
}

#[test]
fn a_file_whose_name_ends_like_a_folders_is_refused_before_it_is_made() -> Outcome {
    let scratch = tempfile::tempdir()?;
    for name in ["new/", "new.svg/", "new/.", "deep/er/"] {
        let out = format!("{}/{name}", scratch.path().display());
        let draw = grn().arg("draw").arg(model()).arg(channel()).args(["--out", &out]).output()?;
        let scatter = grn().arg("scatter").arg(channel()).args(["--out", &out]).output()?;
        assert_refused(&draw, &[name, "names a folder"]);
        assert_refused(&scatter, &[name, "names a folder"]);
    }
    assert_eq!(std::fs::read_dir(scratch.path())?.count(), 0);
    Ok(())
}

#[test]
fn files_that_belong_together_are_replaced_together_or_not_at_all() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let (simulated, flashed) = (scratch.path().join("simulated"), scratch.path().join("flashed"));
    std::fs::create_dir_all(simulated.join("trace.csv"))?;
    std::fs::create_dir_all(flashed.join("flash.gdb"))?;
    std::fs::write(simulated.join("metrics.json"), "old")?;
    std::fs::write(flashed.join("slot.hex"), "old")?;
    let begin = std::time::Instant::now();
    let slow = ["--robots", "100", "--speed", "0.001"];
    assert_refused(&simulate(&simulated, &slow).output()?, &["trace.csv", "it is a folder"]);
    assert!(begin.elapsed() < std::time::Duration::from_secs(5), "refused after the simulation");
    assert_refused(&flash(&flashed).output()?, &["flash.gdb", "it is a folder"]);
    assert_eq!(names(&simulated)?, [PathBuf::from("metrics.json")]);
    assert_eq!(content(&flashed)?, [(PathBuf::from("slot.hex"), b"old".to_vec())]);
    Ok(())
}

#[test]
fn a_resumed_run_has_the_same_bytes_even_if_its_checkpoint_got_other_ends_of_lines() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let (whole, run) = (scratch.path().join("whole"), scratch.path().join("run"));
    assert_answered(&evolve(&whole, 1, &[]).output()?);
    assert_answered(&evolve(&run, 1, &[]).output()?);
    let checkpoint = run.join("checkpoint.json");
    let state = std::fs::read(&checkpoint)?;
    std::fs::write(&checkpoint, text(&state).replace('\n', "\r\n"))?;
    assert_answered(&evolve(&run, 1, &["--resume"]).output()?);
    assert_eq!(different(&whole, &run)?, Vec::<PathBuf>::new());
    let mut broken = state;
    broken[100] = 0xff;
    std::fs::write(&checkpoint, &broken)?;
    assert_refused(&evolve(&run, 1, &["--resume"]).output()?, &["checkpoint.json", "damaged", "from a copy"]);
    Ok(())
}
