//! Campaigns that evolve for several worlds and test in others, which no search has seen.

mod support;

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use support::desk::{Desk, WORLD, edited};
use support::{Outcome, text};

const PLAN: &str = r#"name = "generalise"
seeds = 2
[[scenario]]
name = "both"
files = ["world.toml", "wide.toml"]
evaluations = 800
[[scenario]]
file = "wide.toml"
evaluations = 800
[[method]]
name = "m"
algorithm = "mogp"
motifs = "all"
[[method]]
name = "e"
algorithm = "eh-grn"
structure = 2
baseline = true
[[transfer]]
name = "unseen"
from = ["both", "wide"]
files = ["free.toml", "shifted.toml"]
[simulate]
realities = 2
speed_m_per_s = 0.12
"#;

/// A desk with three more worlds: one with a wider channel, one without walls, and one whose channel is not where the others have it.
fn desk() -> std::io::Result<Desk> {
    let desk = Desk::new()?;
    let world = |name: &str, low: &str, high: &str| {
        let text = edited(WORLD, "name = \"world\"", &format!("name = {name:?}"));
        let text = edited(&text, "[6.0, 14.0], [14.0, 14.0]", &format!("[6.0, {high}], [14.0, {high}]"));
        edited(&text, "[14.0, 6.0], [6.0, 6.0]", &format!("[14.0, {low}], [6.0, {low}]"))
    };
    std::fs::write(desk.path("wide.toml"), world("wide", "5.0", "15.0"))?;
    std::fs::write(desk.path("shifted.toml"), world("shifted", "5.6", "13.4"))?;
    let walls = WORLD.find("[[wall]]").unwrap_or(WORLD.len());
    std::fs::write(desk.path("free.toml"), edited(&WORLD[..walls], "name = \"world\"", "name = \"free\""))?;
    Ok(desk)
}

fn campaign(desk: &Desk, plan: &str, out: &Path, more: &[&str]) -> std::io::Result<Output> {
    std::fs::write(desk.path("campaign.toml"), plan)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_grn"));
    command.arg("campaign").arg(desk.path("campaign.toml")).arg("--out").arg(out).args(more).output()
}

/// A line of a table: its cells with the names of their columns.
type Row = Vec<(String, String)>;

/// The lines of a table.
fn table(path: PathBuf) -> Result<Vec<Row>, Box<dyn std::error::Error>> {
    let all = std::fs::read_to_string(path)?;
    let all = all.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n");
    let mut csv = csv::Reader::from_reader(all.as_bytes());
    let header = csv.headers()?.clone();
    let named =
        |record: csv::StringRecord| header.iter().zip(record.iter()).map(|(a, b)| (a.into(), b.into())).collect();
    csv.records().map(|record| Ok(named(record?))).collect()
}

fn cell<'t>(row: &'t [(String, String)], column: &str) -> &'t str {
    row.iter().find(|(name, _)| name == column).map_or("no such column", |(_, value)| value)
}

fn number(row: &[(String, String)], column: &str) -> f64 {
    cell(row, column).parse().unwrap_or(f64::NAN)
}

