//! Success rates with their intervals.

use crate::canvas::error::{FigureError, finite, within};
use crate::canvas::note::nothing_to_draw;
use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::style::{BLUE, COLUMN, DATA, INK, LABEL, SMALL, THIN};
use crate::canvas::svg::Svg;
use crate::canvas::text::{BOLD, lines, width};
use crate::chart::axes::{Axis, Chart};
use crate::chart::panels::blank;

/// Most rows, titles of groups among them, that fit on a page.
const ROWS: usize = 44;
const STEP: f64 = 13.0;
const LINE: f64 = 8.4;
/// Widest line of a row's name.
const NAME: f64 = 92.0;
/// Room right of the axis for numbers.
const NUMBERS: f64 = 66.0;

/// What [`rates`] shows.
#[derive(Debug, Clone, PartialEq)]
pub struct RatesFigure {
    /// The groups from above.
    pub groups: Vec<RateGroup>,
    /// Of what it is the rate, in percent.
    pub x_label: String,
}

/// Rows that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct RateGroup {
    /// What is common to them, such as the scenario; empty for no title.
    pub title: String,
    /// The rows from above.
    pub rows: Vec<RateRow>,
}

/// How often something succeeded.
#[derive(Debug, Clone, PartialEq)]
pub struct RateRow {
    /// What succeeds.
    pub label: String,
    /// How often it succeeded.
    pub successes: u64,
    /// How often it was tried.
    pub trials: u64,
    /// The ends of the rate's interval of 95 %, from 0 to 1; none where a single trial tells of no spread.
    pub interval: Option<(f64, f64)>,
}

impl RateRow {
    /// From 0 to 1; none without a trial.
    fn rate(&self) -> Option<f64> {
        (self.trials > 0).then(|| self.successes as f64 / self.trials as f64)
    }

    /// `80 % (63–90)`, or `1 of 1` where there is no interval.
    fn words(&self) -> String {
        let percent = |rate: f64| format!("{:.0}", 100.0 * rate);
        match (self.rate(), self.interval) {
            (Some(rate), Some((low, high))) => format!("{} % ({}–{})", percent(rate), percent(low), percent(high)),
            _ => format!("{} of {}", self.successes, self.trials),
        }
    }
}

/// The same on as many pages as it takes; a group that goes on overleaf keeps its title.
fn pages(groups: &[RateGroup]) -> Vec<Vec<RateGroup>> {
    let mut pages: Vec<Vec<RateGroup>> = Vec::new();
    for RateGroup { title, rows } in groups {
        let mut begun = false;
        for row in rows {
            let needed = lines_of(row) + if begun { 0 } else { title_lines(title).len() };
            if pages.last().is_none_or(|page| lines_on(page) + needed > ROWS) {
                pages.push(Vec::new());
                begun = false;
            }
            let Some(page) = pages.last_mut() else { continue };
            match page.last_mut().filter(|_| begun) {
                Some(group) => group.rows.push(row.clone()),
                None => page.push(RateGroup { title: title.clone(), rows: vec![row.clone()] }),
            }
            begun = true;
        }
    }
    pages
}

fn lines_on(page: &[RateGroup]) -> usize {
    page.iter().map(|group| title_lines(&group.title).len() + group.rows.iter().map(lines_of).sum::<usize>()).sum()
}

fn lines_of(row: &RateRow) -> usize {
    name_lines(row).len().max(1)
}

fn name_lines(row: &RateRow) -> Vec<String> {
    lines(&row.label, SMALL, NAME, 4)
}

fn title_lines(title: &str) -> Vec<String> {
    lines(title, LABEL * BOLD, COLUMN - 8.0, 3)
}

/// Draws each rate as a dot and its interval as a bar on an axis from 0 to 100 %, one column wide, with the
/// numbers beside it. Groups are set apart by their titles. The documents are the pages, at least one.
///
/// # Errors
/// An end of an interval that is not finite or not from 0 to 1, a rate outside its interval, more successes than trials.
pub fn rates(figure: &RatesFigure) -> Result<Vec<String>, FigureError> {
    check(figure)?;
    let pages = pages(&figure.groups);
    if pages.is_empty() {
        return Ok(vec![nothing_to_draw("nothing was tried")]);
    }
    pages.iter().map(|groups| page(groups, &figure.x_label)).collect()
}

