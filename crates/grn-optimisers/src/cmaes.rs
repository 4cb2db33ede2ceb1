//! CMA-ES, the covariance matrix adaptation evolution strategy, with the default parameters of Hansen, "The CMA
//! Evolution Strategy: A Tutorial" (arXiv:1604.00772v2); equation numbers are those of its Appendix A.
//!
//! A generation draws λ vectors from a normal distribution with mean `m`, step size `σ` and covariance `σ² C`, ranks
//! them, moves `m` to the weighted mean of the better half, and learns `σ` and `C` from where the better ones lay,
//! now and over past generations. Only ranks count, so any fitness that can be compared will do, and any increasing
//! function of it gives the same search.
//!
//! - **Active.** The worse half enters `C` with negative weights (eqs. 46 and 53), as in the tutorial and in pycma,
//!   unless the settings are [`passive`](Settings::passive).
//! - **Damping.** Steps change more slowly than in the tutorial if the population is large for the dimension: with the
//!   damping of pycma 4.5.0, see `cmaes/parameters.rs`.
//! - **Bounds.** The distribution is not bounded: samples are folded into the box (a smooth mirror, as in pycma). Within
//!   the middle nine tenths of every interval this changes nothing; an optimum on a wall, an edge or a corner, where
//!   redrawing samples would hardly ever succeed, is found like any other.
//! - **Units.** All coordinates start with the same step: scale them to similar sensitivity.
//!
//! [`minimise`] is the whole search. [`Cmaes`] is one generation at a time, for callers that evaluate in parallel,
//! watch the distribution, or stop and go on later (it can be cloned, and has no state but its own).

mod boundary;
mod parameters;
mod settings;
#[cfg(test)]
mod tests;

use core::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::{Rng, RngExt};

use super::bounds::Bounds;
use boundary::{fold, unfold};
use parameters::Parameters;
pub use settings::{Settings, SettingsError, StartError};

/// The largest ratio of the eigenvalues of `C` (ConditionCov).
const CONDITION: f64 = 1e14;
/// The largest growth of the longest axis of the distribution (TolXUp).
const GROWTH: f64 = 1e4;

/// Why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// All the evaluations allowed were made.
    Budget,
    /// The target was reached.
    Target,
    /// Steps in every coordinate, and the path of the covariance, are below the tolerance (TolX).
    Step,
    /// The longest axis of the distribution is 10⁴ times as long as at the start: the initial step was far too small
    /// (TolXUp).
    Growth,
    /// The longest axis of the distribution is 10⁷ times as long as the shortest (ConditionCov).
    Condition,
    /// The best fitness of a generation was the same for `10 + ⌈30 n / λ⌉` generations (EqualFunValues).
    Flat,
}

/// The result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome<Fit> {
    /// The best vector met; the first among equals.
    pub best: Vec<f64>,
    /// Its fitness.
    pub fitness: Fit,
    /// Evaluations made.
    pub evaluations: usize,
    /// Why there were no more.
    pub reason: Reason,
}

/// The state of a search between generations: [`ask`](Self::ask) for a population, evaluate it, [`rank`] it, and
/// [`tell`](Self::tell).
///
/// ```
/// use grn_optimisers::{bounds::Bounds, cmaes::{Cmaes, Settings, rank}, de::at_most};
/// use rand::SeedableRng;
///
/// let settings = Settings::new(10, 0.5, 1000)?;
/// let mut search = Cmaes::new(&settings, &Bounds::cube(3, 0.0, 2.0)?, &[1.0; 3])?;
/// let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(1);
/// while search.stop().is_none() && search.generation() < 100 {
///     let population = search.ask(&mut rng);
///     let fitness: Vec<f64> = population.iter().map(|x| x.iter().map(|x| (x - 0.3).powi(2)).sum()).collect();
///     search.tell(&rank(&fitness, at_most));
/// }
/// assert!(search.mean().into_iter().all(|x| (x - 0.3).abs() < 1e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Cmaes {
    settings: Settings,
    bounds: Bounds,
    parameters: Parameters,
    generation: usize,
    /// m, not folded into the box.
    mean: DVector<f64>,
    sigma: f64,
    /// C.
    covariance: DMatrix<f64>,
    /// B, whose columns are the unit axes of C, and D, the square roots of its eigenvalues: as of the last
    /// decomposition.
    axes: DMatrix<f64>,
    lengths: DVector<f64>,
    path_sigma: DVector<f64>,
    path_c: DVector<f64>,
    /// The samples of the population last asked for, as y in m + σ y.
    steps: Vec<DVector<f64>>,
    /// The covariance was no longer positive definite.
    degenerate: bool,
}

