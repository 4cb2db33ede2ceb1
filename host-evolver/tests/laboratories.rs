//! Laboratories on the command line.

mod support;

use std::path::Path;
use support::{channel, grn, model, text};

type Tested = Result<(), Box<dyn std::error::Error>>;

/// What `grn simulate` says of a laboratory with this text, and how it ends.
fn told(folder: &Path, lab: &str) -> Result<(Option<i32>, String), Box<dyn std::error::Error>> {
    let path = folder.join("lab.toml");
    std::fs::write(&path, lab)?;
    let output = grn().arg("simulate").arg(model()).arg(channel()).arg("--lab").arg(&path).output()?;
    assert!(output.stdout.is_empty(), "nothing is simulated");
    Ok((output.status.code(), text(&output.stderr).replace(&path.display().to_string(), "lab.toml")))
}

#[test]
fn a_wrong_laboratory_is_refused_with_line_value_and_way_out() -> Tested {
    let folder = tempfile::tempdir()?;
    for (lab, expected) in [
        ("[radio]\nlos = 0.1\n", "lab.toml:2:1: radio.los: unknown key; did you mean loss?"),
        ("[radios]\nloss = 0.1\n", "lab.toml:1:2: radios: unknown key; did you mean radio?"),
        ("[radio]\nloss = 1.5\n", "lab.toml:2:8: radio.loss = 1.5: must be a number from 0 to 1 (a probability)"),
        (
            "\n[localisation]\nrate_hz = 0\n",
            "lab.toml:3:11: localisation.rate_hz = 0: must be a number from 0.1 to 1000",
        ),
        (
            "[localisation]\nlatency_s = nan\n",
            "lab.toml:2:13: localisation.latency_s = nan: must be a number from 0 to 2",
        ),
        ("[robots]\ncount = 3\nmothers = 5\n", "lab.toml:3:11: robots.mothers = 5: must be a number from 1 to 3"),
        ("[robots]\ncount = -1\n", "lab.toml:2:9: robots.count = -1: "),
        ("[radio]\npayload_bytes = 2\n", "lab.toml:2:17: radio.payload_bytes = 2: a message has up to"),
        ("[proximity]\nresponse = \"sonar\"\n", "lab.toml:2:12: proximity.response = \"sonar\": "),
        ("[proximity]\nbearings_deg = [0.0, 1.0]\n", "lab.toml:2:16: proximity.bearings_deg"),
        (
            "base = \"e-puck3\"\n",
            "lab.toml:1:8: base = \"e-puck3\": must be a laboratory that is shipped: ideal, e-puck2-tracked",
        ),
        ("[timing]\ntick_s = \"fast\"\n", "lab.toml:2:10: timing.tick_s = \"fast\": "),
        ("[wheels\ngain = 0.1\n", "lab.toml:1:"),
    ] {
        let (code, told) = told(folder.path(), lab)?;
        assert_eq!(code, Some(2), "{lab}{told}");
        assert!(told.starts_with(&format!("grn: {expected}")), "{lab}{told}");
    }
    Ok(())
}

#[test]
fn a_wrong_name_or_setting_is_refused() -> Tested {
    for (arguments, expected) in [
        (vec!["--lab", "e-puck"], "--lab = e-puck: no laboratory of this name is shipped (ideal, e-puck2-tracked, "),
        (vec!["--lab", "missing.toml"], "missing.toml"),
        (vec!["--set", "radio.loss"], "--set = radio.loss: must be KEY=VALUE, such as radio.loss=0.3"),
        (vec!["--set", "radio.loss=2"], "--set radio.loss=2: radio.loss = 2.0: must be a number from 0 to 1"),
        (vec!["--set", "radio.range=2"], "--set radio.range=2: radio.range: unknown key; did you mean radio.range_m?"),
        (vec!["--realities", "0"], "error: invalid value '0' for '--realities <N>': must be a number from 1 to 10000"),
    ] {
        let output = grn().arg("simulate").arg(model()).arg(channel()).args(&arguments).output()?;
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
        assert!(told.contains(expected), "{arguments:?}: {told}");
    }
    Ok(())
}

#[test]
fn shipped_laboratories_are_printed_as_they_can_be_read() -> Tested {
    let folder = tempfile::tempdir()?;
    let list = text(&grn().arg("lab").output()?.stdout);
    assert_eq!(list.lines().count(), 4);
    for name in list.lines().filter_map(|line| line.split_whitespace().next()) {
        let printed = grn().arg("lab").arg(name).output()?.stdout;
        let path = folder.path().join(format!("{name}.toml"));
        std::fs::write(&path, &printed)?;
        let checked = grn().arg("lab").arg(&path).output()?;
        assert_eq!(checked.status.code(), Some(0), "{}", text(&checked.stderr));
        assert!(text(&checked.stdout).starts_with(&format!("name = \"{name}\"")));
    }
    Ok(())
}

#[test]
fn realities_are_the_same_for_any_number_of_threads_and_one_by_one() -> Tested {
    let folder = tempfile::tempdir()?;
    let run = |arguments: &[&str]| {
        let short = ["--speed", "0.1", "--lab", "e-puck2-tracked", "--set", "radio.loss=0.3", "--json"];
        grn().arg("simulate").arg(model()).arg(channel()).args(short).args(arguments).output()
    };
    let out = folder.path().join("out");
    let one = run(&["--realities", "4", "--threads", "1"])?;
    let two = run(&["--realities", "4", "--threads", "2", "--out", &out.display().to_string()])?;
    assert_eq!(text(&one.stdout), text(&two.stdout));
    let all: serde_json::Value = serde_json::from_slice(&one.stdout)?;
    assert_eq!(all["of"].as_u64(), Some(4));
    assert_eq!(all["swarm"]["lab"]["radio"]["loss"].as_f64(), Some(0.3));
    let third: serde_json::Value = serde_json::from_slice(&run(&["--reality", "3"])?.stdout)?;
    let (listed, alone) = (&all["realities"][2], &third["metrics"]);
    assert_eq!(listed["encircled_share"], alone["encircled_share"]);
    assert_eq!(listed["radial_error_share"], third["radial_error_share"]);
    assert_ne!(third["swarm"]["lab"]["radio"]["loss"].as_f64(), Some(0.3), "drawn around it");
    let table = std::fs::read_to_string(out.join("realities.csv"))?;
    assert_eq!(table.lines().count(), 5);
    Ok(())
}
