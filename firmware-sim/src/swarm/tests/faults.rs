//! What becomes of robots that something is wrong with.

use super::{channel, recorded, wanderer};
use crate::body::Pose;
use crate::brain::{Brain, BrainError};
use crate::config::SwarmConfig;
use crate::faults::Fault;
use crate::geometry::length_squared;
use crate::lab::{FaultKind, Faults, Laboratory, ScheduledFault, Shipped};
use crate::swarm::Swarm;
use grn_core::robot::epuck2::BODY_RADIUS;
use grn_core::robot::{Command, Fix, Message, Percept};

/// The robot that faults happen to.
const PATIENT: usize = 4;

/// The perfect laboratory with six robots that all hear each other, and these faults.
fn perfect(faults: Faults) -> SwarmConfig {
    let mut lab = Laboratory { faults, ..Laboratory::perfect() };
    lab.radio.range_m = 100.0;
    SwarmConfig { lab, ..SwarmConfig::default() }.with_robots(6)
}

/// One fault of the patient after two seconds, or so early as is said.
fn one(kind: FaultKind, at_s: f64, lasts_s: Option<f64>) -> SwarmConfig {
    perfect(Faults {
        at: vec![ScheduledFault { kind, robot: Some(PATIENT), share: None, at_s, lasts_s }],
        ..Faults::default()
    })
}

/// Drives straight on, talks, and remembers.
#[derive(Default)]
struct Diary {
    robot: u16,
    ticks: u32,
    reboots: u32,
    last: Option<Percept>,
}

impl Brain for Diary {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        self.ticks += 1;
        self.last = Some(percept.clone());
        let position = Default::default();
        let broadcast = Message { sender: self.robot, position, target: None, obstacles: Default::default() };
        Ok(Command { left: 300, right: 300, broadcast: Some(broadcast) })
    }

    fn reboot(&mut self) -> Result<(), BrainError> {
        *self = Diary { robot: self.robot, reboots: self.reboots + 1, ..Diary::default() };
        Ok(())
    }
}

fn swarm(config: SwarmConfig) -> Swarm<Diary> {
    Swarm::new(&channel(), config, |robot| Diary { robot: robot as u16, ..Diary::default() }).unwrap()
}

fn steps(swarm: &mut Swarm<Diary>, count: u32) {
    (0..count).for_each(|_| swarm.step().unwrap());
}

impl Swarm<Diary> {
    fn of(&self, robot: usize) -> (&Diary, Pose, [i16; 2]) {
        (&self.units[robot].brain, self.poses()[robot], self.frame().robots[robot].wheels)
    }

    fn percept(&self) -> &Percept {
        self.of(PATIENT).0.last.as_ref().unwrap()
    }

    fn fault(&self) -> Fault {
        self.faults().faults()[0]
    }

    /// Whom a robot has heard in its last tick.
    fn heard_by(&self, robot: usize) -> Vec<u16> {
        let heard = &self.of(robot).0.last.as_ref().unwrap().heard;
        let mut senders: Vec<u16> = heard.iter().map(|heard| heard.message.sender).collect();
        senders.sort_unstable();
        senders
    }
}

#[test]
fn a_stopped_robot_stands_silent_and_goes_on() {
    let mut swarm = swarm(one(FaultKind::Stop, 2.0, Some(3.0)));
    steps(&mut swarm, 64);
    let before = swarm.of(PATIENT).1;
    assert_eq!(swarm.of(PATIENT).0.ticks, 64);
    steps(&mut swarm, 96);
    assert_eq!((swarm.of(PATIENT).0.ticks, swarm.of(PATIENT).2), (64, [0, 0]));
    assert_eq!(swarm.of(PATIENT).1, before);
    assert_eq!(swarm.heard_by(0), [1, 2, 3, 5]);
    assert_eq!(swarm.of(0).0.ticks, 160);
    steps(&mut swarm, 1);
    let now = swarm.percept();
    assert_eq!((swarm.of(PATIENT).0.ticks, now.elapsed_us, now.fix.unwrap().age_ms), (65, 31_250, 0));
    assert!(now.heard.iter().all(|heard| heard.age_ms <= 32), "nothing of what was said meanwhile");
    steps(&mut swarm, 1);
    assert!(swarm.of(PATIENT).1 != before && swarm.heard_by(0) == [1, 2, 3, 4, 5]);
}

