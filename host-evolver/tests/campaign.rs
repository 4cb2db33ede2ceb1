//! `grn campaign` as a researcher uses it: killed, split over machines, merged, and given bad files.

mod support;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;
use support::{Outcome, content, text};

const SMALL: &str = r#"
name = "small"
seeds = 3

[[scenario]]
file = "REPOSITORY/scenarios/channel.toml"
evaluations = 900

[[method]]
name = "MOGP"
algorithm = "mogp"
motifs = "all"

[[method]]
name = "EH-GRN 2"
algorithm = "eh-grn"
structure = 2
baseline = true

[[model]]
name = "printed"
file = "REPOSITORY/models/nand-xnor.grn"

[[transfer]]
name = "random obstacles"
from = ["channel"]
file = "REPOSITORY/scenarios/open.toml"
random = { worlds = 3, seed = 1, density = 0.03, radius = [0.3, 0.6], clearance = 1.5 }
"#;

fn small() -> String {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    SMALL.replace("REPOSITORY", &repository.display().to_string().replace('\\', "/"))
}

fn file(folder: &Path, text: &str) -> std::io::Result<PathBuf> {
    let path = folder.join("campaign.toml");
    std::fs::write(&path, text)?;
    Ok(path)
}

fn campaign(file: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_grn"));
    command.arg("campaign").arg(file).arg("--out").arg(out).args(more);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn assert_done(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

#[test]
fn a_campaign_killed_twenty_times_or_split_ends_like_one_left_alone() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let plan = file(scratch.path(), &small())?;
    let alone = scratch.path().join("alone");
    let output = campaign(&plan, &alone, &["--threads", "1"]).output()?;
    assert_done(&output);
    assert!(text(&output.stdout).contains("A12"));
    let expected = content(&alone)?;
    let has = |name: &str| expected.iter().any(|(path, _)| path == Path::new(name));
    for name in ["results.csv", "summary.csv", "comparisons.csv", "transfers.csv", "f2.svg", "transfers.svg"] {
        assert!(has(name), "no {name}");
    }
    let results = text(&std::fs::read(alone.join("results.csv"))?);
    assert_eq!(results.lines().count(), 1 + 6);

    let killed = scratch.path().join("killed");
    let mut whole_runs = Vec::new();
    for kill in 0..20 {
        let mut child = campaign(&plan, &killed, &[]).spawn()?;
        std::thread::sleep(Duration::from_millis(20 + (kill * 617) % 1900));
        child.kill()?;
        child.wait()?;
        whole_runs.push(content(&killed.join("runs")).map_or(0, |files| files.len()));
    }
    assert!(whole_runs[0] < *whole_runs.last().unwrap_or(&0), "the kills never met work under way");
    assert_done(&campaign(&plan, &killed, &[]).output()?);
    assert!(content(&killed)? == expected, "killed and resumed, the result is another");

    let (first, second) = (scratch.path().join("first"), scratch.path().join("second"));
    let part = campaign(&plan, &first, &["--shard", "1/2"]).output()?;
    assert_done(&part);
    assert!(text(&part.stdout).contains("3 of 6 runs are there"), "{}", text(&part.stdout));
    assert_done(&campaign(&plan, &second, &["--shard", "2/2"]).output()?);
    let first_path = first.display().to_string();
    assert_done(&campaign(&plan, &second, &["--merge", &first_path]).output()?);
    assert!(content(&second)? == expected, "split and merged, the result is another");
    Ok(())
}

#[test]
fn variations_are_in_the_tables_and_not_in_the_figures() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let two_targets = r#"
[[transfer]]
name = "two targets"
from = ["channel"]
file = "REPOSITORY/scenarios/channel-two-targets.toml"

[vary]
level = [0.75, 1.25]
"#;
    let more = small().replace("seeds = 3", "seeds = 2") + two_targets;
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").display().to_string().replace('\\', "/");
    let plan = file(scratch.path(), &more.replace("REPOSITORY", &repository))?;
    let out = scratch.path().join("out");
    assert_done(&campaign(&plan, &out, &[]).output()?);
    let transfers = text(&std::fs::read(out.join("transfers.csv"))?);
    assert!(transfers.contains("\"two targets, level x 0.75\"") && !out.join("transfers-2.svg").exists());
    let figure = text(&std::fs::read(out.join("transfers.svg"))?);
    assert!(figure.contains("two targets") && !figure.contains("level x"));
    Ok(())
}

#[test]
fn a_campaign_refuses_what_is_not_its_own_and_what_it_cannot_do() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let refused = |text_of_file: &str, more: &[&str], words: &[&str]| -> Outcome {
        let plan = file(scratch.path(), text_of_file)?;
        let output = campaign(&plan, &scratch.path().join("out"), more).output()?;
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        for word in words {
            assert!(message.contains(word), "{word:?} is not in {message:?}");
        }
        Ok(())
    };
    refused(&small().replace("seeds = 3", "seeds = 0"), &[], &["campaign.toml", "seeds = 0", "from 1"])?;
    refused(&small().replace("seeds = 3", "seeds = 3\nsedes = 4"), &[], &["campaign.toml", "sedes"])?;
    refused(&small().replace("structure = 2", "structure = 3"), &[], &["campaign.toml", "structure 3"])?;
    refused(&small().replace("motifs = \"all\"", "motif = \"all\""), &[], &["campaign.toml", "motif"])?;
    refused(&small().replace("evaluations = 900", "evaluations = 9"), &[], &["evaluations = 9", "800"])?;
    refused(&small().replace("[\"channel\"]", "[\"canal\"]"), &[], &["canal", "channel"])?;
    refused(&small().replace("nand-xnor.grn", "nothing.grn"), &[], &["nothing.grn", "cannot be read"])?;
    refused(&small().replace("\"EH-GRN 2\"", "\"mogp\""), &[], &["mogp", "another"])?;
    refused(&small().replace("clearance = 1.5", "clearance = 12.0"), &[], &["transfer[0].random.density", "no room"])?;
    refused(&small().replace("worlds = 3", "worlds = 3, depth = 1"), &[], &["campaign.toml", "depth"])?;
    refused(&small().replace("structure = 2", "structure = 2\ncolour = 1"), &[], &["campaign.toml", "colour"])?;
    refused(&small(), &["--shard", "3/2"], &["3/2", "2/3"])?;
    refused(&small(), &["--merge", "nowhere"], &["nowhere", "no such folder"])?;

    let plan = file(scratch.path(), &small().replace("seeds = 3", "seeds = 1"))?;
    let out = scratch.path().join("mine");
    assert_done(&campaign(&plan, &out, &[]).output()?);
    let plan = file(scratch.path(), &small().replace("evaluations = 900", "evaluations = 1000"))?;
    let output = campaign(&plan, &out, &[]).output()?;
    assert_eq!(output.status.code(), Some(2));
    let message = text(&output.stderr);
    assert!(message.contains("evaluations is 900 there and 1000 now") && message.contains("--out"), "{message}");
    Ok(())
}
