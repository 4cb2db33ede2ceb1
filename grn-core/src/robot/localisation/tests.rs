use super::*;
use crate::robot::percept::HEADING_UNIT;
use crate::scalar::Q8_24;
use std::vec::Vec;

/// Where a robot really is, in f64: position in metres, angle in radians.
#[derive(Clone, Copy, Debug)]
struct Truth {
    x: f64,
    y: f64,
    angle: f64,
}

impl Truth {
    const START: Truth = Truth { x: 1.0, y: -2.0, angle: 0.5 };

    /// Along the arc that these wheel speeds, in whole steps per second, describe.
    fn after(self, wheels: [i16; 2], seconds: f64) -> Truth {
        let [left, right] = wheels.map(|steps| f64::from(speed(steps)) * METRES_PER_STEP * seconds);
        let (path, turned) = ((left + right) / 2.0, (right - left) / AXLE);
        let chord = if turned == 0.0 { path } else { path * libm::sin(turned / 2.0) / (turned / 2.0) };
        let (sin, cos) = libm::sincos(self.angle + turned / 2.0);
        Truth { x: self.x + chord * cos, y: self.y + chord * sin, angle: self.angle + turned }
    }

    fn fix(self, age_ms: u16) -> Fix {
        let (sin, cos) = libm::sincos(self.angle);
        let unit = |component: f64| libm::round(component * f64::from(HEADING_UNIT)) as i16;
        let micrometres = |metres: f64| libm::round(metres * 1e6) as i32;
        Fix { position: [micrometres(self.x), micrometres(self.y)], heading: [unit(cos), unit(sin)], age_ms }
    }
}

/// How far a pose is from the truth, metres and radians.
fn errors<S: Scalar>(pose: Pose<S>, truth: Truth) -> (f64, f64) {
    let distance = libm::hypot(pose.position.x.to_f64() - truth.x, pose.position.y.to_f64() - truth.y);
    let (sin, cos) = libm::sincos(truth.angle);
    (distance, libm::hypot(pose.heading.x.to_f64() - cos, pose.heading.y.to_f64() - sin))
}

fn tick<S: Scalar>(localisation: &mut Localisation<S>, fix: Option<Fix>, elapsed_us: u32) -> Option<Pose<S>> {
    localisation.update(&Percept { fix, elapsed_us, ..Percept::nothing() })
}

/// Wheel speeds of a robot that goes straight on, along curves, back, and turns on the spot.
fn wheels(tick: usize) -> [i16; 2] {
    [[700, 700], [300, 800], [900, -200], [-500, -650], [-400, 400], [0, 0], [1100, 1000]][tick / 5 % 7]
}

fn between_fixes_the_pose_is_that_of_the_arcs<S: Scalar>() {
    for elapsed_us in [5_000, 31_000, 31_250, 32_000, 100_000] {
        let mut localisation = Localisation::<S>::new();
        let mut truth = Truth::START;
        tick(&mut localisation, Some(truth.fix(0)), elapsed_us);
        for step in 0..(480_000 / elapsed_us as usize) {
            let wheels = wheels(step);
            localisation.drive(wheels[0], wheels[1]);
            truth = truth.after(wheels, f64::from(elapsed_us) * 1e-6);
            let (distance, angle) = errors(tick(&mut localisation, None, elapsed_us).unwrap(), truth);
            let bound = if elapsed_us > 50_000 { 6e-4 } else { 5e-5 };
            assert!(
                distance < bound && angle < 2.0 * bound + 2e-4,
                "{} {elapsed_us} µs, {step}: {distance} {angle}",
                S::NAME
            );
        }
    }
}

#[test]
fn between_fixes_it_goes_along_arcs() {
    between_fixes_the_pose_is_that_of_the_arcs::<f32>();
    between_fixes_the_pose_is_that_of_the_arcs::<Q8_24>();
}

/// The largest errors in 10 s with fixes of this age and period, in ticks of this length.
fn largest_errors<S: Scalar>(age_ms: u16, every: usize, elapsed_us: u32) -> (f64, f64) {
    let mut localisation = Localisation::<S>::new();
    let mut past = std::vec![(0_u32, Truth::START)];
    tick(&mut localisation, Some(Truth::START.fix(0)), elapsed_us);
    let (mut largest, mut now) = ((0.0_f64, 0.0_f64), 0);
    for step in 1..(10_000_000 / elapsed_us as usize) {
        let wheels = wheels(step);
        localisation.drive(wheels[0], wheels[1]);
        let (begun, truth) = *past.last().unwrap();
        now += elapsed_us;
        let truth = truth.after(wheels, f64::from(elapsed_us) * 1e-6);
        let measured = (step % every == 0).then(|| {
            // Before the start the robot stood still.
            let then = now.saturating_sub(u32::from(age_ms) * 1000);
            past.push((now, truth));
            let at = past.iter().rposition(|&(at, _)| at <= then).unwrap();
            let (at, truth) = past[at];
            // Within a tick the wheels keep their speeds: these of the tick that the measurement fell into.
            let wheels = self::wheels((at / elapsed_us) as usize + 1);
            past.pop();
            truth.after(wheels, f64::from(then - at) * 1e-6).fix(age_ms)
        });
        assert!(begun < now);
        past.push((now, truth));
        let (distance, angle) = errors(tick(&mut localisation, measured, elapsed_us).unwrap(), truth);
        largest = (largest.0.max(distance), largest.1.max(angle));
    }
    largest
}

