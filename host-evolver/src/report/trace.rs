//! A run of the swarm: where the robots went, and how well they surrounded the targets.

use super::axes::{Axis, Chart, Line};
use super::error::{FigureError, finite, finite_lines};
use super::map::{View, Window};
use super::pattern::mark_target;
use super::style::{
    DATA, GREEN, GREY, INK, LABEL, LIGHT, PAGE, SERIES, SMALL, THIN, WALL, time_colour,
};
use super::svg::{Anchor, Font, Key, Mark, Paint, Rect, Svg, legend, poly};
use super::text::width;

/// A robot at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Where it is, metres.
    pub position: [f64; 2],
    /// Where it looks, radians anticlockwise from the x axis.
    pub heading: f64,
}

/// A moment at which the map shows the swarm.
#[derive(Debug, Clone, PartialEq)]
pub struct Instant {
    /// Seconds from the start.
    pub time: f64,
    /// The robots.
    pub robots: Vec<Pose>,
    /// The targets, metres.
    pub targets: Vec<[f64; 2]>,
    /// The pattern: closed contours, metres.
    pub contours: Vec<Vec<[f64; 2]>>,
}

/// A run.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceFigure {
    /// The part of the world to show.
    pub window: Window,
    /// Obstacles, closed polygons, metres.
    pub walls: Vec<Vec<[f64; 2]>>,
    /// Paths of the targets, metres.
    pub target_paths: Vec<Vec<[f64; 2]>>,
    /// Paths of the robots, metres.
    pub trajectories: Vec<Vec<[f64; 2]>>,
    /// Radius of a robot, metres; drawn larger where it would be too small to see.
    pub body_radius: f64,
    /// The moments shown, in order of time.
    pub instants: Vec<Instant>,
    /// Times of the series below the map, seconds, increasing; at least two.
    pub times: Vec<f64>,
    /// For each target, at each time, the largest angle between neighbouring robots as the target sees them, degrees.
    pub gaps: Vec<Vec<f64>>,
    /// At each time, the median over robots of the distance to the pattern, metres.
    pub radial_error: Vec<f64>,
    /// What counts as on the pattern: 10 % of its radius, metres.
    pub radial_band: f64,
}

const GAP_LIMIT: f64 = 90.0;
const LEFT: f64 = 40.0;
const SEEN: f64 = 1.9;

