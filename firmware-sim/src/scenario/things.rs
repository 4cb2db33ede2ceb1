//! The targets and walls of a file, checked.

use super::limits::{self, MAX_POINTS, WALL_OVERHANG};
use super::tables::{TargetTable, WallTable};
use super::timing::{checked_motion, checked_times};
use super::{MovingWall, Path, Presence, Target};
use crate::geometry::{Polygon, PolygonError, Walls};
use grn_core::geometry::{Point, Vector};
use grn_core::robot::percept::MAX_TARGETS;
use grn_input::{InputError, Pair, Range};

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

fn too_many(key: &str, count: usize) -> InputError {
    InputError::new(key, format!("{count} points"), format!("at most {MAX_POINTS} points are allowed; simplify it"))
}

fn checked_points(key: &str, raw: &[Pair], region: [f64; 2], overhang: f64) -> Result<Vec<Point<f64>>, InputError> {
    if raw.len() > MAX_POINTS {
        return Err(too_many(key, raw.len()));
    }
    let point = |(index, &raw)| checked_point(&format!("{key}[{index}]"), raw, region, overhang);
    raw.iter().enumerate().map(point).collect()
}

/// The walls that stand still, and the others.
pub(super) fn checked_walls(
    tables: Vec<WallTable>,
    region: [f64; 2],
    snapshots: usize,
) -> Result<(Walls, Vec<MovingWall>), InputError> {
    let (mut fixed, mut moving) = (Vec::with_capacity(tables.len()), Vec::new());
    let (mut outlines, mut points) = (0.0, 0);
    for (place, WallTable { polygon: vertices, path, turn_deg, times, present }) in tables.into_iter().enumerate() {
        let wall = format!("wall[{place}]");
        let key = format!("{wall}.polygon");
        let polygon = checked_points(&key, &vertices, region, WALL_OVERHANG)?;
        let polygon = Polygon::new(polygon).map_err(|error| polygon_error(&key, &vertices, error))?;
        outlines += polygon.perimeter();
        points += vertices.len();
        limits::check_outline(&key, outlines, points, snapshots)?;
        let path = checked_points(&format!("{wall}.path"), &path, region, WALL_OVERHANG)?;
        let motion = checked_motion(&wall, path, turn_deg, times)?;
        let presence = Presence::checked(&format!("{wall}.present"), &present)?;
        if motion.is_none() && presence.is_always() {
            fixed.push(polygon);
        } else {
            moving.push(MovingWall { place, drawn: polygon, motion, presence });
        }
    }
    Ok((Walls::new(fixed), moving))
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

/// `fixed` are the walls that stand still; a target may not go into them, wherever it is on its way.
pub(super) fn checked_targets(
    tables: Vec<TargetTable>,
    region: [f64; 2],
    fixed: &Walls,
) -> Result<Vec<Target>, InputError> {
    if !(1..=MAX_TARGETS).contains(&tables.len()) {
        let expected = format!("a scenario has 1 to {MAX_TARGETS} [[target]] tables");
        return Err(InputError::new("target", format!("{} of them", tables.len()), expected));
    }
    let mut targets: Vec<Target> = Vec::with_capacity(tables.len());
    for (place, TargetTable { path: raw, times, present }) in tables.into_iter().enumerate() {
        let target = format!("target[{place}]");
        let key = format!("{target}.path");
        if raw.is_empty() {
            return Err(InputError::new(key, "[]", "a path needs at least 1 point"));
        }
        let points = checked_points(&key, &raw, region, 0.0)?;
        check_free(&key, &points, fixed)?;
        let presence = Presence::checked(&format!("{target}.present"), &present)?;
        let path = match checked_times(&format!("{target}.times"), times, points.len())? {
            Some(times) => Path::timed(points, times),
            None => Path::new(points),
        };
        let new = Target { path, presence };
        if let Some(other) = targets.iter().position(|other| other.path == new.path && meet(other, &new)) {
            let expected = format!("the same path as target[{other}]: two targets in one place; move or remove one");
            return Err(InputError::new(key, "", expected));
        }
        targets.push(new);
    }
    Ok(targets)
}

/// Whether two targets are there at once.
fn meet(a: &Target, b: &Target) -> bool {
    let mut times = [0.0].into_iter().chain(a.presence.changes()).chain(b.presence.changes());
    times.any(|time| a.presence.holds(time) && b.presence.holds(time))
}

fn check_free(key: &str, points: &[Point<f64>], walls: &Walls) -> Result<(), InputError> {
    for (index, &here) in points.iter().enumerate() {
        let fault = |expected| {
            Err(InputError::new(format!("{key}[{index}]"), format!("[{:?}, {:?}]", here.x, here.y), expected))
        };
        if let Some(wall) = walls.containing(here) {
            return fault(format!("is inside wall[{wall}] (counted from 0); move the target or the wall"));
        }
        let before = index.checked_sub(1).and_then(|before| points.get(before));
        if let Some(wall) = before.and_then(|&before| wall_between(walls, before, here)) {
            let words = "the straight way from the point before it meets wall";
            return fault(format!("{words}[{wall}] (counted from 0); lead the path around it"));
        }
    }
    Ok(())
}

/// The wall that the straight way between two points meets first.
fn wall_between(walls: &Walls, start: Point<f64>, end: Point<f64>) -> Option<usize> {
    let (direction, reach) = ((end - start).direction()?, (end - start).length());
    let met = |(wall, polygon): (usize, &Polygon)| Some((wall, polygon.ray(start, direction, reach)?));
    let hits = walls.fixed().iter().enumerate().filter_map(met);
    hits.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(wall, _)| wall)
}
