//! Box plots: the runs of several methods side by side, a panel for each scenario.

use crate::canvas::error::{FigureError, finite};
use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::style::{BLUE, BLUE_TINT, DATA, INK, SMALL, THIN, VERMILLION};
use crate::canvas::svg::Svg;
use crate::canvas::text::{width, wrap};
use crate::chart::axes::Chart;
use crate::chart::panels::{Grid, blank, value_axis};
use grn_optimisers::statistics::{Quartiles, quartiles};

/// Width of a group that holds `infeasible`, the longest word below or above every group.
const SLOT: f64 = 38.0;
const LINE: f64 = 8.6;
const HEIGHT: f64 = 120.0;
/// Most groups of a panel: the page's width holds no more.
const GROUPS: usize = 12;

/// What [`boxes`] shows.
#[derive(Debug, Clone, PartialEq)]
pub struct BoxFigure {
    /// The panels, row by row.
    pub panels: Vec<BoxPanel>,
    /// What the values are, with their unit.
    pub y_label: String,
}

/// Groups that share an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct BoxPanel {
    /// What is common to the groups, such as the scenario.
    pub title: String,
    /// The groups from left to right.
    pub groups: Vec<BoxGroup>,
}

/// The runs of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct BoxGroup {
    /// What they are runs of.
    pub label: String,
    /// A value for each run, `None` for an infeasible one.
    pub values: Vec<Option<f64>>,
}

impl BoxGroup {
    fn feasible(&self) -> Vec<f64> {
        self.values.iter().flatten().copied().collect()
    }

    fn infeasible(&self) -> usize {
        self.values.iter().filter(|value| value.is_none()).count()
    }

    /// How many runs are infeasible, in one line if `room` is wide enough, else in two.
    fn count(&self, room: f64) -> Vec<String> {
        let count = format!("{} of {}", self.infeasible(), self.values.len());
        let words = format!("{count} infeasible");
        if width(&words, SMALL, false) <= room { vec![words] } else { vec![count, "infeasible".into()] }
    }
}

/// Draws the values of runs as boxes from the lower to the upper quartile with a bar at the median, whiskers
/// to the last value within 1.5 times the box's height, and every run as a point: a circle, or a diamond
/// beyond the whiskers. Points are spread sideways only to be seen. Infeasible runs are crosses above the
/// panel, and counted. A panel's axis is logarithmic if its values are above 0 and span more than a factor
/// of ten; one panel is a column wide where its groups fit, several share the page's width.
///
/// # Errors
/// No panel, no group in a panel or no run in a group, a value that is not finite, more than 12 groups in a
/// panel, or more panels than a page holds.
pub fn boxes(figure: &BoxFigure) -> Result<String, FigureError> {
    check(figure)?;
    let groups = || figure.panels.iter().flat_map(|panel| &panel.groups);
    let most = figure.panels.iter().map(|panel| panel.groups.len()).max().unwrap_or(1);
    let grid = Grid::new(figure.panels.len(), SLOT * most as f64);
    let labels = Labels::fit(groups().map(|group| group.label.as_str()), grid.plot() / most as f64);
    let strip = if groups().any(|group| group.infeasible() > 0) { 2.0 * LINE + 10.0 } else { 3.0 };
    let row = 12.0 + strip + HEIGHT + labels.height + 8.0;
    let (found, limit) = (figure.panels.len(), grid.limit(row));
    if found > limit {
        return Err(FigureError::TooMany { what: "panels", found, limit });
    }
    let mut svg = Svg::default();
    for (i, panel) in figure.panels.iter().enumerate() {
        let top = row * grid.row(i) as f64;
        let rect = grid.rect(i, top + 12.0 + strip, HEIGHT);
        grid.words(&mut svg, i, &rect, (&panel.title, top + 10.0), &figure.y_label);
        let values: Vec<f64> = panel.groups.iter().flat_map(BoxGroup::feasible).collect();
        let (x, y) = (blank(panel.groups.len() as f64), value_axis(&values));
        let chart = Chart { rect, x, y, x_label: "", y_label: "", x_numbers: false };
        chart.draw(&mut svg, &[])?;
        for (place, group) in panel.groups.iter().enumerate() {
            let slot = Slot { chart: &chart, middle: place as f64 + 0.5 };
            svg.open("group", &group.label);
            if let Some(quartiles) = quartiles(&group.feasible()) {
                slot.draw_box(&mut svg, &group.feasible(), quartiles);
            }
            slot.draw_infeasible(&mut svg, group);
            labels.draw(&mut svg, &group.label, slot.x(), rect.bottom());
            svg.close();
        }
    }
    Ok(svg.finish(grid.width, row * (grid.row(found - 1) + 1) as f64))
}

