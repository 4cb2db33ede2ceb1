//! Figures of a campaign: plain data in, an SVG document out.
//!
//! Every figure is a pure function. It reads nothing but its arguments, and equal arguments give equal
//! bytes, so figures can be held in golden files and compared between runs. Lengths on paper are points
//! (1/72 inch): [`style::COLUMN`] is one column of a two-column page, [`style::PAGE`] its full width, and no
//! text but subscripts is set below 7 points. Lengths in the world are metres with y upwards, times are
//! seconds, angles in the data are radians unless a name says otherwise.
//!
//! A figure is drawn whatever the data, as long as they are numbers that mean something: with nothing to show it says so,
//! with too much for a page it goes on overleaf, and long names are broken or cut. Errors name numbers that mean nothing.
//!
//! Colours are those of Okabe and Ito, which people with colour-blindness can tell apart; every
//! distinction is also made by shape, dash or lightness, so that a grey print keeps it.
//!
//! Charts with axes are drawn by `plotters` (`chart/axes.rs`). Trees, networks and maps need fractional
//! coordinates, subscripts and measured text, which that crate's SVG backend does not have without a font
//! library, so they use the small writer in `canvas/svg.rs`.

mod boxes;
mod canvas;
mod chart;
mod convergence;
mod grn;
mod pareto;
mod pattern;
#[cfg(feature = "png")]
mod png;
mod rates;
mod trace;
mod tree;

#[cfg(test)]
mod odd_data;

pub use boxes::{BoxFigure, BoxGroup, BoxPanel, boxes};
pub use canvas::error::FigureError;
pub use canvas::note::nothing_to_draw;
pub use canvas::style;
pub use chart::map::Window;
pub use convergence::{ConvergenceFigure, ConvergencePanel, ConvergenceSeries, convergence};
pub use grn::data::{Gene, Input, Source};
pub use grn::figure::grn;
pub use pareto::data::{ParetoPoint, Reference};
pub use pareto::figure::pareto;
pub use pareto::pairs::{ObjectivesFigure, ObjectivesPoint, objectives};
pub use pattern::{Panel, PatternFigure, Target, pattern};
#[cfg(feature = "png")]
pub use png::{PngError, png};
pub use rates::{RateGroup, RateRow, RatesFigure, rates};
pub use trace::data::{Fault, Instant, Pose, TraceFigure};
pub use trace::figure::trace;
pub use tree::{SyntaxTree, tree};
