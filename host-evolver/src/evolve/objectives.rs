//! The objectives of a run.

use super::objective::{ALL, Candidate, ClosedLoop, Nodes, Objective, RingError};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The objectives of a run: two or three different ones, in the order in which they were asked for.
#[derive(Clone, Serialize, Deserialize)]
#[serde(try_from = "Vec<String>", into = "Vec<String>")]
pub struct Objectives(Vec<&'static dyn Objective>);

impl Objectives {
    /// The paper's: f1 and f2.
    pub fn paper() -> Self {
        Objectives(vec![&Nodes, &RingError])
    }

    /// What shows best what a swarm does: nodes and the closed loop.
    pub fn adaptive() -> Self {
        Objectives(vec![&Nodes, &ClosedLoop])
    }

    /// Whether some are made from simulated runs.
    pub fn need_trials(&self) -> bool {
        self.0.iter().any(|objective| objective.needs_trials())
    }

    /// These objectives.
    ///
    /// # Errors
    /// Fewer than two, more than three, or one given twice.
    pub fn new(objectives: Vec<&'static dyn Objective>) -> Result<Self, ObjectivesError> {
        if !(2..=3).contains(&objectives.len()) {
            return Err(ObjectivesError::Count(objectives.len()));
        }
        let repeated =
            |(place, name): (usize, &&str)| objectives[..place].iter().any(|earlier| earlier.name() == *name);
        let names: Vec<&'static str> = objectives.iter().map(|objective| objective.name()).collect();
        match names.iter().enumerate().find(|&entry| repeated(entry)) {
            Some((_, name)) => Err(ObjectivesError::Repeated(name)),
            None => Ok(Objectives(objectives)),
        }
    }

    /// Their names, in order.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|objective| objective.name())
    }

    /// The names of those that are neither nodes nor f2, which every file has anyway.
    pub fn further_names(&self) -> impl Iterator<Item = &'static str> {
        self.names().filter(|name| is_further(name))
    }

    /// The values, of all in order, that belong to [`Objectives::further_names`].
    pub fn further(&self, values: &[f64]) -> Vec<f64> {
        self.names().zip(values).filter(|(name, _)| is_further(name)).map(|(_, &value)| value).collect()
    }

    /// What they measure, in order, for people.
    pub fn descriptions(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|objective| objective.description())
    }

    /// All values in order, from those that every file has and the further ones.
    pub fn in_order(&self, nodes: f64, f2: f64, further: &[f64]) -> Vec<f64> {
        let mut further = further.iter().copied();
        let value = |name: &str| match name {
            _ if name == Nodes.name() => nodes,
            _ if name == RingError.name() => f2,
            _ => further.next().unwrap_or(f64::MAX),
        };
        self.names().map(value).collect()
    }

    /// Their values of a candidate, in order. A value that is not finite becomes the largest number: files hold no other.
    pub fn values(&self, candidate: &Candidate<'_>) -> Vec<f64> {
        let finite = |value: f64| if value.is_finite() { value } else { f64::MAX };
        self.0.iter().map(|objective| finite(objective.value(candidate))).collect()
    }
}

fn is_further(name: &str) -> bool {
    name != Nodes.name() && name != RingError.name()
}

impl fmt::Debug for Objectives {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}

impl fmt::Display for Objectives {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.names().collect::<Vec<_>>().join(","))
    }
}

impl PartialEq for Objectives {
    fn eq(&self, other: &Self) -> bool {
        self.names().eq(other.names())
    }
}

impl From<Objectives> for Vec<String> {
    fn from(objectives: Objectives) -> Self {
        objectives.names().map(String::from).collect()
    }
}

impl TryFrom<Vec<String>> for Objectives {
    type Error = ObjectivesError;

    fn try_from(names: Vec<String>) -> Result<Self, ObjectivesError> {
        let known = |name: String| {
            let found = ALL.iter().find(|objective| objective.name() == name);
            found.copied().ok_or(ObjectivesError::Unknown(name))
        };
        Objectives::new(names.into_iter().map(known).collect::<Result<_, _>>()?)
    }
}

impl FromStr for Objectives {
    type Err = ObjectivesError;

    /// Names separated by commas: `nodes,f2`.
    fn from_str(text: &str) -> Result<Self, ObjectivesError> {
        Objectives::try_from(text.split(',').map(|name| name.trim().to_owned()).collect::<Vec<_>>())
    }
}

/// What no run can minimise.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ObjectivesError {
    /// No objective has this name.
    Unknown(String),
    /// Two or three are needed.
    Count(usize),
    /// One stands there twice.
    Repeated(&'static str),
}

impl fmt::Display for ObjectivesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ObjectivesError::Unknown(name) => {
                let known: Vec<_> = ALL.iter().map(|objective| objective.name()).collect();
                write!(f, "{name:?} is no objective; there are {}", known.join(", "))
            }
            ObjectivesError::Count(count) => write!(f, "{count} objectives: give two or three, as in nodes,f2"),
            ObjectivesError::Repeated(name) => write!(f, "{name} stands there twice: give two or three different ones"),
        }
    }
}

impl std::error::Error for ObjectivesError {}
