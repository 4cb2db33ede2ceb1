//! One look for all figures: sizes, fonts, colours.

/// Width of one column of a two-column journal page: 3.5 in, in points.
pub const COLUMN: f64 = 252.0;
/// Width of a two-column journal page: 7.16 in, in points.
pub const PAGE: f64 = 515.5;
/// Height of a journal page that a figure may take, caption left out: points.
pub const PAGE_HEIGHT: f64 = 620.0;

/// Size of labels, points.
pub const LABEL: f64 = 8.0;
/// Size of tick labels and legends, points: the smallest text but for subscripts.
pub const SMALL: f64 = 7.2;
/// Typefaces: the first installed one is used. Figures are laid out for a wider one.
pub const FONTS: &str = "Helvetica, Arial, Liberation Sans, sans-serif";

/// Line of axes, frames and outlines, points.
pub const THIN: f64 = 0.6;
/// Line of data, points.
pub const DATA: f64 = 1.2;

/// Text and axes.
pub const INK: &str = "#222222";
/// Secondary text and marks.
pub const GREY: &str = "#767676";
/// Grid lines and light marks.
pub const LIGHT: &str = "#DADADA";
/// Walls.
pub const WALL: &str = "#ABABAB";
/// Outline of walls.
pub const WALL_EDGE: &str = "#4D4D4D";
/// Frame of a map.
pub const EDGE: &str = "#C9C9C9";
/// Okabe-Ito blue: the pattern, target input x1.
pub const BLUE: &str = "#0072B2";
/// Okabe-Ito orange: obstacle input x2.
pub const ORANGE: &str = "#E69F00";
/// Okabe-Ito bluish green: enclosed targets.
pub const GREEN: &str = "#009E73";
/// Okabe-Ito vermillion: leaks, inhibition, knees.
pub const VERMILLION: &str = "#D55E00";
/// Okabe-Ito reddish purple.
pub const PURPLE: &str = "#CC79A7";
/// Tint of blue, for filled areas under dark text.
pub const BLUE_TINT: &str = "#D6EAF6";
/// Tint of orange, for filled areas under dark text.
pub const ORANGE_TINT: &str = "#F8DFA6";
/// Tint of grey, for boxes.
pub const BOX_TINT: &str = "#F5F5F5";

/// Colours and dash patterns (on and off, points) of series, distinct in grey by the dashes; see [`series`].
pub const SERIES: [(&str, &[f64]); 6] = [
    (BLUE, &[]),
    (VERMILLION, &[4.0, 2.0]),
    (GREEN, &[1.2, 1.6]),
    (PURPLE, &[7.0, 2.0]),
    (ORANGE, &[2.5, 1.5]),
    (INK, &[6.0, 1.5, 1.5, 1.5]),
];

/// The look of a series by its place: after the sixth the colours come again with other dashes, after the 36th all does.
pub fn series(place: usize) -> (&'static str, &'static [f64]) {
    let count = SERIES.len();
    (SERIES[place % count].0, SERIES[(place + place / count) % count].1)
}

/// A colour for a time, `0` the earliest and `1` the latest: from dark violet to light green, darker is
/// always earlier, also in grey. The ramp is viridis without its palest end.
pub fn time_colour(share: f64) -> String {
    const RAMP: [[f64; 3]; 6] = [
        [68.0, 1.0, 84.0],
        [70.0, 50.0, 127.0],
        [54.0, 92.0, 141.0],
        [39.0, 127.0, 142.0],
        [31.0, 161.0, 135.0],
        [96.0, 196.0, 96.0],
    ];
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    let place = share * (RAMP.len() - 1) as f64;
    let low = (place as usize).min(RAMP.len() - 2);
    let part = place - low as f64;
    let channel = |c: usize| (RAMP[low][c] + part * (RAMP[low + 1][c] - RAMP[low][c])).round() as u8;
    format!("#{:02X}{:02X}{:02X}", channel(0), channel(1), channel(2))
}
