//! The TOML file as it stands, and the checks that make it a [`Scenario`].

use super::limits::{self, MAX_POINTS, WALL_OVERHANG};
use super::{Morphogen, Path, Ring, Scenario};
use crate::geometry::{Polygon, PolygonError, Walls};
use core::fmt::Write;
use grn_core::field::Kernel;
use grn_core::geometry::{Point, Vector};
use grn_core::robot::percept::MAX_TARGETS;
use grn_input::{InputError, Pair, Range, check_name};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScenarioFile {
    name: String,
    region: Pair,
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

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TargetTable {
    path: Vec<Pair>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WallTable {
    polygon: Vec<Pair>,
}

/// A point that must lie in the region, or at most `overhang` metres beside it.
fn checked_point(key: &str, Pair([x, y]): Pair, region: [f64; 2], overhang: f64) -> Result<Point<f64>, InputError> {
    let holds = |value: f64, side: f64| Range::new(-overhang, side + overhang, "").holds(value);
    if holds(x, region[0]) && holds(y, region[1]) {
        return Ok(Vector::new(x, y));
    }
    let [east, north] = region;
    let expected = if overhang > 0.0 {
        format!(
            "must be finite and at most {overhang} metres outside the region, {east:?} x {north:?} metres from [0, 0]"
        )
    } else {
        format!("must lie in the region, {east:?} x {north:?} metres from [0, 0]; move it, or make the region larger")
    };
    Err(InputError::new(key, format!("[{x:?}, {y:?}]"), expected))
}

impl TryFrom<ScenarioFile> for Scenario {
    type Error = InputError;

    fn try_from(file: ScenarioFile) -> Result<Scenario, InputError> {
        let ScenarioFile { name, region: Pair(region), snapshots, morphogen, ring, targets, walls } = file;
        check_name("name", &name)?;
        let snapshots = limits::check_region(region, snapshots)?;
        let MorphogenTable { kernel, target_width, obstacle_width, level } = morphogen;
        let morphogen = Morphogen { kernel, target_width, obstacle_width, level };
        limits::check_morphogen(&morphogen)?;
        let RingTable { d_min, d_max, d_obstacle, steepness } = ring;
        let ring = Ring { d_min, d_max, d_obstacle, steepness };
        limits::check_ring(&ring, region)?;
        let walls = checked_walls(walls, region, snapshots)?;
        let targets = checked_targets(targets, region, &walls)?;
        Ok(Scenario { name, region, snapshots, morphogen, ring, targets, walls })
    }
}

fn too_many(key: &str, count: usize) -> InputError {
    InputError::new(key, format!("{count} points"), format!("at most {MAX_POINTS} points are allowed; simplify it"))
}

fn checked_walls(tables: Vec<WallTable>, region: [f64; 2], snapshots: usize) -> Result<Walls, InputError> {
    let mut polygons = Vec::with_capacity(tables.len());
    let (mut outlines, mut points) = (0.0, 0);
    for (index, WallTable { polygon: vertices }) in tables.into_iter().enumerate() {
        let key = format!("wall[{index}].polygon");
        if vertices.len() > MAX_POINTS {
            return Err(too_many(&key, vertices.len()));
        }
        let point = |(vertex, raw)| checked_point(&format!("{key}[{vertex}]"), raw, region, WALL_OVERHANG);
        let polygon = vertices.iter().copied().enumerate().map(point).collect::<Result<_, _>>()?;
        let polygon = Polygon::new(polygon).map_err(|error| polygon_error(&key, &vertices, error))?;
        outlines += polygon.perimeter();
        points += vertices.len();
        limits::check_outline(&key, outlines, points, snapshots)?;
        polygons.push(polygon);
    }
    Ok(Walls::new(polygons))
}

fn polygon_error(key: &str, vertices: &[Pair], error: PolygonError) -> InputError {
    let at = |vertex: usize| vertices.get(vertex).map(|pair| format!("{:?}", pair.0)).unwrap_or_default();
    let next = |vertex: usize| (vertex + 1) % vertices.len().max(1);
    match error {
        PolygonError::TooFewVertices(count) => {
            InputError::new(key, format!("{count} points"), "a polygon needs at least 3 points")
        }
        PolygonError::NotFinite(vertex) => {
            InputError::new(format!("{key}[{vertex}]"), at(vertex), "coordinates must be finite")
        }
        PolygonError::RepeatedVertex(vertex) => InputError::new(
            format!("{key}[{vertex}]"),
            at(vertex),
            "must differ from the next point (the last point is joined to the first by itself)",
        ),
        PolygonError::SelfIntersecting(a, b) => InputError::new(
            format!("{key}[{b}]"),
            at(b),
            format!(
                "the edge from here to {} meets the one from {} to {}; the outline must not cross or touch itself",
                at(next(b)),
                at(a),
                at(next(a))
            ),
        ),
        PolygonError::NoArea => InputError::new(key, "", "encloses no area; points must not lie on a line"),
    }
}

fn checked_targets(tables: Vec<TargetTable>, region: [f64; 2], walls: &Walls) -> Result<Vec<Path>, InputError> {
    if !(1..=MAX_TARGETS).contains(&tables.len()) {
        let expected = format!("a scenario has 1 to {MAX_TARGETS} [[target]] tables");
        return Err(InputError::new("target", format!("{} of them", tables.len()), expected));
    }
    let mut paths: Vec<Path> = Vec::with_capacity(tables.len());
    for (target, TargetTable { path }) in tables.into_iter().enumerate() {
        let key = format!("target[{target}].path");
        if path.is_empty() {
            return Err(InputError::new(key, "[]", "a path needs at least 1 point"));
        }
        if path.len() > MAX_POINTS {
            return Err(too_many(&key, path.len()));
        }
        let mut points: Vec<Point<f64>> = Vec::with_capacity(path.len());
        for (index, raw) in path.into_iter().enumerate() {
            let key = format!("{key}[{index}]");
            let here = checked_point(&key, raw, region, 0.0)?;
            let fault = |expected: String| InputError::new(&key, format!("{:?}", raw.0), expected);
            if let Some(wall) = walls.containing(here) {
                return Err(fault(format!("is inside wall[{wall}] (counted from 0); move the target or the wall")));
            }
            if let Some(wall) = points.last().and_then(|&before| wall_between(walls, before, here)) {
                let words = "the straight way from the point before it meets wall";
                return Err(fault(format!("{words}[{wall}] (counted from 0); lead the path around it")));
            }
            points.push(here);
        }
        let path = Path::new(points);
        if let Some(other) = paths.iter().position(|other| *other == path) {
            let expected = format!("the same path as target[{other}]: two targets in one place; move or remove one");
            return Err(InputError::new(key, "", expected));
        }
        paths.push(path);
    }
    Ok(paths)
}

/// The wall that the straight way between two points meets first.
fn wall_between(walls: &Walls, start: Point<f64>, end: Point<f64>) -> Option<usize> {
    let (direction, reach) = ((end - start).direction()?, (end - start).length());
    walls.ray(start, direction, reach)?;
    let first = |polygon: &Polygon| {
        let hits = polygon.edges().iter().filter_map(|edge| edge.ray(start, direction));
        hits.filter(|&distance| distance <= reach).reduce(f64::min)
    };
    let hits = walls.polygons().iter().enumerate().filter_map(|(wall, polygon)| Some((wall, first(polygon)?)));
    hits.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(wall, _)| wall)
}

impl From<Scenario> for ScenarioFile {
    fn from(scenario: Scenario) -> ScenarioFile {
        let raw = |points: &[Point<f64>]| points.iter().map(|p| Pair([p.x, p.y])).collect();
        let Morphogen { kernel, target_width, obstacle_width, level } = scenario.morphogen;
        let Ring { d_min, d_max, d_obstacle, steepness } = scenario.ring;
        ScenarioFile {
            name: scenario.name,
            region: Pair(scenario.region),
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
            self.region.0,
            self.snapshots,
            self.morphogen.kernel.name(),
        );
        let raw = |points: &[Pair]| points.iter().map(|pair| pair.0).collect::<Vec<_>>();
        for TargetTable { path } in &self.targets {
            let path = raw(path);
            let _ = write!(text, "\n[[target]]\npath = {path:?}\n");
        }
        for WallTable { polygon } in &self.walls {
            let polygon = raw(polygon);
            let _ = write!(text, "\n[[wall]]\npolygon = {polygon:?}\n");
        }
        text
    }
}
