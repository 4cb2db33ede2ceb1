//! When things in a file move, come and go, checked.

use super::evasion::check_evasion;
use super::{Motion, Path, Scenario};
use crate::geometry::Polygon;
use grn_core::geometry::Point;
use grn_input::{InputError, Range};

/// Angles that a wall may turn to: a thousand turns.
const TURN: Range<f64> = Range::new(-360_000.0, 360_000.0, "degrees");
/// Between so many moments, and whenever something comes or goes, it is looked whether a wall runs into a target.
const MOMENTS: u32 = 2000;

/// The times of a file, read under `key`, one for each of so many points; none without any.
pub(super) fn checked_times(key: &str, times: Vec<f64>, points: usize) -> Result<Option<Vec<f64>>, InputError> {
    if times.is_empty() {
        return Ok(None);
    }
    if times.len() != points {
        let expected = format!("one time is needed for each of the {points} places of the way");
        return Err(InputError::new(key, format!("{} times", times.len()), expected));
    }
    for (index, &time) in times.iter().enumerate() {
        let fault = |expected| Err(InputError::new(format!("{key}[{index}]"), format!("{time:?}"), expected));
        if !(0.0..=1.0).contains(&time) {
            return fault("times go from 0, when the targets set out, to 1, when they have arrived");
        }
        if index.checked_sub(1).is_some_and(|before| times[before] >= time) {
            return fault("must be later than the time before it");
        }
    }
    Ok(Some(times))
}

/// How the wall under the key `wall` moves: its reference point along `path`, turned to `turn_deg` there.
pub(super) fn checked_motion(
    wall: &str,
    path: Vec<Point<f64>>,
    turn_deg: Vec<f64>,
    times: Vec<f64>,
) -> Result<Option<Motion>, InputError> {
    let key = |name: &str| format!("{wall}.{name}");
    let stations = path.len().max(turn_deg.len());
    if stations == 0 {
        let unused = |_| InputError::new(key("times"), "", "times are of a path or of turns, and there are none");
        return times.first().map(unused).map_or(Ok(None), Err);
    }
    if path.is_empty() {
        let expected = "the point that the wall turns about is missing: add path = [[x, y]]";
        return Err(InputError::new(key("turn_deg"), "", expected));
    }
    if stations == 1 {
        let expected = "one point is no way: add a second one, or two angles as turn_deg to turn about it";
        return Err(InputError::new(key("path"), "", expected));
    }
    for (index, &angle) in turn_deg.iter().enumerate() {
        TURN.check(&format!("{}[{index}]", key("turn_deg")), angle)?;
    }
    let turns = if turn_deg.is_empty() { vec![0.0; stations] } else { turn_deg };
    let path = if path.len() == 1 { vec![path[0]; stations] } else { path };
    if turns.len() != path.len() {
        let expected = format!("one angle is needed for each of the {} points of the path", path.len());
        return Err(InputError::new(key("turn_deg"), format!("{} angles", turns.len()), expected));
    }
    let times = match checked_times(&key("times"), times, stations)? {
        Some(times) => times,
        None => even_times(&path).ok_or_else(|| {
            let expected =
                "a point equals the one before it: to stop there, or to turn, give the times of all points as times";
            InputError::new(key("path"), "", expected)
        })?,
    };
    Ok(Some(Motion::new(Path::timed(path, times), turns)))
}

/// Times for constant speed, or equal ones between turns about one point; `None` if only a part of the way is none.
fn even_times(path: &[Point<f64>]) -> Option<Vec<f64>> {
    let stretches: Vec<f64> = path.windows(2).map(|pair| (pair[1] - pair[0]).length()).collect();
    let length: f64 = stretches.iter().sum();
    if length == 0.0 {
        return Some((0..path.len()).map(|place| place as f64 / stretches.len() as f64).collect());
    }
    let mut passed = 0.0;
    let times = stretches.iter().map(|stretch| {
        passed += stretch;
        (passed / length).min(1.0)
    });
    let times: Vec<f64> = [0.0].into_iter().chain(times).collect();
    times.windows(2).all(|pair| pair[0] < pair[1]).then_some(times)
}

/// Whether there is always a target, and no wall ever runs into one, nor can one that evades run into a wall.
pub(super) fn check_course(world: &Scenario) -> Result<(), InputError> {
    let changes = world.changes();
    if let Some(time) = [0.0].iter().chain(&changes).chain(&[1.0]).find(|&&time| world.targets_at(time).is_empty()) {
        let expected = format!("no target is there at time {time:?}; let one be there at every time from 0 to 1");
        return Err(InputError::new("target", "", expected));
    }
    if !changes.is_empty() && world.longest_path() == 0.0 && world.duration_s().is_none() {
        let expected = "nothing moves, so the run would have no time in which something comes or goes: \
                        add duration_s, in seconds, beside region";
        return Err(InputError::new("duration_s", "", expected));
    }
    let mut times: Vec<f64> =
        (0..=MOMENTS).map(|moment| f64::from(moment) / f64::from(MOMENTS)).chain(changes).collect();
    times.sort_by(f64::total_cmp);
    if world.walls_change() {
        check_collisions(world, &times)?;
    }
    check_evasion(world, &times)
}

/// Whether no wall runs into a target on its path, looked at at these times, rising.
fn check_collisions(world: &Scenario, times: &[f64]) -> Result<(), InputError> {
    let mut before: Vec<Option<Point<f64>>> = vec![None; world.targets().len()];
    for &time in times {
        let now: Vec<Option<Point<f64>>> = world.targets().iter().map(|target| target.at(time)).collect();
        for wall in world.moving_walls() {
            let Some(polygon) = wall.at(time) else { continue };
            for (target, here) in now.iter().enumerate().filter_map(|(target, here)| Some((target, (*here)?))) {
                if polygon.contains(here) || before[target].is_some_and(|from| crosses(&polygon, from, here)) {
                    let expected = format!(
                        "this wall runs into target[{target}] (counted from 0) at time {time:.3}, at [{:.2}, {:.2}]; move one \
                         of them, or change its times",
                        here.x, here.y
                    );
                    return Err(InputError::new(wall.key(), "", expected));
                }
            }
        }
        before = now;
    }
    Ok(())
}

fn crosses(polygon: &Polygon, from: Point<f64>, to: Point<f64>) -> bool {
    let way = to - from;
    way.direction().is_some_and(|direction| polygon.ray(from, direction, way.length()).is_some())
}
