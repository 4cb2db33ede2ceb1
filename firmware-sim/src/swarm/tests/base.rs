//! What a base station makes robots do.

use super::{channel, recorded};
use crate::base_station::{Circumference, Dispatch, PatternSize};
use crate::brain::{Brain, BrainError};
use crate::config::SwarmConfig;
use crate::lab::{BaseStation, FaultKind, Faults, Laboratory, ScheduledFault};
use crate::swarm::Swarm;
use grn_core::robot::{Command, Message, Millimetres, Percept, TargetReport};
use std::sync::Arc;

/// Goes straight to the target that it was told of, or home; says where the target is.
#[derive(Default)]
struct Errand {
    robot: u16,
    reboots: u32,
    target: Option<TargetReport>,
    told_by_base: u32,
}

/// Wheels that lead there.
fn towards(percept: &Percept, place: Millimetres) -> (i16, i16) {
    let Some(fix) = percept.fix else { return (0, 0) };
    let [x, y] = fix.position.map(|micrometres| f64::from(micrometres) * 1e-3);
    let (east, north) = (f64::from(place.x) - x, f64::from(place.y) - y);
    let [cos, sin] = fix.heading.map(|part| f64::from(part) / 16384.0);
    let (along, aside) = (east * cos + north * sin, north * cos - east * sin);
    let turn = (300.0 * aside / libm::hypot(east, north).max(1.0)) as i16;
    let speed = if along > 0.0 { 700 } else { 0 };
    (speed - turn, speed + turn)
}

impl Brain for Errand {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        for sighting in &percept.targets {
            let (target, position) = (sighting.target, sighting.position);
            self.target = Some(TargetReport { target, position, velocity: [0; 2], age: 0 });
        }
        for heard in &percept.heard {
            self.told_by_base += u32::from(heard.message.sender == u16::MAX);
            self.target = heard.message.target.or(self.target);
        }
        let (left, right) = self.target.map_or((0, 0), |report| towards(percept, report.position));
        let position = Millimetres::default();
        let target = self.target.filter(|_| !percept.targets.is_empty());
        let said = Message { sender: self.robot, position, target, obstacles: Default::default() };
        Ok(Command { left, right, broadcast: Some(said) })
    }

    fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, BrainError> {
        let (left, right) = towards(percept, home);
        Ok(Command { left, right, broadcast: None })
    }

    fn reboot(&mut self) -> Result<(), BrainError> {
        *self = Errand { robot: self.robot, reboots: self.reboots + 1, ..Errand::default() };
        Ok(())
    }
}

/// Ten robots that hear nobody but the base, at a target that rests; the pattern has so many spacings, ten seconds each.
fn swarm(spacings: &[f64], faults: Faults) -> Swarm<Errand> {
    let mut lab = Laboratory { faults, ..Laboratory::perfect() };
    lab.radio.range_m = 0.01;
    lab.base_station = BaseStation { sends: true, spacing_m: 0.2, reserve: 0.2 };
    let config = SwarmConfig { lab, settle_s: 1000.0, ..SwarmConfig::default() }.with_robots(10);
    let size = |&count: &f64| Some(PatternSize { circumference_m: 0.2 * count, rings: 1 });
    let timetable = Circumference::new(320, spacings.iter().map(size).collect());
    let brain = |robot| Errand { robot: robot as u16, ..Errand::default() };
    Swarm::with_pattern(&channel(), config, Some(Arc::new(timetable)), brain).unwrap()
}

/// Who had this done to it, in order of time.
fn whom(swarm: &Swarm<Errand>, what: Dispatch) -> Vec<(f64, usize)> {
    let deeds = swarm.base_record().unwrap().dispatched.iter();
    deeds.filter(|deed| deed.what == what).map(|deed| (deed.at_s, deed.robot)).collect()
}

