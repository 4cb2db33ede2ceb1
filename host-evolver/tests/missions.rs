//! `grn missions` and `grn survey`, from drawing worlds to judging models in them.

mod support;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use support::*;

fn missions(folder: &Path, more: &[&str]) -> Command {
    let mut command = grn();
    command.args(["missions", "--out"]).arg(folder).args(more);
    command
}

/// Small swarms, so that trials are short.
const SMALL: [&str; 6] = ["--targets", "1", "1", "--robots", "10", "11"];

fn survey(folder: &Path, more: &[&str]) -> Command {
    let mut command = grn();
    command.arg("survey").arg(folder).args(["--speed", "0.1", "--realities", "2"]).args(more);
    command
}

fn content(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let file = |entry: std::fs::DirEntry| {
        let bytes = std::fs::read(entry.path()).unwrap_or_default();
        (entry.file_name().to_string_lossy().into_owned(), bytes)
    };
    entries.map(file).collect()
}

#[test]
fn equal_seeds_give_equal_bytes_and_more_missions_add_to_them() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let [one, two] = ["one", "two"].map(|name| scratch.path().join(name));
    assert_code(&missions(&one, &["--count", "9", "--threads", "1"]).output()?, 0);
    assert_code(&missions(&two, &["--count", "7"]).output()?, 0);
    let first = content(&two);
    assert_eq!(first.len(), 8);
    for class in ["corridor", "door", "columns", "corner", "sliding-door", "sweeping-bar", "drifting-disc"] {
        assert!(first.keys().any(|name| name.ends_with(&format!("-{class}.toml"))), "{class}");
    }
    // More of them, after some were lost as in an interruption.
    std::fs::remove_file(two.join("0003-corner.toml"))?;
    std::fs::remove_file(two.join("missions.csv"))?;
    assert_code(&missions(&two, &["--count", "9"]).output()?, 0);
    assert_eq!(content(&two), content(&one));
    let table = text(&content(&one)["missions.csv"]);
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 10);
    let header = "file,class,seed,targets,robots,walls_block_radio,moving,clearance_m,circle_radius_m,circle_f2,star_f2,difficulty";
    assert_eq!(lines[0], header);
    for (line, number) in lines[1..].iter().zip(0..) {
        let cells: Vec<&str> = line.split(',').collect();
        assert!(line.starts_with(&format!("{number:04}-")) && cells.len() == 12, "{line}");
        let number = |place: usize| cells[place].parse::<f64>();
        let (circle, star, difficulty) = (number(9)?, number(10)?, number(11)?);
        assert!((circle - star - difficulty).abs() < 2e-6 && difficulty >= 0.0, "{line}");
        let robots = number(4)? / number(3)?;
        assert!((10.0..=20.0).contains(&robots) && (0.6..=1.2).contains(&number(7)?), "{line}");
    }
    Ok(())
}

#[test]
fn folders_with_other_missions_and_wrong_numbers_are_refused() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("missions");
    assert_code(&missions(&folder, &["--count", "3"]).output()?, 0);
    let before = content(&folder);
    let other = |more: &[&str]| missions(&folder, more).output();
    assert_refused(&other(&["--count", "2"])?, &["0002-columns.toml", "does not draw", "--out"]);
    assert_refused(&other(&["--count", "3", "--seed", "4"])?, &["0000-corridor.toml", "does not draw", "--out"]);
    assert_refused(&other(&["--count", "3", "--class", "door"])?, &["0000-corridor.toml", "does not draw"]);
    let new = scratch.path().join("new");
    for (more, words) in [
        (&["--count", "0"][..], &["--count", "1 to 10000"][..]),
        (&["--count", "10001"], &["--count", "1 to 10000"]),
        (&["--count", "1.5"], &["--count", "1.5"]),
        (&["--count", "-1"], &["--count", "-1", "1 to 10000"]),
        (&[], &["--count"]),
        (&["--count", "1", "--seed", "-1"], &["--seed", "-1"]),
        (&["--count", "1", "--class", "corridors"], &["corridors", "must be one of corridor, door"]),
        (&["--count", "1", "--targets", "0", "3"], &["--targets", "1 to 10"]),
        (&["--count", "1", "--targets", "3", "1"], &["--targets", "3 1", "the least comes first"]),
        (&["--count", "1", "--robots", "9", "20"], &["--robots", "10 to 200"]),
        (&["--count", "1", "--targets", "5", "6", "--robots", "10", "40"], &["--robots", "50 to 120"]),
        (&["--count", "1", "--clearance", "0.1", "1"], &["--clearance", "0.3 to 3"]),
        (&["--count", "1", "--clearance", "nan", "1"], &["--clearance", "nan", "0.3 to 3"]),
    ] {
        assert_refused(&missions(&new, more).output()?, words);
    }
    assert!(!new.exists());
    assert_eq!(content(&folder), before);
    Ok(())
}

