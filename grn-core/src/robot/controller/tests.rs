use super::*;
use crate::robot::epuck2::{AXLE, METRES_PER_STEP};
use crate::robot::message::Message;
use crate::robot::percept::HEADING_UNIT;
use crate::robot::{Fix, Heard, Millimetres, Sighting};
use crate::scalar::Q8_24;
use std::vec::Vec;

const NAND_XNOR: &[u8] = include_bytes!("../../../../models/nand-xnor.grn");
const ELAPSED_US: [u32; 6] = [5_000, 31_000, 31_250, 32_000, 100_000, 250_000];

fn controller<S: Scalar>(robot: u16) -> Controller<S> {
    Controller::new(&Blob::decode(NAND_XNOR).unwrap(), robot).unwrap()
}

fn at(x: f64, y: f64) -> Millimetres {
    let millimetres = |metres: f64| libm::round(metres * 1e3) as i16;
    Millimetres { x: millimetres(x), y: millimetres(y) }
}

/// A fix at (x, y) metres, looking this way.
fn fix([x, y, angle]: [f64; 3], age_ms: u16) -> Fix {
    let (sin, cos) = libm::sincos(angle);
    let unit = |component: f64| libm::round(component * f64::from(HEADING_UNIT)) as i16;
    Fix { position: [x, y].map(|metres| libm::round(metres * 1e6) as i32), heading: [unit(cos), unit(sin)], age_ms }
}

/// A percept in which a target is seen half a metre to the east of the origin.
fn target_ahead(fix: Option<Fix>, elapsed_us: u32) -> Percept {
    let mut percept = Percept { fix, elapsed_us, ..Percept::nothing() };
    percept.targets.push(Sighting { target: 0, position: at(0.6, 0.0) }).unwrap();
    percept
}

#[test]
fn without_a_fix_the_robot_stands_still_and_is_silent() {
    for elapsed_us in [31_250, 100_000] {
        let mut robot = controller::<f32>(1);
        let mut seconds = |fix: Option<Fix>, seconds: f64| -> Vec<Command> {
            let ticks = (seconds * 1e6 / f64::from(elapsed_us)) as usize;
            (0..ticks).map(|_| robot.tick(&target_ahead(fix, elapsed_us)).unwrap()).collect()
        };
        assert!(seconds(None, 2.0).iter().all(|command| *command == Command::default()));
        let here = Some(fix([0.0; 3], 0));
        let driven = seconds(here, 2.0);
        assert!(driven.iter().filter(|command| command.broadcast.is_some()).count() >= 7);
        assert!(driven.iter().all(|command| command.left > 0 && command.right > 0));
        assert!(seconds(None, 0.4).iter().all(|command| command.left > 0 && command.right > 0));
        let stale = seconds(None, 2.0);
        assert!(stale[4..].iter().all(|command| *command == Command::default()));
        assert!(seconds(here, 0.2).iter().all(|command| command.left > 0));
    }
}

#[test]
fn a_robot_speaks_four_times_a_second_however_often_it_is_ticked() {
    for elapsed_us in ELAPSED_US {
        let mut robot = controller::<f32>(40_003);
        let here = Some(fix([0.0; 3], 0));
        let ticks = 10_000_000 / elapsed_us;
        let said = (0..ticks).filter(|_| robot.tick(&target_ahead(here, elapsed_us)).unwrap().broadcast.is_some());
        let said = said.count();
        assert!((39..=41).contains(&said), "{elapsed_us} µs: {said}");
    }
}

