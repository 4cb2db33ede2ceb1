//! A small writer of SVG elements: escapes text, writes numbers shortly, and leaves nothing to the locale.

use super::style::{FONTS, INK};
use super::text::{Kind, SUB, run_width, runs, width};
use std::fmt::Write as _;

/// A rectangle on paper, points, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub x: f64,
    pub y: f64,
    pub w: f64,
    pub h: f64,
}

impl Rect {
    pub fn new(x: f64, y: f64, w: f64, h: f64) -> Self {
        Self { x, y, w, h }
    }

    pub fn right(&self) -> f64 {
        self.x + self.w
    }

    pub fn bottom(&self) -> f64 {
        self.y + self.h
    }

    /// Area shared with another rectangle.
    pub fn overlap(&self, other: &Rect) -> f64 {
        let w = self.right().min(other.right()) - self.x.max(other.x);
        let h = self.bottom().min(other.bottom()) - self.y.max(other.y);
        if w > 0.0 && h > 0.0 { w * h } else { 0.0 }
    }

    pub fn holds(&self, other: &Rect) -> bool {
        other.x >= self.x
            && other.y >= self.y
            && other.right() <= self.right()
            && other.bottom() <= self.bottom()
    }
}

/// How a shape is filled and outlined; `none` for neither.
#[derive(Debug, Clone)]
pub(super) struct Paint {
    pub fill: String,
    pub stroke: String,
    pub width: f64,
    pub dash: Vec<f64>,
}

impl Paint {
    pub fn stroke(colour: &str, width: f64) -> Self {
        Self {
            fill: "none".into(),
            stroke: colour.into(),
            width,
            dash: Vec::new(),
        }
    }

    pub fn fill(colour: &str) -> Self {
        Self {
            fill: colour.into(),
            stroke: "none".into(),
            width: 0.0,
            dash: Vec::new(),
        }
    }

    pub fn dashed(mut self, dash: &[f64]) -> Self {
        self.dash = dash.to_vec();
        self
    }

    pub fn filled(mut self, colour: &str) -> Self {
        self.fill = colour.into();
        self
    }

    fn attributes(&self) -> String {
        let mut out = format!("fill=\"{}\"", escape(&self.fill));
        if self.stroke != "none" {
            let _ = write!(
                out,
                " stroke=\"{}\" stroke-width=\"{}\"",
                escape(&self.stroke),
                num(self.width)
            );
        }
        if !self.dash.is_empty() {
            let dash: Vec<String> = self.dash.iter().map(|d| num(*d)).collect();
            let _ = write!(out, " stroke-dasharray=\"{}\"", dash.join(" "));
        }
        out
    }
}

/// Which point of a text is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How text is set.
#[derive(Debug, Clone)]
pub(super) struct Font {
    pub size: f64,
    pub anchor: Anchor,
    pub colour: String,
    pub bold: bool,
    /// Set the first letter as a symbol even without an index (a gene named `M`).
    pub symbol: bool,
}

impl Font {
    pub fn new(size: f64, anchor: Anchor) -> Self {
        Self {
            size,
            anchor,
            colour: INK.into(),
            bold: false,
            symbol: false,
        }
    }

    pub fn bold(mut self) -> Self {
        self.bold = true;
        self
    }

    pub fn colour(mut self, colour: &str) -> Self {
        self.colour = colour.into();
        self
    }

    pub fn symbol(mut self) -> Self {
        self.symbol = true;
        self
    }
}

/// A shape for points of data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    Circle,
    Square,
    Diamond,
    Triangle,
    Cross,
}

/// An SVG document, or a part of one, being written.
#[derive(Debug, Default)]
pub(super) struct Svg {
    body: String,
}