#[test]
fn a_simulation_takes_the_swarm_that_its_mission_is_for() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("missions");
    assert_code(&missions(&folder, &["--count", "1", "--targets", "2", "2", "--robots", "23", "23"]).output()?, 0);
    let world = folder.join("0000-corridor.toml");
    let simulate = |more: &[&str]| {
        let mut command = grn();
        command.arg("simulate").arg(model()).arg(&world).args(["--speed", "0.1", "--json"]).args(more);
        command.output()
    };
    let found = simulate(&["--lab", "hostile"])?;
    assert_answered(&found);
    let json: serde_json::Value = serde_json::from_slice(&found.stdout)?;
    let lab = &json["swarm"]["lab"];
    assert_eq!((&lab["robots"]["count"], &lab["robots"]["mothers"]), (&23.into(), &4.into()), "{lab}");
    let blocked = std::fs::read_to_string(&world)?.contains("walls_block_radio = true");
    assert_eq!(lab["radio"]["walls_block"], blocked);
    assert_eq!(lab["name"], "hostile");
    let fewer: serde_json::Value = serde_json::from_slice(&simulate(&["--robots", "12"])?.stdout)?;
    assert_eq!(fewer["swarm"]["lab"]["robots"]["count"], 12);
    let words = ["--set robots.count=12", "0000-corridor.toml", "[swarm]", "leave --set out"];
    assert_refused(&simulate(&["--set", "robots.count=12"])?, &words);
    Ok(())
}

#[test]
fn a_survey_is_the_same_for_all_threads_and_goes_on_where_it_was_stopped() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("missions");
    assert_code(&missions(&folder, &[&["--count", "3"][..], &SMALL].concat()).output()?, 0);
    let [one, two] = ["one.csv", "two.csv"].map(|name| scratch.path().join(name).display().to_string());
    let blob = model().display().to_string();
    let first = survey(&folder, &[&blob, "--circle", "--threads", "1", "--out", &one]).output()?;
    assert_code(&first, 0);
    let told = text(&first.stdout);
    for word in
        ["all ", "corridor ", "door ", "columns ", "easy ", "hard ", "circle ", "2 models in 3 missions in 2 realities"]
    {
        assert!(told.contains(word), "{word:?} is not in\n{told}");
    }
    let whole = std::fs::read_to_string(&one)?;
    assert_eq!(whole.lines().count(), 7);

    // Stopped after two trials, and begun with one model only.
    let part: Vec<&str> = whole.lines().take(3).collect();
    std::fs::write(&two, part.join("\n") + "\n")?;
    let rest = survey(&folder, &[&blob, "--circle", "--out", &two, "--json"]).output()?;
    assert_code(&rest, 0);
    assert_eq!(std::fs::read_to_string(&two)?, whole);
    let json: serde_json::Value = serde_json::from_slice(&rest.stdout)?;
    let ticks = |key: &str| json[key].as_u64().unwrap_or_default();
    assert!(0 < ticks("robot_ticks_now") && ticks("robot_ticks_now") < ticks("robot_ticks"), "{json}");
    assert_eq!(json["groups"][0]["name"], "all");
    assert_eq!(json["groups"][0]["missions"], 3);

    let other = survey(&folder, &[&blob, "--circle", "--seed", "2", "--out", &two]).output()?;
    assert_refused(&other, &["two.csv", "has 6 lines of other trials", "--out"]);
    assert_eq!(std::fs::read_to_string(&two)?, whole);
    Ok(())
}

#[test]
fn a_survey_refuses_what_it_cannot_try() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("missions");
    assert_code(&missions(&folder, &[&["--count", "2"][..], &SMALL].concat()).output()?, 0);
    let blob = model().display().to_string();
    let notes = scratch.path().join("notes.csv");
    std::fs::write(&notes, "a,b\n1,2\n")?;
    let notes = notes.display().to_string();
    assert_refused(&survey(&folder, &[]).output()?, &["BLOB"]);
    assert_refused(&survey(&folder, &[&blob, &blob]).output()?, &["given twice"]);
    assert_refused(&survey(scratch.path(), &[&blob]).output()?, &["missions.csv", "grn missions"]);
    assert_refused(&survey(&folder, &["missing.grn"]).output()?, &["missing.grn"]);
    assert_refused(&survey(&folder, &[&blob, "--realities", "0"]).output()?, &["--realities"]);
    assert_refused(
        &survey(&folder, &[&blob, "--set", "robots.count=3"]).output()?,
        &["--set robots.count=3", "[swarm]"],
    );
    assert_refused(&survey(&folder, &[&blob, "--scale", "0.01"]).output()?, &["0000-corridor.toml"]);
    assert_refused(&survey(&folder, &[&blob, "--out", &notes]).output()?, &["notes.csv", "no table of a survey"]);
    assert_eq!(std::fs::read_to_string(&notes)?, "a,b\n1,2\n");
    std::fs::remove_file(folder.join("0001-door.toml"))?;
    assert_refused(&survey(&folder, &[&blob]).output()?, &["0001-door.toml"]);
    Ok(())
}

#[cfg(unix)]
#[test]
fn an_interrupted_survey_keeps_what_is_done() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("missions");
    // More than can be done before the interruption.
    assert_code(&missions(&folder, &[&["--count", "60"][..], &SMALL].concat()).output()?, 0);
    let out = scratch.path().join("survey.csv");
    let blob = model().display().to_string();
    let mut command = grn();
    command
        .arg("survey")
        .arg(&folder)
        .args([&blob, "--circle", "--realities", "20", "--threads", "1", "--out"])
        .arg(&out);
    let mut child = command.spawn()?;
    // The first trial is kept at once.
    while !out.exists() {
        assert!(child.try_wait()?.is_none(), "it ended without a trial");
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status()?;
    assert!(killed.success());
    let stopped = child.wait_with_output()?;
    assert_code(&stopped, 130);
    assert!(text(&stopped.stderr).contains("of 120 trials; the same command goes on"), "{}", text(&stopped.stderr));
    assert!(std::fs::read_to_string(&out)?.lines().count() > 1, "a header and at least one trial");
    Ok(())
}
