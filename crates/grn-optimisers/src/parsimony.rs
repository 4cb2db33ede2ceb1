//! Which of several candidates, each tried under the same random conditions, to prefer: the simplest that is as good as the best, as
//! far as the trials tell. This is the one-standard-error rule of Breiman, Friedman, Olshen and Stone 1984, "Classification and
//! Regression Trees", section 3.4.3, on paired differences: under common conditions most of the noise is the same for all.

/// A candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried<'a> {
    /// How complex it is, less is better.
    pub complexity: f64,
    /// What it cost in each trial, less is better; trials of the same place are of the same conditions.
    pub costs: &'a [f64],
}

/// The place of the simplest candidate whose mean cost is at most one standard error of the paired differences above that of the
/// best; of equally simple ones the better, of equal ones the first. `None` without candidates.
pub fn parsimonious(candidates: &[Tried<'_>]) -> Option<usize> {
    let means: Vec<f64> = candidates.iter().map(|candidate| mean(candidate.costs)).collect();
    let best = (0..candidates.len()).min_by(|&a, &b| means[a].total_cmp(&means[b]))?;
    let is_as_good = |&place: &usize| {
        let pairs = candidates[place].costs.iter().zip(candidates[best].costs);
        let differences: Vec<f64> = pairs.map(|(cost, least)| cost - least).collect();
        place == best || mean(&differences) <= standard_error(&differences)
    };
    let order = |&a: &usize, &b: &usize| {
        candidates[a].complexity.total_cmp(&candidates[b].complexity).then(means[a].total_cmp(&means[b]))
    };
    (0..candidates.len()).filter(is_as_good).min_by(order)
}

/// Infinite without values.
fn mean(values: &[f64]) -> f64 {
    if values.is_empty() { f64::INFINITY } else { values.iter().sum::<f64>() / values.len() as f64 }
}

/// Of the mean; 0 of a single value, which tells of no spread.
fn standard_error(values: &[f64]) -> f64 {
    let (count, mean) = (values.len() as f64, mean(values));
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    if values.len() < 2 { 0.0 } else { (squares / (count - 1.0) / count).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(candidates: &[(f64, &[f64])]) -> Option<usize> {
        let tried = |&(complexity, costs): &(f64, _)| Tried { complexity, costs };
        parsimonious(&candidates.iter().map(tried).collect::<Vec<_>>())
    }

    #[test]
    fn the_simplest_within_a_standard_error_is_chosen() {
        let best: &[f64] = &[0.10, 0.20, 0.30, 0.40];
        assert_eq!(chosen(&[]), None);
        assert_eq!(chosen(&[(9.0, best)]), Some(0));
        // Differences -0.02, 0.04, 0.03, -0.01: 0.01 on average, with a standard error of 0.015.
        assert_eq!(chosen(&[(9.0, best), (3.0, &[0.08, 0.24, 0.33, 0.39])]), Some(1));
        // Always a little worse: the same mean difference, but no doubt about it.
        assert_eq!(chosen(&[(9.0, best), (3.0, &[0.11, 0.21, 0.31, 0.41])]), Some(0));
        assert_eq!(chosen(&[(9.0, best), (3.0, &[0.5; 4]), (5.0, best), (5.0, best)]), Some(2));
        assert_eq!(chosen(&[(9.0, &[0.1]), (3.0, &[0.2])]), Some(0), "a single trial tells of no spread");
    }
}
