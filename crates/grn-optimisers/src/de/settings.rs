//! What a run of differential evolution is told, and the checks on it.

use core::fmt;

use crate::bounds::Bounds;

/// Checked settings of a run of [`minimise`](super::minimise).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    population: usize,
    weight: f64,
    crossover: f64,
    generations: usize,
    evaluations: usize,
}

/// Why settings were rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SettingsError {
    /// The population is smaller than 4: a target and three different others.
    Population(usize),
    /// The weight F is not within (0, 2].
    Weight(f64),
    /// The crossover rate CR is not within [0, 1].
    Crossover(f64),
    /// `population * (1 + generations)` does not fit in a `usize`.
    Generations(usize),
    /// The budget is of no evaluation at all.
    Budget,
}

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Population(n) => write!(f, "a population of {n}: DE/rand/1 needs at least 4"),
            Self::Weight(w) => write!(f, "weight F = {w}: must be above 0 and at most 2"),
            Self::Crossover(cr) => write!(f, "crossover rate CR = {cr}: must be from 0 to 1"),
            Self::Generations(n) => {
                write!(f, "{n} generations: too many to count their evaluations")
            }
            Self::Budget => write!(f, "a budget of no evaluations: must be at least 1"),
        }
    }
}

impl core::error::Error for SettingsError {}

/// Why the caller's initial vectors were rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InitialError {
    /// More initial vectors than places in the population.
    TooMany {
        /// How many were given.
        given: usize,
        /// How many places there are.
        population: usize,
    },
    /// A vector of the wrong length.
    Length {
        /// Which vector, from 0.
        vector: usize,
        /// Its length.
        length: usize,
        /// The length of the bounds.
        expected: usize,
    },
    /// A coordinate outside its bounds, or NaN.
    Outside {
        /// Which vector, from 0.
        vector: usize,
        /// Which coordinate, from 0.
        coordinate: usize,
        /// Its value.
        value: f64,
    },
}

impl fmt::Display for InitialError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooMany { given, population } => {
                write!(f, "{given} initial vectors for a population of {population}")
            }
            Self::Length { vector, length, expected } => {
                write!(f, "initial vector {vector} has {length} coordinates, the bounds have {expected}")
            }
            Self::Outside { vector, coordinate, value } => {
                write!(f, "initial vector {vector}: coordinate {coordinate} is {value}, out of bounds")
            }
        }
    }
}

impl core::error::Error for InitialError {}

impl Settings {
    /// A population of `population` vectors (NP, at least 4), weight `weight` (F, above 0 and at most 2),
    /// crossover rate `crossover` (CR, 0 to 1), and that many `generations` after the start (0 evaluates the
    /// start alone). No budget but the one that follows: `population * (1 + generations)` evaluations.
    ///
    /// # Errors
    /// The first argument out of range.
    pub fn new(population: usize, weight: f64, crossover: f64, generations: usize) -> Result<Self, SettingsError> {
        if population < 4 {
            return Err(SettingsError::Population(population));
        }
        if !(weight > 0.0 && weight <= 2.0) {
            return Err(SettingsError::Weight(weight));
        }
        if !(0.0..=1.0).contains(&crossover) {
            return Err(SettingsError::Crossover(crossover));
        }
        let evaluations = generations.checked_add(1).and_then(|n| n.checked_mul(population));
        let Some(evaluations) = evaluations else {
            return Err(SettingsError::Generations(generations));
        };
        Ok(Self { population, weight, crossover, generations, evaluations })
    }

    /// The same, but ending after at most `evaluations`, wherever in a generation that is.
    ///
    /// # Errors
    /// [`SettingsError::Budget`] if it is 0.
    pub fn within(self, evaluations: usize) -> Result<Self, SettingsError> {
        if evaluations == 0 {
            return Err(SettingsError::Budget);
        }
        Ok(Self { evaluations: self.evaluations.min(evaluations), ..self })
    }

    /// NP, the number of vectors kept.
    #[must_use]
    pub fn population(&self) -> usize {
        self.population
    }

    /// F, the weight of the difference.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// CR, the probability that a coordinate comes from the mutant.
    #[must_use]
    pub fn crossover(&self) -> f64 {
        self.crossover
    }

    /// Generations after the start, unless a budget ends the run earlier.
    #[must_use]
    pub fn generations(&self) -> usize {
        self.generations
    }

    /// How many evaluations a run makes (in a box with at least one coordinate).
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Rejects initial vectors that are too many or not in the box.
    pub(super) fn check_initial(&self, bounds: &Bounds, initial: &[Vec<f64>]) -> Result<(), InitialError> {
        let (given, population, expected) = (initial.len(), self.population, bounds.dimension());
        if given > population {
            return Err(InitialError::TooMany { given, population });
        }
        for (vector, x) in initial.iter().enumerate() {
            if x.len() != expected {
                return Err(InitialError::Length { vector, length: x.len(), expected });
            }
            if let Some(coordinate) = bounds.outside(x) {
                return Err(InitialError::Outside { vector, coordinate, value: x[coordinate] });
            }
        }
        Ok(())
    }
}
