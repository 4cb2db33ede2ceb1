//! Figures of a campaign: plain data in, an SVG document out.
//!
//! Every figure is a pure function. It reads nothing but its arguments, and equal arguments give equal
//! bytes, so figures can be held in golden files and compared between runs. Lengths on paper are points
//! (1/72 inch): [`style::COLUMN`] is one column of a two-column page, [`style::PAGE`] its full width, and no
//! text but subscripts is set below 7 points. Lengths in the world are metres with y upwards, times are
//! seconds, angles in the data are radians unless a name says otherwise.
//!
//! Colours are those of Okabe and Ito, which people with colour-blindness can tell apart; every
//! distinction is also made by shape, dash or lightness, so that a grey print keeps it.
//!
//! Charts with axes are drawn by `plotters` (`axes.rs`). Trees, networks and maps need fractional
//! coordinates, subscripts and measured text, which that crate's SVG backend does not have without a font
//! library, so they use the small writer in `svg.rs`.

mod axes;
mod boxes;
mod convergence;
mod error;
mod front;
mod grn;
mod grn_draw;
mod grn_layout;
mod legend;
mod map;
mod paint;
mod panels;
mod pareto;
mod pattern;
mod place;
mod rates;
pub mod style;
mod svg;
mod text;
mod trace;
mod trace_map;
mod trace_strips;
mod tree;

pub use boxes::{BoxFigure, BoxGroup, BoxPanel, boxes};
pub use convergence::{ConvergenceFigure, ConvergencePanel, ConvergenceSeries, convergence};
pub use error::FigureError;
pub use grn::{Gene, Input, Source, grn};
pub use map::Window;
pub use pareto::{KneeKind, ParetoPoint, Reference, pareto};
pub use pattern::{Panel, PatternFigure, Target, pattern};
pub use rates::{RateGroup, RateRow, RatesFigure, rates};
pub use trace::{Instant, Pose, TraceFigure, trace};
pub use tree::{SyntaxTree, tree};

#[cfg(test)]
mod check;
