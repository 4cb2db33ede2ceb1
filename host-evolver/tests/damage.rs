//! Files of finished work that were cut, changed, mixed or lost since: refused or made anew, never taken as they are.

mod support;

use std::path::{Path, PathBuf};
use support::*;

fn flip(path: &Path, bit: usize) -> std::io::Result<()> {
    let mut bytes = std::fs::read(path)?;
    let place = bit / 8 % bytes.len();
    bytes[place] ^= 1 << (bit % 8);
    std::fs::write(path, bytes)
}

fn cut(path: &Path, length: usize) -> std::io::Result<()> {
    let bytes = std::fs::read(path)?;
    std::fs::write(path, &bytes[..length.min(bytes.len())])
}

#[test]
fn a_damaged_checkpoint_is_refused_by_name() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    assert_answered(&evolve(&folder, 2, &[]).output()?);
    let path = folder.join("checkpoint.json");
    let whole = std::fs::read_to_string(&path)?;
    let refused = |content: &str, words: &[&str]| -> Outcome {
        assert_ne!(content, whole);
        std::fs::write(&path, content)?;
        assert_refused(&evolve(&folder, 2, &["--resume"]).output()?, &[&["checkpoint.json", "--out"], words].concat());
        Ok(())
    };
    // Beyond its budget it would search without end.
    refused(&whole.replacen("\"evaluations\": 1600", "\"evaluations\": 1000000000", 1), &["1000000000", "1600"])?;
    refused(&whole.replacen("\"generation\": 2", "\"generation\": 1", 1), &["whole generations"])?;
    refused(&whole.replacen("\"f2\": 0", "\"f2\": 1", 1), &["SHA-256"])?;
    refused(&whole.replacen("\"violation\": 0.0", "\"violation\": -1.0", 1), &["violation"])?;
    refused(&whole[..whole.len() / 2], &["damaged"])?;
    refused("", &["damaged"])?;
    std::fs::write(&path, &whole)?;
    assert_answered(&evolve(&folder, 2, &["--resume"]).output()?);
    Ok(())
}

#[test]
fn a_checkpoint_of_another_run_is_refused() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let (ours, other) = (scratch.path().join("ours"), scratch.path().join("other"));
    assert_answered(&evolve(&ours, 1, &[]).output()?);
    assert_answered(&evolve(&other, 1, &["--seed", "2"]).output()?);
    std::fs::copy(other.join("checkpoint.json"), ours.join("checkpoint.json"))?;
    assert_refused(&evolve(&ours, 1, &["--resume"]).output()?, &["checkpoint.json", "of another run"]);
    Ok(())
}

#[test]
fn damaged_results_of_a_run_are_made_anew_and_told() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let (whole, folder) = (scratch.path().join("whole"), scratch.path().join("run"));
    assert_answered(&evolve(&whole, 1, &[]).output()?);
    assert_answered(&evolve(&folder, 1, &[]).output()?);
    let names: Vec<PathBuf> = content(&folder)?.into_iter().map(|(path, _)| path).collect();
    let names = names.iter().filter(|name| !["manifest.json", "checkpoint.json"].iter().any(|own| name.ends_with(own)));
    for (number, name) in names.enumerate() {
        match number % 3 {
            0 => flip(&folder.join(name), 997 * number)?,
            1 => cut(&folder.join(name), 7 * number)?,
            _ => std::fs::remove_file(folder.join(name))?,
        }
    }
    let output = evolve(&folder, 1, &["--resume"]).output()?;
    assert_answered(&output);
    assert!(text(&output.stderr).contains("front.csv is missing or was changed"), "{}", text(&output.stderr));
    assert_eq!(different(&whole, &folder)?, Vec::<PathBuf>::new());
    Ok(())
}

fn campaign(plan: &Path, folder: &Path) -> std::process::Command {
    let mut command = grn();
    command.arg("campaign").arg(plan).arg("--out").arg(folder);
    command
}

fn plan(folder: &Path) -> std::io::Result<PathBuf> {
    let plan = folder.join("campaign.toml");
    let [channel, model] = [channel(), model()].map(|path| path.display().to_string());
    let open = repository("scenarios/open.toml").display().to_string();
    std::fs::write(
        &plan,
        format!(
            "name = \"c\"\nseeds = 2\n[[scenario]]\nfile = {channel:?}\nevaluations = 800\n\
             [[method]]\nname = \"m\"\nalgorithm = \"mogp\"\nmotifs = \"all\"\n\
             [[model]]\nname = \"printed\"\nfile = {model:?}\n\
             [[transfer]]\nname = \"t\"\nfrom = [\"channel\"]\nfile = {open:?}\n\
             random = {{ worlds = 3, seed = 1, density = 0.03, radius = [0.3, 0.6], clearance = 1.5 }}\n"
        ),
    )?;
    Ok(plan)
}

fn files_below(folder: &Path, part: &str) -> std::io::Result<Vec<PathBuf>> {
    Ok(content(&folder.join(part))?.into_iter().map(|(path, _)| folder.join(part).join(path)).collect())
}

