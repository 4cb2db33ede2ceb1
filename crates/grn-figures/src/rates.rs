//! Success rates with their intervals.

use crate::canvas::error::{FigureError, finite, within};
use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::style::{BLUE, COLUMN, DATA, INK, LABEL, SMALL, THIN};
use crate::canvas::svg::Svg;
use crate::canvas::text::{width, wrap};
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

/// A rate and its interval.
#[derive(Debug, Clone, PartialEq)]
pub struct RateRow {
    /// What succeeds.
    pub label: String,
    /// The rate, from 0 to 1.
    pub rate: f64,
    /// The ends of its interval of 95 %, from 0 to 1, around the rate.
    pub interval: (f64, f64),
}

impl RatesFigure {
    /// The same on as many pages as it takes, none for no rows; a group that goes on overleaf keeps its title.
    #[must_use]
    pub fn pages(self) -> Vec<RatesFigure> {
        let mut pages: Vec<RatesFigure> = Vec::new();
        for RateGroup { title, rows } in self.groups {
            let mut begun = false;
            for row in rows {
                let needed = lines_of(&row) + usize::from(!begun && !title.is_empty());
                if pages.last().is_none_or(|page| page.lines() + needed > ROWS) {
                    pages.push(RatesFigure { groups: Vec::new(), x_label: self.x_label.clone() });
                    begun = false;
                }
                let Some(RatesFigure { groups, .. }) = pages.last_mut() else { continue };
                match groups.last_mut().filter(|_| begun) {
                    Some(group) => group.rows.push(row),
                    None => groups.push(RateGroup { title: title.clone(), rows: vec![row] }),
                }
                begun = true;
            }
        }
        pages
    }

    fn lines(&self) -> usize {
        let lines =
            |group: &RateGroup| usize::from(!group.title.is_empty()) + group.rows.iter().map(lines_of).sum::<usize>();
        self.groups.iter().map(lines).sum()
    }
}

fn lines_of(row: &RateRow) -> usize {
    wrap(&row.label, SMALL, NAME).len().max(1)
}

/// Draws each rate as a dot and its interval as a bar on an axis from 0 to 100 %, one column wide, with the
/// numbers beside it. Groups are set apart by their titles.
///
/// # Errors
/// No group, no row in a group; a rate or an end that is not finite or not from 0 to 1, a rate outside its
/// interval; more than 44 rows and titles.
pub fn rates(figure: &RatesFigure) -> Result<String, FigureError> {
    check(figure)?;
    let rows = || figure.groups.iter().flat_map(|group| &group.rows);
    let lines = |row: &RateRow| wrap(&row.label, SMALL, NAME);
    let widest = rows().flat_map(lines).map(|line| width(&line, SMALL, false)).fold(0.0, f64::max);
    let title = Font::new(LABEL, Anchor::Start).bold();
    let titles = figure.groups.iter().map(|group| title.width(&group.title).min(NAME));
    let left = 4.0 + titles.fold(widest, f64::max) + 6.0;
    let top = 4.0;
    let rect = Rect::new(left, top, COLUMN - left - NUMBERS, height(figure));
    let x = Axis::stepped(0.0, 100.0, if rect.w > 110.0 { 20.0 } else { 50.0 });
    let chart = Chart { rect, x, y: blank(1.0), x_label: "", y_label: "", x_numbers: true };
    let mut svg = Svg::default();
    chart.draw(&mut svg, &[])?;
    let mut y = top;
    for group in &figure.groups {
        if !group.title.is_empty() {
            y += STEP;
            // On white, since a long one runs over the axis and its grid.
            let w = title.width(&group.title);
            svg.rect(&Rect::new(2.0, y - 8.5, w + 4.0, 11.0), 0.0, &Paint::fill("#FFFFFF"));
            svg.text(&group.title, (4.0, y), &title);
            y += 2.0;
        }
        for row in &group.rows {
            let lines = lines(row);
            let tall = row_height(lines.len());
            svg.open("rate", &row.label);
            draw_row(&mut svg, &chart, row, &lines, y + tall / 2.0);
            svg.close();
            y += tall;
        }
    }
    let middle = rect.x + rect.w / 2.0;
    svg.text(&figure.x_label, (middle, rect.bottom() + 23.0), &Font::new(LABEL, Anchor::Middle));
    Ok(svg.finish(COLUMN, rect.bottom() + 28.0))
}

