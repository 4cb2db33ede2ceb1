//! Worlds that move.

use super::*;

const OPEN: &str = include_str!("../../../../scenarios/open.toml");

fn with(more: &str) -> Result<Scenario, InputError> {
    Scenario::parse(&format!("{OPEN}\n{more}"))
}

/// A square of 1 m whose south-west corner is here, and what it does.
fn square(x: f64, y: f64, more: &str) -> String {
    let corners = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
    format!("[[wall]]\npolygon = {corners:?}\n{more}\n")
}

#[test]
fn the_shipped_worlds_move_and_round_trip() {
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/moving");
    let mut seen = 0;
    for file in std::fs::read_dir(shipped).unwrap() {
        let world = Scenario::load(file.unwrap().path()).unwrap();
        assert!(world.walls_change() || !world.changes().is_empty(), "{}", world.name());
        assert_eq!(Scenario::parse(&world.to_toml()).unwrap(), world);
        assert_eq!(world.scaled(0.25).walls_at(0.4), world.walls_at(0.4).scaled(0.25));
        seen += 1;
    }
    assert_eq!(seen, 4);
}

#[test]
fn the_adaptive_worlds_are_passable_at_every_moment() {
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/adaptive");
    let mut moving = 0;
    let mut seen: Vec<String> = Vec::new();
    for file in std::fs::read_dir(shipped).unwrap() {
        let path = file.unwrap().path();
        let world = Scenario::load(&path).unwrap();
        assert_eq!(path.file_stem().unwrap().to_str(), Some(world.name()));
        assert_eq!(Scenario::parse(&world.to_toml()).unwrap(), world);
        let target = &world.targets()[0];
        let places: Vec<Point<f64>> = (0..=200).map(|step| target.path.at(f64::from(step) / 200.0)).collect();
        let mut clearance = f64::INFINITY;
        for moment in 0..=400 {
            let walls = world.walls_at(f64::from(moment) / 400.0);
            clearance = places.iter().map(|&place| walls.signed_distance(place)).fold(clearance, f64::min);
        }
        let stated = match world.name() {
            "tight" => 1.2,
            "corner" => 0.8 * core::f64::consts::FRAC_1_SQRT_2,
            _ => 0.8,
        };
        assert!((clearance - stated).abs() < 1e-3, "{}: {clearance}", world.name());
        for wall in world.moving_walls() {
            assert!(wall.length_at_full_speed() < target.path.length_at_full_speed(), "{}", world.name());
            moving += 1;
        }
        seen.push(world.name().to_owned());
    }
    assert_eq!((seen.len(), moving), (9, 4), "{seen:?}");
}

#[test]
fn targets_stop_wait_and_vanish() {
    let open = Scenario::parse(OPEN).unwrap();
    let path = open.targets()[0].path().points().to_vec();
    let target =
        "path = [[3.0, 3.0], [7.0, 3.0], [7.0, 3.0], [7.0, 5.0]]\ntimes = [0.1, 0.3, 0.5, 0.9]\npresent = [[0.0, 0.8]]";
    let world = with(&format!("[[target]]\n{target}\n")).unwrap();
    let second = |time: f64| world.targets()[1].at(time).map(|p| (p.x, p.y));
    assert_eq!(second(0.0), Some((3.0, 3.0)));
    assert_eq!(second(0.2), Some((5.0, 3.0)));
    assert_eq!((second(0.3), second(0.4), second(0.5)), (Some((7.0, 3.0)), Some((7.0, 3.0)), Some((7.0, 3.0))));
    assert_eq!((second(0.7), second(0.8), second(1.0)), (Some((7.0, 4.0)), None, None));
    assert_eq!((world.targets_at(0.7).len(), world.targets_at(0.8)), (2, open.targets_at(0.8)));
    assert_eq!((world.targets()[1].path().length(), world.changes()), (6.0, vec![0.8]));
    // 4 m in a fifth of the time.
    assert!((world.longest_path() - 20.0f64.max(Path::new(path).length())).abs() < 1e-12);
    assert_eq!(world.travel_s(0.5), world.longest_path() / 0.5);
}

