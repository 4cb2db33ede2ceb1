//! A folder belongs to one process while it is written, and to one run or campaign for good.
#![cfg(unix)]

mod support;

use std::path::{Path, PathBuf};
use std::process::Child;
use std::time::Duration;
use support::*;

/// A process that has begun to fill its folder and goes on for long; it ends with the test.
struct Busy(Child);

impl Drop for Busy {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn busy(folder: &Path) -> Result<Busy, Box<dyn std::error::Error>> {
    let child = Busy(evolve(folder, 500, &["--threads", "1"]).spawn()?);
    while !folder.join("checkpoint.json").exists() {
        std::thread::sleep(Duration::from_millis(20));
    }
    Ok(child)
}

fn small_campaign(folder: &Path) -> std::io::Result<PathBuf> {
    let plan = folder.join("campaign.toml");
    let channel = channel().display().to_string();
    let text = format!(
        "name = \"c\"\nseeds = 3\n[[scenario]]\nfile = {channel:?}\nevaluations = 800\n\
         [[method]]\nname = \"m\"\nalgorithm = \"mogp\"\nmotifs = \"all\"\n"
    );
    std::fs::write(&plan, text)?;
    Ok(plan)
}

/// A campaign whose first run takes so long that a refusal after it would not come in time.
fn long(plan: &Path) -> std::io::Result<String> {
    Ok(std::fs::read_to_string(plan)?.replace("evaluations = 800", "evaluations = 4000000"))
}

fn campaign(plan: &Path, folder: &Path) -> std::process::Command {
    let mut command = grn();
    command.arg("campaign").arg(plan).arg("--out").arg(folder);
    command
}

#[test]
fn two_evolves_in_one_folder_the_second_is_told_who_is_there() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    let holder = busy(&folder)?;
    let process = format!("process {} on ", holder.0.id());
    let words = [process.as_str(), " since 20", "grn evolve", "--out"];
    assert_refused(&evolve(&folder, 1, &["--seed", "2"]).output()?, &words);
    assert_refused(&evolve(&folder, 500, &["--threads", "1", "--resume"]).output()?, &words);
    assert_refused(&campaign(&small_campaign(scratch.path())?, &folder).output()?, &words);
    let simulate = grn().arg("simulate").arg(model()).arg(channel()).arg("--out").arg(&folder).output()?;
    assert_refused(&simulate, &["run", "--out"]);
    Ok(())
}

#[test]
fn the_lock_of_a_killed_process_holds_nobody_up() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    drop(busy(&folder)?);
    let output = evolve(&folder, 500, &["--resume", "--seed", "2"]).output()?;
    assert_refused(&output, &["settings.seed is 1 there and 2 now"]);
    assert!(!text(&output.stderr).contains("in use"));
    Ok(())
}

#[test]
fn runs_begun_together_without_out_choose_different_folders() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let start = || {
        let mut command = grn();
        command.arg("evolve").arg(channel()).args(["--paper", "--evaluations", "800", "--threads", "1"]);
        command.current_dir(scratch.path()).spawn()
    };
    let children: Vec<Child> = (0..4).map(|_| start()).collect::<Result<_, _>>()?;
    for child in children {
        assert_answered(&child.wait_with_output()?);
    }
    let runs = scratch.path().join("runs");
    for name in ["channel-seed-1-2", "channel-seed-1-3", "channel-seed-1-4"] {
        assert_eq!(different(&runs.join("channel-seed-1"), &runs.join(name))?, Vec::<PathBuf>::new(), "{name}");
    }
    Ok(())
}

#[test]
fn two_campaigns_in_one_folder_one_is_refused_and_the_other_is_whole() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = small_campaign(scratch.path())?;
    let alone = scratch.path().join("alone");
    assert_code(&campaign(&plan, &alone).output()?, 0);
    for round in 0..3 {
        let folder = scratch.path().join(format!("shared-{round}"));
        let mut children = Vec::new();
        for _ in 0..3 {
            children.push(campaign(&plan, &folder).args(["--threads", "1"]).spawn()?);
        }
        let outputs: Vec<_> = children.into_iter().map(Child::wait_with_output).collect::<Result<_, _>>()?;
        for output in outputs.iter().filter(|output| output.status.code() != Some(0)) {
            assert_refused(output, &["in use by process", "grn campaign"]);
        }
        assert!(outputs.iter().any(|output| output.status.code() == Some(0)));
        assert_eq!(different(&alone, &folder)?, Vec::<PathBuf>::new());
    }
    Ok(())
}

