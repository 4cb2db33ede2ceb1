//! A figure that says why it shows nothing.

use crate::canvas::paint::{Anchor, Font};
use crate::canvas::style::{COLUMN, GREY, LABEL};
use crate::canvas::svg::Svg;
use crate::canvas::text::lines;

const LINE: f64 = 11.0;
const MARGIN: f64 = 14.0;

/// A document one column wide that says `Nothing to draw:` and why.
#[must_use]
pub fn nothing_to_draw(why: &str) -> String {
    let mut svg = Svg::default();
    let words = lines(&format!("Nothing to draw: {why}."), LABEL, COLUMN - 2.0 * MARGIN, 12);
    svg.open("note", "");
    for (i, line) in words.iter().enumerate() {
        let at = (COLUMN / 2.0, MARGIN + LABEL + LINE * i as f64);
        svg.text(line, at, &Font::new(LABEL, Anchor::Middle).colour(GREY));
    }
    svg.close();
    svg.finish(COLUMN, 2.0 * MARGIN + LINE * words.len() as f64)
}