/// Where a lone robot is after 20 s, metres from its target, and how far from there it was in the last 5 s: with fixes of
/// this age, one in `every` ticks, and wheels of which one is larger by a share.
fn settled<S: Scalar>(elapsed_us: u32, age_ms: u16, every: u32, gain: f64) -> (f64, f64) {
    let mut robot = controller::<S>(0);
    let mut poses = std::vec![[0.0, 0.1, 2.0]];
    let seconds = f64::from(elapsed_us) * 1e-6;
    let late = (f64::from(age_ms) * 1e-3 / seconds).round() as usize;
    let mut distances = Vec::new();
    for tick in 0..(20_000_000 / elapsed_us) {
        let measured = poses[poses.len().saturating_sub(late + 1)];
        let age_ms = (late as f64 * seconds * 1e3).round() as u16;
        let percept = target_ahead((tick % every == 0).then(|| fix(measured, age_ms)), elapsed_us);
        let Command { left, right, .. } = robot.tick(&percept).unwrap();
        let [left, right] = [f64::from(left) * (1.0 + gain), f64::from(right)].map(|s| s * METRES_PER_STEP * seconds);
        let [x, y, angle] = *poses.last().unwrap();
        let (sin, cos) = libm::sincos(angle + (right - left) / AXLE / 2.0);
        let path = (left + right) / 2.0;
        poses.push([x + path * cos, y + path * sin, angle + (right - left) / AXLE]);
        distances.push(libm::hypot(x - 0.6, y));
    }
    let last = distances[distances.len() - 1];
    let recent = &distances[distances.len() * 3 / 4..];
    (last, recent.iter().fold(0.0, |most, distance| (distance - last).abs().max(most)))
}

#[test]
fn a_robot_comes_to_rest_on_the_ring_at_every_pace_and_with_old_fixes() {
    let blob: Blob = Blob::decode(NAND_XNOR).unwrap();
    let network = blob.network.cast::<f64>();
    let pattern = Pattern::of(&network, f64::from(blob.level_fraction)).unwrap();
    let ring = pattern.free_space_radius(&network, &blob.field.field(blob.scale)).unwrap();
    for elapsed_us in ELAPSED_US {
        for (age_ms, every, gain) in [(0, 1, 0.0), (300, 1, 0.0), (200, 2, 0.0), (250, 1, 0.05), (0, 1, -0.05)] {
            if elapsed_us * every > 400_000 {
                continue;
            }
            let float = settled::<f32>(elapsed_us, age_ms, every, gain);
            let fixed = settled::<Q8_24>(elapsed_us, age_ms, every, gain);
            for (distance, moved) in [float, fixed] {
                let told = std::format!("{elapsed_us} µs, {age_ms} ms, 1 of {every}, {gain}: {distance} {moved}");
                assert!((distance - ring).abs() < 0.03 * ring && moved < 0.02 * ring, "{told}, ring {ring}");
            }
            assert!((float.0 - fixed.0).abs() < 0.01 * ring, "{elapsed_us} µs: {float:?} {fixed:?}");
        }
    }
}

#[test]
fn what_is_heard_over_relays_is_as_old_and_as_far_as_it_should_be() {
    const RADIO_TICKS: usize = 5;
    const SEEN: usize = 320;
    let mut robots: Vec<Controller<f32>> = (0..5).map(controller).collect();
    let mut said: Vec<Vec<Option<Message>>> = std::vec![Vec::new(); robots.len()];
    // The target moves east at 40 mm/s and is seen by the first robot only, for 10 s.
    let target_at = |tick: usize| 0.04 / 32.0 * tick as f64;
    let mut told = 0;
    for tick in 0..SEEN + 120 {
        for (number, robot) in robots.iter_mut().enumerate() {
            let mut percept = Percept { fix: Some(fix([0.0, 5.0, 0.0], 0)), ..Percept::nothing() };
            if number == 0 && tick <= SEEN {
                percept.targets.push(Sighting { target: 3, position: at(target_at(tick), 0.0) }).unwrap();
            }
            let sent = number.checked_sub(1).zip(tick.checked_sub(RADIO_TICKS));
            if let Some(message) = sent.and_then(|(before, then)| said[before][then].clone()) {
                percept.heard.push(Heard { message, age_ms: 156 }).unwrap();
            }
            said[number].push(robot.tick(&percept).unwrap().broadcast);
        }
        let last = said.last().and_then(|of| of.last()?.as_ref()?.target);
        if let Some(report) = last.filter(|_| tick > SEEN + 70) {
            let age = tick - SEEN;
            assert!(usize::from(report.age).abs_diff(age) <= 1, "{} ticks instead of {age}", report.age);
            let place = libm::round(target_at(tick) * 1e3) as i16;
            assert!(report.position.x.abs_diff(place) <= 3, "{} mm instead of {place}", report.position.x);
            told += 1;
        }
    }
    assert!(told >= 5, "{told}");
}

