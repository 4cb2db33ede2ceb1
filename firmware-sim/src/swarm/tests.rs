mod base;
mod faults;
mod moving;
mod starts;

use super::*;
use crate::brain::BrainError;
use crate::geometry::length_squared;
use crate::lab::{self, Laboratory, Wheels};
use crate::trace::{Recorder, Trace, TraceHeader};
use grn_core::blob::{Blob, FieldParameters, Gains};
use grn_core::dynamics::Step;
use grn_core::field::Kernel;
use grn_core::motif::Motif;
use grn_core::network::{Gene, Network, Source};
use grn_core::robot::epuck2::BODY_RADIUS;
use grn_core::robot::{Command, Controller, Message, Millimetres, Percept};
use grn_core::scalar::{Q8_24, Scalar};

const CHANNEL: &str = include_str!("../../../scenarios/channel.toml");

fn channel() -> Scenario {
    Scenario::parse(CHANNEL).unwrap()
}

/// So many robots whose wheels differ.
fn uneven(robots: usize) -> SwarmConfig {
    let mut config = SwarmConfig::default().with_robots(robots);
    config.lab.wheels = Wheels { gain: 0.02, ..Wheels::default() };
    config
}

/// Wanders, turns away from what it senses, and talks; remembers what it heard.
struct Wanderer {
    number: u16,
    tick: u16,
    heard: Vec<(u16, u16, i16)>,
}

impl Brain for Wanderer {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        self.heard.extend(percept.heard.iter().map(|h| (self.tick, h.message.sender, h.message.position.x)));
        let near = percept.proximity.iter().any(|&p| p < 300);
        let left = if near { -300 } else { 600 + self.number as i16 * 5 };
        let position = Millimetres { x: self.tick as i16, y: 0 };
        let broadcast = Message { sender: self.number, position, target: None, obstacles: Default::default() };
        self.tick += 1;
        Ok(Command { left, right: 600, broadcast: Some(broadcast) })
    }
}

fn wanderer(robot: usize) -> Wanderer {
    Wanderer { number: robot as u16, tick: 0, heard: Vec::new() }
}

/// The real controller.
struct Real<S>(Controller<S>);

impl<S: Scalar> Brain for Real<S> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        Brain::tick(&mut self.0, percept)
    }
}

fn recorder<B: Brain>(swarm: &Swarm<B>) -> Recorder {
    Recorder::new(TraceHeader::of(swarm.world(), swarm.config()), usize::MAX)
}

/// Every tick up to this one.
fn recorded<B: Brain>(swarm: &mut Swarm<B>, end: u64) -> Trace {
    let mut recorder = recorder(swarm);
    assert_eq!(swarm.run(end, &mut recorder, |_| ControlFlow::Continue(())).unwrap(), Outcome::Finished);
    recorder.into_trace()
}

/// The bytes of 10 s of 12 robots under the real controller, with every noise on.
fn real_bytes<S: Scalar>() -> Vec<u8> {
    let gene = |motif, inputs: &[Source], theta| Gene { motif, inputs: inputs.iter().copied().collect(), theta };
    let nand = gene(Motif::Nand, &[Source::X1, Source::X1], 0.8393);
    let xnor = gene(Motif::Xnor, &[Source::Gene(0), Source::X2], 0.9256);
    let blob: Blob = Blob {
        network: Network::new(1.0, [nand, xnor]).unwrap(),
        field: FieldParameters { kernel: Kernel::Gaussian, target_width: 1.5, obstacle_width: 0.9 },
        level_fraction: 0.5,
        scale: 0.25,
        step: Step::EIGHTH,
        time_scale: 4.0,
        gains: Gains::default(),
    };
    let config = uneven(12);
    let controller = |robot| Real(Controller::<S>::new(&blob, robot as u16).unwrap());
    let mut swarm = Swarm::new(&channel(), config, controller).unwrap();
    recorded(&mut swarm, 320).encode()
}

#[test]
fn the_real_controller_gives_equal_bytes_in_every_run_and_after_decoding() {
    for (bytes, again) in [(real_bytes::<f32>(), real_bytes::<f32>()), (real_bytes::<Q8_24>(), real_bytes::<Q8_24>())] {
        assert_eq!(bytes, again);
        let trace = Trace::decode(&bytes).unwrap();
        assert_eq!(trace.encode(), bytes);
        assert_eq!(trace.len(), 321);
        let frames: Vec<_> = trace.frames().collect();
        let moved = |robot: usize| frames[0].robots[robot].position_um != frames[320].robots[robot].position_um;
        assert!((0..12).all(moved), "every robot hears of the target and drives");
    }
}

