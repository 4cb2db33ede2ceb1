//! Worlds that move under the robots.

use super::*;

const OPEN: &str = include_str!("../../../../scenarios/open.toml");

/// Stands still, and remembers which targets and how many wall points it saw in its last tick.
struct Watcher(Vec<u8>, usize);

impl Brain for Watcher {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        self.0 = percept.targets.iter().map(|seen| seen.target).collect();
        self.1 = percept.obstacles.len();
        Ok(Command::default())
    }
}

fn world(more: &str) -> Scenario {
    Scenario::parse(&format!("{OPEN}\n{more}")).unwrap()
}

fn watched(more: &str) -> Swarm<Watcher> {
    let config = SwarmConfig { lab: Laboratory::perfect(), settle_s: 1.0, ..SwarmConfig::default() }.with_robots(12);
    Swarm::new(&world(more), config, |_| Watcher(Vec::new(), 0)).unwrap()
}

#[test]
fn a_target_is_seen_while_it_is_there() {
    let mut swarm = watched("[[target]]\npath = [[3.0, 5.0], [3.0, 6.0]]\npresent = [[0.0, 0.02], [0.06, 1.0]]\n");
    let end = swarm.arrival_tick();
    let (mut seen, mut shown) = (Vec::new(), Vec::new());
    while swarm.tick() < end / 8 {
        swarm.step().unwrap();
        let targets = swarm.brains().next().unwrap().0.clone();
        if seen.last() != Some(&targets) {
            seen.push(targets);
        }
        let there: Vec<bool> = swarm.frame().targets_um.iter().map(Option::is_some).collect();
        if shown.last() != Some(&there) {
            shown.push(there);
        }
    }
    assert_eq!(seen[..3], [vec![0, 1], vec![0], vec![0, 1]], "{seen:?}");
    assert_eq!(shown, [[true, true], [true, false], [true, true]]);
}

#[test]
fn a_wall_that_moves_pushes_robots_and_is_felt_and_seen() {
    // A bar 6 m long comes over the robots' starts, west of [3, 4], at most as fast as the target.
    let bar = "[[wall]]\npolygon = [[0.0, 8.0], [2.5, 8.0], [2.5, 8.5], [0.0, 8.5]]\npath = [[1.0, 8.0], [1.0, 2.0]]\n";
    let mut swarm = watched(bar);
    let before: Vec<_> = swarm.poses().to_vec();
    let (mut touched, mut seen) = (0, 0);
    while swarm.tick() < swarm.arrival_tick() {
        swarm.step().unwrap();
        touched += swarm.frame().contacts.wall_events;
        seen = seen.max(swarm.brains().next().unwrap().1);
        for pose in swarm.poses() {
            let clearance = swarm.scene().walls().signed_distance(pose.position);
            assert!(clearance > BODY_RADIUS - 2e-3, "{pose:?} is {clearance} m from the bar in tick {}", swarm.tick());
        }
    }
    assert!(touched > 0 && seen > 0, "{touched} contacts, {seen} points seen");
    let pushed = before.iter().zip(swarm.poses()).filter(|(before, after)| before.position.y - after.position.y > 0.1);
    assert!(pushed.count() >= 3);
}

#[test]
fn a_door_that_closes_on_robots_puts_them_out() {
    let mut swarm =
        watched("[[wall]]\npolygon = [[0.0, 0.0], [2.0, 0.0], [2.0, 9.0], [0.0, 9.0]]\npresent = [[0.2, 1.0]]\n");
    let door = swarm.world().walls_at(0.5);
    let under =
        |swarm: &Swarm<Watcher>| swarm.poses().iter().filter(|pose| door.containing(pose.position).is_some()).count();
    assert!(under(&swarm) >= 2 && swarm.scene().walls().is_empty());
    while swarm.scene().walls().is_empty() {
        swarm.step().unwrap();
    }
    (0..3).for_each(|_| swarm.step().unwrap());
    assert_eq!(under(&swarm), 0);
    assert!(swarm.poses().iter().all(|pose| pose.position.x.is_finite() && pose.position.y.is_finite()));
}

#[test]
fn equal_seeds_move_alike() {
    let text = include_str!("../../../../scenarios/moving/crossing.toml");
    let run = || {
        let world = Scenario::parse(text).unwrap();
        let mut swarm = Swarm::new(&world, uneven(12), wanderer).unwrap();
        let mut recorder = recorder(&swarm);
        swarm.run(swarm.arrival_tick() / 4, &mut recorder, |_| ControlFlow::Continue(())).unwrap();
        recorder.into_trace().encode()
    };
    assert_eq!(run(), run());
}
