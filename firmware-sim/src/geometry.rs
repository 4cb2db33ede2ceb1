//! Polygons, walls, rays and hulls in the plane, in `f64`; lengths in metres unless stated otherwise.

mod nearest;
mod polygon;
mod walls;

pub use polygon::{Polygon, PolygonError};
pub use walls::Walls;

use grn_core::geometry::{Point, Vector};

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

#[cfg(test)]
mod tests;
