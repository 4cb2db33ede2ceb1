//! The tables of targets, walls, discs and starts as they stand in a file.

use super::{Disc, Evasion, MeantSwarm, MovingWall, Path, Presence, Start, Target};
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
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evade: Option<EvasionTable>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EvasionTable {
    pub distance: f64,
    pub reach: f64,
    pub speed: f64,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SwarmTable {
    pub robots: i64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mothers: Option<i64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub walls_block_radio: Option<bool>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StartTable {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub centre: Option<Pair>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub positions: Option<Vec<Pair>>,
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

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DiscTable {
    pub centre: Pair,
    pub radius: f64,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<Pair>,
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
        let evade = target.evasion().map(|Evasion { distance, reach, speed }| EvasionTable { distance, reach, speed });
        TargetTable { path: raw(path.points()), times: raw_times(path), present: raw_spans(presence), evade }
    }
}

impl SwarmTable {
    pub fn of(meant: &MeantSwarm) -> SwarmTable {
        let whole = |count: usize| i64::try_from(count).unwrap_or(i64::MAX);
        let MeantSwarm { robots, mothers, walls_block_radio } = *meant;
        SwarmTable { robots: whole(robots), mothers: Some(whole(mothers)), walls_block_radio }
    }
}

impl StartTable {
    pub fn of(start: &Start) -> StartTable {
        match start {
            Start::Within(Disc { centre, radius }) => {
                StartTable { centre: Some(Pair([centre.x, centre.y])), radius: Some(*radius), positions: None }
            }
            Start::At(positions) => StartTable { centre: None, radius: None, positions: Some(raw(positions)) },
        }
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

impl DiscTable {
    pub fn fixed(disc: &Disc) -> DiscTable {
        let Disc { centre, radius } = *disc;
        DiscTable {
            centre: Pair([centre.x, centre.y]),
            radius,
            path: Vec::new(),
            times: Vec::new(),
            present: Vec::new(),
        }
    }

    pub fn moving(disc: &Disc, wall: &MovingWall) -> DiscTable {
        let present = raw_spans(wall.presence());
        let path = wall.motion().map(|motion| motion.path());
        let (path, times) = path.map_or((Vec::new(), Vec::new()), |path| (raw(path.points()), raw_times(path)));
        DiscTable { path, times, present, ..DiscTable::fixed(disc) }
    }
}
