use super::*;
use crate::geometry::Polygon;
use crate::lab::Laboratory;
use grn_core::geometry::Vector;
use grn_core::robot::Millimetres;

fn open() -> Walls {
    Walls::default()
}

fn radio(change: impl FnOnce(&mut lab::Radio)) -> lab::Radio {
    let mut radio = Laboratory::perfect().radio;
    change(&mut radio);
    radio
}

fn message(sender: usize) -> Message {
    let position = Millimetres { x: sender as i16, y: 0 };
    Message { sender: sender as u16, position, target: None, obstacles: Default::default() }
}

fn line(places: &[f64]) -> Vec<Point<f64>> {
    places.iter().map(|&x| Vector::new(x, 0.0)).collect()
}

/// What is delivered to robot 0 in this frame.
fn hear(
    ether: &Ether,
    receiver: &mut Receiver,
    positions: &[Point<f64>],
    frame: u64,
    walls: &Walls,
) -> heapless::Vec<Heard, MAX_HEARD> {
    let mut heard = heapless::Vec::new();
    ether.deliver(receiver, positions[0], frame * FRAME_US, &Obstruction { walls, positions }, &mut heard);
    heard
}

/// What robot 0 hears in each of these frames, (sender, age), if all broadcast in frame 0 and it listens in every frame.
fn heard_in(config: &lab::Radio, positions: &[Point<f64>], walls: &Walls, frames: u64) -> Vec<Vec<(u16, u16)>> {
    let mut ether = Ether::new(config, 1, positions.len());
    let mut receiver = ether.receiver(0);
    let mut listen = |frame: u64| {
        ether.begin(frame, positions);
        let heard = hear(&ether, &mut receiver, positions, frame, walls);
        if frame == 0 {
            (0..positions.len()).for_each(|sender| ether.send(sender, &Letter::of(&message(sender), 0)));
        }
        heard.iter().map(|heard| (heard.message.sender, heard.age_ms)).collect()
    };
    (0..frames).map(&mut listen).collect()
}

/// Whom robot 0 hears in frame 1, with robots on a line at these places (metres).
fn heard(config: &lab::Radio, places: &[f64]) -> Vec<u16> {
    heard_in(config, &line(places), &open(), 2)[1].iter().map(|heard| heard.0).collect()
}

#[test]
fn range_is_sharp_and_nobody_hears_itself() {
    let lossless = radio(|_| ());
    assert_eq!(heard(&lossless, &[0.0, 0.69, 0.71, -0.3, -5.0]), [3, 1]);
    assert!(heard(&lossless, &[0.0, 0.8]).is_empty());
    assert!(heard(&radio(|radio| radio.loss = 1.0), &[0.0, 0.1, 0.2]).is_empty());
    assert_eq!(heard(&radio(|radio| radio.echo = 1.0), &[0.0, 0.1]), [0, 1]);
}

#[test]
fn the_nearest_fill_the_inbox() {
    let places: Vec<f64> = (0..60).map(|i| f64::from(i * 7 % 60) * 0.1).collect();
    let senders = heard(&radio(|radio| radio.range_m = 10.0), &places);
    assert_eq!(senders.len(), MAX_HEARD);
    let far: Vec<f64> = senders.iter().map(|&s| places[usize::from(s)]).collect();
    assert_eq!(far, (1..=8).map(|i| f64::from(i) * 0.1).collect::<Vec<_>>());
}

#[test]
fn latency_and_packets_delay_a_message() {
    let positions = line(&[0.0, 0.1]);
    let arrival = |config: &lab::Radio| {
        let frames = heard_in(config, &positions, &open(), 50);
        assert_eq!(frames.iter().flatten().count(), 1, "once, and only once");
        let frame = frames.iter().position(|heard| !heard.is_empty()).unwrap();
        (frame, frames[frame][0].1)
    };
    assert_eq!(arrival(&radio(|_| ())), (1, 31));
    assert_eq!(arrival(&radio(|radio| radio.latency_s = 0.3)), (11, 344));
    assert_eq!(arrival(&radio(|radio| radio.latency_s = 1.0)), (33, 1031));
    // A message without target and points is small: packets of a third of it take two frames more.
    let bytes = grn_core::robot::radio::packed::write(&message(1)).len();
    let packets = lab::packets(&message(1), bytes / 2);
    assert!(packets >= 2);
    assert_eq!(arrival(&radio(|radio| radio.payload_bytes = bytes / 2)), (packets, (packets as u16 * 125 + 2) / 4));
}

#[test]
fn who_thinks_seldom_hears_what_came_in_the_meantime_once() {
    let positions = line(&[0.0, 0.1, 0.2]);
    let mut ether = Ether::new(&radio(|_| ()), 1, 3);
    let mut receiver = ether.receiver(0);
    let mut found = Vec::new();
    for frame in 0..12 {
        ether.begin(frame, &positions);
        if frame % 4 == 3 {
            let heard = hear(&ether, &mut receiver, &positions, frame, &open());
            found.push(heard.iter().map(|heard| heard.message.sender).collect::<Vec<_>>());
        }
        if frame % 2 == 0 {
            ether.send(1, &Letter::of(&message(1), frame * FRAME_US));
        }
        if frame == 5 {
            ether.send(2, &Letter::of(&message(2), frame * FRAME_US));
        }
    }
    assert_eq!(found, [vec![1, 1], vec![1, 1, 2], vec![1, 1]]);
}