#[test]
fn a_late_robot_waits_at_its_start() {
    let mut swarm = swarm(one(FaultKind::Late, 2.0, None));
    let start = swarm.of(PATIENT).1;
    steps(&mut swarm, 64);
    assert_eq!((swarm.of(PATIENT).0.ticks, swarm.of(PATIENT).1), (0, start));
    steps(&mut swarm, 10);
    assert_eq!(swarm.of(PATIENT).0.ticks, 10);
    assert!(swarm.of(PATIENT).1 != start);
}

#[test]
fn a_robot_that_reboots_begins_anew_after_a_second() {
    let mut swarm = swarm(one(FaultKind::Reboot, 2.0, None));
    steps(&mut swarm, 64 + 32);
    let (brain, _, wheels) = swarm.of(PATIENT);
    assert_eq!((brain.reboots, brain.ticks, wheels), (1, 0, [0, 0]));
    steps(&mut swarm, 50);
    assert_eq!((swarm.of(PATIENT).0.reboots, swarm.of(PATIENT).0.ticks), (1, 50));
    assert!(swarm.brains().filter(|brain| brain.reboots == 0).all(|brain| brain.ticks == 146));
    let mut stubborn = Swarm::new(&channel(), one(FaultKind::Reboot, 2.0, None), wanderer).unwrap();
    let error = (0..100).find_map(|_| stubborn.step().err()).unwrap();
    assert_eq!((error.robot, error.tick), (PATIENT, 64));
    assert!(error.to_string().contains("simulate it without the fault reboot"), "{error}");
}

#[test]
fn a_robot_without_radio_neither_hears_nor_is_heard() {
    let mut swarm = swarm(one(FaultKind::Radio, 2.0, Some(1.0)));
    steps(&mut swarm, 64);
    assert_eq!((swarm.heard_by(PATIENT), swarm.heard_by(0)), (vec![0, 1, 2, 3, 5], vec![1, 2, 3, 4, 5]));
    steps(&mut swarm, 32);
    assert_eq!((swarm.heard_by(PATIENT), swarm.heard_by(0)), (vec![], vec![1, 2, 3, 5]));
    assert_eq!(swarm.of(PATIENT).0.ticks, 96);
    steps(&mut swarm, 2);
    assert_eq!((swarm.heard_by(PATIENT), swarm.heard_by(0)), (vec![0, 1, 2, 3, 5], vec![1, 2, 3, 4, 5]));
}

#[test]
fn a_stuck_wheel_does_not_turn() {
    let mut swarm = swarm(one(FaultKind::Wheel, 0.0, None));
    let start = swarm.of(PATIENT).1.heading;
    steps(&mut swarm, 8);
    let turned = start.cross(swarm.of(PATIENT).1.heading);
    // With the left wheel stuck it turns to the left.
    let left = swarm.fault().part() == Some(0);
    assert!(if left { turned > 0.1 } else { turned < -0.1 }, "{left}: {turned}");
    assert_eq!(swarm.of(PATIENT).2, [300, 300], "its controller does not know");
    assert!((swarm.of(0).1.heading.length() - 1.0).abs() < 1e-12);
}

#[test]
fn sensors_die_and_have_shorts() {
    for (kind, reading) in [(FaultKind::SensorDead, u16::MAX), (FaultKind::SensorShorted, 0)] {
        // So many robots around it that every sensor would read something now and then.
        let mut config = one(kind, 0.0, Some(2.0));
        config.scale = 0.1;
        config = config.with_robots(30);
        let mut swarm = swarm(config);
        let sensor = swarm.fault().part().unwrap();
        let mut others = std::collections::BTreeSet::new();
        for _ in 0..64 {
            steps(&mut swarm, 1);
            let proximity = swarm.percept().proximity;
            assert_eq!(proximity[sensor], reading);
            others.extend(proximity.iter().enumerate().filter(|&(other, _)| other != sensor).map(|(_, &read)| read));
        }
        assert!(others.len() > 5, "the others work: {others:?}");
    }
    let mut swarm = swarm(one(FaultKind::SensorShorted, 0.0, Some(1.0)));
    let sensor = swarm.fault().part().unwrap();
    steps(&mut swarm, 33);
    assert_ne!(swarm.percept().proximity[sensor], 0);
}

