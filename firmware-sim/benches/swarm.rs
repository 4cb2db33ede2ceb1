//! What the simulator itself costs: robot-ticks per second with every sensor and the radio on, under a cheap brain.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use firmware_sim::{Brain, BrainError, Scenario, Swarm, SwarmConfig};
use grn_core::geometry::Vector;
use grn_core::robot::message::ObstacleReport;
use grn_core::robot::{Command, Message, Millimetres, Percept, TargetReport};
use std::hint::black_box;
use std::time::Duration;

const ROBOTS: usize = 100;
const TICKS: u64 = 320;

/// Circles the target it last heard of, turns away from what is near, and broadcasts a full message.
struct Cheap {
    number: u8,
    target: TargetReport,
}

impl Brain for Cheap {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        for message in &percept.heard {
            if let Some(report) = message.target {
                self.target = report;
            }
        }
        if let Some(seen) = percept.targets.first() {
            self.target.position = seen.position;
        }
        let [x, y] = percept.position.map(|um| um / 1000);
        let to = Vector::new(
            f64::from(i32::from(self.target.position.x) - x),
            f64::from(i32::from(self.target.position.y) - y),
        );
        let [cos, sin] = percept.heading.map(f64::from);
        let ahead = (cos * to.x + sin * to.y) / 16384.0;
        let aside = (cos * to.y - sin * to.x) / 16384.0;
        let near = percept.proximity.iter().filter(|&&p| p < 200).count() as i16;
        let wanted = to.x * to.x + to.y * to.y - 400.0 * 400.0;
        let turn = if wanted * aside + ahead > 0.0 { 150 } else { -150 } + 50 * near;
        let position = Millimetres { x: x as i16, y: y as i16 };
        let report = ObstacleReport { position, age: 3 };
        let mut obstacles = percept.heard.first().map(|m| m.obstacles.clone()).unwrap_or_default();
        while obstacles.push(report).is_ok() {}
        let broadcast = Message { sender: self.number, position, target: Some(self.target), obstacles };
        Ok(Command { left: 600 - turn, right: 600 + turn, broadcast: Some(broadcast) })
    }
}

fn swarm(scenario: &Scenario, scale: f64) -> Swarm<Cheap> {
    let config = SwarmConfig { robots: ROBOTS, scale, settle_s: 0.0, ..SwarmConfig::default() };
    let target = TargetReport { target: 0, position: Millimetres { x: 750, y: 2500 }, velocity: [0; 2], age: 0 };
    let made = Swarm::new(scenario, config, |robot| Cheap { number: robot as u8, target });
    let mut swarm = made.unwrap_or_else(|error| panic!("{error}"));
    // Past the start, when buffers have grown and robots have met.
    for _ in 0..320 {
        step(&mut swarm);
    }
    swarm
}

fn step(swarm: &mut Swarm<Cheap>) {
    swarm.step().unwrap_or_else(|error| panic!("{error}"));
}

fn bench(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("swarm");
    group.throughput(Throughput::Elements(ROBOTS as u64 * TICKS));
    group.sample_size(20).measurement_time(Duration::from_secs(4)).warm_up_time(Duration::from_secs(1));
    for (name, text) in [
        ("channel", include_str!("../../scenarios/channel.toml")),
        ("compound-channel", include_str!("../../scenarios/compound-channel.toml")),
    ] {
        let scenario = Scenario::parse(text).unwrap_or_else(|error| panic!("{error}"));
        for scale in [0.25, 1.0] {
            group.bench_function(format!("{name}/scale-{scale}/{ROBOTS}-robots"), |bencher| {
                bencher.iter_batched_ref(
                    || swarm(&scenario, scale),
                    |swarm| {
                        swarm.restart_trace();
                        for _ in 0..TICKS {
                            step(swarm);
                        }
                        black_box(swarm.poses().len())
                    },
                    BatchSize::LargeInput,
                );
            });
        }
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
