//! The closed loop: simulated swarms that run the flashed controller encircle a moving target on the model's pattern.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::geometry::Walls;
use firmware_sim::{Brain, BrainError, Metrics, MetricsOptions, Scenario, Swarm, SwarmConfig};
use grn_core::blob::{Blob, FieldParameters, Gains};
use grn_core::dynamics::Step;
use grn_core::field::{Field, Obstacles};
use grn_core::geometry::{Point, Vector};
use grn_core::network::Network;
use grn_core::pattern::Pattern;
use grn_core::robot::{Command, Controller, Percept};
use grn_core::scalar::{Q8_24, Scalar};
use host_evolver::published::PUBLISHED;
use host_evolver::tree::Tree;
use std::ops::ControlFlow;
use std::thread;

/// Model metres; shorter Newton steps than the ring is wide.
const LONGEST_STEP: f64 = 0.5;
/// Every how many robot-moments the distance to the pattern is measured: it is slow, and moments are much alike.
const MEASURED: u64 = 7;

struct Robot<S>(Controller<S>);

impl<S: Scalar> Brain for Robot<S> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        Ok(self.0.tick(percept))
    }
}

/// The walls as they are, not as robots know them.
struct Exact<'a>(&'a Walls);

impl Obstacles<f64> for Exact<'_> {
    fn offset_from_nearest(&self, point: Point<f64>) -> Option<Vector<f64>> {
        let (boundary, _) = self.0.nearest_boundary(point)?;
        Some(if self.0.containing(point).is_none() { point - boundary } else { Vector::ZERO })
    }
}

/// What one run was worth.
struct Run {
    metrics: Metrics,
    /// Radius of the model's ring in free space, world metres.
    ring: f64,
    /// Robots that began to touch another after forming.
    peer_contacts_after_forming: u64,
}

impl Run {
    fn encircled(&self) -> f64 {
        self.metrics.encircled_share.unwrap_or(0.0)
    }

    /// Median and 95th percentile of the distance to the pattern as shares of the ring's radius.
    fn radial_errors(&self) -> [f64; 2] {
        [self.metrics.radial_error_median_m, self.metrics.radial_error_p95_m]
            .map(|error| error.unwrap_or(f64::INFINITY) / self.ring)
    }
}

