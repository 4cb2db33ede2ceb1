//! A front in any objectives: one chart for each pair of them.

use crate::canvas::error::{FigureError, finite};
use crate::canvas::note::nothing_to_draw;
use crate::canvas::paint::{Mark, Paint, Rect};
use crate::canvas::style::SMALL;
use crate::canvas::svg::Svg;
use crate::chart::axes::Chart;
use crate::chart::legend::{Key, legend};
use crate::chart::panels::{Grid, value_axis};
use crate::pareto::data::{front_look, knee_look, other_look};
use grn_optimisers::knee::Knee;

const HEIGHT: f64 = 120.0;
/// Room below a chart for its numbers and words.
const BELOW: f64 = 34.0;
/// Room right of an axis for half of its last number.
const LAST_NUMBER: f64 = 9.0;

/// What [`objectives`] shows.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectivesFigure {
    /// What each objective measures, with its unit; less is better.
    pub labels: Vec<&'static str>,
    /// The models.
    pub points: Vec<ObjectivesPoint>,
}

/// A model by its objectives.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectivesPoint {
    /// The value of each objective.
    pub values: Vec<f64>,
    /// Whether no other dominates it in all objectives together.
    pub non_dominated: bool,
    /// Whether every target is enclosed and every obstacle cleared.
    pub feasible: bool,
    /// By which measures it is a knee of the front.
    pub knee: Knee,
    /// Its expression, shown on pointing at it.
    pub label: String,
}

/// Draws a front in two or three objectives, one chart for each pair: a model that looks dominated in one chart may be
/// the best in the objective that the chart does not show. The first objective of a pair lies along x.
///
/// # Errors
/// Values that are not finite, or not one for each objective.
pub fn objectives(figure: &ObjectivesFigure) -> Result<String, FigureError> {
    let expected = figure.labels.len();
    for point in &figure.points {
        if point.values.len() != expected {
            return Err(FigureError::Length { what: "values of a model", found: point.values.len(), expected });
        }
        finite("objective of model", point.values.iter().copied())?;
    }
    if figure.points.is_empty() {
        return Ok(nothing_to_draw("there is no model"));
    }
    let pairs: Vec<(usize, usize)> = (0..expected).flat_map(|x| (x + 1..expected).map(move |y| (x, y))).collect();
    let grid = Grid::new(pairs.len(), 100.0);
    let mut svg = Svg::default();
    let head = legend(&mut svg, 45.0, 10.0, grid.width - 4.0, SMALL, &entries(&figure.points)).0 + 8.0;
    let row = HEIGHT + BELOW;
    for (panel, &(x, y)) in pairs.iter().enumerate() {
        let rect = grid.rect(panel, head + row * grid.row(panel) as f64, HEIGHT);
        let axis = |objective: usize| {
            let values: Vec<f64> = figure.points.iter().map(|point| point.values[objective]).collect();
            value_axis(&values)
        };
        let chart = Chart {
            rect: Rect { w: rect.w - LAST_NUMBER, ..rect },
            x: axis(x),
            y: axis(y),
            x_label: figure.labels[x],
            y_label: figure.labels[y],
            x_numbers: true,
        };
        chart.draw(&mut svg, &[])?;
        let mut in_order: Vec<&ObjectivesPoint> = figure.points.iter().collect();
        // Dominated ones below, knees on top.
        in_order.sort_by_key(|point| (point.non_dominated, knee_look(point.knee).is_some()));
        for point in in_order {
            let (mark, r, paint) = look(point);
            svg.open(if point.non_dominated { "front" } else { "other" }, &point.label);
            svg.mark(mark, chart.place(point.values[x], point.values[y]), r, &paint);
            svg.close();
        }
    }
    Ok(svg.finish(grid.width, head + row * (grid.row(pairs.len() - 1) + 1) as f64))
}

fn look(point: &ObjectivesPoint) -> (Mark, f64, Paint) {
    if point.non_dominated && point.feasible { front_look(point.knee) } else { other_look(point.feasible) }
}

fn entries(points: &[ObjectivesPoint]) -> Vec<(Key, &'static str)> {
    let kinds = [
        ("non-dominated", true, true, Knee::default()),
        ("knee of the first two (angle)", true, true, Knee { angle: true, utility: false, parsimony: false }),
        ("knee of the first two (utility)", true, true, Knee { angle: false, utility: true, parsimony: false }),
        ("knee of the first two", true, true, Knee { angle: true, utility: true, parsimony: false }),
        ("knee (parsimony)", true, true, Knee { angle: false, utility: false, parsimony: true }),
        ("dominated", false, true, Knee::default()),
        ("infeasible", false, false, Knee::default()),
    ];
    let mut entries = Vec::new();
    for (words, non_dominated, feasible, knee) in kinds {
        let example = ObjectivesPoint { values: Vec::new(), non_dominated, feasible, knee, label: String::new() };
        let seen = points.iter().find(|point| look(point) == look(&example));
        entries.extend(seen.map(|point| {
            let (mark, r, paint) = look(point);
            (Key::Mark(mark, r, paint), words)
        }));
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::check::read;

    fn point(values: &[f64], non_dominated: bool) -> ObjectivesPoint {
        let knee = Knee::default();
        ObjectivesPoint { values: values.to_vec(), non_dominated, feasible: true, knee, label: "(NEG x1)".into() }
    }

    #[test]
    fn three_objectives_make_three_charts() {
        let points = vec![point(&[3.0, 0.2, 9.0], true), point(&[5.0, 0.1, 8.0], true), point(&[5.0, 0.3, 9.5], false)];
        let figure = ObjectivesFigure { labels: vec!["nodes", "f2", "length (m)"], points };
        let document = read(&objectives(&figure).unwrap());
        assert_eq!((document.count("class=\"front\""), document.count("class=\"other\"")), (6, 3));
        for words in ["nodes", "f2", "length (m)", "non-dominated", "dominated"] {
            assert!(document.says(words), "{words}");
        }
    }

    #[test]
    fn odd_but_legal_data_can_be_drawn_and_wrong_data_is_refused() {
        let labels = vec!["nodes", "f2"];
        let figure = |points| ObjectivesFigure { labels: labels.clone(), points };
        read(&objectives(&figure(vec![])).unwrap());
        read(&objectives(&figure(vec![point(&[0.0, 0.0], false)])).unwrap());
        read(&objectives(&figure(vec![point(&[-1.0, 1e9], true), point(&[1e-12, -1e9], true)])).unwrap());
        assert!(matches!(objectives(&figure(vec![point(&[1.0], true)])), Err(FigureError::Length { .. })));
        assert!(matches!(objectives(&figure(vec![point(&[1.0, f64::NAN], true)])), Err(FigureError::NotFinite { .. })));
    }
}
