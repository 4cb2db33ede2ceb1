//! The pattern: the contour M = L around the targets (model page, section 3).

use crate::field::{Field, Morphogens, Obstacles};
use crate::geometry::{Point, Vector};
use crate::network::Network;
use crate::scalar::Scalar;
use core::fmt;

/// |M(1,0) - M(0,0)| below which a model has no pattern.
pub const SMALLEST_CONTRAST: f64 = 1e-4;

/// The network hardly tells a target from empty space: |M(1,0) - M(0,0)| is below [`SMALLEST_CONTRAST`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoPattern {
    /// M(1,0) - M(0,0).
    pub contrast: f64,
}

impl fmt::Display for NoPattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the model has no pattern: M(1,0) - M(0,0) = {:e}, smaller than {SMALLEST_CONTRAST:e}", self.contrast)
    }
}

impl core::error::Error for NoPattern {}

/// The level and orientation of a model's pattern. Both follow from the model alone, so a robot knows them before it has
/// seen anything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern<S> {
    level: S,
    contrast: S,
}

impl<S: Scalar> Pattern<S> {
    /// Level L = M(0,0) + c · (M(1,0) - M(0,0)), with c = `level_fraction`.
    ///
    /// # Errors
    /// [`NoPattern`] if the model's contrast is too small.
    pub fn of<const N: usize>(network: &Network<S, N>, level_fraction: S) -> Result<Self, NoPattern> {
        let empty = network.steady_state(S::ZERO, S::ZERO);
        let contrast = network.steady_state(S::ONE, S::ZERO) - empty;
        if contrast.abs() < S::from_f64(SMALLEST_CONTRAST) {
            return Err(NoPattern { contrast: contrast.to_f64() });
        }
        Ok(Pattern { level: empty + level_fraction * contrast, contrast })
    }

    /// L.
    pub fn level(&self) -> S {
        self.level
    }

    /// M(1,0) - M(0,0); its sign is the orientation s.
    pub fn contrast(&self) -> S {
        self.contrast
    }

    /// Whether a point with morphogen level `m` is inside: s · (M - L) ≥ 0.
    pub fn is_inside(&self, m: S) -> bool {
        if self.contrast > S::ZERO { m >= self.level } else { m <= self.level }
    }

    /// The pattern error φ = (M - L) / (M(1,0) - M(0,0)): 0 on the pattern, positive inside, c at most in free space
    /// outside, 1 - c at a lone target.
    pub fn error(&self, m: S) -> S {
        (m - self.level) / self.contrast
    }

    /// ∇φ in 1/m, from the morphogens of a point and M's `slopes` (∂M/∂x1, ∂M/∂x2) there.
    pub fn error_gradient(&self, slopes: [S; 2], here: &Morphogens<S>) -> Vector<S> {
        let [d1, d2] = slopes;
        here.x1_gradient * (d1 / self.contrast) + here.x2_gradient * (d2 / self.contrast)
    }

    /// Radius of the ring around a lone target in free space, in metres: where the pattern error first changes sign on
    /// the way out, within 8 σ_t. `None` if it does not.
    pub fn free_space_radius<const N: usize>(&self, network: &Network<S, N>, field: &Field<S>) -> Option<S> {
        let inside = |r| self.is_inside(network.steady_state(field.target_concentration(r), S::ZERO));
        let stride = field.target_width().over_power_of_two(4);
        let mut inner = S::ZERO;
        let mut outer = stride;
        let mut strides = 0;
        while inside(outer) {
            strides += 1;
            if strides > 128 {
                return None;
            }
            inner = outer;
            outer = outer + stride;
        }
        for _ in 0..24 {
            let middle = (inner + outer).over_power_of_two(1);
            if inside(middle) {
                inner = middle;
            } else {
                outer = middle;
            }
        }
        Some((inner + outer).over_power_of_two(1))
    }

