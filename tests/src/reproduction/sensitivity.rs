//! What the verdicts hang on.

use super::*;

/// The table of variations: what each does to the paper's central claims.
pub(super) fn section(tables: &Tables) -> Result<String, Missing> {
    let runs = tables.summary(CHANNEL, ALL, Measure::BestF2)?.runs;
    let mut text = format!(
        "## How the verdicts change with what the paper leaves open\n\n\
         One number at a time, {runs} seeds a method and half of the paper's budgets. \"World\" scales region, path and walls \
         while the model's lengths stay, so channels get narrower or wider. A printed model passes (yes) if it is feasible \
         at every snapshot.\n\n\
         | changed | NAND-XNOR, channel | NAND-XNOR, two targets | EH-GRN 1 leaks with two targets | A, compound | B, compound | \
         B better than A | EH-GRN 2, compound | MOGP feasible (channel, compound) | EH-GRN 1, 2 feasible in compound | \
         A12 of best f2, compound, against EH-GRN 1, 2 |\n|---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    let scenarios = tables.summaries.iter().filter(|row| row.method == ALL && row.measure == Measure::BestF2);
    for compound in scenarios.filter_map(|row| row.scenario.strip_prefix(COMPOUND).map(|_| &row.scenario)) {
        let change = compound.strip_prefix(COMPOUND).unwrap_or_default();
        let (channel, two) = (format!("{CHANNEL}{change}"), format!("two targets{change}"));
        let passes =
            |world: &str, model: &str| -> Result<bool, Missing> { Ok(tables.transfer(world, "", model)?.rate == 1.0) };
        let words = |yes: bool| if yes { "yes" } else { "no" };
        let (a, b) = (tables.transfer(compound, "", ANDN_XNOR)?, tables.transfer(compound, "", ANDN_NAND_XNOR)?);
        let feasible = |scenario: &str, method: &str| -> Result<String, Missing> {
            let row = tables.summary(scenario, method, Measure::BestF2)?;
            Ok(format!("{}/{}", row.feasible, row.runs))
        };
        let a12 = |baseline: &str| -> Result<String, Missing> {
            Ok(format!("{:.2}", tables.comparison(compound, ALL, baseline, Measure::BestF2)?.a12))
        };
        let cells = [
            if change.is_empty() { "nothing".into() } else { change.trim_start_matches(", ").to_owned() },
            words(passes(&channel, NAND_XNOR)?).into(),
            words(passes(&two, NAND_XNOR)?).into(),
            words(!passes(&two, PRINTED_EH_1)?).into(),
            words(a.rate == 1.0).into(),
            words(b.rate == 1.0).into(),
            words(b.median_f2 < a.median_f2).into(),
            words(passes(compound, PRINTED_EH_2)?).into(),
            format!("{}, {}", feasible(&channel, ALL)?, feasible(compound, ALL)?),
            format!("{}, {}", feasible(compound, EH_1)?, feasible(compound, EH_2)?),
            format!("{}, {}", a12(EH_1)?, a12(EH_2)?),
        ];
        text += &format!("| {} |\n", cells.join(" | "));
    }
    Ok(text + "\n`docs/reproduction/sensitivity/`\n\n")
}

/// What other numbers of DE generations do.
pub(super) fn generations(tables: &Tables) -> String {
    let mut text = String::from(
        "## DE generations an individual gets\n\nThe budget is the same, so more generations mean fewer structures.\n\n\
         | scenario | DE | feasible | best f2 | knee f2 | nodes of the knee | hypervolume |\n|---|---|---|---|---|---|---|\n",
    );
    for row in tables.summaries.iter().filter(|row| row.measure == Measure::BestF2) {
        let measures = [Measure::BestF2, Measure::KneeF2, Measure::KneeNodes, Measure::Hypervolume];
        let cells: Vec<String> = measures
            .iter()
            .filter_map(|&measure| tables.summary(&row.scenario, &row.method, measure).ok())
            .map(quartiles)
            .collect();
        text +=
            &format!("| {} | {} | {}/{} | {} |\n", row.scenario, row.method, row.feasible, row.runs, cells.join(" | "));
    }
    text + "\n`docs/reproduction/de-generations/summary.csv`\n\n"
}
