//! Where exactly a contour crosses the edges of a lattice.

use super::candidates::thinned;
use super::corners::with_corners;
use super::lanes::{Lanes, WIDTH};
use super::lattice::Edge;
use super::medium::Medium;
use super::view::View;
use grn_core::geometry::Point;

/// A ring's points are at least this far apart, in lattice steps.
const CLOSEST_POINTS: f64 = 0.25;

/// The ring that crosses these edges of a lattice in this order, given the pattern error at each node: from the chord, one
/// evaluation, then the parabola through three points.
pub(super) fn refined<M: Medium>(medium: &M, edges: &[Edge], errors: &[f64], view: View<'_>) -> Vec<Point<f64>> {
    let error = |point| {
        let [x1, x2] = medium.world().inputs_at(view.snapshot, point);
        view.model.error(x1, x2)
    };
    let mut points = Vec::with_capacity(edges.len());
    for edges in edges.chunks(WIDTH) {
        let filled = std::array::from_fn(|lane| edges[lane.min(edges.len() - 1)]);
        let inner = filled.map(|edge| errors[edge.from]);
        // A border node's error is minus infinity: the chord then is 0, the inner node itself.
        let outer = filled.map(|edge| errors[edge.to]);
        let chord = Lanes(std::array::from_fn(|lane| inner[lane] / (inner[lane] - outer[lane])));
        let [x1, x2] = medium.inputs_along(view.snapshot, &filled, chord);
        let middle = view.model.errors(x1, x2);
        points.extend(edges.iter().enumerate().map(|(lane, &edge)| {
            let t = if medium.is_creased(view.snapshot, edge) {
                root_between(inner[lane], outer[lane], |t| error(medium.along(edge, t)))
            } else {
                parabola_root([0.0, chord.0[lane], 1.0], [inner[lane], middle.0[lane], outer[lane]])
            };
            medium.along(edge, t)
        }));
    }
    let ring = thinned(points, medium.lattice().step() * CLOSEST_POINTS);
    let exact = |points: &[Point<f64>; WIDTH]| {
        let [x1, x2] = medium.world().inputs_at_all(view.snapshot, points);
        view.model.errors(x1, x2)
    };
    with_corners(ring, |point| medium.world().is_at_crease(view.snapshot, point), exact)
}

/// The root in [0, 1] by inverse quadratic interpolation of three points whose values fall strictly through 0, else the
/// middle point.
fn parabola_root(t: [f64; 3], [a, b, c]: [f64; 3]) -> f64 {
    if !(a > b && b > c && c.is_finite()) {
        return t[1];
    }
    let root =
        t[0] * b * c / ((a - b) * (a - c)) + t[1] * a * c / ((b - a) * (b - c)) + t[2] * a * b / ((c - a) * (c - b));
    if (0.0..=1.0).contains(&root) { root } else { t[1] }
}

/// The root in [0, 1] of a function with the given values at 0 and 1, by false position with halving (Illinois).
fn root_between(start: f64, end: f64, f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 5;
    if !end.is_finite() {
        return 0.0;
    }
    let (mut a, mut b) = ((0.0, start), (1.0, end));
    for _ in 0..STEPS {
        let t = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        let value = f(t);
        if (value < 0.0) == (b.1 < 0.0) {
            a.1 *= 0.5;
        } else {
            a = b;
        }
        b = (t, value);
    }
    b.0
}
