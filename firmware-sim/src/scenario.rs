//! A world as a person writes it: region, targets, walls, and what the morphogens and the ring are.
//!
//! Lengths are the model's metres; [`Scenario::scaled`] gives the same world in a laboratory's metres. Times go from 0, when the
//! targets set out, to 1, when they have arrived, whatever that takes.

mod disc;
mod evasion;
mod file;
pub mod limits;
mod meant;
mod moving;
mod obstacles;
mod path;
mod points;
mod presence;
pub mod random;
mod scene;
mod start;
mod tables;
mod target;
mod targets;
mod timing;

pub use disc::Disc;
pub use evasion::Evasion;
pub use grn_input::InputError;
pub use limits::MAX_SNAPSHOTS;
pub use meant::MeantSwarm;
pub use moving::{Motion, MovingWall};
pub use path::Path;
pub use presence::Presence;
pub use random::RandomObstacles;
pub use scene::{Course, Scene};
pub use start::Start;
pub use target::Target;

use crate::geometry::{Bounds, Polygon, Walls};
use file::ScenarioFile;
use grn_core::field::Kernel;
use grn_core::geometry::Point;
use grn_input::Found;
use serde::{Deserialize, Serialize};

/// Arc length between two samples of a wall's outline, metres.
pub const OBSTACLE_SPACING: f64 = 0.5;
/// How far a mother robot perceives targets and walls, metres; samples farther from every target do not count.
pub const PERCEPTION_RANGE: f64 = 5.0;

/// How targets and walls turn into the morphogens x1 and x2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Morphogen {
    /// How concentration falls with distance.
    pub kernel: Kernel,
    /// σ_t, metres, in [`limits::WIDTH`].
    pub target_width: f64,
    /// σ_o, metres, in [`limits::WIDTH`].
    pub obstacle_width: f64,
    /// c, the pattern's level as a share of the range from M(0,0) to M(1,0), in [`limits::LEVEL`].
    pub level: f64,
}

/// Where the ring is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Nearest wanted distance from a target, metres, in [`limits::DISTANCE`].
    pub d_min: f64,
    /// Farthest wanted distance from a target, metres, above `d_min`, in [`limits::DISTANCE`] and no longer than the region.
    pub d_max: f64,
    /// Wanted distance from walls, metres, in [`limits::DISTANCE`].
    pub d_obstacle: f64,
    /// k1 = k2 = k3: how sharply the objective punishes, per metre, in [`limits::STEEPNESS`].
    pub steepness: f64,
}

/// A checked scenario; whatever one holds has passed every check named in [`Scenario::parse`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "ScenarioFile", into = "ScenarioFile")]
pub struct Scenario {
    name: String,
    region: [f64; 2],
    snapshots: usize,
    duration_s: Option<f64>,
    morphogen: Morphogen,
    ring: Ring,
    meant_swarm: Option<MeantSwarm>,
    start: Option<Start>,
    targets: Vec<Target>,
    /// Polygons, then the outlines of the discs.
    fixed_walls: Walls,
    fixed_discs: Vec<Disc>,
    moving_walls: Vec<MovingWall>,
}

impl Scenario {
    /// Reads and checks a TOML file.
    ///
    /// # Errors
    /// [`InputError`], naming the file, when it cannot be read or [`Scenario::parse`] rejects it.
    pub fn load(path: impl AsRef<std::path::Path>) -> Result<Scenario, InputError> {
        let path = path.as_ref();
        let text = grn_input::read_text(path, Found::Scenario)?;
        Scenario::parse(&text).map_err(|error| match Found::of(text.as_bytes()) {
            found @ Found::Campaign => InputError::new("", "", found.instead_of(Found::Scenario)).in_file(path),
            _ => error.in_file(path),
        })
    }

