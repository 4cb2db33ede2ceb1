//! Solid obstacles.

use super::nearest::NearestEdges;
use super::{Bounds, Polygon};
use grn_core::field::Obstacles;
use grn_core::geometry::{Point, Vector};
use std::sync::Arc;

/// Solid obstacles: a set of polygons, which may touch and overlap. Most stand still, and are prepared for being asked about; some
/// may move.
#[derive(Clone, Debug, Default)]
pub struct Walls {
    fixed: Arc<Fixed>,
    moving: Vec<Polygon>,
}

#[derive(Debug, Default)]
struct Fixed {
    polygons: Vec<Polygon>,
    nearest: Option<NearestEdges>,
}

impl PartialEq for Walls {
    fn eq(&self, other: &Walls) -> bool {
        let same_fixed = Arc::ptr_eq(&self.fixed, &other.fixed) || self.fixed.polygons == other.fixed.polygons;
        same_fixed && self.moving == other.moving
    }
}

impl Walls {
    /// These polygons, which stand still.
    pub fn new(polygons: Vec<Polygon>) -> Self {
        let nearest = NearestEdges::of(&polygons);
        Walls { fixed: Arc::new(Fixed { polygons, nearest }), moving: Vec::new() }
    }

    /// The same fixed walls with these moving ones in the place of all moving ones before.
    pub fn set_moving(&mut self, polygons: impl Iterator<Item = Polygon>) {
        self.moving.clear();
        self.moving.extend(polygons);
    }

    /// The polygons, fixed ones first.
    pub fn polygons(&self) -> impl Iterator<Item = &Polygon> + Clone {
        self.fixed.polygons.iter().chain(&self.moving)
    }

    /// The polygons that stand still.
    pub fn fixed(&self) -> &[Polygon] {
        &self.fixed.polygons
    }

    /// The polygons that may move.
    pub fn moving(&self) -> &[Polygon] {
        &self.moving
    }

    /// The walls with every coordinate multiplied by a positive finite `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Walls {
        let scaled = |polygons: &[Polygon]| polygons.iter().map(|polygon| polygon.scaled(factor)).collect();
        Walls { moving: scaled(&self.moving), ..Walls::new(scaled(&self.fixed.polygons)) }
    }

    /// Is there no wall at all?
    pub fn is_empty(&self) -> bool {
        self.polygons().next().is_none()
    }

    /// The smallest box around all walls, or `None` without walls.
    pub fn bounds(&self) -> Option<Bounds> {
        self.polygons().map(Polygon::bounds).reduce(Bounds::joined)
    }

    /// Which wall holds the point, by its place in [`polygons`](Walls::polygons); the first, if several do.
    pub fn containing(&self, point: Point<f64>) -> Option<usize> {
        self.polygons().position(|polygon| polygon.contains(point))
    }

    fn is_in_moving(&self, point: Point<f64>) -> bool {
        self.moving.iter().any(|polygon| polygon.contains(point))
    }

    /// The nearest point of any outline and the squared distance to it, if the prepared grid tells that the point is outside all
    /// fixed walls.
    fn nearest_outside_fixed(&self, point: Point<f64>) -> Option<(Point<f64>, f64)> {
        let fixed = self.fixed.nearest.as_ref().and_then(|nearest| nearest.nearest_outside(point))?;
        nearer(&self.moving, point, Some(fixed))
    }

    /// Distance to the nearest wall's outline: negative inside a wall (the deepest counts), infinite without walls.
    pub fn signed_distance(&self, point: Point<f64>) -> f64 {
        if !self.is_in_moving(point)
            && let Some((_, squared)) = self.nearest_outside_fixed(point)
        {
            return squared.sqrt();
        }
        let inside = self.polygons().filter(|polygon| polygon.contains(point));
        let depth = inside.map(|polygon| polygon.nearest_boundary(point).1).reduce(f64::max);
        match depth {
            Some(squared) => -squared.sqrt(),
            None => self.nearest_boundary(point).map_or(f64::INFINITY, |(_, squared)| squared.sqrt()),
        }
    }

    /// The point of any outline nearest to `point` and the squared distance to it, or `None` without walls.
    pub fn nearest_boundary(&self, point: Point<f64>) -> Option<(Point<f64>, f64)> {
        let prepared = self.fixed.nearest.as_ref().and_then(|nearest| nearest.nearest(point));
        nearer(&self.moving, point, prepared.or_else(|| nearer(&self.fixed.polygons, point, None)))
    }

    /// Distance along the ray from `origin` in the unit `direction` to the first outline, if within `reach`.
    pub fn ray(&self, origin: Point<f64>, direction: Vector<f64>, reach: f64) -> Option<f64> {
        let near = self.polygons().filter(|p| p.bounds().distance_squared(origin) <= reach * reach);
        near.filter_map(|polygon| polygon.ray(origin, direction, reach)).reduce(f64::min)
    }

    /// Points on every outline, wall by wall, every `spacing` metres of arc length from each wall's first vertex.
    pub fn boundary_samples(&self, spacing: f64) -> Vec<Point<f64>> {
        self.polygons().flat_map(|polygon| polygon.boundary_samples(spacing)).collect()
    }
}

/// `best`, or what of these polygons' outlines is nearer to `point`, with the squared distance.
fn nearer(polygons: &[Polygon], point: Point<f64>, best: Option<(Point<f64>, f64)>) -> Option<(Point<f64>, f64)> {
    let mut best = best;
    for polygon in polygons {
        if best.is_some_and(|(_, squared)| polygon.bounds().distance_squared(point) >= squared) {
            continue;
        }
        let candidate = polygon.nearest_boundary(point);
        if best.is_none_or(|(_, squared)| candidate.1 < squared) {
            best = Some(candidate);
        }
    }
    best
}

impl Obstacles<f64> for Walls {
    fn offset_from_nearest(&self, point: Point<f64>) -> Option<Vector<f64>> {
        if !self.is_in_moving(point)
            && let Some((boundary, _)) = self.nearest_outside_fixed(point)
        {
            return Some(point - boundary);
        }
        let (boundary, _) = self.nearest_boundary(point)?;
        Some(if self.containing(point).is_some() { Vector::ZERO } else { point - boundary })
    }
}
