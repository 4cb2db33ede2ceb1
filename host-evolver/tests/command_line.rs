//! The command `grn` as scripts use it: files, exit codes, messages, interruption.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn grn() -> Command {
    Command::new(env!("CARGO_BIN_EXE_grn"))
}

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn channel() -> PathBuf {
    repository("scenarios/channel.toml")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn assert_refused(output: &Output, words: &[&str]) {
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    for word in words {
        assert!(message.contains(word), "{word:?} is not in {message:?}");
    }
}

fn evolve(folder: &Path, more: &[&str]) -> Command {
    let mut command = grn();
    command.arg("evolve").arg(channel()).arg("--paper").arg("--out").arg(folder).args(more);
    command.stderr(Stdio::piped()).stdout(Stdio::piped());
    command
}

/// The files that must not depend on threads or interruptions.
fn results(folder: &Path) -> std::io::Result<Vec<Vec<u8>>> {
    let mut blobs: Vec<PathBuf> = std::fs::read_dir(folder.join("front"))?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    blobs.sort();
    let named =
        ["manifest.json", "front.csv", "history.csv", "knee.grn", "pareto.svg", "tree.svg", "grn.svg", "pattern.svg"];
    named.iter().map(|name| folder.join(name)).chain(blobs).map(std::fs::read).collect()
}

#[test]
fn evolve_leaves_the_same_folder_for_any_threads_and_after_any_kill() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let alone = scratch.path().join("alone");
    let output = evolve(&alone, &["--seed", "5", "--threads", "1"]).output()?;
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("works"));
    let expected = results(&alone)?;
    let header = std::fs::read_to_string(alone.join("front.csv"))?;
    assert!(header.starts_with("nodes,f2,violation,knee,expression,blob\n"));
    for threads in ["2", "4"] {
        let folder = scratch.path().join(threads);
        assert_eq!(evolve(&folder, &["--seed", "5", "--threads", threads]).output()?.status.code(), Some(0));
        assert!(results(&folder)? == expected, "{threads} threads change the result");
    }
    for attempt in 0..6 {
        let folder = scratch.path().join(format!("killed-{attempt}"));
        for kill in 0..4 {
            let begun = folder.join("manifest.json").exists();
            let resume: &[&str] = if begun { &["--seed", "5", "--resume"] } else { &["--seed", "5"] };
            let mut child = evolve(&folder, resume).spawn()?;
            std::thread::sleep(Duration::from_millis(40 + (attempt * 97 + kill * 211) % 700));
            child.kill()?;
            child.wait()?;
        }
        // What a kill in the midst of writing a blob leaves.
        std::fs::create_dir_all(folder.join("front"))?;
        std::fs::write(folder.join("front/.unfinished-blob"), "GRN")?;
        let output = evolve(&folder, &["--seed", "5", "--resume"]).output()?;
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(results(&folder)? == expected, "killed and resumed, the result is another");
    }
    Ok(())
}

#[test]
fn a_run_is_not_overwritten_nor_mixed() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    let few = ["--evaluations", "800", "--motifs", "binary"];
    let code = evolve(&folder, &few).output()?.status.code();
    assert!(code == Some(0) || code == Some(1), "{code:?}");
    let before = results(&folder)?;
    assert_refused(&evolve(&folder, &few).output()?, &["manifest.json", "--resume", "--out"]);
    assert_refused(&evolve(&folder, &["--resume", "--seed", "2"]).output()?, &["settings", "--out"]);
    assert!(results(&folder)? == before);
    let front = std::fs::read_to_string(folder.join("front.csv"))?;
    for line in front.lines().skip(1) {
        let nodes: usize = line.split(',').next().unwrap_or_default().parse()?;
        assert!(nodes % 2 == 1 && nodes >= 3, "binary motifs give odd trees, not {line}");
    }
    Ok(())
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_was_done_and_says_how_to_go_on() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    let child = evolve(&folder, &["--evaluations", "400000"]).spawn()?;
    while !folder.join("checkpoint.json").exists() {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status()?.success());
    let output = child.wait_with_output()?;
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.contains("--resume --out"), "{message}");
    assert!(!folder.join("front.csv").exists());
    Ok(())
}

#[test]
fn eval_prints_the_steady_state_in_every_number_type() -> Outcome {
    let golden: serde_json::Value = serde_json::from_str(include_str!("../../tests/golden/published-models.json"))?;
    for (number, tolerance) in [("f64", 1e-6), ("f32", 2e-6), ("q8.24", 2e-6)] {
        for name in ["nand-xnor", "andn-xnor", "andn-nand-xnor", "eh-grn-1", "eh-grn-2"] {
            let blob = repository(&format!("models/{name}.grn"));
            let mut child = grn()
                .arg("eval")
                .arg(blob)
                .args(["--number", number])
                .stdin(Stdio::piped())
                .stdout(Stdio::piped())
                .spawn()?;
            child.stdin.take().ok_or("no standard input")?.write_all(b"0,0\n1,0\n")?;
            let output = child.wait_with_output()?;
            let values: Result<Vec<f64>, _> = text(&output.stdout).lines().map(str::parse).collect();
            let model = &golden["models"][name];
            let expected = [&model["M00"], &model["M10"]].map(|value| value.as_f64().unwrap_or(f64::NAN));
            for (got, expected) in values?.into_iter().zip(expected) {
                assert!((got - expected).abs() < tolerance, "{name} in {number}: {got} against {expected}");
            }
        }
    }
    Ok(())
}

