//! The time series below the map of a run.

use crate::canvas::error::FigureError;
use crate::canvas::format::num;
use crate::canvas::paint::{Anchor, Font, Paint, Rect};
use crate::canvas::style::{GREY, INK, LABEL, LIGHT, PAGE, SMALL, THIN, series, time_colour};
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
    let line = |points: Vec<(f64, f64)>, (colour, dash)| Line { points, colour, width: 1.0, dash };
    let level = |chart: &Chart, value: f64| {
        let points = vec![(chart.x.lo, value), (chart.x.hi, value)];
        Line { points, colour: GREY, width: THIN, dash: &[3.0, 2.0] }
    };
    let mut lines = vec![level(&first, GAP_LIMIT)];
    for (i, values) in figure.gaps.iter().enumerate() {
        let clamped = |gap: &Option<f64>| gap.map(|gap| gap.clamp(first.y.lo, first.y.hi));
        lines
            .extend(known(&figure.times, values.iter().map(clamped)).into_iter().map(|points| line(points, series(i))));
    }
    moments(svg, figure, &first);
    first.draw(svg, &lines)?;
    name_moments(svg, figure, &first);
    moments(svg, figure, &second);
    let mut lines: Vec<Line> = known(&figure.times, figure.radial_error.iter().copied())
        .into_iter()
        .map(|points| line(points, (INK, &[])))
        .collect();
    lines.extend(figure.radial_band.map(|band| level(&second, band)));
    second.draw(svg, &lines)?;
    note(svg, &first, GAP_LIMIT, "90°");
    if let Some(band) = figure.radial_band {
        note(svg, &second, band, "10 % of the radius");
    }
    if figure.radial_error.iter().all(Option::is_none) {
        let at = (rect.x + rect.w / 2.0, second.rect.y + second.rect.h / 2.0);
        svg.text("not known: no robot finds the pattern", at, &Font::new(LABEL, Anchor::Middle).colour(GREY));
    }
    Ok(second.rect.bottom())
}

/// Values over time as lines that break off where one is not known.
fn known(times: &[f64], values: impl Iterator<Item = Option<f64>>) -> Vec<Vec<(f64, f64)>> {
    let mut lines: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for (time, value) in times.iter().zip(values) {
        match (value, lines.last_mut()) {
            (Some(value), Some(line)) => line.push((*time, value)),
            (None, Some(line)) if !line.is_empty() => lines.push(Vec::new()),
            _ => {}
        }
    }
    lines.retain(|line| line.len() > 1);
    lines
}

fn time_axis(figure: &TraceFigure) -> Axis {
    let first = figure.times.first().copied().unwrap_or(0.0);
    Axis::linear(first, figure.times.last().copied().unwrap_or(1.0), 10.0)
}

fn gap_chart(figure: &TraceFigure, rect: Rect) -> Chart {
    let most = figure.gaps.iter().flatten().flatten().copied().fold(0.0, f64::max);
    let top = [120.0, 180.0, 270.0, 360.0].into_iter().find(|t| most <= *t).unwrap_or(360.0);
    let step = if top > 200.0 { 90.0 } else { 30.0_f64.max(top / 4.0) };
    let y = Axis::stepped(0.0, top, step);
    Chart { rect, x: time_axis(figure), y, x_label: "", y_label: "Largest gap (°)", x_numbers: false }
}

fn error_chart(figure: &TraceFigure, rect: Rect) -> Chart {
    let band = figure.radial_band.unwrap_or(0.0);
    let most = figure.radial_error.iter().flatten().copied().fold(band * 1.3, f64::max);
    let y = Axis::linear(0.0, if most > 0.0 { most * 1.05 } else { 1.0 }, 3.0);
    Chart { rect, x: time_axis(figure), y, x_label: "Time (s)", y_label: "Radial error (m)", x_numbers: true }
}

/// Writes the times of the moments above the chart, where they do not run into each other.
fn name_moments(svg: &mut Svg, figure: &TraceFigure, chart: &Chart) {
    let mut free = f64::NEG_INFINITY;
    for instant in &figure.instants {
        if instant.time < chart.x.lo || instant.time > chart.x.hi {
            continue;
        }
        let words = format!("{} s", num(instant.time));
        let half = width(&words, SMALL, true) / 2.0;
        let (x, y) = chart.place(instant.time, chart.y.hi);
        let x = x.min(PAGE - 2.0 - half);
        if x - half > free {
            let font = Font::new(SMALL, Anchor::Middle).bold().colour(&time_colour(share(figure, instant.time)));
            svg.text(&words, (x, y - 6.0), &font);
            free = x + half + 4.0;
        }
    }
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
