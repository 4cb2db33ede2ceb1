//! `grn campaign` as a researcher uses it: killed, split over machines, merged, and given bad files.

mod support;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;
use support::desk::{CAMPAIGN, Desk, edited};
use support::{Outcome, content, repository, text};

/// The campaign of the desk with three seeds, a method that the other is compared with, and no variations.
fn small() -> String {
    let text = edited(CAMPAIGN, "seeds = 1", "seeds = 3");
    let text = edited(&text, "evaluations = 800", "evaluations = 900");
    let text = edited(&text, "structure = 2", "structure = 2\nbaseline = true");
    edited(&text, "[vary]\nlevel = [0.9, 1.1]\n", "[simulate]\nrealities = 2\n")
}

fn written(desk: &Desk, text: &str) -> std::io::Result<PathBuf> {
    std::fs::write(desk.path("campaign.toml"), text)?;
    Ok(desk.path("campaign.toml"))
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
    let desk = Desk::new()?;
    let plan = written(&desk, &small())?;
    let alone = desk.path("alone");
    let output = campaign(&plan, &alone, &["--threads", "1"]).output()?;
    assert_done(&output);
    assert!(text(&output.stdout).contains("A12"));
    let expected = content(&alone)?;
    let has = |name: &str| expected.iter().any(|(path, _)| path == Path::new(name));
    let tables =
        ["results.csv", "summary.csv", "comparisons.csv", "transfers.csv", "simulations.csv", "simulation-summary.csv"];
    for name in tables.into_iter().chain(["f2.svg", "transfers.svg", "simulations.svg"]) {
        assert!(has(name), "no {name}");
    }
    let results = text(&std::fs::read(alone.join("results.csv"))?);
    assert_eq!(results.lines().count(), 1 + 6);
    let simulations = text(&std::fs::read(alone.join("simulations.csv"))?);
    assert_eq!(simulations.lines().filter(|line| line.starts_with("world,") && line.contains(",ideal,2,")).count(), 6);
    let parts = expected.iter().filter(|(path, _)| path.starts_with("simulations/world"));
    let realities = parts.map(|(_, bytes)| text(bytes).lines().filter(|line| !line.starts_with('#')).count());
    assert_eq!(realities.collect::<Vec<_>>(), [3; 6], "a header and two realities for each of six knees");
    assert!(text(&output.stdout).contains("knees simulated in 2 realities of ideal each"), "{}", text(&output.stdout));

    let killed = desk.path("killed");
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

    let (first, second) = (desk.path("first"), desk.path("second"));
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
    let desk = Desk::new()?;
    let two_targets = format!(
        "[[transfer]]\nname = \"two targets\"\nfrom = [\"world\"]\nfile = {:?}\n[vary]\nlevel = [0.75, 1.25]\n",
        repository("scenarios/channel-two-targets.toml").display().to_string()
    );
    let plan = written(&desk, &(edited(&small(), "seeds = 3", "seeds = 2") + &two_targets))?;
    let out = desk.path("out");
    assert_done(&campaign(&plan, &out, &[]).output()?);
    let transfers = text(&std::fs::read(out.join("transfers.csv"))?);
    assert!(transfers.contains("\"two targets, level x 0.75\"") && !out.join("transfers-2.svg").exists());
    let figure = text(&std::fs::read(out.join("transfers.svg"))?);
    assert!(figure.contains("two targets") && !figure.contains("level x"));
    Ok(())
}

#[test]
fn the_command_line_says_what_is_simulated_and_old_simulations_go() -> Outcome {
    let desk = Desk::new()?;
    let plan = written(&desk, &small().replace("seeds = 3", "seeds = 1"))?;
    let out = desk.path("out");
    let lines = |more: &[&str]| -> Result<(Vec<String>, usize), Box<dyn std::error::Error>> {
        assert_done(&campaign(&plan, &out, more).output()?);
        let simulations = text(&std::fs::read(out.join("simulations.csv"))?);
        let parts = content(&out)?.into_iter().filter(|(path, _)| path.starts_with("simulations"));
        Ok((simulations.lines().skip(1).map(str::to_owned).collect(), parts.count()))
    };
    let (planned, parts) = lines(&[])?;
    assert_eq!((planned.len(), parts), (2, 2));
    let (jammed, parts) = lines(&["--lab", "e-puck2-tracked", "--set", "radio.range_m=0.01", "--realities", "3"])?;
    // Robots that hear nobody never learn where the target is.
    assert!(jammed.iter().all(|line| line.contains(",e-puck2-tracked,3,0,0.0,")), "{jammed:?}");
    assert_eq!(parts, 2, "those of the plan are gone");
    assert_eq!(lines(&[])?, (planned, 2), "and come again");
    let without =
        written(&desk, &small().replace("[simulate]\nrealities = 2\n", "").replace("seeds = 3", "seeds = 1"))?;
    assert_done(&campaign(&without, &out, &[]).output()?);
    assert!(!out.join("simulations.csv").exists() && !out.join("simulations").exists());
    Ok(())
}

