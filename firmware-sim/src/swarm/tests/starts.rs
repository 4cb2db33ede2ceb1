//! Where robots begin, and targets that evade them.

use super::*;
use crate::scenario::Disc;
use grn_core::geometry::Vector;

fn world(more: &str) -> Scenario {
    Scenario::parse(&format!("{CHANNEL}\n{more}\n")).unwrap()
}

fn poses(more: &str, robots: usize) -> Vec<Pose> {
    Swarm::new(&world(more), SwarmConfig::default().with_robots(robots), wanderer).unwrap().poses().to_vec()
}

fn refused(more: &str, robots: usize) -> String {
    check(&world(more), &SwarmConfig::default().with_robots(robots)).unwrap_err().to_string()
}

#[test]
fn robots_begin_where_the_world_says() {
    // Half of the disc is in a wall.
    let disc = Disc { centre: Vector::new(2.0, 3.4), radius: 0.6 };
    let starts = poses("[start]\ncentre = [8.0, 13.6]\nradius = 2.4", 60);
    let walls = channel().scaled(0.25).walls_at(0.0);
    for (robot, pose) in starts.iter().enumerate() {
        assert!((pose.position - disc.centre).length() <= disc.radius);
        assert!(walls.signed_distance(pose.position) >= BODY_RADIUS);
        let apart = |other: &Pose| (other.position - pose.position).length() >= 2.0 * BODY_RADIUS;
        assert!(starts[..robot].iter().all(apart));
    }
    let places = "[start]\npositions = [[2.0, 8.0], [2.0, 9.0], [2.5, 10.0], [3.0, 12.0]]";
    let starts = poses(places, 3);
    let expected = [[0.5, 2.0], [0.5, 2.25], [0.625, 2.5]].map(|[x, y]| Vector::new(x, y));
    assert_eq!(starts.iter().map(|pose| pose.position).collect::<Vec<_>>(), expected);
    assert!(starts.iter().all(|pose| (pose.heading.length() - 1.0).abs() < 1e-12));
}

#[test]
fn starts_without_room_are_refused_before_a_run() {
    let shown = refused("[start]\ncentre = [3.0, 9.0]\nradius = 1.0", 60);
    assert!(shown.contains("start.radius = 1.0: 60 robots find no room"), "{shown}");
    let shown = refused("[start]\npositions = [[2.0, 8.0], [2.0, 9.0]]", 3);
    assert!(shown.contains("start.positions = 2 places: the laboratory has 3 robots"), "{shown}");
    let shown = refused("[start]\npositions = [[2.0, 8.0], [2.0, 8.2], [2.0, 9.0]]", 3);
    assert!(shown.contains("start.positions[1] = [2.0, 8.2]: a robot, 0.28 m across"), "{shown}");
    let shown = refused("[start]\npositions = [[8.0, 13.9], [2.0, 8.2], [2.0, 9.0]]", 3);
    assert!(shown.contains("start.positions[0] = [8.0, 13.9]: a robot"), "{shown}");
}

/// The channel with a target that evades.
fn evading() -> Scenario {
    let line = "path = [[3.0000, 10.0000], [17.0000, 10.0000]]";
    let evade = "evade = { distance = 2.4, reach = 0.5, speed = 2.0 }";
    Scenario::parse(&CHANNEL.replace(line, &format!("{line}\n{evade}"))).unwrap()
}

#[test]
fn a_target_evades_robots_within_its_bounds() {
    let config = SwarmConfig { settle_s: 2.0, ..SwarmConfig::default() };
    let step_um = config.target_speed_m_per_s * 2.0 / f64::from(TICKS_PER_SECOND) * 1e6;
    let world = evading();
    let mut swarm = Swarm::new(&world, config, wanderer).unwrap();
    let offset = |swarm: &Swarm<Wanderer>| {
        let on_path = swarm.world().targets()[0].at(swarm.scene().time()).unwrap();
        let [x, y] = swarm.frame().targets_um[0].unwrap().map(|um| f64::from(um) * 1e-6);
        Vector::new(x, y) - on_path
    };
    let (mut before, mut farthest) = (offset(&swarm), 0.0_f64);
    assert!(before.length() < 1e-6);
    while swarm.tick() < swarm.arrival_tick() {
        swarm.step().unwrap();
        let now = offset(&swarm);
        assert!((now - before).length() * 1e6 <= step_um + 2.0, "{now:?} after {before:?}");
        farthest = farthest.max(now.length());
        before = now;
    }
    assert!(farthest > 0.1 && farthest <= 0.125 + 1e-6, "{farthest}");
}

#[test]
fn evading_targets_move_alike_with_any_number_of_threads() {
    // So many robots that the frame's parts run on several threads.
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut swarm = Swarm::new(&evading(), uneven(CROWD + 20), wanderer).unwrap();
            recorded(&mut swarm, 400).encode()
        })
    };
    assert_eq!(run(1), run(3));
    let still = |world: &Scenario| recorded(&mut Swarm::new(world, uneven(12), wanderer).unwrap(), 400).encode();
    assert_ne!(still(&evading()), still(&channel()));
}
