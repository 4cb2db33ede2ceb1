//! A run of the swarm: where the robots went, and how well they surrounded the targets.

use crate::canvas::error::{FigureError, finite, finite_lines, within};
use crate::canvas::note::nothing_to_draw;
use crate::canvas::paint::{Paint, Rect};
use crate::canvas::style::{DATA, PAGE, SMALL, series};
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
/// Series of unequal length, numbers that are not finite, times that do not increase.
pub fn trace(figure: &TraceFigure) -> Result<String, FigureError> {
    check(figure)?;
    if figure.trajectories.iter().all(Vec::is_empty) || figure.times.len() < 2 {
        return Ok(nothing_to_draw("the run ended before a robot could move"));
    }
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
                let (colour, dash) = series(i);
                (Key::Line(Paint::stroke(colour, DATA).dashed(dash)), name.as_str())
            })
            .collect();
        (base, _) = legend(&mut svg, LEFT, base + 14.0, PAGE - 4.0, SMALL, &keys);
    }
    let bottom = strips(&mut svg, figure, Rect::new(LEFT, base + 18.0, room.0, 62.0))?;
    Ok(svg.finish(PAGE, bottom + 28.0))
}

fn check(figure: &TraceFigure) -> Result<(), FigureError> {
    figure.window.check("window", 0)?;
    let expected = figure.times.len();
    let gaps = figure.gaps.iter().map(|gaps| ("angular gap", gaps.len()));
    for (what, found) in gaps.chain([("radial error", figure.radial_error.len())]) {
        if found != expected {
            return Err(FigureError::Length { what, found, expected });
        }
    }
    finite("time", figure.times.iter().copied())?;
    if let Some(i) = figure.times.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(FigureError::OutOfRange { what: "time", index: i + 1, expected: "later than the one before" });
    }
    let not_negative = |what, values: &[f64]| {
        finite(what, values.iter().copied())?;
        within(what, values.iter().copied(), (0.0, f64::INFINITY), "0 or more")
    };
    not_negative("radius or band", &[figure.body_radius, figure.radial_band.unwrap_or(0.0)])?;
    // What is not known is given a good number, so that the index is the time's.
    for gaps in &figure.gaps {
        let gaps = || gaps.iter().map(|gap| gap.unwrap_or(0.0));
        finite("angular gap", gaps())?;
        within("angular gap", gaps(), (0.0, 360.001), "from 0 to 360 degrees")?;
    }
    let errors: Vec<f64> = figure.radial_error.iter().map(|error| error.unwrap_or(0.0)).collect();
    not_negative("radial error", &errors)?;
    finite_lines("wall", &figure.walls)?;
    finite_lines("target path", &figure.target_paths)?;
    finite_lines("trajectory", &figure.trajectories)?;
    let faults = figure.faults.iter().flat_map(|fault| [fault.time, fault.position[0], fault.position[1]]);
    finite("fault", faults)?;
    for (index, instant) in figure.instants.iter().enumerate() {
        let named = |e: FigureError| e.within("instant", index);
        let poses = instant.robots.iter().flat_map(|r| [r.position[0], r.position[1], r.heading]);
        finite("", poses.chain(instant.targets.iter().flatten().copied()).chain([instant.time])).map_err(named)?;
        finite_lines("", &instant.contours).map_err(named)?;
        finite_lines("", &instant.walls).map_err(named)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::style::{VERMILLION, time_colour};
    use crate::chart::check::read;
    use crate::chart::map::{Window, frame_look, wall_look};
    use crate::trace::data::{Fault, Instant, Pose};

    fn figure() -> TraceFigure {
        let ring: Vec<[f64; 2]> = vec![[4.0, 9.0], [6.0, 9.0], [5.0, 11.0]];
        let instant = |time: f64| Instant {
            time,
            robots: vec![Pose { position: [4.0, 9.0], heading: 1.0, in_service: true }],
            targets: vec![[5.0, 10.0]],
            contours: vec![ring.clone()],
            walls: Vec::new(),
        };
        TraceFigure {
            window: Window { min: [0.0, 5.0], max: [20.0, 15.0] },
            walls: vec![vec![[6.0, 14.0], [14.0, 14.0], [14.0, 20.0]]],
            target_paths: vec![vec![[3.0, 10.0], [17.0, 10.0]]],
            trajectories: vec![ring.clone()],
            body_radius: 0.035,
            instants: vec![instant(0.0), instant(40.0)],
            faults: Vec::new(),
            times: vec![0.0, 20.0, 40.0],
            gaps: vec![vec![Some(300.0), Some(80.0), Some(60.0)], vec![Some(200.0), Some(100.0), Some(70.0)]],
            radial_error: vec![Some(0.8), Some(0.2), Some(0.05)],
            radial_band: Some(0.12),
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
    fn targets_robots_walls_and_frame_look_different() {
        let document = read(&trace(&figure()).unwrap());
        let circles = document.tags.iter().filter(|tag| tag.starts_with("circle")).count();
        assert_eq!(circles, 2 + 1, "the robots of both moments and the one of the legend: a target is no circle");
        let marked = |words: &str| document.texts.iter().filter(|text| *text == words).count();
        assert_eq!(marked("40 s"), 1 + 1, "a moment is named in the map and above the series");
        assert_ne!(wall_look().stroke, frame_look().stroke);
        let dashes = document.tags.iter().filter(|tag| tag.contains(&time_colour(0.0)) && tag.contains("dasharray"));
        assert!(dashes.count() > 0, "an earlier pattern is dashed");
    }

    #[test]
    fn faults_and_robots_out_of_service_are_marked() {
        let crosses = |figure: &TraceFigure| {
            let document = read(&trace(figure).unwrap());
            let lines = document.tags.iter().filter(|tag| tag.starts_with("path") && tag.contains(VERMILLION));
            (lines.count() / 2, document.says("fault of a robot"), document.says("robot out of service"))
        };
        let mut figure = figure();
        assert_eq!(crosses(&figure), (0, false, false));
        figure.faults = [10.0, 30.0].map(|time| Fault { time, position: [4.0, 9.0] }).to_vec();
        figure.instants[0].robots[0].in_service = false;
        // Each on the map and in both series, and one in the legend.
        assert_eq!(crosses(&figure), (2 * 3 + 1, true, true));
        figure.faults = (0..501).map(|_| Fault { time: 10.0, position: [4.0, 9.0] }).collect();
        assert_eq!(crosses(&figure).0, 500 * 3 + 1);
        assert!(read(&trace(&figure).unwrap()).says("fault of a robot (first 500)"));
    }

    #[test]
    fn what_is_not_known_leaves_a_hole() {
        let mut unknown = figure();
        let svg = |figure: &TraceFigure| trace(figure).unwrap();
        unknown.radial_error = vec![None; 3];
        unknown.radial_band = None;
        assert!(read(&svg(&unknown)).says("not known: no robot finds the pattern"));
        unknown.radial_error = vec![Some(0.1), None, Some(0.2)];
        assert!(!read(&svg(&unknown)).says("not known: no robot finds the pattern"));
        unknown.instants.clear();
        unknown.gaps.clear();
        read(&svg(&unknown));
    }

    #[test]
    fn a_run_too_short_to_draw_is_said() {
        let mut short = figure();
        (short.times, short.radial_error) = (vec![0.0], vec![None]);
        short.gaps.iter_mut().for_each(|gaps| gaps.truncate(1));
        assert!(read(&trace(&short).unwrap()).texts.concat().starts_with("Nothing to draw"));
    }

    #[test]
    fn bad_runs_are_refused() {
        let refused = |change: &dyn Fn(&mut TraceFigure)| {
            let mut bad = figure();
            change(&mut bad);
            trace(&bad).unwrap_err()
        };
        assert_eq!(
            refused(&|f| f.gaps[1][2] = Some(f64::NAN)),
            FigureError::NotFinite { what: "angular gap", index: 2 }
        );
        let expected = FigureError::NotFinite { what: "instant", index: 1 };
        assert_eq!(refused(&|f| f.instants[1].robots[0].heading = f64::INFINITY), expected);
        assert!(matches!(refused(&|f| f.times[1] = 40.0), FigureError::OutOfRange { index: 2, .. }));
        assert!(matches!(refused(&|f| f.radial_error.truncate(2)), FigureError::Length { found: 2, expected: 3, .. }));
    }
}
