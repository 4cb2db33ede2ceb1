//! Drawing on paper: shapes, text with measured widths, colours, and what can be wrong with the data of a figure.

pub(crate) mod error;
pub(crate) mod format;
pub(crate) mod note;
pub(crate) mod paint;
pub mod style;
pub(crate) mod svg;
pub(crate) mod text;
