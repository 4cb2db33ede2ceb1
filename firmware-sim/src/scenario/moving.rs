//! Walls that move, turn, come and go.

use super::path::{Stretch, stretch};
use super::{Disc, Path, Presence};
use crate::geometry::{Bounds, Polygon, length_squared};
use grn_core::geometry::{Point, Vector};

/// How a wall moves: a point of it follows a path, and the wall turns about that point.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    path: Path,
    turns_deg: Vec<f64>,
}

impl Motion {
    /// `path` is timed, and `turns_deg` has an entry for each of its points.
    pub(super) fn new(path: Path, turns_deg: Vec<f64>) -> Self {
        debug_assert!(path.times().is_some() && path.points().len() == turns_deg.len());
        Motion { path, turns_deg }
    }

    /// What the point about which the wall turns follows; the wall is drawn for its first point.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// By the path's points how far the wall has turned from how it is drawn, counter-clockwise, degrees.
    pub fn turns_deg(&self) -> &[f64] {
        &self.turns_deg
    }

    fn turn_deg_at(&self, time: f64) -> f64 {
        let turns = &self.turns_deg;
        match stretch(self.path.times().unwrap_or_default(), time) {
            Stretch::Before => turns[0],
            Stretch::Between(begun, share) => turns[begun] + (turns[begun + 1] - turns[begun]) * share,
            Stretch::After => turns[turns.len() - 1],
        }
    }

    /// Where a point of the wall as it is drawn is at a time.
    fn moved(&self, time: f64) -> impl Fn(Point<f64>) -> Point<f64> {
        let drawn = self.path.points().first().copied().unwrap_or(Point::ZERO);
        let (sin, cos) = libm::sincos(self.turn_deg_at(time).to_radians());
        let now = self.path.at(time);
        move |point| {
            let arm = point - drawn;
            now + Vector::new(arm.x * cos - arm.y * sin, arm.x * sin + arm.y * cos)
        }
    }
}

/// A wall or disc that is not always where it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingWall {
    /// Its place among the scenario's walls, or among its discs, counted from 0.
    pub(super) place: usize,
    /// What it is, if it is a disc; `drawn` is its outline then.
    pub(super) disc: Option<Disc>,
    pub(super) drawn: Polygon,
    pub(super) motion: Option<Motion>,
    pub(super) presence: Presence,
}

impl MovingWall {
    /// The wall as it is drawn.
    pub fn drawn(&self) -> &Polygon {
        &self.drawn
    }

    /// The disc that it is, as it is drawn; `None` of a polygon.
    pub fn disc(&self) -> Option<Disc> {
        self.disc
    }

    /// What it is in a file: `wall[2]`, `disc[0]`.
    pub(super) fn key(&self) -> String {
        format!("{}[{}]", if self.disc.is_some() { "disc" } else { "wall" }, self.place)
    }

    /// How it moves, if it does.
    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }

    /// When it is there.
    pub fn presence(&self) -> &Presence {
        &self.presence
    }

    /// The wall at a time, 0 to 1; `None` while it is not there.
    pub fn at(&self, time: f64) -> Option<Polygon> {
        let there = self.presence.holds(time);
        there.then(|| match &self.motion {
            Some(motion) => self.drawn.moved(motion.moved(time)),
            None => self.drawn.clone(),
        })
    }

    /// How far its fastest point would go in the whole run at its greatest speed, metres; a little more if it moves and turns at once.
    pub(super) fn length_at_full_speed(&self) -> f64 {
        let Some(motion) = &self.motion else { return 0.0 };
        let arm = self.longest_arm(motion);
        let times = motion.path.times().unwrap_or_default();
        let stretches = times.windows(2).zip(motion.turns_deg.windows(2));
        let fastest_turn = stretches.map(|(time, turn)| (turn[1] - turn[0]).to_radians().abs() / (time[1] - time[0]));
        motion.path.length_at_full_speed() + arm * fastest_turn.fold(0.0, f64::max)
    }

    /// From the point about which it turns to the vertex farthest from it, metres.
    fn longest_arm(&self, motion: &Motion) -> f64 {
        let drawn = motion.path.points().first().copied().unwrap_or(Point::ZERO);
        self.drawn.vertices().iter().map(|&vertex| length_squared(vertex - drawn)).fold(0.0, f64::max).sqrt()
    }

    /// A box that it never leaves.
    pub(super) fn reach(&self) -> Bounds {
        let Some(motion) = &self.motion else { return self.drawn.bounds() };
        let arm = self.longest_arm(motion);
        let arm = Vector::new(arm, arm);
        let corners = motion.path.points().iter().flat_map(|&point| [point - arm, point + arm]);
        Bounds::around(corners).unwrap_or(self.drawn.bounds())
    }

    #[must_use]
    pub(super) fn scaled(&self, factor: f64) -> MovingWall {
        let scaled = |motion: &Motion| Motion { path: motion.path.scaled(factor), turns_deg: motion.turns_deg.clone() };
        let disc = self.disc.map(|disc| disc.scaled(factor));
        MovingWall {
            place: self.place,
            disc,
            drawn: disc.map_or_else(|| self.drawn.scaled(factor), |disc| disc.outline()),
            motion: self.motion.as_ref().map(scaled),
            presence: self.presence.clone(),
        }
    }
}