impl Cmaes {
    /// A search about to start from `mean`, in all directions alike.
    ///
    /// # Errors
    /// If the box has no coordinate, or if `mean` does not lie in it.
    pub fn new(settings: &Settings, bounds: &Bounds, mean: &[f64]) -> Result<Self, StartError> {
        settings::check_start(bounds, mean)?;
        let n = mean.len();
        Ok(Self {
            settings: *settings,
            bounds: bounds.clone(),
            parameters: Parameters::new(n, settings.population(), settings.active()),
            generation: 0,
            mean: DVector::from_iterator(n, mean.iter().zip(bounds.intervals()).map(|(&x, &ends)| unfold(x, ends))),
            sigma: settings.sigma(),
            covariance: DMatrix::identity(n, n),
            axes: DMatrix::identity(n, n),
            lengths: DVector::repeat(n, 1.0),
            path_sigma: DVector::zeros(n),
            path_c: DVector::zeros(n),
            steps: Vec::new(),
            degenerate: false,
        })
    }

    /// The mean of the distribution, folded into the box: the best guess where the optimum is.
    #[must_use]
    pub fn mean(&self) -> Vec<f64> {
        self.fold(&self.mean)
    }

    fn fold(&self, free: &DVector<f64>) -> Vec<f64> {
        free.iter().zip(self.bounds.intervals()).map(|(&x, &ends)| fold(x, ends)).collect()
    }

    /// The step size σ, in the coordinates' unit.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Generations told so far.
    #[must_use]
    pub fn generation(&self) -> usize {
        self.generation
    }

    /// The vectors to evaluate next: λ of them, all in the box (eqs. 38 to 40).
    pub fn ask<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Vec<Vec<f64>> {
        let n = self.mean.len();
        // Only products with vectors: nalgebra leaves larger ones to code that differs from processor to processor.
        let draw = |_| &self.axes * standard_normal(rng, n).component_mul(&self.lengths);
        self.steps = (0..self.settings.population()).map(draw).collect();
        self.steps.iter().map(|step| self.fold(&(&self.mean + step * self.sigma))).collect()
    }

    /// Learns how the population last asked for is ranked: the places of its vectors, best first.
    ///
    /// # Panics
    /// If it is not as many as were asked for, or one is not a place.
    pub fn tell(&mut self, order: &[usize]) {
        assert!(!order.is_empty() && order.len() == self.steps.len(), "a rank for every vector asked for");
        let population = core::mem::take(&mut self.steps);
        let steps = || order.iter().map(|&i| &population[i]);
        let p = &self.parameters;
        let n = self.mean.len() as f64;
        self.generation += 1;

        // Selection and recombination (eqs. 41 and 42).
        let mut step = DVector::zeros(self.mean.len());
        for (y, &weight) in steps().zip(&p.weights).filter(|(_, weight)| **weight > 0.0) {
            step.axpy(weight, y, 1.0);
        }
        self.mean.axpy(self.sigma, &step, 1.0);

        // Step size (eqs. 43 and 44). In the axes' own frame C^(-1/2) only divides by their lengths.
        let mut white = DVector::zeros(self.mean.len());
        white.gemv(1.0, &self.axes, &self.whiten(&step), 0.0);
        self.path_sigma.axpy((p.c_sigma * (2.0 - p.c_sigma) * p.mu_eff).sqrt(), &white, 1.0 - p.c_sigma);
        let stride = self.path_sigma.norm() / p.chi;
        let grown = 1.0 - libm::pow(1.0 - p.c_sigma, 2.0 * self.generation as f64);

        // Covariance (eqs. 45 to 47); its path stalls while steps grow fast.
        let stalled = stride / grown.sqrt() >= 1.4 + 2.0 / (n + 1.0);
        let pull = if stalled { 0.0 } else { (p.c_c * (2.0 - p.c_c) * p.mu_eff).sqrt() };
        self.path_c.axpy(pull, &step, 1.0 - p.c_c);
        let lost = if stalled { p.c_c * (2.0 - p.c_c) } else { 0.0 };
        self.covariance *= 1.0 - p.c_1 * (1.0 - lost) - p.c_mu * p.weights.iter().sum::<f64>();
        self.covariance.ger(p.c_1, &self.path_c, &self.path_c, 1.0);
        for (y, &weight) in steps().zip(&p.weights) {
            let scale = if weight < 0.0 { n / self.whiten(y).norm_squared() } else { 1.0 };
            self.covariance.ger(p.c_mu * weight * scale, y, y, 1.0);
        }
        self.sigma *= libm::exp(p.c_sigma / p.d_sigma * (stride - 1.0));
        if self.generation.is_multiple_of(p.gap) {
            self.decompose();
        }
    }

    /// `D⁻¹ Bᵀ y`: as long as `C^(-1/2) y`, and `B` turns it into that.
    fn whiten(&self, y: &DVector<f64>) -> DVector<f64> {
        self.axes.tr_mul(y).component_div(&self.lengths)
    }

    /// `C = B D² Bᵀ`.
    fn decompose(&mut self) {
        let most_steps = 100 * self.mean.len();
        match SymmetricEigen::try_new(self.covariance.clone(), f64::EPSILON, most_steps) {
            Some(eigen) if eigen.eigenvalues.iter().all(|value| *value > 0.0 && value.is_finite()) => {
                self.axes = eigen.eigenvectors;
                self.lengths = eigen.eigenvalues.map(f64::sqrt);
            }
            _ => self.degenerate = true,
        }
    }

