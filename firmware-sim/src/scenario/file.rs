//! The TOML file as it stands, and the checks that make it a [`Scenario`].

use super::limits::{self, DURATION};
use super::obstacles::Obstacles;
use super::tables::{DiscTable, EvasionTable, StartTable, SwarmTable, TargetTable, WallTable};
use super::targets::checked_targets;
use super::timing::check_course;
use super::{MeantSwarm, Morphogen, Ring, Scenario, Start};
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
    #[serde(default, skip_serializing_if = "Option::is_none")]
    swarm: Option<SwarmTable>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start: Option<StartTable>,
    #[serde(default, rename = "target")]
    targets: Vec<TargetTable>,
    #[serde(default, rename = "wall", skip_serializing_if = "Vec::is_empty")]
    walls: Vec<WallTable>,
    #[serde(default, rename = "disc", skip_serializing_if = "Vec::is_empty")]
    discs: Vec<DiscTable>,
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
        let ScenarioFile { name, region, snapshots, duration_s, morphogen, ring, swarm, start, targets, walls, discs } =
            file;
        let Pair(region) = region;
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
        let meant_swarm = swarm.as_ref().map(MeantSwarm::checked).transpose()?;
        let obstacles = Obstacles::checked(walls, discs, region, snapshots)?;
        let targets = checked_targets(targets, region, &obstacles)?;
        let Obstacles { fixed: fixed_walls, fixed_discs, moving: moving_walls, .. } = obstacles;
        let mut scenario = Scenario {
            name,
            region,
            snapshots,
            duration_s,
            morphogen,
            ring,
            meant_swarm,
            start: None,
            targets,
            fixed_walls,
            fixed_discs,
            moving_walls,
        };
        limits::check_changing_walls(&scenario)?;
        check_course(&scenario)?;
        let at_start = |table| Start::checked(table, region, &scenario.walls_at(0.0));
        scenario.start = start.map(at_start).transpose()?;
        Ok(scenario)
    }
}

impl From<Scenario> for ScenarioFile {
    fn from(scenario: Scenario) -> ScenarioFile {
        let Morphogen { kernel, target_width, obstacle_width, level } = scenario.morphogen;
        let Ring { d_min, d_max, d_obstacle, steepness } = scenario.ring;
        let mut walls: Vec<WallTable> =
            scenario.fixed_polygons().iter().map(|polygon| WallTable::fixed(polygon.vertices())).collect();
        let mut discs: Vec<DiscTable> = scenario.fixed_discs.iter().map(DiscTable::fixed).collect();
        for wall in &scenario.moving_walls {
            match &wall.disc {
                None => walls.insert(wall.place.min(walls.len()), WallTable::moving(wall)),
                Some(disc) => discs.insert(wall.place.min(discs.len()), DiscTable::moving(disc, wall)),
            }
        }
        ScenarioFile {
            name: scenario.name,
            region: Pair(scenario.region),
            snapshots: i64::try_from(scenario.snapshots).unwrap_or(i64::MAX),
            duration_s: scenario.duration_s,
            morphogen: MorphogenTable { kernel, target_width, obstacle_width, level },
            ring: RingTable { d_min, d_max, d_obstacle, steepness },
            swarm: scenario.meant_swarm.as_ref().map(SwarmTable::of),
            start: scenario.start.as_ref().map(StartTable::of),
            targets: scenario.targets.iter().map(TargetTable::of).collect(),
            walls,
            discs,
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
        if let Some(SwarmTable { robots, mothers, walls_block_radio }) = self.swarm {
            let mothers = mothers.map_or(String::new(), |mothers| format!("mothers = {mothers}\n"));
            let radio = walls_block_radio.map_or(String::new(), |block| format!("walls_block_radio = {block}\n"));
            let _ = write!(text, "\n[swarm]\nrobots = {robots}\n{mothers}{radio}");
        }
        if let Some(StartTable { centre, radius, positions }) = &self.start {
            let centre = centre.as_ref().map_or(String::new(), |Pair(centre)| format!("centre = {centre:?}\n"));
            let radius = radius.map_or(String::new(), |radius| format!("radius = {radius:?}\n"));
            let positions = pairs("positions", positions.as_deref().unwrap_or_default());
            let _ = write!(text, "\n[start]\n{centre}{radius}{positions}");
        }
        for TargetTable { path, times, present, evade } in &self.targets {
            let evade = evade.map_or(String::new(), |EvasionTable { distance, reach, speed }| {
                format!("evade = {{ distance = {distance:?}, reach = {reach:?}, speed = {speed:?} }}\n")
            });
            let lines = [pairs("path", path), numbers("times", times), pairs("present", present), evade];
            let _ = write!(text, "\n[[target]]\n{}", lines.concat());
        }
        for WallTable { polygon, path, turn_deg, times, present } in &self.walls {
            let motion = [pairs("path", path), numbers("turn_deg", turn_deg), numbers("times", times)];
            let lines = [pairs("polygon", polygon), motion.concat(), pairs("present", present)];
            let _ = write!(text, "\n[[wall]]\n{}", lines.concat());
        }
        for DiscTable { centre: Pair(centre), radius, path, times, present } in &self.discs {
            let lines = [pairs("path", path), numbers("times", times), pairs("present", present)];
            let _ = write!(text, "\n[[disc]]\ncentre = {centre:?}\nradius = {radius:?}\n{}", lines.concat());
        }
        text
    }
}