#[test]
fn models_are_evolved_for_all_training_worlds_and_tried_in_those_that_no_search_has_seen() -> Outcome {
    let desk = desk()?;
    let out = desk.path("out");
    let output = campaign(&desk, PLAN, &out, &["--threads", "2"])?;
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));

    // Who was evolved for what.
    let manifest: Value = serde_json::from_slice(&std::fs::read(out.join("runs/both/m/001/manifest.json"))?)?;
    assert_eq!(manifest["worlds"], serde_json::json!(["world", "wide"]));
    let manifest: Value = serde_json::from_slice(&std::fs::read(out.join("runs/wide/m/001/manifest.json"))?)?;
    assert_eq!(manifest["worlds"], Value::Null, "a single world is the scenario itself");

    // What a run is worth is the mean over its training worlds.
    let runs = table(out.join("results.csv"))?;
    assert_eq!(runs.len(), 8);
    let mut trials = Vec::new();
    for entry in std::fs::read_dir(out.join("trials/both"))? {
        trials.push(table(entry?.path())?);
    }
    assert_eq!(trials.len(), 2, "one table for each training world");
    for run in runs.iter().filter(|run| cell(run, "scenario") == "both") {
        let of_run =
            |row: &&Row| ["scenario", "method", "seed"].iter().all(|column| cell(row, column) == cell(run, column));
        let f2: Vec<f64> = trials.iter().flatten().filter(of_run).map(|row| number(row, "f2")).collect();
        assert_eq!(f2.len(), 2, "{run:?}");
        assert!(f2[0] != f2[1], "{f2:?}");
        assert!((number(run, "knee_f2") - (f2[0] + f2[1]) / 2.0).abs() < 1e-9, "{f2:?} {run:?}");
    }

    // Every knee is simulated in its training worlds and in the test worlds.
    let simulations = table(out.join("simulations.csv"))?;
    let worlds = |scenario: &str| -> Vec<(String, String)> {
        let of = simulations.iter().filter(|row| cell(row, "scenario") == scenario && cell(row, "method") == "m");
        let of = of.filter(|row| cell(row, "seed") == "1");
        of.map(|row| (cell(row, "transfer").into(), cell(row, "world").into())).collect()
    };
    let named = |all: &[(&str, &str)]| all.iter().map(|&(a, b)| (a.into(), b.into())).collect::<Vec<_>>();
    let tests = [("unseen", "free"), ("unseen", "shifted")];
    assert_eq!(worlds("both"), named(&[&[("", "world"), ("", "wide")][..], &tests].concat()));
    assert_eq!(worlds("wide"), named(&[&[("", "wide")][..], &tests].concat()));

    // Mean and worst, from the lines of the worlds.
    let summaries = table(out.join("simulation-summary.csv"))?;
    let mut several = 0;
    for summary in &summaries {
        let here = |row: &&Row| {
            let same =
                ["scenario", "method", "transfer"].iter().all(|column| cell(row, column) == cell(summary, column));
            same && ["", cell(row, "world")].contains(&cell(summary, "world"))
        };
        let rows: Vec<_> = simulations.iter().filter(here).collect();
        let seeds = ["1", "2"].map(|seed| rows.iter().filter(|row| cell(row, "seed") == seed).collect::<Vec<_>>());
        assert_eq!(rows.len() as f64, number(summary, "runs") * number(summary, "worlds"), "{summary:?}");
        let mean = |column: &str| rows.iter().map(|row| number(row, column)).sum::<f64>() / rows.len() as f64;
        let worst = |column: &str, worse: fn(f64, f64) -> f64| {
            let of_knee = |seed: &Vec<_>| seed.iter().map(|row: &&&Vec<_>| number(row, column)).reduce(worse);
            seeds.iter().filter_map(of_knee).sum::<f64>() / 2.0
        };
        for (column, value) in [
            ("caged", mean("caged")),
            ("cost", mean("cost")),
            ("worst_caged", worst("caged", f64::min)),
            ("worst_cost", worst("cost", f64::max)),
        ] {
            assert!((number(summary, column) - value).abs() < 1e-9, "{column}: {value} {summary:?}");
        }
        several += usize::from(number(summary, "worlds") > 1.0);
    }
    assert_eq!((summaries.len(), several), (2 * (3 + 3) + 2 * (1 + 3), 6), "all worlds of a group, then each");
    let both = summaries.iter().find(|row| cell(row, "worlds") == "2").ok_or("no line of both training worlds")?;
    let cost_of_runs: Vec<_> =
        runs.iter().filter(|run| cell(run, "scenario") == "both" && cell(run, "method") == "m").collect();
    let mean = |column: &str| cost_of_runs.iter().map(|run| number(run, column)).sum::<f64>() / 2.0;
    assert!((mean("cost") - number(both, "cost")).abs() < 1e-9);
    assert!((mean("worst_cost") - number(both, "worst_cost")).abs() < 1e-9);

    // The patterns in the test worlds, together and in each.
    let transfers = table(out.join("transfers.csv"))?;
    let unseen: Vec<_> = transfers.iter().filter(|row| cell(row, "transfer") == "unseen").collect();
    let called = |world: &str| unseen.iter().filter(|row| cell(row, "world") == world).count();
    assert_eq!(["", "free", "shifted"].map(called), [4; 3]);
    assert!(text(&output.stdout).contains("all its worlds"), "{}", text(&output.stdout));
    assert!(out.join("typical/both/m/pattern-2.svg").exists() && out.join("typical/wide/m/pattern.svg").exists());
    let figure = std::fs::read_to_string(out.join("simulations.svg"))?;
    assert!(figure.contains("unseen") && figure.contains("both"));

    // In parts, and merged, the same.
    let parts = [desk.path("first"), desk.path("second")];
    for (part, shard) in parts.iter().zip(["1/2", "2/2"]) {
        assert_eq!(campaign(&desk, PLAN, part, &["--shard", shard])?.status.code(), Some(0));
    }
    let merged = campaign(&desk, PLAN, &parts[1], &["--merge", &parts[0].display().to_string()])?;
    assert_eq!(merged.status.code(), Some(0), "{}", text(&merged.stderr));
    assert!(support::content(&parts[1])? == support::content(&out)?, "in parts the result is another");
    Ok(())
}

