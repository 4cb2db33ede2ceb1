//! What a good model is: the pattern it makes in a scenario, and the paper's f2 of that pattern (model page, 3 and 4).
//!
//! A scenario is prepared once: the morphogens x1 and x2 depend on the world alone and are kept on a lattice. A model is
//! then judged by flooding the inside component of each target, following its contour, and scoring candidate points.

mod chart;
mod contour;
mod fine;
mod fitness;
mod judge;
mod lanes;
mod lattice;
mod model;
mod profile;
mod ring;
mod sharpen;
mod tracer;
mod world;

pub use fitness::{CANDIDATES_PER_RING, Evaluation, SMALLEST_CLEARANCE};
pub use judge::Judge;
pub use model::Model;
pub use tracer::{Contours, Tracer};
pub use world::{LATTICE_STEP, Snapshot, World};
