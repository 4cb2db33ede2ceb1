//! Axes, ticks and lines of a chart, drawn by `plotters`.
//!
//! `plotters` works in whole pixels, so it draws ten to the point and the result is scaled down. Tick
//! positions and the logarithm are computed here: ticks so that their number suits the size on paper, the
//! logarithm because the one of the platform may differ in its last bit.

use crate::canvas::error::FigureError;
use crate::canvas::paint::{Anchor, Font, Paint, Rect};
use crate::canvas::style::{FONTS, INK, LABEL, LIGHT, SMALL, THIN};
use crate::canvas::svg::Svg;
use crate::canvas::text::width;
use plotters::coord::ranged1d::{KeyPointHint, KeyPointWeight, NoDefaultFormatting, ValueFormatter};
use plotters::prelude::*;

const SCALE: f64 = 10.0;
const LEFT: f64 = 34.0;
const BELOW: f64 = 16.0;

/// One axis: its range and its ticks, in chart coordinates (the decadic logarithm on a logarithmic axis).
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    pub lo: f64,
    pub hi: f64,
    pub ticks: Vec<(f64, String)>,
    pub minor: Vec<f64>,
    pub log: bool,
}

impl Axis {
    /// A linear axis over `lo..hi` with about `count` ticks.
    pub fn linear(lo: f64, hi: f64, count: f64) -> Self {
        let span = (hi - lo).max(1e-12 * lo.abs().max(1.0));
        let raw = span / count;
        let power = libm::pow(10.0, libm::floor(libm::log10(raw)));
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= raw * 0.7).unwrap_or(10.0) * power;
        Self::stepped(lo, lo + span, step)
    }

    /// A linear axis with a tick at every multiple of `step`.
    pub fn stepped(lo: f64, hi: f64, step: f64) -> Self {
        let decimals = (-libm::floor(libm::log10(step) + 1e-9)).clamp(0.0, 12.0) as usize;
        let first = libm::ceil(lo / step - 1e-9);
        let count = (libm::floor(hi / step + 1e-9) - first).clamp(0.0, 200.0) as usize;
        let tick = |i: usize| {
            let value = (first + i as f64) * step;
            (value, format!("{value:.decimals$}").replace('-', "\u{2212}"))
        };
        Self { lo, hi, ticks: (0..=count).map(tick).collect(), minor: Vec::new(), log: false }
    }

    /// A logarithmic axis over `lo..hi`, both above 0, with ticks at 1, 2 and 5 or, over many decades, at 1.
    pub fn logarithmic(lo: f64, hi: f64) -> Self {
        let (low, high) = (libm::log10(lo), libm::log10(hi));
        let mantissas: &[u32] = if high - low > 2.6 { &[1] } else { &[1, 2, 5] };
        let (mut ticks, mut minor) = (Vec::new(), Vec::new());
        let mut decade = libm::floor(low);
        while decade <= high {
            for mantissa in 1..=9_u32 {
                let at = decade + libm::log10(f64::from(mantissa));
                if at < low - 1e-9 || at > high + 1e-9 {
                    continue;
                }
                let whole_decades = high - low > 6.0 && libm::fmod(decade, 2.0) != 0.0;
                if mantissas.contains(&mantissa) && !whole_decades {
                    let decimals = (-decade).clamp(0.0, 20.0) as usize;
                    let value = f64::from(mantissa) * libm::pow(10.0, decade);
                    let label = if decimals > 4 { format!("{value:.0e}") } else { format!("{value:.decimals$}") };
                    ticks.push((at, label));
                } else {
                    minor.push(at);
                }
            }
            decade += 1.0;
        }
        Self { lo: low, hi: high, ticks, minor, log: true }
    }

    /// The chart coordinate of a value; 0 has none on a logarithmic axis and is put at its lower end.
    pub fn at(&self, value: f64) -> f64 {
        match self.log {
            true if value > 0.0 => libm::log10(value).max(self.lo),
            true => self.lo,
            false => value,
        }
    }

    /// How far from a vertical axis its label stands: clear of the numbers.
    pub fn label_distance(&self) -> f64 {
        let widest = self.ticks.iter().map(|tick| width(&tick.1, SMALL, false)).fold(0.0, f64::max);
        (widest + 9.0).max(LEFT - 5.0)
    }

    /// The words at a chart coordinate: none where there is no tick.
    fn label(&self, at: f64) -> String {
        let near = |tick: &&(f64, String)| (tick.0 - at).abs() <= 1e-9 * (self.hi - self.lo);
        self.ticks.iter().find(near).map(|tick| tick.1.clone()).unwrap_or_default()
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        let share = (value - self.lo) / (self.hi - self.lo);
        start + (f64::from(end - start) * share).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        match hint.weight() {
            KeyPointWeight::Bold => self.ticks.iter().map(|tick| tick.0).collect(),
            KeyPointWeight::Any => Vec::new(),
        }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.lo..self.hi
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(value: &f64) -> String {
        value.to_string()
    }
}