    /// Why there is no point in going on, if so: [`Reason::Step`], [`Reason::Growth`] or [`Reason::Condition`].
    #[must_use]
    pub fn stop(&self) -> Option<Reason> {
        let small = |x: f64| self.sigma * x.abs() < self.settings.tolerance();
        let (shortest, longest) = (self.lengths.min(), self.lengths.max());
        if self.path_c.iter().all(|&x| small(x)) && self.covariance.diagonal().iter().all(|x| small(x.sqrt())) {
            Some(Reason::Step)
        } else if self.sigma * longest > GROWTH * self.settings.sigma() {
            Some(Reason::Growth)
        } else if self.degenerate || longest * longest > CONDITION * shortest * shortest {
            Some(Reason::Condition)
        } else {
            None
        }
    }
}

/// `n` independent standard normal numbers, two from every two of `rng` (Box and Muller 1958).
fn standard_normal<R: Rng + ?Sized>(rng: &mut R, n: usize) -> DVector<f64> {
    let mut z = DVector::zeros(n);
    for pair in z.as_mut_slice().chunks_mut(2) {
        // From (0, 1], where the logarithm is finite.
        let radius = (-2.0 * libm::log(1.0 - rng.random::<f64>())).sqrt();
        let (sin, cos) = libm::sincos(TAU * rng.random::<f64>());
        pair.iter_mut().zip([cos, sin]).for_each(|(z, unit)| *z = radius * unit);
    }
    z
}

/// The places of `fitness`, best first; equals, and whatever `better_or_equal` cannot put in order, by index.
#[must_use]
pub fn rank<Fit>(fitness: &[Fit], better_or_equal: impl Fn(&Fit, &Fit) -> bool) -> Vec<usize> {
    let mut order = Vec::with_capacity(fitness.len());
    for (i, fit) in fitness.iter().enumerate() {
        order.insert(order.partition_point(|&j: &usize| better_or_equal(&fitness[j], fit)), i);
    }
    order
}

/// Minimises by CMA-ES from `mean`, until something stops the search: see [`Reason`].
///
/// `better_or_equal(a, b)` says that `a` is at least as good as `b`; it should order every two fitnesses one way or
/// the other and be transitive: [`at_most`](super::de::at_most) does so for a number, and `|a, b| !b.dominates(a)`
/// for [`Scores<1>`](super::nsga2::Scores), which is Deb's rule. With any other comparison the run still ends within
/// the budget, but what it returns may not be the best it met. The run ends at the evaluation that is at least as
/// good as `target`, if there is one, or at the last one that the budget allows.
///
/// # Errors
/// If the box has no coordinate, or if `mean` does not lie in it; no evaluation has been made then.
pub fn minimise<Fit: Clone, R: Rng + ?Sized>(
    settings: &Settings,
    bounds: &Bounds,
    mean: &[f64],
    target: Option<&Fit>,
    rng: &mut R,
    mut evaluate: impl FnMut(&[f64]) -> Fit,
    better_or_equal: impl Fn(&Fit, &Fit) -> bool,
) -> Result<Outcome<Fit>, StartError> {
    let mut search = Cmaes::new(settings, bounds, mean)?;
    let most_equal = 10 + (30 * mean.len()).div_ceil(settings.population());
    let (mut best, mut evaluations): (Option<(Vec<f64>, Fit)>, usize) = (None, 0);
    let (mut last, mut equal): (Option<Fit>, usize) = (None, 0);
    let reason = 'run: loop {
        let population = search.ask(rng);
        let mut fitness = Vec::with_capacity(population.len());
        for x in &population {
            let fit = evaluate(x);
            evaluations += 1;
            let reached = target.is_some_and(|target| better_or_equal(&fit, target));
            if best.as_ref().is_none_or(|(_, best)| !better_or_equal(best, &fit)) {
                best = Some((x.clone(), fit.clone()));
            }
            fitness.push(fit);
            if reached {
                break 'run Reason::Target;
            }
            if evaluations == settings.evaluations() {
                break 'run Reason::Budget;
            }
        }
        let order = rank(&fitness, &better_or_equal);
        search.tell(&order);

        let first = fitness.swap_remove(order[0]);
        let same = |last: &Fit| better_or_equal(last, &first) && better_or_equal(&first, last);
        equal = if last.as_ref().is_some_and(same) { equal + 1 } else { 1 };
        last = Some(first);
        if equal == most_equal {
            break Reason::Flat;
        }
        if let Some(reason) = search.stop() {
            break reason;
        }
    };
    // At least one evaluation has been made.
    let (best, fitness) = best.unwrap_or_else(|| unreachable!());
    Ok(Outcome { best, fitness, evaluations, reason })
}
