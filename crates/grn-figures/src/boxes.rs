//! Box plots: the runs of several methods side by side, a panel for each scenario.

use crate::canvas::error::{FigureError, finite};
use crate::canvas::note::nothing_to_draw;
use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::style::{BLUE, BLUE_TINT, DATA, GREY, INK, SMALL, THIN, VERMILLION};
use crate::canvas::svg::Svg;
use crate::canvas::text::{lines, width, wrap};
use crate::chart::axes::Chart;
use crate::chart::legend::{Key, legend};
use crate::chart::panels::{Grid, blank, value_axis};
use grn_optimisers::statistics::{Quartiles, quartiles};

/// Width of a group that holds `infeasible`, the longest word below or above every group.
const SLOT: f64 = 38.0;
const LINE: f64 = 8.6;
const HEIGHT: f64 = 120.0;
/// Most groups of a panel: the page's width holds no more, so further ones go into a panel of their own.
const GROUPS: usize = 12;
/// Fewer values than these have no quartiles worth a box.
const BOX: usize = 5;
/// Longest line of a name that stands upright.
const UPRIGHT: f64 = 96.0;

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
/// beyond the whiskers. Fewer than five values have no box, only their points and median. Points are spread sideways
/// only to be seen. Infeasible runs are crosses above the panel, and counted. A panel's axis is logarithmic if its
/// values are above 0 and span more than a factor of ten; one panel is a column wide where its groups fit, several
/// share the page's width. A panel of more than 12 groups is split. The documents are the pages, at least one.
///
/// # Errors
/// A value that is not finite, or beyond 1e9.
pub fn boxes(figure: &BoxFigure) -> Result<Vec<String>, FigureError> {
    for group in figure.panels.iter().flat_map(|panel| &panel.groups) {
        // An infeasible run is given a good number, so that the index is the run's.
        finite("value of run", group.values.iter().map(|value| value.unwrap_or(0.0)))?;
    }
    let panels = parts(&figure.panels);
    if panels.is_empty() {
        return Ok(vec![nothing_to_draw("there is no run")]);
    }
    let groups = || panels.iter().flat_map(|panel| panel.groups);
    let most = panels.iter().map(|panel| panel.groups.len()).max().unwrap_or(1);
    let grid = Grid::new(panels.len(), SLOT * most as f64);
    let labels = Labels::fit(groups().map(|group| group.label.as_str()), grid.plot() / most as f64);
    let keys = keys(groups());
    let head = if keys.is_empty() { 0.0 } else { 16.0 };
    let title = grid.title_height(panels.iter().map(|panel| panel.title.as_str())) + 2.0;
    let strip = if groups().any(|group| group.infeasible() > 0) { 2.0 * LINE + 10.0 } else { 3.0 };
    let row = title + strip + HEIGHT + labels.height + 8.0;
    let page = |panels: &[Part<'_>]| -> Result<String, FigureError> {
        let mut svg = Svg::default();
        legend(&mut svg, 45.0, 10.0, grid.width - 4.0, SMALL, &keys);
        for (i, panel) in panels.iter().enumerate() {
            let top = head + row * grid.row(i) as f64;
            let rect = grid.rect(i, top + title + strip, HEIGHT);
            grid.words(&mut svg, i, &rect, (&panel.title, top), &figure.y_label);
            draw_panel(&mut svg, panel, rect, &labels)?;
        }
        Ok(svg.finish(grid.width, head + row * (grid.row(panels.len() - 1) + 1) as f64))
    };
    panels.chunks(grid.limit(head, row)).map(page).collect()
}

/// A panel, or as many of its groups as one panel holds.
struct Part<'a> {
    title: String,
    groups: &'a [BoxGroup],
}

fn parts(panels: &[BoxPanel]) -> Vec<Part<'_>> {
    let mut out = Vec::new();
    for panel in panels {
        let count = panel.groups.len().div_ceil(GROUPS).max(1);
        // Parts of about the same size.
        let size = panel.groups.len().div_ceil(count).max(1);
        for (part, groups) in panel.groups.chunks(size).enumerate() {
            let title = match count {
                1 => panel.title.clone(),
                _ => format!("{} ({} of {count})", panel.title, part + 1),
            };
            out.push(Part { title, groups });
        }
    }
    out
}

