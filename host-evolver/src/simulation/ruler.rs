//! How far a place in the world is from a model's pattern.

use crate::evaluation::Model;
use firmware_sim::geometry::Walls;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use grn_core::field::{Field, Kernel};
use grn_core::geometry::{Point, Vector};
use grn_core::pattern::NoPattern;

/// Measures how far a position in the world is from the pattern of the exact model.
pub struct PatternRuler<'s> {
    model: Model,
    field: Field<f64>,
    pub(super) scenario: &'s Scenario,
    scale: f64,
    /// Radius of the ring around a lone target in free space, scenario metres.
    ring_radius: f64,
    /// How far from all targets a point may be and still belong to their pattern, scenario metres.
    reach: f64,
}

impl<'s> PatternRuler<'s> {
    /// The ruler of a blob in a scenario.
    ///
    /// # Errors
    /// [`NoPattern`] if the blob's network has none.
    pub fn new(blob: &Blob, scenario: &'s Scenario) -> Result<Self, NoPattern> {
        let model = Model::new(&blob.network, f64::from(blob.level_fraction))?;
        let field = blob.field.field(1.0);
        let ring_radius = model.pattern().free_space_radius(model.network(), &field).unwrap_or(f64::INFINITY);
        let merged = merged_ring_radius(blob.field.kernel, ring_radius, field.target_width(), scenario.targets().len());
        Ok(PatternRuler {
            model,
            field,
            scenario,
            scale: f64::from(blob.scale),
            ring_radius,
            reach: ring_radius + merged,
        })
    }

    /// Radius of the ring around a lone target in free space, world metres; infinite if it does not close.
    pub fn ring_radius(&self) -> f64 {
        self.ring_radius * self.scale
    }

    /// Distance from `robot` to the nearest candidate point, all in world metres. `None` where none is found, and where the
    /// one that is found is farther from every target than two ring radii (more with several targets, whose rings merge):
    /// the contour is open there and follows the walls away from the targets, so it encloses none. `walls` are those of the
    /// scenario, in its metres, at that moment.
    pub fn distance(&self, robot: Point<f64>, targets: &[Point<f64>], walls: &Walls) -> Option<f64> {
        let unscaled = |point: Point<f64>| Vector::new(point.x / self.scale, point.y / self.scale);
        let start = unscaled(robot);
        let targets: Vec<_> = targets.iter().map(|&target| unscaled(target)).collect();
        let pattern = self.model.pattern();
        let longest = self.field.target_width() / 4.0;
        let found = pattern.nearest_candidate(self.model.network(), &self.field, &targets, walls, start, longest)?;
        let near_target = targets.iter().any(|&target| (found - target).length() <= self.reach);
        near_target.then(|| (found - start).length() * self.scale)
    }
}

/// Radius of the ring around `targets` targets at one place: where n κ(R/σ) = κ(r/σ), the level of a lone target's ring.
fn merged_ring_radius(kernel: Kernel, ring_radius: f64, target_width: f64, targets: usize) -> f64 {
    let widened = target_width * libm::log(targets.max(1) as f64);
    match kernel {
        Kernel::Gaussian => (ring_radius * ring_radius + 2.0 * target_width * widened).sqrt(),
        Kernel::Exponential => ring_radius + widened,
    }
}
