//! A small writer of SVG elements: escapes text, writes numbers shortly, and leaves nothing to the locale.

use crate::canvas::format::{escape, num};
use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::style::FONTS;
use crate::canvas::text::{Kind, SUB, runs};
use std::fmt::Write as _;

/// An SVG document, or a part of one, being written.
#[derive(Debug, Default)]
pub(crate) struct Svg {
    body: String,
}

impl Svg {
    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), paint: &Paint) {
        self.path(&format!("M{} {}L{} {}", num(from.0), num(from.1), num(to.0), num(to.1)), paint);
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
        let _ = writeln!(self.body, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" {}/>", paint.attributes());
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
            Mark::RingedCross => {
                let ring = Paint::stroke(&paint.stroke, paint.width * 0.85).filled("#FFFFFF");
                self.circle(at, r * 1.9, &ring);
                return self.mark(Mark::Cross, at, r, paint);
            }
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
            "<text xml:space=\"preserve\" x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\"",
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
                let _ = write!(attributes, " dy=\"{}\"", num(if sub { drop } else { -drop }));
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
                let _ = write!(self.body, "<tspan{attributes}>{}</tspan>", escape(&run.text));
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

/// Path data of a polyline; points closer than 0.05 pt to the one before are left out.
pub(crate) fn poly(points: &[(f64, f64)], closed: bool) -> String {
    let mut d = String::new();
    let mut last: Option<(f64, f64)> = None;
    for (i, &(x, y)) in points.iter().enumerate() {
        let near = last.is_some_and(|(lx, ly)| (x - lx).abs() + (y - ly).abs() < 0.05);
        if near && i + 1 < points.len() {
            continue;
        }
        let _ = write!(d, "{}{} {}", if d.is_empty() { 'M' } else { 'L' }, num(x), num(y));
        last = Some((x, y));
    }
    if closed && !d.is_empty() {
        d.push('Z');
    }
    d
}
