//! The parts of the controller that owe nothing to genes, for controllers that decide otherwise where to go and are to be compared with
//! it: what a robot knows, where it is, how it keeps clear of what it feels, and how it drives.
//!
//! The order in which a tick uses them is that of [`Controller::tick`](super::Controller::tick). They may change with it.

pub use super::avoidance::Avoidance;
pub use super::clock::{Clock, Pace};
pub use super::drive::Drive;
pub use super::knowledge::{Knowledge, KnownTarget};
pub use super::localisation::{Localisation, Pose};
pub use super::neighbours::{Neighbour, Neighbours};
pub use super::position::metres;
