//! Polygons, walls, rays and hulls in the plane, in `f64`; lengths in metres unless stated otherwise.

mod nearest;
mod polygon;

pub use polygon::{Polygon, PolygonError};

use grn_core::field::Obstacles;
use grn_core::geometry::{Point, Vector};
use nearest::NearestEdges;

/// |v|², without the square root.
pub fn length_squared(v: Vector<f64>) -> f64 {
    v.x * v.x + v.y * v.y
}

/// The point of the segment from `start` to `end` nearest to `point`.
pub fn nearest_on_segment(start: Point<f64>, end: Point<f64>, point: Point<f64>) -> Point<f64> {
    Edge::new(start, end).nearest(point)
}

/// How far along the ray from `origin` in the unit `direction` the segment from `start` to `end` is first met, if at
/// all. A ray along the segment's own line does not meet it.
pub fn ray_segment(origin: Point<f64>, direction: Vector<f64>, start: Point<f64>, end: Point<f64>) -> Option<f64> {
    Edge::new(start, end).ray(origin, direction)
}

/// How far along the ray from `origin` in the unit `direction` the circle is first met; 0 from inside the circle.
pub fn ray_circle(origin: Point<f64>, direction: Vector<f64>, centre: Point<f64>, radius: f64) -> Option<f64> {
    let offset = centre - origin;
    let squared = length_squared(offset);
    if squared <= radius * radius {
        return Some(0.0);
    }
    let along = offset.dot(direction);
    let room = radius * radius - (squared - along * along);
    (along > 0.0 && room >= 0.0).then(|| along - room.sqrt())
}

/// Does the segment from `start` to `end` come within `radius` of `centre`?
pub fn segment_meets_circle(start: Point<f64>, end: Point<f64>, centre: Point<f64>, radius: f64) -> bool {
    length_squared(centre - nearest_on_segment(start, end, centre)) <= radius * radius
}

/// An axis-parallel box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// South-west corner.
    pub low: Point<f64>,
    /// North-east corner.
    pub high: Point<f64>,
}

impl Bounds {
    /// The smallest box around `points`, or `None` without points.
    pub fn around(points: impl IntoIterator<Item = Point<f64>>) -> Option<Bounds> {
        points.into_iter().map(|p| Bounds { low: p, high: p }).reduce(|a, b| a.joined(b))
    }

    /// The smallest box around both.
    #[must_use]
    pub fn joined(self, other: Bounds) -> Bounds {
        Bounds {
            low: Vector::new(self.low.x.min(other.low.x), self.low.y.min(other.low.y)),
            high: Vector::new(self.high.x.max(other.high.x), self.high.y.max(other.high.y)),
        }
    }

    /// Does the box, its border included, hold the point?
    pub fn contains(&self, point: Point<f64>) -> bool {
        point.x >= self.low.x && point.x <= self.high.x && point.y >= self.low.y && point.y <= self.high.y
    }

    /// Squared distance from the box to the point, 0 inside.
    pub fn distance_squared(&self, point: Point<f64>) -> f64 {
        let x = (self.low.x - point.x).max(point.x - self.high.x).max(0.0);
        let y = (self.low.y - point.y).max(point.y - self.high.y).max(0.0);
        x * x + y * y
    }
}

/// A directed segment, with its squared length's inverse at hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    start: Point<f64>,
    along: Vector<f64>,
    per_length_squared: f64,
}

impl Edge {
    /// From `start` to `end`; equal ends make a point.
    pub fn new(start: Point<f64>, end: Point<f64>) -> Self {
        let along = end - start;
        let squared = length_squared(along);
        Edge { start, along, per_length_squared: if squared > 0.0 { 1.0 / squared } else { 0.0 } }
    }

    /// Where it begins.
    pub fn start(&self) -> Point<f64> {
        self.start
    }

    /// Where it ends.
    pub fn end(&self) -> Point<f64> {
        self.start + self.along
    }

    /// Its length.
    pub fn length(&self) -> f64 {
        length_squared(self.along).sqrt()
    }

    /// Its point nearest to `point`.
    pub fn nearest(&self, point: Point<f64>) -> Point<f64> {
        let share = (point - self.start).dot(self.along) * self.per_length_squared;
        self.start + self.along * share.clamp(0.0, 1.0)
    }

    /// Distance along the ray from `origin` in the unit `direction` at which the edge is met, if at all.
    pub fn ray(&self, origin: Point<f64>, direction: Vector<f64>) -> Option<f64> {
        let denominator = direction.cross(self.along);
        if denominator == 0.0 {
            return None;
        }
        let offset = self.start - origin;
        let distance = offset.cross(self.along) / denominator;
        let share = offset.cross(direction) / denominator;
        (distance >= 0.0 && (0.0..=1.0).contains(&share)).then_some(distance)
    }
}

/// Is the point inside the polygon of these vertices, by the even-odd rule? Points on the outline may count as either.
pub fn point_in_polygon(vertices: &[Point<f64>], point: Point<f64>) -> bool {
    crossings_odd(vertices, point)
}

