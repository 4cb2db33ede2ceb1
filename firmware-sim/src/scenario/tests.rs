use super::*;
use grn_core::geometry::Vector;

const CHANNEL: &str = include_str!("../../../scenarios/channel.toml");
const TWO: &str = include_str!("../../../scenarios/channel-two-targets.toml");
const COMPOUND: &str = include_str!("../../../scenarios/compound-channel.toml");

fn channel() -> Scenario {
    Scenario::parse(CHANNEL).unwrap()
}

/// The error of the channel scenario with `from` replaced by `to`.
fn fault(from: &str, to: &str) -> ScenarioError {
    assert!(CHANNEL.contains(from), "{from}");
    Scenario::parse(&CHANNEL.replace(from, to)).unwrap_err()
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
    assert_eq!(Scenario::parse(COMPOUND).unwrap().walls().polygons().len(), 11);
    assert_eq!(channel().morphogen().kernel, Kernel::Gaussian);
    assert_eq!((channel().name(), channel().region(), channel().snapshots()), ("channel", [20.0, 20.0], 15));
}

#[test]
fn every_error_names_place_value_and_remedy() {
    let cases = [
        ("region = [20.0, 20.0]", "region = [20.0, -3.0]", "region[1]", "-3", "positive"),
        ("region = [20.0, 20.0]", "region = [inf, 20.0]", "region[0]", "inf", "positive"),
        ("snapshots = 15", "snapshots = 0", "snapshots", "0", "1..=10000"),
        ("snapshots = 15", "snapshots = 10001", "snapshots", "10001", "1..=10000"),
        ("target_width = 1.5", "target_width = 0", "morphogen.target_width", "0", "positive"),
        ("obstacle_width = 0.9", "obstacle_width = nan", "morphogen.obstacle_width", "NaN", "positive"),
        ("level = 0.5", "level = 1", "morphogen.level", "1", "between 0 and 1"),
        ("d_min = 1.0", "d_min = -1.0", "ring.d_min", "-1", "at least 0"),
        ("d_max = 2.0", "d_max = 1.0", "ring.d_max", "1", "above d_min = 1"),
        ("d_obstacle = 2.0", "d_obstacle = -2.0", "ring.d_obstacle", "-2", "at least 0"),
        ("steepness = 10.0", "steepness = 0.0", "ring.steepness", "0", "positive"),
        ("path = [[3.0000, 10.0000], [17.0000, 10.0000]]", "path = []", "target[0].path", "[]", "at least 1 point"),
        ("[17.0000, 10.0000]", "[10.0, 15.0]", "target[0].path[1]", "[10.0, 15.0]", "inside wall[0]"),
        ("[3.0000, 10.0000]", "[10.0, 1.0]", "target[0].path[0]", "[10.0, 1.0]", "inside wall[1]"),
        ("[17.0000, 10.0000]", "[17.0, 16.0]", "target[0].path[1]", "[17.0, 16.0]", "meets a wall"),
        ("[17.0000, 10.0000]", "[inf, 16.0]", "target[0].path[1]", "[inf, 16.0]", "finite"),
        (", [14.0000, 20.0000], [6.0000, 20.0000]", "", "wall[0].polygon", "2 points", "at least 3"),
        ("[14.0000, 6.0000], [6.0000, 6.0000]", "[6.0, 6.0], [14.0, 6.0]", "wall[1].polygon", "edges", "cross"),
        ("[14.0000, 6.0000], [6.0000, 6.0000]", "[9.0, 0.0]", "wall[1].polygon", "no area", "on a line"),
        ("[14.0000, 20.0000]", "[nan, 20.0]", "wall[0].polygon[2]", "[NaN, 20.0]", "finite"),
        ("[14.0000, 20.0000]", "[14.0, 14.0]", "wall[0].polygon[1]", "[14.0, 14.0]", "differ"),
        ("snapshots = 15", "snapshot = 15", "line 4", "snapshot = 15", "unknown field `snapshot`"),
        ("level = 0.5", "level = 0.5\nnoise = 2", "line 11", "noise = 2", "unknown field `noise`"),
        ("kernel = \"gaussian\"", "kernel = \"box\"", "line 7", "kernel = \"box\"", "`gaussian`"),
        ("d_max = 2.0", "d_max = ", "line 14", "d_max =", ""),
        ("steepness = 10.0", "", "", "", "missing field `steepness`"),
    ];
    for (from, to, place, value, remedy) in cases {
        let error = fault(from, to);
        let shown = error.to_string();
        assert!(place.is_empty() || error.place == place, "{to}: {shown}");
        assert!(error.value.contains(value) && error.expected.contains(remedy), "{to}: {shown}");
        assert!(shown.contains(place) && shown.contains(value) && shown.contains(remedy), "{shown}");
    }
}

#[test]
fn targets_are_counted() {
    let cut = CHANNEL.replace("[[target]]\npath = [[3.0000, 10.0000], [17.0000, 10.0000]]", "");
    assert_eq!(Scenario::parse(&cut).unwrap_err().value, "0 of them");
    let many = format!("{CHANNEL}\n{}", "[[target]]\npath = [[1.0, 1.0]]\n".repeat(4));
    assert_eq!(Scenario::parse(&many).unwrap_err().value, "5 of them");
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
    let snapshots = two.snapshot_targets();
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
    assert_eq!(one.snapshot_targets(), [vec![Vector::new(3.0, 10.0)]]);
}

#[test]
fn obstacle_points_are_boundary_samples_near_targets() {
    let scenario = channel();
    // Each wall: 8 x 6 m, 28 m of outline, 56 samples from (6, 14) and (6, 0).
    let samples = scenario.boundary_samples();
    assert_eq!(samples.len(), 112);
    assert_eq!(
        (samples[0], samples[1], samples[17]),
        (Vector::new(6.0, 14.0), Vector::new(6.5, 14.0), Vector::new(14.0, 14.5))
    );
    let points = scenario.obstacle_points(&[Vector::new(10.0, 10.0)]);
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
    assert_eq!(scaled.walls().polygons()[0].vertices()[0], Vector::new(1.5, 3.5));
    assert_eq!(scaled.walls().polygons()[0].area(), 3.0);
}
