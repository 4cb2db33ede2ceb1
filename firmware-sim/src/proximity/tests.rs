use super::*;
use crate::lab::Laboratory;
use grn_core::robot::epuck2::PROXIMITY_BEARINGS_DEG;

const POSE: Pose = Pose { position: Vector::new(1.0, 2.0), heading: Vector::new(0.0, 1.0) };
const EVEN: Gains = Gains([1.0; PROXIMITY_SENSORS]);

fn stream() -> Stream {
    Stream::new(1, Component::Sensors, 0)
}

fn ring_with(change: impl FnOnce(&mut lab::Proximity)) -> ProximityRing {
    let mut proximity = Laboratory::perfect().proximity;
    change(&mut proximity);
    ProximityRing::new(&proximity)
}

fn ring() -> ProximityRing {
    ring_with(|_| ())
}

/// A point at `distance` from the pose, `bearing` degrees left of its heading.
fn at(bearing: f64, distance: f64) -> Point<f64> {
    let (sin, cos) = libm::sincos(bearing.to_radians());
    POSE.position + (POSE.heading * cos + POSE.heading.turned_left() * sin) * distance
}

/// What sensor 0 makes of this distance in metres, in 0.1 mm, so many times.
fn readings(ring: &ProximityRing, distance: f64, gains: &Gains, count: usize) -> Vec<u16> {
    let mut free = ALL_FREE;
    free[0][0] = distance;
    let mut noise = stream();
    (0..count).map(|_| ring.readings(&free, gains, &mut noise)[0]).collect()
}

#[test]
fn a_robot_straight_before_a_sensor_is_met_at_its_edge() {
    let ring = ring();
    for (sensor, bearing) in PROXIMITY_BEARINGS_DEG.into_iter().enumerate() {
        let mut free = ALL_FREE;
        ring.sense_body(&POSE, at(f64::from(bearing), 0.1), BODY_RADIUS, &mut free);
        assert!((free[0][sensor] - 0.03).abs() < 1e-12, "{bearing}: {free:?}");
        assert!(free[0].iter().enumerate().all(|(other, &f)| other == sensor || f > 0.03), "{bearing}: {free:?}");
    }
}

#[test]
fn a_robot_off_the_axis_is_met_on_its_flank_or_missed() {
    let ring = ring();
    // Straight ahead at 90 mm: both front sensors, 17° off the centre line.
    let mut free = ALL_FREE;
    ring.sense_body(&POSE, at(0.0, 0.09), BODY_RADIUS, &mut free);
    let (sin, cos) = libm::sincos(17f64.to_radians());
    let expected = 0.09 * cos - (0.035f64 * 0.035 - 0.09 * 0.09 * sin * sin).sqrt() - 0.035;
    assert!((free[0][0] - expected).abs() < 1e-12 && (free[0][7] - expected).abs() < 1e-12);
    assert!(free[0][1..7].iter().all(|f| f.is_infinite()));
    // Overlapping robots give no negative reading.
    let mut free = ALL_FREE;
    ring.sense_body(&POSE, at(90.0, 0.06), BODY_RADIUS, &mut free);
    assert_eq!(ring.readings(&free, &EVEN, &mut stream())[5], 0);
}

#[test]
fn walls_are_met_at_the_ray_s_distance() {
    let ring = ring();
    // A wall across the heading, its line 60 mm ahead.
    let edge = Edge::new(at(0.0, 0.06) + Vector::new(-1.0, 0.0), at(0.0, 0.06) + Vector::new(1.0, 0.0));
    let mut free = ALL_FREE;
    ring.sense_edge(&POSE, &edge, &mut free);
    let expected = |bearing: f64| 0.06 / libm::cos(bearing.to_radians()) - 0.035;
    let [free, ..] = free;
    assert!((free[0] - expected(17.0)).abs() < 1e-12 && (free[1] - expected(50.0)).abs() < 1e-12);
    // The sensors at 90° look along the wall, those at 150° away from it.
    assert!(free[2] > 1.0 && free[3].is_infinite() && free[4].is_infinite() && free[5] > 1.0);
    // The same from the edge's other direction, and a short edge beside the rays is missed.
    let mut reversed = ALL_FREE;
    ring.sense_edge(&POSE, &Edge::new(edge.end(), edge.start()), &mut reversed);
    assert!((reversed[0][0] - free[0]).abs() < 1e-15 && (reversed[0][6] - free[6]).abs() < 1e-15);
    let mut missed = ALL_FREE;
    ring.sense_edge(&POSE, &Edge::new(at(-10.0, 0.06), at(10.0, 0.06)), &mut missed);
    assert_eq!(missed, ALL_FREE);
}

