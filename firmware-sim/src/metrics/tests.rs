use super::*;
use crate::geometry::{Polygon, convex_hull, point_in_polygon};
use crate::random::{Component, Stream};
use crate::trace::Trace;
use crate::trace::tests::trace_of;
use grn_core::geometry::Vector;
use std::sync::LazyLock;

/// Robots at these bearings (degrees) and this distance from the target at (1, 2).
fn around(bearings: &[f64], distance: f64) -> Vec<(f64, f64)> {
    let at = |bearing: &f64| {
        let (sin, cos) = libm::sincos(bearing.to_radians());
        (1.0 + distance * cos, 2.0 + distance * sin)
    };
    bearings.iter().map(at).collect()
}

fn gap_deg(bearings: &[f64]) -> f64 {
    let robots = around(bearings, 0.5).into_iter().map(|(x, y)| Vector::new(x, y));
    largest_gap(Vector::new(1.0, 2.0), robots).to_degrees()
}

fn largest_gap(target: Point<f64>, robots: impl IntoIterator<Item = Point<f64>>) -> f64 {
    let mut bearings = Bearings::default();
    bearings.take(target, robots);
    bearings.largest_gap()
}

fn measured(
    trace: &Trace,
    options: &MetricsOptions<'_>,
    distance: impl FnMut(Point<f64>, &[Point<f64>], f64) -> Option<f64>,
) -> Metrics {
    let mut meter = Meter::new(options.clone(), distance);
    trace.frames().for_each(|frame| meter.observe(&frame));
    meter.metrics()
}

/// One robot out of service from this tick on.
fn away(robot: usize, from: u64) -> Absences {
    let mut absences = Absences::default();
    absences.add(robot, from..u64::MAX);
    absences
}

/// Without walls or faults, around a ring of half a metre.
fn options<'a>() -> MetricsOptions<'a> {
    static NO_WALLS: LazyLock<Walls> = LazyLock::new(Walls::default);
    static PRESENT: LazyLock<Absences> = LazyLock::new(Absences::default);
    let (walls, disturbances, absences) = (WallsOfRun::Fixed(&NO_WALLS), [].as_slice(), &*PRESENT);
    MetricsOptions { walls, ring_radius_m: 0.5, ticks_per_second: 32, disturbances, absences }
}

const RING: [f64; 5] = [0.0, 72.0, 144.0, 216.0, 288.0];
const OPEN: [f64; 5] = [0.0, 30.0, 60.0, 90.0, 120.0];

#[test]
fn gaps_wrap_around() {
    assert!((gap_deg(&RING) - 72.0).abs() < 1e-9);
    assert!((gap_deg(&OPEN) - 240.0).abs() < 1e-9);
    assert!((gap_deg(&[170.0, -170.0, 40.0, -60.0]) - 130.0).abs() < 1e-9);
    assert_eq!((gap_deg(&[]), gap_deg(&[33.0])), (360.0, 360.0));
    let at_target = [Vector::new(1.0, 2.0); 4];
    assert_eq!(largest_gap(Vector::new(1.0, 2.0), at_target), TAU);
}

#[test]
fn exactly_ninety_degrees_does_not_encircle() {
    // On the axes and on the diagonals: atan2 rounds differently there.
    for corners in
        [[(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)], [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]]
    {
        let mut robots: Vec<Point<f64>> = corners.iter().map(|&(x, y)| Vector::new(x, y)).collect();
        assert!(!encircles(largest_gap(Vector::ZERO, robots.clone())));
        // One more robot divides one of the four gaps; the others stay.
        robots.push(Vector::new(corners[0].0 + 0.3, corners[0].1 + 0.3));
        assert!(!encircles(largest_gap(Vector::ZERO, robots)));
    }
    assert!(encircles(gap_deg(&[0.0, 89.9999, 170.0, 250.0, 310.0]).to_radians()));
    assert!(!encircles(gap_deg(&[0.0, 90.0001, 170.0, 250.0, 310.0]).to_radians()));
}

