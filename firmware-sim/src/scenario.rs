//! A world as a person writes it: region, target paths, walls, and what the morphogens and the ring are.
//!
//! Lengths are the model's metres; [`Scenario::scaled`] gives the same world in a laboratory's metres.

mod file;
pub mod limits;
mod path;
pub mod random;

pub use grn_input::InputError;
pub use limits::MAX_SNAPSHOTS;
pub use path::Path;
pub use random::RandomObstacles;

use crate::geometry::Walls;
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
    morphogen: Morphogen,
    ring: Ring,
    targets: Vec<Path>,
    walls: Walls,
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
    /// together, no target or more than [`MAX_TARGETS`](grn_core::robot::percept::MAX_TARGETS), two targets on the same
    /// path, paths that leave the region or enter a wall, and polygons that are none.
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

    /// The targets' paths, 1 to 4 of them.
    pub fn paths(&self) -> &[Path] {
        &self.targets
    }

    /// The walls; perhaps none.
    pub fn walls(&self) -> &Walls {
        &self.walls
    }

    /// Where the targets are after this share of the time: 0 at the start of their paths, 1 at the end. Each moves along
    /// its own path at constant speed, so all arrive together. A share outside [0, 1] is taken as the nearer end.
    pub fn targets_at(&self, fraction: f64) -> Vec<Point<f64>> {
        self.targets.iter().map(|path| path.at(fraction)).collect()
    }

    /// The targets of every snapshot, equally spaced in time with both ends included; a single snapshot is the start.
    pub fn snapshot_targets(&self) -> Vec<Vec<Point<f64>>> {
        let last = self.snapshots.saturating_sub(1).max(1) as f64;
        (0..self.snapshots).map(|index| self.targets_at(index as f64 / last)).collect()
    }

    /// Length of the longest path, metres; 0 when every target stands still.
    pub fn longest_path(&self) -> f64 {
        self.targets.iter().map(Path::length).fold(0.0, f64::max)
    }

    /// Samples of every wall's outline, each [`OBSTACLE_SPACING`] of arc length from its first vertex on.
    pub fn boundary_samples(&self) -> Vec<Point<f64>> {
        self.walls.boundary_samples(OBSTACLE_SPACING)
    }

    /// Those [`boundary_samples`](Scenario::boundary_samples) that lie within [`PERCEPTION_RANGE`] of some target.
    /// Meant for unscaled scenarios: spacing and range are not scaled.
    pub fn obstacle_points(&self, targets: &[Point<f64>]) -> Vec<Point<f64>> {
        let mut points = self.boundary_samples();
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
        Scenario {
            name: self.name.clone(),
            region: self.region.map(|side| side * factor),
            snapshots: self.snapshots,
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
            targets: self.targets.iter().map(|path| path.scaled(factor)).collect(),
            walls: self.walls.scaled(factor),
        }
    }
}

#[cfg(test)]
mod tests;