#[test]
fn old_and_rare_fixes_are_carried_forward() {
    for elapsed_us in [31_000, 31_250, 32_000, 100_000] {
        for (age_ms, every) in [(0, 1), (100, 1), (300, 1), (300, 3), (250, 4), (600, 2)] {
            for (distance, angle) in
                [largest_errors::<f32>(age_ms, every, elapsed_us), largest_errors::<Q8_24>(age_ms, every, elapsed_us)]
            {
                // A part of a stretch is taken from its chord.
                let (bound, turn) = if elapsed_us > 50_000 { (4e-3, 4e-3) } else { (1.2e-3, 2e-2) };
                assert!(
                    distance < bound && angle < turn,
                    "{age_ms} ms, 1 of {every}, {elapsed_us} µs: {distance} {angle}"
                );
            }
        }
    }
}

#[test]
fn a_fix_older_than_what_is_remembered_does_not_count() {
    let mut localisation = Localisation::<f32>::new();
    assert_eq!(tick(&mut localisation, Some(Truth::START.fix(2000)), NOMINAL_TICK_US), None);
    assert!(tick(&mut localisation, Some(Truth::START.fix(600)), NOMINAL_TICK_US).is_some());
    for step in 1..=16 {
        let pose = tick(&mut localisation, Some(Truth::START.fix(2000)), NOMINAL_TICK_US);
        assert_eq!(pose.is_some(), step < 16, "{step}");
    }
}

#[test]
fn noise_is_damped_and_wheels_of_another_size_bias_little() {
    let mut localisation = Localisation::<f32>::new();
    let mut truth = Truth::START;
    let mut random = 1_u32;
    let mut noise = |half_width: f64| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (f64::from(random >> 8) / f64::from(1 << 23) - 1.0) * half_width
    };
    let (mut squares, mut count, mut sum) = (0.0, 0.0, 0.0);
    for step in 0..3000 {
        // Straight on, as the robot believes; its wheels are 5 % larger.
        localisation.drive(500, 500);
        truth = truth.after([525, 525], 0.03125);
        let seen = Truth { x: truth.x + noise(0.035), y: truth.y + noise(0.035), angle: truth.angle + noise(0.15) };
        let pose = tick(&mut localisation, Some(seen.fix(0)), NOMINAL_TICK_US).unwrap();
        if step > 30 {
            let along = (pose.position.x.to_f64() - truth.x) * libm::cos(truth.angle)
                + (pose.position.y.to_f64() - truth.y) * libm::sin(truth.angle);
            let (distance, _) = errors(pose, truth);
            (squares, count, sum) = (squares + distance * distance, count + 1.0, sum + along);
        }
    }
    // One fix is 20 mm off in each direction, 29 mm in all.
    let (rms, bias): (f64, f64) = (libm::sqrt(squares / count), sum / count);
    assert!(rms < 0.0125 && bias.abs() < 0.0015, "{rms} {bias}");
}

#[test]
fn a_jump_is_ignored_unless_it_lasts() {
    let mut localisation = Localisation::<f32>::new();
    let away = Truth { x: 2.0, ..Truth::START };
    let position = |localisation: &mut Localisation<f32>, truth: Truth| {
        tick(localisation, Some(truth.fix(0)), NOMINAL_TICK_US).unwrap().position.x
    };
    let near = |found: f32, truth: Truth| (f64::from(found) - truth.x).abs() < 1e-3;
    assert!(near(position(&mut localisation, Truth::START), Truth::START));
    for _ in 0..5 {
        for _ in 0..10 {
            assert!(near(position(&mut localisation, away), Truth::START));
        }
        assert!(near(position(&mut localisation, Truth::START), Truth::START));
    }
    // Carried away: believed after a third of a second.
    let found: Vec<bool> = (0..20).map(|_| near(position(&mut localisation, away), away)).collect();
    assert_eq!(found.iter().position(|&believed| believed), Some(11));
    assert!(found[11..].iter().all(|&believed| believed));
    // The same for a robot that was turned around where it stands.
    let turned = Truth { angle: away.angle + 3.0, ..away };
    let heading = |localisation: &mut Localisation<f32>| {
        errors(tick(localisation, Some(turned.fix(0)), NOMINAL_TICK_US).unwrap(), turned).1
    };
    assert!((0..10).all(|_| heading(&mut localisation) > 1.9));
    assert!((0..3).map(|_| heading(&mut localisation)).last().unwrap() < 1e-3);
}

#[test]
fn half_a_second_without_a_fix_the_pose_is_not_known() {
    for elapsed_us in [10_000, 31_250, 100_000] {
        let mut localisation = Localisation::<f32>::new();
        assert_eq!(tick(&mut localisation, None, elapsed_us), None);
        assert!(tick(&mut localisation, Some(Truth::START.fix(0)), elapsed_us).is_some());
        for step in 1..=60 {
            let known = tick(&mut localisation, None, elapsed_us).is_some();
            assert_eq!(known, step * elapsed_us < STALE_US, "{elapsed_us} µs, {step}");
        }
        // The next one is taken whole, wherever it is.
        let away = Truth { x: 9.0, ..Truth::START };
        let (distance, _) = errors(tick(&mut localisation, Some(away.fix(0)), elapsed_us).unwrap(), away);
        assert!(distance < 1e-5);
    }
}

#[test]
fn headings_keep_their_length() {
    let mut localisation = Localisation::<Q8_24>::new();
    let mut truth = Truth::START;
    let long = |truth: Truth| {
        let fix = truth.fix(0);
        Fix { heading: fix.heading.map(|component| component / 100 * 103), ..fix }
    };
    for step in 0..500 {
        let wheels = wheels(step);
        localisation.drive(wheels[0], wheels[1]);
        truth = truth.after(wheels, 0.1);
        let pose = tick(&mut localisation, Some(long(truth)), 100_000).unwrap();
        let length = pose.heading.length().to_f64();
        assert!((length - 1.0).abs() < 0.005, "{length}");
    }
}
