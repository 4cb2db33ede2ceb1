//! The TOML file as it stands, and the checks that make it a [`Scenario`].

use super::limits::{self, DURATION};
use super::tables::{TargetTable, WallTable};
use super::things::{checked_targets, checked_walls};
use super::timing::check_course;
use super::{Morphogen, Ring, Scenario};
use core::fmt::Write;
use grn_core::field::Kernel;
use grn_input::{InputError, Pair, check_name};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScenarioFile {
    name: String,
    region: Pair,
    snapshots: i64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    duration_s: Option<f64>,
    morphogen: MorphogenTable,
    ring: RingTable,
    #[serde(default, rename = "target")]
    targets: Vec<TargetTable>,
    #[serde(default, rename = "wall", skip_serializing_if = "Vec::is_empty")]
    walls: Vec<WallTable>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MorphogenTable {
    kernel: Kernel,
    target_width: f64,
    obstacle_width: f64,
    level: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RingTable {
    d_min: f64,
    d_max: f64,
    d_obstacle: f64,
    steepness: f64,
}

impl TryFrom<ScenarioFile> for Scenario {
    type Error = InputError;

    fn try_from(file: ScenarioFile) -> Result<Scenario, InputError> {
        let ScenarioFile { name, region: Pair(region), snapshots, duration_s, morphogen, ring, targets, walls } = file;
        check_name("name", &name)?;
        if let Some(duration_s) = duration_s {
            DURATION.check("duration_s", duration_s)?;
        }
        let snapshots = limits::check_region(region, snapshots)?;
        let MorphogenTable { kernel, target_width, obstacle_width, level } = morphogen;
        let morphogen = Morphogen { kernel, target_width, obstacle_width, level };
        limits::check_morphogen(&morphogen)?;
        let RingTable { d_min, d_max, d_obstacle, steepness } = ring;
        let ring = Ring { d_min, d_max, d_obstacle, steepness };
        limits::check_ring(&ring, region)?;
        let (fixed_walls, moving_walls) = checked_walls(walls, region, snapshots)?;
        let targets = checked_targets(targets, region, &fixed_walls)?;
        let scenario =
            Scenario { name, region, snapshots, duration_s, morphogen, ring, targets, fixed_walls, moving_walls };
        limits::check_changing_walls(&scenario)?;
        check_course(&scenario)?;
        Ok(scenario)
    }
}

impl From<Scenario> for ScenarioFile {
    fn from(scenario: Scenario) -> ScenarioFile {
        let Morphogen { kernel, target_width, obstacle_width, level } = scenario.morphogen;
        let Ring { d_min, d_max, d_obstacle, steepness } = scenario.ring;
        let mut walls: Vec<WallTable> =
            scenario.fixed_walls.fixed().iter().map(|polygon| WallTable::fixed(polygon.vertices())).collect();
        for wall in &scenario.moving_walls {
            walls.insert(wall.place.min(walls.len()), WallTable::moving(wall));
        }
        ScenarioFile {
            name: scenario.name,
            region: Pair(scenario.region),
            snapshots: i64::try_from(scenario.snapshots).unwrap_or(i64::MAX),
            duration_s: scenario.duration_s,
            morphogen: MorphogenTable { kernel, target_width, obstacle_width, level },
            ring: RingTable { d_min, d_max, d_obstacle, steepness },
            targets: scenario.targets.iter().map(TargetTable::of).collect(),
            walls,
        }
    }
}

impl ScenarioFile {
    /// Text in the layout of the scenarios a person writes: one line a path or polygon, shortest exact numbers.
    pub(super) fn to_toml(&self) -> String {
        let mut text = String::new();
        let name = toml::Value::String(self.name.clone());
        let MorphogenTable { target_width, obstacle_width, level, .. } = self.morphogen;
        let RingTable { d_min, d_max, d_obstacle, steepness } = self.ring;
        let duration = self.duration_s.map_or(String::new(), |seconds| format!("duration_s = {seconds:?}\n"));
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "name = {name}\nregion = {:?}\nsnapshots = {}\n{duration}\n\
             [morphogen]\nkernel = \"{}\"\ntarget_width = {target_width:?}\nobstacle_width = {obstacle_width:?}\n\
             level = {level:?}\n\n\
             [ring]\nd_min = {d_min:?}\nd_max = {d_max:?}\nd_obstacle = {d_obstacle:?}\nsteepness = {steepness:?}\n",
            self.region.0,
            self.snapshots,
            self.morphogen.kernel.name(),
        );
        let pairs = |key: &str, pairs: &[Pair]| {
            let pairs: Vec<[f64; 2]> = pairs.iter().map(|pair| pair.0).collect();
            if pairs.is_empty() { String::new() } else { format!("{key} = {pairs:?}\n") }
        };
        let numbers = |key: &str, numbers: &[f64]| {
            if numbers.is_empty() { String::new() } else { format!("{key} = {numbers:?}\n") }
        };
        for TargetTable { path, times, present } in &self.targets {
            let lines = [pairs("path", path), numbers("times", times), pairs("present", present)];
            let _ = write!(text, "\n[[target]]\n{}", lines.concat());
        }
        for WallTable { polygon, path, turn_deg, times, present } in &self.walls {
            let motion = [pairs("path", path), numbers("turn_deg", turn_deg), numbers("times", times)];
            let lines = [pairs("polygon", polygon), motion.concat(), pairs("present", present)];
            let _ = write!(text, "\n[[wall]]\n{}", lines.concat());
        }
        text
    }
}
