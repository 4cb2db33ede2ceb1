//! The page on controllers that adapt: what they cost in the closed loop, beside what they are to be better than.

use super::{Look, Missing, p_value};
use host_evolver::campaign::{Comparison, Measure, SimulationSummary, Summary, Tables};
use std::collections::BTreeSet;

/// The method that is compared with all others.
const OURS: &str = "closed loop";
/// The best circle, which sees no obstacles.
const CIRCLE: &str = "circle";
/// A p below this counts, after Holm's correction.
const SIGNIFICANT: f64 = 0.001;
/// The mean over worlds of the median costs that was wanted.
const WANTED_COST: f64 = 0.13;
/// The share of the time that targets were wanted to be caged in all worlds but one.
const WANTED_CAGED: f64 = 0.97;
/// The same in worlds that the search has not seen.
const WANTED_UNSEEN: f64 = 0.9;
/// The scenario of `campaigns/generalise.toml` that trains in several worlds, and the worlds that test it.
const TRAINED_IN_ALL: &str = "three worlds";
const UNSEEN: &str = "unseen";

/// What the page is made from.
pub struct AdaptiveCampaigns {
    /// Laboratories and the campaigns in them, which compare the same methods in the same worlds.
    pub laboratories: Vec<(String, Tables)>,
    /// Trained in some worlds and tested in others.
    pub generalise: Tables,
}

/// The whole page.
///
/// # Errors
/// A table without a line that the page needs.
pub fn adaptive_report(campaigns: &AdaptiveCampaigns) -> Result<String, Missing> {
    let mut page = String::from(INTRODUCTION);
    page += "## What was wanted, and what came out\n\n| wanted | laboratory | met | figures |\n|---|---|---|---|\n";
    for (laboratory, tables) in &campaigns.laboratories {
        for row in wanted(tables)? {
            page += &format!(
                "| {} | {laboratory} | {} | {} |\n",
                row.what,
                if row.met { "yes" } else { "**no**" },
                row.figures
            );
        }
    }
    let row = generalises(&campaigns.generalise)?;
    page += &format!("| {} | ideal | {} | {} |\n\n", row.what, if row.met { "yes" } else { "**no**" }, row.figures);
    for (laboratory, tables) in &campaigns.laboratories {
        page += &of_laboratory(laboratory, tables)?;
    }
    page += &unseen(&campaigns.generalise);
    page += &pictures(&campaigns.laboratories);
    Ok(page)
}

const INTRODUCTION: &str = "\
# Controllers that adapt\n\n\
Worlds in which no circle fits, or a small one only, and what swarms cost in them. `cargo xtask reproduce adaptive` makes this page \
and everything in `docs/adaptive/` from `campaigns/adaptive.toml`, `campaigns/adaptive-tracked.toml` and `campaigns/generalise.toml`; \
nothing here is written by hand but the words. How the search works is in `docs/closed-loop.md`.\n\n\
J is what a simulated run costs (see README): less is better, 0 is perfect. Of each run the knee is simulated in realities of the \
laboratory that no search has seen. Medians are given with quartiles over seeds. Tests are two-sided Mann-Whitney U tests over seeds, p \
after Holm's correction over all lines of `comparisons.csv`; A12 is the probability that a run of the first method is better than \
one of the second.\n\n";

/// Something that was wanted, and what came out.
struct Wanted {
    what: String,
    met: bool,
    figures: String,
}

/// The scenarios of a campaign, in its order.
pub fn scenarios(tables: &Tables) -> Vec<&str> {
    let mut seen = BTreeSet::new();
    tables.summaries.iter().map(|row| row.scenario.as_str()).filter(|name| seen.insert(*name)).collect()
}

fn methods(tables: &Tables) -> Vec<&str> {
    let mut seen = BTreeSet::new();
    tables.summaries.iter().map(|row| row.method.as_str()).filter(|name| seen.insert(*name)).collect()
}

