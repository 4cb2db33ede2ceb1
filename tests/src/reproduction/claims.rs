//! The paper's claims against the campaign's tables.

use super::*;

/// What we say to a claim.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Holds,
    InPart,
    Fails,
}

impl Verdict {
    fn of(holds: &[bool]) -> Verdict {
        match (holds.iter().all(|&part| part), holds.iter().any(|&part| part)) {
            (true, _) => Verdict::Holds,
            (false, true) => Verdict::InPart,
            (false, false) => Verdict::Fails,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Verdict::Holds => "holds",
            Verdict::InPart => "holds in part",
            Verdict::Fails => "does not hold",
        }
    }
}

struct Claim {
    text: &'static str,
    verdict: Verdict,
    figures: String,
    file: &'static str,
}

/// How much better than chance is clearly better.
const CLEAR: f64 = 0.9;
const SIGNIFICANT: f64 = 0.01;
/// A success rate that counts as success.
const NEARLY_ALL: f64 = 0.95;

fn claims(paper: &Tables) -> Result<Vec<Claim>, Missing> {
    Ok(vec![
        feasible_in(
            paper,
            CHANNEL,
            "Task 1: the framework finds models that encircle a target through the channel without touching it.",
        )?,
        trade_off(paper)?,
        knees(paper)?,
        baseline_in_channel(paper)?,
        two_targets(paper)?,
        baseline_two_targets(paper)?,
        feasible_in(paper, COMPOUND, "Task 2: it finds models for the compound channel too.")?,
        points_a_and_b(paper)?,
        baseline_in_compound(paper)?,
        better_than_baseline(paper)?,
        random_obstacles(paper)?,
    ])
}

fn feasible_in(paper: &Tables, scenario: &str, text: &'static str) -> Result<Claim, Missing> {
    let (all, binary) =
        (paper.summary(scenario, ALL, Measure::BestF2)?, paper.summary(scenario, BINARY, Measure::BestF2)?);
    let figures = format!(
        "Feasible runs: {}/{} with all motifs, {}/{} with binary ones. Best f2 {} and {}.",
        all.feasible,
        all.runs,
        binary.feasible,
        binary.runs,
        quartiles(all),
        quartiles(binary)
    );
    let verdict = Verdict::of(&[all.feasible == all.runs, binary.feasible == binary.runs]);
    Ok(Claim { text, verdict, figures, file: "paper/summary.csv" })
}

fn trade_off(paper: &Tables) -> Result<Claim, Missing> {
    let runs: Vec<_> = paper.runs.iter().filter(|run| run.scenario == CHANNEL && run.method == BINARY).collect();
    let traded =
        runs.iter().filter(|run| run.members > 1 && run.best_nodes > run.knee_nodes.min(run.best_nodes - 1)).count();
    let members: Vec<usize> = runs.iter().map(|run| run.members).collect();
    let (least, most) = (members.iter().min().copied().unwrap_or(0), members.iter().max().copied().unwrap_or(0));
    let nodes = paper.summary(CHANNEL, BINARY, Measure::BestNodes)?;
    Ok(Claim {
        text: "Fronts trade size for accuracy: the fewer nodes, the higher f2.",
        verdict: Verdict::of(&[traded * 20 >= runs.len() * 19]),
        figures: format!(
            "Binary motifs, channel: fronts of {least} to {most} models, more than one in {traded} of {} runs; the most \
             accurate model has {} nodes. Beyond 5 nodes little is gained: best f2 {}, knee f2 {}.",
            runs.len(),
            quartiles(nodes),
            quartiles(paper.summary(CHANNEL, BINARY, Measure::BestF2)?),
            quartiles(paper.summary(CHANNEL, BINARY, Measure::KneeF2)?),
        ),
        file: "paper/results.csv",
    })
}

fn knees(paper: &Tables) -> Result<Claim, Missing> {
    let of = |scenario| paper.summary(scenario, BINARY, Measure::KneeNodes);
    let (channel, compound) = (of(CHANNEL)?, of(COMPOUND)?);
    let near = |row: &Summary| (3.0..=7.0).contains(&row.median);
    Ok(Claim {
        text: "Knees are small: 5 nodes in task 1 (point B), 5 and 7 in task 2 (points A and B).",
        verdict: Verdict::of(&[near(channel), near(compound)]),
        figures: format!(
            "Nodes of the knee with binary motifs: {} in the channel, {} in the compound channel; with all motifs {} and {}.",
            quartiles(channel),
            quartiles(compound),
            quartiles(paper.summary(CHANNEL, ALL, Measure::KneeNodes)?),
            quartiles(paper.summary(COMPOUND, ALL, Measure::KneeNodes)?),
        ),
        file: "paper/summary.csv",
    })
}