/// Drives straight on.
struct Straight;

impl Brain for Straight {
    fn tick(&mut self, _: &Percept) -> Result<Command, BrainError> {
        Ok(Command { left: 1000, right: 1000, broadcast: None })
    }
}

#[test]
fn equal_seeds_give_equal_bytes() {
    let config = uneven(40);
    let bytes = |seed| {
        let config = SwarmConfig { seed, ..config.clone() };
        recorded(&mut Swarm::new(&channel(), config, wanderer).unwrap(), 400).encode()
    };
    assert_eq!(bytes(1), bytes(1));
    assert_ne!(bytes(1), bytes(2));
    // In two runs, through a box, the same.
    let mut boxed: Swarm<Box<dyn Brain>> =
        Swarm::new(&channel(), config.clone(), |robot| Box::new(wanderer(robot)) as _).unwrap();
    let mut recorder = recorder(&boxed);
    assert_eq!(boxed.run(150, &mut recorder, |_| ControlFlow::Continue(())).unwrap(), Outcome::Finished);
    assert_eq!(boxed.run(400, &mut recorder, |_| ControlFlow::Continue(())).unwrap(), Outcome::Finished);
    assert_eq!(recorder.into_trace().encode(), bytes(1));
}

#[test]
fn a_broadcast_is_heard_in_the_next_tick() {
    let config = SwarmConfig { lab: Laboratory::perfect(), ..SwarmConfig::default() }.with_robots(5);
    let config = SwarmConfig { lab: lab::set(config.lab, "radio.range_m=10").unwrap(), ..config };
    let mut swarm = Swarm::new(&channel(), config, wanderer).unwrap();
    (0..10).for_each(|_| swarm.step().unwrap());
    for (robot, brain) in swarm.brains().enumerate() {
        assert_eq!(brain.heard.len(), 9 * 4);
        assert!(
            brain
                .heard
                .iter()
                .all(|&(tick, sender, sent)| i32::from(tick) == i32::from(sent) + 1 && usize::from(sender) != robot)
        );
    }
}

#[test]
fn robots_start_free_and_near_the_target() {
    for (robots, scale) in [(20, 0.25), (250, 0.25), (100, 0.1), (30, 1.0)] {
        let config = SwarmConfig { scale, ..SwarmConfig::default() }.with_robots(robots);
        let swarm = Swarm::new(&channel(), config, |_| Straight).unwrap();
        let positions: Vec<_> = swarm.poses().iter().map(|pose| pose.position).collect();
        for (i, &p) in positions.iter().enumerate() {
            assert!(swarm.scene().walls().signed_distance(p) > BODY_RADIUS);
            assert!(positions[..i].iter().all(|&q| length_squared(p - q) > 4.0 * BODY_RADIUS * BODY_RADIUS));
            let distance = (p - swarm.scene().targets()[0].unwrap()).length() / (2.0 * scale);
            assert!(distance >= 0.3 && (robots > 30 || distance <= 1.6), "{distance}");
            assert!(
                robots > 30 || p.x <= swarm.scene().targets()[0].unwrap().x,
                "the target goes east, robots start west of it"
            );
        }
    }
    let full = SwarmConfig { scale: 0.03, ..SwarmConfig::default() }.with_robots(250);
    assert_eq!(Swarm::new(&channel(), full, |_| Straight).unwrap_err().key(), "robots");
    let large = SwarmConfig { scale: 2.0, ..SwarmConfig::default() };
    assert_eq!(Swarm::new(&channel(), large, |_| Straight).unwrap_err().key(), "scale");
}

