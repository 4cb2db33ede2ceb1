use super::*;

mod discs;
mod moving;
mod starts;
use grn_core::geometry::Vector;

const CHANNEL: &str = include_str!("../../../scenarios/channel.toml");
const TWO: &str = include_str!("../../../scenarios/channel-two-targets.toml");
const COMPOUND: &str = include_str!("../../../scenarios/compound-channel.toml");

fn channel() -> Scenario {
    Scenario::parse(CHANNEL).unwrap()
}

/// The error of the channel scenario with `from` replaced by `to`.
fn fault(from: &str, to: &str) -> InputError {
    assert!(CHANNEL.contains(from), "{from}");
    Scenario::parse(&CHANNEL.replace(from, to)).map(|_| ()).unwrap_err()
}

#[test]
fn the_repository_s_scenarios_load_and_round_trip() {
    for text in [CHANNEL, TWO, COMPOUND] {
        let scenario = Scenario::parse(text).unwrap();
        let canonical = scenario.to_toml();
        let again = Scenario::parse(&canonical).unwrap();
        assert_eq!(scenario, again);
        assert_eq!(canonical, again.to_toml());
        let through_serde: Scenario = toml::from_str(&toml::to_string(&scenario).unwrap()).unwrap();
        assert_eq!(scenario, through_serde);
    }
    assert_eq!(Scenario::parse(COMPOUND).unwrap().fixed_walls().fixed().len(), 11);
    assert_eq!(channel().morphogen().kernel, Kernel::Gaussian);
    assert_eq!((channel().name(), channel().region(), channel().snapshots()), ("channel", [20.0, 20.0], 15));
}

