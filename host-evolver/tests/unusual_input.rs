//! Input that is unusual but right, and a search that finds nothing.

mod support;

use std::path::PathBuf;
use std::process::Command;
use support::Outcome;
use support::desk::{CAMPAIGN, Desk, WORLD, edited};

/// Names that would lead out of `runs/`, or to no file at all, become safe file names; the true name stays in the tables.
#[test]
fn name_leaves_runs_and_long_name_late() -> Outcome {
    for name in ["../../x", "/tmp/x", "a/../../b", "CON", ".hidden", "x ", &"y".repeat(300)] {
        let desk = Desk::new()?;
        let above = desk.path("a/b");
        std::fs::create_dir_all(&above)?;
        std::fs::write(desk.path("world.toml"), edited(WORLD, "\"world\"", &format!("{name:?}")))?;
        let named = edited(CAMPAIGN, "\"campaign\"", &format!("{name:?}")).replace("\"e\"", &format!("{name:?}"));
        let named = named.split("[[model]]").next().unwrap_or_default().replace("world.toml", "../../world.toml");
        std::fs::write(above.join("campaign.toml"), named)?;
        let mut command = Command::new(env!("CARGO_BIN_EXE_grn"));
        let output = command.args(["campaign", "campaign.toml"]).current_dir(&above).output()?;
        assert_eq!(output.status.code(), Some(0), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        let runs: Vec<_> = std::fs::read_dir(above.join("runs"))?.collect::<Result<Vec<_>, _>>()?;
        assert_eq!(runs.len(), 1, "{name}");
        let results = std::fs::read_to_string(runs[0].path().join("results.csv"))?;
        assert!(results.contains(name), "{name} is not in {results}");
        let names = |folder: PathBuf| -> std::io::Result<usize> { Ok(std::fs::read_dir(folder)?.count()) };
        assert_eq!((names(above)?, names(desk.path("a"))?, names(desk.path(""))?), (2, 1, 4), "{name} leads out");
    }
    Ok(())
}

#[test]
fn an_infeasible_run_ends_with_one_and_its_reason() -> Outcome {
    let desk = Desk::new()?;
    // A channel 8 cm wide: whatever is in it is nearer than 5 cm to a wall.
    let narrow = edited(WORLD, "[6.0, 14.0], [14.0, 14.0]", "[6.0, 10.04], [14.0, 10.04]");
    let narrow = edited(&narrow, "[14.0, 6.0], [6.0, 6.0]", "[14.0, 9.96], [6.0, 9.96]");
    std::fs::write(desk.path("world.toml"), narrow)?;
    let output = desk.grn(&["evolve", "world.toml", "--out", "o", "--paper", "--evaluations", "800"])?;
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}{}", String::from_utf8_lossy(&output.stderr));
    let line = said.lines().find(|line| line.starts_with("infeasible: ")).unwrap_or_default();
    assert!(line.contains("loses a target at") || line.contains("too near to a wall"), "{said}");
    assert!(desk.path("o/front.csv").exists());
    Ok(())
}

#[test]
fn marks_of_byte_order_and_pipes_are_taken() -> Outcome {
    let desk = Desk::new()?;
    for name in ["world.toml", "campaign.toml"] {
        let marked = format!("\u{feff}{}", std::fs::read_to_string(desk.path(name))?.replace("seeds = 1", "seeds = 0"));
        std::fs::write(desk.path(name), marked)?;
    }
    desk.refuses(&["campaign", "campaign.toml"], &["campaign.toml:2:9: seeds = 0: "], "a marked campaign")?;
    assert_eq!(desk.grn(&["draw", "blob.grn", "world.toml", "--json"])?.status.code(), Some(0));
    if cfg!(unix) {
        let shell = |script: &str| {
            Command::new("sh").args(["-c", script, env!("CARGO_BIN_EXE_grn")]).current_dir(desk.path("")).output()
        };
        let evaluated = shell("printf '\\357\\273\\2770.5,0.25\\r\\n0,0\\n' | \"$0\" eval blob.grn")?;
        assert_eq!(String::from_utf8_lossy(&evaluated.stdout).lines().count(), 2, "{evaluated:?}");
        let endless = shell("head -c 100000000 /dev/zero | tr '\\0' 1 | \"$0\" eval blob.grn")?;
        let message = String::from_utf8_lossy(&endless.stderr).into_owned();
        assert!(endless.status.code() == Some(2) && message.contains("line 1: "), "{message}");
        let shown = shell("cat blob.grn | \"$0\" show /dev/stdin")?;
        assert!(String::from_utf8_lossy(&shown.stdout).contains("95 bytes"), "{shown:?}");
    }
    Ok(())
}
