//! What can be wrong with the data of a figure.

/// A figure's data cannot be drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum FigureError {
    /// A number is NaN or infinite.
    NotFinite {
        /// Which input holds it.
        what: &'static str,
        /// Where in that input, counted from 0.
        index: usize,
    },
    /// A number is finite, but means nothing here.
    OutOfRange {
        /// Which input holds it.
        what: &'static str,
        /// Where in that input, counted from 0.
        index: usize,
        /// What would have been accepted.
        expected: &'static str,
    },
    /// Two inputs that belong together differ in length.
    Length {
        /// Which input.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// The chart library refused; the text is its own.
    Chart(String),
}

impl std::fmt::Display for FigureError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotFinite { what, index } => write!(f, "{what} {index} is not a finite number"),
            Self::OutOfRange { what, index, expected } => write!(f, "{what} {index} must be {expected}"),
            Self::Length { what, found, expected } => {
                write!(f, "{what}: {found} values where {expected} are needed")
            }
            Self::Chart(reason) => write!(f, "the chart could not be drawn: {reason}"),
        }
    }
}

impl std::error::Error for FigureError {}

/// The largest number a figure takes, either sign: beyond it sums and scales could overflow.
const LARGEST: f64 = 1e9;

/// Rejects the first number of `values` that is NaN, infinite or absurdly large.
pub(crate) fn finite(what: &'static str, values: impl IntoIterator<Item = f64>) -> Result<(), FigureError> {
    for (index, value) in values.into_iter().enumerate() {
        if !value.is_finite() {
            return Err(FigureError::NotFinite { what, index });
        }
        if value.abs() > LARGEST {
            return Err(FigureError::OutOfRange { what, index, expected: "between -1e9 and 1e9" });
        }
    }
    Ok(())
}

/// [`finite`] for the points of lines; the index is the line's.
pub(crate) fn finite_lines(what: &'static str, lines: &[Vec<[f64; 2]>]) -> Result<(), FigureError> {
    for (index, line) in lines.iter().enumerate() {
        finite(what, line.iter().flatten().copied()).map_err(|e| e.within(what, index))?;
    }
    Ok(())
}

/// Rejects the first finite number of `values` outside `lo..=hi`.
pub(crate) fn within(
    what: &'static str,
    values: impl IntoIterator<Item = f64>,
    (lo, hi): (f64, f64),
    expected: &'static str,
) -> Result<(), FigureError> {
    match values.into_iter().position(|v| v < lo || v > hi) {
        Some(index) => Err(FigureError::OutOfRange { what, index, expected }),
        None => Ok(()),
    }
}

impl FigureError {
    /// The same fault, said of the item that holds the number.
    pub(crate) fn within(self, what: &'static str, index: usize) -> Self {
        match self {
            Self::NotFinite { .. } => Self::NotFinite { what, index },
            Self::OutOfRange { expected, .. } => Self::OutOfRange { what, index, expected },
            other => other,
        }
    }
}