fn scenario(name: &str) -> Scenario {
    Scenario::load(format!("{}/../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// A printed model by name, or a tree.
fn network(model: &str) -> Network<f32> {
    match PUBLISHED.iter().find(|published| published.name == model) {
        Some(published) => published.network().unwrap(),
        None => model.parse::<Tree>().unwrap().network(1.0).unwrap(),
    }
}

/// The world of the bar: a quarter of the scenario's scale, 12 robots, targets at 30 mm/s.
fn bar(seed: u64) -> SwarmConfig {
    SwarmConfig { robots: 12, seed, target_speed_m_per_s: 0.03, ..SwarmConfig::default() }
}

fn run<S: Scalar>(network: &Network<f32>, scenario: &Scenario, config: SwarmConfig) -> Run {
    let (morphogen, scale) = (scenario.morphogen(), config.scale);
    let blob = Blob {
        network: network.clone(),
        field: FieldParameters {
            kernel: morphogen.kernel,
            target_width: morphogen.target_width as f32,
            obstacle_width: morphogen.obstacle_width as f32,
        },
        level_fraction: morphogen.level as f32,
        scale: scale as f32,
        step: Step::DEFAULT,
        time_scale: 4.0,
        gains: Gains::default(),
    };
    let brain = |robot: usize| Robot(Controller::<S>::new(&blob, robot as u8).unwrap());
    let mut swarm = Swarm::new(scenario, config, brain).unwrap();
    swarm.run(swarm.arrival_tick(), |_| ControlFlow::Continue(())).unwrap();

    let network = network.cast::<f64>();
    let pattern = Pattern::of(&network, morphogen.level).unwrap();
    let field = Field::new(morphogen.kernel, morphogen.target_width, morphogen.obstacle_width);
    let mut moments = 0;
    let distance = |robot: Point<f64>, targets: &[Point<f64>]| {
        moments += 1;
        if moments % MEASURED != 0 {
            return None;
        }
        let robot = robot * (1.0 / scale);
        let targets: Vec<_> = targets.iter().map(|&target| target * (1.0 / scale)).collect();
        let walls = Exact(scenario.walls());
        let found = pattern.nearest_candidate(&network, &field, &targets, &walls, robot, LONGEST_STEP)?;
        Some((found.point - robot).length() * scale)
    };
    let metrics = Metrics::of(swarm.trace(), swarm.walls(), &MetricsOptions::default(), distance);
    let per_second = f64::from(swarm.trace().header().ticks_per_second);
    let formed = metrics.formed_at_s.map_or(swarm.trace().len(), |seconds| (seconds * per_second) as usize);
    let contacts = swarm.trace().frames().skip(formed).map(|frame| u64::from(frame.contacts.peer_events));
    Run {
        peer_contacts_after_forming: contacts.sum(),
        ring: pattern.free_space_radius(&network, &field).unwrap() * scale,
        metrics,
    }
}

/// One run for each seed, side by side.
fn runs<S: Scalar>(model: &str, scenario: &Scenario, configs: impl IntoIterator<Item = SwarmConfig>) -> Vec<Run> {
    let network = &network(model);
    let configs: Vec<_> = configs.into_iter().collect();
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let chunks = configs.chunks(configs.len().div_ceil(workers).max(1));
    thread::scope(|scope| {
        let one = |chunk: &[SwarmConfig]| -> Vec<Run> {
            chunk.iter().map(|config| run::<S>(network, scenario, config.clone())).collect()
        };
        let started: Vec<_> = chunks.map(|chunk| scope.spawn(move || one(chunk))).collect();
        started.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    })
}

/// The thresholds of the bar, with forming and peer contacts as tight as the controller keeps them.
fn assert_bar(name: &str, runs: &[Run]) {
    for (index, run) in runs.iter().enumerate() {
        let Run { metrics, peer_contacts_after_forming, .. } = run;
        let place = format!("{name}, run {index}");
        assert!(
            metrics.formed_at_s.is_some_and(|formed| formed <= 10.0),
            "{place}: formed at {:?}",
            metrics.formed_at_s
        );
        assert!(run.encircled() >= 0.98, "{place}: encircled {:.3} of the time", run.encircled());
        let [median, p95] = run.radial_errors();
        assert!(median < 0.05 && p95 < 0.1, "{place}: off the pattern by {median:.3}, 95 %: {p95:.3} of its radius");
        assert_eq!(metrics.wall_contacts, 0, "{place}: wall contacts");
        assert_eq!(*peer_contacts_after_forming, 0, "{place}: robots ran into each other");
    }
}

const MODELS: [&str; 3] = ["nand-xnor", "andn-nand-xnor", "(NOR[1.9995] x1 x1)"];

#[test]
fn a_moving_target_is_encircled() {
    let channel = scenario("channel");
    for model in MODELS {
        assert_bar(&format!("{model}, f32"), &runs::<f32>(model, &channel, [1, 2].map(bar)));
        assert_bar(&format!("{model}, Q8.24"), &runs::<Q8_24>(model, &channel, [3, 4].map(bar)));
    }
}

#[test]
fn a_crowd_stands_in_one_row() {
    let crowd = |seed| SwarmConfig { robots: 20, ..bar(seed) };
    let runs = runs::<f32>("nand-xnor", &scenario("channel"), [1, 2].map(crowd));
    for run in runs {
        let [_, p95] = run.radial_errors();
        assert!(p95 < 0.1, "20 robots are off the pattern by {p95:.3} of its radius");
    }
}

#[test]
fn targets_that_part_are_both_kept() {
    let scenario = scenario("channel-two-targets");
    for run in runs::<Q8_24>("andn-xnor", &scenario, [3, 11].map(bar)) {
        assert!(run.encircled() > 0.95, "a target got away: {:?}", run.metrics.encircled_share_by_target);
        assert_eq!(run.metrics.wall_contacts, 0);
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn table_row(world: &str, model: &str, number: &str, runs: &[Run]) {
    let of = |value: fn(&Run) -> f64| runs.iter().map(value);
    let lowest = |value| of(value).fold(f64::INFINITY, f64::min);
    let highest = |value| of(value).fold(0.0, f64::max);
    let formed = |run: &Run| run.metrics.formed_at_s.unwrap_or(f64::INFINITY);
    println!(
        "| {world} | {model} | {number} | {:.1} / {:.1} | {:.3} / {:.3} | {:.2} / {:.2} | {:.3} | {} | {} / {} |",
        median(of(formed)),
        highest(formed),
        lowest(Run::encircled),
        median(of(Run::encircled)),
        median(of(|run| run.radial_errors()[0] * 100.0)),
        median(of(|run| run.radial_errors()[1] * 100.0)),
        median(of(|run| run.metrics.spacing_evenness.unwrap_or(0.0))),
        of(|run| run.metrics.wall_contacts as f64).sum::<f64>(),
        of(|run| run.metrics.peer_contacts as f64).sum::<f64>(),
        of(|run| run.peer_contacts_after_forming as f64).sum::<f64>(),
    );
}

/// The whole bar, and how the controller does beyond it: run with `--release --ignored --nocapture`.
#[test]
#[ignore = "some minutes; prints a table"]
fn twenty_seeds_of_every_model() {
    println!(
        "| world | model | number | formed s, median / max | encircled, min / median | off pattern %, median / 95 % | \
         evenness | wall contacts | peer contacts, all / after forming |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let both = |world: &str, scenario: &Scenario, model: &str, config: &dyn Fn(u64) -> SwarmConfig| {
        let (float, fixed) =
            (runs::<f32>(model, scenario, (1..=20).map(config)), runs::<Q8_24>(model, scenario, (1..=20).map(config)));
        table_row(world, model, "f32", &float);
        table_row(world, model, "Q8.24", &fixed);
        [float, fixed]
    };
    let [channel, two_targets, compound] = ["channel", "channel-two-targets", "compound-channel"].map(scenario);
    let mut bars = Vec::new();
    for model in MODELS.into_iter().chain(["andn-xnor", "eh-grn-1", "eh-grn-2"]) {
        bars.extend(both("channel", &channel, model, &bar).map(|runs| (model, runs)));
    }
    for model in ["nand-xnor", "andn-nand-xnor"] {
        both("channel, 8 robots", &channel, model, &|seed| SwarmConfig { robots: 8, ..bar(seed) });
        both("channel, 20 robots", &channel, model, &|seed| SwarmConfig { robots: 20, ..bar(seed) });
        both("channel, 50 mm/s", &channel, model, &|seed| SwarmConfig { target_speed_m_per_s: 0.05, ..bar(seed) });
        both("channel, scale 0.1, 8 robots", &channel, model, &|seed| SwarmConfig {
            robots: 8,
            scale: 0.1,
            ..bar(seed)
        });
    }
    for model in ["nand-xnor", "andn-xnor", "andn-nand-xnor", "eh-grn-2"] {
        both("two targets", &two_targets, model, &bar);
    }
    for model in ["andn-xnor", "andn-nand-xnor", "eh-grn-2"] {
        both("compound channel", &compound, model, &bar);
    }
    for (model, runs) in bars.iter().filter(|(model, _)| MODELS.contains(model)) {
        assert_bar(model, runs);
    }
}
