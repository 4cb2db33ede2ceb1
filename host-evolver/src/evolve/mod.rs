//! The search for models: the paper's Algorithm 1 and its baseline, what they minimise, and the front they leave.

pub mod eh_grn;
mod front;
mod individual;
pub mod objective;
mod objectives;
mod ranking;
mod refinement;
mod search;
mod settings;
mod state;
mod task;
mod trials;

pub use front::{FrontMember, REFERENCE, deployed, front_hypervolume};
pub use individual::Individual;
pub use objective::Objective;
pub use objectives::{Objectives, ObjectivesError};
pub use search::{Advance, Search};
pub use settings::{DeSettings, MOST_EVALUATIONS, MOST_REALITIES, Settings, SettingsError};
pub use state::{Milestone, State};
pub use task::{Task, TaskError};

#[cfg(test)]
mod tests;
