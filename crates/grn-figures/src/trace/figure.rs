//! A run of the swarm: where the robots went, and how well they surrounded the targets.

use crate::canvas::error::{FigureError, finite, finite_lines, within};
use crate::canvas::paint::{Paint, Rect};
use crate::canvas::style::{DATA, PAGE, SERIES, SMALL};
use crate::canvas::svg::Svg;
use crate::chart::legend::{Key, legend};
use crate::chart::map::View;
use crate::trace::data::TraceFigure;
use crate::trace::map::{SEEN, entries, map};
use crate::trace::strips::strips;

const LEFT: f64 = 40.0;

/// Draws a run across the page: the map above, the largest angular gap and the radial error below.
///
/// # Errors
/// Nothing to draw, series of unequal length, numbers that are not finite, times that do not increase.
pub fn trace(figure: &TraceFigure) -> Result<String, FigureError> {
    check(figure)?;
    let mut svg = Svg::default();
    let room = (PAGE - LEFT - 9.0, 285.0);
    let shape = figure.window.height() / figure.window.width();
    let (w, h) = if shape * room.0 <= room.1 { (room.0, shape * room.0) } else { (room.1 / shape, room.1) };
    // A window that is much higher than wide is shown with more of the world beside it.
    let w = w.max(room.0 * 0.5);
    let view = View::new(&figure.window, Rect::new(LEFT + (room.0 - w) / 2.0, 4.0, w, h));
    map(&mut svg, figure, &view);
    let mut base = view.rect.bottom() + 11.0;
    let x = view.scale_bar(&mut svg, LEFT, base, 60.0) + 16.0;
    let enlarged = figure.body_radius * view.scale < SEEN;
    (base, _) = legend(&mut svg, x, base, PAGE - 4.0, SMALL, &entries(figure, enlarged));
    let names: Vec<String> = (1..=figure.gaps.len()).map(|i| format!("target {i}")).collect();
    if names.len() > 1 {
        let keys: Vec<(Key, &str)> = names
            .iter()
            .enumerate()
            .map(|(i, name)| {
                let (colour, dash) = SERIES[i % SERIES.len()];
                (Key::Line(Paint::stroke(colour, DATA).dashed(dash)), name.as_str())
            })
            .collect();
        (base, _) = legend(&mut svg, LEFT, base + 14.0, PAGE - 4.0, SMALL, &keys);
    }
    let bottom = strips(&mut svg, figure, Rect::new(LEFT, base + 8.0, room.0, 62.0))?;
    Ok(svg.finish(PAGE, bottom + 28.0))
}

fn check(figure: &TraceFigure) -> Result<(), FigureError> {
    figure.window.check("window", 0)?;
    for (what, empty) in [
        ("robot trajectories", figure.trajectories.iter().all(Vec::is_empty)),
        ("instants", figure.instants.is_empty()),
        ("angular gaps", figure.gaps.is_empty()),
    ] {
        if empty {
            return Err(FigureError::Empty { what });
        }
    }
    let expected = figure.times.len();
    for (what, values) in figure.gaps.iter().map(|g| ("angular gap", g)).chain([("radial error", &figure.radial_error)])
    {
        if values.len() != expected {
            return Err(FigureError::Length { what, found: values.len(), expected });
        }
        finite(what, values.iter().copied())?;
    }
    finite("time", figure.times.iter().copied())?;
    if expected < 2 {
        return Err(FigureError::Length { what: "times", found: expected, expected: 2 });
    }
    if let Some(i) = figure.times.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(FigureError::OutOfRange { what: "time", index: i + 1, expected: "later than the one before" });
    }
    let lengths = [figure.body_radius, figure.radial_band];
    finite("radius or band", lengths)?;
    within("radius or band", lengths, (0.0, f64::INFINITY), "0 or more")?;
    for gaps in &figure.gaps {
        within("angular gap", gaps.iter().copied(), (0.0, 360.001), "from 0 to 360 degrees")?;
    }
    within("radial error", figure.radial_error.iter().copied(), (0.0, f64::INFINITY), "0 or more")?;
    finite_lines("wall", &figure.walls)?;
    finite_lines("target path", &figure.target_paths)?;
    finite_lines("trajectory", &figure.trajectories)?;
    for (index, instant) in figure.instants.iter().enumerate() {
        let named = |e: FigureError| e.within("instant", index);
        let poses = instant.robots.iter().flat_map(|r| [r.position[0], r.position[1], r.heading]);
        finite("", poses.chain(instant.targets.iter().flatten().copied()).chain([instant.time])).map_err(named)?;
        finite_lines("", &instant.contours).map_err(named)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::check::read;
    use crate::chart::map::Window;
    use crate::trace::data::{Instant, Pose};

    fn figure() -> TraceFigure {
        let ring: Vec<[f64; 2]> = vec![[4.0, 9.0], [6.0, 9.0], [5.0, 11.0]];
        let instant = |time: f64| Instant {
            time,
            robots: vec![Pose { position: [4.0, 9.0], heading: 1.0 }],
            targets: vec![[5.0, 10.0]],
            contours: vec![ring.clone()],
        };
        TraceFigure {
            window: Window { min: [0.0, 5.0], max: [20.0, 15.0] },
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
        for words in ["Time (s)", "Largest gap (°)", "Radial error (m)", "40 s", "robot (enlarged)", "target 2"] {
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
        assert_eq!(refused(&|f| f.instants.clear()), FigureError::Empty { what: "instants" });
        assert_eq!(refused(&|f| f.gaps[1][2] = f64::NAN), FigureError::NotFinite { what: "angular gap", index: 2 });
        let expected = FigureError::NotFinite { what: "instant", index: 1 };
        assert_eq!(refused(&|f| f.instants[1].robots[0].heading = f64::INFINITY), expected);
        assert!(matches!(refused(&|f| f.times[1] = 40.0), FigureError::OutOfRange { index: 2, .. }));
        assert!(matches!(refused(&|f| f.radial_error.truncate(2)), FigureError::Length { found: 2, expected: 3, .. }));
    }
}
