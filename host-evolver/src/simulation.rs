//! Software in the loop: a blob on every robot of a simulated swarm, and whether it works.

use crate::evaluation::Model;
use crate::pattern_length::circumference;
use firmware_sim::base_station::{BaseRecord, Circumference};
use firmware_sim::brain::{Brain, Onboard};
use firmware_sim::config::SwarmConfig;
use firmware_sim::faults::{Absences, FaultPlan};
use firmware_sim::geometry::Walls;
use firmware_sim::lab::Laboratory;
use firmware_sim::metrics::{Meter, Metrics, MetricsOptions, PatternDistance, WallsOfRun};
use firmware_sim::scenario::{Course, Scenario, Scene};
use firmware_sim::swarm::{Outcome, Progress, StepError, Swarm};
use firmware_sim::trace::Observer;
use grn_core::blob::{Blob, Identity};
use grn_core::field::Kernel;
use grn_core::geometry::{Point, Vector};
use grn_core::pattern::NoPattern;
use grn_core::robot::epuck2::TICKS_PER_SECOND;
use grn_core::robot::{Controller, LoadError};
use grn_core::scalar::{NumberType, Q8_24, Scalar};
use grn_input::InputError;
use serde::Serialize;
use std::error::Error;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Share of the time after forming during which every target must be encircled.
pub const ENOUGH_ENCIRCLED: f64 = 0.98;
/// Largest median radial error, as a share of the ring's radius.
pub const ENOUGH_ACCURACY: f64 = 0.10;

/// Largest share of robots' moments after forming in which the distance from the pattern may be unknown.
pub const ENOUGH_UNKNOWN: f64 = 0.05;
/// Most contacts between robots, for each robot: one may bump into another while the swarm forms, not again and again.
pub const ENOUGH_PEER_CONTACTS: f64 = 1.0;

/// Speed of the fastest target when nothing else is said, metres per second in the world.
pub const DEFAULT_SPEED: f64 = 0.03;

/// The usual run in a laboratory for a blob of this scale.
pub fn usual_config(scale: f32, lab: Laboratory) -> SwarmConfig {
    SwarmConfig { scale: f64::from(scale), target_speed_m_per_s: DEFAULT_SPEED, lab, ..SwarmConfig::default() }
}

/// Why there was no simulation.
#[derive(Debug)]
pub enum SimulationError {
    /// The blob cannot drive a robot.
    Load(LoadError),
    /// The blob's pattern vanishes in double precision.
    NoPattern(NoPattern),
    /// The swarm cannot be set up.
    Config(InputError),
    /// A robot's brain failed.
    Brain(StepError),
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SimulationError::Load(error) => error.fmt(f),
            SimulationError::NoPattern(error) => error.fmt(f),
            SimulationError::Config(error) => error.fmt(f),
            SimulationError::Brain(error) => error.fmt(f),
        }
    }
}

impl Error for SimulationError {
    /// It shows the words of the error in it, so the next in the chain is what that one comes from.
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            SimulationError::Load(error) => error.source(),
            SimulationError::NoPattern(error) => error.source(),
            SimulationError::Config(error) => error.source(),
            SimulationError::Brain(error) => error.source(),
        }
    }
}

/// A finished run.
pub struct Simulation {
    /// What it was worth.
    pub metrics: Metrics,
    /// What went wrong with robots.
    pub faults: FaultPlan,
    /// What the base station did, if there is one.
    pub base: Option<BaseRecord>,
    /// Radius of the model's ring around a lone target in free space, world metres.
    pub ring_radius_m: f64,
    /// The blob that ran.
    pub blob: Identity,
    /// What the robots computed in.
    pub number: NumberType,
    /// The swarm and its conditions.
    pub config: SwarmConfig,
}

