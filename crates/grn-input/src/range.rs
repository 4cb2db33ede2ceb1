//! Ranges of numbers.

use crate::InputError;
use std::fmt;

/// The numbers from `low` to `high`, both included, in some unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range<T> {
    /// The least.
    pub low: T,
    /// The greatest.
    pub high: T,
    /// Unit in words, perhaps empty.
    pub unit: &'static str,
}

impl<T: PartialOrd + Copy + fmt::Debug> Range<T> {
    /// A range.
    pub const fn new(low: T, high: T, unit: &'static str) -> Self {
        Range { low, high, unit }
    }

    /// Whether a number is in it; NaN is in none.
    pub fn holds(&self, value: T) -> bool {
        value >= self.low && value <= self.high
    }

    /// The number, if it is in the range.
    ///
    /// # Errors
    /// The key, the value and the range.
    pub fn check(&self, key: &str, value: T) -> Result<T, InputError> {
        if self.holds(value) { Ok(value) } else { Err(InputError::new(key, format!("{value:?}"), self.to_string())) }
    }
}

impl<T: fmt::Debug> fmt::Display for Range<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Plain integers for floating-point bounds that are whole.
        let plain = |number: &T| format!("{number:?}").trim_end_matches(".0").to_owned();
        write!(f, "must be a number from {} to {}", plain(&self.low), plain(&self.high))?;
        if self.unit.is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_in_no_range() {
        let range = Range::new(0.0, 100.0, "metres");
        for wrong in [f64::NAN, f64::INFINITY, -f64::MIN_POSITIVE, 100.000_001, 1e300] {
            let error = range.check("ring.d_min", wrong).unwrap_err().to_string();
            assert!(error.starts_with("ring.d_min = ") && error.ends_with("from 0 to 100 metres"), "{error}");
        }
        assert!(range.holds(0.0) && range.holds(100.0) && range.holds(5e-324));
    }
}