fn check(figure: &BoxFigure) -> Result<(), FigureError> {
    if figure.panels.is_empty() {
        return Err(FigureError::Empty { what: "panels" });
    }
    for panel in &figure.panels {
        if panel.groups.is_empty() {
            return Err(FigureError::Empty { what: "groups in a panel" });
        }
        if panel.groups.len() > GROUPS {
            return Err(FigureError::TooMany { what: "groups", found: panel.groups.len(), limit: GROUPS });
        }
        for group in &panel.groups {
            if group.values.is_empty() {
                return Err(FigureError::Empty { what: "runs in a group" });
            }
            // An infeasible run is given a good number, so that the index is the run's.
            finite("value of run", group.values.iter().map(|value| value.unwrap_or(0.0)))?;
        }
    }
    Ok(())
}

/// A group's share of the panel's width.
struct Slot<'a> {
    chart: &'a Chart,
    middle: f64,
}

impl Slot<'_> {
    fn x(&self) -> f64 {
        self.chart.place(self.middle, 0.0).0
    }

    fn y(&self, value: f64) -> f64 {
        self.chart.place(self.middle, value).1
    }

    fn width(&self) -> f64 {
        self.chart.rect.w / self.chart.x.hi
    }

    fn draw_box(&self, svg: &mut Svg, values: &[f64], q: Quartiles) {
        let (x, half) = (self.x(), (self.width() * 0.3).min(12.0));
        let reach = 1.5 * (q.upper - q.lower);
        let usual = |v: f64| q.lower - reach <= v && v <= q.upper + reach;
        let within = || values.iter().copied().filter(|v| usual(*v));
        let ends = [(q.lower, within().fold(q.lower, f64::min)), (q.upper, within().fold(q.upper, f64::max))];
        let ink = Paint::stroke(INK, THIN);
        for (from, to) in ends {
            let (from, to) = (self.y(from), self.y(to));
            svg.line((x, from), (x, to), &ink);
            svg.line((x - half / 2.0, to), (x + half / 2.0, to), &ink);
        }
        let (top, bottom) = (self.y(q.upper), self.y(q.lower));
        svg.rect(&Rect::new(x - half, top, 2.0 * half, bottom - top), 0.0, &ink.clone().filled(BLUE_TINT));
        let median = self.y(q.median);
        svg.line((x - half, median), (x + half, median), &Paint::stroke(INK, DATA * 1.5));
        for (i, &value) in values.iter().enumerate() {
            let at = (x + half * 1.5 * spread(i), self.y(value));
            match usual(value) {
                true => svg.mark(Mark::Circle, at, 1.1, &Paint::stroke("#FFFFFF", 0.3).filled(BLUE)),
                false => svg.mark(Mark::Diamond, at, 1.6, &Paint::stroke(VERMILLION, 0.7).filled("#FFFFFF")),
            }
        }
    }

    fn draw_infeasible(&self, svg: &mut Svg, group: &BoxGroup) {
        let count = group.infeasible();
        if count == 0 {
            return;
        }
        let (x, base) = (self.x(), self.chart.rect.y - 5.0);
        let apart = (self.width() * 0.7 / count as f64).min(4.5);
        for i in 0..count {
            let at = x + apart * (i as f64 - (count - 1) as f64 / 2.0);
            svg.mark(Mark::Cross, (at, base), 1.6, &Paint::stroke(VERMILLION, 0.7));
        }
        let lines = group.count(self.width() - 4.0);
        for (i, line) in lines.iter().rev().enumerate() {
            svg.text(line, (x, base - 4.5 - LINE * i as f64), &Font::new(SMALL, Anchor::Middle));
        }
    }
}

/// A share from -0.5 to 0.5, even over any stretch of indices: multiples of the golden ratio.
fn spread(index: usize) -> f64 {
    libm::fmod(0.5 + 0.618_033_988_749_895 * index as f64, 1.0) - 0.5
}

/// How the names of groups are set below a panel: in lines, or upright where a word is too wide.
struct Labels {
    room: f64,
    upright: bool,
    height: f64,
}

impl Labels {
    fn fit<'a>(labels: impl Iterator<Item = &'a str> + Clone, slot: f64) -> Self {
        let room = slot - 4.0;
        let widest = |lines: Vec<String>| lines.iter().map(|line| width(line, SMALL, false)).fold(0.0, f64::max);
        let upright = labels.clone().any(|label| widest(wrap(label, SMALL, room)) > room);
        let height = match upright {
            true => labels.map(|label| width(label, SMALL, false)).fold(0.0, f64::max) + 3.0,
            false => LINE * labels.map(|label| wrap(label, SMALL, room).len()).max().unwrap_or(1) as f64,
        };
        Self { room, upright, height }
    }

    fn draw(&self, svg: &mut Svg, label: &str, x: f64, below: f64) {
        if self.upright {
            let font = Font::new(SMALL, Anchor::End);
            return svg.turned_text(label, (x + SMALL * 0.35, below + 4.0), -90.0, &font);
        }
        for (i, line) in wrap(label, SMALL, self.room).iter().enumerate() {
            svg.text(line, (x, below + 9.0 + LINE * i as f64), &Font::new(SMALL, Anchor::Middle));
        }
    }
}

#[cfg(test)]
mod tests;