#[test]
fn a_gap_below_180_is_the_same_as_inside_the_hull() {
    let mut stream = Stream::new(2, Component::Placement, 0);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..2000 {
        let robots: Vec<Point<f64>> = (0..5).map(|_| Vector::new(stream.symmetric(), stream.symmetric())).collect();
        let target = Vector::new(stream.symmetric(), stream.symmetric()) * 0.5;
        let gap = largest_gap(target, robots.clone());
        let held = point_in_polygon(&convex_hull(&robots), target);
        assert_eq!(held, gap < PI, "{robots:?} {target:?}");
        if held { inside += 1 } else { outside += 1 }
    }
    assert!(inside > 200 && outside > 200);
}

#[test]
fn forming_takes_two_unbroken_seconds() {
    // In quarters of a second, of which each has one moment: 10 open, 7 closed (too few), 5 open, 20 closed, 4 open, 16 closed.
    let ring = |open| (vec![(1.0, 2.0)], around(if open { &OPEN } else { &RING }, 0.5));
    let frames: Vec<_> = [(10, true), (7, false), (5, true), (20, false), (4, true), (16, false)]
        .into_iter()
        .flat_map(|(moments, open)| (0..8 * moments).map(move |_| ring(open)))
        .collect();
    let metrics = measured(&trace_of(&frames), &options(), |_, _, _| Some(0.02));
    assert_eq!(metrics.formed_at_s, Some(22.0 / 4.0));
    assert_eq!(metrics.encircled_share, Some(36.0 / 40.0));
    assert_eq!(metrics.encircled_share_by_target, Some(vec![Some(36.0 / 40.0)]));
    assert_eq!(metrics.encircled_share_of_run, 43.0 / 62.0);
    assert_eq!(metrics.duration_s, 495.0 / 32.0);
    assert!((metrics.largest_gap_deg.unwrap() - 240.0).abs() < 1e-3);
    assert_eq!((metrics.wall_contacts, metrics.peer_contacts), (2 * 496, 496));
    assert_eq!((metrics.wall_contact_s, metrics.peer_contact_s), (4.0 * 496.0 / 32.0, 3.0 * 496.0 / 32.0));
    assert_eq!(metrics.min_wall_clearance_m, None);
    // 64 ticks are 65 frames: one frame fewer does not form.
    let frames = |n| vec![ring(false); n];
    let formed = |n| measured(&trace_of(&frames(n)), &options(), |_, _, _| None).formed_at_s;
    assert_eq!((formed(64), formed(65)), (None, Some(0.0)));
}

#[test]
fn every_target_counts_by_itself() {
    let mut robots = around(&RING, 0.5);
    robots.extend(around(&RING, 0.4).into_iter().map(|(x, y)| (x + 3.0, y)));
    let both = (vec![(1.0, 2.0), (4.0, 2.0)], robots.clone());
    let lost = (vec![(1.0, 2.0), (4.0, 3.0)], robots);
    let frames: Vec<_> = (0..160).map(|i| if i < 120 { both.clone() } else { lost.clone() }).collect();
    let metrics = measured(&trace_of(&frames), &options(), |_, _, _| None);
    assert_eq!(metrics.encircled_share_by_target, Some(vec![Some(1.0), Some(0.75)]));
    assert_eq!(metrics.encircled_share, Some(0.75));
    assert_eq!((metrics.radial_error_median_m, metrics.radial_error_unknown_share), (None, Some(1.0)));
}

#[test]
fn an_unknown_distance_is_longer_than_any_other() {
    let frames = vec![(vec![(1.0, 2.0)], around(&RING, 0.5)); 200];
    let west_of = |limit: f64| move |p: Point<f64>, _: &[Point<f64>], _: f64| (p.x < limit).then_some(0.01);
    // Four of five robots are west of 1.2 m, two west of 1 m.
    let most = measured(&trace_of(&frames), &options(), west_of(1.2));
    assert!((most.radial_error_median_m.unwrap() - 0.01).abs() < 1e-4);
    assert_eq!((most.radial_error_p95_m, most.lost_robots, most.strayed_robots), (None, 0, 0));
    assert!((most.radial_error_unknown_share.unwrap() - 0.2).abs() < 1e-9);
    let few = measured(&trace_of(&frames), &options(), west_of(1.0));
    assert_eq!(few.radial_error_median_m, None);
}

