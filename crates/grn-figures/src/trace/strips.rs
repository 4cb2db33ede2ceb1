//! The time series below the map of a run.

use crate::canvas::error::FigureError;
use crate::canvas::paint::{Anchor, Font, Paint, Rect};
use crate::canvas::style::{GREY, INK, LIGHT, SERIES, SMALL, THIN, time_colour};
use crate::canvas::svg::{Svg, poly};
use crate::canvas::text::width;
use crate::chart::axes::{Axis, Chart, Line};
use crate::trace::data::TraceFigure;
use crate::trace::map::share;

/// The widest gap a ring without holes may show, degrees.
const GAP_LIMIT: f64 = 90.0;

/// Draws the gaps in `rect` and the error below it; returns where the lower one ends.
pub(crate) fn strips(svg: &mut Svg, figure: &TraceFigure, rect: Rect) -> Result<f64, FigureError> {
    let first = gap_chart(figure, rect);
    let second = error_chart(figure, Rect { y: rect.bottom() + 11.0, ..rect });
    let series = |chart: &Chart, values: &[f64], (colour, dash): (&'static str, &'static [f64])| {
        let point = |(t, v): (&f64, &f64)| (*t, v.clamp(chart.y.lo, chart.y.hi));
        let points = figure.times.iter().zip(values).map(point).collect();
        Line { points, colour, width: 1.0, dash }
    };
    let level = |chart: &Chart, value: f64| {
        let points = vec![(chart.x.lo, value), (chart.x.hi, value)];
        Line { points, colour: GREY, width: THIN, dash: &[3.0, 2.0] }
    };
    let mut lines = vec![level(&first, GAP_LIMIT)];
    for (i, values) in figure.gaps.iter().enumerate() {
        lines.push(series(&first, values, SERIES[i % SERIES.len()]));
    }
    moments(svg, figure, &first);
    first.draw(svg, &lines)?;
    moments(svg, figure, &second);
    let error = series(&second, &figure.radial_error, (INK, &[]));
    second.draw(svg, &[level(&second, figure.radial_band), error])?;
    note(svg, &first, GAP_LIMIT, "90°");
    note(svg, &second, figure.radial_band, "10 % of the radius");
    Ok(second.rect.bottom())
}

fn time_axis(figure: &TraceFigure) -> Axis {
    let first = figure.times.first().copied().unwrap_or(0.0);
    Axis::linear(first, figure.times.last().copied().unwrap_or(1.0), 10.0)
}

fn gap_chart(figure: &TraceFigure, rect: Rect) -> Chart {
    let most = figure.gaps.iter().flatten().copied().fold(0.0, f64::max);
    let top = [120.0, 180.0, 270.0, 360.0].into_iter().find(|t| most <= *t).unwrap_or(360.0);
    let step = if top > 200.0 { 90.0 } else { 30.0_f64.max(top / 4.0) };
    let y = Axis::stepped(0.0, top, step);
    Chart { rect, x: time_axis(figure), y, x_label: "", y_label: "Largest gap (°)", x_numbers: false }
}

fn error_chart(figure: &TraceFigure, rect: Rect) -> Chart {
    let most = figure.radial_error.iter().copied().fold(figure.radial_band * 1.3, f64::max);
    let y = Axis::linear(0.0, if most > 0.0 { most * 1.05 } else { 1.0 }, 3.0);
    Chart { rect, x: time_axis(figure), y, x_label: "Time (s)", y_label: "Radial error (m)", x_numbers: true }
}

/// Marks the moments that the map shows.
fn moments(svg: &mut Svg, figure: &TraceFigure, chart: &Chart) {
    for instant in &figure.instants {
        if instant.time < chart.x.lo || instant.time > chart.x.hi {
            continue;
        }
        let (x, y) = chart.place(instant.time, chart.y.hi);
        let colour = time_colour(share(figure, instant.time));
        svg.line((x, y), (x, chart.rect.bottom()), &Paint::stroke(LIGHT, 0.8));
        let head = [(x, y + 0.5), (x - 2.6, y - 4.0), (x + 2.6, y - 4.0)];
        svg.path(&poly(&head, true), &Paint::fill(&colour));
    }
}

/// Names a level at the right end of a chart.
fn note(svg: &mut Svg, chart: &Chart, value: f64, words: &str) {
    let (x, y) = chart.place(chart.x.hi, value);
    let w = width(words, SMALL, false);
    svg.rect(&Rect::new(x - w - 4.0, y - 9.4, w + 3.0, 8.4), 0.0, &Paint::fill("#FFFFFF"));
    svg.text(words, (x - 2.5, y - 2.6), &Font::new(SMALL, Anchor::End).colour(GREY));
}