/// A line of a chart, in chart coordinates.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    pub points: Vec<(f64, f64)>,
    pub colour: &'static str,
    pub width: f64,
    pub dash: &'static [f64],
}

/// A chart: the rectangle between its axes and the axes themselves.
#[derive(Debug, Clone)]
pub(crate) struct Chart {
    pub rect: Rect,
    pub x: Axis,
    pub y: Axis,
    pub x_label: &'static str,
    pub y_label: &'static str,
    /// Whether the x axis has numbers, or leaves them to a chart below it.
    pub x_numbers: bool,
}

impl Chart {
    /// Where a value lies on paper.
    pub fn place(&self, x: f64, y: f64) -> (f64, f64) {
        self.on_paper((self.x.at(x), self.y.at(y)))
    }

    /// Where a chart coordinate lies on paper.
    pub fn on_paper(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let share = |axis: &Axis, v: f64| (v - axis.lo) / (axis.hi - axis.lo);
        let (right, up) = (share(&self.x, x), share(&self.y, y));
        (self.rect.x + right * self.rect.w, self.rect.bottom() - up * self.rect.h)
    }

    /// Draws the axes, grid and lines.
    pub fn draw(&self, svg: &mut Svg, lines: &[Line]) -> Result<(), FigureError> {
        let elements = self.plot(lines).map_err(FigureError::Chart)?;
        svg.embed(&elements, self.rect.x - LEFT, self.rect.y, 1.0 / SCALE);
        let tick = Paint::stroke(INK, THIN * 0.8);
        for at in &self.y.minor {
            let y = self.rect.bottom() - (at - self.y.lo) / (self.y.hi - self.y.lo) * self.rect.h;
            svg.line((self.rect.x - 1.6, y), (self.rect.x, y), &tick);
        }
        let middle = self.rect.x + self.rect.w / 2.0;
        if !self.x_label.is_empty() {
            svg.text(self.x_label, (middle, self.rect.bottom() + 23.0), &Font::new(LABEL, Anchor::Middle));
        }
        let at = (self.rect.x - self.y.label_distance(), self.rect.y + self.rect.h / 2.0);
        svg.turned_text(self.y_label, at, -90.0, &Font::new(LABEL, Anchor::Middle));
        Ok(())
    }

