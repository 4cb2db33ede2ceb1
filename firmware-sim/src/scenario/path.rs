//! A target's path and motion along it.

use grn_core::geometry::Point;

/// A polyline that a target follows at constant speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    points: Vec<Point<f64>>,
    /// Arc length from the start to each point.
    passed: Vec<f64>,
}

impl Path {
    /// The path through `points`; without points, a path that rests at the origin.
    pub fn new(points: Vec<Point<f64>>) -> Self {
        let mut passed = Vec::with_capacity(points.len());
        let mut total = 0.0;
        for (index, &point) in points.iter().enumerate() {
            if let Some(&before) = index.checked_sub(1).and_then(|i| points.get(i)) {
                total += (point - before).length();
            }
            passed.push(total);
        }
        Path { points, passed }
    }

    /// The points as given.
    pub fn points(&self) -> &[Point<f64>] {
        &self.points
    }

    /// Arc length, metres; 0 for a single point.
    pub fn length(&self) -> f64 {
        self.passed.last().copied().unwrap_or(0.0)
    }

    /// The point after this share of the arc length; shares outside [0, 1] (or NaN) are taken as the nearer end (the
    /// start).
    pub fn at(&self, fraction: f64) -> Point<f64> {
        let first = self.points.first().copied().unwrap_or(Point::ZERO);
        if fraction >= 1.0 {
            return self.points.last().copied().unwrap_or(first);
        }
        let along = if fraction > 0.0 { fraction * self.length() } else { 0.0 };
        let next = self.passed.partition_point(|&passed| passed <= along);
        let (Some(&to), Some(from_index)) = (self.points.get(next), next.checked_sub(1)) else {
            return if next == 0 { first } else { self.points.last().copied().unwrap_or(first) };
        };
        let from = self.points[from_index];
        let share = (along - self.passed[from_index]) / (self.passed[next] - self.passed[from_index]);
        from + (to - from) * share
    }

    /// The path with every coordinate multiplied by `factor`.
    #[must_use]
    pub(super) fn scaled(&self, factor: f64) -> Path {
        Path::new(self.points.iter().map(|&point| point * factor).collect())
    }
}