/// Whether a run met each of the bars for a working controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Verdict {
    /// Every target encircled at least [`ENOUGH_ENCIRCLED`] of the time after forming.
    pub encircled: bool,
    /// Median radial error below [`ENOUGH_ACCURACY`] of the ring's radius.
    pub accurate: bool,
    /// The distance from the pattern was unknown in at most [`ENOUGH_UNKNOWN`] of the robots' moments after forming.
    pub known: bool,
    /// No robot was off the pattern at the end.
    pub none_lost: bool,
    /// No robot left the pattern and came back.
    pub none_strayed: bool,
    /// No wall was touched.
    pub clear_of_walls: bool,
    /// At most [`ENOUGH_PEER_CONTACTS`] contacts between robots for each of them.
    pub clear_of_peers: bool,
}

impl Verdict {
    /// All of it.
    pub fn works(self) -> bool {
        let Verdict { encircled, accurate, known, none_lost, none_strayed, clear_of_walls, clear_of_peers } = self;
        encircled && accurate && known && none_lost && none_strayed && clear_of_walls && clear_of_peers
    }
}

impl Simulation {
    /// Median radial error as a share of the ring's radius; `None` if the swarm never formed or the median is unknown.
    pub fn radial_error_share(&self) -> Option<f64> {
        self.metrics.radial_error_median_m.map(|error| error / self.ring_radius_m)
    }

    /// The most contacts between robots that a working swarm of this size has.
    pub fn allowed_peer_contacts(&self) -> u64 {
        (ENOUGH_PEER_CONTACTS * self.config.lab.robots.count as f64) as u64
    }

    /// Whether the controller works.
    pub fn verdict(&self) -> Verdict {
        let metrics = &self.metrics;
        Verdict {
            encircled: metrics.encircled_share.is_some_and(|share| share >= ENOUGH_ENCIRCLED),
            accurate: self.radial_error_share().is_some_and(|share| share < ENOUGH_ACCURACY),
            known: metrics.radial_error_unknown_share.is_some_and(|share| share <= ENOUGH_UNKNOWN),
            none_lost: metrics.lost_robots == 0,
            none_strayed: metrics.strayed_robots == 0,
            clear_of_walls: metrics.wall_contacts == 0,
            clear_of_peers: metrics.peer_contacts <= self.allowed_peer_contacts(),
        }
    }
}

/// What robots run, and where; made once for many runs.
#[derive(Clone)]
pub struct Setting<'a> {
    blob: &'a Blob,
    scenario: &'a Scenario,
    circumference: Option<Arc<Circumference>>,
}

impl<'a> Setting<'a> {
    /// Of runs with this configuration, but for seed and conditions, which may differ.
    ///
    /// # Errors
    /// [`SimulationError::NoPattern`] if there is a base station and the blob has no pattern that it could measure.
    pub fn new(blob: &'a Blob, scenario: &'a Scenario, config: &SwarmConfig) -> Result<Self, SimulationError> {
        let known = || circumference(blob, scenario, config).map(Arc::new).map_err(SimulationError::NoPattern);
        let circumference = config.lab.base_station.sends.then(known).transpose()?;
        Ok(Setting { blob, scenario, circumference })
    }
}

