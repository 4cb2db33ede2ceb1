//! Convergence: how good a run's models are, over the evaluations spent.

use crate::canvas::error::{FigureError, finite};
use crate::canvas::note::nothing_to_draw;
use crate::canvas::paint::{Mark, Paint, Rect};
use crate::canvas::style::{DATA, SMALL, series};
use crate::canvas::svg::{Svg, poly};
use crate::canvas::text::lines;
use crate::chart::axes::{Axis, Chart, Line};
use crate::chart::legend::{Key, legend};
use crate::chart::panels::{Grid, value_axis};
use grn_optimisers::statistics::Quartiles;

const HEIGHT: f64 = 110.0;
/// Half of the widest number below the right end of an axis.
const LAST_NUMBER: f64 = 9.0;
/// Room below a chart for its numbers and words.
const BELOW: f64 = 32.0;
/// How far lone points of a panel stand apart.
const LONE: f64 = 6.0;
const LONE_RADIUS: f64 = 2.2;

/// What [`convergence`] shows.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvergenceFigure {
    /// The panels, row by row.
    pub panels: Vec<ConvergencePanel>,
    /// What the values are, with their unit.
    pub y_label: String,
}

/// Series that share their axes.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvergencePanel {
    /// What is common to the series, such as the scenario.
    pub title: String,
    /// The series; the same label looks the same in every panel.
    pub series: Vec<ConvergenceSeries>,
}

/// The runs of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvergenceSeries {
    /// What they are runs of.
    pub label: String,
    /// Evaluations of f2 spent, in order, and the quartiles over the runs after them.
    pub points: Vec<(u64, Quartiles)>,
}

/// Draws the median over runs as a line and the range between the quartiles as a shaded band, over the
/// evaluations of f2; a series of one point is a mark with a bar between the quartiles. A panel's axis of values is
/// logarithmic if they are above 0 and span more than a factor of ten. One panel is a column wide, several share the
/// page's width. The documents are the pages, at least one.
///
/// # Errors
/// A quartile that is not finite, evaluations that do not ascend, quartiles out of order.
pub fn convergence(figure: &ConvergenceFigure) -> Result<Vec<String>, FigureError> {
    figure.panels.iter().flat_map(|panel| &panel.series).try_for_each(check)?;
    let drawn = |panel: &&ConvergencePanel| panel.series.iter().any(|series| !series.points.is_empty());
    let panels: Vec<&ConvergencePanel> = figure.panels.iter().filter(drawn).collect();
    if panels.is_empty() {
        return Ok(vec![nothing_to_draw("no generation was finished")]);
    }
    let labels = labels(&panels);
    let grid = Grid::new(panels.len(), 120.0);
    let right = grid.width - 4.0;
    let words: Vec<String> = labels.iter().map(|label| lines(label, SMALL, right - 45.0 - 20.0, 1).concat()).collect();
    let look = |i: usize| Paint::stroke(series(i).0, DATA).dashed(series(i).1);
    let is_lone = |label: &str| {
        let mut all = panels.iter().flat_map(|panel| &panel.series).filter(|one| one.label == label);
        all.all(|one| one.points.len() <= 1)
    };
    let key = |i: usize| match is_lone(labels[i]) {
        true => Key::Mark(lone_mark(i).0, LONE_RADIUS, lone_mark(i).1),
        false => Key::Line(look(i)),
    };
    let keys: Vec<(Key, &str)> = words.iter().enumerate().map(|(i, words)| (key(i), words.as_str())).collect();
    let title = grid.title_height(panels.iter().map(|panel| panel.title.as_str())) + 4.0;
    let row = title + HEIGHT + BELOW;
    let page = |panels: &[&ConvergencePanel]| -> Result<String, FigureError> {
        let mut svg = Svg::default();
        let head = legend(&mut svg, 45.0, 10.0, right, SMALL, &keys).0 + 4.0;
        for (i, panel) in panels.iter().enumerate() {
            let top = head + row * grid.row(i) as f64;
            let room = grid.rect(i, top + title, HEIGHT);
            let rect = Rect { w: room.w - LAST_NUMBER, ..room };
            grid.words(&mut svg, i, &rect, (&panel.title, top), &figure.y_label);
            draw_panel(&mut svg, panel, rect, &labels)?;
        }
        Ok(svg.finish(grid.width, head + row * (grid.row(panels.len() - 1) + 1) as f64))
    };
    let head = legend(&mut Svg::default(), 45.0, 10.0, right, SMALL, &keys).0 + 4.0;
    panels.chunks(grid.limit(head, row)).map(page).collect()
}