fn baseline_in_channel(paper: &Tables) -> Result<Claim, Missing> {
    let row = paper.summary(CHANNEL, EH_1, Measure::BestF2)?;
    let printed = paper.transfer(CHANNEL, "", PRINTED_EH_1)?;
    Ok(Claim {
        text: "EH-GRN of task 1, tuned by CMA-ES, encircles one target through the channel.",
        verdict: Verdict::of(&[row.feasible == row.runs, printed.rate == 1.0]),
        figures: format!(
            "The printed model {}. Tuned again: {}/{} feasible, f2 {}.",
            if printed.rate == 1.0 { "passes" } else { "does not pass" },
            row.feasible,
            row.runs,
            quartiles(row)
        ),
        file: "paper/summary.csv, paper/transfers.csv",
    })
}

const TWO: &str = "two targets";

fn two_targets(paper: &Tables) -> Result<Claim, Missing> {
    let printed = paper.transfer(TWO, "", NAND_XNOR)?;
    let (all, binary) = (paper.transfer(TWO, CHANNEL, ALL)?, paper.transfer(TWO, CHANNEL, BINARY)?);
    Ok(Claim {
        text: "A model evolved with one target encircles two, applied unchanged: ellipse, gourd, two rings.",
        verdict: Verdict::of(&[printed.rate == 1.0, all.rate >= NEARLY_ALL, binary.rate >= NEARLY_ALL]),
        figures: format!(
            "Printed NAND-XNOR {}. Knees: {} with all motifs, {} with binary ones.",
            if printed.rate == 1.0 { "passes" } else { "does not pass" },
            percent(all),
            percent(binary)
        ),
        file: "paper/transfers.csv",
    })
}

fn baseline_two_targets(paper: &Tables) -> Result<Claim, Missing> {
    let printed = paper.transfer(TWO, "", PRINTED_EH_1)?;
    let (one, two) = (paper.transfer(TWO, CHANNEL, EH_1)?, paper.transfer(TWO, CHANNEL, EH_2)?);
    Ok(Claim {
        text: "EH-GRN collides with the channel when it is applied to two targets, because its structure is given.",
        verdict: Verdict::of(&[printed.rate < 1.0, one.rate < NEARLY_ALL]),
        figures: format!(
            "The printed model of task 1 {}. Tuned again, the same structure succeeds in {}, that of task 2 in {}: where \
             it fails it is the θ, not the structure.",
            if printed.rate < 1.0 { "leaks" } else { "passes" },
            percent(one),
            percent(two)
        ),
        file: "paper/transfers.csv",
    })
}

fn points_a_and_b(paper: &Tables) -> Result<Claim, Missing> {
    let (a, b) = (paper.transfer(COMPOUND, "", ANDN_XNOR)?, paper.transfer(COMPOUND, "", ANDN_NAND_XNOR)?);
    Ok(Claim {
        text: "Points A (5 nodes) and B (7 nodes) of task 2 pass the compound channel, and B has the lower f2.",
        verdict: Verdict::of(&[a.rate == 1.0 && b.rate == 1.0, b.median_f2 < a.median_f2]),
        figures: format!(
            "f2 of A {:.5}, of B {:.5}; both feasible: {}.",
            a.median_f2,
            b.median_f2,
            a.rate == 1.0 && b.rate == 1.0
        ),
        file: "paper/transfers.csv",
    })
}

fn baseline_in_compound(paper: &Tables) -> Result<Claim, Missing> {
    let printed = paper.transfer(COMPOUND, "", PRINTED_EH_2)?;
    let of = |method| paper.summary(COMPOUND, method, Measure::BestF2);
    let (one, two) = (of(EH_1)?, of(EH_2)?);
    let b = paper.transfer(COMPOUND, "", ANDN_NAND_XNOR)?;
    Ok(Claim {
        text: "EH-GRN cannot adapt to the compound channel: it collides in the narrowest parts.",
        verdict: Verdict::of(&[printed.rate < 1.0, one.feasible == 0, two.feasible == 0]),
        figures: format!(
            "The printed model of task 2 {} (f2 {:.5}, point B {:.5}). Tuned again: structure 1 is feasible in {}/{} runs, \
             structure 2 in {}/{}, f2 {}.",
            if printed.rate < 1.0 { "touches the walls" } else { "encloses the target everywhere" },
            printed.median_f2,
            b.median_f2,
            one.feasible,
            one.runs,
            two.feasible,
            two.runs,
            quartiles(two)
        ),
        file: "paper/summary.csv, paper/transfers.csv",
    })
}

fn better_than_baseline(paper: &Tables) -> Result<Claim, Missing> {
    let mut figures = Vec::new();
    let mut parts = Vec::new();
    for (baseline, words) in [(EH_1, "structure 1"), (EH_2, "structure 2")] {
        for measure in [Measure::BestF2, Measure::KneeF2, Measure::KneeNodes] {
            let row = paper.comparison(COMPOUND, ALL, baseline, measure)?;
            parts.push(row.p_holm < SIGNIFICANT && row.a12 > CLEAR);
            figures.push(format!("{} against {words}: A12 {:.3}, {}", measure.words(), row.a12, p_value(row.p_holm)));
        }
    }
    Ok(Claim {
        text: "In the compound channel the framework's models have lower f2 and fewer nodes than EH-GRN.",
        verdict: Verdict::of(&parts),
        figures: format!("All motifs. {}.", figures.join("; ")),
        file: "paper/comparisons.csv",
    })
}

