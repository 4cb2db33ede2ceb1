//! What a robot-tick costs: the simulator with every sensor and the radio on, the real controller, and both together.
//!
//! Throughput is in robot-ticks. `simulator` runs under a cheap scripted brain that broadcasts a full message as often as
//! the controller does; `controller-…` replays percepts recorded in the same world; `swarm-…` is the closed loop.

use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use firmware_sim::{Brain, BrainError, Scenario, Swarm, SwarmConfig};
use grn_core::blob::{Blob, FieldParameters, Gains};
use grn_core::dynamics::Step;
use grn_core::geometry::Vector;
use grn_core::motif::Motif;
use grn_core::network::{Gene, Network, Source};
use grn_core::robot::message::ObstacleReport;
use grn_core::robot::{Command, Controller, Fix, Message, Millimetres, Percept, TargetReport};
use grn_core::scalar::{Q8_24, Scalar};
use std::hint::black_box;
use std::time::Duration;

const ROBOTS: usize = 100;
const TICKS: usize = 320;
/// As many robots as a swarm may have, in a world of a hundred times the area: as dense as [`ROBOTS`] in the channel.
const CROWD: usize = 10_000;
const PLAIN: &str = r#"
name = "plain"
region = [30.0, 30.0]
snapshots = 2
morphogen = { kernel = "gaussian", target_width = 1.5, obstacle_width = 0.9, level = 0.5 }
ring = { d_min = 2.5, d_max = 5.0, d_obstacle = 2.0, steepness = 10.0 }
target = [{ path = [[15.0, 15.0], [15.1, 15.0]] }]
"#;
/// How many robots' percepts are replayed to the controller alone; one of them is a mother's.
const REPLAYED: usize = 20;
/// A robot speaks every so many ticks, as under the real controller.
const BROADCAST_PERIOD: u32 = 8;

/// Circles the target it last heard of at this distance, turns away from what is near, and broadcasts a full message in its turn.
struct Cheap {
    number: u16,
    tick: u32,
    target: TargetReport,
    distance_mm: f64,
}

impl Brain for Cheap {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        self.tick += 1;
        for heard in &percept.heard {
            if let Some(report) = heard.message.target {
                self.target = report;
            }
        }
        if let Some(seen) = percept.targets.first() {
            self.target.position = seen.position;
        }
        let Fix { position, heading, .. } = percept.fix.ok_or_else(|| BrainError::new("a tick without a fix"))?;
        let [x, y] = position.map(|um| um / 1000);
        let to = Vector::new(
            f64::from(i32::from(self.target.position.x) - x),
            f64::from(i32::from(self.target.position.y) - y),
        );
        let [cos, sin] = heading.map(f64::from);
        let ahead = (cos * to.x + sin * to.y) / 16384.0;
        let aside = (cos * to.y - sin * to.x) / 16384.0;
        let near = percept.proximity.iter().filter(|&&p| p < 200).count() as i16;
        let wanted = to.x * to.x + to.y * to.y - self.distance_mm * self.distance_mm;
        let turn = if wanted * aside + ahead > 0.0 { 150 } else { -150 } + 50 * near;
        let turned = (self.tick + u32::from(self.number)).is_multiple_of(BROADCAST_PERIOD);
        let broadcast = turned.then(|| {
            let position = Millimetres { x: x as i16, y: y as i16 };
            let report = ObstacleReport { position, age: 3 };
            let mut obstacles = percept.heard.first().map(|h| h.message.obstacles.clone()).unwrap_or_default();
            while obstacles.push(report).is_ok() {}
            Message { sender: self.number, position, target: Some(self.target), obstacles }
        });
        Ok(Command { left: 600 - turn, right: 600 + turn, broadcast })
    }
}

/// The real controller, and a record of what it perceives in ticks [`TICKS`] to 2 [`TICKS`].
struct Real<S> {
    controller: Controller<S>,
    tick: usize,
    record: Option<Record<S>>,
}

/// A controller's state at the start, and its percepts from then on.
#[derive(Clone)]
struct Record<S> {
    start: Controller<S>,
    percepts: Vec<Percept>,
}

impl<S: Scalar> Brain for Real<S> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        if let Some(record) = &mut self.record {
            if self.tick == TICKS {
                record.start = self.controller.clone();
            }
            if self.tick >= TICKS {
                record.percepts.push(percept.clone());
            }
            self.tick += 1;
        }
        Brain::tick(&mut self.controller, percept)
    }
}

/// A result whose error ends the benchmark.
fn expect<T, E: core::fmt::Display>(result: Result<T, E>) -> T {
    result.unwrap_or_else(|error| panic!("{error}"))
}

/// The printed model XNOR(NAND(x1, x1), x2) in a blob for this world; one RK4 step a tick.
fn blob(scenario: &Scenario, scale: f64) -> Blob {
    let gene = |motif, inputs: &[Source], theta| Gene { motif, inputs: inputs.iter().copied().collect(), theta };
    let nand = gene(Motif::Nand, &[Source::X1, Source::X1], 0.8393);
    let xnor = gene(Motif::Xnor, &[Source::Gene(0), Source::X2], 0.9256);
    let morphogen = scenario.morphogen();
    Blob {
        network: expect(Network::new(1.0, [nand, xnor])),
        field: FieldParameters {
            kernel: morphogen.kernel,
            target_width: morphogen.target_width as f32,
            obstacle_width: morphogen.obstacle_width as f32,
        },
        level_fraction: morphogen.level as f32,
        scale: scale as f32,
        step: Step::EIGHTH,
        time_scale: 4.0,
        gains: Gains::default(),
    }
}

