//! The motion law: where the robot wants to go, as a velocity in the world.
//!
//! This is the field's layer-2 GRN (Guo, Meng and Jin) for a robot at g, with the target it accompanies moving at v:
//!
//! ```text
//! dg/dt = v - a z + m p          dp/dt = -c p - k f(z) + b D          f(z) = z / (1 + |z| / r)
//! ```
//!
//! | symbol | unit | what it is |
//! |---|---|---|
//! | g, v | m, m/s | position of the robot; estimated velocity of its target |
//! | z | m | from the nearest point of the pattern to the robot, at most r/2 long |
//! | r | m | radius of the pattern around a lone target in free space |
//! | p | m/s | the motion protein |
//! | D | 1 | repulsion from neighbours, along the pattern only |
//! | a, c | 1/s | attraction, decay |
//! | m | 1 | coupling |
//! | k, b | 1/s², m/s² | drive, repulsion |
//!
//! Three things differ from the published law.
//! - v is fed forward: without it robots trail the pattern by v/a.
//! - D = Σ t sign(t · (g - gⱼ)) (1 - dⱼ/R)² over neighbours j at distance dⱼ < R, with t a unit tangent of the pattern
//!   where the robot is and R = `repulsion_range` · r. Repulsion in the whole plane holds late robots in a second row
//!   outside the first; along the tangent alone it spreads the robots evenly and makes room for whoever pushes in. Its
//!   sign, not its share t · (g - gⱼ) / dⱼ, counts, so that robots one behind the other part before they meet.
//! - k f(z) has the sign with which both genes pull towards the pattern; f is a sigmoid that saturates at r, algebraic so
//!   that it is the same bits everywhere. With the pull -a z alone (k = 0, the default) robots settle just as near.
//!
//! z is a Newton step on the pattern error φ: φ ∇φ / |∇φ|². Outside, a step longer than r/2 or one that leads away from
//! the target is not believed: there ∇φ is small, down to a few units of Q8.24, and obstacles may outweigh the target.
//! The robot then heads for its target until the pattern can be sensed.

use super::clock::Pace;
use super::knowledge::KnownTarget;
use super::neighbours::{Neighbour, Neighbours};
use crate::blob::Gains;
use crate::geometry::{Point, Vector};
use crate::pattern::newton_step;
use crate::scalar::Scalar;

/// What the motion law needs to know of the pattern where the robot is.
pub struct PatternHere<S> {
    /// Pattern error φ from the integrated morphogen.
    pub error: S,
    /// ∇φ, 1/m.
    pub gradient: Vector<S>,
}

/// Where the pattern is, seen from the robot: -z = distance · direction.
struct Way<S> {
    /// How far, metres; negative against the direction.
    distance: S,
    /// Across the pattern, of length 1.
    direction: Vector<S>,
}

/// The state of the motion law and its gains in the controller's number type.
#[derive(Clone, Debug)]
pub struct Motion<S> {
    attraction: S,
    coupling: S,
    decay: S,
    drive: S,
    repulsion: S,
    range: S,
    per_range: S,
    cruise: S,
    ring_radius: S,
    per_ring_radius: S,
    protein: Vector<S>,
}

impl<S: Scalar> Motion<S> {
    /// A law at rest; `ring_radius` in world metres.
    pub fn new(gains: &Gains, ring_radius: S) -> Self {
        let range = S::from_f32(gains.repulsion_range) * ring_radius;
        Motion {
            attraction: S::from_f32(gains.attraction),
            coupling: S::from_f32(gains.coupling),
            decay: S::from_f32(gains.decay),
            drive: S::from_f32(gains.drive),
            repulsion: S::from_f32(gains.repulsion),
            range,
            per_range: S::ONE / range,
            cruise: S::from_f32(gains.cruise),
            ring_radius,
            per_ring_radius: S::ONE / ring_radius,
            protein: Vector::ZERO,
        }
    }

    /// The velocity to move at, metres per second, at most the cruise speed. Without a pattern it leads to the target.
    pub fn velocity(
        &mut self,
        here: Point<S>,
        pattern: Option<&PatternHere<S>>,
        target: &KnownTarget<S>,
        neighbours: &Neighbours<S>,
        pace: &Pace<S>,
    ) -> Vector<S> {
        let to_target = target.position - here;
        let Way { distance, direction } = pattern
            .and_then(|pattern| self.way_to_pattern(pattern, to_target))
            .unwrap_or_else(|| self.way_to_target(to_target));
        let to_pattern = direction * distance;
        let repulsion = self.repulsion_from(neighbours.seen_from(here), direction.turned_left(), neighbours.known());
        let mut production = repulsion * self.repulsion;
        if self.drive != S::ZERO {
            let saturation = S::ONE + distance.abs() * self.per_ring_radius;
            production = production + to_pattern * (self.drive / saturation);
        }
        let decayed = self.decay * pace.seconds;
        self.protein = if decayed > S::ONE.over_power_of_two(1) {
            // An explicit step would overshoot at this pace.
            let kept = S::ONE / (S::ONE + decayed);
            (self.protein + production * pace.seconds) * kept
        } else {
            self.protein + (production - self.protein * self.decay) * pace.seconds
        };
        let velocity = target.velocity + to_pattern * pace.held(self.attraction) + self.protein * self.coupling;
        velocity.limited(self.cruise)
    }

    /// The velocity to a place at this offset from the robot, metres per second, at most the cruise speed.
    pub fn velocity_to(&self, offset: Vector<S>, pace: &Pace<S>) -> Vector<S> {
        let Way { distance, direction } = self.way_to_target(offset);
        (direction * (distance * pace.held(self.attraction))).limited(self.cruise)
    }

    /// r/2: the longest Newton step that is believed.
    fn trust(&self) -> S {
        self.ring_radius.over_power_of_two(1)
    }

    /// The way along the gradient of the pattern error; `None` where it does not tell the way.
    fn way_to_pattern(&self, pattern: &PatternHere<S>, to_target: Vector<S>) -> Option<Way<S>> {
        let (distance, direction) = newton_step(pattern.error, pattern.gradient)?;
        let trust = self.trust();
        let inside = pattern.error >= S::ZERO;
        // From outside the pattern is ahead, and so must the target be.
        let believed = inside || (distance < trust && direction.dot(to_target) > S::ZERO);
        believed.then(|| Way { distance: distance.clamp(-trust, trust), direction })
    }

    fn way_to_target(&self, to_target: Vector<S>) -> Way<S> {
        let (distance, direction) = to_target.polar().unwrap_or((S::ZERO, Vector::ZERO));
        Way { distance: distance.min(self.trust()), direction }
    }

    /// D: along the pattern's unit `tangent`, away from each neighbour at distance d < R, (1 - d/R)² strong.
    fn repulsion_from(&self, seen_from: Point<S>, tangent: Vector<S>, neighbours: &[Neighbour<S>]) -> Vector<S> {
        let limit = self.range.square_sum(S::ZERO);
        let offsets = neighbours.iter().map(|neighbour| neighbour.offset(seen_from));
        let along = offsets.filter(|offset| offset.square() < limit).fold(S::ZERO, |sum, offset| {
            let closeness = S::ONE - offset.length() * self.per_range;
            let strength = closeness * closeness;
            if offset.dot(tangent) < S::ZERO { sum - strength } else { sum + strength }
        });
        tangent * along
    }
}