/// Draws a run across the page: the map above, the largest angular gap and the radial error below.
///
/// # Errors
/// Nothing to draw, series of unequal length, numbers that are not finite, times that do not increase.
pub fn trace(figure: &TraceFigure) -> Result<String, FigureError> {
    check(figure)?;
    let mut svg = Svg::default();
    let room = (PAGE - LEFT - 6.0, 285.0);
    let shape = figure.window.height() / figure.window.width();
    let (w, h) = if shape * room.0 <= room.1 {
        (room.0, shape * room.0)
    } else {
        (room.1 / shape, room.1)
    };
    // A window that is much higher than wide is shown with more of the world beside it.
    let w = w.max(room.0 * 0.5);
    let view = View::new(
        &figure.window,
        Rect::new(LEFT + (room.0 - w) / 2.0, 4.0, w, h),
    );
    map(&mut svg, figure, &view);
    let mut base = view.rect.bottom() + 11.0;
    let x = view.scale_bar(&mut svg, LEFT, base, 60.0) + 16.0;
    let enlarged = figure.body_radius * view.scale < SEEN;
    (base, _) = legend(
        &mut svg,
        x,
        base,
        PAGE - 4.0,
        SMALL,
        &entries(figure, enlarged),
    );
    let names: Vec<String> = (1..=figure.gaps.len())
        .map(|i| format!("target {i}"))
        .collect();
    if names.len() > 1 {
        let keys: Vec<(Key, &str)> = names
            .iter()
            .enumerate()
            .map(|(i, name)| {
                let (colour, dash) = SERIES[i % SERIES.len()];
                (
                    Key::Line(Paint::stroke(colour, DATA).dashed(dash)),
                    name.as_str(),
                )
            })
            .collect();
        (base, _) = legend(&mut svg, LEFT, base + 14.0, PAGE - 4.0, SMALL, &keys);
    }
    let strip = |y: f64| Rect::new(LEFT, y, room.0, 62.0);
    let first = gap_chart(figure, strip(base + 8.0));
    let second = error_chart(figure, strip(first.rect.bottom() + 11.0));
    let series = |chart: &Chart, values: &[f64], i: usize| {
        let (colour, dash) = SERIES[i % SERIES.len()];
        let point = |(t, v): (&f64, &f64)| (*t, v.clamp(chart.y.lo, chart.y.hi));
        Line {
            points: figure.times.iter().zip(values).map(point).collect(),
            colour,
            width: 1.0,
            dash,
        }
    };
    let level = |chart: &Chart, value: f64| Line {
        points: vec![(chart.x.lo, value), (chart.x.hi, value)],
        colour: GREY,
        width: THIN,
        dash: &[3.0, 2.0],
    };
    let mut lines = vec![level(&first, GAP_LIMIT)];
    lines.extend(
        figure
            .gaps
            .iter()
            .enumerate()
            .map(|(i, values)| series(&first, values, i)),
    );
    moments(&mut svg, figure, &first);
    first.draw(&mut svg, &lines)?;
    moments(&mut svg, figure, &second);
    second.draw(
        &mut svg,
        &[
            level(&second, figure.radial_band),
            series(&second, &figure.radial_error, 0),
        ],
    )?;
    note(&mut svg, &first, GAP_LIMIT, "90°");
    note(&mut svg, &second, figure.radial_band, "10 % of the radius");
    Ok(svg.finish(PAGE, second.rect.bottom() + 28.0))
}

fn check(figure: &TraceFigure) -> Result<(), FigureError> {
    figure.window.check("window", 0)?;
    for (what, empty) in [
        (
            "robot trajectories",
            figure.trajectories.iter().all(Vec::is_empty),
        ),
        ("instants", figure.instants.is_empty()),
        ("angular gaps", figure.gaps.is_empty()),
    ] {
        if empty {
            return Err(FigureError::Empty { what });
        }
    }
    let expected = figure.times.len();
    for (what, values) in figure
        .gaps
        .iter()
        .map(|g| ("angular gap", g))
        .chain([("radial error", &figure.radial_error)])
    {
        if values.len() != expected {
            return Err(FigureError::Length {
                what,
                found: values.len(),
                expected,
            });
        }
        finite(what, values.iter().copied())?;
    }
    finite("time", figure.times.iter().copied())?;
    if expected < 2 {
        return Err(FigureError::Length {
            what: "times",
            found: expected,
            expected: 2,
        });
    }
    if let Some(i) = figure.times.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(FigureError::OutOfRange {
            what: "time",
            index: i + 1,
            expected: "later than the one before",
        });
    }
    finite("radius or band", [figure.body_radius, figure.radial_band])?;
    for (i, value) in [figure.body_radius, figure.radial_band]
        .into_iter()
        .enumerate()
    {
        if value < 0.0 {
            return Err(FigureError::OutOfRange {
                what: "radius or band",
                index: i,
                expected: "0 or more",
            });
        }
    }
    finite_lines("wall", &figure.walls)?;
    finite_lines("target path", &figure.target_paths)?;
    finite_lines("trajectory", &figure.trajectories)?;
    for (index, instant) in figure.instants.iter().enumerate() {
        let named = |_| FigureError::NotFinite {
            what: "instant",
            index,
        };
        let poses = instant
            .robots
            .iter()
            .flat_map(|r| [r.position[0], r.position[1], r.heading]);
        finite(
            "",
            poses
                .chain(instant.targets.iter().flatten().copied())
                .chain([instant.time]),
        )
        .map_err(named)?;
        finite_lines("", &instant.contours).map_err(named)?;
    }
    Ok(())
}