/// How the knees of a method did in the worlds they were trained for.
fn simulated<'t>(tables: &'t Tables, scenario: &str, method: &str) -> Result<&'t SimulationSummary, Missing> {
    let is_it = |row: &&SimulationSummary| {
        row.scenario == scenario && row.method == method && row.transfer.is_empty() && row.world.is_empty()
    };
    let found = tables.simulated.iter().find(is_it);
    found.ok_or_else(|| Missing(format!("simulations of {method} in {scenario}")))
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

fn median_costs(tables: &Tables, method: &str) -> Result<Vec<f64>, Missing> {
    let median = |scenario: &&str| Ok(tables.summary(scenario, method, Measure::Cost)?.median);
    scenarios(tables).iter().map(median).collect()
}

fn wanted(tables: &Tables) -> Result<Vec<Wanted>, Missing> {
    let worlds = scenarios(tables);
    let against: Vec<&Comparison> = worlds
        .iter()
        .map(|scenario| tables.comparison(scenario, OURS, CIRCLE, Measure::Cost))
        .collect::<Result<_, _>>()?;
    let lower = against.iter().filter(|row| row.median < row.baseline_median).count();
    let sure = against.iter().filter(|row| row.median < row.baseline_median && row.p_holm < SIGNIFICANT).count();
    let ours = median_costs(tables, OURS)?;
    let caged: Vec<f64> =
        worlds.iter().map(|scenario| Ok(simulated(tables, scenario, OURS)?.caged)).collect::<Result<_, Missing>>()?;
    let enough = caged.iter().filter(|&&caged| caged >= WANTED_CAGED).count();
    let cost = mean(ours.iter().copied());
    Ok(vec![
        Wanted {
            what: "Costs less than the best circle in every world".into(),
            met: lower == worlds.len(),
            figures: format!("less in {lower} of {} worlds, in {sure} with p < {SIGNIFICANT}", worlds.len()),
        },
        Wanted {
            what: format!("Mean over worlds of the median J at most {WANTED_COST}"),
            met: cost <= WANTED_COST,
            figures: format!("{cost:.3}; circle {:.3}", mean(median_costs(tables, CIRCLE)?.into_iter())),
        },
        Wanted {
            what: format!("Caged at least {:.0} % of the time in all worlds but one", 100.0 * WANTED_CAGED),
            met: enough + 1 >= worlds.len(),
            figures: format!(
                "in {enough} of {} worlds; least {:.1} %",
                worlds.len(),
                100.0 * caged.iter().copied().fold(1.0, f64::min)
            ),
        },
    ])
}

/// The lines of a transfer's worlds together, one for each scenario trained for.
fn of_unseen(tables: &Tables) -> impl Iterator<Item = &SimulationSummary> {
    tables.simulated.iter().filter(|row| row.transfer == UNSEEN && row.world.is_empty() && row.method == OURS)
}

fn generalises(tables: &Tables) -> Result<Wanted, Missing> {
    let missing = || Missing(format!("simulations of {OURS} in {UNSEEN}"));
    let all = of_unseen(tables).find(|row| row.scenario == TRAINED_IN_ALL).ok_or_else(missing)?;
    let specialists = of_unseen(tables).filter(|row| row.scenario != TRAINED_IN_ALL);
    let best = specialists.min_by(|a, b| a.cost.total_cmp(&b.cost)).ok_or_else(missing)?;
    Ok(Wanted {
        what: format!(
            "Trained in three worlds, caged at least {:.0} % of the time in three others, and better than the best specialist",
            100.0 * WANTED_UNSEEN
        ),
        met: all.caged >= WANTED_UNSEEN && all.cost < best.cost,
        figures: format!(
            "caged {:.1} %, J {:.3}; the best specialist, of {}: {:.1} %, {:.3}",
            100.0 * all.caged,
            all.cost,
            best.scenario,
            100.0 * best.caged,
            best.cost
        ),
    })
}

