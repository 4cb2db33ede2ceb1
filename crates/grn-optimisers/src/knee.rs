//! Which point of a two-objective front is its knee: where a little more of one objective costs much of the
//! other. Both measures of Branke, Deb, Dierolf and Osswald 2004, "Finding knees in multi-objective
//! optimization".
//!
//! # What both do with a list of points
//!
//! - Points may come in any order. Values come back in that order, one a point; larger is more of a knee.
//! - The *front* is what is left after dropping points that are dominated or not usable (a coordinate is NaN,
//!   infinite, or beyond half the range of `f64`). Dropped points have the value 0.
//! - Copies count as one point and share its value; the functions that pick one give the first copy.
//! - Each objective is scaled so that the front spans [0, 1]; units do not matter.
//! - A front of one point has that point as its knee. One of two points has two equal ends, and no knee in
//!   between: the one that comes first in the list is picked. With no usable point there is no knee: `None`.
//!
//! # Picking a knee
//!
//! The ends of a front have trade-offs on one side only. So a pick looks between them first, for the largest
//! value of a point that bulges (an angle above π, a marginal utility above 0, beyond rounding); only if there is
//! none, on a concave or straight front, does it fall back to the largest value of all, which is then an end.
//! Equal values go to the point that comes first in the list.

#[cfg(test)]
mod tests;

use core::f64::consts::{FRAC_PI_2, PI};
use core::fmt;
use core::str::FromStr;

/// Below this many radians above π an angle is straight.
const STRAIGHT: f64 = 1e-9;
/// Below this a marginal utility is rounding. A smooth front of n even points has them near n⁻³.
const NO_LOSS: f64 = 1e-20;

/// Whose angles count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Neighbours {
    /// The point's nearest neighbour on either side.
    Nearest,
    /// The two nearest on either side: of the four combinations of one left and one right, the largest angle.
    /// Less easily misled by a point that happens to lie close.
    Two,
}

/// By which of the two measures a point is the knee of its front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Knee {
    /// The largest angle.
    pub angle: bool,
    /// The largest marginal utility.
    pub utility: bool,
    /// The simplest one that is as good as the best, as far as noisy values tell: see [`parsimonious`](crate::parsimony::parsimonious).
    pub parsimony: bool,
}

impl fmt::Display for Knee {
    /// `angle`, `utility`, `parsimony`, several of them with `+` in between, or nothing for a point that is no knee.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = [(self.angle, "angle"), (self.utility, "utility"), (self.parsimony, "parsimony")];
        let names: Vec<_> = named.into_iter().filter(|(is, _)| *is).map(|(_, name)| name).collect();
        f.write_str(&names.join("+"))
    }
}

/// A text that names no [`Knee`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseKneeError(String);

impl fmt::Display for ParseKneeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "knee {:?}: angle, utility, parsimony, several of them as in angle+utility, or nothing is needed",
            self.0
        )
    }
}

impl core::error::Error for ParseKneeError {}

impl FromStr for Knee {
    type Err = ParseKneeError;

    fn from_str(text: &str) -> Result<Knee, ParseKneeError> {
        let is = |number: u8, bit: u8| number >> bit & 1 == 1;
        let mut knees =
            (0..8).map(|number| Knee { angle: is(number, 0), utility: is(number, 1), parsimony: is(number, 2) });
        knees.find(|knee| knee.to_string() == text).ok_or_else(|| ParseKneeError(text.into()))
    }
}

/// Whether each point is the knee of the front, by the angle to its nearest neighbours and by marginal utility.
#[must_use]
pub fn knees(points: &[[f64; 2]]) -> Vec<Knee> {
    let (angle, utility) = (knee_by_angle(points, Neighbours::Nearest), knee_by_utility(points));
    (0..points.len())
        .map(|place| Knee { angle: angle == Some(place), utility: utility == Some(place), parsimony: false })
        .collect()
}

/// The distinct points of a front, scaled, by increasing first and so decreasing second objective.
struct Front {
    points: Vec<[f64; 2]>,
    /// For each of the caller's points, its place in `points`, if it is on the front.
    places: Vec<Option<usize>>,
}