fn draw_panel(svg: &mut Svg, panel: &Part<'_>, rect: Rect, labels: &Labels) -> Result<(), FigureError> {
    let values: Vec<f64> = panel.groups.iter().flat_map(BoxGroup::feasible).collect();
    let (x, y) = (blank(panel.groups.len() as f64), value_axis(&values));
    let chart = Chart { rect, x, y, x_label: "", y_label: "", x_numbers: false };
    chart.draw(svg, &[])?;
    for (place, group) in panel.groups.iter().enumerate() {
        let slot = Slot { chart: &chart, middle: place as f64 + 0.5 };
        svg.open("group", &group.label);
        let values = group.feasible();
        if let Some(quartiles) = quartiles(&values) {
            slot.draw_values(svg, &values, quartiles);
        }
        if group.values.is_empty() {
            let at = (slot.x(), rect.bottom() - 4.0);
            svg.text("no run", at, &Font::new(SMALL, Anchor::Middle).colour(GREY));
        }
        slot.draw_infeasible(svg, group);
        labels.draw(svg, &group.label, slot.x(), rect.bottom());
        svg.close();
    }
    Ok(())
}

fn run_look() -> (Mark, f64, Paint) {
    (Mark::Circle, 1.1, Paint::stroke("#FFFFFF", 0.3).filled(BLUE))
}

fn outlier_look() -> (Mark, f64, Paint) {
    (Mark::Diamond, 1.6, Paint::stroke(VERMILLION, 0.7).filled("#FFFFFF"))
}

fn infeasible_look() -> (Mark, f64, Paint) {
    (Mark::Cross, 1.6, Paint::stroke(VERMILLION, 0.7))
}

/// What the marks mean that are in the figure.
fn keys<'a>(groups: impl Iterator<Item = &'a BoxGroup> + Clone) -> Vec<(Key, &'static str)> {
    let has = |what: &dyn Fn(&BoxGroup) -> bool| groups.clone().any(what);
    let mut keys = Vec::new();
    let mut add = |present: bool, (mark, r, paint): (Mark, f64, Paint), words| {
        if present {
            keys.push((Key::Mark(mark, r, paint), words));
        }
    };
    add(has(&|group| !group.feasible().is_empty()), run_look(), "run");
    add(has(&|group| has_outlier(&group.feasible())), outlier_look(), "outlier (beyond 1.5 box heights)");
    add(has(&|group| group.infeasible() > 0), infeasible_look(), "infeasible run");
    keys
}

fn has_outlier(values: &[f64]) -> bool {
    quartiles(values).is_some_and(|q| values.iter().any(|&value| is_outlier(value, values.len(), &q)))
}

/// Whether a value lies beyond the whiskers.
fn is_outlier(value: f64, count: usize, q: &Quartiles) -> bool {
    let reach = 1.5 * (q.upper - q.lower);
    count >= BOX && !(q.lower - reach <= value && value <= q.upper + reach)
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

    /// Draws the points, and behind them the box or at least the median.
    fn draw_values(&self, svg: &mut Svg, values: &[f64], q: Quartiles) {
        let (x, half) = (self.x(), (self.width() * 0.3).min(12.0));
        let usual = |value: f64| !is_outlier(value, values.len(), &q);
        if values.len() >= BOX {
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
        }
        if values.len() > 1 {
            let median = self.y(q.median);
            svg.line((x - half, median), (x + half, median), &Paint::stroke(INK, DATA * 1.5));
        }
        for (i, &value) in values.iter().enumerate() {
            let (mark, r, paint) = if usual(value) { run_look() } else { outlier_look() };
            svg.mark(mark, (x + half * 1.5 * spread(i), self.y(value)), r, &paint);
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
            let (mark, r, paint) = infeasible_look();
            svg.mark(mark, (at, base), r, &paint);
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
        let widest = |lines: &[String]| lines.iter().map(|line| width(line, SMALL, false)).fold(0.0, f64::max);
        let upright = labels.clone().any(|label| widest(&wrap(label, SMALL, room)) > room);
        let mut fitted = Self { room, upright, height: LINE };
        let lines = labels.map(|label| fitted.lines(label));
        fitted.height = match upright {
            true => lines.map(|lines| widest(&lines)).fold(0.0, f64::max) + 3.0,
            false => LINE * lines.map(|lines| lines.len()).max().unwrap_or(1) as f64,
        };
        fitted
    }

    /// A name in lines; what is too long is cut, and whole in the group's title.
    fn lines(&self, label: &str) -> Vec<String> {
        match self.upright {
            true => lines(label, SMALL, UPRIGHT, ((self.room / LINE) as usize).max(1)),
            false => lines(label, SMALL, self.room, 4),
        }
    }

    fn draw(&self, svg: &mut Svg, label: &str, x: f64, below: f64) {
        let lines = self.lines(label);
        for (i, line) in lines.iter().enumerate() {
            if self.upright {
                let across = x + SMALL * 0.35 + LINE * (i as f64 - (lines.len() as f64 - 1.0) / 2.0);
                svg.turned_text(line, (across, below + 4.0), -90.0, &Font::new(SMALL, Anchor::End));
            } else {
                svg.text(line, (x, below + 9.0 + LINE * i as f64), &Font::new(SMALL, Anchor::Middle));
            }
        }
    }
}

#[cfg(test)]
mod tests;