#[test]
fn walls_move_turn_come_and_go() {
    let world = with(&square(2.0, 2.0, "path = [[2.0, 2.0], [6.0, 2.0]]\nturn_deg = [0.0, 90.0]\ntimes = [0.0, 0.5]\npresent = [[0.0, 0.6], [0.9, 1.0]]")).unwrap();
    assert!(world.fixed_walls().is_empty() && world.walls_change());
    let corners = |time: f64| world.walls_at(time).polygons().next().map(|wall| wall.vertices().to_vec());
    assert_eq!(corners(0.0).unwrap()[2], Vector::new(3.0, 3.0));
    let half = corners(0.25).unwrap();
    assert!((half[0] - Vector::new(4.0, 2.0)).length() < 1e-12);
    assert!((half[1] - Vector::new(4.0 + 0.5f64.sqrt(), 2.0 + 0.5f64.sqrt())).length() < 1e-12);
    let turned = corners(0.55).unwrap();
    for (corner, (x, y)) in turned.iter().zip([(6.0, 2.0), (6.0, 3.0), (5.0, 3.0), (5.0, 2.0)]) {
        assert!((*corner - Vector::new(x, y)).length() < 1e-12, "{turned:?}");
    }
    assert_eq!((corners(0.6), corners(0.7), corners(1.0)), (None, None, Some(turned)));
    assert_eq!(world.changes(), [0.6, 0.9]);
    let wall = &world.walls_at(0.25);
    assert!((wall.signed_distance(Vector::new(4.0, 2.5)) + 0.5 * 0.5f64.sqrt()).abs() < 1e-12, "inside, 0.35 m deep");
    assert!(world.extent().low.x <= 1.0 && world.extent().high.x >= 7.0);
    // Its far corner goes a quarter of a turn on an arm of the diagonal while it moves 4 m, in half the time.
    let expected = 2.0 * (4.0 + 2.0f64.sqrt() * core::f64::consts::FRAC_PI_2);
    let own = world.moving_walls()[0].length_at_full_speed();
    assert!((own - expected).abs() < 1e-9, "{own}");
}

#[test]
fn moving_walls_among_fixed_ones_measure_alike() {
    let still = with(&format!("{}{}", square(2.0, 2.0, ""), square(8.0, 3.0, ""))).unwrap();
    let door = with(&format!("{}{}", square(2.0, 2.0, ""), square(8.0, 3.0, "present = [[0.0, 0.5]]"))).unwrap();
    let (fixed, mixed) = (still.walls_at(0.2), door.walls_at(0.2));
    assert_eq!((mixed.fixed().len(), mixed.moving().len()), (1, 1));
    let mut stream = crate::random::Stream::new(1, crate::random::Component::Placement, 0);
    for _ in 0..2000 {
        let p = Vector::new(stream.unit() * 20.0, stream.unit() * 8.0);
        assert_eq!(fixed.signed_distance(p), mixed.signed_distance(p), "{p:?}");
        assert_eq!(fixed.nearest_boundary(p).map(|b| b.1), mixed.nearest_boundary(p).map(|b| b.1));
        let direction = Vector::new(stream.symmetric(), stream.symmetric()).direction().unwrap();
        assert_eq!(fixed.ray(p, direction, 9.0), mixed.ray(p, direction, 9.0));
        assert_eq!(fixed.containing(p).is_some(), mixed.containing(p).is_some());
    }
}