#[test]
fn robots_are_lost_far_away_and_stray_for_a_while() {
    // The first robot leaves after 2 s for 6 s, the second after 8 s for good; the third is broken down and far away.
    let frames: Vec<_> = (0..14 * 32)
        .map(|tick| {
            let mut robots = around(&RING, 0.5);
            robots[0].0 += if (64..256).contains(&tick) { 0.3 } else { 0.2 };
            // Off the pattern too, but near the target.
            robots[4] = (1.0, 2.1);
            robots[1].1 += if tick >= 256 { 0.3 } else { 0.0 };
            robots[2].0 -= 3.0;
            (vec![(1.0, 2.0)], robots)
        })
        .collect();
    let distance = |p: Point<f64>, targets: &[Point<f64>], _: f64| Some(((p - targets[0]).length() - 0.5).abs());
    let absences = away(2, 5);
    let metrics = measured(&trace_of(&frames), &MetricsOptions { absences: &absences, ..options() }, distance);
    assert_eq!((metrics.lost_robots, metrics.strayed_robots), (1, 1));
    let metrics = measured(&trace_of(&frames), &options(), distance);
    assert_eq!((metrics.lost_robots, metrics.strayed_robots), (2, 1), "a robot that works counts");
}

#[test]
fn a_broken_robot_does_not_encircle() {
    let frames = vec![(vec![(1.0, 2.0)], around(&RING, 0.5)); 192];
    let absences = away(1, 96);
    let metrics = measured(&trace_of(&frames), &MetricsOptions { absences: &absences, ..options() }, |_, _, _| None);
    assert_eq!((metrics.formed_at_s, metrics.encircled_share), (Some(0.0), Some(0.5)));
}

#[test]
fn a_swarm_recovers_from_one_disturbance_and_not_from_the_next() {
    // Closed for 3 s, broken by the first disturbance for 1 s, closed for 4 s but for 0.5 s, open before the second.
    let closed = |tick| tick < 96 || ((128..256).contains(&tick) && !(200..216).contains(&tick));
    let frames: Vec<_> =
        (0..300).map(|tick| (vec![(1.0, 2.0)], around(if closed(tick) { &RING } else { &OPEN }, 0.5))).collect();
    let disturbed =
        |disturbances| measured(&trace_of(&frames), &MetricsOptions { disturbances, ..options() }, |_, _, _| None);
    let metrics = disturbed(&[96, 260, 1000]);
    let first = Recovery { disturbed_at_s: 3.0, reformed_at_s: Some(4.0), encircled_share: Some(14.0 / 17.0) };
    let second = Recovery { disturbed_at_s: 264.0 / 32.0, reformed_at_s: None, encircled_share: None };
    assert_eq!(metrics.recoveries, [first, second]);
    assert_eq!(metrics.formed_at_s, Some(0.0));
    assert_eq!(metrics.recoveries, disturbed(&[96, 260]).recoveries);
    assert_eq!(disturbed(&[]).recoveries, []);
}

#[test]
fn distances_are_measured_some_times_a_second_of_every_robot() {
    let frames = vec![(vec![(1.0, 2.0)], around(&RING, 0.5)); 129];
    let mut calls = 0;
    measured(&trace_of(&frames), &options(), |_, _, _| {
        calls += 1;
        None
    });
    assert_eq!(calls, RING.len() * (4 * usize::from(MEASUREMENTS_PER_SECOND) + 1));
}