/// Which of `count` deliveries of one message robot 0 gets.
fn deliveries(config: &lab::Radio, count: u64) -> Vec<bool> {
    let positions = line(&[0.0, 0.65]);
    let mut ether = Ether::new(config, 5, 2);
    let mut receiver = ether.receiver(0);
    let one = |frame| {
        ether.begin(frame, &positions);
        let heard = hear(&ether, &mut receiver, &positions, frame, &open());
        ether.send(1, &Letter::of(&message(1), frame * FRAME_US));
        heard.iter().any(|heard| heard.message == message(1))
    };
    (0..count).map(one).skip(1).collect()
}

fn share(deliveries: &[bool]) -> f64 {
    deliveries.iter().filter(|&&arrived| arrived).count() as f64 / deliveries.len() as f64
}

#[test]
fn losses_are_as_frequent_as_asked_alone_or_in_rows() {
    let alone = deliveries(&radio(|radio| radio.loss = 0.3), 20_000);
    assert!((share(&alone) - 0.7).abs() < 0.015);
    let rows = deliveries(&radio(|radio| (radio.loss, radio.burst_s) = (0.3, 1.0)), 100_000);
    assert!((share(&rows) - 0.7).abs() < 0.03, "{}", share(&rows));
    let changes =
        |arrived: &[bool]| arrived.windows(2).filter(|pair| pair[0] != pair[1]).count() as f64 / arrived.len() as f64;
    assert!((changes(&alone) - 0.42).abs() < 0.02 && changes(&rows) < 0.03);
    // Of a range of 0.7 m ± 0.14 m, 0.65 m is within in 64 of 100 cases.
    let noisy = deliveries(&radio(|radio| radio.range_noise = 0.2), 20_000);
    assert!((share(&noisy) - 0.64).abs() < 0.02, "{}", share(&noisy));
    // A checksum of 16 bits lets hardly a wrong byte pass.
    let corrupted = deliveries(&radio(|radio| radio.corruption = 0.2), 20_000);
    assert!((share(&corrupted) - 0.8).abs() < 0.015, "{}", share(&corrupted));
}

#[test]
fn walls_and_bodies_block_where_they_do() {
    let block = [(0.2, -0.1), (0.25, -0.1), (0.25, 0.1), (0.2, 0.1)].map(|(x, y)| Vector::new(x, y));
    let walls = Walls::new(vec![Polygon::new(block.to_vec()).unwrap()]);
    let positions = [Vector::new(0.0, 0.0), Vector::new(0.5, 0.0), Vector::new(-0.3, 0.0), Vector::new(-0.5, 0.02)];
    let hears = |config: &lab::Radio| {
        let heard = heard_in(config, &positions, &walls, 2);
        heard[1].iter().map(|heard| heard.0).collect::<Vec<_>>()
    };
    assert_eq!(hears(&radio(|_| ())), [2, 1, 3]);
    assert_eq!(hears(&radio(|radio| radio.walls_block = true)), [2, 3]);
    assert_eq!(hears(&radio(|radio| radio.bodies_block = true)), [2, 1]);
}

#[test]
fn the_place_that_a_receiver_has_just_left_does_not_block() {
    let positions = line(&[0.0, 0.5]);
    for moved in [-0.01, -0.001, 0.0, 0.001, 0.01] {
        let mut ether = Ether::new(&radio(|radio| radio.bodies_block = true), 1, 2);
        let mut receiver = ether.receiver(0);
        let obstruction = Obstruction { walls: &open(), positions: &positions };
        ether.begin(0, &positions);
        ether.send(1, &Letter::of(&message(1), 0));
        ether.begin(1, &positions);
        let mut heard = heapless::Vec::new();
        ether.deliver(&mut receiver, Vector::new(moved, 0.0), FRAME_US, &obstruction, &mut heard);
        assert_eq!(heard.len(), 1, "moved by {moved} m");
    }
}

#[test]
fn a_crowd_with_heavy_losses_is_searched_to_the_end() {
    // Half the messages get lost in a crowd of 40, and the inbox still fills, with the nearest of the others.
    let positions: Vec<Point<f64>> = (0..40).map(|i| Vector::new(f64::from(i) * 0.01, 0.0)).collect();
    let mut ether = Ether::new(&radio(|radio| radio.loss = 0.5), 6, 40);
    let mut receiver = ether.receiver(0);
    for frame in 0..1000 {
        ether.begin(frame, &positions);
        let heard = hear(&ether, &mut receiver, &positions, frame, &open());
        assert!(frame == 0 || heard.len() == MAX_HEARD);
        assert!(heard.windows(2).all(|pair| pair[0].message.sender < pair[1].message.sender));
        (0..40).for_each(|sender| ether.send(sender, &Letter::of(&message(sender), frame * FRAME_US)));
    }
}
