//! What a result says of itself: which program, which blob, which conditions; and runs too long to keep.

mod support;

use support::*;

#[test]
fn metrics_name_version_commit_blob_number_type_and_every_condition() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("out");
    let mut command = grn();
    command
        .arg("simulate")
        .arg(model())
        .arg(channel())
        .args(["--number", "q8.24", "--speed", "0.1", "--json", "--out"]);
    let output = command.arg(&folder).output()?;
    let printed: serde_json::Value = serde_json::from_slice(&output.stdout)?;
    let written: serde_json::Value = serde_json::from_slice(&std::fs::read(folder.join("metrics.json"))?)?;
    assert_eq!(printed, written);
    let version = text(&grn().arg("--version").output()?.stdout);
    assert_eq!(format!("grn {}", written["grn"].as_str().ok_or("no version")?), version.trim());
    assert!(version.contains('('), "no commit: {version}");
    assert_eq!((written["blob"].as_str(), written["number"].as_str()), (Some("7c883eab055a7ee8"), Some("q8.24")));
    assert_eq!(written["swarm"]["target_speed_m_per_s"].as_f64(), Some(0.1));
    let keys = [("radio", "range_m"), ("radio", "loss"), ("localisation", "noise_m"), ("timing", "tick_s")];
    for (table, key) in keys {
        assert!(written["swarm"]["lab"][table][key].is_number(), "{table}.{key}");
    }
    Ok(())
}

#[test]
fn a_run_of_more_than_a_thousand_hours_is_refused_before_it_starts() -> Outcome {
    for speed in ["1e-7", "1e-300", "9.5e-7"] {
        let mut command = grn();
        let output = command.arg("simulate").arg(model()).arg(channel()).args(["--speed", speed]).output()?;
        assert_refused(&output, &["--speed", "simulated hours", "metres per second are needed"]);
    }
    // Where the world itself says how long it takes, the speed is not to blame.
    let folder = tempfile::tempdir()?;
    let long = folder.path().join("long.toml");
    std::fs::write(&long, std::fs::read_to_string(channel())?.replace("snapshots", "duration_s = 3.6e6\nsnapshots"))?;
    let output = grn().arg("simulate").arg(model()).arg(&long).output()?;
    assert_refused(&output, &["duration_s = 3600000.0", "at most 3599990 s are possible"]);
    Ok(())
}