#[test]
fn runs_that_were_tried_in_another_laboratory_are_not_taken_for_these() -> Outcome {
    let desk = Desk::new()?;
    let plan = |set: &str| {
        format!(
            "name = \"tried\"\nseeds = 1\n[[scenario]]\nfile = \"world.toml\"\nevaluations = 800\n[[method]]\nname = \"m\"\n\
             algorithm = \"mogp\"\nmotifs = \"all\"\nobjectives = [\"nodes\", \"closed-loop\"]\nrealities = 1\n\
             [simulate]\nrealities = 1\nspeed_m_per_s = 0.12\nset = [{set}]\n"
        )
    };
    let out = desk.path("out");
    assert_done(&campaign(&written(&desk, &plan(""))?, &out, &[]).output()?);
    assert_done(&campaign(&written(&desk, &plan(""))?, &out, &[]).output()?);
    let other = campaign(&written(&desk, &plan("\"radio.loss=0.5\""))?, &out, &[]).output()?;
    let message = text(&other.stderr);
    assert_eq!(other.status.code(), Some(2), "{message}");
    assert!(message.contains("not the same run: swarm.lab.radio.loss"), "{message}");
    Ok(())
}

#[test]
fn a_campaign_refuses_what_is_not_its_own_and_what_it_cannot_do() -> Outcome {
    let desk = Desk::new()?;
    let refused = |text_of_file: &str, more: &[&str], words: &[&str]| -> Outcome {
        let plan = written(&desk, text_of_file)?;
        let output = campaign(&plan, &desk.path("out"), more).output()?;
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
    refused(&small().replace("[\"world\"]", "[\"wrold\"]"), &[], &["wrold", "world"])?;
    refused(&small().replace("blob.grn", "nothing.grn"), &[], &["nothing.grn", "cannot be read"])?;
    refused(&small().replace("name = \"e\"", "name = \"M\""), &[], &["M", "another"])?;
    refused(&small().replace("clearance = 1.5", "clearance = 12.0"), &[], &["transfer[0].random.density", "no room"])?;
    refused(&small().replace("worlds = 3", "worlds = 3, depth = 1"), &[], &["campaign.toml", "depth"])?;
    refused(&small().replace("structure = 2", "structure = 2\ncolour = 1"), &[], &["campaign.toml", "colour"])?;
    refused(&small().replace("realities = 2", "realities = 0"), &[], &["campaign.toml", "realities = 0", "from 1"])?;
    refused(
        &small().replace("realities = 2", "lab = \"moon\""),
        &[],
        &["campaign.toml", "simulate.lab = \"moon\"", "hostile"],
    )?;
    refused(&small().replace("realities = 2", "set = [\"radio.lost=1\"]"), &[], &["simulate.set[0]", "radio.loss?"])?;
    refused(
        &small().replace("realities = 2", "scale = 9.0"),
        &[],
        &["campaign.toml:", "simulate.scale = 9", "31.7 m", "scenario world"],
    )?;
    refused(&small(), &["--lab", "moon"], &["--lab", "moon", "hostile"])?;
    refused(&small(), &["--set", "radio.loss=2"], &["--set radio.loss=2", "from 0 to 1"])?;
    refused(&small(), &["--shard", "3/2"], &["3/2", "2/3"])?;
    refused(&small(), &["--merge", "nowhere"], &["nowhere", "no such folder"])?;

    let plan = written(&desk, &small().replace("seeds = 3", "seeds = 1"))?;
    let out = desk.path("mine");
    assert_done(&campaign(&plan, &out, &[]).output()?);
    let plan = written(&desk, &small().replace("evaluations = 900", "evaluations = 1000"))?;
    let output = campaign(&plan, &out, &[]).output()?;
    assert_eq!(output.status.code(), Some(2));
    let message = text(&output.stderr);
    assert!(message.contains("evaluations is 900 there and 1000 now") && message.contains("--out"), "{message}");
    Ok(())
}