fn of_laboratory(laboratory: &str, tables: &Tables) -> Result<String, Missing> {
    let (worlds, methods) = (scenarios(tables), methods(tables));
    let seeds = tables.summary(worlds.first().copied().unwrap_or_default(), OURS, Measure::Cost)?.runs;
    let mut text = format!("## Laboratory {laboratory}, {seeds} seeds\n\nCost J of the knee:\n\n| world |");
    methods.iter().for_each(|method| text += &format!(" {method} |"));
    text += &format!("\n|---|{}\n", "---|".repeat(methods.len()));
    for scenario in &worlds {
        let cell = |method: &&str| Ok(cost_words(tables.summary(scenario, method, Measure::Cost)?));
        let cells: Vec<String> = methods.iter().map(cell).collect::<Result<_, Missing>>()?;
        text += &format!("| {scenario} | {} |\n", cells.join(" | "));
    }
    let means = methods.iter().map(|method| Ok(format!("{:.3}", mean(median_costs(tables, method)?.into_iter()))));
    let means: Vec<String> = means.collect::<Result<_, Missing>>()?;
    text += &format!("| mean of the medians | {} |\n\n", means.join(" | "));
    text += "How long targets were caged, and in how many simulations the verdict was \"works\":\n\n| world | method | caged | works |\n|---|---|---|---|\n";
    for scenario in &worlds {
        for method in &methods {
            let row = simulated(tables, scenario, method)?;
            text += &format!("| {scenario} | {method} | {:.1} % | {} |\n", 100.0 * row.caged, row.rate_words());
        }
    }
    text += &format!(
        "\n{OURS} against each baseline, cost J:\n\n| world | baseline | median | of the baseline | A12 | p |\n|---|---|---|---|---|---|\n"
    );
    let costs = || tables.comparisons.iter().filter(|row| row.measure == Measure::Cost && row.method == OURS);
    for row in costs() {
        text += &format!(
            "| {} | {} | {:.3} | {:.3} | {:.2} | {} |\n",
            row.scenario,
            row.baseline,
            row.median,
            row.baseline_median,
            row.a12,
            p_value(row.p_holm)
        );
    }
    let wins: Vec<String> = costs()
        .filter(|row| row.baseline_median < row.median)
        .map(|row| format!("{} in {} ({})", row.baseline, row.scenario, p_value(row.p_holm)))
        .collect();
    text += &match wins.as_slice() {
        [] => "\nNo baseline has the lower median anywhere.\n\n".to_owned(),
        _ => format!("\n**Baselines with the lower median:** {}.\n\n", wins.join("; ")),
    };
    Ok(text + &format!("`docs/adaptive/{laboratory}/`\n\n"))
}

fn cost_words(row: &Summary) -> String {
    row.quartile_words(|value| format!("{value:.3}"))
}

fn unseen(tables: &Tables) -> String {
    let mut text = String::from(
        "## In worlds that no search has seen\n\n| trained for | tested in | caged | in the worst world | J | in the worst world |\n|---|---|---|---|---|---|\n",
    );
    for row in tables.simulated.iter().filter(|row| row.transfer == UNSEEN && row.method == OURS) {
        text += &format!(
            "| {} | {} | {:.1} % | {:.1} % | {:.3} | {:.3} |\n",
            row.scenario,
            if row.world.is_empty() { "all of them" } else { &row.world },
            100.0 * row.caged,
            100.0 * row.worst_caged,
            row.cost,
            row.worst_cost
        );
    }
    text + "\n`docs/adaptive/generalise/`\n\n"
}

/// The picture of the typical run of a method in a world, below `docs/adaptive`.
pub fn picture(laboratory: &str, scenario: &str, method: &str) -> String {
    format!("{laboratory}/{scenario}-{}.svg", method.replace(' ', "-"))
}

