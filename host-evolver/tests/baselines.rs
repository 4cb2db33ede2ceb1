//! What evolved controllers are compared with in campaigns, beside them in every table.

mod support;

use std::path::Path;
use std::process::{Command, Output};
use support::desk::Desk;
use support::{Outcome, text};

const PLAN: &str = r#"name = "baselines"
seeds = 2
[[scenario]]
file = "world.toml"
evaluations = 800
[[method]]
name = "evolved"
algorithm = "mogp"
motifs = "all"
[[method]]
name = "rules"
algorithm = "rule-ring"
baseline = true
[simulate]
realities = 3
speed_m_per_s = 0.06
"#;

fn campaign(desk: &Desk, plan: &str, out: &Path) -> std::io::Result<Output> {
    std::fs::write(desk.path("campaign.toml"), plan)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_grn"));
    command.arg("campaign").arg(desk.path("campaign.toml")).arg("--out").arg(out).output()
}

#[test]
fn the_rule_ring_stands_beside_evolved_controllers_in_all_tables() -> Outcome {
    let desk = Desk::new()?;
    let out = desk.path("out");
    let output = campaign(&desk, PLAN, &out)?;
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let table = |name: &str| std::fs::read_to_string(out.join(name));
    let lines =
        |table: &str| table.lines().filter(|line| line.contains(",rules,")).map(str::to_owned).collect::<Vec<_>>();

    // Seeds change nothing: it has one run, which spends one evaluation.
    let results = table("results.csv")?;
    let [run] = &lines(&results)[..] else { return Err(results.into()) };
    assert!(run.starts_with("world,rules,1,1,1,"), "{run}");
    assert_eq!(results.lines().filter(|line| line.contains(",evolved,")).count(), 2);
    assert!(out.join("runs/world/rules/001/knee.grn").exists() && !out.join("runs/world/rules/002").exists());

    // Its robots follow the rules, not the circle that stands for it where models are evaluated.
    let simulations = table("simulations.csv")?;
    let [simulated] = &lines(&simulations)[..] else { return Err(simulations.into()) };
    let cells: Vec<&str> = simulated.split(',').collect();
    assert_eq!(cells[..7], ["world", "rules", "1", "", "world", "ideal", "3"], "{simulated}");
    let caged: f64 = cells[11].parse()?;
    assert!(caged > 0.85, "the channel has room for a ring: {simulated}");
    let costs_alone = |method: &str| -> Result<f64, Box<dyn std::error::Error>> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grn"));
        command.arg("simulate").arg(out.join(format!("runs/world/{method}/001/knee.grn"))).arg(desk.path("world.toml"));
        let told = command.args(["--speed", "0.06", "--realities", "3", "--json"]).output()?;
        let told: serde_json::Value = serde_json::from_slice(&told.stdout)?;
        Ok(told["cost"].as_f64().ok_or("no cost")?)
    };
    let evolved = simulations.lines().find(|line| line.starts_with("world,evolved,1,")).ok_or("no evolved knee")?;
    assert_eq!(evolved.split(',').nth(12).ok_or("no cost")?.parse::<f64>()?, costs_alone("evolved")?);
    assert_ne!(cells[12].parse::<f64>()?, costs_alone("rules")?);

    // It is compared by its cost.
    let comparisons = table("comparisons.csv")?;
    assert!(comparisons.lines().any(|line| line.starts_with("world,cost,evolved,rules,")), "{comparisons}");
    let figure = table("cost-of-knees.svg")?;
    assert!(figure.contains("rules") && !out.join("typical/world/rules").exists());
    assert!(out.join("typical/world/evolved/tree.svg").exists());

    // Done again nothing changes, and more seeds leave it as it is.
    let before = support::content(&out)?;
    assert_eq!(campaign(&desk, PLAN, &out)?.status.code(), Some(0));
    assert!(support::content(&out)? == before, "done again the folder differs");
    Ok(())
}

#[test]
fn what_the_rule_ring_has_no_use_for_is_refused_at_its_line() -> Outcome {
    let desk = Desk::new()?;
    let simulate = "[simulate]\nrealities = 3\nspeed_m_per_s = 0.06\n";
    for (from, to, words) in [
        (
            "baseline = true",
            "structure = 2",
            &["campaign.toml:13", "method[1].structure", "\"rule-ring\" has no such key"][..],
        ),
        (
            "baseline = true",
            "motifs = \"all\"",
            &["campaign.toml:13", "method[1].motifs", "\"rule-ring\" has no such key"],
        ),
        (simulate, "", &["campaign.toml:12", "method[1].algorithm = \"rule-ring\"", "[simulate]"]),
        ("rule-ring", "rule-rings", &["campaign.toml:12", "rule-ring"]),
    ] {
        let output = campaign(&desk, &support::desk::edited(PLAN, from, to), &desk.path("out"))?;
        let message = text(&output.stderr);
        let first = message.lines().next().unwrap_or_default();
        assert_eq!(output.status.code(), Some(2), "{to}: {message}");
        let missing: Vec<_> = words.iter().filter(|word| !first.contains(**word)).collect();
        assert!(missing.is_empty() && !desk.path("out").exists(), "{to}: {missing:?} is not in {first}");
    }
    Ok(())
}