    /// The nearest candidate point, metres: Newton steps from `start` along the gradient of the pattern error.
    ///
    /// Each step is at most `longest` metres and is halved while it does not bring |φ| down, so the search cannot run
    /// away. It has converged when the step that is left is shorter than a hundredth of `longest`. `None` otherwise: far
    /// from every target, where the gradient vanishes, or where the pattern is broken and |φ| has a minimum above 0.
    pub fn nearest_candidate<const N: usize, O: Obstacles<S> + ?Sized>(
        &self,
        network: &Network<S, N>,
        field: &Field<S>,
        targets: &[Point<S>],
        obstacles: &O,
        start: Point<S>,
        longest: S,
    ) -> Option<Point<S>> {
        let converged = longest * S::from_ratio(1, 100);
        let look = |point: Point<S>| {
            let here = field.at(point, targets.iter().copied(), obstacles);
            // The gradient at once: most steps that are tried are taken.
            let m = network.steady_state_gradient(here.x1, here.x2);
            (self.error(m.value), self.error_gradient(m.gradient, &here))
        };
        let mut point = start;
        let (mut error, mut gradient) = look(start);
        for _ in 0..NEWTON_STEPS {
            let (distance, direction) = newton_step(error, gradient)?;
            if distance.abs() < converged {
                return Some(point + direction * distance);
            }
            let mut step = direction * distance.clamp(-longest, longest);
            let better = (0..=BACKTRACKS).find_map(|_| {
                let tried = look(point + step);
                let falls = tried.0.abs() < error.abs();
                if !falls {
                    step = step * S::ONE.over_power_of_two(1);
                }
                falls.then_some(tried)
            });
            (error, gradient) = better?;
            point = point + step;
        }
        None
    }
}

const NEWTON_STEPS: usize = 12;
const BACKTRACKS: usize = 4;

/// The Newton step -φ ∇φ / |∇φ|², in metres: from here to the pattern, to first order. As a signed distance and the unit
/// vector along which it is, which points inwards. `None` for a vanishing gradient.
pub fn newton_step<S: Scalar>(error: S, gradient: Vector<S>) -> Option<(S, Vector<S>)> {
    let (slope, direction) = gradient.polar()?;
    Some((-(error / slope), direction))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Kernel;
    use crate::motif::Motif;
    use crate::network::{Gene, Source};

    fn nand_xnor() -> Network<f64, 4> {
        let gene = |motif, inputs: &[Source], theta| Gene { motif, inputs: inputs.iter().copied().collect(), theta };
        let nand = gene(Motif::Nand, &[Source::X1, Source::X1], 0.8393);
        let xnor = gene(Motif::Xnor, &[Source::Gene(0), Source::X2], 0.9256);
        Network::new(1.0, [nand, xnor]).unwrap().cast()
    }

    #[test]
    fn level_orientation_and_radius_of_the_printed_model() {
        let network = nand_xnor();
        let pattern = Pattern::of(&network, 0.5).unwrap();
        assert!((pattern.level() - 0.301_651_796).abs() < 1e-7);
        assert!(
            pattern.is_inside(network.steady_state(1.0, 0.0)) && !pattern.is_inside(network.steady_state(0.0, 0.0))
        );
        let field = Field::new(Kernel::Gaussian, 1.5, 0.9);
        let radius = pattern.free_space_radius(&network, &field).unwrap();
        assert!((radius - 1.221_609).abs() < 1e-3, "{radius}");
    }

    #[test]
    fn newton_reaches_the_ring_from_inside_and_outside() {
        let network = nand_xnor();
        let pattern = Pattern::of(&network, 0.5).unwrap();
        let field = Field::new(Kernel::Gaussian, 1.5, 0.9);
        let ring = pattern.free_space_radius(&network, &field).unwrap();
        let nothing: &[Point<f64>] = &[];
        for start in [0.05, 0.4, 1.0, 1.6, 2.5, 3.5] {
            let found = pattern
                .nearest_candidate(&network, &field, &[Vector::ZERO], nothing, Vector::new(start, 0.0), 0.5)
                .unwrap();
            assert!((found.x - ring).abs() < 1e-3 && found.y == 0.0, "{start}: {found:?}");
        }
        let gone = pattern.nearest_candidate(&network, &field, &[], nothing, Vector::ZERO, 0.5);
        assert!(gone.is_none());
    }

    #[test]
    fn a_model_blind_to_the_target_has_no_pattern() {
        let blind = Gene { motif: Motif::Pos, inputs: [Source::X2].into_iter().collect(), theta: 1.0 };
        let network: Network<f32, 1> = Network::new(1.0, [blind]).unwrap();
        assert_eq!(Pattern::of(&network, 0.5), Err(NoPattern { contrast: 0.0 }));
    }
}