fn draw_row(svg: &mut Svg, chart: &Chart, row: &RateRow, lines: &[String], middle: f64) {
    let x = |rate: f64| chart.place(100.0 * rate, 0.0).0;
    let first = middle + SMALL * 0.35 - (row_height(lines.len()) - STEP) / 2.0;
    for (i, line) in lines.iter().enumerate() {
        svg.text(line, (chart.rect.x - 6.0, first + LINE * i as f64), &Font::new(SMALL, Anchor::End));
    }
    let (low, high) = row.interval;
    svg.line((x(low), middle), (x(high), middle), &Paint::stroke(INK, DATA * 0.8));
    for end in [low, high] {
        svg.line((x(end), middle - 2.2), (x(end), middle + 2.2), &Paint::stroke(INK, DATA * 0.8));
    }
    svg.mark(Mark::Circle, (x(row.rate), middle), 2.4, &Paint::stroke(INK, THIN).filled(BLUE));
    let percent = |rate: f64| format!("{:.0}", 100.0 * rate);
    let words = format!("{} % ({}–{})", percent(row.rate), percent(low), percent(high));
    svg.text(&words, (COLUMN - 3.0, middle + SMALL * 0.35), &Font::new(SMALL, Anchor::End));
}

fn row_height(lines: usize) -> f64 {
    STEP + LINE * lines.saturating_sub(1) as f64
}

fn height(figure: &RatesFigure) -> f64 {
    let title = |group: &RateGroup| if group.title.is_empty() { 0.0 } else { STEP + 2.0 };
    let rows = figure.groups.iter().flat_map(|group| &group.rows);
    let rows: f64 = rows.map(|row| row_height(wrap(&row.label, SMALL, NAME).len())).sum();
    figure.groups.iter().map(title).sum::<f64>() + rows + 3.0
}

