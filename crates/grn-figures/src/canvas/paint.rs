//! What shapes and text look like.

use crate::canvas::format::{escape, num};
use crate::canvas::style::INK;
use crate::canvas::text::width;
use std::fmt::Write as _;

/// A rectangle on paper, points, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rect {
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
        other.x >= self.x && other.y >= self.y && other.right() <= self.right() && other.bottom() <= self.bottom()
    }
}

/// How a shape is filled and outlined; `none` for neither.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Paint {
    pub fill: String,
    pub stroke: String,
    pub width: f64,
    pub dash: Vec<f64>,
}

impl Paint {
    pub fn stroke(colour: &str, width: f64) -> Self {
        Self { fill: "none".into(), stroke: colour.into(), width, dash: Vec::new() }
    }

    pub fn fill(colour: &str) -> Self {
        Self { fill: colour.into(), stroke: "none".into(), width: 0.0, dash: Vec::new() }
    }

    pub fn dashed(mut self, dash: &[f64]) -> Self {
        self.dash = dash.to_vec();
        self
    }

    pub fn filled(mut self, colour: &str) -> Self {
        self.fill = colour.into();
        self
    }

    /// As attributes of an element.
    pub fn attributes(&self) -> String {
        let mut out = format!("fill=\"{}\"", escape(&self.fill));
        if self.stroke != "none" {
            let _ = write!(out, " stroke=\"{}\" stroke-width=\"{}\"", escape(&self.stroke), num(self.width));
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
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How text is set.
#[derive(Debug, Clone)]
pub(crate) struct Font {
    pub size: f64,
    pub anchor: Anchor,
    pub colour: String,
    pub bold: bool,
    /// Set the first letter as a symbol even without an index (a gene named `M`).
    pub symbol: bool,
}

impl Font {
    pub fn new(size: f64, anchor: Anchor) -> Self {
        Self { size, anchor, colour: INK.into(), bold: false, symbol: false }
    }

    pub fn bold(mut self) -> Self {
        self.bold = true;
        self
    }

    pub fn colour(mut self, colour: &str) -> Self {
        self.colour = colour.into();
        self
    }

    /// Width of text set in this font, points.
    pub fn width(&self, text: &str) -> f64 {
        width(text, self.size, self.bold)
    }

    pub fn symbol(mut self) -> Self {
        self.symbol = true;
        self
    }
}

/// A shape for points of data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    Circle,
    Square,
    Diamond,
    Triangle,
    Cross,
    /// A cross in a white ring of twice its size.
    RingedCross,
}
