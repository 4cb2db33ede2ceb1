//! Panels side by side, over as many pages as it takes, and the axis of what they measure.

use crate::canvas::paint::{Anchor, Font, Rect};
use crate::canvas::style::{COLUMN, LABEL, PAGE, PAGE_HEIGHT, SMALL};
use crate::canvas::svg::Svg;
use crate::canvas::text::{BOLD, lines, width};
use crate::chart::axes::Axis;

/// Room left of all panels for the words of the y axis.
const WORDS: f64 = 11.0;
/// Room left of each panel for its numbers.
const NUMBERS: f64 = 34.0;
const GAP: f64 = 6.0;
/// Height of a line of a title.
const TITLE: f64 = 10.0;
/// Most lines of a title; a longer one is cut.
const TITLE_LINES: usize = 3;

/// Panels in rows and columns.
pub(crate) struct Grid {
    /// Width of the figure: one column of a page or all of it.
    pub width: f64,
    columns: usize,
}

impl Grid {
    /// One panel is as wide as a column of the page if that leaves it `least` points; several share the
    /// page's width, up to three abreast.
    pub fn new(panels: usize, least: f64) -> Self {
        let mut options = if panels == 1 { vec![(COLUMN, 1)] } else { Vec::new() };
        options.extend((1..=panels.min(3)).rev().map(|columns| (PAGE, columns)));
        let grids = options.into_iter().map(|(width, columns)| Self { width, columns });
        let wide = |grid: &Self| grid.plot() >= least;
        grids.into_iter().find(wide).unwrap_or(Self { width: PAGE, columns: 1 })
    }

    fn cell(&self) -> f64 {
        (self.width - WORDS) / self.columns as f64
    }

    /// Width between the axes of a panel.
    pub fn plot(&self) -> f64 {
        self.cell() - NUMBERS - GAP
    }

    /// How many panels fit on a page in rows so high below a head: at least one row of them.
    pub fn limit(&self, head: f64, row: f64) -> usize {
        self.columns * (((PAGE_HEIGHT - head) / row) as usize).max(1)
    }

    fn title(&self, title: &str) -> Vec<String> {
        lines(title, LABEL * BOLD, self.cell() - 2.0 * GAP, TITLE_LINES)
    }

    /// Room that the highest of some titles takes.
    pub fn title_height<'a>(&self, titles: impl Iterator<Item = &'a str>) -> f64 {
        TITLE * titles.map(|title| self.title(title).len()).max().unwrap_or(0) as f64
    }

    /// The row of a panel, counted from 0.
    pub fn row(&self, panel: usize) -> usize {
        panel / self.columns
    }

    /// The rectangle between the axes of a panel.
    pub fn rect(&self, panel: usize, top: f64, height: f64) -> Rect {
        let left = WORDS + (panel % self.columns) as f64 * self.cell() + NUMBERS;
        Rect::new(left, top, self.plot(), height)
    }

    /// Writes a panel's title from `top` downwards, and the words of the y axis beside the first panel of a row.
    pub fn words(&self, svg: &mut Svg, panel: usize, rect: &Rect, title: (&str, f64), y_label: &str) {
        let middle = rect.x + rect.w / 2.0;
        // Above the middle of the axes, unless it is so long that it would reach into the next panel.
        let left = WORDS + (panel % self.columns) as f64 * self.cell();
        for (i, line) in self.title(title.0).iter().enumerate() {
            let half = width(line, LABEL, true) / 2.0;
            let x = middle.min(left + self.cell() - half).max(left + half);
            let base = title.1 + TITLE * (i as f64 + 0.85);
            svg.text(line, (x, base), &Font::new(LABEL, Anchor::Middle).bold());
        }
        if panel.is_multiple_of(self.columns) {
            let at = (WORDS - 2.0, rect.y + rect.h / 2.0);
            svg.turned_text(y_label, at, -90.0, &Font::new(LABEL, Anchor::Middle));
        }
    }
}

/// An axis without ticks from 0 to `hi`.
pub(crate) fn blank(hi: f64) -> Axis {
    Axis { lo: 0.0, hi, ticks: Vec::new(), minor: Vec::new(), log: false }
}

/// The axis of finite values: logarithmic if they are above 0 and span more than a factor of ten.
pub(crate) fn value_axis(values: &[f64]) -> Axis {
    let (lo, hi) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(*v), hi.max(*v)));
    if values.is_empty() {
        return blank(1.0);
    }
    if lo > 0.0 && hi > 10.0 * lo {
        let room = libm::pow(hi / lo, 0.05);
        return Axis::logarithmic(lo / room, hi * room);
    }
    let size = lo.abs().max(hi.abs());
    let span = if hi - lo > 1e-9 * size { hi - lo } else { size.max(1e-6) };
    let margin = 0.06 * span;
    let floor = if lo < 0.0 { lo - margin } else { (lo - margin).max(0.0) };
    let axis = Axis::linear(floor, hi + margin, 5.0);
    let widest = axis.ticks.iter().map(|tick| width(&tick.1, SMALL, false)).fold(0.0, f64::max);
    if widest > NUMBERS - 8.0 { powers(axis) } else { axis }
}

/// Writes long numbers as a decimal times a power of ten.
fn powers(mut axis: Axis) -> Axis {
    for (value, label) in &mut axis.ticks {
        *label = format!("{value:.2e}").replace('-', "\u{2212}");
    }
    axis
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_lie_apart_within_the_page() {
        for (panels, least) in [(1, 100.0), (1, 300.0), (2, 100.0), (5, 100.0), (5, 180.0)] {
            let grid = Grid::new(panels, least);
            assert!(grid.plot() >= least);
            let rect = |i: usize| grid.rect(i, 120.0 * grid.row(i) as f64, 100.0);
            for i in 0..panels {
                assert!(rect(i).x >= WORDS + NUMBERS && rect(i).right() <= grid.width);
                assert!((0..i).all(|j| rect(i).overlap(&rect(j)) == 0.0));
            }
        }
        assert_eq!(Grid::new(1, 100.0).width, COLUMN);
        assert_eq!(Grid::new(2, 100.0).width, PAGE);
    }

    #[test]
    fn the_scale_follows_the_values() {
        assert!(value_axis(&[0.01, 0.2]).log);
        for linear in [&[0.01, 0.1][..], &[0.0, 5.0], &[-1.0, 100.0], &[3.0], &[0.0], &[0.013391, 0.013392]] {
            let axis = value_axis(linear);
            assert!(!axis.log && axis.ticks.len() >= 2, "{linear:?}");
            assert!(linear.iter().all(|v| axis.lo <= *v && *v <= axis.hi));
            let fits = |tick: &(f64, String)| width(&tick.1, SMALL, false) <= NUMBERS - 4.0;
            assert!(axis.ticks.iter().all(fits), "{:?}", axis.ticks);
        }
        assert!(value_axis(&[]).ticks.is_empty());
    }
}