#[test]
fn cut_trials_and_cut_fronts_change_no_table() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = plan(scratch.path())?;
    let (whole, folder) = (scratch.path().join("whole"), scratch.path().join("out"));
    assert_code(&campaign(&plan, &whole).output()?, 0);
    assert_code(&campaign(&plan, &folder).output()?, 0);
    let again = |words: &[&str]| -> Outcome {
        let output = campaign(&plan, &folder).output()?;
        assert_code(&output, 0);
        for word in words {
            assert!(text(&output.stderr).contains(word), "{word}: {}", text(&output.stderr));
        }
        assert_eq!(different(&whole, &folder)?, Vec::<PathBuf>::new(), "{words:?}");
        Ok(())
    };
    let trials = files_below(&folder, "trials/t")?;
    assert_eq!(trials.len(), 3);
    let header = std::fs::read_to_string(&trials[0])?.lines().next().unwrap_or_default().to_owned() + "\n";
    std::fs::write(&trials[0], &header)?;
    again(&["trials/t/000-", "made anew"])?;
    // A line less, and the files of two worlds in each other's place.
    let lines = std::fs::read_to_string(&trials[1])?;
    let fewer: Vec<&str> = lines.lines().enumerate().filter(|(line, _)| *line != 2).map(|(_, line)| line).collect();
    std::fs::write(&trials[1], fewer.join("\n") + "\n")?;
    again(&["trials/t/001-", "made anew"])?;
    let first = std::fs::read(&trials[0])?;
    std::fs::copy(&trials[1], &trials[0])?;
    std::fs::write(&trials[1], first)?;
    again(&["trials/t/000-", "trials/t/001-"])?;
    for bit in [3, 500, 900] {
        flip(&trials[2], bit)?;
        again(&["trials/t/002-"])?;
    }

    let run = folder.join("runs/channel/m/001");
    for name in ["front.csv", "history.csv", "knee.grn"] {
        let length = std::fs::metadata(run.join(name))?.len() as usize;
        cut(&run.join(name), length / 2)?;
        again(&[name, "done again"])?;
        flip(&run.join(name), 333)?;
        again(&[name, "done again"])?;
        std::fs::remove_file(run.join(name))?;
        again(&[name, "done again"])?;
    }
    // Files of one run in another's folder.
    std::fs::copy(folder.join("runs/channel/m/002/front.csv"), run.join("front.csv"))?;
    again(&["front.csv", "done again"])?;
    cut(&run.join("manifest.json"), 100)?;
    again(&["manifest.json", "done again"])?;
    Ok(())
}

#[test]
fn a_run_without_its_manifest_is_done_again_once_and_foreign_files_in_it_stay() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = plan(scratch.path())?;
    let (whole, folder) = (scratch.path().join("whole"), scratch.path().join("out"));
    assert_code(&campaign(&plan, &whole).output()?, 0);
    assert_code(&campaign(&plan, &folder).output()?, 0);
    let run = folder.join("runs/channel/m/001");
    std::fs::remove_file(run.join("manifest.json"))?;
    std::fs::write(run.join("notes.txt"), "mine")?;
    let output = campaign(&plan, &folder).output()?;
    assert_code(&output, 0);
    assert!(text(&output.stderr).contains("manifest.json is missing"), "{}", text(&output.stderr));
    assert_eq!(different(&whole, &folder)?, [PathBuf::from("runs/channel/m/001/notes.txt")]);
    let output = campaign(&plan, &folder).output()?;
    assert_code(&output, 0);
    assert!(!text(&output.stderr).contains("done again"));
    Ok(())
}

#[test]
fn a_damaged_manifest_of_a_campaign_is_refused_and_its_runs_are_taken_over() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = plan(scratch.path())?;
    let (folder, other) = (scratch.path().join("out"), scratch.path().join("other"));
    assert_code(&campaign(&plan, &folder).output()?, 0);
    let whole = std::fs::read(folder.join("manifest.json"))?;
    cut(&folder.join("manifest.json"), 50)?;
    assert_refused(&campaign(&plan, &folder).output()?, &["manifest.json: damaged", "--out", "--merge"]);
    let output = campaign(&plan, &other).arg("--merge").arg(&folder).output()?;
    assert_code(&output, 0);
    assert!(text(&output.stderr).contains("2 runs taken over"), "{}", text(&output.stderr));
    std::fs::write(folder.join("manifest.json"), whole)?;
    assert_eq!(different(&folder, &other)?, Vec::<PathBuf>::new());
    Ok(())
}

#[test]
fn whole_runs_in_each_others_place_are_refused() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = plan(scratch.path())?;
    let folder = scratch.path().join("out");
    assert_code(&campaign(&plan, &folder).output()?, 0);
    let runs = folder.join("runs/channel/m");
    std::fs::rename(runs.join("001"), runs.join("x"))?;
    std::fs::rename(runs.join("002"), runs.join("001"))?;
    std::fs::rename(runs.join("x"), runs.join("002"))?;
    assert_refused(&campaign(&plan, &folder).output()?, &["manifest.json", "seed is", "--out"]);
    Ok(())
}

#[test]
fn a_damaged_run_is_not_merged() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = plan(scratch.path())?;
    let (there, here) = (scratch.path().join("there"), scratch.path().join("here"));
    assert_code(&campaign(&plan, &there).output()?, 0);
    let front = there.join("runs/channel/m/001/front.csv");
    let whole = std::fs::read(&front)?;
    cut(&front, whole.len() / 2)?;
    let output = campaign(&plan, &here).arg("--merge").arg(&there).output()?;
    assert_code(&output, 0);
    let told = text(&output.stderr);
    assert!(told.contains("front.csv") && told.contains("not taken over") && told.contains("1 runs"), "{told}");
    std::fs::write(&front, whole)?;
    assert_eq!(different(&there, &here)?, Vec::<PathBuf>::new());
    Ok(())
}