#[test]
fn a_folder_that_is_being_written_is_not_merged() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = small_campaign(scratch.path())?;
    let (there, here) = (scratch.path().join("there"), scratch.path().join("here"));
    let long = scratch.path().join("long.toml");
    std::fs::write(&long, std::fs::read_to_string(&plan)?.replace("seeds = 3", "seeds = 3000"))?;
    let writer = Busy(campaign(&long, &there).spawn()?);
    while !there.join("runs/channel/m/001/manifest.json").exists() {
        std::thread::sleep(Duration::from_millis(20));
    }
    let merge = |other: &Path| campaign(&plan, &here).arg("--merge").arg(other).output();
    assert_refused(&merge(&there)?, &["there", "in use by process", "grn campaign"]);
    drop(writer);
    assert_code(&merge(&there)?, 0);
    assert_refused(&merge(&here)?, &["own folder", "--merge"]);
    assert_refused(&merge(scratch.path())?, &["no campaign", "--merge"]);
    Ok(())
}

#[test]
fn unfinished_files_of_a_killed_run_go_and_those_of_others_stay() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    // Killed before its manifest was written.
    std::fs::create_dir(&folder)?;
    std::fs::write(folder.join(".unfinished-abc"), "")?;
    assert_answered(&evolve(&folder, 1, &["--resume"]).output()?);
    for place in ["", "front", "simulation", "mine"] {
        std::fs::create_dir_all(folder.join(place))?;
        std::fs::write(folder.join(place).join(".unfinished-def"), "")?;
    }
    assert_answered(&evolve(&folder, 1, &["--resume"]).output()?);
    let left: Vec<PathBuf> = content(&folder)?.into_iter().map(|(path, _)| path).collect();
    let unfinished: Vec<&PathBuf> = left.iter().filter(|path| path.to_string_lossy().contains("unfinished")).collect();
    assert_eq!(unfinished, [&PathBuf::from("mine/.unfinished-def")]);
    assert!(!left.iter().any(|path| path.to_string_lossy().contains("lock")), "{left:?}");
    Ok(())
}

#[test]
fn a_folder_that_holds_other_things_is_left_alone() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("mine");
    std::fs::create_dir(&folder)?;
    std::fs::write(folder.join("thesis.tex"), "words")?;
    let plan = small_campaign(scratch.path())?;
    assert_refused(&evolve(&folder, 1, &[]).output()?, &["mine", "thesis.tex", "--out"]);
    assert_refused(&campaign(&plan, &folder).output()?, &["mine", "thesis.tex", "--out"]);
    assert_eq!(content(&folder)?.len(), 1);
    Ok(())
}

#[test]
fn folders_that_cannot_be_written_are_refused_before_the_first_run() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = small_campaign(scratch.path())?;
    std::fs::write(&plan, long(&plan)?)?;
    let file = scratch.path().join("file");
    std::fs::write(&file, "")?;
    for folder in [file.join("below"), PathBuf::from("/proc/nothing/here"), scratch.path().join("x".repeat(300))] {
        let begin = std::time::Instant::now();
        assert_refused(&evolve(&folder, 5000, &[]).output()?, &["cannot be written"]);
        assert_refused(&campaign(&plan, &folder).output()?, &["cannot be written"]);
        let simulate = grn().arg("simulate").arg(model()).arg(channel()).arg("--out").arg(&folder).output()?;
        assert_refused(&simulate, &["cannot be written"]);
        assert!(begin.elapsed() < Duration::from_secs(10), "{}", folder.display());
    }
    Ok(())
}

#[test]
fn a_read_only_folder_is_refused_before_the_first_run() -> Outcome {
    use std::os::unix::fs::PermissionsExt;
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("read-only");
    std::fs::create_dir(&folder)?;
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o555))?;
    let plan = small_campaign(scratch.path())?;
    std::fs::write(&plan, long(&plan)?.replace(&channel().display().to_string(), "channel.toml"))?;
    let begin = std::time::Instant::now();
    for (command, file) in [("evolve", "channel.toml"), ("campaign", "campaign.toml")] {
        let mut run = guest(scratch.path())?;
        run.args([command, file, "--out", "read-only/run"]);
        if command == "evolve" {
            run.args(["--evaluations", "4000000"]);
        }
        assert_refused(&run.output()?, &["read-only/run", "cannot be written", "ermission denied"]);
    }
    assert!(begin.elapsed() < Duration::from_secs(10), "refused after a run");
    Ok(())
}
