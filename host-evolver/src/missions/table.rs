//! The table of a folder of missions.

use super::difficulty::Difficulty;
use crate::files::{FileError, read_csv};
use firmware_sim::missions::Mission;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Its name in the folder.
pub const TABLE: &str = "missions.csv";

/// A line of it: a mission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MissionRow {
    /// The file of its world, in the same folder.
    pub file: String,
    /// Its class.
    pub class: String,
    /// What determines all of it but its name, together with the options that it was drawn with.
    pub seed: u64,
    /// How many targets it has.
    pub targets: usize,
    /// How many robots it is for.
    pub robots: usize,
    /// Whether walls stop their radio.
    pub walls_block_radio: bool,
    /// Whether obstacles move.
    pub moving: bool,
    /// No wall is ever nearer to the path of a target, metres.
    pub clearance_m: f64,
    /// Radius of the best circle, metres.
    pub circle_radius_m: f64,
    /// Its f2, as of the nearest target.
    pub circle_f2: f64,
    /// f2 of the best star-shaped pattern.
    pub star_f2: f64,
    /// By how much that is less than the circle's.
    pub difficulty: f64,
}

impl MissionRow {
    /// The line of a mission.
    pub fn of(mission: &Mission, difficulty: &Difficulty) -> MissionRow {
        let digits = |value: f64| (value * 1e6).round() / 1e6;
        MissionRow {
            file: mission.file(),
            class: mission.class.name().to_owned(),
            seed: mission.seed,
            targets: mission.scenario.targets().len(),
            robots: mission.robots,
            walls_block_radio: mission.walls_block,
            moving: mission.scenario.walls_change(),
            clearance_m: mission.clearance,
            circle_radius_m: digits(difficulty.circle_radius),
            circle_f2: digits(difficulty.circle_f2),
            star_f2: digits(difficulty.star_f2),
            difficulty: digits(difficulty.gain()),
        }
    }

    /// The missions of a folder, in the order of its table.
    ///
    /// # Errors
    /// A folder without a table, or whose table is none.
    pub fn read_all(folder: &Path) -> Result<Vec<MissionRow>, FileError> {
        let path = folder.join(TABLE);
        if !path.exists() {
            let fault = format!("it has no {TABLE}; name a folder that grn missions has filled to its end");
            return Err(FileError::new(folder, fault));
        }
        let rows: Vec<MissionRow> = read_csv(&path)?;
        if rows.is_empty() {
            return Err(FileError::new(path, "has no mission; draw some with grn missions"));
        }
        let is_name =
            |row: &&MissionRow| Path::new(&row.file).file_name().is_some_and(|name| name == row.file.as_str());
        match rows.iter().find(|row| !is_name(row)) {
            Some(row) => Err(FileError::new(path, format!("file {:?} is no name of a file in the folder", row.file))),
            None => Ok(rows),
        }
    }
}