/// A swarm under way: past the start, when buffers have grown, news has spread and robots have met.
fn swarm<B: Brain>(robots: usize, scenario: &Scenario, scale: f64, brain: impl FnMut(usize) -> B) -> Swarm<B> {
    let config = SwarmConfig { scale, settle_s: 0.0, ..SwarmConfig::default() }.with_robots(robots);
    let mut swarm = expect(Swarm::new(scenario, config, brain));
    run(&mut swarm);
    swarm
}

fn run<B: Brain>(swarm: &mut Swarm<B>) {
    for _ in 0..TICKS {
        expect(swarm.step());
    }
}

/// A swarm of real controllers under way, of which every `recorded`-th keeps a record.
fn real<S: Scalar>(scenario: &Scenario, scale: f64, recorded: Option<usize>) -> Swarm<Real<S>> {
    let blob = blob(scenario, scale);
    swarm(ROBOTS, scenario, scale, |robot| {
        let controller: Controller<S> = expect(Controller::new(&blob, robot as u16));
        let recording = recorded.is_some_and(|every| robot.is_multiple_of(every));
        let record = recording.then(|| Record { start: controller.clone(), percepts: Vec::new() });
        Real { controller, tick: 0, record }
    })
}

fn simulator(group: &mut BenchmarkGroup<'_, WallTime>, scenario: &Scenario, scale: f64) {
    let target = TargetReport { target: 0, position: Millimetres { x: 750, y: 2500 }, velocity: [0; 2], age: 0 };
    let cheap = |robot| Cheap { number: robot as u16, tick: 0, target, distance_mm: 400.0 };
    group.bench_function(format!("simulator/scale-{scale}"), |bencher| {
        bencher.iter_batched_ref(|| swarm(ROBOTS, scenario, scale, cheap), run, BatchSize::LargeInput);
    });
}

fn crowd(group: &mut BenchmarkGroup<'_, WallTime>) {
    let scenario = expect(Scenario::parse(PLAIN));
    let target = TargetReport { target: 0, position: Millimetres { x: 15_000, y: 15_000 }, velocity: [0; 2], age: 0 };
    let cheap = |robot| Cheap { number: robot as u16, tick: 0, target, distance_mm: 4000.0 };
    group.sample_size(10).throughput(Throughput::Elements((CROWD * TICKS) as u64));
    group.bench_function("simulator/crowd", |bencher| {
        bencher.iter_batched_ref(|| swarm(CROWD, &scenario, 1.0, cheap), run, BatchSize::PerIteration);
    });
}

fn closed_loop<S: Scalar>(group: &mut BenchmarkGroup<'_, WallTime>, scenario: &Scenario, scale: f64) {
    group.bench_function(format!("swarm-{}/scale-{scale}", S::NAME), |bencher| {
        bencher.iter_batched_ref(|| real::<S>(scenario, scale, None), run, BatchSize::LargeInput);
    });
}

/// What [`REPLAYED`] of the robots perceived in a closed loop.
fn records<S: Scalar>(scenario: &Scenario, scale: f64) -> Vec<Record<S>> {
    let mut swarm = real::<S>(scenario, scale, Some(ROBOTS / REPLAYED));
    run(&mut swarm);
    swarm.brains().filter_map(|brain| brain.record.clone()).collect()
}

/// Gives these controllers their percepts, tick by tick as in a swarm.
fn replay<S: Scalar>(records: &mut [Record<S>]) {
    for tick in 0..TICKS {
        for Record { start, percepts } in records.iter_mut() {
            let _ = black_box(start.tick(&percepts[tick]));
        }
    }
}

fn controller<S: Scalar>(group: &mut BenchmarkGroup<'_, WallTime>, scenario: &Scenario, scale: f64) {
    let records = records::<S>(scenario, scale);
    group.bench_function(format!("controller-{}/scale-{scale}", S::NAME), |bencher| {
        bencher.iter_batched_ref(|| records.clone(), |records| replay(records), BatchSize::LargeInput);
    });
}

fn bench(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("channel");
    group.sample_size(20).measurement_time(Duration::from_secs(3)).warm_up_time(Duration::from_secs(1));
    let scenario = expect(Scenario::parse(include_str!("../../scenarios/channel.toml")));
    for scale in [1.0, 0.25] {
        group.throughput(Throughput::Elements((ROBOTS * TICKS) as u64));
        simulator(&mut group, &scenario, scale);
        closed_loop::<f32>(&mut group, &scenario, scale);
        closed_loop::<Q8_24>(&mut group, &scenario, scale);
        group.throughput(Throughput::Elements((REPLAYED * TICKS) as u64));
        controller::<f32>(&mut group, &scenario, scale);
        controller::<Q8_24>(&mut group, &scenario, scale);
    }
    crowd(&mut group);
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