#[test]
fn every_error_names_place_value_and_remedy() {
    let cases = [
        ("region = [20.0, 20.0]", "region = [20.0, -3.0]", "3:17: region[1] = -3.0: must be a number from 0.5 to 3000"),
        ("region = [20.0, 20.0]", "region = [inf, 20.0]", "3:11: region[0] = inf: must be"),
        ("region = [20.0, 20.0]", "region = [1e20, 20.0]", "3:11: region[0] = 1e20: must be"),
        ("region = [20.0, 20.0]", "region = [2e3, 2e3]", "3:10: region = [2e3, 2e3]: 1.0e8 lattice nodes"),
        ("region = [20.0, 20.0]", "region = [20.0, 20.0, 1]", "3:10: region = [20.0, 20.0, 1]: invalid length 3"),
        ("snapshots = 15", "snapshots = 0", "4:13: snapshots = 0: must be a number from 1 to 10000"),
        ("snapshots = 15", "snapshots = 10001", "4:13: snapshots = 10001: must be"),
        ("snapshots = 15", "snapshots = 5000", "4:13: snapshots = 5000: too many for a region of [20.0, 20.0] metres"),
        (
            "snapshots = 15",
            "snapshots = 99999999999999999999",
            "4:13: snapshots = 99999999999999999999: must be a smaller whole number",
        ),
        ("snapshots = 15", "snapshots = 1.5", "4:13: snapshots = 1.5: must be a whole number, without point"),
        (
            "target_width = 1.5",
            "target_width = 0",
            "8:16: morphogen.target_width = 0: must be a number from 0.01 to 100",
        ),
        ("target_width = 1.5", "target_width = 150", "8:16: morphogen.target_width = 150: must be"),
        ("obstacle_width = 0.9", "obstacle_width = nan", "9:18: morphogen.obstacle_width = nan: must be"),
        ("level = 0.5", "level = 0.995", "10:9: morphogen.level = 0.995: must be a number from 0.01 to 0.99"),
        ("d_min = 1.0", "d_min = -1.0", "13:9: ring.d_min = -1.0: must be a number from 0 to 100"),
        ("d_max = 2.0", "d_max = 1.0", "14:9: ring.d_max = 1.0: must be above d_min = 1.0"),
        ("d_max = 2.0", "d_max = 30.0", "14:9: ring.d_max = 30.0: a ring of this radius does not fit"),
        ("d_obstacle = 2.0", "d_obstacle = 1e9", "15:14: ring.d_obstacle = 1e9: must be a number from 0 to 100 metres"),
        ("steepness = 10.0", "steepness = 0.001", "16:13: ring.steepness = 0.001: must be a number from 0.5 to 1000"),
        ("steepness = 10.0", "steepness = 5e-324", "16:13: ring.steepness = 5e-324: must be"),
        ("[[3.0000, 10.0000], [17.0000, 10.0000]]", "[]", "19:8: target[0].path = []: a path needs at least 1 point"),
        ("[17.0000, 10.0000]", "[10.0, 15.0]", "19:28: target[0].path[1] = [10.0, 15.0]: is inside wall[0]"),
        ("[3.0000, 10.0000]", "[10.0, 1.0]", "19:9: target[0].path[0] = [10.0, 1.0]: is inside wall[1]"),
        (
            "[17.0000, 10.0000]",
            "[17.0, 16.0]",
            "19:28: target[0].path[1] = [17.0, 16.0]: the straight way from the point before it meets wall[0]",
        ),
        ("[17.0000, 10.0000]", "[inf, 16.0]", "19:28: target[0].path[1] = [inf, 16.0]: must lie in the region"),
        (
            "[17.0000, 10.0000]",
            "[27.0, 10.0]",
            "19:28: target[0].path[1] = [27.0, 10.0]: must lie in the region, 20.0 x 20.0 metres",
        ),
        ("[[3.0000, 10.0000],", "[[-0.1, 10.0],", "19:9: target[0].path[0] = [-0.1, 10.0]: must lie in the region"),
        (
            ", [14.0000, 20.0000], [6.0000, 20.0000]",
            "",
            "22:11: wall[0].polygon = 2 points: a polygon needs at least 3",
        ),
        (
            "[14.0000, 6.0000], [6.0000, 6.0000]",
            "[6.0, 6.0], [14.0, 6.0]",
            "wall[1].polygon[3] = [14.0, 6.0]: the edge from here to [6.0, 0.0] meets the one from [14.0, 0.0] to [6.0, 6.0]",
        ),
        ("[14.0000, 6.0000], [6.0000, 6.0000]", "[9.0, 0.0]", "25:11: wall[1].polygon: encloses no area"),
        ("[14.0000, 20.0000]", "[nan, 20.0]", "wall[0].polygon[2] = [nan, 20.0]: must be finite"),
        ("[14.0000, 20.0000]", "[1e9, 20.0]", "wall[0].polygon[2] = [1e9, 20.0]: must be finite and at most 100"),
        ("[14.0000, 20.0000]", "[14.0, 14.0]", "wall[0].polygon[1] = [14.0000, 14.0000]: must differ"),
        ("name = \"channel\"", "name = \"..\"", "2:8: name = \"..\": a name with letters or digits"),
        ("name = \"channel\"", "name = \"a\\u0000\"", "2:8: name = \"a\\u0000\": a name is one line"),
        ("name = \"channel\"", "name = 3", "2:8: name = 3: must be a text in quotes"),
        ("snapshots = 15", "snapshot = 15", "4:1: snapshot: unknown key; did you mean snapshots?"),
        ("level = 0.5", "level = 0.5\nnoise = 2", "11:1: morphogen.noise: unknown key (known here: kernel"),
        (
            "kernel = \"gaussian\"",
            "kernel = \"box\"",
            "7:10: morphogen.kernel = \"box\": unknown name (known here: gaussian, exponential)",
        ),
        ("d_max = 2.0", "d_max = ", "14:9: d_max =: a value is missing"),
        ("steepness = 10.0", "", "12:1: ring.steepness: is missing; add it"),
        ("region = [20.0, 20.0]", "region = [20.0, 20.0", "3:10: the list that begins here is not closed"),
    ];
    for (from, to, beginning) in cases {
        let shown = fault(from, to).to_string();
        assert!(shown.contains(beginning), "{to}:\n{shown}\n{beginning}");
    }
    let long = fault("channel", &"x".repeat(1001)).to_string();
    assert!(long.contains("2:8: name = ") && long.contains("a name of 1001 bytes is too long"), "{long}");
}

#[test]
fn too_much_together_is_refused() {
    let polygon = |count: usize, radius: f64, x: f64| {
        let corner = |i: usize| {
            let (sin, cos) = libm::sincos(i as f64 * core::f64::consts::TAU / count as f64);
            format!("[{:?}, {:?}]", x + radius * cos, 17.0 + radius * sin)
        };
        let corners: Vec<String> = (0..count).map(corner).collect();
        format!("\n[[wall]]\npolygon = [{}]\n", corners.join(", "))
    };
    let error = |more: String| Scenario::parse(&(CHANNEL.to_owned() + &more)).unwrap_err().to_string();
    let crowded = error(polygon(1001, 2.0, 10.0));
    assert!(crowded.contains("wall[2].polygon = 1001 points: at most 1000"), "{crowded}");
    assert!(error(polygon(1000, 2.0, 10.0).repeat(20)).contains("wall[21].polygon = 20008 points: with this one"));
    let points = vec!["[3.0, 10.0]"; 1001].join(", ");
    let path = CHANNEL.replace("[3.0000, 10.0000]", &points);
    assert!(Scenario::parse(&path).unwrap_err().to_string().contains("target[0].path = 1002 points: at most 1000"));
    let outlines = CHANNEL.replace("snapshots = 15", "snapshots = 660") + &polygon(500, 90.0, 0.0).repeat(6);
    let error = Scenario::parse(&outlines).unwrap_err().to_string();
    assert!(error.contains("outlines are") && error.contains("660 snapshots"), "{error}");
    let table =
        CHANNEL.replace("steepness = 10.0", "steepness = 999.0").replace("d_obstacle = 2.0", "d_obstacle = 99.0");
    let error = Scenario::parse(&table).unwrap_err().to_string();
    assert!(error.contains("ring.steepness = 999.0: with distances up to 99.0 metres a table"), "{error}");
    let twins = format!("{CHANNEL}\n[[target]]\npath = [[3.0, 10.0], [17.0, 10.0]]\n");
    let error = Scenario::parse(&twins).unwrap_err().to_string();
    assert!(error.contains("target[1].path: the same path as target[0]"), "{error}");
    // A target that rests, written as a path of equal points.
    let rests = CHANNEL.replace("[17.0000, 10.0000]", "[3.0, 10.0]");
    assert_eq!(Scenario::parse(&rests).unwrap().longest_path(), 0.0);
}

