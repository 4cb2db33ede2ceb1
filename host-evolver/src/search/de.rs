//! Differential evolution, DE/rand/1/bin (Storn and Price 1997).
//!
//! Each generation, every member `x_i` of the population is challenged by a trial. With three other members
//! `r1, r2, r3`, all different, the mutant is `v = x_r1 + F (x_r2 - x_r3)`; the trial takes each coordinate from
//! the mutant with probability `CR`, one coordinate chosen at random always, and the others from `x_i`. The
//! trial takes the place of `x_i` if it is at least as good. All trials of a generation are made from the
//! population as it was when the generation began.
//!
//! A mutant coordinate beyond a bound is drawn again, uniformly between the base vector's coordinate `x_r1` and
//! that bound (bounce-back; Price, Storn, Lampinen 2005, "Differential Evolution: A Practical Approach to Global
//! Optimization"), so trials always lie in the box and do not pile up on its walls.

mod settings;
#[cfg(test)]
mod tests;

use rand::{Rng, RngExt};

use super::bounds::Bounds;
pub use settings::{InitialError, Settings, SettingsError};

/// The result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome<Fit> {
    /// The best vector met; among equals the one in the earliest place of the last population.
    pub best: Vec<f64>,
    /// Its fitness.
    pub fitness: Fit,
    /// Evaluations made.
    pub evaluations: usize,
}

/// Whether `a` is at most `b`, NaN counting as worst: the comparison for a plain number to be minimised.
#[must_use]
pub fn at_most(a: &f64, b: &f64) -> bool {
    a <= b || b.is_nan()
}

/// Minimises by DE/rand/1/bin.
///
/// The population starts with the vectors of `initial`, in order, and is filled up with uniform draws from
/// `bounds`. Without a budget, exactly `population * (1 + generations)` evaluations are made: one for every
/// starting vector, then one for every trial. With a budget the run ends at the last evaluation it allows, be
/// it in the middle of the start or of a generation; what has been evaluated by then counts in full. If the box
/// has no coordinate there is one vector, which is evaluated once.
///
/// `evaluate(x, rival)` gives the fitness of `x`. A rival is one that `x` has to match: if `x` is strictly worse, any
/// fitness strictly worse than the rival's will do, so an evaluation may stop as soon as it is sure to be lost. The
/// rival of a trial is its target, and in the last generation the best vector so far; starting vectors have the best so
/// far as their rival too if there is at most one generation, for then nothing else depends on their fitness.
///
/// `better_or_equal(a, b)` says that `a` is at least as good as `b`. It should order every two fitnesses one way
/// or the other and be transitive: [`at_most`] does so for a number, and
/// `|a, b| !b.dominates(a)` for [`Scores<1>`](super::nsga2::Scores), which is Deb's rule. With any other
/// comparison the run still ends after as many evaluations, but what it returns may not be the best it met.
///
/// # Errors
/// If an initial vector does not lie in `bounds`, or if there are more of them than the population has places;
/// no evaluation has been made then.
pub fn minimise<Fit: Clone, R: Rng + ?Sized>(
    settings: &Settings,
    bounds: &Bounds,
    initial: &[Vec<f64>],
    rng: &mut R,
    mut evaluate: impl FnMut(&[f64], Option<&Fit>) -> Fit,
    better_or_equal: impl Fn(&Fit, &Fit) -> bool,
) -> Result<Outcome<Fit>, InitialError> {
    settings.check_initial(bounds, initial)?;
    if bounds.dimension() == 0 {
        return Ok(Outcome { best: Vec::new(), fitness: evaluate(&[], None), evaluations: 1 });
    }
    let strictly = |a: &Fit, b: &Fit| better_or_equal(a, b) && !better_or_equal(b, a);
    let budget = settings.evaluations();
    let mut evaluations = 0;
    let mut score = |x: &[f64], rival: Option<&Fit>| {
        evaluations += 1;
        evaluate(x, rival)
    };

    let size = settings.population().min(budget);
    let starts_the_last_generation = budget - size <= size;
    let mut population: Vec<(Vec<f64>, Fit)> = Vec::with_capacity(size);
    let mut best: Option<Fit> = None;
    while population.len() < size {
        let x = initial.get(population.len()).cloned().unwrap_or_else(|| bounds.sample(rng));
        let fitness = score(&x, best.as_ref().filter(|_| starts_the_last_generation));
        if best.as_ref().is_none_or(|best| strictly(&fitness, best)) {
            best = Some(fitness.clone());
        }
        population.push((x, fitness));
    }

    let mut left = budget - size;
    while left > 0 {
        let is_last = left <= size;
        let mut next = population.clone();
        for (target, place) in next.iter_mut().enumerate().take(left) {
            let trial = trial(settings, bounds, &population, target, rng);
            let rival = best.as_ref().filter(|_| is_last).unwrap_or(&place.1);
            let fitness = score(&trial, Some(rival));
            if best.as_ref().is_none_or(|best| strictly(&fitness, best)) {
                best = Some(fitness.clone());
            }
            if better_or_equal(&fitness, &place.1) {
                *place = (trial, fitness);
            }
        }
        left -= left.min(size);
        population = next;
    }

    let mut first_best = 0;
    for (i, (_, fitness)) in population.iter().enumerate() {
        if strictly(fitness, &population[first_best].1) {
            first_best = i;
        }
    }
    let (best, fitness) = population.swap_remove(first_best);
    Ok(Outcome { best, fitness, evaluations })
}

/// The vector that challenges member `target`. The population is full: at least four members.
fn trial<Fit, R: Rng + ?Sized>(
    settings: &Settings,
    bounds: &Bounds,
    population: &[(Vec<f64>, Fit)],
    target: usize,
    rng: &mut R,
) -> Vec<f64> {
    let mut others = [target; 4];
    for k in 1..4 {
        while others[..k].contains(&others[k]) {
            others[k] = rng.random_range(0..population.len());
        }
    }
    let [x, base, plus, minus] = others.map(|i| &population[i].0);
    let always = rng.random_range(0..x.len());
    let mut trial = x.clone();
    for (j, &(lo, hi)) in bounds.intervals().iter().enumerate() {
        if rng.random::<f64>() >= settings.crossover() && j != always {
            continue;
        }
        let mutant = base[j] + settings.weight() * (plus[j] - minus[j]);
        // `min` and `max` only undo rounding: the draw lies between two values of the interval.
        trial[j] = if mutant < lo {
            (base[j] + rng.random::<f64>() * (lo - base[j])).max(lo)
        } else if mutant > hi {
            (base[j] + rng.random::<f64>() * (hi - base[j])).min(hi)
        } else {
            mutant
        };
    }
    trial
}
