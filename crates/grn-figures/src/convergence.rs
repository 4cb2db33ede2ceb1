//! Convergence: how good the best model is after so many evaluations.

use crate::canvas::error::{FigureError, finite};
use crate::canvas::paint::{Paint, Rect};
use crate::canvas::style::{DATA, SERIES, SMALL};
use crate::canvas::svg::{Svg, poly};
use crate::chart::axes::{Axis, Chart, Line};
use crate::chart::legend::{Key, legend};
use crate::chart::panels::{Grid, value_axis};
use grn_optimisers::statistics::Quartiles;

const HEIGHT: f64 = 110.0;
/// Half of the widest number below the right end of an axis.
const LAST_NUMBER: f64 = 9.0;
/// A row of panels: title, chart, numbers and words below it.
const ROW: f64 = 14.0 + HEIGHT + 32.0;

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
    /// Evaluations of f2 spent, ascending, and the quartiles over the runs after them.
    pub points: Vec<(u64, Quartiles)>,
}

/// Draws the median over runs as a line and the range between the quartiles as a shaded band, over the
/// evaluations of f2. A panel's axis of values is logarithmic if they are above 0 and span more than a
/// factor of ten. One panel is a column wide, several share the page's width.
///
/// # Errors
/// No panel, no series in a panel or no point in a series; a quartile that is not finite, evaluations that
/// do not ascend, quartiles out of order; more than six labels, or more panels than a page holds.
pub fn convergence(figure: &ConvergenceFigure) -> Result<String, FigureError> {
    check(figure)?;
    let labels = labels(figure);
    let grid = Grid::new(figure.panels.len(), 120.0);
    let (found, limit) = (figure.panels.len(), grid.limit(ROW + 10.0));
    if found > limit {
        return Err(FigureError::TooMany { what: "panels", found, limit });
    }
    let mut svg = Svg::default();
    let key = |(i, label): (usize, _)| (Key::Line(Paint::stroke(SERIES[i].0, DATA).dashed(SERIES[i].1)), label);
    let keys: Vec<(Key, &str)> = labels.iter().copied().enumerate().map(key).collect();
    let (head, _) = legend(&mut svg, 45.0, 10.0, grid.width - 4.0, SMALL, &keys);
    for (i, panel) in figure.panels.iter().enumerate() {
        let top = head + 4.0 + ROW * grid.row(i) as f64;
        let room = grid.rect(i, top + 14.0, HEIGHT);
        let rect = Rect { w: room.w - LAST_NUMBER, ..room };
        grid.words(&mut svg, i, &rect, (&panel.title, top + 10.0), &figure.y_label);
        let (unit, x_label) = unit(panel);
        let chart = Chart { rect, x: time_axis(panel, unit), y: values(panel), x_label, y_label: "", x_numbers: true };
        let look = |series: &ConvergenceSeries| labels.iter().position(|label| *label == series.label).unwrap_or(0);
        for series in &panel.series {
            svg.open("band", &series.label);
            band(&mut svg, &chart, series, unit, SERIES[look(series)].0);
            svg.close();
        }
        let mut lines = Vec::new();
        for series in &panel.series {
            let (colour, dash) = SERIES[look(series)];
            let line = |pick: fn(&Quartiles) -> f64, width| {
                let point = |(n, q): &(u64, Quartiles)| (*n as f64 / unit, chart.y.at(pick(q)));
                Line { points: series.points.iter().map(point).collect(), colour, width, dash }
            };
            lines.extend([line(|q| q.lower, 0.3), line(|q| q.upper, 0.3), line(|q| q.median, DATA)]);
        }
        chart.draw(&mut svg, &lines)?;
    }
    Ok(svg.finish(grid.width, head + 4.0 + ROW * (grid.row(found - 1) + 1) as f64))
}