#[test]
fn show_and_draw_speak_json() -> Outcome {
    let blob = repository("models/nand-xnor.grn");
    let shown = grn().arg("show").arg(&blob).arg("--json").output()?;
    let shown: serde_json::Value = serde_json::from_slice(&shown.stdout)?;
    assert_eq!((shown["genes"].as_u64(), shown["nodes"].as_u64()), (Some(2), Some(5)));
    assert!((shown["ring_radius_m"].as_f64().ok_or("no radius")? - 1.2216).abs() < 0.01);
    let scratch = tempfile::tempdir()?;
    let picture = scratch.path().join("pattern.svg");
    let mut draw = grn();
    draw.arg("draw")
        .arg(&blob)
        .arg(repository("scenarios/compound-channel.toml"))
        .arg("--json")
        .arg("--out")
        .arg(&picture);
    let drawn = draw.output()?;
    assert_eq!(drawn.status.code(), Some(0));
    let drawn: serde_json::Value = serde_json::from_slice(&drawn.stdout)?;
    let snapshots = drawn["snapshots"].as_array().ok_or("no snapshots")?;
    assert_eq!(snapshots.len(), 25);
    assert_eq!(snapshots[5]["enclosed"], serde_json::json!([false]));
    assert!(snapshots[5]["radius_min"].is_null() && snapshots[5]["clearance_min"].is_null());
    assert!(std::fs::read_to_string(picture)?.contains("<svg"));
    Ok(())
}

#[test]
fn simulate_answers_with_its_exit_code() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let run = |model: &str, more: &[&str]| {
        grn().arg("simulate").arg(repository(&format!("models/{model}.grn"))).arg(channel()).args(more).output()
    };
    let folder = scratch.path().join("simulation");
    let good = run("nand-xnor", &["--json", "--out", &folder.to_string_lossy(), "--number", "q8.24"])?;
    assert_eq!(good.status.code(), Some(0), "{}", text(&good.stderr));
    let good: serde_json::Value = serde_json::from_slice(&good.stdout)?;
    assert_eq!(good["works"], true);
    for name in ["trace.svg", "trace.csv", "trace.bin", "metrics.json"] {
        assert!(folder.join(name).exists(), "{name}");
    }
    // Three robots cannot close gaps of 90 degrees.
    assert_eq!(run("nand-xnor", &["--robots", "3"])?.status.code(), Some(1));
    Ok(())
}

#[test]
fn bad_input_is_refused_by_name() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let bad_blob = scratch.path().join("bad.grn");
    std::fs::write(&bad_blob, b"GRNb\x09 something of the future")?;
    assert_refused(&grn().arg("show").arg(&bad_blob).output()?, &["bad.grn", "format version 9", "update"]);
    assert_refused(&grn().arg("show").arg("no-such.grn").output()?, &["no-such.grn", "cannot be read"]);
    let world = scratch.path().join("world.toml");
    std::fs::write(&world, std::fs::read_to_string(channel())?.replace("snapshots", "snap_shots"))?;
    assert_refused(&grn().arg("evolve").arg(&world).output()?, &["world.toml", "snap_shots"]);
    let blob = repository("models/nand-xnor.grn");
    assert_refused(
        &grn().arg("simulate").arg(&blob).arg(channel()).args(["--robots", "0"]).output()?,
        &["robots", "0"],
    );
    assert_refused(&grn().arg("simulate").arg(&blob).arg(channel()).args(["--scale", "0"]).output()?, &["scale", "0"]);
    assert_refused(&grn().arg("evolve").arg(channel()).args(["--evaluations", "7"]).output()?, &["evaluations", "7"]);
    let mut eval =
        grn().arg("eval").arg(&blob).stdin(Stdio::piped()).stderr(Stdio::piped()).stdout(Stdio::null()).spawn()?;
    eval.stdin.take().ok_or("no standard input")?.write_all(b"0,0\n0.5;0.5\n")?;
    assert_refused(&eval.wait_with_output()?, &["line 2", "0.5;0.5"]);
    Ok(())
}

#[test]
fn scattered_worlds_are_scenarios_like_any_other() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let world = scratch.path().join("world.toml");
    let open = repository("scenarios/open.toml");
    let written = grn().arg("scatter").arg(&open).args(["--seed", "7", "--out"]).arg(&world).output()?;
    assert_eq!(written.status.code(), Some(0), "{}", text(&written.stderr));
    let printed = grn().arg("scatter").arg(&open).args(["--seed", "7"]).output()?;
    assert_eq!(text(&printed.stdout), std::fs::read_to_string(&world)?);
    let drawn = grn().arg("draw").arg(repository("models/andn-nand-xnor.grn")).arg(&world).arg("--json").output()?;
    assert!(text(&drawn.stdout).contains("clearance_min"), "{}", text(&drawn.stderr));
    let crowded = grn().arg("scatter").arg(&open).args(["--density", "0.5", "--clearance", "9"]).output()?;
    assert_refused(&crowded, &["density", "0.5", "no room"]);
    Ok(())
}
