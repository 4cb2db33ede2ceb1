//! Missions that are counted together.

use super::Third;
use super::row::Row;
use crate::missions::MissionRow;
use firmware_sim::missions::Class;
use grn_optimisers::statistics::wilson;
use serde::Serialize;

/// Missions of one kind, and what each model achieved in them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// What they are.
    pub name: String,
    /// How many they are.
    pub missions: usize,
    /// The least and the greatest difficulty.
    pub difficulty: [f64; 2],
    /// By model, in their order.
    pub models: Vec<Tally>,
}

/// What a model achieved in a group of missions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tally {
    /// What it is called.
    pub model: String,
    /// In how many missions targets were caged at least 95 % of the time, in the mean over the realities.
    pub caged: usize,
    /// The share of the missions that this is.
    pub caged_share: f64,
    /// Its 95 % interval (Wilson).
    pub interval: [f64; 2],
    /// The share of all realities of all missions in which every bar was met.
    pub works_share: f64,
    /// Mean of J.
    pub cost: f64,
}

/// All missions, then each class that there is, then each third of the difficulties. `rows` has one for each mission and model, missions
/// first; `missions` are those of the rows.
pub fn groups<'m>(
    missions: impl Iterator<Item = (&'m MissionRow, Third)>,
    models: &[&str],
    rows: &[Row],
) -> Vec<Group> {
    let missions: Vec<(&MissionRow, Third)> = missions.collect();
    let all = group("all", &missions, models, rows, |_, _| true);
    let classes = Class::ALL
        .iter()
        .filter_map(|class| group(class.name(), &missions, models, rows, |mission, _| mission.class == class.name()));
    let thirds =
        Third::ALL.iter().filter_map(|third| group(third.name(), &missions, models, rows, |_, of| of == *third));
    all.into_iter().chain(classes).chain(thirds).collect()
}

/// `None` without missions.
fn group(
    name: &str,
    missions: &[(&MissionRow, Third)],
    models: &[&str],
    rows: &[Row],
    belongs: impl Fn(&MissionRow, Third) -> bool,
) -> Option<Group> {
    let members: Vec<usize> =
        (0..missions.len()).filter(|&place| belongs(missions[place].0, missions[place].1)).collect();
    let difficulties = || members.iter().map(|&place| missions[place].0.difficulty);
    let difficulty = [difficulties().min_by(f64::total_cmp)?, difficulties().max_by(f64::total_cmp)?];
    let tally = |(number, model): (usize, &&str)| {
        let of_model = || members.iter().map(|&place| &rows[place * models.len() + number]);
        let count = members.len() as f64;
        let caged = of_model().filter(|row| row.caged).count();
        let (low, high) = wilson(caged, members.len());
        let (works, realities) = of_model().fold((0, 0), |(works, all), row| (works + row.works, all + row.realities));
        Tally {
            model: (*model).to_owned(),
            caged,
            caged_share: caged as f64 / count,
            interval: [low, high],
            works_share: works as f64 / realities.max(1) as f64,
            cost: of_model().map(|row| row.cost).sum::<f64>() / count,
        }
    };
    let models = models.iter().enumerate().map(tally).collect();
    Some(Group { name: name.to_owned(), missions: members.len(), difficulty, models })
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::mission;
    use super::super::row::thirds;
    use super::*;
    use crate::realities::Robustness;

    #[test]
    fn missions_are_counted_by_class_and_by_third() {
        let missions: Vec<MissionRow> = (0..12)
            .map(|number| mission(number, if number % 2 == 0 { "door" } else { "corner" }, number as f64 / 10.0))
            .collect();
        let thirds = thirds(&missions);
        // The first model cages all doors, the second the easiest half.
        let row = |place: usize| {
            let number = place / 2;
            let caged = if place.is_multiple_of(2) { number.is_multiple_of(2) } else { number < 6 };
            let mission = &missions[place / 2];
            let nothing = Robustness { realities: Vec::new() };
            let mut row = Row::of(mission, thirds[place / 2], "", &nothing, 7, "");
            (row.caged, row.works, row.realities, row.cost) = (caged, usize::from(caged), 1, place as f64);
            row
        };
        let rows: Vec<Row> = (0..24).map(row).collect();
        let found = groups(missions.iter().zip(thirds.iter().copied()), &["a", "b"], &rows);
        let told: Vec<(&str, usize, usize, usize)> = found
            .iter()
            .map(|group| (group.name.as_str(), group.missions, group.models[0].caged, group.models[1].caged))
            .collect();
        let expected = [
            ("all", 12, 6, 6),
            ("door", 6, 6, 3),
            ("corner", 6, 0, 3),
            ("easy", 4, 2, 4),
            ("middle", 4, 2, 2),
            ("hard", 4, 2, 0),
        ];
        assert_eq!(told, expected);
        assert_eq!(found[3].difficulty, [0.0, 0.3]);
        let door = &found[1].models[0];
        assert_eq!((door.caged_share, door.works_share, door.cost), (1.0, 1.0, 10.0));
        // Wilson's interval of 6 of 6: 1 / (1 + z²/6).
        assert!((door.interval[0] - 0.6097).abs() < 1e-3 && door.interval[1] > 0.999, "{:?}", door.interval);
    }
}