fn crossings_odd(vertices: &[Point<f64>], point: Point<f64>) -> bool {
    let Some(&last) = vertices.last() else { return false };
    let mut inside = false;
    let mut from = last;
    for &to in vertices {
        if (from.y > point.y) != (to.y > point.y) {
            // The crossing lies east of the point: compare without dividing, by the sign of the edge's rise.
            let cross = (to - from).cross(point - from);
            if (cross > 0.0) == (to.y > from.y) && cross != 0.0 {
                inside = !inside;
            }
        }
        from = to;
    }
    inside
}

/// The convex hull of `points`, counter-clockwise, without points in the middle of its edges (Andrew's monotone chain).
/// Fewer than three vertices when the points lie on a line. Points must be finite.
pub fn convex_hull(points: &[Point<f64>]) -> Vec<Point<f64>> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull: Vec<Point<f64>> = Vec::with_capacity(sorted.len() + 1);
    let mut chain = |points: &mut dyn Iterator<Item = Point<f64>>| {
        let floor = hull.len();
        for point in points {
            while let [.., a, b] = hull[floor..] {
                if (b - a).cross(point - b) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
    };
    chain(&mut sorted.iter().copied());
    chain(&mut sorted.iter().rev().copied());
    hull
}

/// Solid obstacles: a set of polygons, which may touch and overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls {
    polygons: Vec<Polygon>,
    nearest: Option<NearestEdges>,
}

impl Walls {
    /// These polygons.
    pub fn new(polygons: Vec<Polygon>) -> Self {
        Walls { nearest: NearestEdges::of(&polygons), polygons }
    }

    /// The polygons, in the scenario's order.
    pub fn polygons(&self) -> &[Polygon] {
        &self.polygons
    }

    /// The walls with every coordinate multiplied by a positive finite `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Walls {
        Walls::new(self.polygons.iter().map(|polygon| polygon.scaled(factor)).collect())
    }

    /// Is there no wall at all?
    pub fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// The smallest box around all walls, or `None` without walls.
    pub fn bounds(&self) -> Option<Bounds> {
        self.polygons.iter().map(Polygon::bounds).reduce(Bounds::joined)
    }

    /// Which wall holds the point; the first, if several do.
    pub fn containing(&self, point: Point<f64>) -> Option<usize> {
        self.polygons.iter().position(|polygon| polygon.contains(point))
    }

    /// Distance to the nearest wall's outline: negative inside a wall (the deepest counts), infinite without walls.
    pub fn signed_distance(&self, point: Point<f64>) -> f64 {
        if let Some((_, squared)) = self.nearest.as_ref().and_then(|nearest| nearest.nearest_outside(point)) {
            return squared.sqrt();
        }
        let inside = self.polygons.iter().filter(|polygon| polygon.contains(point));
        let depth = inside.map(|polygon| polygon.nearest_boundary(point).1).reduce(f64::max);
        match depth {
            Some(squared) => -squared.sqrt(),
            None => self.nearest_boundary(point).map_or(f64::INFINITY, |(_, squared)| squared.sqrt()),
        }
    }

    /// The point of any outline nearest to `point` and the squared distance to it, or `None` without walls.
    pub fn nearest_boundary(&self, point: Point<f64>) -> Option<(Point<f64>, f64)> {
        if let Some(best) = self.nearest.as_ref().and_then(|nearest| nearest.nearest(point)) {
            return Some(best);
        }
        let mut best: Option<(Point<f64>, f64)> = None;
        for polygon in &self.polygons {
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

    /// Distance along the ray from `origin` in the unit `direction` to the first outline, if within `reach`.
    pub fn ray(&self, origin: Point<f64>, direction: Vector<f64>, reach: f64) -> Option<f64> {
        let near = self.polygons.iter().filter(|p| p.bounds().distance_squared(origin) <= reach * reach);
        let hits = near.flat_map(Polygon::edges).filter_map(|edge| edge.ray(origin, direction));
        hits.reduce(f64::min).filter(|&distance| distance <= reach)
    }

    /// Points on every outline, wall by wall, every `spacing` metres of arc length from each wall's first vertex.
    pub fn boundary_samples(&self, spacing: f64) -> Vec<Point<f64>> {
        self.polygons.iter().flat_map(|polygon| polygon.boundary_samples(spacing)).collect()
    }
}

impl Obstacles<f64> for Walls {
    fn offset_from_nearest(&self, point: Point<f64>) -> Option<Vector<f64>> {
        if let Some((boundary, _)) = self.nearest.as_ref().and_then(|nearest| nearest.nearest_outside(point)) {
            return Some(point - boundary);
        }
        let (boundary, _) = self.nearest_boundary(point)?;
        Some(if self.containing(point).is_some() { Vector::ZERO } else { point - boundary })
    }
}

#[cfg(test)]
mod tests;