/// Runs `blob` on every robot until all targets have arrived. `observer` sees every tick; a
/// [`Recorder`](firmware_sim::trace::Recorder) keeps them, `()` does not. `watch` is called once a simulated second with the
/// share done and may stop the run.
///
/// # Errors
/// [`SimulationError`]; `Ok(None)` if `watch` stopped it.
pub fn simulate(
    blob: &Blob,
    scenario: &Scenario,
    config: SwarmConfig,
    number: NumberType,
    observer: &mut dyn Observer,
    watch: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Simulation>, SimulationError> {
    simulate_in(&Setting::new(blob, scenario, &config)?, config, number, observer, watch)
}

/// [`simulate`] in a setting that was made before.
///
/// # Errors
/// As of [`simulate`].
pub fn simulate_in(
    setting: &Setting<'_>,
    config: SwarmConfig,
    number: NumberType,
    observer: &mut dyn Observer,
    watch: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Simulation>, SimulationError> {
    match number {
        NumberType::F32 => run(setting, config, number, native::<f32>(setting.blob)?, observer, watch),
        NumberType::Q8_24 => run(setting, config, number, native::<Q8_24>(setting.blob)?, observer, watch),
    }
}

/// The controllers of a swarm in this process, by robot number.
pub(crate) fn native<S: Scalar>(blob: &Blob) -> Result<impl Fn(usize) -> Onboard<S>, SimulationError> {
    let loaded = Arc::new(Controller::<S>::new(blob, 0).map_err(SimulationError::Load)?);
    Ok(move |robot: usize| Onboard::new(&loaded, robot as u16))
}

/// [`simulate_in`] with any brains.
pub(crate) fn run<B: Brain>(
    setting: &Setting<'_>,
    config: SwarmConfig,
    number: NumberType,
    brain: impl FnMut(usize) -> B,
    observer: &mut dyn Observer,
    mut watch: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Simulation>, SimulationError> {
    let Setting { blob, scenario, circumference } = setting.clone();
    let ruler = PatternRuler::new(blob, scenario).map_err(SimulationError::NoPattern)?;
    check_length(scenario, &config).map_err(SimulationError::Config)?;
    let swarm = Swarm::with_pattern(scenario, config.clone(), circumference, brain);
    let mut swarm = swarm.map_err(SimulationError::Config)?;
    let end = swarm.arrival_tick();
    let marks = Marks::of(swarm.world().clone(), &config, swarm.faults());
    let mut meter = meter(&ruler, &marks, TICKS_PER_SECOND);
    let share = |progress: Progress| progress.tick as f64 / progress.end.max(1) as f64;
    let outcome = swarm.run(end, &mut (&mut meter, observer), |progress| watch(share(progress)));
    match outcome.map_err(SimulationError::Brain)? {
        Outcome::Interrupted => return Ok(None),
        Outcome::Finished => {}
    }
    let (metrics, ring_radius_m, blob) = (meter.metrics(), ruler.ring_radius(), blob.identity());
    let (faults, base) = (swarm.faults().clone(), swarm.base_record().cloned());
    Ok(Some(Simulation { metrics, faults, base, ring_radius_m, blob, number, config }))
}

/// What a [`meter`] of a run borrows.
pub struct Marks {
    world: Scenario,
    course: Course,
    absences: Absences,
    disturbances: Vec<u64>,
}

impl Marks {
    /// Of a run in `world`, which is in real metres, with this configuration, in which this goes wrong.
    pub fn of(world: Scenario, config: &SwarmConfig, faults: &FaultPlan) -> Self {
        let course = Course::of(&world, config);
        let tick = |time: f64| (course.seconds_at(time) * f64::from(TICKS_PER_SECOND)).ceil() as u64;
        let mut disturbances = faults.disturbances();
        disturbances.extend(world.changes().into_iter().map(tick));
        disturbances.sort_unstable();
        disturbances.dedup();
        Marks { world, course, absences: faults.absences(), disturbances }
    }
}

/// Measures a run, wherever its robots drive: those of another simulator are measured with the same ruler.
pub fn meter<'a>(
    ruler: &'a PatternRuler<'_>,
    marks: &'a Marks,
    ticks_per_second: u16,
) -> Meter<'a, impl PatternDistance> {
    let options = MetricsOptions {
        walls: WallsOfRun::Changing(&marks.world, marks.course),
        ring_radius_m: ruler.ring_radius(),
        ticks_per_second,
        disturbances: &marks.disturbances,
        absences: &marks.absences,
    };
    let mut scene = Scene::of(ruler.scenario, 0.0);
    Meter::new(options, move |robot, targets: &[Point<f64>], seconds| {
        scene.move_to(ruler.scenario, marks.course.time_at(seconds));
        ruler.distance(robot, targets, scene.walls())
    })
}

/// The longest run, simulated hours; who asks for more has mistyped a speed.
const MOST_HOURS: f64 = 1000.0;

/// Whether a run ends in reasonable time: a slow target makes a long run.
///
/// # Errors
/// [`InputError`] that says which speed or duration is possible.
pub fn check_length(scenario: &Scenario, config: &SwarmConfig) -> Result<(), InputError> {
    let most_seconds = MOST_HOURS * 3600.0;
    if scenario.travel_s(config.target_speed_m_per_s / config.scale) + config.settle_s <= most_seconds {
        return Ok(());
    }
    if let Some(duration_s) = scenario.duration_s() {
        let most = most_seconds - config.settle_s;
        let way_out =
            format!("the run would take longer than {MOST_HOURS:.0} simulated hours; at most {most} s are possible");
        return Err(InputError::new("duration_s", format!("{duration_s:?}"), way_out));
    }
    let path = scenario.longest_path() * config.scale;
    // Rounded up, so that the speed that is named is possible.
    let least = (path / (most_seconds - config.settle_s) * 1e9).ceil() / 1e9;
    let way_out = format!(
        "the run would take longer than {MOST_HOURS:.0} simulated hours; at least {least} metres per second are needed"
    );
    Err(InputError::new("target_speed_m_per_s", format!("{:?}", config.target_speed_m_per_s), way_out))
}

/// Measures how far a position in the world is from the pattern of the exact model.
pub struct PatternRuler<'s> {
    model: Model,
    field: grn_core::field::Field<f64>,
    scenario: &'s Scenario,
    scale: f64,
    /// Radius of the ring around a lone target in free space, scenario metres.
    ring_radius: f64,
    /// How far from all targets a point may be and still belong to their pattern, scenario metres.
    reach: f64,
}

