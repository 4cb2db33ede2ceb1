//! How expression levels move: dy/dt = -y + R, by RK4, and where they come to rest.

use crate::network::Network;
use crate::scalar::{Arithmetic, Dual, Scalar, Stages};
use core::fmt;
use heapless::Vec;

impl<S: Scalar, const N: usize> Network<S, N> {
    /// The level of M when inputs are held constant: one pass in topological order with y = R.
    pub fn steady_state(&self, x1: S, x2: S) -> S {
        self.steady_morphogen([x1, x2])
    }

    /// M in the steady state and its gradient (∂M/∂x1, ∂M/∂x2).
    pub fn steady_state_gradient(&self, x1: S, x2: S) -> Dual<S> {
        self.steady_morphogen([Dual::input(x1, 0), Dual::input(x2, 1)])
    }

    /// M in the steady state for inputs (x1, x2) of any arithmetic over `S`.
    pub fn steady_morphogen<A: Arithmetic<Real = S>>(&self, x: [A; 2]) -> A {
        let mut levels = Vec::new();
        self.steady_levels(x, &mut levels);
        levels.last().copied().unwrap_or(A::ZERO)
    }

    /// Puts the level of each gene in the steady state into the empty list `levels`. M is the last one.
    pub fn steady_levels<A: Arithmetic<Real = S>>(&self, x: [A; 2], levels: &mut Vec<A, N>) {
        self.regulate(x, levels, |levels, _, regulation| {
            // Genes are visited in order and there are at most N, so the next level always fits.
            let _ = levels.push(regulation);
        });
    }
}

/// An integration step of 2^-n GRN seconds, n in 0..=10, so that multiplying by it is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step(u8);

/// The exponent of a [`Step`] was outside 0..=10.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepError(pub u8);

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an integration step of 2^-{} s; the exponent must be in 0..={}", self.0, Step::MAX_EXPONENT)
    }
}

impl core::error::Error for StepError {}

impl Step {
    const MAX_EXPONENT: u8 = 10;
    /// 1/32 s.
    pub const DEFAULT: Step = Step(5);
    /// 1/8 s: what passes in a tick of 1/32 s for a GRN four times as fast as its robot.
    pub const EIGHTH: Step = Step(3);

    /// 2^-`exponent` seconds.
    ///
    /// # Errors
    /// An exponent above 10.
    pub const fn from_exponent(exponent: u8) -> Result<Step, StepError> {
        if exponent <= Self::MAX_EXPONENT { Ok(Step(exponent)) } else { Err(StepError(exponent)) }
    }

    /// n of 2^-n.
    pub const fn exponent(self) -> u8 {
        self.0
    }

    /// The step in GRN seconds.
    pub fn seconds<S: Scalar>(self) -> S {
        S::ONE.over_power_of_two(self.0)
    }
}

/// The expression levels of a network's genes over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression<S, const N: usize> {
    levels: [S; N],
}

impl<S: Scalar, const N: usize> Default for Expression<S, N> {
    fn default() -> Self {
        Expression { levels: [S::ZERO; N] }
    }
}

impl<S: Scalar, const N: usize> Expression<S, N> {
    /// All genes silent: every level 0.
    pub fn silent() -> Self {
        Self::default()
    }

    /// Every gene at rest under constant inputs.
    pub fn at_rest(network: &Network<S, N>, x1: S, x2: S) -> Self {
        let mut levels = [S::ZERO; N];
        network.regulate([x1, x2], &mut levels, |levels, gene, regulation| {
            if let Some(level) = levels.get_mut(gene) {
                *level = regulation;
            }
        });
        Expression { levels }
    }

    /// The level of each gene of `network`, in its order.
    pub fn levels(&self, network: &Network<S, N>) -> &[S] {
        self.levels.get(..network.genes().len()).unwrap_or(&self.levels)
    }

    /// The level of the last gene, the pattern morphogen M.
    pub fn morphogen(&self, network: &Network<S, N>) -> S {
        self.levels(network).last().copied().unwrap_or(S::ZERO)
    }

