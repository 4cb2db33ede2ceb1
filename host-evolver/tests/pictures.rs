//! What people look at: pictures never cost the run that they are of, are what their names say, and models have one notation.

mod support;

use std::path::Path;
use support::{assert_answered, assert_code, assert_refused, channel, grn, model, text};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// The channel with walls so near that no ring keeps its distance from them.
fn too_narrow() -> std::io::Result<String> {
    let channel = std::fs::read_to_string(channel())?;
    let upper = ("[6.0000, 14.0000], [14.0000, 14.0000]", "[6.0, 10.1], [14.0, 10.1]");
    let lower = ("[14.0000, 6.0000], [6.0000, 6.0000]", "[14.0, 9.9], [6.0, 9.9]");
    assert!(channel.contains(upper.0) && channel.contains(lower.0), "the channel has other walls");
    Ok(channel.replace(upper.0, upper.1).replace(lower.0, lower.1))
}

#[test]
fn a_run_without_a_feasible_model_says_no_and_shows_its_front() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let (world, out) = (scratch.path().join("narrow.toml"), scratch.path().join("out"));
    std::fs::write(&world, too_narrow()?)?;
    let output =
        grn().arg("evolve").arg(&world).args(["--paper", "--evaluations", "800", "--out"]).arg(&out).output()?;
    assert_code(&output, 1);
    assert!(text(&output.stdout).contains("infeasible: "), "{}", text(&output.stdout));
    let picture = std::fs::read_to_string(out.join("pareto.svg"))?;
    assert!(picture.contains("no model is feasible"));
    for name in ["tree.svg", "grn.svg", "front.csv", "knee.grn"] {
        assert!(out.join(name).exists(), "no {name}");
    }
    Ok(())
}

#[test]
fn a_campaign_of_many_scenarios_and_one_generation_is_finished_and_goes_on_overleaf() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let worlds = std::fs::read_to_string(channel())?;
    let mut plan = String::from("name = \"many\"\nseeds = 1\n");
    for number in 1..=12 {
        let name = format!("channel number {number} with a name that does not fit above its panel in a single line");
        let file = scratch.path().join(format!("{number}.toml"));
        std::fs::write(file, worlds.replace("name = \"channel\"", &format!("name = \"{name}\"")))?;
        plan += &format!("[[scenario]]\nfile = \"{number}.toml\"\nevaluations = 40\n");
    }
    plan += "[[method]]\nname = \"a method with a long name\"\nalgorithm = \"eh-grn\"\nstructure = 1\n";
    let (file, out) = (scratch.path().join("campaign.toml"), scratch.path().join("out"));
    std::fs::write(&file, plan)?;
    let output = grn().arg("campaign").arg(&file).arg("--out").arg(&out).output()?;
    assert_code(&output, 0);
    assert!(!text(&output.stderr).contains("is not drawn"), "{}", text(&output.stderr));
    for name in ["f2.svg", "f2-2.svg", "nodes-of-knees-2.svg", "convergence.svg", "convergence-2.svg"] {
        assert!(out.join(name).exists(), "no {name}");
    }
    let history = std::fs::read_to_string(out.join("convergence.svg"))?;
    assert!(history.contains("class=\"point\""), "one generation leaves no mark");
    let printed = text(&output.stdout);
    assert!(!printed.contains("100.0 to 100.0"), "one trial has no interval: {printed}");
    Ok(())
}

#[test]
fn draw_writes_what_the_ending_says_and_refuses_other_endings_before_any_work() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let draw =
        |name: &str| grn().arg("draw").arg(model()).arg(channel()).arg("--out").arg(scratch.path().join(name)).output();
    assert_code(&draw("x.png")?, 0);
    let pixels = std::fs::read(scratch.path().join("x.png"))?;
    assert!(pixels.starts_with(b"\x89PNG\r\n\x1a\n") && pixels.len() > 20_000, "{} bytes", pixels.len());
    for name in ["x.svg", "X.SVG", "picture"] {
        assert_code(&draw(name)?, 0);
        assert!(std::fs::read(scratch.path().join(name))?.starts_with(b"<?xml"), "{name}");
    }
    assert_refused(&draw("x.pdf")?, &["--out", "x.pdf", ".svg or .png", "x.svg"]);
    assert!(!scratch.path().join("x.pdf").exists());
    // Before any work: not even the blob is read.
    let missing = grn().args(["draw", "nothing.grn", "nothing.toml", "--out", "x.jpeg"]).output()?;
    assert_refused(&missing, &["x.jpeg", ".svg or .png"]);
    assert!(!Path::new("x.jpeg").exists());
    Ok(())
}

#[test]
fn show_has_the_notation_of_the_front_with_four_digits_for_people() -> Outcome {
    let shown = grn().arg("show").arg(model()).output()?;
    assert_code(&shown, 0);
    let words = text(&shown.stdout);
    for line in ["(XNOR[0.9256] (NAND[0.8393] x1 x1) x2)", "dy1/dt = -y1 + 1 - sig(x1*x1, 0.8393)", "XNOR  θ = 0.9256"]
    {
        assert!(words.contains(line), "{line:?} is not in {words}");
    }
    let json = grn().arg("show").arg(model()).arg("--json").output()?;
    let shown: serde_json::Value = serde_json::from_slice(&json.stdout)?;
    assert_eq!(shown["expression"], "(XNOR[0.9256] (NAND[0.8393] x1 x1) x2)");
    Ok(())
}

#[test]
fn a_run_too_short_to_draw_is_answered() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let world = std::fs::read_to_string(channel())?;
    let from = world.find("path = ").ok_or("the channel has no path")?;
    let to = from + world[from..].find('\n').ok_or("the path has no end")?;
    let world = format!("{}path = [[5.0, 10.0], [5.02, 10.0]]{}", &world[..from], &world[to..]);
    let (file, out) = (scratch.path().join("short.toml"), scratch.path().join("out"));
    std::fs::write(&file, world)?;
    let output = grn().arg("simulate").arg(model()).arg(&file).arg("--out").arg(&out).output()?;
    assert_answered(&output);
    assert!(std::fs::read_to_string(out.join("trace.svg"))?.starts_with("<?xml"));
    Ok(())
}
