//! NSGA-II over individuals, for as many objectives as they have.

use super::individual::Individual;
use grn_optimisers::nsga2::{self, Scores, Standing};

/// The first M objectives and the violation, for Deb's rule.
fn scores<const M: usize>(individual: &Individual) -> Scores<M> {
    let objective = |place: usize| individual.objectives.get(place).copied().unwrap_or(f64::INFINITY);
    Scores { objectives: std::array::from_fn(objective), violation: individual.violation }
}

/// Calls a function of `nsga2` with the scores of individuals: two objectives have a faster sort of their own.
macro_rules! by_count {
    ($function:path, $individuals:expr $(, $argument:expr)*) => {{
        let individuals: &[&Individual] = $individuals;
        match individuals.first().map_or(2, |first| first.objectives.len()) {
            2 => $function(&individuals.iter().map(|one| scores::<2>(one)).collect::<Vec<_>>() $(, $argument)*),
            _ => $function(&individuals.iter().map(|one| scores::<3>(one)).collect::<Vec<_>>() $(, $argument)*),
        }
    }};
}

/// Rank and crowding of each.
pub fn standings(individuals: &[&Individual]) -> Vec<Standing> {
    by_count!(nsga2::standings, individuals)
}

/// The places of the `count` that survive.
pub fn survivors(individuals: &[&Individual], count: usize) -> Vec<usize> {
    by_count!(nsga2::survivors, individuals, count)
}

/// The places of those that no other dominates.
pub fn non_dominated(individuals: &[&Individual]) -> Vec<usize> {
    by_count!(nsga2::non_dominated, individuals)
}

/// Deb's rule between two individuals.
pub fn dominates(a: &Individual, b: &Individual) -> bool {
    if a.objectives.len() == 2 { scores::<2>(a).dominates(&scores(b)) } else { scores::<3>(a).dominates(&scores(b)) }
}
