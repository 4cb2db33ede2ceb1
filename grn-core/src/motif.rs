//! The ten network motifs: how the inputs of a gene regulate its expression.
//!
//! All that there is to a motif is here: another one is a line of the table with the next free opcode, and an arm in each
//! function; the compiler and the tests below name what is missing.

use crate::coded::coded;
use crate::scalar::Arithmetic;

/// The most inputs a gene can have (OR and NOR).
pub const MAX_INPUTS: usize = 4;

coded! {
    /// A network motif (Fan et al. 2019, section IV-A), with its opcode in a blob and its name in the paper.
    pub enum Motif {
        /// σ(a)
        Pos = (1, "POS"),
        /// 1 - σ(a)
        Neg = (2, "NEG"),
        /// σ(a·b)
        And = (3, "AND"),
        /// 1 - σ(a·b)
        Nand = (4, "NAND"),
        /// σ(a + b), of two to four inputs
        Or = (5, "OR"),
        /// 1 - σ(a + b), of two to four inputs
        Nor = (6, "NOR"),
        /// σ(a·(1-b))
        Andn = (7, "ANDN"),
        /// σ(a + (1-b))
        Orn = (8, "ORN"),
        /// σ(a·(1-b)) + σ((1-a)·b), both with one θ; may exceed 1
        Xor = (9, "XOR"),
        /// 1 - σ(a·(1-b)) - σ((1-a)·b), both with one θ; may be negative
        Xnor = (10, "XNOR"),
    }
}

impl Motif {
    /// How many inputs a gene with this motif may have.
    pub const fn arity(self) -> core::ops::RangeInclusive<usize> {
        match self {
            Motif::Pos | Motif::Neg => 1..=1,
            Motif::Or | Motif::Nor => 2..=MAX_INPUTS,
            _ => 2..=2,
        }
    }

    /// The regulation R of dy/dt = -y + R, with σ(x) = 1 / (1 + e^(-k(x - θ))).
    ///
    /// `inputs` gives as many expression levels as [`Motif::arity`] allows; a missing one counts as 0.
    #[inline]
    pub fn regulation<A: Arithmetic>(self, inputs: impl IntoIterator<Item = A>, theta: A::Real, k: A::Real) -> A {
        let sig = |x: A| x.sigmoid(theta, k);
        let mut levels = inputs.into_iter();
        let a = levels.next().unwrap_or(A::ZERO);
        let b = levels.next().unwrap_or(A::ZERO);
        let sum = || levels.fold(a + b, |sum, level| sum + level);
        match self {
            Motif::Pos => sig(a),
            Motif::Neg => A::ONE - sig(a),
            Motif::And => sig(a * b),
            Motif::Nand => A::ONE - sig(a * b),
            Motif::Or => sig(sum()),
            Motif::Nor => A::ONE - sig(sum()),
            Motif::Andn => sig(a * (A::ONE - b)),
            Motif::Orn => sig(a + (A::ONE - b)),
            Motif::Xor => sig(a * (A::ONE - b)) + sig((A::ONE - a) * b),
            Motif::Xnor => A::ONE - sig(a * (A::ONE - b)) - sig((A::ONE - a) * b),
        }
    }

    /// The same function as text, in the paper's notation; `a`, `b`, … are the operands.
    pub const fn formula(self) -> &'static str {
        match self {
            Motif::Pos => "sig(a, θ)",
            Motif::Neg => "1 - sig(a, θ)",
            Motif::And => "sig(a*b, θ)",
            Motif::Nand => "1 - sig(a*b, θ)",
            Motif::Or => "sig(a + b + …, θ)",
            Motif::Nor => "1 - sig(a + b + …, θ)",
            Motif::Andn => "sig(a*(1 - b), θ)",
            Motif::Orn => "sig(a + (1 - b), θ)",
            Motif::Xor => "sig(a*(1 - b), θ) + sig((1 - a)*b, θ)",
            Motif::Xnor => "1 - sig(a*(1 - b), θ) - sig((1 - a)*b, θ)",
        }
    }

    /// Whether it rises with its operand; for XOR and XNOR, which do both, while the other operand is low.
    pub const fn rises_with(self, operand: usize) -> bool {
        match self {
            Motif::Pos | Motif::And | Motif::Or | Motif::Xor => true,
            Motif::Neg | Motif::Nand | Motif::Nor | Motif::Xnor => false,
            Motif::Andn | Motif::Orn => operand == 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_motif_follows_its_equation() {
        let (a, b, c, theta, k) = (0.7_f64, 0.2, 0.4, 0.35, 2.0);
        let sig = |x: f64| 1.0 / (1.0 + libm::exp(-k * (x - theta)));
        let expected = [
            (Motif::Pos, sig(0.7)),
            (Motif::Neg, 1.0 - sig(0.7)),
            (Motif::And, sig(0.14)),
            (Motif::Nand, 1.0 - sig(0.14)),
            (Motif::Or, sig(1.3)),
            (Motif::Nor, 1.0 - sig(1.3)),
            (Motif::Andn, sig(0.56)),
            (Motif::Orn, sig(1.5)),
            (Motif::Xor, sig(0.56) + sig(0.06)),
            (Motif::Xnor, 1.0 - sig(0.56) - sig(0.06)),
        ];
        assert_eq!(expected.map(|(motif, _)| motif), Motif::ALL, "a motif has no value to be held to");
        for (motif, value) in expected {
            let inputs = &[a, b, c][..(*motif.arity().end()).min(3)];
            let got = motif.regulation(inputs.iter().copied(), theta, k);
            assert!((got - value).abs() < 1e-12, "{}: {got} against {value}", motif.name());
        }
    }

    #[test]
    fn motifs_rise_and_fall_as_they_say() {
        for motif in Motif::ALL {
            for operand in 0..*motif.arity().end() {
                let with = |level: f64| {
                    let inputs = (0..*motif.arity().end()).map(|place| if place == operand { level } else { 0.1 });
                    motif.regulation(inputs, 0.35, 2.0)
                };
                assert_eq!(with(0.8) > with(0.2), motif.rises_with(operand), "{} {operand}", motif.name());
            }
        }
    }

    #[test]
    fn opcodes_are_frozen() {
        let frozen = ["POS", "NEG", "AND", "NAND", "OR", "NOR", "ANDN", "ORN", "XOR", "XNOR"];
        let names: std::vec::Vec<_> = Motif::ALL.iter().map(|motif| motif.name()).collect();
        assert_eq!(names, frozen, "a released motif keeps its place; a new one goes to the end of this list, too");
        for (motif, code) in Motif::ALL.into_iter().zip(1..) {
            assert_eq!((motif.code(), Motif::from_code(code)), (code, Some(motif)));
        }
        assert!(Motif::from_code(0).is_none() && Motif::from_code(frozen.len() as u8 + 1).is_none());
    }
}
