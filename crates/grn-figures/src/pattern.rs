//! The pattern along the targets' path, one small map for each moment.

use crate::canvas::error::{FigureError, finite, finite_lines};
use crate::canvas::note::nothing_to_draw;
use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::style::{BLUE, BLUE_TINT, COLUMN, GREEN, GREY, LABEL, PAGE, PAGE_HEIGHT, SMALL, VERMILLION};
use crate::canvas::svg::Svg;
use crate::canvas::text::{lines, width};
use crate::chart::legend::{Key, legend};
use crate::chart::map::{View, Window, frame_look, wall_look};

/// A target of the swarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Where it is, metres.
    pub position: [f64; 2],
    /// Whether a closed contour surrounds it.
    pub enclosed: bool,
}

/// One moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// What stands after its letter, such as `t = 3 s`.
    pub title: String,
    /// The part of the world to show; the figure's region if none.
    pub window: Option<Window>,
    /// Obstacles, closed polygons, metres.
    pub walls: Vec<Vec<[f64; 2]>>,
    /// The targets.
    pub targets: Vec<Target>,
    /// The pattern: closed contours, metres.
    pub contours: Vec<Vec<[f64; 2]>>,
    /// Level lines that leave the world or meet a wall: open, metres.
    pub leak_outlines: Vec<Vec<[f64; 2]>>,
    /// Candidate points on the pattern, metres; may be empty.
    pub candidates: Vec<[f64; 2]>,
}

/// Moments that share a world.
#[derive(Debug, Clone, PartialEq)]
pub struct PatternFigure {
    /// The world.
    pub region: Window,
    /// Paths of the targets, thin and dashed in every panel, metres; may be empty.
    pub paths: Vec<Vec<[f64; 2]>>,
    /// The moments in order.
    pub panels: Vec<Panel>,
    /// Panels a row; chosen if none.
    pub columns: Option<usize>,
}

const GAP: f64 = 8.0;
const CAPTION: f64 = 12.0;

/// Draws the moments in rows, (a), (b), (c), …, all to one scale unless their windows differ in size. The figure is as
/// high as it takes; 25 moments fill a page.
///
/// # Errors
/// Coordinates that are not finite, a region or window that is none.
pub fn pattern(figure: &PatternFigure) -> Result<String, FigureError> {
    check(figure)?;
    if figure.panels.is_empty() {
        return Ok(nothing_to_draw("there is no moment to show"));
    }
    let windows: Vec<Window> = figure.panels.iter().map(|p| p.window.unwrap_or(figure.region)).collect();
    let shape = windows.iter().map(|w| w.height() / w.width()).fold(0.0, f64::max).clamp(0.3, 1.5);
    let count = figure.panels.len();
    let columns = figure.columns.map_or_else(|| columns(count, shape), |c| c.clamp(1, 6)).min(count);
    let total = if columns == 1 { COLUMN } else { PAGE };
    let w = (total - 2.0 - GAP * (columns - 1) as f64) / columns as f64;
    let h = w * shape;
    let views: Vec<View> = windows
        .iter()
        .enumerate()
        .map(|(i, window)| {
            let (row, column) = ((i / columns) as f64, (i % columns) as f64);
            let at = (1.0 + column * (w + GAP), CAPTION + row * (h + CAPTION + GAP * 0.6));
            View::new(window, Rect::new(at.0, at.1, w, h))
        })
        .collect();
    let one_scale = views.iter().all(|v| (v.scale - views[0].scale).abs() < 1e-6 * views[0].scale);
    let mut svg = Svg::default();
    for (i, (panel, view)) in figure.panels.iter().zip(&views).enumerate() {
        draw_panel(&mut svg, figure, panel, view, i, !one_scale);
    }
    let rows = count.div_ceil(columns) as f64;
    let mut base = rows * (h + CAPTION + GAP * 0.6) + 7.0;
    let mut x = 3.0;
    if one_scale {
        x = views[0].scale_bar(&mut svg, x, base, 60.0) + 16.0;
    }
    (base, _) = legend(&mut svg, x, base, total - 2.0, SMALL, &entries(figure));
    Ok(svg.finish(total, base + 6.0))
}

