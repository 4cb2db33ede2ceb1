//! General optimisers, and statistics to compare them by. Nothing here knows what a gene or a robot is: a problem is a closure from a vector, or
//! a list of scores, to be minimised.
//!
//! | module | what it holds |
//! |---|---|
//! | [`nsga2`] | Deb's constrained dominance, non-dominated sorting, crowding, survival, binary tournament |
//! | [`real`] | operators for real vectors (SBX, polynomial mutation) and NSGA-II built from them |
//! | [`de`] | differential evolution DE/rand/1/bin for any fitness that can be compared |
//! | [`cmaes`] | CMA-ES, whole or one generation at a time, for any fitness that can be compared |
//! | [`knee`] | which point of a two-objective front is the knee: by angle, by marginal utility |
//! | [`parsimony`] | which of several noisily known candidates to prefer: the simplest of the best |
//! | [`hypervolume`] | the exact area a two-objective front dominates |
//! | [`bounds`] | the box a real vector lives in |
//! | [`statistics`] | quartiles, effect sizes, tests with correction, intervals |
//! | [`problems`] | problems with known fronts, to hold the optimisers to: ZDT1-3 and DO2DK |
//!
//! # What all of them promise
//!
//! - **Minimisation.** Smaller is better in every objective. To maximise, negate.
//! - **Equal seed, equal log.** The only source of chance is the generator the caller passes in. Two calls with
//!   equal arguments and equal generators ask for the same evaluations in the same order, return the same bits
//!   and leave the generators in the same state, on every machine: transcendental functions come from `libm`,
//!   nothing depends on addresses, hash order, threads or time, and ties are broken by index (or by a coin from
//!   that generator, where it says so). What a generator's words become (a float, an index) is `rand`'s
//!   business, which keeps it within a minor version.
//! - **Exact budgets.** Where a number of evaluations is given, no more are made, even if it ends in the middle
//!   of a generation.
//! - **Rejected arguments.** Settings are checked by their constructors and cannot be changed afterwards; an
//!   argument out of range is an error that says which one and what it was, before any evaluation is made.
//! - **NaN is worst.** An objective or violation that is not a number counts as positive infinity. It never
//!   panics and never beats a number.
//!
//! # An example: a constrained minimum by differential evolution
//!
//! ```
//! use grn_optimisers::{bounds::Bounds, de, nsga2::Scores};
//! use rand::SeedableRng;
//!
//! // Least x² + y² with x + y at least 1: Deb's rule compares, so nothing has to be weighed against the constraint.
//! let settings = de::Settings::new(30, 0.5, 0.9, 100)?;
//! let bounds = Bounds::cube(2, -5.0, 5.0)?;
//! let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(1);
//! let found = de::minimise(
//!     &settings,
//!     &bounds,
//!     &[],
//!     &mut rng,
//!     |x, _| Scores { objectives: [x[0] * x[0] + x[1] * x[1]], violation: (1.0 - x[0] - x[1]).max(0.0) },
//!     |a, b| !b.dominates(a),
//! )?;
//! assert!((found.best[0] - 0.5).abs() < 1e-3 && (found.best[1] - 0.5).abs() < 1e-3);
//! assert_eq!(found.evaluations, 30 + 30 * 100);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bounds;
pub mod cmaes;
pub mod de;
pub mod hypervolume;
pub mod knee;
pub mod nsga2;
pub mod parsimony;
pub mod problems;
pub mod real;
pub mod statistics;
