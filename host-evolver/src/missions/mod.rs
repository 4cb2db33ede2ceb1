//! What there is to gain in a mission, and its line in the table of a folder of missions.
//!
//! `difficulty` measures how much a mission rewards adaptation, `table` has a line on it, `circle` is the controller that keeps to the best
//! circle, which does not adapt.

mod circle;
mod difficulty;
mod table;

pub use circle::Circle;
pub use difficulty::Difficulty;
pub use table::{MissionRow, TABLE};
