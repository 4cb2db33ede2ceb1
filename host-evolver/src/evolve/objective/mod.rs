//! What the search can minimise.
//!
//! A further objective is a type that implements [`Objective`] in a file of its own and its two lines here. It then can be
//! asked for by its name, is computed once for every individual, and has its column in every file and figure.

mod candidate;
mod closed_loop;
mod nodes;
mod ring_error;

pub use candidate::{Candidate, Objective};
pub use closed_loop::{ClosedLoop, Worst};
pub use nodes::Nodes;
pub use ring_error::RingError;

/// All objectives, the paper's first.
pub const ALL: &[&'static dyn Objective] = &[&Nodes, &RingError, &ClosedLoop, &Worst];
