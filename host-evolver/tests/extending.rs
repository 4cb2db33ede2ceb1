//! Runs and campaigns that go on: to the same bytes as if they had been so long from the start, or not at all.

mod support;

use std::path::{Path, PathBuf};
use support::*;

fn evaluations(folder: &Path, evaluations: usize, more: &[&str]) -> std::process::Command {
    let mut command = grn();
    command.arg("evolve").arg(channel()).arg("--paper").arg("--out").arg(folder);
    command.arg("--evaluations").arg(evaluations.to_string()).args(more);
    command
}

#[test]
fn a_run_is_extended_to_the_bytes_of_one_that_was_as_long_from_the_start() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let long = scratch.path().join("long");
    assert_answered(&evaluations(&long, 3010, &[]).output()?);
    // Ends after a whole generation, within one, and within one evaluation of the next individual.
    for first in [800, 1600, 1220, 2399, 3009] {
        let folder = scratch.path().join(first.to_string());
        assert_answered(&evaluations(&folder, first, &["--threads", "1"]).output()?);
        let output = evaluations(&folder, 3010, &["--resume", "--threads", "2"]).output()?;
        assert_answered(&output);
        assert_eq!(different(&long, &folder)?, Vec::<PathBuf>::new(), "extended from {first}");
    }
    let steps = scratch.path().join("steps");
    assert_answered(&evaluations(&steps, 1000, &[]).output()?);
    for budget in [1000, 1700, 1705, 3010] {
        assert_answered(&evaluations(&steps, budget, &["--resume"]).output()?);
    }
    assert_eq!(different(&long, &steps)?, Vec::<PathBuf>::new(), "extended in steps");
    Ok(())
}

#[test]
fn a_run_with_trials_is_extended_likewise() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let tried = |folder: &str, evaluations: &str, more: &[&str]| {
        let mut command = grn();
        command.arg("evolve").arg(repository("scenarios/open.toml")).arg("--out").arg(scratch.path().join(folder));
        command.args(["--realities", "2", "--evaluations", evaluations]).args(more);
        command
    };
    assert_answered(&tried("long", "2100", &["--threads", "2"]).output()?);
    assert_answered(&tried("steps", "900", &["--threads", "1"]).output()?);
    assert_answered(&tried("steps", "2100", &["--resume"]).output()?);
    let [long, steps] = ["long", "steps"].map(|folder| scratch.path().join(folder));
    assert_eq!(different(&long, &steps)?, Vec::<PathBuf>::new());
    let front = std::fs::read_to_string(long.join("front.csv"))?;
    assert!(front.starts_with("nodes,f2,closed-loop,violation,knee,expression,blob\n"), "{front}");
    assert_eq!(front.matches("parsimony").count(), 1, "{front}");
    Ok(())
}

#[test]
fn a_run_is_not_shortened_and_other_settings_are_refused_by_name() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    assert_answered(&evaluations(&folder, 1600, &[]).output()?);
    let before = content(&folder)?;
    let refused = |budget: usize, more: &[&str], words: &[&str]| -> Outcome {
        assert_refused(&evaluations(&folder, budget, &[&["--resume"], more].concat()).output()?, words);
        assert_eq!(content(&folder)?, before);
        Ok(())
    };
    refused(800, &[], &["evaluations is 1600 there and 800 now", "not shortened", "--evaluations 1600", "--out"])?;
    refused(1600, &["--seed", "7"], &["settings.seed is 1 there and 7 now", "--out"])?;
    refused(2400, &["--motifs", "binary"], &["settings.motifs is \"all\" there and \"binary\" now"])?;
    refused(1600, &["--scale", "0.5"], &["scale is 0.25 there and 0.5 now"])?;
    Ok(())
}

#[test]
fn resume_with_a_mistyped_out_begins_nothing() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    assert_refused(&evolve(&folder, 1, &["--resume"]).output()?, &["run", "no run is here", "--out"]);
    assert!(!folder.exists());
    std::fs::create_dir(&folder)?;
    assert_refused(&evolve(&folder, 1, &["--resume"]).output()?, &["no run is here"]);
    std::fs::write(folder.join("notes.txt"), "")?;
    assert_refused(&evolve(&folder, 1, &["--resume"]).output()?, &["no run is here"]);
    assert_eq!(content(&folder)?.len(), 1);
    let without_out = grn().arg("evolve").arg(channel()).arg("--resume").current_dir(scratch.path()).output()?;
    assert_refused(&without_out, &["runs/channel-seed-1", "no run is here"]);
    Ok(())
}