fn check(figure: &PatternFigure) -> Result<(), FigureError> {
    figure.region.check("region", 0)?;
    finite_lines("path", &figure.paths)?;
    for (index, panel) in figure.panels.iter().enumerate() {
        panel.window.map_or(Ok(()), |w| w.check("window of panel", index))?;
        let in_panel = |e: FigureError| e.within("a coordinate of panel", index);
        for lines in [&panel.walls, &panel.contours, &panel.leak_outlines] {
            finite_lines("", lines).map_err(in_panel)?;
        }
        finite("", panel.targets.iter().flat_map(|t| t.position)).map_err(in_panel)?;
        finite("", panel.candidates.iter().flatten().copied()).map_err(in_panel)?;
    }
    Ok(())
}

/// Panels a row: as few empty places as can be had on as little of a page.
fn columns(count: usize, shape: f64) -> usize {
    if count <= 3 {
        return count;
    }
    let cost = |c: usize| {
        let w = (PAGE - GAP * (c as f64 - 1.0)) / c as f64;
        let rows = count.div_ceil(c);
        let height = rows as f64 * (w * shape + CAPTION + GAP);
        let too_high = if height > PAGE_HEIGHT { 100.0 } else { 0.0 };
        (c * rows - count) as f64 + height / 200.0 + too_high
    };
    (3..=5).rev().min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap_or(5)
}

/// a, b, …, z, aa, ab, ….
fn letters(index: usize) -> String {
    let last = char::from(b'a' + (index % 26) as u8);
    match index / 26 {
        0 => last.to_string(),
        before => letters(before - 1) + &last.to_string(),
    }
}

fn draw_panel(svg: &mut Svg, figure: &PatternFigure, panel: &Panel, view: &View, index: usize, own_bar: bool) {
    let rect = view.rect;
    let letter = format!("({})", letters(index));
    svg.open("panel", &format!("{letter} {}", panel.title));
    svg.open_clip(&rect);
    view.walls(svg, &panel.walls);
    let paths = view.path(&figure.paths, false);
    if !paths.is_empty() {
        svg.path(&paths, &Paint::stroke(GREY, 0.5).dashed(&[2.0, 1.6]));
    }
    let contours = view.path(&panel.contours, true);
    if !contours.is_empty() {
        svg.path(&contours, &ring());
    }
    let leaks = view.path(&panel.leak_outlines, false);
    if !leaks.is_empty() {
        svg.path(&leaks, &leak());
    }
    for point in &panel.candidates {
        svg.circle(view.place(*point), 0.9, &Paint::fill(BLUE));
    }
    for target in &panel.targets {
        mark_target(svg, view.place(target.position), target.enclosed);
    }
    svg.close_clip();
    svg.rect(&rect, 0.0, &frame_look());
    let base = rect.y - 3.2;
    let font = Font::new(LABEL, Anchor::Start);
    svg.text(&letter, (rect.x, base), &font.clone().bold());
    let x = rect.x + width(&letter, LABEL, true) + 3.0;
    let bar = if own_bar { view.scale_bar_width(24.0) + 4.0 } else { 0.0 };
    let title = lines(&panel.title, LABEL, (rect.right() - bar - x).max(LABEL), 1).concat();
    svg.text(&title, (x, base), &font);
    if own_bar {
        let bar = view.scale_bar_width(24.0);
        view.scale_bar(svg, rect.right() - bar, base, 24.0);
    }
    svg.close();
}

fn ring() -> Paint {
    Paint::stroke(BLUE, 1.0).filled(BLUE_TINT)
}

fn leak() -> Paint {
    Paint::stroke(VERMILLION, 1.1).dashed(&[3.2, 1.6])
}

/// An enclosed target is a green disc, one that is not a vermillion cross in a ring.
fn mark_target(svg: &mut Svg, at: (f64, f64), enclosed: bool) {
    if enclosed {
        svg.circle(at, 2.1, &Paint::stroke("#FFFFFF", 0.5).filled(GREEN));
    } else {
        svg.mark(Mark::RingedCross, at, 2.1, &Paint::stroke(VERMILLION, 1.2));
    }
}