#[test]
fn a_tracker_that_jumps_is_off_by_the_same_all_the_time() {
    let mut swarm = swarm(one(FaultKind::TrackerJump, 2.0, Some(1.0)));
    let jump = swarm.fault().jump();
    assert!((0.1..=0.3).contains(&jump.length()));
    for tick in 0..160 {
        let [x, y] = [swarm.poses()[PATIENT].position.x, swarm.poses()[PATIENT].position.y];
        steps(&mut swarm, 1);
        let Fix { position, .. } = swarm.percept().fix.unwrap();
        let expected = if (64..96).contains(&tick) { [jump.x, jump.y] } else { [0.0; 2] };
        let off = [f64::from(position[0]) * 1e-6 - x - expected[0], f64::from(position[1]) * 1e-6 - y - expected[1]];
        assert!(off.iter().all(|off| off.abs() < 2e-6), "{tick}: {off:?}");
    }
}

#[test]
fn a_robot_is_set_down_at_a_free_place_some_distance_off() {
    for seed in 1..=20 {
        let mut swarm = swarm(SwarmConfig { seed, ..one(FaultKind::Carried, 2.0, None) });
        steps(&mut swarm, 64);
        let before = swarm.of(PATIENT).1;
        steps(&mut swarm, 1);
        let after = swarm.of(PATIENT).1;
        let d_max = 2.0 * 0.25;
        let carried = (after.position - before.position).length();
        assert!((0.49 * d_max..=1.51 * d_max).contains(&carried), "{carried}");
        assert!(swarm.scene().walls().signed_distance(after.position) > BODY_RADIUS);
        let others = swarm.poses().iter().enumerate().filter(|(robot, _)| *robot != PATIENT);
        let room = 4.0 * BODY_RADIUS * BODY_RADIUS;
        assert!(others.map(|(_, pose)| length_squared(pose.position - after.position)).all(|squared| squared > room));
        assert_eq!((swarm.of(PATIENT).0.ticks, swarm.of(PATIENT).2), (65, [300, 300]), "its controller is not told");
    }
}

#[test]
fn faults_leave_what_chance_does_to_others_as_it_was() {
    let ideal = || SwarmConfig::default().with_robots(20);
    let mut deaf = ideal();
    deaf.lab.faults = Faults { radio_per_hour: 60.0, ..Faults::default() };
    let trace = |config| recorded(&mut Swarm::new(&channel(), config, wanderer).unwrap(), 3200).encode();
    assert!(!Swarm::new(&channel(), deaf.clone(), wanderer).unwrap().faults().faults().is_empty());
    assert!(trace(deaf) == trace(ideal()), "wanderers do not mind what they hear");
}

#[test]
fn a_hostile_laboratory_gives_equal_bytes_on_any_number_of_threads() {
    let mut lab = Shipped::Hostile.laboratory();
    lab.faults.lasts_s = 2.0;
    lab.faults.at = [FaultKind::Stop, FaultKind::Carried, FaultKind::Wheel, FaultKind::TrackerJump]
        .map(|kind| ScheduledFault { kind, robot: None, share: Some(0.3), at_s: 1.0, lasts_s: None })
        .to_vec();
    let config = SwarmConfig { lab, ..SwarmConfig::default() }.with_robots(crate::lab::MAX_ROBOTS.min(300));
    let bytes = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let brain = |robot: usize| Diary { robot: robot as u16, ..Diary::default() };
        pool.install(|| recorded(&mut Swarm::new(&channel(), config.clone(), brain).unwrap(), 160).encode())
    };
    assert!(bytes(1) == bytes(3));
}