    fn plot(&self, lines: &[Line]) -> Result<String, String> {
        let pixels = |points: f64| (points * SCALE).round() as u32;
        let mut out = String::new();
        {
            let size = (pixels(self.rect.w + LEFT), pixels(self.rect.h + BELOW));
            let area = SVGBackend::with_string(&mut out, size).into_drawing_area();
            let mut chart = ChartBuilder::on(&area)
                .set_label_area_size(LabelAreaPosition::Left, pixels(LEFT))
                .set_label_area_size(LabelAreaPosition::Bottom, pixels(BELOW))
                .build_cartesian_2d(self.x.clone(), self.y.clone())
                .map_err(|e| e.to_string())?;
            let font = (FONTS, SMALL * SCALE * 1.24).into_font().color(&colour(INK));
            chart
                .configure_mesh()
                .light_line_style(TRANSPARENT)
                .bold_line_style(colour(LIGHT).stroke_width(pixels(THIN * 0.6)))
                .axis_style(colour(INK).stroke_width(pixels(THIN)))
                .set_all_tick_mark_size(pixels(2.4))
                .x_labels(self.x.ticks.len().max(1))
                .y_labels(self.y.ticks.len().max(1))
                .x_label_formatter(&|v| {
                    if self.x_numbers { self.x.label(*v) } else { String::new() }
                })
                .y_label_formatter(&|v| self.y.label(*v))
                .label_style(font)
                .draw()
                .map_err(|e| e.to_string())?;
            for line in lines {
                let style = colour(line.colour).stroke_width(pixels(line.width));
                let points = line.points.iter().copied();
                let drawn = match line.dash {
                    [on, off, ..] => {
                        chart.draw_series(DashedLineSeries::new(points, pixels(*on), pixels(*off), style)).map(|_| ())
                    }
                    _ => chart.draw_series(LineSeries::new(points, style)).map(|_| ()),
                };
                drawn.map_err(|e| e.to_string())?;
            }
            area.present().map_err(|e| e.to_string())?;
        }
        // Its root element goes: the chart becomes a part of another document.
        let start = out.find('>').ok_or("no root element")? + 1;
        let end = out.rfind("</svg>").ok_or("no end of the root element")?;
        out.get(start..end).map(|s| s.trim_start().to_owned()).ok_or_else(|| "an empty root element".to_owned())
    }
}

/// A colour of the form `#RRGGBB`; anything else is grey.
fn colour(hex: &str) -> RGBColor {
    let channel = |at: usize| hex.get(at..at + 2).and_then(|part| u8::from_str_radix(part, 16).ok());
    match (channel(1), channel(3), channel(5)) {
        (Some(r), Some(g), Some(b)) => RGBColor(r, g, b),
        _ => RGBColor(128, 128, 128),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers() {
        let labels = |axis: Axis| axis.ticks.into_iter().map(|t| t.1).collect::<Vec<_>>();
        assert_eq!(labels(Axis::linear(0.0, 100.0, 5.0)), ["0", "20", "40", "60", "80", "100"]);
        assert_eq!(labels(Axis::linear(0.0, 0.3, 3.0)), ["0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(labels(Axis::logarithmic(0.01, 0.5)), ["0.01", "0.02", "0.05", "0.1", "0.2", "0.5"]);
        assert!(labels(Axis::logarithmic(1e-9, 1.0)).len() < 8);
    }

    #[test]
    fn lines_end_where_place_says() {
        let chart = Chart {
            rect: Rect::new(40.0, 10.0, 200.0, 100.0),
            x: Axis::linear(0.0, 8.0, 4.0),
            y: Axis::linear(0.0, 1.0, 4.0),
            x_label: "x",
            y_label: "y",
            x_numbers: true,
        };
        let line = Line { points: vec![(2.0, 0.25), (6.0, 0.75)], colour: INK, width: 1.0, dash: &[] };
        let out = chart.plot(&[line]).unwrap();
        let points = out.lines().rfind(|l| l.starts_with("<polyline")).unwrap();
        let inner = points.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
        let drawn: Vec<f64> = inner.split([' ', ',']).filter_map(|n| n.parse().ok()).collect();
        for (pair, value) in drawn.chunks(2).zip([(2.0, 0.25), (6.0, 0.75)]) {
            let (x, y) = chart.place(value.0, value.1);
            assert!((pair[0] / SCALE + chart.rect.x - LEFT - x).abs() < 0.21, "{pair:?} {x}");
            assert!((pair[1] / SCALE + chart.rect.y - y).abs() < 0.21, "{pair:?} {y}");
        }
    }
}