fn check(figure: &RatesFigure) -> Result<(), FigureError> {
    if figure.groups.is_empty() {
        return Err(FigureError::Empty { what: "groups" });
    }
    if figure.groups.iter().any(|group| group.rows.is_empty()) {
        return Err(FigureError::Empty { what: "rows in a group" });
    }
    let rows = || figure.groups.iter().flat_map(|group| &group.rows);
    for (index, row) in rows().enumerate() {
        let (what, shares) = ("rate of row", [row.rate, row.interval.0, row.interval.1]);
        finite(what, shares).map_err(|e| e.within(what, index))?;
        within(what, shares, (0.0, 1.0), "from 0 to 1").map_err(|e| e.within(what, index))?;
    }
    let outside = |row: &RateRow| row.rate < row.interval.0 || row.rate > row.interval.1;
    if let Some(index) = rows().position(outside) {
        return Err(FigureError::OutOfRange { what: "rate of row", index, expected: "within its interval" });
    }
    let found = figure.lines();
    if found > ROWS { Err(FigureError::TooMany { what: "rows", found, limit: ROWS }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::style::PAGE_HEIGHT;
    use crate::chart::check::read;

    fn row(label: &str, rate: f64, interval: (f64, f64)) -> RateRow {
        RateRow { label: label.to_owned(), rate, interval }
    }

    fn figure() -> RatesFigure {
        let rows = vec![row("EH-GRN, structure 1", 0.5, (0.25, 0.75)), row("<a> & b", 1.0, (0.887, 1.0))];
        let first = RateGroup { title: "Compound channel".into(), rows };
        let second = RateGroup { title: String::new(), rows: vec![row("", 0.0, (0.0, 0.1))] };
        RatesFigure { groups: vec![first, second], x_label: "Success rate (%)".into() }
    }

    #[test]
    fn rates_are_written_and_stand_on_the_axis() {
        let svg = rates(&figure()).unwrap();
        assert_eq!(svg, rates(&figure()).unwrap());
        let document = read(&svg);
        for words in ["EH-GRN, structure 1", "50 % (25–75)", "100 % (89–100)", "0 % (0–10)", "Compound channel"] {
            assert!(document.says(words), "{words}");
        }
        assert_eq!(document.count("class=\"rate\""), 3);
        let dots: Vec<f64> = document
            .tags
            .iter()
            .filter_map(|tag| tag.strip_prefix("circle cx=\""))
            .map(|tag| tag.split('"').next().unwrap().parse().unwrap())
            .collect();
        let [half, all, none] = dots[..] else { panic!("{dots:?}") };
        assert!((all - (COLUMN - NUMBERS)).abs() < 0.02, "100 % is at the axis's end");
        assert!((half - (all + none) / 2.0).abs() < 0.02);
    }

    #[test]
    fn a_full_figure_fits_on_a_page() {
        let rows = vec![row("a", 0.5, (0.4, 0.6)); ROWS - 1];
        let group = RateGroup { title: "b".into(), rows };
        let mut figure = RatesFigure { groups: vec![group], x_label: String::new() };
        assert!(height(&figure) + 32.0 <= PAGE_HEIGHT);
        read(&rates(&figure).unwrap());
        figure.groups[0].rows.push(row("a", 0.5, (0.4, 0.6)));
        assert_eq!(rates(&figure), Err(FigureError::TooMany { what: "rows", found: ROWS + 1, limit: ROWS }));
    }

    #[test]
    fn what_is_too_much_for_a_page_goes_on_overleaf() {
        let group = |title: &str, count: usize| RateGroup {
            title: title.into(),
            rows: (0..count).map(|index| row(&format!("{title}{index}"), 0.5, (0.4, 0.6))).collect(),
        };
        let groups = vec![group("a", 30), group("b", 13), group("c", 60)];
        let figure = RatesFigure { groups: groups.clone(), x_label: "%".into() };
        let pages = figure.pages();
        let titles = |page: &RatesFigure| page.groups.iter().map(|group| group.title.clone()).collect::<Vec<_>>();
        assert_eq!(pages.iter().map(titles).collect::<Vec<_>>(), [vec!["a", "b"], vec!["b", "c"], vec!["c"]]);
        for page in &pages {
            read(&rates(page).unwrap());
        }
        let rows = |groups: Vec<RateGroup>| groups.into_iter().flat_map(|group| group.rows).collect::<Vec<_>>();
        assert_eq!(pages.into_iter().flat_map(|page| rows(page.groups)).collect::<Vec<_>>(), rows(groups));
        assert!(RatesFigure { groups: Vec::new(), x_label: String::new() }.pages().is_empty());
    }

    #[test]
    fn bad_data_is_named() {
        let change = |edit: fn(&mut RatesFigure)| {
            let mut figure = figure();
            edit(&mut figure);
            rates(&figure)
        };
        assert_eq!(change(|f| f.groups.clear()), Err(FigureError::Empty { what: "groups" }));
        assert_eq!(change(|f| f.groups[1].rows.clear()), Err(FigureError::Empty { what: "rows in a group" }));
        let nan = change(|f| f.groups[1].rows[0].rate = f64::NAN);
        assert_eq!(nan, Err(FigureError::NotFinite { what: "rate of row", index: 2 }));
        let percent = change(|f| f.groups[0].rows[1].interval.1 = 100.0);
        assert_eq!(percent, Err(FigureError::OutOfRange { what: "rate of row", index: 1, expected: "from 0 to 1" }));
        let outside = change(|f| f.groups[0].rows[0].rate = 0.1);
        assert!(matches!(outside, Err(FigureError::OutOfRange { index: 0, expected: "within its interval", .. })));
    }
}
