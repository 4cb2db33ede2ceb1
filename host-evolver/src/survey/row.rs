//! What came out of a trial.

use crate::missions::MissionRow;
use crate::realities::Robustness;
use crate::simulation::verdict::ENOUGH_CAGED;
use serde::{Deserialize, Serialize};

/// The third of a survey's missions, by difficulty, that a mission is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Third {
    /// The least difficult ones.
    Easy,
    /// Those between.
    Middle,
    /// The most difficult ones.
    Hard,
}

impl Third {
    /// All of them, rising.
    pub const ALL: [Third; 3] = [Third::Easy, Third::Middle, Third::Hard];

    /// Its name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Third::Easy => "easy",
            Third::Middle => "middle",
            Third::Hard => "hard",
        }
    }
}

/// The third that each mission is in. Of two that are equally difficult the earlier one counts as less difficult.
pub fn thirds(missions: &[MissionRow]) -> Vec<Third> {
    let mut order: Vec<usize> = (0..missions.len()).collect();
    order.sort_by(|&a, &b| missions[a].difficulty.total_cmp(&missions[b].difficulty));
    let mut thirds = vec![Third::Easy; missions.len()];
    for (rank, &mission) in order.iter().enumerate() {
        thirds[mission] = Third::ALL[rank * Third::ALL.len() / missions.len()];
    }
    thirds
}

/// A model in a mission. Measures are means over the realities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The mission's file.
    pub mission: String,
    /// Its class.
    pub class: String,
    /// Its number of targets.
    pub targets: usize,
    /// Its number of robots.
    pub robots: usize,
    /// How much it rewards adaptation.
    pub difficulty: f64,
    /// The third of the missions of this survey that it is in.
    pub third: Third,
    /// What the model is called.
    pub model: String,
    /// Whether targets were caged at least 95 % of the time.
    pub caged: bool,
    /// Share of the time after settling in which targets were caged.
    pub caged_share: f64,
    /// The same in the worst reality.
    pub least_caged_share: f64,
    /// In how many realities every bar was met.
    pub works: usize,
    /// In how many it was tried.
    pub realities: usize,
    /// J.
    pub cost: f64,
    /// Share of robots' time within d_min and d_max of a target.
    pub in_band_share: f64,
    /// Share of robots' time in touch with something.
    pub contact_share: f64,
    /// Robots off the pattern at the end, as a share.
    pub lost_share: f64,
    /// Robots times simulated ticks of 1/32 s, all realities together.
    pub robot_ticks: u64,
    /// What the trial is a hash of: program, world, blob, laboratory, realities.
    pub key: String,
}

impl Row {
    pub(super) fn of(
        mission: &MissionRow,
        third: Third,
        model: &str,
        came_out: &Robustness,
        robot_ticks: u64,
        key: &str,
    ) -> Row {
        let caged_share = came_out.mean(|reality| reality.caged_share);
        Row {
            mission: mission.file.clone(),
            class: mission.class.clone(),
            targets: mission.targets,
            robots: mission.robots,
            difficulty: mission.difficulty,
            third,
            model: model.to_owned(),
            caged: caged_share >= ENOUGH_CAGED,
            caged_share,
            least_caged_share: came_out.realities.iter().map(|reality| reality.caged_share).fold(1.0, f64::min),
            works: came_out.works(),
            realities: came_out.realities.len(),
            cost: came_out.mean(|reality| reality.cost),
            in_band_share: came_out.mean(|reality| reality.in_band_share),
            contact_share: came_out.mean(|reality| reality.contact_share),
            lost_share: came_out.mean(|reality| reality.lost_share),
            robot_ticks,
            key: key.to_owned(),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub fn mission(number: usize, class: &str, difficulty: f64) -> MissionRow {
        MissionRow {
            file: format!("{number:04}-{class}.toml"),
            class: class.into(),
            seed: 1,
            targets: 1,
            robots: 12,
            walls_block_radio: false,
            moving: false,
            clearance_m: 0.8,
            circle_radius_m: 0.75,
            circle_f2: 1.0,
            star_f2: 1.0 - difficulty,
            difficulty,
        }
    }

    #[test]
    fn missions_are_ranked_by_difficulty() {
        let missions: Vec<MissionRow> =
            [0.5, 0.1, 0.9, 0.3, 0.3, 0.2, 0.8].into_iter().map(|d| mission(0, "door", d)).collect();
        use Third::{Easy, Hard, Middle};
        assert_eq!(thirds(&missions), [Middle, Easy, Hard, Easy, Middle, Easy, Hard]);
        assert_eq!(thirds(&missions[..1]), [Easy]);
    }
}