fn check(figure: &ConvergenceFigure) -> Result<(), FigureError> {
    let all = || figure.panels.iter().flat_map(|panel| &panel.series);
    if figure.panels.is_empty() {
        return Err(FigureError::Empty { what: "panels" });
    }
    if figure.panels.iter().any(|panel| panel.series.is_empty()) {
        return Err(FigureError::Empty { what: "series in a panel" });
    }
    for series in all() {
        let points = &series.points;
        if points.is_empty() {
            return Err(FigureError::Empty { what: "points in a series" });
        }
        for (index, (_, q)) in points.iter().enumerate() {
            let what = "quartile of point";
            finite(what, [q.lower, q.median, q.upper]).map_err(|e| e.within(what, index))?;
        }
        if let Some(before) = points.windows(2).position(|pair| pair[1].0 <= pair[0].0) {
            let expected = "after the one before";
            return Err(FigureError::OutOfRange { what: "evaluations of point", index: before + 1, expected });
        }
        let in_order = |q: &Quartiles| q.lower <= q.median && q.median <= q.upper;
        if let Some(index) = points.iter().position(|point| !in_order(&point.1)) {
            let expected = "in order";
            return Err(FigureError::OutOfRange { what: "quartiles of point", index, expected });
        }
    }
    let (found, limit) = (labels(figure).len(), SERIES.len());
    if found > limit { Err(FigureError::TooMany { what: "labels", found, limit }) } else { Ok(()) }
}

/// The labels of all panels, each once, in the order of their first appearance.
fn labels(figure: &ConvergenceFigure) -> Vec<&str> {
    let mut labels = Vec::new();
    for series in figure.panels.iter().flat_map(|panel| &panel.series) {
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
mod tests {
    use super::*;
    use crate::chart::check::read;

    fn quartiles(median: f64) -> Quartiles {
        Quartiles { lower: median * 0.5, median, upper: median * 2.0 }
    }

    fn figure(panels: usize, labels: &[&str]) -> ConvergenceFigure {
        let points: Vec<(u64, Quartiles)> = (1..=20).map(|i| (i * 1000, quartiles(1.0 / i as f64))).collect();
        let series = |label: &&str| ConvergenceSeries { label: (*label).to_owned(), points: points.clone() };
        let panel = |i| ConvergencePanel { title: format!("World {i}"), series: labels.iter().map(series).collect() };
        ConvergenceFigure { panels: (0..panels).map(panel).collect(), y_label: "f2 <best>".into() }
    }

    #[test]
    fn each_series_is_a_line_and_a_band_named_once() {
        let figure = figure(4, &["MOGP, all motifs", "a & b"]);
        let svg = convergence(&figure).unwrap();
        assert_eq!(svg, convergence(&figure).unwrap());
        let document = read(&svg);
        assert_eq!(document.count("fill-opacity"), 8);
        let words = |words: &str| document.texts.iter().filter(|text| *text == words).count();
        assert_eq!(words("a & b"), 1 + 4, "the legend, and the title of each band");
        assert_eq!(words("f2 <best>"), 2, "beside each row");
        assert_eq!(words("Evaluations of f2 (thousands)"), 4);
        assert_eq!(words("World 3"), 1);
    }

    #[test]
    fn one_point_and_zero_values_can_be_drawn() {
        let points = vec![(0, quartiles(0.0))];
        let series = vec![ConvergenceSeries { label: "a".into(), points }];
        let panels = vec![ConvergencePanel { title: String::new(), series }];
        read(&convergence(&ConvergenceFigure { panels, y_label: String::new() }).unwrap());
    }

    #[test]
    fn bad_data_is_named() {
        let change = |edit: fn(&mut ConvergenceFigure)| {
            let mut figure = figure(1, &["a", "b"]);
            edit(&mut figure);
            convergence(&figure)
        };
        assert_eq!(change(|f| f.panels.clear()), Err(FigureError::Empty { what: "panels" }));
        let series = change(|f| f.panels[0].series.clear());
        assert_eq!(series, Err(FigureError::Empty { what: "series in a panel" }));
        let points = change(|f| f.panels[0].series[1].points.clear());
        assert_eq!(points, Err(FigureError::Empty { what: "points in a series" }));
        let nan = change(|f| f.panels[0].series[1].points[3].1.median = f64::NAN);
        assert_eq!(nan, Err(FigureError::NotFinite { what: "quartile of point", index: 3 }));
        let order = change(|f| f.panels[0].series[1].points[3].1.lower = 9.0);
        assert!(matches!(order, Err(FigureError::OutOfRange { what: "quartiles of point", index: 3, .. })));
        let back = change(|f| f.panels[0].series[0].points[5].0 = 5000);
        assert!(matches!(back, Err(FigureError::OutOfRange { what: "evaluations of point", index: 5, .. })));
        let labels = convergence(&figure(1, &["1", "2", "3", "4", "5", "6", "7"]));
        assert_eq!(labels, Err(FigureError::TooMany { what: "labels", found: 7, limit: 6 }));
        assert!(matches!(convergence(&figure(40, &["a"])), Err(FigureError::TooMany { what: "panels", .. })));
    }
}