    /// Checks TOML text.
    ///
    /// # Errors
    /// [`InputError`] for text that is not TOML, unknown or missing keys, numbers out of the ranges in [`limits`], alone or
    /// together, no target or more than [`MOST_TARGETS`](limits::MOST_TARGETS), two targets on the same
    /// path, a time without a target, paths that leave the region or enter a wall, walls that run into a target, and polygons
    /// that are none.
    pub fn parse(text: &str) -> Result<Scenario, InputError> {
        grn_input::parse(text.trim_start_matches('\u{feff}'), |file: ScenarioFile| Scenario::try_from(file))
    }

    /// The canonical TOML text; parsing it gives an equal scenario.
    pub fn to_toml(&self) -> String {
        ScenarioFile::from(self.clone()).to_toml()
    }

    /// What the scenario is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Extent of the region from the origin, metres, (east, north).
    pub fn region(&self) -> [f64; 2] {
        self.region
    }

    /// Target poses per pattern evaluation, 1..=[`MAX_SNAPSHOTS`].
    pub fn snapshots(&self) -> usize {
        self.snapshots
    }

    /// Kernel, widths and level.
    pub fn morphogen(&self) -> Morphogen {
        self.morphogen
    }

    /// Wanted distances.
    pub fn ring(&self) -> Ring {
        self.ring
    }

    /// Where robots begin, if the world says so; else behind the first target.
    pub fn start(&self) -> Option<&Start> {
        self.start.as_ref()
    }

    /// The targets, 1 to 10 of them.
    pub fn targets(&self) -> &[Target] {
        &self.targets
    }

    /// The walls and discs that are always where they are drawn, as polygons, discs last; perhaps none.
    pub fn fixed_walls(&self) -> &Walls {
        &self.fixed_walls
    }

    /// The discs among [`fixed_walls`](Scenario::fixed_walls); perhaps none.
    pub fn fixed_discs(&self) -> &[Disc] {
        &self.fixed_discs
    }

    /// The fixed walls that are drawn as polygons.
    fn fixed_polygons(&self) -> &[Polygon] {
        let fixed = self.fixed_walls.fixed();
        &fixed[..fixed.len() - self.fixed_discs.len()]
    }

    /// The walls and discs that move, or are not always there; perhaps none.
    pub fn moving_walls(&self) -> &[MovingWall] {
        &self.moving_walls
    }

    /// Whether walls are not the same at all times.
    pub fn walls_change(&self) -> bool {
        !self.moving_walls.is_empty()
    }

    /// Where their paths have the targets at a time, 0 at the start of their paths, 1 at the end; those that are there. A target without times of
    /// its own moves along its path at constant speed, so all such arrive together. A time outside [0, 1] is taken as the nearer end.
    pub fn targets_at(&self, time: f64) -> Vec<Point<f64>> {
        self.targets.iter().filter_map(|target| target.at(time)).collect()
    }

    /// The walls that are there at a time.
    pub fn walls_at(&self, time: f64) -> Walls {
        let mut walls = self.fixed_walls.clone();
        walls.set_moving(self.moving_walls_at(time));
        walls
    }