impl Front {
    fn new(given: &[[f64; 2]]) -> Self {
        let usable = |p: &[f64; 2]| p.iter().all(|x| x.abs() <= f64::MAX / 2.0);
        // Adding 0 leaves one zero, so that copies have equal bits.
        let mut order: Vec<([f64; 2], usize)> =
            given.iter().map(|p| p.map(|x| x + 0.0)).zip(0..).filter(|(p, _)| usable(p)).collect();
        order.sort_unstable_by(|(a, i), (b, j)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(i.cmp(j)));
        let mut front = Self { points: Vec::new(), places: vec![None; given.len()] };
        for (point, index) in order {
            match front.points.last() {
                Some(last) if *last == point => {}
                Some(last) if last[1] <= point[1] => continue,
                _ => front.points.push(point),
            }
            front.places[index] = Some(front.points.len() - 1);
        }
        if let [first, .., last] = front.points[..] {
            // Both spans are above 0, because neither end dominates the other.
            let (lo, span) = ([first[0], last[1]], [last[0] - first[0], first[1] - last[1]]);
            for point in &mut front.points {
                *point = [0, 1].map(|m| (point[m] - lo[m]) / span[m]);
            }
        }
        front
    }

    /// The values of the caller's points from those of the front's.
    fn values(&self, of_front: &[f64]) -> Vec<f64> {
        self.places.iter().map(|place| place.map_or(0.0, |i| of_front[i])).collect()
    }

    /// The caller's first point of largest value, between the ends if one there is above `threshold`.
    fn pick(&self, of_front: &[f64], threshold: f64) -> Option<usize> {
        let largest = |among: &dyn Fn(usize) -> bool| {
            let mut best: Option<(usize, f64)> = None;
            for (index, place) in self.places.iter().enumerate() {
                let Some(place) = place.filter(|&place| among(place)) else {
                    continue;
                };
                if best.is_none_or(|(_, value)| of_front[place] > value) {
                    best = Some((index, of_front[place]));
                }
            }
            best.map(|(index, _)| index)
        };
        let n = self.points.len();
        largest(&|i| i > 0 && i + 1 < n && of_front[i] > threshold).or_else(|| largest(&|_| true))
    }

    fn angles(&self, neighbours: Neighbours) -> Vec<f64> {
        let reach = match neighbours {
            Neighbours::Nearest => 1,
            Neighbours::Two => 2,
        };
        let steepness = |dx: f64, dy: f64| libm::atan2(dy, dx);
        let angle = |(i, here): (usize, &[f64; 2])| {
            // How steeply the front comes down to this point, and how steeply it goes on down.
            let left = self.points[i.saturating_sub(reach)..i].iter();
            let down = left.map(|p| steepness(here[0] - p[0], p[1] - here[1])).reduce(f64::max);
            let right = self.points[i + 1..].iter().take(reach);
            let on = right.map(|p| steepness(p[0] - here[0], here[1] - p[1])).reduce(f64::min);
            PI + (down.unwrap_or(FRAC_PI_2) - on.unwrap_or(0.0))
        };
        self.points.iter().enumerate().map(angle).collect()
    }

    fn losses(&self) -> Vec<f64> {
        let n = self.points.len();
        if n == 1 {
            return vec![f64::INFINITY];
        }
        let mut losses = vec![0.0; n];
        let mut substitutes = Vec::new();
        let mut hull = Vec::new();
        extend_hull(&mut hull, &self.points, 0..n);
        for (k, &i) in hull.iter().enumerate() {
            // Without point i its hull neighbours are best, or points between them.
            let from = if k == 0 { i } else { hull[k - 1] };
            let to = hull.get(k + 1).copied().unwrap_or(i);
            substitutes.clear();
            extend_hull(&mut substitutes, &self.points, (from..=to).filter(|&j| j != i));
            let lowest = hull.get(k + 1).map_or(0.0, |&j| indifference(self.points[i], self.points[j]));
            let highest = if k == 0 { 1.0 } else { indifference(self.points[from], self.points[i]) };
            losses[i] = self.loss(i, &substitutes, lowest, highest);
        }
        losses
    }