fn share(figure: &TraceFigure, time: f64) -> f64 {
    let times = || figure.instants.iter().map(|i| i.time);
    let (lo, hi) = (
        times().fold(f64::INFINITY, f64::min),
        times().fold(f64::NEG_INFINITY, f64::max),
    );
    if hi > lo {
        (time - lo) / (hi - lo)
    } else {
        0.0
    }
}

fn map(svg: &mut Svg, figure: &TraceFigure, view: &View) {
    svg.open("map", "");
    svg.open_clip(&view.rect);
    view.walls(svg, &figure.walls);
    let trajectories = view.path(&figure.trajectories, false);
    svg.path(&trajectories, &Paint::stroke("#BDBDBD", 0.35));
    let paths = view.path(&figure.target_paths, false);
    if !paths.is_empty() {
        svg.path(&paths, &Paint::stroke(INK, 0.6).dashed(&[2.5, 2.0]));
    }
    for instant in &figure.instants {
        let contours = view.path(&instant.contours, true);
        if !contours.is_empty() {
            svg.path(
                &contours,
                &Paint::stroke(&time_colour(share(figure, instant.time)), 0.9),
            );
        }
    }
    let mut taken: Vec<(Rect, f64)> = Vec::new();
    for instant in &figure.instants {
        let colour = time_colour(share(figure, instant.time));
        for robot in &instant.robots {
            let at = view.place(robot.position);
            let r = (figure.body_radius * view.scale).max(SEEN);
            let nose = (
                at.0 + 2.2 * r * libm::cos(robot.heading),
                at.1 - 2.2 * r * libm::sin(robot.heading),
            );
            svg.line(at, nose, &Paint::stroke(&colour, 0.8));
            svg.circle(at, r, &Paint::stroke("#FFFFFF", 0.3).filled(&colour));
            taken.push((Rect::new(at.0 - 5.0, at.1 - 5.0, 10.0, 10.0), 3.0));
        }
        for target in &instant.targets {
            let at = view.place(*target);
            mark_target(svg, at, true);
            taken.push((Rect::new(at.0 - 3.0, at.1 - 3.0, 6.0, 6.0), 3.0));
        }
        for point in instant.contours.iter().flatten() {
            let at = view.place(*point);
            taken.push((Rect::new(at.0 - 1.0, at.1 - 1.0, 2.0, 2.0), 2.0));
        }
    }
    for instant in &figure.instants {
        time_label(svg, figure, instant, view, &mut taken);
    }
    svg.close_clip();
    svg.rect(&view.rect, 0.0, &Paint::stroke(INK, THIN));
    svg.close();
}

