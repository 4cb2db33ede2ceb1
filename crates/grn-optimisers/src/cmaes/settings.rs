//! What a run of CMA-ES is told, and the checks on it.

use core::fmt;

use crate::bounds::Bounds;

/// Checked settings of a run of [`Cmaes`](super::Cmaes).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    population: usize,
    sigma: f64,
    evaluations: usize,
    tolerance: f64,
    active: bool,
}

/// Why settings were rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SettingsError {
    /// The population is smaller than 4.
    Population(usize),
    /// The initial step size is not finite, or not above 0.
    Sigma(f64),
    /// The budget is of no evaluation at all.
    Budget,
    /// The smallest step is not finite, or below 0.
    Tolerance(f64),
}

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Population(n) => write!(f, "a population of {n}: must be at least 4"),
            Self::Sigma(sigma) => write!(f, "initial step size {sigma}: must be finite and above 0"),
            Self::Budget => write!(f, "a budget of no evaluations: must be at least 1"),
            Self::Tolerance(x) => write!(f, "smallest step {x}: must be finite and at least 0"),
        }
    }
}

impl core::error::Error for SettingsError {}

/// Why the box or the initial mean was rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StartError {
    /// The box has no coordinate.
    NoCoordinate,
    /// The initial mean has the wrong length.
    Length {
        /// Its length.
        length: usize,
        /// The length of the bounds.
        expected: usize,
    },
    /// A coordinate of the initial mean is outside its bounds, or NaN.
    Outside {
        /// Which coordinate, from 0.
        coordinate: usize,
        /// Its value.
        value: f64,
    },
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoCoordinate => write!(f, "a box without coordinates"),
            Self::Length { length, expected } => {
                write!(f, "the initial mean has {length} coordinates, the bounds have {expected}")
            }
            Self::Outside { coordinate, value } => {
                write!(f, "initial mean: coordinate {coordinate} is {value}, out of bounds")
            }
        }
    }
}

impl core::error::Error for StartError {}

impl Settings {
    /// `population` samples a generation (λ, at least 4; the tutorial's default is `4 + ⌊3 ln n⌋`, and more make
    /// the search slower and more global), an initial step size `sigma` (σ, above 0, in the coordinates' unit;
    /// about a third of the width of the region where the optimum is expected), and a budget of exactly
    /// `evaluations` (at least 1), unless the run stops earlier. The smallest step is `1e-12 sigma`.
    ///
    /// # Errors
    /// The first argument out of range.
    pub fn new(population: usize, sigma: f64, evaluations: usize) -> Result<Self, SettingsError> {
        if population < 4 {
            return Err(SettingsError::Population(population));
        }
        if !(sigma > 0.0 && sigma.is_finite()) {
            return Err(SettingsError::Sigma(sigma));
        }
        if evaluations == 0 {
            return Err(SettingsError::Budget);
        }
        Ok(Self { population, sigma, evaluations, tolerance: 1e-12 * sigma, active: true })
    }

    /// The same, but stopping when steps in every coordinate are below `tolerance` (TolX, at least 0, in the
    /// coordinates' unit).
    ///
    /// # Errors
    /// [`SettingsError::Tolerance`] if it is out of range.
    pub fn until(self, tolerance: f64) -> Result<Self, SettingsError> {
        if !(tolerance >= 0.0 && tolerance.is_finite()) {
            return Err(SettingsError::Tolerance(tolerance));
        }
        Ok(Self { tolerance, ..self })
    }

    /// The same, but learning from the better half of a generation only: no negative weights, as in CMA-ES before
    /// active covariance adaptation. Slower on most problems.
    #[must_use]
    pub fn passive(self) -> Self {
        Self { active: false, ..self }
    }

    /// λ, the number of samples a generation.
    #[must_use]
    pub fn population(&self) -> usize {
        self.population
    }

    /// σ at the start.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// The most evaluations that [`minimise`](super::minimise) makes.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// TolX, the step below which a run stops.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Whether the worse half of a generation counts, with negative weights.
    #[must_use]
    pub fn active(&self) -> bool {
        self.active
    }
}

/// Rejects a box without coordinates, and a mean that is not in the box.
pub(super) fn check_start(bounds: &Bounds, mean: &[f64]) -> Result<(), StartError> {
    if bounds.dimension() == 0 {
        return Err(StartError::NoCoordinate);
    }
    if mean.len() != bounds.dimension() {
        return Err(StartError::Length { length: mean.len(), expected: bounds.dimension() });
    }
    match bounds.outside(mean) {
        Some(coordinate) => Err(StartError::Outside { coordinate, value: mean[coordinate] }),
        None => Ok(()),
    }
}
