//! The motion law: where the robot wants to go, as a velocity in the world.
//!
//! This is the field's layer-2 GRN (Guo, Meng and Jin), with the robot's velocity dg/dt relative to the target it
//! accompanies:
//!
//! ```text
//! dg/dt = -a z + m p          dp/dt = -c p - k f(z) + b D          f(z) = z / (1 + |z| / r)
//! ```
//!
//! z is the gradient of half the squared distance to the pattern, that is, the vector from the nearest candidate point
//! to the robot, estimated by a Newton step on the pattern error; D is the repulsion from neighbours. On the pattern
//! only D's part along the pattern counts, which spreads the robots evenly; f is a sigmoid that saturates at the ring's
//! radius r, algebraic so that it is the same bits everywhere. (The sign of k f(z) is chosen so that both genes pull
//! towards the pattern.)

use super::knowledge::{KnownTarget, Neighbour};
use crate::blob::Gains;
use crate::geometry::{Point, Vector};
use crate::pattern::newton_step;
use crate::scalar::Scalar;

/// What the motion law needs to know of the pattern where the robot is.
pub struct Bearing<S> {
    /// Pattern error φ from the integrated morphogen.
    pub error: S,
    /// ∇φ, 1/m.
    pub gradient: Vector<S>,
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
    cruise: S,
    ring_radius: S,
    tick: S,
    protein: Vector<S>,
}

impl<S: Scalar> Motion<S> {
    /// A law at rest; `ring_radius` in world metres, `tick` the control period in seconds.
    pub fn new(gains: &Gains, ring_radius: S, tick: S) -> Self {
        Motion {
            attraction: S::from_f32(gains.attraction),
            coupling: S::from_f32(gains.coupling),
            decay: S::from_f32(gains.decay),
            drive: S::from_f32(gains.drive),
            repulsion: S::from_f32(gains.repulsion),
            range: S::from_f32(gains.repulsion_range),
            cruise: S::from_f32(gains.cruise),
            ring_radius,
            tick,
            protein: Vector::ZERO,
        }
    }

    /// The velocity to move at, metres per second, at most the cruise speed.
    pub fn velocity(
        &mut self,
        here: Point<S>,
        bearing: &Bearing<S>,
        target: &KnownTarget<S>,
        neighbours: &[Neighbour<S>],
    ) -> Vector<S> {
        let to_pattern = self.way_to_pattern(here, bearing, target.position);
        let along = bearing.gradient.turned_left().direction();
        let repulsion = self.repulsion_from(here, neighbours);
        let near = to_pattern.length() < self.ring_radius.halved(2);
        let repulsion = match along {
            Some(along) if near => along * repulsion.dot(along),
            _ => repulsion,
        };
        let saturation = S::ONE + to_pattern.length() / self.ring_radius;
        let production = to_pattern * (self.drive / saturation) + repulsion * self.repulsion;
        self.protein = self.protein + (production - self.protein * self.decay) * self.tick;
        let velocity = target.velocity + to_pattern * self.attraction + self.protein * self.coupling;
        velocity.limited(self.cruise)
    }

    /// -z: the way to the nearest candidate point, or towards the target where the pattern cannot be sensed.
    fn way_to_pattern(&self, here: Point<S>, bearing: &Bearing<S>, target: Point<S>) -> Vector<S> {
        let to_target = target - here;
        let outside = bearing.error < S::ZERO;
        match newton_step(bearing.error, bearing.gradient) {
            Some(step) if !outside || step.dot(to_target) > S::ZERO => step.limited(self.ring_radius.halved(1)),
            _ if outside => to_target.limited(self.ring_radius.halved(1)),
            _ => Vector::ZERO,
        }
    }

    /// D: for each neighbour at distance d < R the unit vector away from it times (1 - d/R)².
    fn repulsion_from(&self, here: Point<S>, neighbours: &[Neighbour<S>]) -> Vector<S> {
        neighbours.iter().fold(Vector::ZERO, |sum, neighbour| {
            let offset = here - neighbour.position;
            let distance = offset.length();
            if distance >= self.range || distance <= S::ZERO {
                return sum;
            }
            let closeness = S::ONE - distance / self.range;
            sum + offset * (closeness * closeness / distance)
        })
    }
}