/// Writes an instant's time beside its robots and pattern where there is room.
fn time_label(
    svg: &mut Svg,
    figure: &TraceFigure,
    instant: &Instant,
    view: &View,
    taken: &mut Vec<(Rect, f64)>,
) {
    let shapes = instant
        .contours
        .iter()
        .flatten()
        .chain(instant.robots.iter().map(|r| &r.position));
    let points: Vec<(f64, f64)> = shapes
        .chain(&instant.targets)
        .map(|p| view.place(*p))
        .collect();
    let (mut left, mut right, mut top, mut bottom) = (
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::INFINITY,
        f64::NEG_INFINITY,
    );
    for (x, y) in points {
        (left, right) = (left.min(x), right.max(x));
        (top, bottom) = (top.min(y), bottom.max(y));
    }
    if !left.is_finite() {
        return;
    }
    let words = format!("{} s", super::svg::num(instant.time));
    let (w, h) = (width(&words, LABEL, true) + 4.0, LABEL + 3.0);
    let (middle, centre) = ((left + right - w) / 2.0, (top + bottom - h) / 2.0);
    let mut best: Option<(f64, Rect)> = None;
    for (ring, gap) in [3.0, 9.0, 16.0, 26.0].into_iter().enumerate() {
        let around = [
            (middle, top - gap - h),
            (middle, bottom + gap),
            (left - gap - w, centre),
            (right + gap, centre),
            (right, top - gap - h),
            (left - w, top - gap - h),
            (right, bottom + gap),
            (left - w, bottom + gap),
        ];
        for (turn, (x, y)) in around.into_iter().enumerate() {
            let rect = Rect::new(x, y, w, h);
            let outside = if view.rect.holds(&rect) { 0.0 } else { 1e4 };
            let covered: f64 = taken
                .iter()
                .map(|(r, weight)| r.overlap(&rect) * weight)
                .sum();
            let cost = covered + outside + (ring * 8 + turn) as f64;
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, rect));
            }
        }
    }
    let Some((_, rect)) = best else { return };
    svg.rect(&rect, 2.0, &Paint::fill("#FFFFFF"));
    let font = Font::new(LABEL, Anchor::Middle)
        .bold()
        .colour(&time_colour(share(figure, instant.time)));
    svg.text(&words, (rect.x + w / 2.0, rect.bottom() - 2.8), &font);
    taken.push((rect, 20.0));
}

fn entries(figure: &TraceFigure, enlarged: bool) -> Vec<(Key, &'static str)> {
    let early = time_colour(0.0);
    let mut out = vec![
        (
            Key::Mark(Mark::Circle, SEEN, Paint::fill(&early)),
            if enlarged {
                "robot (enlarged)"
            } else {
                "robot"
            },
        ),
        (Key::Line(Paint::stroke("#BDBDBD", 0.6)), "robot path"),
    ];
    if figure.instants.iter().any(|i| !i.contours.is_empty()) {
        out.push((Key::Line(Paint::stroke(&early, 0.9)), "pattern"));
    }
    if figure.instants.iter().any(|i| !i.targets.is_empty()) {
        out.push((Key::Mark(Mark::Circle, 2.1, Paint::fill(GREEN)), "target"));
    }
    if !figure.target_paths.is_empty() {
        out.push((
            Key::Line(Paint::stroke(INK, 0.6).dashed(&[2.5, 2.0])),
            "target path",
        ));
    }
    if !figure.walls.is_empty() {
        out.push((Key::Area(Paint::stroke(GREY, 0.5).filled(WALL)), "wall"));
    }
    out
}

fn time_axis(figure: &TraceFigure) -> Axis {
    let first = figure.times.first().copied().unwrap_or(0.0);
    Axis::linear(first, figure.times.last().copied().unwrap_or(1.0), 10.0)
}

fn gap_chart(figure: &TraceFigure, rect: Rect) -> Chart {
    let most = figure.gaps.iter().flatten().copied().fold(0.0, f64::max);
    let top = [120.0, 180.0, 270.0, 360.0]
        .into_iter()
        .find(|t| most <= *t)
        .unwrap_or(360.0);
    let step = if top > 200.0 {
        90.0
    } else {
        30.0_f64.max(top / 4.0)
    };
    let y = Axis::stepped(0.0, top, step);
    Chart {
        rect,
        x: time_axis(figure),
        y,
        x_label: "",
        y_label: "Largest gap (°)",
        x_numbers: false,
    }
}

fn error_chart(figure: &TraceFigure, rect: Rect) -> Chart {
    let most = figure
        .radial_error
        .iter()
        .copied()
        .fold(figure.radial_band * 1.3, f64::max);
    let y = Axis::linear(0.0, if most > 0.0 { most * 1.05 } else { 1.0 }, 4.0);
    Chart {
        rect,
        x: time_axis(figure),
        y,
        x_label: "Time (s)",
        y_label: "Radial error (m)",
        x_numbers: true,
    }
}

