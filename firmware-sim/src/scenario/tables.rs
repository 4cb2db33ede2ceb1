//! The tables of targets and walls as they stand in a file.

use super::{MovingWall, Path, Presence, Target};
use grn_core::geometry::Point;
use grn_input::Pair;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TargetTable {
    pub path: Vec<Pair>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub times: Vec<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub present: Vec<Pair>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WallTable {
    pub polygon: Vec<Pair>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<Pair>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub turn_deg: Vec<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub times: Vec<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub present: Vec<Pair>,
}

fn raw(points: &[Point<f64>]) -> Vec<Pair> {
    points.iter().map(|p| Pair([p.x, p.y])).collect()
}

fn raw_spans(presence: &Presence) -> Vec<Pair> {
    presence.spans().iter().copied().map(Pair).collect()
}

fn raw_times(path: &Path) -> Vec<f64> {
    path.times().unwrap_or_default().to_vec()
}

impl TargetTable {
    pub fn of(target: &Target) -> TargetTable {
        let (path, presence) = (target.path(), target.presence());
        TargetTable { path: raw(path.points()), times: raw_times(path), present: raw_spans(presence) }
    }
}

impl WallTable {
    pub fn fixed(polygon: &[Point<f64>]) -> WallTable {
        let (path, turn_deg, times, present) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        WallTable { polygon: raw(polygon), path, turn_deg, times, present }
    }

    pub fn moving(wall: &MovingWall) -> WallTable {
        let present = raw_spans(wall.presence());
        let drawn = WallTable { present, ..WallTable::fixed(wall.drawn().vertices()) };
        let Some(motion) = wall.motion() else { return drawn };
        let path = motion.path();
        WallTable { path: raw(path.points()), turn_deg: motion.turns_deg().to_vec(), times: raw_times(path), ..drawn }
    }
}
