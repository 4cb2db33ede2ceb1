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
/// fitness strictly worse than the rival's will do, so an evaluation may stop as soon as it is sure to be lost: see
/// [`Wanted`], and [`minimise_together`] to evaluate many at once.
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
    let strictly = |a: &Fit, b: &Fit| better_or_equal(a, b) && !better_or_equal(b, a);
    let one_by_one = |vectors: &[Vec<f64>], wanted: Wanted<'_, Fit>| match wanted {
        Wanted::All => vectors.iter().map(|x| evaluate(x, None)).collect(),
        Wanted::Winners(rivals) => vectors.iter().zip(rivals).map(|(x, rival)| evaluate(x, Some(rival))).collect(),
        Wanted::Best(rival) => {
            let mut best = rival.cloned();
            let mut score = |x: &Vec<f64>| {
                let fitness = evaluate(x, best.as_ref());
                if best.as_ref().is_none_or(|best| strictly(&fitness, best)) {
                    best = Some(fitness.clone());
                }
                fitness
            };
            vectors.iter().map(&mut score).collect()
        }
    };
    minimise_together(settings, bounds, initial, rng, one_by_one, &better_or_equal)
}

/// Which of the vectors that are evaluated together need their exact fitness.
#[derive(Clone, Copy, Debug)]
pub enum Wanted<'a, Fit> {
    /// Every one.
    All,
    /// Those that are as good as their own rival, a target each; the others may get any fitness that is strictly worse
    /// than the rival's.
    Winners(&'a [Fit]),
    /// The best ones, if they are as good as the rival, the best vector so far; the others may get any fitness that is
    /// strictly worse than the best's or the rival's. So it is in the last generation, for nothing else depends on the
    /// others' fitness.
    Best(Option<&'a Fit>),
}

/// The same as [`minimise`] with all vectors of a generation evaluated together: `evaluate(vectors, wanted)` gives a
/// fitness for each.
///
/// # Errors
/// As for [`minimise`].
pub fn minimise_together<Fit: Clone, R: Rng + ?Sized>(
    settings: &Settings,
    bounds: &Bounds,
    initial: &[Vec<f64>],
    rng: &mut R,
    mut evaluate: impl FnMut(&[Vec<f64>], Wanted<'_, Fit>) -> Vec<Fit>,
    better_or_equal: impl Fn(&Fit, &Fit) -> bool,
) -> Result<Outcome<Fit>, InitialError> {
    settings.check_initial(bounds, initial)?;
    let strictly = |a: &Fit, b: &Fit| better_or_equal(a, b) && !better_or_equal(b, a);
    let (size, budget) = if bounds.dimension() == 0 {
        (1, 1)
    } else {
        (settings.population().min(settings.evaluations()), settings.evaluations())
    };
    let mut population: Vec<Vec<f64>> = initial.iter().take(size).cloned().collect();
    population.resize_with(size, || bounds.sample(rng));
    let mut left = budget - size;
    let mut trials = |population: &[Vec<f64>], left: &mut usize| -> Vec<Vec<f64>> {
        let trials = (0..size.min(*left)).map(|target| trial(settings, bounds, population, target, rng));
        let trials: Vec<_> = trials.collect();
        *left -= trials.len();
        trials
    };
    // Trials are made from the vectors, not from their fitness: those of the only generation can be evaluated with them.
    let mut challengers = if left <= size { trials(&population, &mut left) } else { Vec::new() };
    let mut fitness = if left == 0 {
        let together: Vec<_> = population.iter().chain(&challengers).cloned().collect();
        evaluate(&together, Wanted::Best(None))
    } else {
        evaluate(&population, Wanted::All)
    };
    let mut results = fitness.split_off(size);
    loop {
        let found = challengers.into_iter().zip(results);
        for ((x, fitness), (trial, result)) in population.iter_mut().zip(&mut fitness).zip(found) {
            if better_or_equal(&result, fitness) {
                (*x, *fitness) = (trial, result);
            }
        }
        if left == 0 {
            break;
        }
        challengers = trials(&population, &mut left);
        let wanted = if left == 0 {
            Wanted::Best(Some(&fitness[best_of(&fitness, strictly)]))
        } else {
            Wanted::Winners(&fitness)
        };
        results = evaluate(&challengers, wanted);
    }

    let best = best_of(&fitness, strictly);
    Ok(Outcome { best: population.swap_remove(best), fitness: fitness.swap_remove(best), evaluations: budget })
}

/// The place of the best; the first among equals.
fn best_of<Fit>(fitness: &[Fit], strictly_better: impl Fn(&Fit, &Fit) -> bool) -> usize {
    (1..fitness.len()).fold(0, |best, i| if strictly_better(&fitness[i], &fitness[best]) { i } else { best })
}

/// The vector that challenges member `target`. The population is full: at least four members.
fn trial<R: Rng + ?Sized>(
    settings: &Settings,
    bounds: &Bounds,
    population: &[Vec<f64>],
    target: usize,
    rng: &mut R,
) -> Vec<f64> {
    let mut others = [target; 4];
    for k in 1..4 {
        while others[..k].contains(&others[k]) {
            others[k] = rng.random_range(0..population.len());
        }
    }
    let [x, base, plus, minus] = others.map(|i| &population[i]);
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