    /// Of the walls that move or are not always there those that are there at a time, where they are then.
    pub(crate) fn moving_walls_at(&self, time: f64) -> impl Iterator<Item = Polygon> + '_ {
        self.moving_walls.iter().filter_map(move |wall| wall.at(time))
    }

    /// The time of every snapshot: equally spaced with both ends included; a single snapshot is the start.
    pub fn snapshot_times(&self) -> impl Iterator<Item = f64> + use<> {
        let last = self.snapshots.saturating_sub(1).max(1) as f64;
        (0..self.snapshots).map(move |index| index as f64 / last)
    }

    /// The times within the run at which a target or a wall comes or goes, rising.
    pub fn changes(&self) -> Vec<f64> {
        let targets = self.targets.iter().flat_map(|target| target.presence.changes());
        let mut changes: Vec<f64> =
            targets.chain(self.moving_walls.iter().flat_map(|wall| wall.presence.changes())).collect();
        changes.sort_by(f64::total_cmp);
        changes.dedup();
        changes
    }

    /// The longest way that anything would go in the whole run at its greatest speed, metres: the length of the longest path, if all
    /// targets move at constant speed; 0 when nothing moves.
    pub fn longest_path(&self) -> f64 {
        let targets = self.targets.iter().map(|target| target.path.length_at_full_speed());
        targets.chain(self.moving_walls.iter().map(MovingWall::length_at_full_speed)).fold(0.0, f64::max)
    }

    /// How long it takes from time 0 to time 1, seconds, if the world says so itself.
    pub fn duration_s(&self) -> Option<f64> {
        self.duration_s
    }

    /// How long it takes from time 0 to time 1, seconds: what the world itself says, or as long as what is fastest takes if it goes
    /// `speed` metres per second at most.
    pub fn travel_s(&self, speed: f64) -> f64 {
        self.duration_s.unwrap_or_else(|| self.longest_path() / speed)
    }

    /// The smallest box around the region, paths and walls, wherever these move.
    pub fn extent(&self) -> Bounds {
        let region = Bounds { low: Point::ZERO, high: Point::new(self.region[0], self.region[1]) };
        let paths = Bounds::around(self.targets.iter().flat_map(|target| target.path.points().iter().copied()));
        let moving = self.moving_walls.iter().map(MovingWall::reach);
        paths.into_iter().chain(self.fixed_walls.bounds()).chain(moving).fold(region, Bounds::joined)
    }

    /// Those samples of the outlines of `walls`, each [`OBSTACLE_SPACING`] of arc length from a wall's first vertex on, that lie within
    /// [`PERCEPTION_RANGE`] of some target. Meant for unscaled scenarios: spacing and range are not scaled.
    pub fn obstacle_points(walls: &Walls, targets: &[Point<f64>]) -> Vec<Point<f64>> {
        let mut points = walls.boundary_samples(OBSTACLE_SPACING);
        points.retain(|&p| targets.iter().any(|&t| (p - t).length() <= PERCEPTION_RANGE));
        points
    }

    /// The same world under another name, with other morphogens and another ring, whose numbers must be in the ranges that
    /// their types give.
    ///
    /// # Errors
    /// A number out of range.
    pub fn with(&self, name: &str, morphogen: Morphogen, ring: Ring) -> Result<Scenario, InputError> {
        let changed = Scenario { name: name.to_owned(), morphogen, ring, ..self.clone() };
        Scenario::try_from(ScenarioFile::from(changed))
    }

    /// The same world with every length multiplied by `factor`, which must be positive and finite: region, paths, walls,
    /// widths and the ring's distances. The steepness, which is per metre, is divided, so that objectives keep their
    /// values.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Scenario {
        let Morphogen { kernel, target_width, obstacle_width, level } = self.morphogen;
        let Ring { d_min, d_max, d_obstacle, steepness } = self.ring;
        let fixed_discs: Vec<Disc> = self.fixed_discs.iter().map(|disc| disc.scaled(factor)).collect();
        let fixed = self.fixed_polygons().iter().map(|polygon| polygon.scaled(factor));
        Scenario {
            name: self.name.clone(),
            region: self.region.map(|side| side * factor),
            snapshots: self.snapshots,
            duration_s: self.duration_s,
            morphogen: Morphogen {
                kernel,
                target_width: target_width * factor,
                obstacle_width: obstacle_width * factor,
                level,
            },
            ring: Ring {
                d_min: d_min * factor,
                d_max: d_max * factor,
                d_obstacle: d_obstacle * factor,
                steepness: steepness / factor,
            },
            meant_swarm: self.meant_swarm,
            start: self.start.as_ref().map(|start| start.scaled(factor)),
            targets: self.targets.iter().map(|target| target.scaled(factor)).collect(),
            fixed_walls: Walls::new(fixed.chain(fixed_discs.iter().map(Disc::outline)).collect()),
            fixed_discs,
            moving_walls: self.moving_walls.iter().map(|wall| wall.scaled(factor)).collect(),
        }
    }
}

#[cfg(test)]
mod tests;