#[test]
fn resume_of_another_version_says_which_version_goes_on() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    assert_answered(&evolve(&folder, 1, &[]).output()?);
    let path = folder.join("manifest.json");
    let manifest = std::fs::read_to_string(&path)?;
    let mut value: serde_json::Value = serde_json::from_str(&manifest)?;
    value["grn"] = "0.0.7".into();
    // Other versions have other fields, too.
    value["colour"] = "green".into();
    std::fs::write(&path, value.to_string())?;
    let output = evolve(&folder, 1, &["--resume"]).output()?;
    assert_refused(&output, &["manifest.json", "made by grn 0.0.7", "go on with grn 0.0.7", "--out"]);
    assert!(!text(&output.stderr).contains("same settings"));
    Ok(())
}

fn plan(folder: &Path, seeds: u64) -> std::io::Result<PathBuf> {
    let plan = folder.join("campaign.toml");
    let [channel, open] = [channel(), repository("scenarios/open.toml")].map(|path| path.display().to_string());
    std::fs::write(
        &plan,
        format!(
            "name = \"c\"\nseeds = {seeds}\n[[scenario]]\nfile = {channel:?}\nevaluations = 800\n\
             [[method]]\nname = \"m\"\nalgorithm = \"mogp\"\nmotifs = \"all\"\n\
             [[transfer]]\nname = \"t\"\nfrom = [\"channel\"]\nfile = {open:?}\n"
        ),
    )?;
    Ok(plan)
}

fn campaign(plan: &Path, folder: &Path) -> std::io::Result<std::process::Output> {
    grn().arg("campaign").arg(plan).arg("--out").arg(folder).output()
}

#[test]
fn seeds_are_added_to_a_campaign_and_not_taken_away() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let (long, folder) = (scratch.path().join("long"), scratch.path().join("out"));
    let three = plan(scratch.path(), 3)?;
    assert_code(&campaign(&three, &long)?, 0);
    for seeds in [1, 2, 3] {
        assert_code(&campaign(&plan(scratch.path(), seeds)?, &folder)?, 0);
    }
    assert_eq!(different(&long, &folder)?, Vec::<PathBuf>::new());
    let refused = campaign(&plan(scratch.path(), 2)?, &folder)?;
    assert_refused(&refused, &["seeds is 3 there and 2 now", "not shortened", "--out"]);
    assert_eq!(different(&long, &folder)?, Vec::<PathBuf>::new());
    Ok(())
}

#[test]
fn a_changed_campaign_leaves_no_stale_pictures_and_nothing_of_others_is_deleted() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("out");
    let with = plan(scratch.path(), 1)?;
    let text_with = std::fs::read_to_string(&with)?;
    let (channel, two) = (channel(), repository("scenarios/channel-two-targets.toml"));
    let [channel, two] = [channel, two].map(|path| path.display().to_string());
    let more = format!(
        "{text_with}[[scenario]]\nfile = {two:?}\nevaluations = 800\n\
         [[model]]\nname = \"printed\"\nfile = {:?}\n\
         [[transfer]]\nname = \"u\"\nfrom = [\"channel\"]\nfile = {channel:?}\n\
         random = {{ worlds = 2, seed = 1, density = 0.02, radius = [0.3, 0.6], clearance = 1.5 }}\n",
        model().display().to_string()
    );
    std::fs::write(&with, more)?;
    assert_code(&campaign(&with, &folder)?, 0);
    assert!(folder.join("transfers.svg").exists() && folder.join("typical/channel-two-targets").exists());
    std::fs::write(folder.join("typical/notes.txt"), "mine")?;
    std::fs::write(folder.join("mine.csv"), "mine")?;

    std::fs::write(&with, text_with.split("[[transfer]]").next().unwrap_or_default())?;
    let fresh = scratch.path().join("fresh");
    assert_code(&campaign(&with, &fresh)?, 0);
    let output = campaign(&with, &folder)?;
    assert_code(&output, 0);
    let told = text(&output.stderr);
    assert!(told.contains("runs/channel-two-targets/m: of another state of the campaign"), "{told}");
    let others: Vec<PathBuf> =
        different(&fresh, &folder)?.into_iter().filter(|path| !path.starts_with("runs/channel-two-targets")).collect();
    assert_eq!(others, [PathBuf::from("mine.csv"), PathBuf::from("typical/notes.txt")]);
    Ok(())
}