fn pictures(laboratories: &[(String, Tables)]) -> String {
    let mut text = String::from("## The swarms\n\nOf each world the run whose knee has the median cost.\n\n");
    for (laboratory, tables) in laboratories {
        text += &format!(
            "![Cost J of the knees in the laboratory {laboratory}](adaptive/{laboratory}/cost-of-knees.svg)\n\n"
        );
        for scenario in scenarios(tables) {
            let file = picture(laboratory, scenario, OURS);
            text += &format!(
                "![{scenario}, laboratory {laboratory}: twelve robots with an evolved knee](adaptive/{file})\n\n"
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(scenario: &str, method: &str, median: f64) -> Summary {
        let (scenario, method) = (scenario.to_owned(), method.to_owned());
        let (lower, upper) = (median - 0.01, median + 0.01);
        Summary { scenario, method, measure: Measure::Cost, runs: 5, feasible: 5, lower, median, upper }
    }

    fn row(scenario: &str, method: &str, transfer: &str, caged: f64, cost: f64) -> SimulationSummary {
        SimulationSummary {
            scenario: scenario.to_owned(),
            method: method.to_owned(),
            transfer: transfer.to_owned(),
            world: String::new(),
            laboratory: "ideal".into(),
            runs: 5,
            worlds: 1,
            realities: 30,
            works: 150,
            rate: 1.0,
            low: Some(0.9),
            high: Some(1.0),
            caged,
            worst_caged: caged,
            cost,
            worst_cost: cost,
        }
    }

    fn comparison(scenario: &str, median: f64, baseline_median: f64) -> Comparison {
        Comparison {
            scenario: scenario.to_owned(),
            measure: Measure::Cost,
            method: OURS.into(),
            baseline: CIRCLE.into(),
            median,
            baseline_median,
            p: 1e-5,
            p_holm: 1e-4,
            a12: 0.9,
        }
    }

    fn tables(costs: &[(&str, [f64; 2], f64)]) -> Tables {
        let mut tables = Tables::default();
        for &(scenario, [ours, circle], caged) in costs {
            tables.summaries.extend([summary(scenario, OURS, ours), summary(scenario, CIRCLE, circle)]);
            tables.simulated.extend([row(scenario, OURS, "", caged, ours), row(scenario, CIRCLE, "", 0.5, circle)]);
            tables.comparisons.push(comparison(scenario, ours, circle));
        }
        tables
    }

    fn generalise([three, specialist]: [f64; 2]) -> Tables {
        let simulated = vec![
            row(TRAINED_IN_ALL, OURS, UNSEEN, 0.95, three),
            row("narrow", OURS, UNSEEN, 0.93, specialist),
            row("corner", OURS, UNSEEN, 0.5, 1.0),
        ];
        Tables { simulated, ..Tables::default() }
    }

    #[test]
    fn what_was_wanted_is_judged_by_the_tables() {
        let good = tables(&[("narrow", [0.1, 0.4], 0.99), ("corner", [0.14, 0.3], 0.9)]);
        let met = |tables: &Tables| wanted(tables).unwrap().iter().map(|row| row.met).collect::<Vec<_>>();
        assert_eq!(met(&good), [true, true, true]);
        let bad = tables(&[("narrow", [0.5, 0.4], 0.9), ("corner", [0.14, 0.3], 0.9)]);
        assert_eq!(met(&bad), [false, false, false]);
        assert!(generalises(&generalise([0.1, 0.2])).unwrap().met);
        assert!(!generalises(&generalise([0.3, 0.2])).unwrap().met);
    }

    #[test]
    fn the_page_says_where_baselines_win() {
        let campaigns = AdaptiveCampaigns {
            laboratories: vec![(
                "ideal".into(),
                tables(&[("columns", [0.2, 0.07], 0.99), ("narrow", [0.1, 0.4], 0.99)]),
            )],
            generalise: generalise([0.1, 0.2]),
        };
        let page = adaptive_report(&campaigns).unwrap();
        assert!(page.contains("**Baselines with the lower median:** circle in columns (p = 0.0001)."), "{page}");
        assert!(page.contains("less in 1 of 2 worlds, in 1 with p < 0.001"), "{page}");
        assert!(page.contains("| columns | 0.200 (0.190 to 0.210) | 0.070 (0.060 to 0.080) |"), "{page}");
    }

    #[test]
    fn a_campaign_without_the_method_is_named() {
        let mut without = tables(&[("narrow", [0.1, 0.4], 0.99)]);
        without.comparisons.clear();
        let missing = wanted(&without).err().map(|missing| missing.to_string()).unwrap_or_default();
        assert!(missing.starts_with("cost J of the knee of closed loop against circle in narrow"), "{missing}");
    }
}