#[test]
fn targets_are_counted() {
    let cut = CHANNEL.replace("[[target]]\npath = [[3.0000, 10.0000], [17.0000, 10.0000]]", "");
    assert_eq!(Scenario::parse(&cut).unwrap_err().value(), "0 of them");
    let many = format!("{CHANNEL}\n{}", "[[target]]\npath = [[1.0, 1.0]]\n".repeat(10));
    assert_eq!(Scenario::parse(&many).unwrap_err().value(), "11 of them");
}

#[test]
fn a_missing_file_is_named() {
    let error = Scenario::load("no/such/world.toml").unwrap_err();
    assert!(error.to_string().starts_with("no/such/world.toml: cannot be read"), "{error}");
}

#[test]
fn targets_move_by_arc_length_and_arrive_together() {
    let two = Scenario::parse(TWO).unwrap();
    assert_eq!(two.targets_at(0.0), [Vector::new(3.5, 10.0), Vector::new(2.5, 10.0)]);
    assert_eq!(two.targets_at(1.0), [Vector::new(18.0, 10.0), Vector::new(12.0, 10.0)]);
    assert_eq!(two.targets_at(0.5), [Vector::new(10.75, 10.0), Vector::new(7.25, 10.0)]);
    assert_eq!(two.longest_path(), 14.5);
    let snapshots: Vec<_> = two.snapshot_times().map(|time| two.targets_at(time)).collect();
    assert_eq!((snapshots.len(), &snapshots[7]), (15, &two.targets_at(0.5)));
    assert_eq!(snapshots[14], two.targets_at(1.0));
    let bent = Path::new(vec![Vector::new(0.0, 0.0), Vector::new(3.0, 0.0), Vector::new(3.0, 1.0)]);
    assert_eq!((bent.length(), bent.at(0.75), bent.at(0.875)), (4.0, Vector::new(3.0, 0.0), Vector::new(3.0, 0.5)));
    let resting = Path::new(vec![Vector::new(1.0, 2.0)]);
    assert_eq!(
        (resting.at(0.3), resting.at(-1.0), resting.at(f64::NAN)),
        (resting.at(1.0), resting.at(1.0), resting.at(0.0))
    );
    let one = Scenario::parse(&CHANNEL.replace("snapshots = 15", "snapshots = 1")).unwrap();
    assert_eq!(one.snapshot_times().collect::<Vec<_>>(), [0.0]);
}

#[test]
fn obstacle_points_are_boundary_samples_near_targets() {
    let scenario = channel();
    // Each wall: 8 x 6 m, 28 m of outline, 56 samples from (6, 14) and (6, 0).
    let walls = scenario.fixed_walls();
    let samples = walls.boundary_samples(OBSTACLE_SPACING);
    assert_eq!(samples.len(), 112);
    assert_eq!(
        (samples[0], samples[1], samples[17]),
        (Vector::new(6.0, 14.0), Vector::new(6.5, 14.0), Vector::new(14.0, 14.5))
    );
    let points = Scenario::obstacle_points(walls, &[Vector::new(10.0, 10.0)]);
    // On each side the edge 4 m away: x within 3 m of the target, 13 samples.
    assert_eq!(points.len(), 26);
    assert!(points.iter().all(|p| (p.y == 14.0 || p.y == 6.0) && (p.x - 10.0).abs() <= 3.0));
}

#[test]
fn scaling_multiplies_lengths() {
    let scaled = channel().scaled(0.25);
    assert_eq!(scaled.region(), [5.0, 5.0]);
    assert_eq!((scaled.morphogen().target_width, scaled.morphogen().level), (0.375, 0.5));
    assert_eq!((scaled.ring().d_max, scaled.ring().steepness), (0.5, 40.0));
    assert_eq!(scaled.targets_at(0.0), [Vector::new(0.75, 2.5)]);
    assert_eq!(scaled.longest_path(), 3.5);
    assert_eq!(scaled.fixed_walls().fixed()[0].vertices()[0], Vector::new(1.5, 3.5));
    assert_eq!(scaled.fixed_walls().fixed()[0].area(), 3.0);
}