#[test]
fn readings_are_tenths_of_millimetres_up_to_five_centimetres() {
    let mut free = ALL_FREE;
    (free[0][0], free[0][1], free[0][2]) = (0.0123, 0.05, 0.0501);
    let read = ring().readings(&free, &EVEN, &mut stream());
    assert_eq!(read, [123, 500, u16::MAX, u16::MAX, u16::MAX, u16::MAX, u16::MAX, u16::MAX]);
    let noisy = readings(&ring_with(|p| p.noise_m = 0.001), 0.02, &EVEN, 1000);
    assert!(noisy.iter().all(|r| (165..=235).contains(r)));
    assert!(noisy.iter().any(|&r| r < 190) && noisy.iter().any(|&r| r > 210));
}

#[test]
fn noise_grows_with_distance_and_gains_stay() {
    let spread = |distance| {
        let read = readings(&ring_with(|p| p.noise_growth = 0.1), distance, &EVEN, 4000);
        let mean = read.iter().map(|&r| f64::from(r)).sum::<f64>() / 4000.0;
        (read.iter().map(|&r| (f64::from(r) - mean) * (f64::from(r) - mean)).sum::<f64>() / 4000.0).sqrt()
    };
    assert!((spread(0.01) / 10.0 - 1.0).abs() < 0.1 && (spread(0.03) / 30.0 - 1.0).abs() < 0.1);
    let gains = Gains::drawn(0.2, 1, 3);
    assert_eq!(gains, Gains::drawn(0.2, 1, 3));
    assert_ne!(gains, Gains::drawn(0.2, 1, 4));
    assert_eq!(Gains::drawn(0.0, 1, 3), EVEN);
    let read = readings(&ring(), 0.02, &gains, 2);
    assert!(read[0] == read[1] && read[0] != 200 && (160..=240).contains(&read[0]), "{read:?}");
}

#[test]
fn every_response_falls_and_its_inverse_gives_the_distance_back() {
    for response in [Response::Distance, Response::Webots, Response::Argos, Response::Enki] {
        let mut before = f64::NAN;
        for step in 0..=70 {
            let distance = f64::from(step) * 1e-3;
            let (signal, noise) = response.signal(distance);
            assert!(noise >= 0.0);
            // Enki's is flat below 3 mm.
            let flat = response == Response::Enki && distance <= 0.003;
            let falls = if response == Response::Distance { before < signal } else { before > signal };
            assert!(before.is_nan() || flat || falls, "{response:?} {distance}");
            assert!(flat || (response.distance(signal) - distance).abs() < 1e-9, "{response:?} {distance}");
            before = signal;
        }
    }
    assert_eq!(Response::Webots.signal(0.025).0, (383.84 + 234.93) / 2.0);
}