    /// The integral over weights from `lowest` to `highest`, where point `i` is best, of how much worse the best
    /// of `substitutes` is. These are by increasing first objective, so for falling weights.
    fn loss(&self, i: usize, substitutes: &[usize], lowest: f64, highest: f64) -> f64 {
        let mut total = 0.0;
        let mut upper = highest;
        for (k, &j) in substitutes.iter().enumerate() {
            let (here, other) = (self.points[i], self.points[j]);
            let next = substitutes.get(k + 1).map_or(lowest, |&next| indifference(other, self.points[next]));
            // Not `clamp`, which panics where rounding has left an empty interval.
            let lower = next.max(lowest).min(upper);
            let excess = |w: f64| (w * (other[0] - here[0]) + (1.0 - w) * (other[1] - here[1])).max(0.0);
            // The excess is linear in between.
            total += (upper - lower) * 0.5 * (excess(lower) + excess(upper));
            upper = lower;
        }
        total
    }
}

/// The weight at which `left` and `right` have the same utility; above it `left` is better. `left` is to have the
/// smaller first and the larger second objective; if scaling has made them one point, any weight would do.
fn indifference(left: [f64; 2], right: [f64; 2]) -> f64 {
    let (dx, dy) = (right[0] - left[0], left[1] - right[1]);
    if dy > 0.0 { dy / (dx + dy) } else { 0.0 }
}

/// Andrew's monotone chain: the lower left convex hull, corners only, of the points at `indices`, which ascend.
fn extend_hull(hull: &mut Vec<usize>, points: &[[f64; 2]], indices: impl Iterator<Item = usize>) {
    for c in indices {
        while let [.., a, b] = hull[..] {
            let (ab, ac) = ([0, 1].map(|m| points[b][m] - points[a][m]), [0, 1].map(|m| points[c][m] - points[a][m]));
            if ab[0] * ac[1] - ab[1] * ac[0] > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(c);
    }
}

/// The angle at every point between the lines to its neighbours on the front, on the side of the ideal point,
/// in radians (the paper's angle-based measure): π where the front is straight, up to 3π/2 at a knee like a corner,
/// down to π/2 in a notch. What is missing beyond an end is a vertical line up on the left, a horizontal one on
/// the right, as if the front went on so for ever. A single point therefore has 3π/2.
///
/// The angle sees only the neighbours. On a dense front it grows with the distance to them, so compare it among
/// points that are about evenly spread, and prefer [`marginal_utilities`] otherwise.
///
/// ```
/// use grn_optimisers::knee::{Neighbours, angles, knee_by_angle};
/// let front = [[0.0, 10.0], [1.0, 2.0], [3.0, 1.0], [10.0, 0.0]];
/// assert_eq!(knee_by_angle(&front, Neighbours::Nearest), Some(1));
/// assert!(angles(&front, Neighbours::Nearest)[1] > core::f64::consts::PI);
/// ```
#[must_use]
pub fn angles(points: &[[f64; 2]], neighbours: Neighbours) -> Vec<f64> {
    let front = Front::new(points);
    front.values(&front.angles(neighbours))
}

/// The index of the knee by [`angles`], picked as the module describes.
#[must_use]
pub fn knee_by_angle(points: &[[f64; 2]], neighbours: Neighbours) -> Option<usize> {
    let front = Front::new(points);
    front.pick(&front.angles(neighbours), PI + STRAIGHT)
}

/// The expected marginal utility of every point (the paper's utility-based measure): how much is lost, on average over
/// the weights `w` uniform in [0, 1] of the utility `w f1 + (1 - w) f2` of the scaled objectives, if the point
/// were not there and whoever chose it had to take the next best. Exact: the utility of the best is piecewise
/// linear in `w` and is integrated piece by piece, in O(n log n) for all points.
///
/// Points that no weight makes best, such as those in a concave stretch, have 0. A single point has infinity:
/// nothing would be left.
///
/// ```
/// use grn_optimisers::knee::marginal_utilities;
/// // The middle is best for w between 0.25 and 0.75, and worth up to 1/4 more than the ends.
/// let utilities = marginal_utilities(&[[0.0, 4.0], [1.0, 1.0], [4.0, 0.0]]);
/// assert_eq!(utilities[1], 0.25 * 0.5 * 0.5);
/// ```
#[must_use]
pub fn marginal_utilities(points: &[[f64; 2]]) -> Vec<f64> {
    let front = Front::new(points);
    front.values(&front.losses())
}

/// The index of the knee by [`marginal_utilities`], picked as the module describes.
#[must_use]
pub fn knee_by_utility(points: &[[f64; 2]]) -> Option<usize> {
    let front = Front::new(points);
    front.pick(&front.losses(), NO_LOSS)
}