fn draw_panel(svg: &mut Svg, panel: &ConvergencePanel, rect: Rect, labels: &[&str]) -> Result<(), FigureError> {
    let (unit, x_label) = unit(panel);
    let chart = Chart { rect, x: time_axis(panel, unit), y: values(panel), x_label, y_label: "", x_numbers: true };
    let look = |one: &ConvergenceSeries| labels.iter().position(|label| *label == one.label).unwrap_or(0);
    for one in &panel.series {
        svg.open("band", &one.label);
        band(svg, &chart, one, unit, series(look(one)).0);
        svg.close();
    }
    let mut lines = Vec::new();
    for one in panel.series.iter().filter(|one| one.points.len() > 1) {
        let (colour, dash) = series(look(one));
        let line = |pick: fn(&Quartiles) -> f64, width| {
            let point = |(n, q): &(u64, Quartiles)| (*n as f64 / unit, chart.y.at(pick(q)));
            Line { points: one.points.iter().map(point).collect(), colour, width, dash }
        };
        lines.extend([line(|q| q.lower, 0.3), line(|q| q.upper, 0.3), line(|q| q.median, DATA)]);
    }
    chart.draw(svg, &lines)?;
    let lone: Vec<&ConvergenceSeries> = panel.series.iter().filter(|one| one.points.len() == 1).collect();
    for (place, one) in lone.iter().enumerate() {
        let aside = LONE * (place as f64 - (lone.len() as f64 - 1.0) / 2.0);
        lone_point(svg, &chart, one, unit, (look(one), aside));
    }
    Ok(())
}

/// Draws a series of one point: a mark at the median, a bar between the quartiles, both moved a little aside so that
/// several series are seen.
fn lone_point(svg: &mut Svg, chart: &Chart, one: &ConvergenceSeries, unit: f64, (look, aside): (usize, f64)) {
    let Some((evaluations, q)) = one.points.first() else { return };
    let at = |value: f64| {
        let (x, y) = chart.place(*evaluations as f64 / unit, value);
        (x + aside, y)
    };
    let colour = series(look).0;
    svg.open("point", &one.label);
    svg.line(at(q.lower), at(q.upper), &Paint::stroke(colour, DATA));
    let (mark, paint) = lone_mark(look);
    svg.mark(mark, at(q.median), LONE_RADIUS, &paint);
    svg.close();
}

/// The mark of a series of one point, by the series' place.
fn lone_mark(place: usize) -> (Mark, Paint) {
    const MARKS: [Mark; 4] = [Mark::Circle, Mark::Square, Mark::Diamond, Mark::Triangle];
    (MARKS[place % MARKS.len()], Paint::stroke("#FFFFFF", 0.4).filled(series(place).0))
}

fn check(series: &ConvergenceSeries) -> Result<(), FigureError> {
    let points = &series.points;
    for (index, (_, q)) in points.iter().enumerate() {
        let what = "quartile of point";
        finite(what, [q.lower, q.median, q.upper]).map_err(|e| e.within(what, index))?;
    }
    if let Some(before) = points.windows(2).position(|pair| pair[1].0 < pair[0].0) {
        let expected = "not before the one before it";
        return Err(FigureError::OutOfRange { what: "evaluations of point", index: before + 1, expected });
    }
    let in_order = |q: &Quartiles| q.lower <= q.median && q.median <= q.upper;
    match points.iter().position(|point| !in_order(&point.1)) {
        Some(index) => Err(FigureError::OutOfRange { what: "quartiles of point", index, expected: "in order" }),
        None => Ok(()),
    }
}

/// The labels of all panels, each once, in the order of their first appearance.
fn labels<'a>(panels: &[&'a ConvergencePanel]) -> Vec<&'a str> {
    let mut labels: Vec<&str> = Vec::new();
    for series in panels.iter().flat_map(|panel| &panel.series) {
        if !labels.contains(&series.label.as_str()) {
            labels.push(&series.label);
        }
    }
    labels
}

/// The first and the last number of evaluations in a panel.
fn range(panel: &ConvergencePanel) -> (u64, u64) {
    let all = || panel.series.iter().flat_map(|series| &series.points).map(|point| point.0);
    (all().min().unwrap_or(0), all().max().unwrap_or(1))
}

/// In what evaluations are counted so that their numbers stay short, and how that is said.
fn unit(panel: &ConvergencePanel) -> (f64, &'static str) {
    match range(panel).1 {
        2_000_000.. => (1e6, "Evaluations of f₂ (millions)"),
        10_000.. => (1e3, "Evaluations of f₂ (thousands)"),
        _ => (1.0, "Evaluations of f₂"),
    }
}

/// From 0, unless the first point lies far from it.
fn time_axis(panel: &ConvergencePanel, unit: f64) -> Axis {
    let (first, last) = range(panel);
    if first == last {
        return Axis::linear(0.0, 1.2 * last.max(1) as f64 / unit, 4.0);
    }
    let start = if first > last / 2 { first } else { 0 };
    Axis::linear(start as f64 / unit, last.max(start + 1) as f64 / unit, 4.0)
}

fn values(panel: &ConvergencePanel) -> Axis {
    let points = panel.series.iter().flat_map(|series| &series.points);
    let values: Vec<f64> = points.flat_map(|(_, q)| [q.lower, q.upper]).collect();
    value_axis(&values)
}

/// Shades the range between the quartiles; where bands cross, both are seen.
fn band(svg: &mut Svg, chart: &Chart, series: &ConvergenceSeries, unit: f64, colour: &str) {
    let place = |evaluations: u64, value: f64| chart.place(evaluations as f64 / unit, value);
    let upper = series.points.iter().map(|(n, q)| place(*n, q.upper));
    let lower = series.points.iter().rev().map(|(n, q)| place(*n, q.lower));
    let outline: Vec<(f64, f64)> = upper.chain(lower).collect();
    let area = format!("<path d=\"{}\" fill=\"{colour}\" fill-opacity=\"0.18\"/>\n", poly(&outline, true));
    svg.embed(&area, 0.0, 0.0, 1.0);
}

#[cfg(test)]
mod tests;
