//! Writes `docs/reproduction.md` and the files behind it from the folders of the three campaigns.
//!
//! Arguments: the folders of `campaigns/paper.toml`, `campaigns/sensitivity.toml` and `campaigns/de-generations.toml`.

use grn_tests::reproduction::{Campaigns, report};
use host_evolver::campaign::Campaign;
use host_evolver::files;
use std::error::Error;
use std::path::{Path, PathBuf};

const TABLES: [&str; 4] = ["results.csv", "summary.csv", "comparisons.csv", "transfers.csv"];
const FIGURES: [&str; 4] = ["f2-of-knees.svg", "nodes-of-knees.svg", "convergence.svg", "transfers.svg"];
const TYPICAL: [&str; 4] = ["pareto.svg", "tree.svg", "grn.svg", "pattern.svg"];

fn main() -> Result<(), Box<dyn Error>> {
    let folders: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
    let [paper, sensitivity, de] = folders.as_slice() else {
        return Err("three folders are needed: of the campaigns paper, sensitivity and de-generations".into());
    };
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let keep = docs.join("reproduction");
    for (folder, name) in [(paper, "paper"), (sensitivity, "sensitivity"), (de, "de-generations")] {
        for table in TABLES {
            files::write(&keep.join(name).join(table), std::fs::read(folder.join(table))?)?;
        }
    }
    for figure in FIGURES {
        files::write(&keep.join(figure), std::fs::read(paper.join(figure))?)?;
    }
    for scenario in ["channel", "compound-channel"] {
        for method in ["mogp-binary-motifs", "mogp-all-motifs", "eh-grn-structure-1", "eh-grn-structure-2"] {
            for figure in TYPICAL {
                let from = paper.join("typical").join(scenario).join(method).join(figure);
                if from.exists() {
                    files::write(&keep.join(format!("{scenario}-{method}-{figure}")), std::fs::read(from)?)?;
                }
            }
        }
    }
    let campaigns = Campaigns {
        paper: Campaign::tables(paper)?,
        sensitivity: Campaign::tables(sensitivity)?,
        de: Campaign::tables(de)?,
    };
    files::write(&docs.join("reproduction.md"), report(&campaigns)?)?;
    println!("docs/reproduction.md is written");
    Ok(())
}
