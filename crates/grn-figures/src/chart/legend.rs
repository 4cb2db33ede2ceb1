//! Legends: rows of keys and words.

use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::svg::Svg;
use crate::canvas::text::width;

/// What stands before the words of a legend entry.
pub(crate) enum Key {
    Line(Paint),
    Mark(Mark, f64, Paint),
    Area(Paint),
}

/// Writes legend entries from left to right from `x` on the baseline `y`, a new row where `right` is
/// passed; returns the baseline of the last row and the end of its text.
pub(crate) fn legend(svg: &mut Svg, x: f64, y: f64, right: f64, size: f64, entries: &[(Key, &str)]) -> (f64, f64) {
    let (mut pen, mut base) = (x, y);
    for (key, words) in entries {
        let key_width = if matches!(key, Key::Mark(..)) { 7.0 } else { 16.0 };
        let needed = key_width + 3.0 + width(words, size, false);
        if pen > x && pen + needed > right {
            pen = x;
            base += size * 1.5;
        }
        let middle = base - size * 0.34;
        match key {
            Key::Line(paint) => svg.line((pen, middle), (pen + key_width, middle), paint),
            Key::Mark(mark, r, paint) => svg.mark(*mark, (pen + key_width / 2.0, middle), *r, paint),
            Key::Area(paint) => {
                svg.rect(&Rect::new(pen + 1.0, middle - 3.0, key_width - 2.0, 6.0), 0.0, paint);
            }
        }
        svg.text(words, (pen + key_width + 3.0, base), &Font::new(size, Anchor::Start));
        pen += needed + 11.0;
    }
    (base, pen - 11.0)
}