impl Svg {
    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), paint: &Paint) {
        self.path(
            &format!(
                "M{} {}L{} {}",
                num(from.0),
                num(from.1),
                num(to.0),
                num(to.1)
            ),
            paint,
        );
    }

    pub fn path(&mut self, d: &str, paint: &Paint) {
        let _ = writeln!(
            self.body,
            "<path d=\"{d}\" {} fill-rule=\"evenodd\" stroke-linejoin=\"round\"/>",
            paint.attributes()
        );
    }

    pub fn circle(&mut self, at: (f64, f64), r: f64, paint: &Paint) {
        let (x, y, r) = (num(at.0), num(at.1), num(r));
        let _ = writeln!(
            self.body,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" {}/>",
            paint.attributes()
        );
    }

    pub fn rect(&mut self, rect: &Rect, corner: f64, paint: &Paint) {
        let (x, y, w, h) = (num(rect.x), num(rect.y), num(rect.w), num(rect.h));
        let _ = writeln!(
            self.body,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" rx=\"{}\" {}/>",
            num(corner),
            paint.attributes()
        );
    }

    pub fn mark(&mut self, mark: Mark, at: (f64, f64), r: f64, paint: &Paint) {
        let (x, y) = at;
        let corners: Vec<(f64, f64)> = match mark {
            Mark::Circle => return self.circle(at, r, paint),
            Mark::Square => vec![(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
            Mark::Diamond => vec![(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
            Mark::Triangle => vec![(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
            Mark::Cross => {
                self.line((x - r, y - r), (x + r, y + r), paint);
                return self.line((x - r, y + r), (x + r, y - r), paint);
            }
        };
        let points: Vec<(f64, f64)> = corners.iter().map(|c| (x + r * c.0, y + r * c.1)).collect();
        self.path(&poly(&points, true), paint);
    }

    /// Writes text with its baseline at `at`.
    pub fn text(&mut self, text: &str, at: (f64, f64), font: &Font) {
        self.turned_text(text, at, 0.0, font);
    }

    /// Writes text turned by `degrees` clockwise about `at`.
    pub fn turned_text(&mut self, text: &str, at: (f64, f64), degrees: f64, font: &Font) {
        let (x, y) = (num(at.0), num(at.1));
        let anchor = match font.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let _ = write!(
            self.body,
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\"",
            num(font.size),
            escape(&font.colour)
        );
        if font.bold {
            self.body.push_str(" font-weight=\"bold\"");
        }
        if degrees != 0.0 {
            let _ = write!(self.body, " transform=\"rotate({} {x} {y})\"", num(degrees));
        }
        self.body.push('>');
        let drop = font.size * 0.2;
        let mut low = false;
        for run in runs(text) {
            let mut attributes = String::new();
            let sub = run.kind == Kind::Sub;
            if sub != low {
                let _ = write!(
                    attributes,
                    " dy=\"{}\"",
                    num(if sub { drop } else { -drop })
                );
            }
            if sub {
                let _ = write!(attributes, " font-size=\"{}\"", num(font.size * SUB));
            }
            if run.kind == Kind::Symbol || (font.symbol && !sub) {
                attributes.push_str(" font-style=\"italic\"");
            }
            low = sub;
            if attributes.is_empty() {
                self.body.push_str(&escape(&run.text));
            } else {
                let _ = write!(
                    self.body,
                    "<tspan{attributes}>{}</tspan>",
                    escape(&run.text)
                );
            }
        }
        self.body.push_str("</text>\n");
    }

    /// Opens a group of a class; its title is what a reader sees on pointing at it.
    pub fn open(&mut self, class: &str, title: &str) {
        let _ = writeln!(self.body, "<g class=\"{}\">", escape(class));
        if !title.is_empty() {
            let _ = writeln!(self.body, "<title>{}</title>", escape(title));
        }
    }

    pub fn close(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// Opens a part that is clipped to `rect`; coordinates stay those of the document.
    pub fn open_clip(&mut self, rect: &Rect) {
        let (x, y, w, h) = (num(rect.x), num(rect.y), num(rect.w), num(rect.h));
        let _ = writeln!(
            self.body,
            "<svg x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\" overflow=\"hidden\">"
        );
    }

    pub fn close_clip(&mut self) {
        self.body.push_str("</svg>\n");
    }

    /// Puts elements that were written elsewhere at `(x, y)`, scaled.
    pub fn embed(&mut self, elements: &str, x: f64, y: f64, scale: f64) {
        let _ = write!(
            self.body,
            "<g transform=\"translate({} {}) scale({})\">\n{elements}</g>\n",
            num(x),
            num(y),
            num(scale)
        );
    }

    /// The document, `w` by `h` points on white.
    pub fn finish(self, w: f64, h: f64) -> String {
        let (w, h) = (num(w), num(h));
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
             width=\"{w}pt\" height=\"{h}pt\" viewBox=\"0 0 {w} {h}\" font-family=\"{FONTS}\">\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"#FFFFFF\"/>\n{}</svg>\n",
            self.body
        )
    }
}

/// What stands before the words of a legend entry.
pub(super) enum Key {
    Line(Paint),
    Mark(Mark, f64, Paint),
    Area(Paint),
}

/// Writes legend entries from left to right from `x` on the baseline `y`, a new row where `right` is
/// passed; returns the baseline of the last row and the end of its text.
pub(super) fn legend(
    svg: &mut Svg,
    x: f64,
    y: f64,
    right: f64,
    size: f64,
    entries: &[(Key, &str)],
) -> (f64, f64) {
    let (mut pen, mut base) = (x, y);
    for (key, words) in entries {
        let key_width = if matches!(key, Key::Mark(..)) {
            7.0
        } else {
            16.0
        };
        let needed = key_width + 3.0 + width(words, size, false);
        if pen > x && pen + needed > right {
            pen = x;
            base += size * 1.5;
        }
        let middle = base - size * 0.34;
        match key {
            Key::Line(paint) => svg.line((pen, middle), (pen + key_width, middle), paint),
            Key::Mark(mark, r, paint) => {
                svg.mark(*mark, (pen + key_width / 2.0, middle), *r, paint)
            }
            Key::Area(paint) => {
                svg.rect(
                    &Rect::new(pen + 1.0, middle - 3.0, key_width - 2.0, 6.0),
                    0.0,
                    paint,
                );
            }
        }
        svg.text(
            words,
            (pen + key_width + 3.0, base),
            &Font::new(size, Anchor::Start),
        );
        pen += needed + 11.0;
    }
    (base, pen - 11.0)
}

/// Width of text set in a font.
pub(super) fn set_width(text: &str, font: &Font) -> f64 {
    let natural: f64 = runs(text).iter().map(|run| run_width(run, font.size)).sum();
    if font.bold { natural * 1.06 } else { natural }
}

/// Path data of a polyline; points closer than 0.05 pt to the one before are left out.
pub(super) fn poly(points: &[(f64, f64)], closed: bool) -> String {
    let mut d = String::new();
    let mut last: Option<(f64, f64)> = None;
    for (i, &(x, y)) in points.iter().enumerate() {
        let near = last.is_some_and(|(lx, ly)| (x - lx).abs() + (y - ly).abs() < 0.05);
        if near && i + 1 < points.len() {
            continue;
        }
        let _ = write!(
            d,
            "{}{} {}",
            if d.is_empty() { 'M' } else { 'L' },
            num(x),
            num(y)
        );
        last = Some((x, y));
    }
    if closed && !d.is_empty() {
        d.push('Z');
    }
    d
}

/// A number with at most two decimals, no trailing zeros and no minus zero.
pub(super) fn num(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// Text that may stand in an element or in an attribute; control characters, which XML forbids, become spaces.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || c == '\u{FFFE}' || c == '\u{FFFF}' => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