#[test]
fn infrared_is_worse_far_away() {
    for response in [Response::Webots, Response::Enki] {
        let ring = ring_with(|p| p.response = response);
        let error = |distance: f64| {
            let read = readings(&ring, distance, &EVEN, 2000);
            let off = |&r: &u16| if r == u16::MAX { 0.0 } else { (f64::from(r) * 1e-4 - distance).abs() };
            read.iter().map(off).sum::<f64>() / 2000.0
        };
        assert!(error(0.04) > 2.0 * error(0.008), "{response:?}: {} {}", error(0.04), error(0.008));
        assert!(error(0.04) < 0.01);
        // A sensor that returns a tenth more than it should feels things nearer than they are.
        let strong = readings(&ring, 0.03, &Gains([1.1; PROXIMITY_SENSORS]), 500);
        let mean = strong.iter().map(|&r| f64::from(r)).sum::<f64>() / 500.0;
        assert!(mean < 297.0 && mean > 250.0, "{response:?}: {mean}");
    }
}

/// What the middle ray of sensor 0 makes of a wall across the sensor's axis, this far from its edge, in 0.1 mm.
fn before_a_wall(ring: &ProximityRing, distance: f64) -> u16 {
    let axis = f64::from(PROXIMITY_BEARINGS_DEG[0]);
    let (middle, aside) = (at(axis, BODY_RADIUS + distance), at(axis + 90.0, 1.0) - POSE.position);
    let mut free = ALL_FREE;
    ring.sense_edge(&POSE, &Edge::new(middle - aside, middle + aside), &mut free);
    ring.readings(&free, &EVEN, &mut stream())[0]
}

#[test]
fn three_rays_feel_a_wall_straight_ahead_like_one() {
    let three = ring_with(|p| (p.response, p.aperture_deg) = (Response::Argos, 15.0));
    for distance in [0.0, 0.01, 0.02, 0.03, 0.04] {
        let read = before_a_wall(&three, distance);
        assert!((f64::from(read) * 1e-4 - distance).abs() < 1e-4, "{distance}: {read}");
    }
    assert_eq!(before_a_wall(&three, 0.051), u16::MAX);
    // The nearest of three distances is that of the middle ray.
    assert_eq!(before_a_wall(&ring_with(|p| p.aperture_deg = 15.0), 0.03), 300);
}

#[test]
fn three_rays_feel_what_one_passes_by_and_miss_a_post() {
    let argos = |aperture_deg| ring_with(|p| (p.response, p.aperture_deg) = (Response::Argos, aperture_deg));
    let felt = |ring: &ProximityRing, centre: Point<f64>, radius: f64| {
        let mut free = ALL_FREE;
        ring.sense_body(&POSE, centre, radius, &mut free);
        ring.readings(&free, &EVEN, &mut stream())[0]
    };
    let axis = f64::from(PROXIMITY_BEARINGS_DEG[0]);
    let from_sensor = |turn: f64, distance: f64| {
        let (sin, cos) = libm::sincos((axis + turn).to_radians());
        let way = POSE.heading * cos + POSE.heading.turned_left() * sin;
        at(axis, BODY_RADIUS) + way * distance
    };
    // A rod of 4 mm, 2 cm before the sensor on each ray in turn: the side rays alone have signals of their own.
    for turn in [15.0, -15.0] {
        let rod = from_sensor(turn, 0.022);
        assert_eq!(felt(&argos(0.0), rod, 0.002), u16::MAX);
        let read = felt(&argos(15.0), rod, 0.002);
        assert!((199..=201).contains(&read), "{turn}: {read}");
    }
    assert_eq!(felt(&argos(0.0), from_sensor(0.0, 0.022), 0.002), 200);
    assert_eq!(felt(&argos(15.0), from_sensor(0.0, 0.022), 0.002), u16::MAX);
    // A wall that begins beside the ray, and a robot before the sensor.
    let robot = from_sensor(0.0, 0.02 + BODY_RADIUS);
    let read = felt(&argos(15.0), robot, BODY_RADIUS);
    assert!((200..260).contains(&read), "its flanks are farther away than those of a wall: {read}");
    let mut free = ALL_FREE;
    argos(15.0).sense_edge(&POSE, &Edge::new(from_sensor(10.0, 0.02), from_sensor(60.0, 0.02)), &mut free);
    assert!(free[0][0].is_infinite() && free[1][0].is_infinite() && free[2][0] < 0.02, "{free:?}");
}
