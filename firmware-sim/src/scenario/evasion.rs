//! Targets that evade robots.

use super::limits::DISTANCE;
use super::tables::EvasionTable;
use super::{Path, Scenario, Target};
use grn_input::{InputError, Range};

/// How fast a target may evade.
const SPEED: Range<f64> = Range::new(0.01, 2.0, "times the speed of the targets");
/// How far a target that evades stays from every wall, metres: more than anything moves between two of the moments that are looked at.
const CLEARANCE: f64 = 0.05;

/// How a target leaves its path for robots, in a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evasion {
    /// It evades robots that are nearer than this, metres.
    pub distance: f64,
    /// The farthest it goes from where its path would have it, metres.
    pub reach: f64,
    /// How fast it goes away from there and back, in multiples of the speed that a run gives its targets.
    pub speed: f64,
}

impl Evasion {
    /// The numbers of the target under the key `target`, whose path must keep within the region by as much as it may leave it.
    pub(super) fn checked(
        target: &str,
        table: EvasionTable,
        path: &Path,
        region: [f64; 2],
    ) -> Result<Evasion, InputError> {
        let key = format!("{target}.evade");
        let EvasionTable { distance, reach, speed } = table;
        for (name, value, range) in
            [("distance", distance, DISTANCE), ("reach", reach, DISTANCE), ("speed", speed, SPEED)]
        {
            range.check(&format!("{key}.{name}"), value)?;
        }
        let room = |(at, side): (f64, f64)| at.min(side - at);
        let rooms = path.points().iter().map(|point| room((point.x, region[0])).min(room((point.y, region[1]))));
        let room = rooms.fold(f64::INFINITY, f64::min);
        if reach > room {
            let expected =
                format!("the path comes within {room:.2} metres of the region's edge, so it must be at most that");
            return Err(InputError::new(format!("{key}.reach"), format!("{reach:?}"), expected));
        }
        Ok(Evasion { distance, reach, speed })
    }

    #[must_use]
    pub(super) fn scaled(&self, factor: f64) -> Evasion {
        Evasion { distance: self.distance * factor, reach: self.reach * factor, speed: self.speed }
    }
}

/// Whether no target that evades can come into a wall: at each of these times, rising from 0 to 1, its path is farther from all walls
/// than it may leave it.
pub(super) fn check_evasion<'w>(world: &'w Scenario, times: &[f64]) -> Result<(), InputError> {
    let evading = |(number, target): (usize, &'w Target)| Some((number, target, target.evasion?.reach));
    let evading: Vec<(usize, &Target, f64)> = world.targets().iter().enumerate().filter_map(evading).collect();
    if evading.is_empty() {
        return Ok(());
    }
    for &time in times {
        let walls = world.walls_at(time);
        for &(number, target, reach) in &evading {
            let Some(here) = target.at(time) else { continue };
            let room = walls.signed_distance(here) - CLEARANCE;
            if reach > room {
                let expected = format!(
                    "at time {time:.3}, at [{:.2}, {:.2}], the path is {:.2} metres from a wall, and a target that evades keeps \
                     {CLEARANCE} metres off; a reach of at most {:.2} is possible there",
                    here.x,
                    here.y,
                    room + CLEARANCE,
                    room.max(0.0)
                );
                return Err(InputError::new(format!("target[{number}].evade.reach"), format!("{reach:?}"), expected));
            }
        }
    }
    Ok(())
}
