//! The map of a run.

use crate::canvas::format::num;
use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::style::{INK, LABEL, LIGHT, time_colour};
use crate::canvas::svg::Svg;
use crate::chart::legend::Key;
use crate::chart::map::{View, frame_look, wall_look};
use crate::chart::place::Taken;
use crate::trace::data::{Instant, TraceFigure};

/// The least radius at which a robot is drawn, points.
pub(crate) const SEEN: f64 = 1.9;

/// Where a time lies between the first and the last instant, from 0 to 1.
pub(crate) fn share(figure: &TraceFigure, time: f64) -> f64 {
    let times = || figure.instants.iter().map(|i| i.time);
    let (lo, hi) = (times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max));
    if hi > lo { (time - lo) / (hi - lo) } else { 0.0 }
}

/// The dashes of a pattern that is drawn this many instants before the last: the last is a whole line, earlier ones are
/// more and more broken.
fn age(later: usize) -> &'static [f64] {
    match later {
        0 => &[],
        1 => &[6.0, 1.5],
        2 => &[3.5, 1.5],
        3 => &[2.0, 1.5],
        _ => &[0.9, 1.4],
    }
}

/// How a target looks: unlike a robot in shape and lightness, whatever its colour.
fn target_look() -> (Mark, f64, Paint) {
    (Mark::Diamond, 2.6, Paint::stroke(INK, 0.9).filled("#FFFFFF"))
}

/// Draws the map.
pub(crate) fn map(svg: &mut Svg, figure: &TraceFigure, view: &View) {
    svg.open("map", "");
    svg.open_clip(&view.rect);
    view.walls(svg, &figure.walls);
    for instant in &figure.instants {
        let moving = view.path(&instant.walls, true);
        if !moving.is_empty() {
            let colour = time_colour(share(figure, instant.time));
            svg.path(&moving, &Paint::stroke(&colour, 0.9).filled(LIGHT));
        }
    }
    let trajectories = view.path(&figure.trajectories, false);
    svg.path(&trajectories, &Paint::stroke("#BDBDBD", 0.35));
    let paths = view.path(&figure.target_paths, false);
    if !paths.is_empty() {
        svg.path(&paths, &Paint::stroke(INK, 0.6).dashed(&[2.5, 2.0]));
    }
    for (place, instant) in figure.instants.iter().enumerate() {
        let contours = view.path(&instant.contours, true);
        if !contours.is_empty() {
            let colour = time_colour(share(figure, instant.time));
            svg.path(&contours, &Paint::stroke(&colour, 0.9).dashed(age(figure.instants.len() - 1 - place)));
        }
    }
    let mut taken = Taken::new(view.rect);
    for instant in &figure.instants {
        let colour = time_colour(share(figure, instant.time));
        for robot in &instant.robots {
            let at = view.place(robot.position);
            let r = (figure.body_radius * view.scale).max(SEEN);
            let nose = (at.0 + 2.2 * r * libm::cos(robot.heading), at.1 - 2.2 * r * libm::sin(robot.heading));
            svg.line(at, nose, &Paint::stroke(&colour, 0.8));
            svg.circle(at, r, &Paint::stroke("#FFFFFF", 0.3).filled(&colour));
            taken.add_mark(at, 3.5, 3.0);
            taken.add_line(at, nose, 3.0);
        }
        for target in &instant.targets {
            let at = view.place(*target);
            let (mark, r, paint) = target_look();
            svg.mark(mark, at, r, &paint);
            taken.add_mark(at, 3.0, 3.0);
        }
        for point in instant.contours.iter().flatten() {
            let at = view.place(*point);
            taken.add_mark(at, 1.0, 2.0);
        }
        for wall in &instant.walls {
            let corners: Vec<(f64, f64)> = wall.iter().map(|corner| view.place(*corner)).collect();
            let next = corners.iter().skip(1).chain(corners.first());
            corners.iter().zip(next).for_each(|(from, to)| taken.add_line(*from, *to, 2.0));
        }
    }
    for instant in &figure.instants {
        time_label(svg, figure, instant, view, &mut taken);
    }
    svg.close_clip();
    svg.rect(&view.rect, 0.0, &frame_look());
    svg.close();
}

/// Writes an instant's time beside its robots and pattern where there is room.
fn time_label(svg: &mut Svg, figure: &TraceFigure, instant: &Instant, view: &View, taken: &mut Taken) {
    let shapes = instant.contours.iter().flatten().chain(instant.robots.iter().map(|r| &r.position));
    let points: Vec<(f64, f64)> = shapes.chain(&instant.targets).map(|p| view.place(*p)).collect();
    let (mut left, mut right, mut top, mut bottom) =
        (f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY);
    for (x, y) in points {
        (left, right) = (left.min(x), right.max(x));
        (top, bottom) = (top.min(y), bottom.max(y));
    }
    if !left.is_finite() {
        return;
    }
    let words = format!("{} s", num(instant.time));
    let font = Font::new(LABEL, Anchor::Middle).bold().colour(&time_colour(share(figure, instant.time)));
    let (w, h) = (font.width(&words) + 4.0, LABEL + 3.0);
    let (middle, centre) = ((left + right - w) / 2.0, (top + bottom - h) / 2.0);
    // In line with the middle if at all possible: there it is plain what the words belong to.
    let around = |gap: f64| {
        [
            (middle, top - gap - h, 0.0),
            (middle, bottom + gap, 1.0),
            (left - gap - w, centre, 12.0),
            (right + gap, centre, 12.0),
            (right, top - gap - h, 40.0),
            (left - w, top - gap - h, 40.0),
            (right, bottom + gap, 41.0),
            (left - w, bottom + gap, 41.0),
        ]
    };
    let places = [2.0, 5.0, 9.0, 16.0, 26.0]
        .into_iter()
        .flat_map(|gap| around(gap).map(|(x, y, cost)| (Rect::new(x, y, w, h), cost + gap)));
    let Some(rect) = taken.cheapest(places) else {
        return;
    };
    svg.rect(&rect, 2.0, &Paint::fill("#FFFFFF"));
    svg.text(&words, (rect.x + w / 2.0, rect.bottom() - 2.8), &font);
    taken.add(rect, 20.0);
}

/// What its legend says.
pub(crate) fn entries(figure: &TraceFigure, enlarged: bool) -> Vec<(Key, &'static str)> {
    let early = time_colour(0.0);
    let mut out = vec![
        (Key::Mark(Mark::Circle, SEEN, Paint::fill(&early)), if enlarged { "robot (enlarged)" } else { "robot" }),
        (Key::Line(Paint::stroke("#BDBDBD", 0.6)), "robot path"),
    ];
    if figure.instants.iter().any(|i| !i.contours.is_empty()) {
        out.push((Key::Line(Paint::stroke(INK, 0.9)), "pattern (dashed: earlier)"));
    }
    if figure.instants.iter().any(|i| !i.targets.is_empty()) {
        let (mark, r, paint) = target_look();
        out.push((Key::Mark(mark, r, paint), "target"));
    }
    if !figure.target_paths.is_empty() {
        out.push((Key::Line(Paint::stroke(INK, 0.6).dashed(&[2.5, 2.0])), "target path"));
    }
    if !figure.walls.is_empty() {
        out.push((Key::Area(wall_look()), "wall"));
    }
    if figure.instants.iter().any(|i| !i.walls.is_empty()) {
        out.push((Key::Area(Paint::stroke(&early, 0.9).filled(LIGHT)), "wall that moves or goes"));
    }
    out
}
