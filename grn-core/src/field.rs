//! Targets and obstacles → the morphogens x1 and x2 at a point, with their gradients (model page, section 2).

use crate::coded::coded;
use crate::geometry::{Point, Vector};
use crate::scalar::Scalar;

coded! {
    /// How a morphogen's concentration falls with distance; u is the distance in widths.
    pub enum Kernel {
        /// κ(u) = e^(-u²/2)
        Gaussian = (1, "gaussian"),
        /// κ(u) = e^-u
        Exponential = (2, "exponential"),
    }
}

impl Kernel {
    /// κ(u), in [0, 1]; a negative u is taken as 0.
    pub fn concentration<S: Scalar>(self, u: S) -> S {
        match self {
            Kernel::Gaussian => (u * u).over_power_of_two(1).exp_neg(),
            Kernel::Exponential => u.exp_neg(),
        }
    }

    /// κ at `offset` from the source, and its gradient per metre; `per_width` is 1/σ.
    fn profile<S: Scalar>(self, offset: Vector<S>, per_width: S) -> (S, Vector<S>) {
        let u = offset * per_width;
        match self {
            Kernel::Gaussian => {
                let concentration = u.dot(u).over_power_of_two(1).exp_neg();
                (concentration, u * -(concentration * per_width))
            }
            Kernel::Exponential => {
                let concentration = u.length().exp_neg();
                (concentration, u.direction().unwrap_or(Vector::ZERO) * -(concentration * per_width))
            }
        }
    }
}

/// What the field needs to know of obstacles.
pub trait Obstacles<S> {
    /// The vector to `point` from the nearest point of any obstacle, metres; zero inside an obstacle, `None` without any.
    fn offset_from_nearest(&self, point: Point<S>) -> Option<Vector<S>>;
}

/// Obstacles known as single points on their boundary.
impl<S: Scalar> Obstacles<S> for [Point<S>] {
    fn offset_from_nearest(&self, point: Point<S>) -> Option<Vector<S>> {
        let offsets = self.iter().map(|&obstacle| point - obstacle);
        let nearest = offsets
            .map(|offset| (offset.square(), offset))
            .reduce(|best, next| if next.0 < best.0 { next } else { best })?;
        Some(nearest.1)
    }
}

/// The morphogens at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Morphogens<S> {
    /// Σ over targets of κ(d / σ_t); a sum, not clipped.
    pub x1: S,
    /// The largest κ(d / σ_o) over obstacles; 1 inside one, 0 without any.
    pub x2: S,
    /// ∇x1, per metre.
    pub x1_gradient: Vector<S>,
    /// ∇x2, per metre.
    pub x2_gradient: Vector<S>,
}

/// The rule that turns a world into morphogens: a kernel and two widths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field<S> {
    kernel: Kernel,
    target_width: S,
    per_target_width: S,
    per_obstacle_width: S,
}

impl<S: Scalar> Field<S> {
    /// A field with widths σ_t and σ_o in metres, both positive.
    pub fn new(kernel: Kernel, target_width: S, obstacle_width: S) -> Self {
        Field {
            kernel,
            target_width,
            per_target_width: S::ONE / target_width,
            per_obstacle_width: S::ONE / obstacle_width,
        }
    }

    /// σ_t in metres.
    pub fn target_width(&self) -> S {
        self.target_width
    }

    /// κ(d / σ_t): what one target at distance d (metres) contributes to x1.
    pub fn target_concentration(&self, distance: S) -> S {
        self.kernel.concentration(distance * self.per_target_width)
    }

    /// κ(d / σ_o): x2 at distance d (metres) from the nearest obstacle.
    pub fn obstacle_concentration(&self, distance: S) -> S {
        self.kernel.concentration(distance * self.per_obstacle_width)
    }

    /// x1, x2 and their gradients at `point`.
    pub fn at<O: Obstacles<S> + ?Sized>(
        &self,
        point: Point<S>,
        targets: impl IntoIterator<Item = Point<S>>,
        obstacles: &O,
    ) -> Morphogens<S> {
        let mut x1 = S::ZERO;
        let mut x1_gradient = Vector::ZERO;
        for target in targets {
            let (concentration, gradient) = self.kernel.profile(point - target, self.per_target_width);
            x1 = x1 + concentration;
            x1_gradient = x1_gradient + gradient;
        }
        let (x2, x2_gradient) = match obstacles.offset_from_nearest(point) {
            None => (S::ZERO, Vector::ZERO),
            Some(offset) => self.kernel.profile(offset, self.per_obstacle_width),
        };
        Morphogens { x1, x2, x1_gradient, x2_gradient }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Q8_24;

    const TARGETS: [Point<f64>; 2] = [Vector::new(0.0, 0.0), Vector::new(1.0, 0.5)];
    const OBSTACLES: [Point<f64>; 2] = [Vector::new(2.0, 2.0), Vector::new(-1.0, -1.5)];

    #[test]
    fn gradients_are_derivatives() {
        for kernel in [Kernel::Gaussian, Kernel::Exponential] {
            let field = Field::new(kernel, 1.5, 0.9);
            let at = |x, y| field.at(Vector::new(x, y), TARGETS, &OBSTACLES[..]);
            let (x, y, h) = (0.7, -0.4, 1e-6);
            let here = at(x, y);
            let east = (at(x + h, y).x1 - at(x - h, y).x1) / (2.0 * h);
            let north = (at(x, y + h).x2 - at(x, y - h).x2) / (2.0 * h);
            assert!((here.x1_gradient.x - east).abs() < 1e-8, "{kernel:?}");
            assert!((here.x2_gradient.y - north).abs() < 1e-8, "{kernel:?}");
        }
    }

    #[test]
    fn x1_sums_and_x2_takes_the_largest() {
        let field = Field::new(Kernel::Gaussian, 1.5, 0.9);
        let there = field.at(Vector::new(0.0, 0.0), [Vector::ZERO, Vector::ZERO], &OBSTACLES[..]);
        assert_eq!(there.x1, 2.0);
        let d = libm::sqrt(1.0 + 2.25);
        assert!((there.x2 - libm::exp(-(d / 0.9) * (d / 0.9) / 2.0)).abs() < 1e-15);
        let none: &[Point<f64>] = &[];
        let empty = field.at(Vector::ZERO, [], none);
        assert_eq!((empty.x1, empty.x2), (0.0, 0.0));
    }

    #[test]
    fn fixed_point_stays_close_on_a_tenth_scale() {
        let exact = Field::new(Kernel::Gaussian, 0.15, 0.09);
        let fixed = Field::new(Kernel::Gaussian, Q8_24::from_f64(0.15), Q8_24::from_f64(0.09));
        let q = |v: Vector<f64>| Vector::new(Q8_24::from_f64(v.x), Q8_24::from_f64(v.y));
        let (p, t, o) = (Vector::new(0.11, 0.05), Vector::new(0.0, 0.02), Vector::new(0.2, 0.1));
        let a = exact.at(p, [t], &[o][..]);
        let b = fixed.at(q(p), [q(t)], &[q(o)][..]);
        assert!((a.x1 - b.x1.to_f64()).abs() < 1e-6 && (a.x2 - b.x2.to_f64()).abs() < 1e-6);
        assert!((a.x2_gradient - Vector::new(b.x2_gradient.x.to_f64(), b.x2_gradient.y.to_f64())).length() < 1e-4);
    }
}
