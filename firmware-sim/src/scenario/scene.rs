//! A world at one moment, and when in a run which moment is.

use super::Scenario;
use crate::config::SwarmConfig;
use crate::geometry::Walls;
use grn_core::geometry::Point;

/// Where targets and walls are at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    time: f64,
    targets: Vec<Option<Point<f64>>>,
    walls: Walls,
}

impl Scene {
    /// The world at a time, 0 to 1.
    pub fn of(world: &Scenario, time: f64) -> Scene {
        let targets = world.targets().iter().map(|target| target.at(time)).collect();
        Scene { time, targets, walls: world.walls_at(time) }
    }

    /// Lets the time of its world, which must be the same one always, be `time`.
    pub fn move_to(&mut self, world: &Scenario, time: f64) {
        if time == self.time {
            return;
        }
        self.time = time;
        for (place, target) in self.targets.iter_mut().zip(world.targets()) {
            *place = target.at(time);
        }
        if world.walls_change() {
            self.walls.set_moving(world.moving_walls_at(time));
        }
    }

    /// The time, 0 to 1.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Puts a target elsewhere than its path would have it.
    pub(crate) fn put_target(&mut self, target: usize, place: Point<f64>) {
        self.targets[target] = Some(place);
    }

    /// Where each target is, metres; `None` while it is not there.
    pub fn targets(&self) -> &[Option<Point<f64>>] {
        &self.targets
    }

    /// The walls that are there.
    pub fn walls(&self) -> &Walls {
        &self.walls
    }
}

/// When in a run which moment of its world is: for a while everything rests as at the beginning, then the world takes its course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    settle_s: f64,
    travel_s: f64,
}

impl Course {
    /// The world rests for `settle_s` seconds and then takes `travel_s`.
    pub(crate) fn new(settle_s: f64, travel_s: f64) -> Course {
        Course { settle_s, travel_s }
    }

    /// Of a run in `world`, which is in real metres.
    pub fn of(world: &Scenario, config: &SwarmConfig) -> Course {
        Course::new(config.settle_s, world.travel_s(config.target_speed_m_per_s))
    }

    /// When the world has taken its course, seconds from the start.
    pub fn end_s(&self) -> f64 {
        self.settle_s + self.travel_s
    }

    /// The world's time, 0 to 1, so many seconds from the start.
    pub fn time_at(&self, seconds: f64) -> f64 {
        let travelled = seconds - self.settle_s;
        if travelled > 0.0 { (travelled / self.travel_s).min(1.0) } else { 0.0 }
    }

    /// When the world has this time, seconds from the start.
    pub fn seconds_at(&self, time: f64) -> f64 {
        self.settle_s + time * self.travel_s
    }
}
