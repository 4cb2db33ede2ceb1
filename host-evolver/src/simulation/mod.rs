//! Software in the loop: a blob on every robot of a simulated swarm, and whether it works.

mod length;
mod outlook;
mod ruler;
pub mod verdict;

use crate::pattern_length::circumference;
use firmware_sim::base_station::{BaseRecord, Circumference};
use firmware_sim::brain::{Brain, Onboard};
use firmware_sim::config::SwarmConfig;
use firmware_sim::faults::{Absences, FaultPlan};
use firmware_sim::lab::Laboratory;
use firmware_sim::metrics::{Caging, CagingMeter, Meter, Metrics, MetricsOptions, PatternDistance, WallsOfRun};
use firmware_sim::scenario::{Course, Scenario, Scene};
use firmware_sim::swarm::{Outcome, Progress, StepError, Swarm};
use firmware_sim::trace::Observer;
use grn_core::blob::{Blob, Identity};
use grn_core::geometry::Point;
use grn_core::pattern::NoPattern;
use grn_core::robot::epuck2::TICKS_PER_SECOND;
use grn_core::robot::{Controller, LoadError};
use grn_core::scalar::{NumberType, Q8_24, Scalar};
use grn_input::InputError;
use std::error::Error;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;
use verdict::{ENOUGH_CAGED, ENOUGH_IN_BAND, MOST_CONTACT, MOST_LOST, Verdict, time_to_form_s};

pub use length::check_length;
pub use outlook::doubts;
pub use ruler::PatternRuler;

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
    pub caging: Caging,
    /// How well the swarm kept to the model's pattern.
    pub metrics: Metrics,
    /// How long it may take to form: see [`time_to_form_s`].
    pub time_to_form_s: f64,
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

impl Simulation {
    /// Median radial error as a share of the ring's radius; `None` if the swarm never formed or the median is unknown.
    pub fn radial_error_share(&self) -> Option<f64> {
        self.metrics.radial_error_median_m.map(|error| error / self.ring_radius_m)
    }

    /// Robots lost at the end, as a share of all.
    pub fn lost_share(&self) -> f64 {
        self.metrics.lost_robots as f64 / self.config.lab.robots.count.max(1) as f64
    }

    /// Whether the controller works.
    pub fn verdict(&self) -> Verdict {
        let Caging { caged_share, in_band_share, contact_share, formed_at_s, .. } = self.caging;
        Verdict {
            caged: caged_share >= ENOUGH_CAGED,
            in_band: in_band_share >= ENOUGH_IN_BAND,
            clear: contact_share <= MOST_CONTACT,
            together: self.lost_share() <= MOST_LOST,
            formed: formed_at_s.is_some_and(|time| time <= self.time_to_form_s),
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

/// Whether a blob can drive robots in a world, and has a pattern there.
///
/// # Errors
/// [`SimulationError::Load`] or [`SimulationError::NoPattern`].
pub fn check_model(blob: &Blob, scenario: &Scenario, number: NumberType) -> Result<(), SimulationError> {
    match number {
        NumberType::F32 => native::<f32>(blob).map(drop),
        NumberType::Q8_24 => native::<Q8_24>(blob).map(drop),
    }?;
    PatternRuler::new(blob, scenario).map(drop).map_err(SimulationError::NoPattern)
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
    let mut caging = marks.caging_meter(TICKS_PER_SECOND);
    let share = |progress: Progress| progress.tick as f64 / progress.end.max(1) as f64;
    let outcome = swarm.run(end, &mut (&mut (&mut meter, &mut caging), observer), |progress| watch(share(progress)));
    match outcome.map_err(SimulationError::Brain)? {
        Outcome::Interrupted => return Ok(None),
        Outcome::Finished => {}
    }
    Ok(Some(Simulation {
        caging: caging.caging(),
        metrics: meter.metrics(),
        time_to_form_s: time_to_form_s(&config, swarm.world().ring()),
        faults: swarm.faults().clone(),
        base: swarm.base_record().cloned(),
        ring_radius_m: ruler.ring_radius(),
        blob: blob.identity(),
        number,
        config,
    }))
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

    /// Measures what the swarm is for.
    pub fn caging_meter(&self, ticks_per_second: u16) -> CagingMeter<'_> {
        CagingMeter::new(&self.world, self.course, &self.absences, ticks_per_second)
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

/// What a run costs: J of [`Caging::cost`], and nothing else is measured. Once it is sure to be more than `most` the run is broken off, and
/// costs what is sure by then.
///
/// # Errors
/// As of [`simulate`].
pub fn cost(setting: &Setting<'_>, config: SwarmConfig, most: f64) -> Result<f64, SimulationError> {
    let Setting { blob, scenario, circumference } = setting.clone();
    let swarm = Swarm::with_pattern(scenario, config, circumference, native::<f32>(blob)?);
    let mut swarm = swarm.map_err(SimulationError::Config)?;
    let (absences, end) = (swarm.faults().absences(), swarm.arrival_tick());
    let (world, course) = (swarm.world().clone(), Course::of(swarm.world(), swarm.config()));
    let mut meter = CagingMeter::new(&world, course, &absences, TICKS_PER_SECOND);
    meter.observe(&swarm.frame());
    while swarm.tick() < end {
        swarm.step().map_err(SimulationError::Brain)?;
        meter.observe(&swarm.frame());
        if swarm.tick().is_multiple_of(u64::from(TICKS_PER_SECOND)) && meter.least_cost() > most {
            return Ok(meter.least_cost());
        }
    }
    Ok(meter.caging().cost())
}