    /// Advances by `steps` steps h of the classical Runge-Kutta method of fourth order under the inputs `x` = [x1, x2],
    /// constant over all of them, with the genes' levels at `rest` under the same inputs ([`Network::steady_levels`]).
    ///
    /// In Q8.24 the levels come to rest within 2^(n-24) of the steady state for h = 2^-n: smaller increments round to 0.
    ///
    /// Because a gene reads only earlier genes, a step goes gene by gene instead of stage by stage: the levels that a
    /// gene's inputs have in the four stages give its four regulations side by side, and these give its own levels.
    /// The regulation of a gene that reads inputs only is its level at rest in all stages of all steps.
    pub fn advance(&mut self, network: &Network<S, N>, x: [S; 2], rest: &[Dual<S>], h: Step, steps: u8) {
        let x = x.map(Stages::constant);
        let mut constants: Vec<Option<S>, N> = Vec::new();
        for (gene, rest) in network.genes().iter().zip(rest) {
            // There are at most N.
            let _ = constants.push(gene.reads_inputs_only().then_some(rest.value));
        }
        let sixth = S::from_ratio(1, 6);
        for _ in 0..steps {
            let mut stages: Vec<Stages<S>, N> = Vec::new();
            for ((gene, constant), level) in network.genes().iter().zip(&constants).zip(&mut self.levels) {
                let Stages([r1, r2, r3, r4]) = match *constant {
                    Some(regulation) => Stages::constant(regulation),
                    None => network.regulation(gene, x, &stages),
                };
                let k1 = r1 - *level;
                let second = *level + k1.over_power_of_two(h.0 + 1);
                let k2 = r2 - second;
                let third = *level + k2.over_power_of_two(h.0 + 1);
                let k3 = r3 - third;
                let fourth = *level + k3.over_power_of_two(h.0);
                let k4 = r4 - fourth;
                // Genes are visited in order and there are at most N, so the next one's stages always fit.
                let _ = stages.push(Stages([*level, second, third, fourth]));
                let middle = k2 + k3;
                *level = *level + ((k1 + middle + middle + k4) * sixth).over_power_of_two(h.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motif::Motif;
    use crate::network::{Gene, Source};
    use crate::scalar::Q8_24;
    use std::vec::Vec;

    fn printed<S: Scalar>() -> Network<S, 8> {
        let gene = |motif, inputs: &[Source], theta| Gene { motif, inputs: inputs.iter().copied().collect(), theta };
        let genes = [
            gene(Motif::Andn, &[Source::X2, Source::X1], 1.5441),
            gene(Motif::Nand, &[Source::X1, Source::X1], 0.0904),
            gene(Motif::Xnor, &[Source::Gene(0), Source::Gene(1)], 0.2414),
        ];
        Network::new(1.0, genes).unwrap().cast()
    }

    /// The same three equations written out, solved in f64 with a step far below RK4's and by another method:
    /// Richardson-extrapolated explicit midpoint.
    fn independent_solution(x1: f64, x2: f64, time: f64) -> [f64; 3] {
        let sig = |x: f64, theta: f64| 1.0 / (1.0 + libm::exp(-(x - theta)));
        let [t1, t2, t3] = [1.5441_f32, 0.0904, 0.2414].map(f64::from);
        let slope = |y: [f64; 3]| {
            [
                -y[0] + sig(x2 * (1.0 - x1), t1),
                -y[1] + 1.0 - sig(x1 * x1, t2),
                -y[2] + 1.0 - sig(y[0] * (1.0 - y[1]), t3) - sig((1.0 - y[0]) * y[1], t3),
            ]
        };
        let shifted = |y: [f64; 3], d: [f64; 3], h: f64| [y[0] + h * d[0], y[1] + h * d[1], y[2] + h * d[2]];
        let midpoint = |steps: usize| {
            let h = time / steps as f64;
            (0..steps).fold([0.0; 3], |y, _| shifted(y, slope(shifted(y, slope(y), h / 2.0)), h))
        };
        let (coarse, fine) = (midpoint(20_000), midpoint(40_000));
        [0, 1, 2].map(|i| fine[i] + (fine[i] - coarse[i]) / 3.0)
    }

    fn at_rest<S: Scalar>(network: &Network<S, 8>, [x1, x2]: [S; 2]) -> heapless::Vec<Dual<S>, 8> {
        let mut rest = heapless::Vec::new();
        network.steady_levels([Dual::input(x1, 0), Dual::input(x2, 1)], &mut rest);
        rest
    }

    fn integrate<S: Scalar>(network: &Network<S, 8>, x1: f64, x2: f64, h: Step, steps: usize) -> f64 {
        let mut expression = Expression::silent();
        let x = [x1, x2].map(S::from_f64);
        let rest = at_rest(network, x);
        for _ in 0..steps {
            expression.advance(network, x, &rest, h, 1);
        }
        expression.morphogen(network).to_f64()
    }

    #[test]
    fn rk4_converges_with_fourth_order() {
        let network = printed::<f64>();
        let exact = independent_solution(0.8, 0.3, 2.0)[2];
        let errors: Vec<f64> = (2..6)
            .map(|n| {
                let h = Step::from_exponent(n).unwrap();
                (integrate(&network, 0.8, 0.3, h, 2 << n) - exact).abs()
            })
            .collect();
        for pair in errors.windows(2) {
            let order = libm::log2(pair[0] / pair[1]);
            assert!((3.7..4.3).contains(&order), "order {order} from errors {errors:?}");
        }
    }

    /// The same step as in textbooks, stage by stage.
    fn stage_by_stage<S: Scalar>(network: &Network<S, 8>, levels: [S; 3], x: [S; 2], h: u8) -> [S; 3] {
        let slopes = |mut levels: [S; 3]| {
            let mut slopes = [S::ZERO; 3];
            network.regulate(x, &mut levels, |levels, gene, regulation| slopes[gene] = regulation - levels[gene]);
            slopes
        };
        let moved = |k: [S; 3], halvings| [0, 1, 2].map(|i| levels[i] + k[i].over_power_of_two(halvings));
        let k1 = slopes(levels);
        let k2 = slopes(moved(k1, h + 1));
        let k3 = slopes(moved(k2, h + 1));
        let k4 = slopes(moved(k3, h));
        let sum = |i: usize| k1[i] + (k2[i] + k3[i]) + (k2[i] + k3[i]) + k4[i];
        [0, 1, 2].map(|i| levels[i] + (sum(i) * S::from_ratio(1, 6)).over_power_of_two(h))
    }

    #[test]
    fn gene_by_gene_is_stage_by_stage_bit_for_bit() {
        fn check<S: Scalar>() {
            let network = printed::<S>();
            for (x1, x2) in [(0.0, 0.0), (1.0, 0.25), (0.3, 0.9), (1.7, 1.0)] {
                let mut expression = Expression::silent();
                let mut expected = [S::ZERO; 3];
                for steps in [1, 2, 5].into_iter().cycle().take(50) {
                    let x = [S::from_f64(x1), S::from_f64(x2)];
                    let rest = at_rest(&network, x);
                    expression.advance(&network, x, &rest, Step::DEFAULT, steps);
                    expected = (0..steps).fold(expected, |levels, _| stage_by_stage(&network, levels, x, 5));
                    assert_eq!(expression.levels(&network), expected);
                }
            }
        }
        check::<f32>();
        check::<Q8_24>();
    }

    #[test]
    fn rk4_comes_to_rest_at_the_steady_state() {
        for (x1, x2) in [(0.0, 0.0), (1.0, 0.0), (0.4, 0.9), (2.0, 1.0)] {
            let exact = printed::<f64>().steady_state(x1, x2);
            let f64_rest = integrate(&printed::<f64>(), x1, x2, Step::DEFAULT, 40 * 32);
            assert!((f64_rest - exact).abs() < 1e-13);
            let f32_rest = integrate(&printed::<f32>(), x1, x2, Step::DEFAULT, 40 * 32);
            let exact_in_f32 = printed::<f32>().steady_state(x1 as f32, x2 as f32);
            assert!((f32_rest - f64::from(exact_in_f32)).abs() < 1e-6);
            let fixed_rest = integrate(&printed::<Q8_24>(), x1, x2, Step::DEFAULT, 40 * 32);
            assert!((fixed_rest - exact).abs() < 3.0 / f64::from(1 << 19), "{fixed_rest} {exact}");
            let at_rest = Expression::at_rest(&printed::<f64>(), x1, x2);
            assert_eq!(at_rest.morphogen(&printed()), exact);
        }
    }

    #[test]
    fn the_gradient_is_the_derivative_of_the_steady_state() {
        let network = printed::<f64>();
        let h = 1e-5;
        for (x1, x2) in [(0.1, 0.0), (0.9, 0.2), (0.5, 1.0), (1.7, 0.6)] {
            let dual = network.steady_state_gradient(x1, x2);
            assert_eq!(dual.value, network.steady_state(x1, x2));
            let d1 = (network.steady_state(x1 + h, x2) - network.steady_state(x1 - h, x2)) / (2.0 * h);
            let d2 = (network.steady_state(x1, x2 + h) - network.steady_state(x1, x2 - h)) / (2.0 * h);
            assert!((dual.gradient[0] - d1).abs() < 1e-9 && (dual.gradient[1] - d2).abs() < 1e-9);
            let fixed = printed::<Q8_24>().steady_state_gradient(Q8_24::from_f64(x1), Q8_24::from_f64(x2));
            assert!((fixed.gradient[0].to_f64() - d1).abs() < 1e-6);
        }
    }

    #[test]
    fn steps_of_an_eighth_err_by_less_than_two_millionths() {
        fn worst<S: Scalar>(x1: f64, x2: f64) -> f64 {
            let error = |eighths| {
                let exact = integrate(&printed::<f64>(), x1, x2, Step(10), 128 * eighths);
                (integrate(&printed::<S>(), x1, x2, Step::EIGHTH, eighths) - exact).abs()
            };
            (1..=40).map(error).fold(0.0, f64::max)
        }
        for (x1, x2) in [(0.0, 0.0), (1.0, 0.0), (0.4, 0.9), (2.0, 1.0)] {
            // f32's sigmoid alone may err by more: it depends on the feature micromath.
            let worst = [worst::<f64>(x1, x2), worst::<Q8_24>(x1, x2)];
            assert!(worst.iter().all(|&error| error < 2e-6), "{worst:?}");
        }
    }

    #[test]
    fn a_step_is_bounded() {
        assert_eq!(Step::from_exponent(11), Err(StepError(11)));
        assert_eq!(Step::DEFAULT.seconds::<f32>(), 1.0 / 32.0);
    }
}