const RANDOM: &str = "random obstacles";

fn random_obstacles(paper: &Tables) -> Result<Claim, Missing> {
    let of = |from: &str, method: &str| -> Result<&TransferRow, Missing> { paper.transfer(RANDOM, from, method) };
    let (a, b, one_b) = (of("", ANDN_XNOR)?, of("", ANDN_NAND_XNOR)?, of("", NAND_XNOR)?);
    let (all, binary) = (of(COMPOUND, ALL)?, of(COMPOUND, BINARY)?);
    Ok(Claim {
        text: "Models of the compound channel work among randomly placed obstacles, unchanged (announced, not shown).",
        verdict: Verdict::of(&[
            a.rate >= NEARLY_ALL,
            b.rate >= NEARLY_ALL,
            all.rate >= NEARLY_ALL,
            binary.rate >= NEARLY_ALL,
        ]),
        figures: format!(
            "{} worlds. Printed A {}, B {}, NAND-XNOR of task 1 {}. Our knees {} (all motifs), {} (binary). EH-GRN: \
             structure 1 {}, structure 2 {}; printed task 1 {}, task 2 {}.",
            a.worlds,
            percent(a),
            percent(b),
            percent(one_b),
            percent(all),
            percent(binary),
            percent(of(COMPOUND, EH_1)?),
            percent(of(COMPOUND, EH_2)?),
            percent(of("", PRINTED_EH_1)?),
            percent(of("", PRINTED_EH_2)?),
        ),
        file: "paper/transfers.csv",
    })
}

/// The table of claims.
pub(super) fn section(paper: &Tables) -> Result<String, Missing> {
    let mut text = String::from(
        "## Claims and verdicts\n\n| claim | verdict | figures | file in `docs/reproduction/` |\n|---|---|---|---|\n",
    );
    for claim in claims(paper)? {
        text += &format!("| {} | **{}** | {} | {} |\n", claim.text, claim.verdict.words(), claim.figures, claim.file);
    }
    Ok(text + "\n")
}

/// Medians, quartiles and success rates of all methods.
pub(super) fn tables(paper: &Tables) -> String {
    let mut text = String::from(
        "## All methods\n\n| scenario | method | feasible | best f2 | its nodes | knee f2 | its nodes | hypervolume |\n|---|---|---|---|---|---|---|---|\n",
    );
    for row in paper.summaries.iter().filter(|row| row.measure == Measure::BestF2) {
        let rest = Measure::ALL.iter().filter_map(|&measure| paper.summary(&row.scenario, &row.method, measure).ok());
        let cells: Vec<String> = rest.map(quartiles).collect();
        text +=
            &format!("| {} | {} | {}/{} | {} |\n", row.scenario, row.method, row.feasible, row.runs, cells.join(" | "));
    }
    text += "\n`docs/reproduction/paper/summary.csv`\n\n| tried in | evolved for | model | success | median f2 |\n|---|---|---|---|---|\n";
    for row in &paper.transfers {
        let f2 = if row.median_f2 < 2.0 { format!("{:.5}", row.median_f2) } else { "infeasible".into() };
        let from = if row.from.is_empty() { "(given)" } else { &row.from };
        text += &format!("| {} | {from} | {} | {} | {f2} |\n", row.transfer, row.method, percent(row));
    }
    text + "\n`docs/reproduction/paper/transfers.csv`\n\n"
}

/// Pictures with what they show.
pub(super) fn pictures() -> String {
    let mut text = String::from("## Pictures\n\n");
    for (file, words) in [
        ("f2-of-knees.svg", "f2 of the knee of each run"),
        ("nodes-of-knees.svg", "Nodes of the knee of each run"),
        ("convergence.svg", "Hypervolume over evaluations: median and quartiles"),
        ("transfers.svg", "Success rates in other worlds"),
        (
            "channel-mogp-binary-motifs-pareto.svg",
            "Channel, binary motifs: front of the run whose knee has the median f2",
        ),
        ("channel-mogp-binary-motifs-tree.svg", "Its knee as a syntax tree"),
        ("channel-mogp-binary-motifs-grn.svg", "and as a GRN"),
        ("channel-mogp-binary-motifs-pattern.svg", "and its pattern along the path"),
        ("channel-eh-grn-structure-1-pattern.svg", "Channel, EH-GRN of structure 1: pattern of the median run"),
        ("compound-channel-mogp-binary-motifs-pareto.svg", "Compound channel, binary motifs: front of the median run"),
        ("compound-channel-mogp-binary-motifs-tree.svg", "Its knee as a syntax tree"),
        ("compound-channel-mogp-binary-motifs-pattern.svg", "and its pattern along the path"),
        (
            "compound-channel-eh-grn-structure-2-pattern.svg",
            "Compound channel, EH-GRN of structure 2: pattern of the median run",
        ),
    ] {
        text += &format!("{words}:\n\n![{words}](reproduction/{file})\n\n");
    }
    text
}