#[test]
fn robots_are_sent_as_the_pattern_grows_and_called_home_as_it_shrinks() {
    let mut swarm = swarm(&[3.5, 6.5, 6.5, 4.5, 4.5, 4.5, 4.5, 4.5], Faults::default());
    let starts: Vec<_> = swarm.poses().iter().map(|pose| pose.position).collect();
    recorded(&mut swarm, 80 * 32);
    let sent: Vec<(f64, usize)> =
        [(0.0, 0..4), (10.0, 4..7)].into_iter().flat_map(|(at, who)| who.map(move |r| (at, r))).collect();
    assert_eq!(whom(&swarm, Dispatch::Sent), sent);
    assert_eq!(whom(&swarm, Dispatch::Joined).len(), 7);
    // Five are needed and a sixth may stay: one is called, not a mother.
    let called = whom(&swarm, Dispatch::CalledHome);
    assert!(called.len() == 1 && called[0].0 == 30.0 && called[0].1 >= 2, "{called:?}");
    let back = whom(&swarm, Dispatch::Back);
    assert!(back.len() == 1 && back[0].1 == called[0].1 && back[0].0 < 70.0, "{back:?}");
    let robot = back[0].1;
    assert!((swarm.poses()[robot].position - starts[robot]).length() < 0.15);
    assert_eq!(swarm.frame().robots[robot].wheels, [0; 2]);
    // Who was never sent has stood there, whoever ran into it; only who is out and no longer on the way is one of the swarm.
    assert!((7..10).all(|robot| (swarm.poses()[robot].position - starts[robot]).length() < 0.1));
    assert!(swarm.brains().skip(7).all(|brain| brain.target.is_none() && brain.told_by_base == 0));
    let off_duty: Vec<usize> = (0..10).filter(|&robot| swarm.frame().off_duty[robot]).collect();
    assert_eq!(off_duty, (0..10).filter(|&other| other >= 7 || other == robot).collect::<Vec<_>>());
    let record = swarm.base_record().unwrap();
    assert_eq!((record.most_needed, record.most_out, record.short_s), (7, 7, 0.0));
}

#[test]
fn the_base_tells_robots_out_of_earshot_of_the_target() {
    let mut swarm = swarm(&[3.5], Faults::default());
    recorded(&mut swarm, 320);
    for (robot, brain) in swarm.brains().enumerate() {
        assert_eq!(brain.told_by_base > 3, robot < 4, "{robot}: {}", brain.told_by_base);
        assert_eq!(brain.target.is_some(), robot < 4);
    }
}

#[test]
fn robots_that_break_down_are_replaced_while_there_are_others() {
    let stop =
        |robot, at_s| ScheduledFault { kind: FaultKind::Stop, robot: Some(robot), share: None, at_s, lasts_s: None };
    let at = vec![stop(1, 5.5), stop(3, 5.5), stop(2, 20.0)];
    let mut swarm = swarm(&[8.5, 8.5, 8.5], Faults { at, ..Faults::default() });
    recorded(&mut swarm, 30 * 32);
    let sent = whom(&swarm, Dispatch::Sent);
    assert_eq!(sent[9..], [(6.0, 9)], "the last one replaces one of two");
    let record = swarm.base_record().unwrap();
    // One is missing from 6 s to 20 s on, two from then on: seconds are counted, not robots.
    assert_eq!((record.most_needed, record.most_out, record.short_s), (9, 9, 24.0));
}

#[test]
fn a_robot_on_its_way_home_is_sent_back_and_one_that_was_off_begins_anew() {
    let mut swarm = swarm(&[7.5, 3.5, 7.5, 1.5, 1.5, 1.5, 1.5, 1.5, 7.5, 7.5], Faults::default());
    recorded(&mut swarm, 11 * 32);
    let called = whom(&swarm, Dispatch::CalledHome);
    assert_eq!(called.iter().map(|call| call.0).collect::<Vec<_>>(), [10.0; 3]);
    recorded(&mut swarm, 95 * 32);
    let (back, sent) = (whom(&swarm, Dispatch::Back), whom(&swarm, Dispatch::Sent));
    for (robot, brain) in swarm.brains().enumerate() {
        let is_own = |&&(_, other): &&(f64, usize)| other == robot;
        let first_back = back.iter().find(is_own).map_or(f64::INFINITY, |back| back.0);
        let again = sent.iter().filter(is_own).any(|sent| sent.0 > first_back);
        assert_eq!(brain.reboots > 0, again, "{robot}: {back:?} {sent:?}");
    }
    assert!(sent.iter().filter(|sent| sent.0 >= 80.0).count() >= 5, "{sent:?}");
    assert!(back.len() >= 4, "{back:?}");
}

#[test]
fn a_simulation_that_knows_no_pattern_says_so() {
    let mut lab = Laboratory::perfect();
    lab.base_station.sends = true;
    let config = SwarmConfig { lab, ..SwarmConfig::default() };
    let error = Swarm::new(&channel(), config, |_| Errand::default()).unwrap_err();
    assert_eq!(error.key(), "base_station.sends");
    assert!(error.to_string().contains("circumference"), "{error}");
}
