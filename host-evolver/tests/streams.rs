//! Standard output and standard error that are closed, full, or a terminal that is gone: work and files are completed, and
//! the exit code is that of the answer.
#![cfg(target_os = "linux")]

mod support;

use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use support::*;

fn full() -> std::io::Result<Stdio> {
    Ok(OpenOptions::new().write(true).open("/dev/full")?.into())
}

/// A pipe that nobody reads.
fn closed() -> std::io::Result<Stdio> {
    Ok(std::io::pipe()?.1.into())
}

fn assert_whole(run: &Path) {
    for name in ["front.csv", "knee.grn", "pareto.svg", "simulation/metrics.json"] {
        assert!(run.join(name).exists(), "{name} is missing");
    }
}

#[test]
fn evolve_completes_its_work_whatever_happens_to_its_streams() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let whole = scratch.path().join("whole");
    let expected = evolve(&whole, 2, &[]).output()?.status.code();
    for (name, [output, error]) in [
        ("closed", [closed()?, closed()?]),
        ("full", [full()?, full()?]),
        ("output-closed", [closed()?, Stdio::null()]),
        ("error-full", [Stdio::null(), full()?]),
    ] {
        let folder = scratch.path().join(name);
        let status = evolve(&folder, 2, &[]).stdout(output).stderr(error).status()?;
        assert_eq!(status.code(), expected, "{name}");
        assert_whole(&folder);
        assert_eq!(different(&whole, &folder)?, Vec::<std::path::PathBuf>::new(), "{name}");
    }
    Ok(())
}

#[test]
fn simulate_answers_no_although_nobody_reads_it() -> Outcome {
    let three_robots = || {
        let mut command = grn();
        command.arg("simulate").arg(model()).arg(channel()).args(["--robots", "3"]);
        command
    };
    assert_eq!(three_robots().stdout(closed()?).status()?.code(), Some(1));
    assert_eq!(three_robots().stdout(full()?).stderr(full()?).status()?.code(), Some(1));
    assert_eq!(three_robots().arg("--json").stdout(closed()?).status()?.code(), Some(1));
    Ok(())
}

#[test]
fn what_cannot_be_printed_although_it_was_asked_for_is_a_failure_of_the_system() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let model = model().display().to_string();
    let channel = channel().display().to_string();
    for arguments in [
        vec!["show", &model],
        vec!["show", &model, "--json"],
        vec!["draw", &model, &channel, "--json"],
        vec!["simulate", &model, &channel, "--json"],
        vec!["scatter", &channel, "--density", "0.01"],
        vec!["flash", &model, "--to", "tcp:x:1", "--dry-run"],
        vec!["--help"],
        vec!["show", "--help"],
    ] {
        let run = |output: Stdio| grn().args(&arguments).current_dir(scratch.path()).stdout(output).output();
        let output = run(full()?)?;
        assert_code(&output, 3);
        assert!(text(&output.stderr).contains("standard output"), "{arguments:?}: {}", text(&output.stderr));
        assert_code(&run(closed()?)?, 0);
    }
    Ok(())
}

#[test]
fn eval_ends_when_its_reader_has_seen_enough() -> Outcome {
    let mut child = grn().arg("eval").arg(model()).stdin(Stdio::piped()).stdout(closed()?).spawn()?;
    let mut lines = child.stdin.take().ok_or("no standard input")?;
    while lines.write_all(b"0,0\n").is_ok() {}
    assert_eq!(child.wait()?.code(), Some(0));

    let mut child = grn().arg("eval").arg(model()).stdin(Stdio::piped()).stdout(full()?).spawn()?;
    child.stdin.take().ok_or("no standard input")?.write_all(b"0,0\n")?;
    assert_eq!(child.wait()?.code(), Some(3));
    Ok(())
}

#[test]
fn a_campaign_leaves_its_tables_whatever_happens_to_its_streams() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = scratch.path().join("campaign.toml");
    let channel = channel().display().to_string();
    std::fs::write(
        &plan,
        format!(
            "name = \"c\"\nseeds = 2\n[[scenario]]\nfile = {channel:?}\nevaluations = 80\n\
             [[method]]\nname = \"m\"\nalgorithm = \"eh-grn\"\nstructure = 2\n"
        ),
    )?;
    for (name, [output, error]) in [("closed", [closed()?, closed()?]), ("full", [full()?, full()?])] {
        let folder = scratch.path().join(name);
        let status =
            grn().arg("campaign").arg(&plan).arg("--out").arg(&folder).stdout(output).stderr(error).status()?;
        assert_eq!(status.code(), Some(0), "{name}");
        for table in ["results.csv", "summary.csv", "transfers.csv", "f2.svg"] {
            assert!(folder.join(table).exists(), "{name}: {table} is missing");
        }
    }
    Ok(())
}

fn signal(name: &str, process: u32) -> Outcome {
    assert!(Command::new("kill").args([&format!("-{name}"), &process.to_string()]).status()?.success());
    Ok(())
}

#[test]
fn the_end_of_the_terminal_or_of_the_machine_is_an_interruption_like_ctrl_c() -> Outcome {
    let scratch = tempfile::tempdir()?;
    for name in ["INT", "TERM", "HUP"] {
        let folder = scratch.path().join(name);
        let run = evolve(&folder, 500, &[]);
        // Whoever runs these tests may have started them under nohup, and ignored signals are inherited.
        let mut command = Command::new("env");
        command.arg("--default-signal").arg(run.get_program()).args(run.get_args());
        let child = command.stdout(Stdio::piped()).stderr(closed()?).spawn()?;
        while !folder.join("checkpoint.json").exists() {
            std::thread::sleep(Duration::from_millis(20));
        }
        signal(name, child.id())?;
        assert_code(&child.wait_with_output()?, 130);
    }
    Ok(())
}

/// The parent of such a process ignores the signal, and so does the process.
#[test]
fn a_run_under_nohup_outlives_its_terminal() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("run");
    let script = "trap '' HUP; exec \"$0\" evolve \"$1\" --out \"$2\" --evaluations 4000";
    let child = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_grn")])
        .arg(channel())
        .arg(&folder)
        .stdout(closed()?)
        .stderr(closed()?)
        .spawn()?;
    while !folder.join("checkpoint.json").exists() {
        std::thread::sleep(Duration::from_millis(20));
    }
    signal("HUP", child.id())?;
    assert_answered(&child.wait_with_output()?);
    assert_whole(&folder);
    Ok(())
}
