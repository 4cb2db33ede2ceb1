//! Variation of real vectors, and NSGA-II for them: simulated binary crossover (Deb and Agrawal 1995) and
//! polynomial mutation (Deb and Goyal 1996), both in the bounded form of Deb's own NSGA-II code, in front of the
//! survival and the tournament of [`nsga2`](super::nsga2).

mod power;
#[cfg(test)]
mod tests;

use core::fmt;

use rand::{Rng, RngExt};

use super::bounds::Bounds;
use super::nsga2::{Scores, Standing, best, standings, tournaments};
use power::Exponent;

/// Why an argument was rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SettingsError {
    /// A probability is not within [0, 1].
    Probability(f64),
    /// A distribution index is not finite, or below 0.
    Index(f64),
    /// The population is smaller than 2.
    Population(usize),
    /// The budget is of no evaluation at all.
    Budget,
}

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Probability(p) => write!(f, "probability {p}: must be from 0 to 1"),
            Self::Index(eta) => {
                write!(f, "distribution index {eta}: must be finite and at least 0")
            }
            Self::Population(n) => write!(f, "a population of {n}: must be at least 2"),
            Self::Budget => write!(f, "a budget of no evaluations: must be at least 1"),
        }
    }
}

impl core::error::Error for SettingsError {}

/// How often an operator acts and how far it goes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Strength {
    probability: f64,
    exponent: Exponent,
}

impl Strength {
    fn new(probability: f64, eta: f64) -> Result<Self, SettingsError> {
        if !(0.0..=1.0).contains(&probability) {
            return Err(SettingsError::Probability(probability));
        }
        if !(eta >= 0.0 && eta.is_finite()) {
            return Err(SettingsError::Index(eta));
        }
        Ok(Self { probability, exponent: Exponent::new(eta) })
    }
}

/// Simulated binary crossover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sbx(Strength);

impl Sbx {
    /// A pair is crossed with `probability` (usually 0.9); the larger the distribution index `eta` (usually 15),
    /// the closer the children are to their parents.
    ///
    /// # Errors
    /// A probability outside [0, 1], an index below 0 or not finite.
    pub fn new(probability: f64, eta: f64) -> Result<Self, SettingsError> {
        Strength::new(probability, eta).map(Self)
    }

    /// Turns two parents into two children, in place. A pair that is crossed exchanges each coordinate with
    /// probability 1/2 for two values spread around the parents' values as one-point crossover spreads the
    /// numbers its bit strings stand for: `(y1 + y2 ∓ β (y2 - y1)) / 2`, with `β` drawn from the density
    /// `(η + 1) β^η / 2` below 1 and `(η + 1) / (2 β^(η + 2))` above, cut off at the bounds. Which child gets
    /// which value is a coin's choice. Parents in the box have children in the box.
    pub fn cross<R: Rng + ?Sized>(&self, rng: &mut R, bounds: &Bounds, a: &mut [f64], b: &mut [f64]) {
        let Strength { probability, exponent } = self.0;
        if rng.random::<f64>() >= probability {
            return;
        }
        for ((a, b), &(lo, hi)) in a.iter_mut().zip(b).zip(bounds.intervals()) {
            if rng.random::<bool>() {
                continue;
            }
            let (y1, y2) = (a.min(*b), a.max(*b));
            let apart = y2 - y1;
            // Deb's code has the same limit.
            if apart <= 1e-14 {
                continue;
            }
            let draw = rng.random::<f64>();
            // β to the power of η + 1, for the room a child has on its own side.
            let raised = |room: f64| {
                let alpha = 2.0 - 1.0 / exponent.raise(1.0 + 2.0 * room / apart);
                let scaled = draw * alpha;
                // One quotient rather than two branches, which would be guessed wrongly half of the time.
                let (above, below) = if scaled <= 1.0 { (scaled, 1.0) } else { (1.0, 2.0 - scaled) };
                above / below
            };
            let [left, right] = exponent.roots([raised(y1 - lo), raised(hi - y2)]);
            let (low, high) = (0.5 * (y1 + y2 - left * apart), 0.5 * (y1 + y2 + right * apart));
            let (low, high) = (low.max(lo).min(hi), high.max(lo).min(hi));
            (*a, *b) = if rng.random::<bool>() { (low, high) } else { (high, low) };
        }
    }
}

/// Polynomial mutation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolynomialMutation(Strength);

impl PolynomialMutation {
    /// Every coordinate is changed with `probability` (usually one over the dimension); the larger the
    /// distribution index `eta` (usually 20), the smaller the change.
    ///
    /// # Errors
    /// A probability outside [0, 1], an index below 0 or not finite.
    pub fn new(probability: f64, eta: f64) -> Result<Self, SettingsError> {
        Strength::new(probability, eta).map(Self)
    }