fn entries(figure: &PatternFigure) -> Vec<(Key, &'static str)> {
    let any = |what: &dyn Fn(&Panel) -> bool| figure.panels.iter().any(what);
    let mut out = Vec::new();
    if any(&|p| !p.contours.is_empty()) {
        out.push((Key::Area(ring()), "pattern"));
    }
    if any(&|p| !p.candidates.is_empty()) {
        out.push((Key::Mark(Mark::Circle, 0.9, Paint::fill(BLUE)), "candidate point"));
    }
    if any(&|p| p.targets.iter().any(|t| t.enclosed)) {
        out.push((Key::Mark(Mark::Circle, 2.1, Paint::fill(GREEN)), "target, enclosed"));
    }
    if any(&|p| p.targets.iter().any(|t| !t.enclosed)) {
        let cross = Paint::stroke(VERMILLION, 1.2);
        out.push((Key::Mark(Mark::RingedCross, 1.7, cross), "target, not enclosed"));
    }
    if any(&|p| !p.leak_outlines.is_empty()) {
        out.push((Key::Line(leak()), "leak"));
    }
    if !figure.paths.is_empty() {
        out.push((Key::Line(Paint::stroke(GREY, 0.6).dashed(&[2.0, 1.6])), "target path"));
    }
    if any(&|p| !p.walls.is_empty()) {
        out.push((Key::Area(wall_look()), "wall"));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::check::read;

    fn figure(count: usize) -> PatternFigure {
        let panel = |i: usize| Panel {
            title: format!("t < {i} s"),
            walls: vec![vec![[6.0, 14.0], [14.0, 14.0], [14.0, 20.0]]],
            targets: vec![Target { position: [i as f64, 10.0], enclosed: i.is_multiple_of(2) }],
            contours: vec![vec![[1.0, 9.0], [3.0, 9.0], [2.0, 11.0]]],
            ..Panel::default()
        };
        PatternFigure {
            region: Window { min: [0.0, 0.0], max: [20.0, 20.0] },
            paths: vec![vec![[3.0, 10.0], [17.0, 10.0]]],
            panels: (0..count).map(panel).collect(),
            columns: None,
        }
    }

    #[test]
    fn every_panel_is_drawn() {
        for count in [1, 2, 7, 25, 60] {
            let svg = pattern(&figure(count)).unwrap();
            assert_eq!(svg, pattern(&figure(count)).unwrap());
            let document = read(&svg);
            assert_eq!(document.count("class=\"panel\""), count);
            assert!(document.says("(a)") && document.says(&format!("t < {} s", count - 1)));
            assert!(document.texts.iter().any(|t| t.ends_with(" m")), "a scale bar");
            assert_eq!(document.says("target, not enclosed"), count > 1);
        }
    }

    #[test]
    fn rows_are_full_and_fit_the_page() {
        let chosen = [4, 5, 6, 8, 9, 15, 16, 20, 25].map(|count| columns(count, 1.0));
        assert_eq!(chosen, [4, 5, 3, 4, 5, 5, 4, 5, 5]);
    }

    #[test]
    fn windows_of_other_sizes_bring_their_own_bar() {
        let mut two = figure(2);
        two.panels[1].window = Some(Window { min: [4.0, 8.0], max: [8.0, 12.0] });
        let bars = read(&pattern(&two).unwrap()).texts.iter().filter(|t| t.ends_with(" m")).count();
        assert_eq!(bars, 2);
    }

    #[test]
    fn moments_are_lettered_without_end_and_none_is_said() {
        assert_eq!([0, 25, 26, 51, 52].map(letters), ["a", "z", "aa", "az", "ba"]);
        assert!(read(&pattern(&figure(0)).unwrap()).texts.concat().starts_with("Nothing to draw"));
    }

    #[test]
    fn bad_figures_are_refused() {
        let mut bad = figure(3);
        bad.panels[2].contours[0][1][0] = f64::NAN;
        let expected = FigureError::NotFinite { what: "a coordinate of panel", index: 2 };
        assert_eq!(pattern(&bad), Err(expected));
        bad.region.max[0] = -1.0;
        assert!(matches!(pattern(&bad), Err(FigureError::OutOfRange { what: "region", .. })));
    }
}