#[test]
fn what_cannot_move_so_is_refused() {
    let target = |more: &str| format!("[[target]]\npath = [[3.0, 3.0], [7.0, 3.0]]\n{more}");
    let cases = [
        (target("times = [0.0]"), "target[1].times = 1 times: one time is needed for each of the 2 places"),
        (target("times = [0.0, 60.0]"), "target[1].times[1] = 60.0: times go from 0"),
        (target("times = [0.5, 0.5]"), "target[1].times[1] = 0.5: must be later"),
        (target("times = [nan, 0.5]"), "target[1].times[0] = nan: times go from 0"),
        (target("present = [[0.6, 0.5]]"), "target[1].present[0] = [0.6, 0.5]: a span ends after it begins"),
        (target("presence = [[0.6, 0.5]]"), "unknown key; did you mean present?"),
        (square(2.0, 2.0, "path = [[2.0, 2.0]]"), "wall[0].path: one point is no way"),
        (square(2.0, 2.0, "turn_deg = [0.0, 9.0]"), "wall[0].turn_deg: the point that the wall turns about is missing"),
        (square(2.0, 2.0, "path = [[2.0, 2.0]]\nturn_deg = [0.0, inf]"), "wall[0].turn_deg[1] = inf: must be"),
        (
            square(2.0, 2.0, "path = [[2.0, 2.0], [3.0, 2.0]]\nturn_deg = [0.0, 1.0, 2.0]"),
            "wall[0].turn_deg = 3 angles: one angle is needed for each of the 2 points",
        ),
        (square(2.0, 2.0, "times = [0.0, 1.0]"), "wall[0].times: times are of a path or of turns"),
        (
            square(2.0, 2.0, "path = [[2.0, 2.0], [2.0, 2.0], [3.0, 2.0]]"),
            "wall[0].path: a point equals the one before",
        ),
        (
            square(2.0, 2.0, "path = [[2.0, 2.0], [900.0, 2.0]]"),
            "wall[0].path[1] = [900.0, 2.0]: must be finite and at most 100",
        ),
        (square(8.5, 9.0, "path = [[9.0, 9.5], [9.0, 12.5]]"), "wall[0]: this wall runs into target[0]"),
        (
            square(11.0, 9.8, "present = [[0.4, 0.6]]"),
            "wall[0]: this wall runs into target[0] (counted from 0) at time 0.4",
        ),
    ];
    for (more, words) in cases {
        let error = with(&more).unwrap_err().to_string();
        assert!(error.contains(words), "{more}\n{error}\n{words}");
    }
    let alone = |from: &str, to: &str| Scenario::parse(&OPEN.replace(from, to)).unwrap_err().to_string();
    let nobody = alone("[[target]]", "[[target]]\npresent = [[0.0, 0.4]]");
    assert!(nobody.contains("target: no target is there at time 0.4; let one be there"), "{nobody}");
    let many = with(&square(2.0, 2.0, "present = [[0.0, 0.5]]"))
        .unwrap()
        .to_toml()
        .replace("snapshots = 20", "snapshots = 200");
    let many = Scenario::parse(&many).unwrap_err().to_string();
    assert!(many.contains("snapshots = 200: with walls that move, come or go at most"), "{many}");
}

#[test]
fn a_world_in_which_nothing_moves_says_how_long_it_takes() {
    let rests = "path = [[9.0, 9.0]]";
    let start = OPEN.find("path").unwrap();
    let end = start + OPEN[start..].find('\n').unwrap();
    let resting = format!("{}{rests}{}{}", &OPEN[..start], &OPEN[end..], square(2.0, 2.0, "present = [[0.0, 0.5]]"));
    let error = Scenario::parse(&resting).unwrap_err().to_string();
    assert!(error.contains("duration_s: nothing moves") && error.contains("add duration_s"), "{error}");
    let world = Scenario::parse(&resting.replace("snapshots", "duration_s = 90.0\nsnapshots")).unwrap();
    assert_eq!((world.travel_s(0.03), world.scaled(0.25).travel_s(0.1)), (90.0, 90.0));
    assert_eq!(Scenario::parse(&world.to_toml()).unwrap(), world);
    let long = Scenario::parse(&resting.replace("snapshots", "duration_s = 1e9\nsnapshots")).unwrap_err().to_string();
    assert!(long.contains("duration_s = 1e9: must be a number from 0.1 to 3600000 seconds"), "{long}");
}
