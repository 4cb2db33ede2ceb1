//! What a good model is: the pattern it makes in a scenario, and the paper's f2 of that pattern (model page, 3 and 4).
//!
//! How a model is evaluated:
//!
//! 1. [`World`] prepares a scenario once: the morphogens x1 and x2 depend on the world alone and are kept on a lattice.
//! 2. `error_table` tabulates the model's pattern error over (x1, x2), where that is accurate enough.
//! 3. `contour` floods the inside component of each target and follows its edge, which `refine` makes exact; `tracer` decides whether
//!    the coarse lattice leaves a doubt, and then takes the fine one. `hidden` knows the walls that a lattice does not show,
//!    `window` looks closely at patterns too small for either.
//! 4. `candidates` spaces points equally along each contour, `corners` adds those that a lattice cuts off.
//! 5. `fitness` sums f2 and the violation of a snapshot from the tabulated `terms`.
//! 6. [`Evaluator`] chooses which snapshot of which model comes next, and stops once it is sure which models win.

mod candidates;
pub mod constraints;
mod contour;
mod corners;
mod distance_table;
mod error_table;
mod evaluator;
mod fine_lattice;
mod fitness;
mod ground;
mod hidden;
mod lanes;
mod lattice;
mod medium;
mod model;
mod refine;
mod terms;
mod tracer;
mod view;
mod window;
mod world;

pub use constraints::{ConstraintNames, Constraints, SMALLEST_CLEARANCE};
pub use evaluator::Evaluator;
pub use fitness::{CANDIDATES_PER_RING, Evaluation, TargetDistance};
pub use lattice::LATTICE_STEP;
pub use model::Model;
pub(crate) use terms::Terms;
pub use tracer::{Contours, Tracer};
pub use world::{Moment, Snapshot, World};