impl<'s> PatternRuler<'s> {
    /// The ruler of a blob in a scenario.
    ///
    /// # Errors
    /// [`NoPattern`] if the blob's network has none.
    pub fn new(blob: &Blob, scenario: &'s Scenario) -> Result<Self, NoPattern> {
        let model = Model::new(&blob.network, f64::from(blob.level_fraction))?;
        let field = blob.field.field(1.0);
        let ring_radius = model.pattern().free_space_radius(model.network(), &field).unwrap_or(f64::INFINITY);
        let merged = merged_ring_radius(blob.field.kernel, ring_radius, field.target_width(), scenario.targets().len());
        Ok(PatternRuler {
            model,
            field,
            scenario,
            scale: f64::from(blob.scale),
            ring_radius,
            reach: ring_radius + merged,
        })
    }

    /// Radius of the ring around a lone target in free space, world metres; infinite if it does not close.
    pub fn ring_radius(&self) -> f64 {
        self.ring_radius * self.scale
    }

    /// Distance from `robot` to the nearest candidate point, all in world metres. `None` where none is found, and where the
    /// one that is found is farther from every target than two ring radii (more with several targets, whose rings merge):
    /// the contour is open there and follows the walls away from the targets, so it encloses none. `walls` are those of the
    /// scenario, in its metres, at that moment.
    pub fn distance(&self, robot: Point<f64>, targets: &[Point<f64>], walls: &Walls) -> Option<f64> {
        let unscaled = |point: Point<f64>| Vector::new(point.x / self.scale, point.y / self.scale);
        let start = unscaled(robot);
        let targets: Vec<_> = targets.iter().map(|&target| unscaled(target)).collect();
        let pattern = self.model.pattern();
        let longest = self.field.target_width() / 4.0;
        let found = pattern.nearest_candidate(self.model.network(), &self.field, &targets, walls, start, longest)?;
        let near_target = targets.iter().any(|&target| (found - target).length() <= self.reach);
        near_target.then(|| (found - start).length() * self.scale)
    }
}

/// Radius of the ring around `targets` targets at one place: where n κ(R/σ) = κ(r/σ), the level of a lone target's ring.
fn merged_ring_radius(kernel: Kernel, ring_radius: f64, target_width: f64, targets: usize) -> f64 {
    let widened = target_width * libm::log(targets.max(1) as f64);
    match kernel {
        Kernel::Gaussian => (ring_radius * ring_radius + 2.0 * target_width * widened).sqrt(),
        Kernel::Exponential => ring_radius + widened,
    }
}