/// Marks the moments that the map shows.
fn moments(svg: &mut Svg, figure: &TraceFigure, chart: &Chart) {
    for instant in &figure.instants {
        if instant.time < chart.x.lo || instant.time > chart.x.hi {
            continue;
        }
        let (x, y) = chart.place(instant.time, chart.y.hi);
        let colour = time_colour(share(figure, instant.time));
        svg.line((x, y), (x, chart.rect.bottom()), &Paint::stroke(LIGHT, 0.8));
        let head = [(x, y + 0.5), (x - 2.6, y - 4.0), (x + 2.6, y - 4.0)];
        svg.path(&poly(&head, true), &Paint::fill(&colour));
    }
}

/// Names a level at the right end of a chart.
fn note(svg: &mut Svg, chart: &Chart, value: f64, words: &str) {
    let (x, y) = chart.place(chart.x.hi, value);
    let w = width(words, SMALL, false);
    svg.rect(
        &Rect::new(x - w - 4.0, y - 9.4, w + 3.0, 8.4),
        0.0,
        &Paint::fill("#FFFFFF"),
    );
    svg.text(
        words,
        (x - 2.5, y - 2.6),
        &Font::new(SMALL, Anchor::End).colour(GREY),
    );
}

#[cfg(test)]
mod tests {
    use super::super::check::read;
    use super::*;

    fn figure() -> TraceFigure {
        let ring: Vec<[f64; 2]> = vec![[4.0, 9.0], [6.0, 9.0], [5.0, 11.0]];
        let instant = |time: f64| Instant {
            time,
            robots: vec![Pose {
                position: [4.0, 9.0],
                heading: 1.0,
            }],
            targets: vec![[5.0, 10.0]],
            contours: vec![ring.clone()],
        };
        TraceFigure {
            window: Window {
                min: [0.0, 5.0],
                max: [20.0, 15.0],
            },
            walls: vec![vec![[6.0, 14.0], [14.0, 14.0], [14.0, 20.0]]],
            target_paths: vec![vec![[3.0, 10.0], [17.0, 10.0]]],
            trajectories: vec![ring.clone()],
            body_radius: 0.035,
            instants: vec![instant(0.0), instant(40.0)],
            times: vec![0.0, 20.0, 40.0],
            gaps: vec![vec![300.0, 80.0, 60.0], vec![200.0, 100.0, 70.0]],
            radial_error: vec![0.8, 0.2, 0.05],
            radial_band: 0.12,
        }
    }

    #[test]
    fn map_and_strips_share_a_figure() {
        let svg = trace(&figure()).unwrap();
        assert_eq!(svg, trace(&figure()).unwrap());
        let document = read(&svg);
        for words in [
            "Time (s)",
            "Largest gap (°)",
            "Radial error (m)",
            "40 s",
            "robot (enlarged)",
            "target 2",
        ] {
            assert!(document.says(words), "{words}");
        }
        assert_eq!(document.count("class=\"map\""), 1);
    }

    #[test]
    fn bad_runs_are_refused() {
        let refused = |change: &dyn Fn(&mut TraceFigure)| {
            let mut bad = figure();
            change(&mut bad);
            trace(&bad).unwrap_err()
        };
        assert_eq!(
            refused(&|f| f.instants.clear()),
            FigureError::Empty { what: "instants" }
        );
        assert_eq!(
            refused(&|f| f.gaps[1][2] = f64::NAN),
            FigureError::NotFinite {
                what: "angular gap",
                index: 2
            }
        );
        let expected = FigureError::NotFinite {
            what: "instant",
            index: 1,
        };
        assert_eq!(
            refused(&|f| f.instants[1].robots[0].heading = f64::INFINITY),
            expected
        );
        assert!(matches!(
            refused(&|f| f.times[1] = 40.0),
            FigureError::OutOfRange { index: 2, .. }
        ));
        assert!(matches!(
            refused(&|f| f.radial_error.truncate(2)),
            FigureError::Length {
                found: 2,
                expected: 3,
                ..
            }
        ));
    }
}
