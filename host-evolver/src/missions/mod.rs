//! What there is to gain in a mission, and its line in the table of a folder of missions.
//!
//! `difficulty` measures how much a mission rewards adaptation, `table` has a line on it.

mod difficulty;
mod table;

pub use difficulty::Difficulty;
pub use table::{MissionRow, TABLE};