#[test]
fn gene_expression_keeps_time_at_every_pace() {
    // The level after 0.5 s, before it is at rest.
    let level = |elapsed_us: u32| {
        let mut robot = controller::<f64>(0);
        for _ in 0..(500_000 / elapsed_us) {
            robot.tick(&target_ahead(Some(fix([0.5, 0.0, 0.0], 0)), elapsed_us)).unwrap();
        }
        robot.morphogen()
    };
    let nominal = level(31_250);
    for elapsed_us in ELAPSED_US {
        assert!((level(elapsed_us) - nominal).abs() < 0.02, "{elapsed_us} µs: {} {nominal}", level(elapsed_us));
    }
}

/// Where a robot is that was called to a place 1.5 m to the west for so many seconds, with something in the way.
fn called_home<S: Scalar>(seconds: u32) -> [f64; 2] {
    let mut robot = controller::<S>(0);
    let [mut x, mut y, mut angle] = [0.0_f64, 0.0, 0.5];
    for _ in 0..seconds * 32 {
        let mut percept = target_ahead(Some(fix([x, y, angle], 0)), 31_250);
        // A post, as thick as a robot, on the straight way.
        for (sensor, bearing) in crate::robot::epuck2::PROXIMITY_BEARINGS_DEG.into_iter().enumerate() {
            let (sin, cos) = libm::sincos(angle + f64::from(bearing).to_radians());
            let (east, north) = (-0.7 - x, -y);
            let (along, aside) = (east * cos + north * sin, east * sin - north * cos);
            let free = along - (0.035f64 * 0.035 - aside * aside).max(0.0).sqrt() - 0.035;
            if along > 0.0 && aside.abs() < 0.035 && free < 0.05 {
                percept.proximity[sensor] = (free.max(0.0) * 1e4) as u16;
            }
        }
        let Command { left, right, .. } = robot.tick_home(&percept, at(-1.5, 0.0)).unwrap();
        let [left, right] = [left, right].map(|speed| f64::from(speed) * METRES_PER_STEP / 32.0);
        angle += (right - left) / AXLE;
        let (sin, cos) = libm::sincos(angle);
        let way = (left + right) / 2.0;
        (x, y) = (x + way * cos, y + way * sin);
    }
    [x, y]
}

#[test]
fn a_robot_that_is_called_home_goes_around_what_is_in_its_way() {
    let off = |[x, y]: [f64; 2]| libm::hypot(x + 1.5, y);
    for place in [called_home::<f32>(60), called_home::<Q8_24>(60)] {
        assert!(off(place) < 0.02, "{place:?}");
    }
    assert!(off(called_home::<f32>(2)) > 1.2, "it takes some time");
}

#[test]
fn a_robot_that_was_called_home_goes_back_to_the_pattern() {
    let mut robot = controller::<f32>(0);
    let percept = target_ahead(Some(fix([0.0, 0.0, 0.0], 0)), 31_250);
    let speeds = |command: Command| (command.left, command.right);
    for _ in 0..32 {
        robot.tick(&percept).unwrap();
    }
    assert!(speeds(robot.tick_home(&percept, at(-5.0, 0.0)).unwrap()) < (-100, -100));
    assert!(speeds(robot.tick(&percept).unwrap()) > (100, 100));
}
