//! Software-in-the-loop simulation: a world around robots that run `grn-core` unchanged.
//!
//! What a robot may know and do is [`Percept`](grn_core::robot::Percept) and [`Command`](grn_core::robot::Command);
//! everything else in here is the simulator's knowledge. From the bottom up:
//!
//! | module | what it holds |
//! |---|---|
//! | [`geometry`] | polygons, walls, rays, hulls |
//! | [`scenario`] | the TOML world: target paths, walls, morphogens, ring |
//! | [`random`] | one portable random stream per component |
//! | [`missions`] | worlds drawn at random, each for a swarm of its own |
//! | [`lab`] | the laboratory: the conditions of a run, as a file, and laboratories around it |
//! | [`timing`] | when robots think |
//! | [`body`] | wheels and differential drive |
//! | [`grid`] | neighbour queries |
//! | [`bursts`] | failures in rows |
//! | [`localisation`] | a tracking system with delay, gaps, noise and drift |
//! | [`proximity`] | the ring of proximity sensors |
//! | [`far_sense`] | the mother robots' far sense |
//! | [`radio`] | broadcasts with range, delay and loss |
//! | [`base_station`] | a base station that sends robots as the pattern asks |
//! | [`contacts`] | collisions, resolved and counted |
//! | [`brain`] | what drives a robot |
//! | [`config`] | a run's parameters |
//! | [`swarm`] | the world in motion |
//! | [`trace`] | a recorded run |
//! | [`metrics`] | what a recorded run is worth |
//! | [`flash`] | a robot's flash, with power loss |
//! | [`link`] | robots behind a link as parts of a swarm: emulated, on a bad wire |
//!
//! Results are the same bits on every machine and for any number of threads: seeded, and without the platform's
//! transcendental functions.

pub mod base_station;
pub mod body;
pub mod brain;
pub mod bursts;
pub mod config;
pub mod contacts;
pub mod far_sense;
pub mod faults;
pub mod flash;
pub mod geometry;
pub mod grid;
pub mod lab;
pub mod link;
pub mod localisation;
pub mod metrics;
pub mod missions;
pub mod proximity;
pub mod radio;
pub mod random;
pub mod scenario;
pub mod swarm;
pub mod timing;
pub mod trace;
mod units;

pub use brain::{Brain, BrainError};
pub use config::SwarmConfig;
pub use faults::FaultPlan;
pub use lab::Laboratory;
pub use metrics::{Meter, Metrics, MetricsOptions};
pub use scenario::{InputError, Scenario};
pub use swarm::{Outcome, Progress, StepError, Swarm};
pub use trace::{Observer, Recorder, Trace, TraceError};