fn page(groups: &[RateGroup], x_label: &str) -> Result<String, FigureError> {
    let rows = || groups.iter().flat_map(|group| &group.rows);
    let widest = rows().flat_map(name_lines).map(|line| width(&line, SMALL, false)).fold(0.0, f64::max);
    let title = Font::new(LABEL, Anchor::Start).bold();
    let titles = groups.iter().flat_map(|group| title_lines(&group.title)).map(|line| title.width(&line).min(NAME));
    let left = 4.0 + titles.fold(widest, f64::max) + 6.0;
    let top = 4.0;
    let rect = Rect::new(left, top, COLUMN - left - NUMBERS, height(groups));
    let x = Axis::stepped(0.0, 100.0, if rect.w > 110.0 { 20.0 } else { 50.0 });
    let chart = Chart { rect, x, y: blank(1.0), x_label: "", y_label: "", x_numbers: true };
    let mut svg = Svg::default();
    chart.draw(&mut svg, &[])?;
    let mut y = top;
    for group in groups {
        for line in title_lines(&group.title) {
            y += STEP;
            // On white, since a long one runs over the axis and its grid.
            svg.rect(&Rect::new(2.0, y - 8.5, title.width(&line) + 4.0, 11.0), 0.0, &Paint::fill("#FFFFFF"));
            svg.text(&line, (4.0, y), &title);
        }
        if !group.title.is_empty() {
            y += 2.0;
        }
        for row in &group.rows {
            let tall = row_height(lines_of(row));
            svg.open("rate", &row.label);
            draw_row(&mut svg, &chart, row, y + tall / 2.0);
            svg.close();
            y += tall;
        }
    }
    let (half, middle) = (width(x_label, LABEL, false) / 2.0, rect.x + rect.w / 2.0);
    let middle = middle.min(COLUMN - 2.0 - half).max(half + 2.0);
    svg.text(x_label, (middle, rect.bottom() + 23.0), &Font::new(LABEL, Anchor::Middle));
    Ok(svg.finish(COLUMN, rect.bottom() + 28.0))
}

fn draw_row(svg: &mut Svg, chart: &Chart, row: &RateRow, middle: f64) {
    let x = |rate: f64| chart.place(100.0 * rate, 0.0).0;
    let lines = name_lines(row);
    let first = middle + SMALL * 0.35 - (row_height(lines.len()) - STEP) / 2.0;
    for (i, line) in lines.iter().enumerate() {
        svg.text(line, (chart.rect.x - 6.0, first + LINE * i as f64), &Font::new(SMALL, Anchor::End));
    }
    if let Some((low, high)) = row.interval {
        svg.line((x(low), middle), (x(high), middle), &Paint::stroke(INK, DATA * 0.8));
        for end in [low, high] {
            svg.line((x(end), middle - 2.2), (x(end), middle + 2.2), &Paint::stroke(INK, DATA * 0.8));
        }
    }
    if let Some(rate) = row.rate() {
        svg.mark(Mark::Circle, (x(rate), middle), 2.4, &Paint::stroke(INK, THIN).filled(BLUE));
    }
    svg.text(&row.words(), (COLUMN - 3.0, middle + SMALL * 0.35), &Font::new(SMALL, Anchor::End));
}

fn row_height(lines: usize) -> f64 {
    STEP + LINE * lines.saturating_sub(1) as f64
}

fn height(groups: &[RateGroup]) -> f64 {
    let title = |group: &RateGroup| match title_lines(&group.title).len() {
        0 => 0.0,
        lines => STEP * lines as f64 + 2.0,
    };
    let rows = groups.iter().flat_map(|group| &group.rows);
    groups.iter().map(title).sum::<f64>() + rows.map(|row| row_height(lines_of(row))).sum::<f64>() + 3.0
}

fn check(figure: &RatesFigure) -> Result<(), FigureError> {
    let what = "rate of row";
    for (index, row) in figure.groups.iter().flat_map(|group| &group.rows).enumerate() {
        if row.successes > row.trials {
            return Err(FigureError::OutOfRange { what, index, expected: "of no more successes than trials" });
        }
        let Some((low, high)) = row.interval else { continue };
        finite(what, [low, high]).map_err(|e| e.within(what, index))?;
        within(what, [low, high], (0.0, 1.0), "from 0 to 1").map_err(|e| e.within(what, index))?;
        if row.rate().is_some_and(|rate| rate < low || rate > high) {
            return Err(FigureError::OutOfRange { what, index, expected: "within its interval" });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
