//! Candidate points: equally spaced on the smooth curve through a ring's points.

use grn_core::geometry::{Point, Vector};

/// `count` points on a closed curve through `ring`, at equal arc length, from its first point on.
///
/// The points of the ring lie on the pattern, its chords do not: between two points the curve is the cubic that has at
/// each point the tangent of the parabola through the point and its two neighbours.
pub(super) fn candidates(ring: &[Point<f64>], count: usize) -> Vec<Point<f64>> {
    let chords: Vec<(Vector<f64>, f64)> = (0..ring.len())
        .map(|place| {
            let chord = ring[(place + 1) % ring.len()] - ring[place];
            (chord, chord.length())
        })
        .collect();
    let perimeter: f64 = chords.iter().map(|(_, length)| length).sum();
    let spacing = perimeter / count as f64;
    let tangent = |place: usize| {
        let (before, after) = (chords[(place + ring.len() - 1) % ring.len()], chords[place]);
        let total = before.1 + after.1;
        before.0 * (after.1 / (before.1 * total)) + after.0 * (before.1 / (after.1 * total))
    };
    let mut candidates = Vec::with_capacity(count);
    let mut passed = 0.0;
    for (place, &(chord, length)) in chords.iter().enumerate() {
        let reached = passed + length;
        let last = place + 1 == ring.len();
        let wanted = |taken: usize| taken < count && (last || taken as f64 * spacing < reached);
        if wanted(candidates.len()) {
            let (start, end) = (tangent(place) * length, tangent((place + 1) % ring.len()) * length);
            while wanted(candidates.len()) {
                let t = ((candidates.len() as f64 * spacing - passed) / length).clamp(0.0, 1.0);
                // Hermite's cubic as the chord plus two bulges that vanish at its ends.
                let bulge = (start - chord) * (t * (1.0 - t) * (1.0 - t)) - (end - chord) * (t * t * (1.0 - t));
                candidates.push(ring[place] + chord * t + bulge);
            }
        }
        passed = reached;
    }
    candidates
}

/// Drops points that are nearer than `spacing` to the last one kept, so that tangents are well defined.
pub(super) fn thinned(points: Vec<Point<f64>>, spacing: f64) -> Vec<Point<f64>> {
    let far = |a: Point<f64>, b: Point<f64>| (a - b).dot(a - b) >= spacing * spacing;
    let Some(&first) = points.first() else { return points };
    let mut kept = vec![first];
    for &point in &points[1..] {
        if kept.last().is_some_and(|&last| far(last, point)) {
            kept.push(point);
        }
    }
    while kept.len() > 3 && kept.last().is_some_and(|&last| !far(last, first)) {
        kept.pop();
    }
    if kept.len() >= 3 { kept } else { points }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(angles: impl Iterator<Item = f64>) -> Vec<Point<f64>> {
        angles.map(|angle| Vector::new(1.5 * libm::cos(angle), 1.5 * libm::sin(angle))).collect()
    }

    #[test]
    fn candidates_lie_on_the_curve_not_on_its_chords() {
        let uneven = (0..50).map(|i| f64::from(i) * std::f64::consts::TAU / 50.0 + 0.04 * f64::from(i % 3));
        let candidates = candidates(&circle(uneven), 48);
        assert_eq!(candidates.len(), 48);
        for (place, point) in candidates.iter().enumerate() {
            assert!((point.length() - 1.5).abs() < 1e-4, "{}", point.length());
            let next = candidates[(place + 1) % 48];
            let gap = (next - *point).length();
            assert!((gap - 0.1962).abs() < 0.002, "gap {gap} after {place}");
        }
    }

    #[test]
    fn thinning_keeps_the_shape() {
        let crowded = (0..300).map(|i| f64::from(i) * std::f64::consts::TAU / 300.0);
        let kept = thinned(circle(crowded), 0.1);
        assert!((70..=94).contains(&kept.len()), "{}", kept.len());
        let few = vec![Vector::new(0.0, 0.0), Vector::new(0.01, 0.0), Vector::new(0.0, 0.01)];
        assert_eq!(thinned(few.clone(), 0.1), few);
    }
}
