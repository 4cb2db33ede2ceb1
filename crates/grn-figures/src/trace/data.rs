//! A run, as its figure takes it.

use crate::chart::map::Window;

/// A robot at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Where it is, metres.
    pub position: [f64; 2],
    /// Where it looks, radians anticlockwise from the x axis.
    pub heading: f64,
}

/// A moment at which the map shows the swarm.
#[derive(Debug, Clone, PartialEq)]
pub struct Instant {
    /// Seconds from the start.
    pub time: f64,
    /// The robots.
    pub robots: Vec<Pose>,
    /// The targets, metres.
    pub targets: Vec<[f64; 2]>,
    /// The pattern: closed contours, metres.
    pub contours: Vec<Vec<[f64; 2]>>,
    /// Obstacles that move, or are not always there, as they are then: closed polygons, metres.
    pub walls: Vec<Vec<[f64; 2]>>,
}

/// A run.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceFigure {
    /// The part of the world to show.
    pub window: Window,
    /// Obstacles that are always there, closed polygons, metres.
    pub walls: Vec<Vec<[f64; 2]>>,
    /// Paths of the targets, metres.
    pub target_paths: Vec<Vec<[f64; 2]>>,
    /// Paths of the robots, metres.
    pub trajectories: Vec<Vec<[f64; 2]>>,
    /// Radius of a robot, metres; drawn larger where it would be too small to see.
    pub body_radius: f64,
    /// The moments shown, in order of time.
    pub instants: Vec<Instant>,
    /// Times of the series below the map, seconds, increasing.
    pub times: Vec<f64>,
    /// For each target, at each time, the largest angle between neighbouring robots as the target sees them, degrees;
    /// none while the target is not there.
    pub gaps: Vec<Vec<Option<f64>>>,
    /// At each time, the median over robots of the distance to the pattern, metres; none where it is not known.
    pub radial_error: Vec<Option<f64>>,
    /// What counts as on the pattern: 10 % of its radius, metres; none for a pattern without one.
    pub radial_band: Option<f64>,
}
