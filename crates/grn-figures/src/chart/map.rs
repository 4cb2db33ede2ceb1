//! The world on paper: equal scales, y upwards, and a bar that says how long a metre is.

use crate::canvas::error::{FigureError, finite};
use crate::canvas::format::num;
use crate::canvas::paint::{Anchor, Font, Paint, Rect};
use crate::canvas::style::{EDGE, INK, SMALL, WALL, WALL_EDGE};
use crate::canvas::svg::{Svg, poly};
use crate::canvas::text::width;

/// An axis-parallel part of the world, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// The corner with the smallest coordinates.
    pub min: [f64; 2],
    /// The corner with the largest coordinates.
    pub max: [f64; 2],
}

impl Window {
    pub(crate) fn check(&self, what: &'static str, index: usize) -> Result<(), FigureError> {
        if self.min.iter().chain(&self.max).any(|v| !v.is_finite()) {
            return Err(FigureError::NotFinite { what, index });
        }
        if self.max[0] < self.min[0] || self.max[1] < self.min[1] {
            return Err(FigureError::OutOfRange {
                what,
                index,
                expected: "from the smaller to the larger coordinates",
            });
        }
        finite(what, self.min.into_iter().chain(self.max)).map_err(|e| e.within(what, index))
    }

    /// At least 1 mm, so that a window around a single point can be shown.
    pub(crate) fn width(&self) -> f64 {
        (self.max[0] - self.min[0]).max(1e-3)
    }

    /// At least 1 mm.
    pub(crate) fn height(&self) -> f64 {
        (self.max[1] - self.min[1]).max(1e-3)
    }
}

/// How walls look: solid and dark.
pub(crate) fn wall_look() -> Paint {
    Paint::stroke(WALL_EDGE, 0.6).filled(WALL)
}

/// How the frame of a map looks: so light that nobody takes it for a wall.
pub(crate) fn frame_look() -> Paint {
    Paint::stroke(EDGE, 0.5)
}

/// A window of the world in a rectangle on paper.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    pub rect: Rect,
    /// Points a metre.
    pub scale: f64,
    middle: [f64; 2],
}

impl View {
    /// As large as the rectangle allows; what is left over of the rectangle shows more of the world.
    pub fn new(window: &Window, rect: Rect) -> Self {
        let scale = (rect.w / window.width()).min(rect.h / window.height());
        let middle = [0, 1].map(|i| (window.min[i] + window.max[i]) / 2.0);
        Self { rect, scale, middle }
    }

    pub fn place(&self, p: [f64; 2]) -> (f64, f64) {
        (
            self.rect.x + self.rect.w / 2.0 + (p[0] - self.middle[0]) * self.scale,
            self.rect.y + self.rect.h / 2.0 - (p[1] - self.middle[1]) * self.scale,
        )
    }

    /// Path data of lines in the world.
    pub fn path(&self, lines: &[Vec<[f64; 2]>], closed: bool) -> String {
        let on_paper = |line: &Vec<[f64; 2]>| line.iter().map(|p| self.place(*p)).collect::<Vec<_>>();
        lines.iter().map(|line| poly(&on_paper(line), closed)).collect()
    }

    pub fn walls(&self, svg: &mut Svg, walls: &[Vec<[f64; 2]>]) {
        for wall in walls {
            let d = self.path(std::slice::from_ref(wall), true);
            if !d.is_empty() {
                svg.path(&d, &wall_look());
            }
        }
    }

    /// A bar of 1, 2 or 5 times a power of ten metres, at most `limit` points long.
    pub fn bar_length(&self, limit: f64) -> f64 {
        let most = limit / self.scale;
        let power = libm::pow(10.0, libm::floor(libm::log10(most)));
        let times = [5.0, 2.0, 1.0].into_iter().find(|m| m * power <= most).unwrap_or(1.0);
        times * power
    }

    /// Draws a scale bar to the right of `x` with its words' baseline at `y`; returns its right end.
    pub fn scale_bar(&self, svg: &mut Svg, x: f64, y: f64, limit: f64) -> f64 {
        let metres = self.bar_length(limit);
        let (middle, end) = (y - SMALL * 0.34, x + metres * self.scale);
        let pen = Paint::stroke(INK, 1.0);
        svg.line((x, middle), (end, middle), &pen);
        svg.line((x, middle - 2.0), (x, middle + 2.0), &pen);
        svg.line((end, middle - 2.0), (end, middle + 2.0), &pen);
        let words = Self::bar_words(metres);
        svg.text(&words, (end + 3.0, y), &Font::new(SMALL, Anchor::Start));
        end + 3.0 + width(&words, SMALL, false)
    }

    /// The room a scale bar takes.
    pub fn scale_bar_width(&self, limit: f64) -> f64 {
        let metres = self.bar_length(limit);
        metres * self.scale + 3.0 + width(&Self::bar_words(metres), SMALL, false)
    }

    fn bar_words(metres: f64) -> String {
        format!("{} m", num(metres))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metre_is_as_long_in_both_directions() {
        let window = Window { min: [2.0, 3.0], max: [12.0, 8.0] };
        let view = View::new(&window, Rect::new(10.0, 20.0, 100.0, 100.0));
        assert_eq!(view.place([7.0, 5.5]), (60.0, 70.0));
        assert_eq!(view.place([8.0, 6.5]), (70.0, 60.0));
        assert_eq!(view.bar_length(45.0), 2.0);
    }

    #[test]
    fn windows_that_are_none_are_refused() {
        let flat = Window { min: [0.0, 1.0], max: [3.0, 1.0] };
        assert_eq!((flat.check("window", 4), flat.height()), (Ok(()), 1e-3));
        let turned = Window { min: [0.0, 1.0], max: [3.0, 0.0] };
        assert!(matches!(turned.check("window", 4), Err(FigureError::OutOfRange { index: 4, .. })));
        let broken = Window { min: [0.0, f64::NAN], max: [3.0, 1.0] };
        assert_eq!(broken.check("window", 0), Err(FigureError::NotFinite { what: "window", index: 0 }));
    }
}