#[test]
fn variations_change_all_worlds_of_a_scenario_at_once() -> Outcome {
    let desk = desk()?;
    let plan = edited(PLAN, "[simulate]\nrealities = 2\nspeed_m_per_s = 0.12\n", "[vary]\nlevel = [0.9]\n");
    let out = desk.path("out");
    let output = campaign(&desk, &edited(&plan, "seeds = 2", "seeds = 1"), &out, &[])?;
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let runs = table(out.join("results.csv"))?;
    let scenarios: Vec<_> = runs.iter().map(|run| cell(run, "scenario")).collect();
    let expected = ["both", "both", "both, level x 0.9", "both, level x 0.9", "wide", "wide"];
    assert_eq!(scenarios[..6], expected);
    let manifest: Value =
        serde_json::from_slice(&std::fs::read(out.join("runs/both-level-x-0-9/m/001/manifest.json"))?)?;
    assert_eq!(manifest["worlds"], serde_json::json!(["world, level x 0.9", "wide, level x 0.9"]));
    Ok(())
}

#[test]
fn worlds_that_do_not_go_together_are_refused_at_their_line() -> Outcome {
    let desk = desk()?;
    let other = edited(&edited(WORLD, "level = 0.5", "level = 0.4"), "name = \"world\"", "name = \"other\"");
    std::fs::write(desk.path("other.toml"), other)?;
    let training = "files = [\"world.toml\", \"wide.toml\"]";
    let tests = "files = [\"free.toml\", \"shifted.toml\"]";
    let random = "\nrandom = { worlds = 3, seed = 1, density = 0.03, radius = [0.3, 0.6], clearance = 1.5 }";
    let several_random = format!("{tests}{random}");
    for (from, to, words) in [
        (training, "files = [\"world.toml\"]\nfile = \"wide.toml\"", &["scenario[0].files", "stands beside file"][..]),
        (training, "", &["scenario[0].file", "is missing", "several with files"]),
        (training, "files = []", &["scenario[0].files = []", "at least one"]),
        (training, "files = [\"world.toml\", \"wide.toml\", \"world.toml\"]", &["files[2]", "\"world\"", "another"]),
        (
            training,
            "files = [\"world.toml\", \"other.toml\"]",
            &["files[1] = \"other.toml\"", "[morphogen]", "world.toml"],
        ),
        (training, "files = [\"world.toml\", \"nothing.toml\"]", &["files[1] = \"nothing.toml\"", "cannot be read"]),
        ("name = \"both\"\n", "", &["scenario[0].name", "is missing", "several files"]),
        ("name = \"both\"", "name = \"Wide\"", &["scenario[1].file", "wide", "Wide"]),
        (tests, "files = []", &["transfer[0].files = []", "at least one"]),
        (
            tests,
            "files = [\"free.toml\", \"wide.toml\"]",
            &["transfer[0].files[1] = \"wide.toml\"", "\"both\" trains for"],
        ),
        (tests, &several_random, &["transfer[0].files", "one world"]),
        ("\"both\", \"wide\"]", "\"world\"]", &["transfer[0].from[0] = \"world\"", "both, wide"]),
    ] {
        let output = campaign(&desk, &edited(PLAN, from, to), &desk.path("out"), &[])?;
        let message = text(&output.stderr);
        let first = message.lines().next().unwrap_or_default();
        assert_eq!(output.status.code(), Some(2), "{to}: {message}");
        assert!(first.contains("campaign.toml:"), "{to}: {first}");
        let missing: Vec<_> = words.iter().filter(|word| !first.contains(**word)).collect();
        assert!(missing.is_empty(), "{to}: {missing:?} is not in {first}");
        assert!(!desk.path("out").exists(), "{to}: a folder was made");
    }
    Ok(())
}
