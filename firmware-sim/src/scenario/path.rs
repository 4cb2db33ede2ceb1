//! A path, and how something goes along it.

use grn_core::geometry::Point;

/// A polyline that something follows while the time of a run goes from 0 to 1: at constant speed, or so that it is at each point
/// at a time of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    points: Vec<Point<f64>>,
    /// Arc length from the start to each point.
    passed: Vec<f64>,
    /// The time of each point.
    times: Option<Vec<f64>>,
}

impl Path {
    /// The path through `points` at constant speed; without points, a path that rests at the origin.
    pub fn new(points: Vec<Point<f64>>) -> Self {
        let mut passed = Vec::with_capacity(points.len());
        let mut total = 0.0;
        for (index, &point) in points.iter().enumerate() {
            if let Some(&before) = index.checked_sub(1).and_then(|i| points.get(i)) {
                total += (point - before).length();
            }
            passed.push(total);
        }
        Path { points, passed, times: None }
    }

    /// The path through `points`, each at its time; as many times as points, rising. Before the first time and after the last one it
    /// rests; between two equal points it stops.
    pub fn timed(points: Vec<Point<f64>>, times: Vec<f64>) -> Self {
        debug_assert_eq!(points.len(), times.len());
        Path { times: Some(times), ..Path::new(points) }
    }

    /// The points as given.
    pub fn points(&self) -> &[Point<f64>] {
        &self.points
    }

    /// The time of each point, in 0..=1, if they have times of their own.
    pub fn times(&self) -> Option<&[f64]> {
        self.times.as_deref()
    }

    /// Arc length, metres; 0 for a single point.
    pub fn length(&self) -> f64 {
        self.passed.last().copied().unwrap_or(0.0)
    }

    /// How far it would go in the whole run at its greatest speed, metres: at constant speed its length.
    pub fn length_at_full_speed(&self) -> f64 {
        let Some(times) = &self.times else { return self.length() };
        let stretches = self.passed.windows(2).zip(times.windows(2));
        stretches.map(|(way, time)| (way[1] - way[0]) / (time[1] - time[0])).fold(0.0, f64::max)
    }

    /// The point at a time; times outside [0, 1] (or NaN) are taken as the nearer end (the start).
    pub fn at(&self, time: f64) -> Point<f64> {
        let first = self.points.first().copied().unwrap_or(Point::ZERO);
        let last = self.points.last().copied().unwrap_or(first);
        let end = self.times.as_ref().map_or(1.0, |times| times.last().copied().unwrap_or(1.0));
        if time >= end {
            return last;
        }
        let (stations, now) = match &self.times {
            Some(times) => (times, time),
            None => (&self.passed, if time > 0.0 { time * self.length() } else { 0.0 }),
        };
        match stretch(stations, now) {
            Stretch::Before => first,
            Stretch::Between(begun, share) => {
                self.points[begun] + (self.points[begun + 1] - self.points[begun]) * share
            }
            Stretch::After => last,
        }
    }

    /// The path with every coordinate multiplied by `factor`.
    #[must_use]
    pub(super) fn scaled(&self, factor: f64) -> Path {
        let scaled = Path::new(self.points.iter().map(|&point| point * factor).collect());
        Path { times: self.times.clone(), ..scaled }
    }
}

/// Between which of some stations something is.
pub(super) enum Stretch {
    /// It has not come to the first.
    Before,
    /// It has passed this one, and a share of the stretch to the next.
    Between(usize, f64),
    /// It has passed the last.
    After,
}

/// Where `now` is among rising `stations`.
pub(super) fn stretch(stations: &[f64], now: f64) -> Stretch {
    let next = stations.partition_point(|&station| station <= now);
    match (next.checked_sub(1), stations.get(next)) {
        (None, _) => Stretch::Before,
        (Some(begun), Some(end)) => Stretch::Between(begun, (now - stations[begun]) / (end - stations[begun])),
        (Some(_), None) => Stretch::After,
    }
}
