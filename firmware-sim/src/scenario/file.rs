//! The TOML file as it stands, and the checks that make it a [`Scenario`].

use super::{MAX_SNAPSHOTS, Morphogen, Path, Ring, Scenario, ScenarioError};
use crate::geometry::{Polygon, PolygonError, Walls};
use core::fmt::Write;
use grn_core::field::Kernel;
use grn_core::geometry::{Point, Vector};
use grn_core::robot::percept::MAX_TARGETS;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScenarioFile {
    name: String,
    region: [f64; 2],
    snapshots: i64,
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
    kernel: KernelName,
    target_width: f64,
    obstacle_width: f64,
    level: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum KernelName {
    Gaussian,
    Exponential,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RingTable {
    d_min: f64,
    d_max: f64,
    d_obstacle: f64,
    steepness: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TargetTable {
    path: Vec<[f64; 2]>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WallTable {
    polygon: Vec<[f64; 2]>,
}

/// `right` must hold for a finite `value`.
fn check(place: &str, value: f64, right: bool, expected: &str) -> Result<(), ScenarioError> {
    if value.is_finite() && right { Ok(()) } else { Err(ScenarioError::new(place, value, expected)) }
}

fn point([x, y]: [f64; 2]) -> Point<f64> {
    Vector::new(x, y)
}

impl TryFrom<ScenarioFile> for Scenario {
    type Error = ScenarioError;

    fn try_from(file: ScenarioFile) -> Result<Scenario, ScenarioError> {
        let ScenarioFile { name, region, snapshots, morphogen, ring, targets, walls } = file;
        for (index, side) in region.into_iter().enumerate() {
            check(&format!("region[{index}]"), side, side > 0.0, "must be a positive length in metres")?;
        }
        let snapshots =
            usize::try_from(snapshots).ok().filter(|count| (1..=MAX_SNAPSHOTS).contains(count)).ok_or_else(|| {
                ScenarioError::new("snapshots", snapshots, format!("must be a whole number in 1..={MAX_SNAPSHOTS}"))
            })?;
        let walls = checked_walls(walls)?;
        Ok(Scenario {
            name,
            region,
            snapshots,
            morphogen: checked_morphogen(morphogen)?,
            ring: checked_ring(ring)?,
            targets: checked_targets(targets, &walls)?,
            walls,
        })
    }
}

fn checked_morphogen(table: MorphogenTable) -> Result<Morphogen, ScenarioError> {
    let MorphogenTable { kernel, target_width, obstacle_width, level } = table;
    check("morphogen.target_width", target_width, target_width > 0.0, "must be a positive length in metres")?;
    check("morphogen.obstacle_width", obstacle_width, obstacle_width > 0.0, "must be a positive length in metres")?;
    check("morphogen.level", level, level > 0.0 && level < 1.0, "must lie between 0 and 1, both excluded")?;
    let kernel = match kernel {
        KernelName::Gaussian => Kernel::Gaussian,
        KernelName::Exponential => Kernel::Exponential,
    };
    Ok(Morphogen { kernel, target_width, obstacle_width, level })
}

fn checked_ring(table: RingTable) -> Result<Ring, ScenarioError> {
    let RingTable { d_min, d_max, d_obstacle, steepness } = table;
    check("ring.d_min", d_min, d_min >= 0.0, "must be at least 0 metres")?;
    check("ring.d_max", d_max, d_max > d_min, &format!("must be above d_min = {d_min} and finite"))?;
    check("ring.d_obstacle", d_obstacle, d_obstacle >= 0.0, "must be at least 0 metres")?;
    check("ring.steepness", steepness, steepness > 0.0, "must be positive, per metre")?;
    Ok(Ring { d_min, d_max, d_obstacle, steepness })
}

fn checked_walls(tables: Vec<WallTable>) -> Result<Walls, ScenarioError> {
    let mut polygons = Vec::with_capacity(tables.len());
    for (index, table) in tables.into_iter().enumerate() {
        let vertices = table.polygon;
        let polygon = Polygon::new(vertices.iter().copied().map(point).collect()).map_err(|error| {
            let place = format!("wall[{index}].polygon");
            let at = |vertex: usize| format!("{:?}", vertices.get(vertex).copied().unwrap_or_default());
            match error {
                PolygonError::TooFewVertices(count) => {
                    ScenarioError::new(place, format!("{count} points"), "a polygon needs at least 3 points")
                }
                PolygonError::NotFinite(vertex) => {
                    ScenarioError::new(format!("{place}[{vertex}]"), at(vertex), "coordinates must be finite")
                }
                PolygonError::RepeatedVertex(vertex) => ScenarioError::new(
                    format!("{place}[{vertex}]"),
                    at(vertex),
                    "must differ from the next point (the last point is joined to the first by itself)",
                ),
                PolygonError::SelfIntersecting(a, b) => ScenarioError::new(
                    place,
                    format!("edges from point {a} {} and point {b} {} meet", at(a), at(b)),
                    "the outline must not cross or touch itself",
                ),
                PolygonError::NoArea => ScenarioError::new(place, "encloses no area", "points must not lie on a line"),
            }
        })?;
        polygons.push(polygon);
    }
    Ok(Walls::new(polygons))
}

fn checked_targets(tables: Vec<TargetTable>, walls: &Walls) -> Result<Vec<Path>, ScenarioError> {
    if !(1..=MAX_TARGETS).contains(&tables.len()) {
        let expected = format!("a scenario has 1 to {MAX_TARGETS} [[target]] tables");
        return Err(ScenarioError::new("target", format!("{} of them", tables.len()), expected));
    }
    let mut paths = Vec::with_capacity(tables.len());
    for (target, table) in tables.into_iter().enumerate() {
        if table.path.is_empty() {
            return Err(ScenarioError::new(format!("target[{target}].path"), "[]", "a path needs at least 1 point"));
        }
        let mut points: Vec<Point<f64>> = Vec::with_capacity(table.path.len());
        for (index, raw) in table.path.into_iter().enumerate() {
            let fault =
                |expected| ScenarioError::new(format!("target[{target}].path[{index}]"), format!("{raw:?}"), expected);
            let here = point(raw);
            if !(here.x.is_finite() && here.y.is_finite()) {
                return Err(fault("coordinates must be finite".to_owned()));
            }
            if let Some(wall) = walls.containing(here) {
                return Err(fault(format!("must lie outside the walls, but is inside wall[{wall}]")));
            }
            if let Some(&before) = points.last()
                && let Some(direction) = (here - before).direction()
                && walls.ray(before, direction, (here - before).length()).is_some()
            {
                return Err(fault("the straight way from the point before it meets a wall".to_owned()));
            }
            points.push(here);
        }
        paths.push(Path::new(points));
    }
    Ok(paths)
}

impl From<Scenario> for ScenarioFile {
    fn from(scenario: Scenario) -> ScenarioFile {
        let raw = |points: &[Point<f64>]| points.iter().map(|p| [p.x, p.y]).collect();
        let Morphogen { kernel, target_width, obstacle_width, level } = scenario.morphogen;
        let Ring { d_min, d_max, d_obstacle, steepness } = scenario.ring;
        let kernel = match kernel {
            Kernel::Gaussian => KernelName::Gaussian,
            Kernel::Exponential => KernelName::Exponential,
        };
        ScenarioFile {
            name: scenario.name,
            region: scenario.region,
            snapshots: i64::try_from(scenario.snapshots).unwrap_or(i64::MAX),
            morphogen: MorphogenTable { kernel, target_width, obstacle_width, level },
            ring: RingTable { d_min, d_max, d_obstacle, steepness },
            targets: scenario.targets.iter().map(|path| TargetTable { path: raw(path.points()) }).collect(),
            walls: scenario.walls.polygons().iter().map(|p| WallTable { polygon: raw(p.vertices()) }).collect(),
        }
    }
}

impl ScenarioFile {
    /// Text in the layout of the scenarios a person writes: one line a path or polygon, shortest exact numbers.
    pub(super) fn to_toml(&self) -> String {
        let mut text = String::new();
        let kernel = match self.morphogen.kernel {
            KernelName::Gaussian => Kernel::Gaussian,
            KernelName::Exponential => Kernel::Exponential,
        };
        let name = toml::Value::String(self.name.clone());
        let MorphogenTable { target_width, obstacle_width, level, .. } = self.morphogen;
        let RingTable { d_min, d_max, d_obstacle, steepness } = self.ring;
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "name = {name}\nregion = {:?}\nsnapshots = {}\n\n\
             [morphogen]\nkernel = \"{}\"\ntarget_width = {target_width:?}\nobstacle_width = {obstacle_width:?}\n\
             level = {level:?}\n\n\
             [ring]\nd_min = {d_min:?}\nd_max = {d_max:?}\nd_obstacle = {d_obstacle:?}\nsteepness = {steepness:?}\n",
            self.region,
            self.snapshots,
            kernel.name(),
        );
        for TargetTable { path } in &self.targets {
            let _ = write!(text, "\n[[target]]\npath = {path:?}\n");
        }
        for WallTable { polygon } in &self.walls {
            let _ = write!(text, "\n[[wall]]\npolygon = {polygon:?}\n");
        }
        text
    }
}
