use super::*;

/// (east, north) in metres.
pub(crate) type Places = Vec<(f64, f64)>;

/// A trace of these targets and robots, frame by frame, with the same contacts and commands in each.
pub(crate) fn trace_of(frames: &[(Places, Places)]) -> Trace {
    let um = |&(x, y): &(f64, f64)| [x, y].map(|v: f64| (v * 1e6).round() as i32);
    let mut trace = Trace::new(TraceHeader {
        scenario: "täst".to_owned(),
        seed: 9,
        scale: 0.25,
        settle_s: 10.0,
        target_speed_m_per_s: 0.02,
        ticks_per_second: 32,
        ticks_per_frame: 1,
        robots: frames[0].1.len() as u16,
        mothers: 1,
        targets: frames[0].0.len() as u16,
    });
    let robot = |p| RobotState { position_um: um(p), heading_q14: [16384, -1], wheels: [-7, 300] };
    for (targets, robots) in frames {
        let targets: Vec<_> = targets.iter().map(um).map(Some).collect();
        let robots: Vec<RobotState> = robots.iter().map(robot).collect();
        trace.push(&targets, &robots, ContactCounts { peer_events: 1, wall_events: 2, peers: 3, walls: 4 });
    }
    trace
}

fn example() -> Trace {
    let frame = |t: f64| (vec![(t, 1.0)], vec![(0.5, t), (-2.0, 3.25)]);
    trace_of(&[frame(0.0), frame(0.001)])
}

#[test]
fn bytes_are_as_documented_and_round_trip() {
    let bytes = example().encode();
    assert_eq!(bytes.len(), 8 + 2 + 2 + 5 + 8 + 24 + 8 + 4 + 4 + 2 * (8 + 32 + 16));
    assert_eq!(&bytes[..17], b"grntrace\x02\x00\x05\x00t\xc3\xa4st");
    assert_eq!(bytes[57..73], [1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0x40, 0x42, 0x0f, 0]);
    assert_eq!(bytes[105..121], [1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0]);
    assert_eq!(Trace::decode(&bytes), Ok(example()));
}

#[test]
fn version_1_is_read() {
    let of_target = b"\0\0\0\0\x40\x42\x0f\0";
    let of_robots = b"\x20\xa1\x07\0\0\0\0\0\0\x40\xff\xff\xf9\xff\x2c\x01\x80\x7b\xe1\xff\x50\x97\x31\0\0\x40\xff\xff\xf9\xff\x2c\x01";
    let of_contacts = b"\x01\0\x02\0\x03\0\x04\0";
    let numbers = [0.25f64, 10.0, 0.02].map(f64::to_le_bytes).concat();
    let head = [b"grntrace\x01\0\x05\0t\xc3\xa4st\x09\0\0\0\0\0\0\0".as_slice(), &numbers].concat();
    let counts = b"\x20\0\x02\0\x01\0\x01\0\x01\0\0\0";
    let bytes = [head.as_slice(), counts, of_target, of_robots, of_contacts].concat();
    let trace = Trace::decode(&bytes).unwrap();
    assert_eq!(trace.header(), example().header());
    let (frame, frames) = (trace.frames().next().unwrap(), example());
    let expected = frames.frames().next().unwrap();
    assert_eq!(
        (frame.targets_um, frame.robots, frame.contacts),
        (expected.targets_um, expected.robots, expected.contacts)
    );
    assert_eq!(Trace::decode(&bytes[..bytes.len() - 1]), Err(TraceError::Length));
}

/// What is left of this many ticks of one robot, which drives 1 um a tick and begins to touch a wall in every one.
fn recorded(ticks: i32, most_frames: usize) -> Trace {
    let header = TraceHeader { robots: 1, targets: 0, ..example().header().clone() };
    let bytes = header.bytes_per_frame();
    let mut recorder = Recorder::new(header, most_frames * bytes);
    for tick in 0..ticks {
        let robots = [RobotState { position_um: [tick, 0], ..RobotState::default() }];
        let contacts = ContactCounts { wall_events: u32::from(tick > 0), walls: 1, ..ContactCounts::default() };
        recorder.observe(&Frame { tick: tick as u64, targets_um: &[], robots: &robots, contacts });
    }
    recorder.into_trace()
}

#[test]
fn a_long_run_is_recorded_at_fewer_ticks() {
    for most in 2..12 {
        for ticks in 1..200 {
            let trace = recorded(ticks, most);
            let every = trace.header().ticks_per_frame as i32;
            assert!(trace.len() <= most && every.count_ones() == 1);
            assert_eq!(trace.len() as i32, (ticks + every - 1) / every, "{ticks} in {most}: every {every}");
            assert!(every == 1 || trace.len() > most / 2, "{ticks} in {most}: more would fit");
            for (place, frame) in trace.frames().enumerate() {
                let tick = place as i32 * every;
                assert_eq!((frame.tick as i32, frame.robots[0].position_um[0]), (tick, tick));
                let events = if place == 0 { 0 } else { every as u32 };
                assert_eq!(
                    (frame.contacts.wall_events, frame.contacts.walls),
                    (events, 1),
                    "{ticks} in {most}, {place}"
                );
                assert_eq!(trace.seconds(place), f64::from(tick) / 32.0);
            }
            assert_eq!(Trace::decode(&trace.encode()), Ok(trace));
        }
    }
}

#[test]
fn other_bytes_are_rejected() {
    let bytes = example().encode();
    for length in 0..bytes.len() {
        assert!(Trace::decode(&bytes[..length]).is_err(), "{length}");
    }
    let with = |at: usize, value: u8| {
        let mut changed = bytes.clone();
        changed[at] = value;
        Trace::decode(&changed)
    };
    assert_eq!(with(0, 0), Err(TraceError::NotATrace));
    assert_eq!((with(8, 0), with(8, 3)), (Err(TraceError::Version(0)), Err(TraceError::Version(3))));
    assert_eq!(with(13, 0xff), Err(TraceError::Name));
    assert_eq!((with(49, 0), with(57, 0)), (Err(TraceError::Ticks), Err(TraceError::Ticks)));
    assert_eq!(with(64, 0xff), Err(TraceError::Length));
    assert_eq!(Trace::decode(&[bytes.clone(), vec![0]].concat()), Err(TraceError::Length));
}

#[test]
fn the_table_has_a_line_per_thing_and_frame() {
    let text = String::from_utf8(example().to_csv()).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 7);
    assert_eq!((lines[4], lines[5]), ("1,target,0,1000,1000000,,,,", "1,robot,0,500000,1000,16384,-1,-7,300"));
}
