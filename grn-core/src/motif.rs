//! The ten network motifs: how the inputs of a gene regulate its expression.
//!
//! All that there is to a motif is here: another one is a line of the table with the next free opcode, and an arm in each
//! function; the compiler and the tests below name what is missing.

use crate::coded::coded;
use crate::scalar::Arithmetic;
use core::fmt;

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
            Motif::And | Motif::Nand | Motif::Andn | Motif::Orn | Motif::Xor | Motif::Xnor => 2..=2,
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

    /// Writes the same function as text, in the paper's notation, over the names of the operands; a missing one is 0.
    ///
    /// # Errors
    /// What `out` says.
    pub fn write_formula(
        self,
        out: &mut impl fmt::Write,
        operands: &[impl fmt::Display],
        theta: impl fmt::Display,
    ) -> fmt::Result {
        let (a, b) = (Operand(operands.first()), Operand(operands.get(1)));
        let sum = Sum(operands);
        match self {
            Motif::Pos => write!(out, "sig({a}, {theta})"),
            Motif::Neg => write!(out, "1 - sig({a}, {theta})"),
            Motif::And => write!(out, "sig({a}*{b}, {theta})"),
            Motif::Nand => write!(out, "1 - sig({a}*{b}, {theta})"),
            Motif::Or => write!(out, "sig({sum}, {theta})"),
            Motif::Nor => write!(out, "1 - sig({sum}, {theta})"),
            Motif::Andn => write!(out, "sig({a}*(1 - {b}), {theta})"),
            Motif::Orn => write!(out, "sig({a} + (1 - {b}), {theta})"),
            Motif::Xor => write!(out, "sig({a}*(1 - {b}), {theta}) + sig((1 - {a})*{b}, {theta})"),
            Motif::Xnor => write!(out, "1 - sig({a}*(1 - {b}), {theta}) - sig((1 - {a})*{b}, {theta})"),
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

/// The name of an operand, if there is one.
struct Operand<'a, D>(Option<&'a D>);

impl<D: fmt::Display> fmt::Display for Operand<'_, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(name) => name.fmt(f),
            None => f.write_str("0"),
        }
    }
}

/// The names of operands with plus signs between them.
struct Sum<'a, D>(&'a [D]);

impl<D: fmt::Display> fmt::Display for Sum<'_, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, name) in self.0.iter().enumerate() {
            f.write_str(if place > 0 { " + " } else { "" })?;
            name.fmt(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_is_written_over_any_names() {
        let written = |motif: Motif, operands: &[&str]| {
            let mut text = std::string::String::new();
            motif.write_formula(&mut text, operands, "0.5").map(|()| text)
        };
        // Names with letters that the formulas themselves hold.
        assert_eq!(written(Motif::Nand, &["ab", "sigma"]).as_deref(), Ok("1 - sig(ab*sigma, 0.5)"));
        assert_eq!(written(Motif::Nor, &["b", "a", "ba"]).as_deref(), Ok("1 - sig(b + a + ba, 0.5)"));
        let xor = "sig(b*(1 - a), 0.5) + sig((1 - b)*a, 0.5)";
        assert_eq!(written(Motif::Xor, &["b", "a"]).as_deref(), Ok(xor));
        assert_eq!(written(Motif::Orn, &["b"]).as_deref(), Ok("sig(b + (1 - 0), 0.5)"));
    }

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