    /// Changes `x` in place. A change is a share of the interval's width, drawn from the density
    /// `(η + 1) (1 - |δ|)^η / 2` cut off at the bounds on either side. A vector in the box stays in the box.
    pub fn mutate<R: Rng + ?Sized>(&self, rng: &mut R, bounds: &Bounds, x: &mut [f64]) {
        let Strength { probability, exponent } = self.0;
        for (x, &(lo, hi)) in x.iter_mut().zip(bounds.intervals()) {
            let width = hi - lo;
            if rng.random::<f64>() >= probability || width <= 0.0 {
                continue;
            }
            let draw = rng.random::<f64>();
            let (down, room) = if draw < 0.5 { (true, *x - lo) } else { (false, hi - *x) };
            // The share of the density that points this way, from 0 at the wall to 1 at no change.
            let share = if down { 2.0 * draw } else { 2.0 * (1.0 - draw) };
            let wall = exponent.raise(1.0 - room / width);
            let [stay] = exponent.roots([share + (1.0 - share) * wall]);
            let step = 1.0 - stay;
            let moved = if down { *x - step * width } else { *x + step * width };
            *x = moved.max(lo).min(hi);
        }
    }
}

/// Checked settings of a run of [`minimise`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    population: usize,
    evaluations: usize,
    crossover: Sbx,
    mutation: PolynomialMutation,
}

impl Settings {
    /// A population of `population` vectors (at least 2) and a budget of exactly `evaluations` (at least 1).
    ///
    /// # Errors
    /// The first argument out of range.
    pub fn new(
        population: usize,
        evaluations: usize,
        crossover: Sbx,
        mutation: PolynomialMutation,
    ) -> Result<Self, SettingsError> {
        if population < 2 {
            return Err(SettingsError::Population(population));
        }
        if evaluations == 0 {
            return Err(SettingsError::Budget);
        }
        Ok(Self { population, evaluations, crossover, mutation })
    }
}

/// A vector and what its evaluation gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Individual<const M: usize> {
    /// The vector.
    pub x: Vec<f64>,
    /// Its scores.
    pub scores: Scores<M>,
}

/// Minimises `M` objectives over a box by NSGA-II, and returns the last population, best first by rank and then
/// crowding. A budget that is no multiple of the population ends in the middle of a generation: the offspring
/// made by then compete for survival. One below the population returns as many vectors as it allowed.
pub fn minimise<const M: usize, R: Rng + ?Sized>(
    settings: &Settings,
    bounds: &Bounds,
    rng: &mut R,
    mut evaluate: impl FnMut(&[f64]) -> Scores<M>,
) -> Vec<Individual<M>> {
    let mut score = |x: Vec<f64>| {
        let scores = evaluate(&x);
        Individual { x, scores }
    };
    let start = settings.population.min(settings.evaluations);
    let mut population: Vec<_> = (0..start).map(|_| score(bounds.sample(rng))).collect();
    let mut left = settings.evaluations - start;
    let mut places = select(&mut population, settings.population);
    while left > 0 {
        let offspring = settings.population.min(left);
        left -= offspring;
        let mut children = Vec::with_capacity(offspring + 1);
        // As many as for a whole generation, so that a smaller budget only cuts a run short.
        let parents = tournaments(rng, &places, settings.population.next_multiple_of(2));
        for pair in parents.chunks_exact(2).take(offspring.div_ceil(2)) {
            let (mut a, mut b) = (population[pair[0]].x.clone(), population[pair[1]].x.clone());
            settings.crossover.cross(rng, bounds, &mut a, &mut b);
            settings.mutation.mutate(rng, bounds, &mut a);
            settings.mutation.mutate(rng, bounds, &mut b);
            children.extend([a, b]);
        }
        children.truncate(offspring);
        population.extend(children.into_iter().map(&mut score));
        places = select(&mut population, settings.population);
    }
    population
}

/// Keeps the `n` best, best first, and says where they stood among all.
fn select<const M: usize>(population: &mut Vec<Individual<M>>, n: usize) -> Vec<Standing> {
    let scores: Vec<Scores<M>> = population.iter().map(|i| i.scores).collect();
    let places = standings(&scores);
    let kept = best(&places, n);
    let mut take = |&i: &usize| Individual { x: core::mem::take(&mut population[i].x), scores: population[i].scores };
    *population = kept.iter().map(&mut take).collect();
    kept.into_iter().map(|i| places[i]).collect()
}
