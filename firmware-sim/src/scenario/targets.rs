//! The targets of a file, checked.

use super::limits::MOST_TARGETS;
use super::obstacles::Obstacles;
use super::points::checked_points;
use super::tables::TargetTable;
use super::timing::checked_times;
use super::{Evasion, Path, Presence, Target};
use grn_core::geometry::Point;
use grn_input::InputError;

/// A target may not go into obstacles that stand still, wherever it is on its way.
pub(super) fn checked_targets(
    tables: Vec<TargetTable>,
    region: [f64; 2],
    obstacles: &Obstacles,
) -> Result<Vec<Target>, InputError> {
    if !(1..=MOST_TARGETS).contains(&tables.len()) {
        let expected = format!("a scenario has 1 to {MOST_TARGETS} [[target]] tables");
        return Err(InputError::new("target", format!("{} of them", tables.len()), expected));
    }
    let mut targets: Vec<Target> = Vec::with_capacity(tables.len());
    for (place, TargetTable { path: raw, times, present, evade }) in tables.into_iter().enumerate() {
        let target = format!("target[{place}]");
        let key = format!("{target}.path");
        if raw.is_empty() {
            return Err(InputError::new(key, "[]", "a path needs at least 1 point"));
        }
        let points = checked_points(&key, &raw, region, 0.0)?;
        check_free(&key, &points, obstacles)?;
        let presence = Presence::checked(&format!("{target}.present"), &present)?;
        let path = match checked_times(&format!("{target}.times"), times, points.len())? {
            Some(times) => Path::timed(points, times),
            None => Path::new(points),
        };
        let evasion = evade.map(|table| Evasion::checked(&target, table, &path, region)).transpose()?;
        let new = Target { path, presence, evasion };
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

fn check_free(key: &str, points: &[Point<f64>], obstacles: &Obstacles) -> Result<(), InputError> {
    for (index, &here) in points.iter().enumerate() {
        let fault = |expected| {
            Err(InputError::new(format!("{key}[{index}]"), format!("[{:?}, {:?}]", here.x, here.y), expected))
        };
        if let Some(obstacle) = obstacles.fixed_containing(here) {
            let kind = obstacle.split('[').next().unwrap_or_default();
            return fault(format!("is inside {obstacle} (counted from 0); move the target or the {kind}"));
        }
        let before = index.checked_sub(1).and_then(|before| points.get(before));
        if let Some(obstacle) = before.and_then(|&before| obstacles.first_fixed_between(before, here)) {
            let words = "the straight way from the point before it meets";
            return fault(format!("{words} {obstacle} (counted from 0); lead the path around it"));
        }
    }
    Ok(())
}
