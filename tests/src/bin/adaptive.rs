//! Writes `docs/adaptive.md` and the files behind it from the folders of campaigns.
//!
//! Arguments: the folder of `campaigns/generalise.toml`, then those of the campaigns that compare methods, one for each
//! laboratory.

use grn_tests::reproduction::adaptive::{AdaptiveCampaigns, adaptive_report, picture, scenarios};
use host_evolver::campaign::{Campaign, Tables};
use host_evolver::files;
use std::error::Error;
use std::path::{Path, PathBuf};

const TABLES: [&str; 4] = ["results.csv", "summary.csv", "comparisons.csv", "simulation-summary.csv"];
const OF_GENERALISE: [&str; 2] = ["results.csv", "simulation-summary.csv"];
/// The folder of the method whose swarms are shown.
const SHOWN: &str = "closed-loop";

fn main() -> Result<(), Box<dyn Error>> {
    let folders: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
    let Some((generalise, compared)) = folders.split_first().filter(|(_, compared)| !compared.is_empty()) else {
        return Err("folders are needed: of the campaign generalise, and of at least one that compares methods".into());
    };
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let keep = docs.join("adaptive");
    for table in OF_GENERALISE {
        files::write(&keep.join("generalise").join(table), std::fs::read(generalise.join(table))?)?;
    }
    let mut laboratories = Vec::new();
    for folder in compared {
        let tables = Campaign::tables(folder)?;
        let laboratory = tables.simulated.first().map(|row| row.laboratory.clone());
        let laboratory = laboratory.ok_or_else(|| format!("{}: no knee was simulated", folder.display()))?;
        for file in TABLES.into_iter().chain(["cost-of-knees.svg"]) {
            files::write(&keep.join(&laboratory).join(file), std::fs::read(folder.join(file))?)?;
        }
        copy_swarms(folder, &keep, &laboratory, &tables)?;
        laboratories.push((laboratory, tables));
    }
    let campaigns = AdaptiveCampaigns { laboratories, generalise: Campaign::tables(generalise)? };
    files::write(&docs.join("adaptive.md"), adaptive_report(&campaigns)?)?;
    println!("docs/adaptive.md is written");
    Ok(())
}

fn copy_swarms(folder: &Path, keep: &Path, laboratory: &str, tables: &Tables) -> Result<(), Box<dyn Error>> {
    for scenario in scenarios(tables) {
        let from = folder.join("typical").join(scenario).join(SHOWN).join("trace.svg");
        files::write(&keep.join(picture(laboratory, scenario, SHOWN)), std::fs::read(from)?)?;
    }
    Ok(())
}