#[test]
fn bodies_never_enter_walls_or_stay_inside_each_other() {
    // In a square pen of 0.9 m, straight drivers end in its corners on top of each other.
    let pen: String = [(0.0, 0.0, 1.1, 0.1), (0.0, 1.0, 1.1, 1.1), (0.0, 0.1, 0.1, 1.0), (1.0, 0.1, 1.1, 1.0)]
        .iter()
        .map(|(w, s, e, n)| format!("[[wall]]\npolygon = [[{w}, {s}], [{e}, {s}], [{e}, {n}], [{w}, {n}]]\n"))
        .collect();
    let text = CHANNEL
        .split("[[target]]")
        .next()
        .unwrap()
        .replace("[20.0, 20.0]", "[1.1, 1.1]")
        .replace("d_min = 1.0", "d_min = 0.1")
        .replace("d_max = 2.0", "d_max = 0.25");
    let scenario = Scenario::parse(&format!("{text}[[target]]\npath = [[0.55, 0.55]]\n{pen}")).unwrap();
    let config = SwarmConfig { scale: 1.0, ..SwarmConfig::default() }.with_robots(20);
    let mut swarm = Swarm::new(&scenario, config, |_| Straight).unwrap();
    let mut closest: f64 = 1.0;
    let (mut wall_events, mut peer_events) = (0, 0);
    for _ in 0..2000 {
        swarm.step().unwrap();
        wall_events += swarm.frame().contacts.wall_events;
        peer_events += swarm.frame().contacts.peer_events;
        for (i, pose) in swarm.poses().iter().enumerate() {
            assert!(swarm.scene().walls().signed_distance(pose.position) >= BODY_RADIUS - 1e-9, "{pose:?}");
            for other in &swarm.poses()[..i] {
                closest = closest.min((pose.position - other.position).length());
            }
        }
    }
    assert!(closest > 1.6 * BODY_RADIUS, "{closest}");
    assert!(wall_events >= 20 && peer_events >= 10, "{wall_events} {peer_events}");
    assert_eq!(swarm.frame().contacts.walls, 20, "they press on");
}

#[test]
fn targets_rest_and_then_arrive_on_time() {
    let config = SwarmConfig { settle_s: 2.0, target_speed_m_per_s: 0.1, ..SwarmConfig::default() };
    let mut swarm = Swarm::new(&channel(), config, |_| Straight).unwrap();
    // 14 m at a quarter of the scale: 3.5 m in 35 s.
    assert_eq!(swarm.arrival_tick(), 37 * 32);
    let mut before = swarm.scene().targets()[0].unwrap();
    for tick in 1..=swarm.arrival_tick() {
        swarm.step().unwrap();
        let step = (swarm.scene().targets()[0].unwrap() - before).length();
        let expected = if tick <= 64 { 0.0 } else { 0.1 / 32.0 };
        assert!((step - expected).abs() < 1e-12, "{tick}: {step}");
        before = swarm.scene().targets()[0].unwrap();
    }
    assert!((before.x - 17.0 * 0.25).abs() < 1e-12);
    assert_eq!(swarm.frame().targets_um, [Some([17_000_000 / 4, 10_000_000 / 4])]);
}

#[test]
fn only_mothers_see_far() {
    struct Watcher(usize, usize);
    impl Brain for Watcher {
        fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
            self.0 = percept.targets.len();
            self.1 += percept.obstacles.len();
            Ok(Command::default())
        }
    }
    let config = SwarmConfig { lab: Laboratory::perfect(), ..SwarmConfig::default() }.with_robots(6);
    let mut swarm = Swarm::new(&channel(), config, |_| Watcher(0, 0)).unwrap();
    (0..4).for_each(|_| swarm.step().unwrap());
    let seen: Vec<_> = swarm.brains().map(|w| w.0).collect();
    assert_eq!(seen, [1, 1, 0, 0, 0, 0]);
    // The nearest corner is 5 m from the target: whether a mother sees walls depends on where it stands.
    let range = 5.0 * 0.25;
    for (robot, (watcher, pose)) in swarm.brains().zip(swarm.poses()).enumerate() {
        let corners = [3.5, 1.5].map(|y| (pose.position - Point::new(1.5, y)).length());
        assert_eq!(watcher.1 > 0, robot < 2 && corners.iter().any(|&d| d <= range), "{robot}");
    }
}

#[test]
fn a_failing_brain_is_named_and_a_callback_may_stop() {
    struct Failing(usize, u64);
    impl Brain for Failing {
        fn tick(&mut self, _: &Percept) -> Result<Command, BrainError> {
            self.1 += 1;
            if self.0 == 3 && self.1 == 50 { Err(BrainError::new("link closed")) } else { Ok(Command::default()) }
        }
    }
    let mut swarm = Swarm::new(&channel(), SwarmConfig::default(), |robot| Failing(robot, 0)).unwrap();
    let mut calls = Vec::new();
    let mut recorder = recorder(&swarm);
    let stopped = swarm.run(100, &mut recorder, |progress| {
        calls.push(progress.tick);
        if progress.tick == 32 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!((stopped.unwrap(), calls), (Outcome::Interrupted, vec![0, 32]));
    let error = swarm.run(100, &mut recorder, |_| ControlFlow::Continue(())).unwrap_err();
    assert_eq!(error.to_string(), "robot 3 gave no command in tick 49: link closed");
    assert_eq!((recorder.trace().len(), swarm.frame().tick), (50, 49));
}