#[test]
fn radial_error_clearance_and_evenness() {
    let frames = vec![(vec![(1.0, 2.0)], around(&RING, 0.5)); 70];
    let wall = [(1.8, 0.0), (2.8, 0.0), (2.8, 4.0), (1.8, 4.0)].map(|(x, y)| Vector::new(x, y));
    let walls = Walls::new(vec![Polygon::new(wall.to_vec()).unwrap()]);
    // The pattern: the ring of radius 0.49 m, farther away in the north.
    let distance = |p: Point<f64>, targets: &[Point<f64>], _: f64| {
        let offset = p - targets[0];
        Some((offset.length() - 0.49).abs() + if offset.y > 0.4 { 0.2 } else { 0.0 })
    };
    let metrics =
        measured(&trace_of(&frames), &MetricsOptions { walls: WallsOfRun::Fixed(&walls), ..options() }, distance);
    assert!((metrics.radial_error_median_m.unwrap() - 0.01).abs() < 2e-4);
    assert!((metrics.radial_error_p95_m.unwrap() - 0.21).abs() < 2e-4);
    assert_eq!(metrics.radial_error_unknown_share, Some(0.0));
    assert!((metrics.min_wall_clearance_m.unwrap() - 0.3).abs() < 1e-9);
    assert!((metrics.spacing_evenness.unwrap() - 1.0).abs() < 1e-9);
    let uneven = vec![(vec![(1.0, 2.0)], around(&[0.0, 10.0, 85.0, 160.0, 235.0, 310.0], 0.5)); 70];
    let metrics = measured(&trace_of(&uneven), &options(), |_, _, _| None);
    let gaps = [10.0, 75.0, 75.0, 75.0, 75.0, 50.0].map(|gap: f64| gap / 360.0);
    let expected = -gaps.iter().map(|g| g * libm::log(*g)).sum::<f64>() / libm::log(6.0);
    assert!((metrics.spacing_evenness.unwrap() - expected).abs() < 1e-5);
}

#[test]
fn a_target_that_goes_is_not_missed() {
    // Both targets are encircled for 10 s; then the second one goes, and its robots come to the first within 6 s.
    let second = |way: f64| RING.map(|bearing| (bearing, way));
    let places = |way: f64| -> Vec<(f64, f64)> {
        let there = second(way)
            .into_iter()
            .flat_map(|(bearing, way)| around(&[bearing], 0.5).into_iter().map(move |(x, y)| (x + 4.0 * way, y)));
        around(&RING, 0.5).into_iter().chain(there).collect()
    };
    let mut frames: Vec<(crate::trace::tests::Places, crate::trace::tests::Places)> = Vec::new();
    frames.extend((0..320).map(|_| (vec![(1.0, 2.0), (5.0, 2.0)], places(1.0))));
    frames.extend((0..192).map(|tick| (vec![(1.0, 2.0), (5.0, 2.0)], places(1.0 - f64::from(tick) / 192.0))));
    frames.extend((0..64).map(|_| (vec![(1.0, 2.0), (5.0, 2.0)], places(0.0))));
    let whole = trace_of(&frames);
    let distance = |p: Point<f64>, targets: &[Point<f64>], _: f64| {
        targets.iter().map(|&target| ((p - target).length() - 0.5).abs()).reduce(f64::min)
    };
    let mut meter = Meter::new(MetricsOptions { disturbances: &[320], ..options() }, distance);
    for frame in whole.frames() {
        let targets: Vec<_> = frame
            .targets_um
            .iter()
            .enumerate()
            .map(|(target, place)| place.filter(|_| target == 0 || frame.tick < 320))
            .collect();
        meter.observe(&Frame { targets_um: &targets, ..frame });
    }
    let metrics = meter.metrics();
    assert_eq!(metrics.encircled_share_by_target, Some(vec![Some(1.0), Some(1.0)]));
    assert_eq!(
        (metrics.encircled_share, metrics.lost_robots, metrics.strayed_robots),
        (Some(1.0), 0, 0),
        "{metrics:?}"
    );
    assert_eq!(metrics.recoveries[0].encircled_share, Some(1.0));
    let seen = measured(&whole, &options(), distance);
    assert!(seen.encircled_share.unwrap() < 1.0, "who sees both targets misses the second one's robots");
}
