//! From models, worlds and runs to the plain data that figures are drawn from, and the pictures of a folder.

use crate::evaluation::{Contours, Model, Moment, Snapshot, Tracer, World};
use crate::evolve::{FrontMember, Individual, Objectives};
use crate::files::Contents;
use crate::model::describe;
use crate::model::notation::Digits;
use crate::simulation::{PatternRuler, Simulation};
use firmware_sim::faults::{Absences, Fault};
use firmware_sim::geometry::{Bounds, Polygon, Walls};
use firmware_sim::lab::FaultKind;
use firmware_sim::metrics::Bearings;
use firmware_sim::scenario::{Course, Ring, Scenario, Scene};
use firmware_sim::trace::{Frame, RobotState, Trace, metres};
use grn_core::blob::Blob;
use grn_core::geometry::Point;
use grn_core::network::Network;
use grn_core::robot::epuck2::{BODY_RADIUS, TICKS_PER_SECOND};
use grn_figures::{FigureError, Window};
use grn_optimisers::knee::Knee;

/// Pictures by their path in a folder, and a line on each that cannot be drawn: a picture never costs the run that it is of.
#[derive(Default)]
pub struct Pictures {
    /// The pictures.
    pub contents: Contents,
    /// What cannot be drawn, and why.
    pub not_drawn: Vec<String>,
}

impl Pictures {
    /// Adds a picture under its path, which ends in `.svg`.
    pub fn add(&mut self, name: &str, figure: Result<String, FigureError>) {
        match figure {
            Ok(svg) => drop(self.contents.insert(name.into(), svg.into_bytes())),
            Err(error) => self.not_drawn.push(format!("{name} is not drawn: {error}")),
        }
    }

    /// Adds the pages of a picture: `f2.svg`, `f2-2.svg`, ….
    pub fn add_pages(&mut self, stem: &str, figure: Result<Vec<String>, FigureError>) {
        match figure {
            Ok(pages) => {
                for (page, svg) in pages.into_iter().enumerate() {
                    let number = if page == 0 { String::new() } else { format!("-{}", page + 1) };
                    self.contents.insert(format!("{stem}{number}.svg"), svg.into_bytes());
                }
            }
            Err(error) => self.not_drawn.push(format!("{stem}.svg is not drawn: {error}")),
        }
    }
}

fn pair(point: Point<f64>) -> [f64; 2] {
    [point.x, point.y]
}

fn pairs(points: &[Point<f64>]) -> Vec<[f64; 2]> {
    points.iter().copied().map(pair).collect()
}

fn outlines(polygons: &[Polygon]) -> Vec<Vec<[f64; 2]>> {
    polygons.iter().map(|polygon| pairs(polygon.vertices())).collect()
}

fn paths(scenario: &Scenario) -> Vec<Vec<[f64; 2]>> {
    scenario.targets().iter().map(|target| pairs(target.path().points())).collect()
}

/// f2 of a circle midway between d_min and d_max around one target, far from every wall: 2 / (1 + e^(k (d_max - d_min) / 2)).
pub fn perfect_circle(ring: &Ring) -> f64 {
    2.0 / (1.0 + libm::exp(ring.steepness * (ring.d_max - ring.d_min) / 2.0))
}

/// Of the last population, individuals beyond this multiple of the front's worst f2 or most nodes are not drawn: they would
/// squeeze the front into a corner.
const NEARBY_F2: f64 = 1.25;
const NEARBY_NODES: usize = 3;

/// The front among other models of its last population, knees named, beside a perfect circle's f2.
///
/// # Errors
/// Numbers that cannot be drawn.
pub fn front(
    objectives: &Objectives,
    front: &[FrontMember],
    others: &[&Individual],
    ring: &Ring,
) -> Result<String, FigureError> {
    if *objectives == Objectives::paper() { pareto(front, others, ring) } else { by_pairs(objectives, front, others) }
}

/// A front in any objectives; models without a pattern, whose values are out of all proportion, are left out.
fn by_pairs(objectives: &Objectives, front: &[FrontMember], others: &[&Individual]) -> Result<String, FigureError> {
    let member = |member: &FrontMember| grn_figures::ObjectivesPoint {
        values: objectives.in_order(member.nodes as f64, member.f2, &member.further),
        non_dominated: true,
        feasible: member.is_feasible(),
        knee: member.knee,
        label: describe::expression(&member.network, Digits::None),
    };
    let other = |individual: &&Individual| grn_figures::ObjectivesPoint {
        values: individual.objectives.clone(),
        non_dominated: false,
        feasible: individual.is_feasible(),
        knee: Knee::default(),
        label: individual.tree.expression(Digits::None),
    };
    let in_proportion = |point: &grn_figures::ObjectivesPoint| point.values.iter().all(|value| value.abs() < f64::MAX);
    let points = front.iter().map(member).chain(others.iter().map(other)).filter(in_proportion).collect();
    grn_figures::objectives(&grn_figures::ObjectivesFigure { labels: objectives.descriptions().collect(), points })
}

fn pareto(front: &[FrontMember], others: &[&Individual], ring: &Ring) -> Result<String, FigureError> {
    let most_nodes = front.iter().map(|member| member.nodes).max().unwrap_or(0);
    let worst_f2 = front.iter().map(|member| member.f2).fold(0.0, f64::max);
    let is_near = |individual: &&&Individual| {
        individual.f2 <= NEARBY_F2 * worst_f2 && individual.tree.size() <= NEARBY_NODES * most_nodes
    };
    let member = |member: &FrontMember| grn_figures::ParetoPoint {
        nodes: member.nodes as u32,
        f2: member.f2,
        feasible: member.is_feasible(),
        knee: member.knee,
        label: describe::expression(&member.network, Digits::None),
    };
    let other = |individual: &&Individual| grn_figures::ParetoPoint {
        nodes: individual.tree.size() as u32,
        f2: individual.f2,
        feasible: individual.is_feasible(),
        knee: Knee::default(),
        label: individual.tree.expression(Digits::None),
    };
    let points = front.iter().map(member).chain(others.iter().filter(is_near).map(other));
    let best = perfect_circle(ring);
    let reference = grn_figures::Reference { f2: best, label: format!("perfect circle in free space, {best:.5}") };
    grn_figures::pareto(&points.collect::<Vec<_>>(), "", Some(&reference))
}

/// The syntax tree of a network.
pub fn tree(network: &Network<f32>) -> String {
    match describe::syntax_tree(network) {
        Some(tree) => grn_figures::tree(&tree),
        None => grn_figures::nothing_to_draw(&describe::expression(network, Digits::None)),
    }
}

/// The genes of a network and what they read.
///
/// # Errors
/// Numbers that cannot be drawn.
pub fn grn(network: &Network<f32>) -> Result<String, FigureError> {
    grn_figures::grn(&describe::graph(network))
}

/// The pattern at each snapshot; of more than 25 as many as fill a page, evenly chosen.
///
/// # Errors
/// Numbers that cannot be drawn.
pub fn pattern(world: &World, model: &Model) -> Result<String, FigureError> {
    const MOST_PANELS: usize = 25;
    let scenario = world.scenario();
    let mut tracer = Tracer::with_leaks(world);
    let stride = scenario.snapshots().div_ceil(MOST_PANELS);
    let panel = |(index, (snapshot, contours)): (usize, (&Snapshot, Contours))| grn_figures::Panel {
        title: format!("snapshot {index}"),
        window: None,
        walls: snapshot.walls().polygons().map(|polygon| pairs(polygon.vertices())).collect(),
        targets: snapshot
            .targets
            .iter()
            .zip(&contours.enclosed)
            .map(|(&target, &enclosed)| grn_figures::Target { position: pair(target), enclosed })
            .collect(),
        contours: contours.rings.iter().map(|ring| pairs(ring)).collect(),
        leak_outlines: contours.leaks.iter().map(|outline| pairs(outline)).collect(),
        candidates: Vec::new(),
    };
    let panels = tracer.trace_all(model).enumerate().step_by(stride).map(panel).collect();
    let [width, height] = scenario.region();
    let region = Window { min: [0.0, 0.0], max: [width, height] };
    grn_figures::pattern(&grn_figures::PatternFigure { region, paths: paths(scenario), panels, columns: None })
}

/// How many moments of a run are drawn with robots and pattern.
const INSTANTS: usize = 5;
/// How many points the time series and trajectories have at most.
const SAMPLES: usize = 600;

/// Who is one of the swarm when, as in the metrics.
struct Service {
    broken: Absences,
    at_base: Absences,
}

impl Service {
    fn of(simulation: &Simulation) -> Service {
        let mut at_base = Absences::default();
        if let Some(base) = &simulation.base {
            base.add_absences(simulation.config.lab.robots.count, &mut at_base);
        }
        Service { broken: simulation.faults.absences(), at_base }
    }

    fn has(&self, robot: usize, tick: u64) -> bool {
        [&self.broken, &self.at_base].into_iter().all(|absences| absences.none_in(robot, tick..tick + 1))
    }

    /// The robots in service.
    fn of_frame<'f>(&self, frame: &Frame<'f>) -> impl Iterator<Item = &'f RobotState> {
        let tick = frame.tick;
        frame.robots.iter().enumerate().filter(move |&(robot, _)| self.has(robot, tick)).map(|(_, state)| state)
    }
}

/// The faults of a run and where robots were when they began; one that is late begins with the run and is none on the map.
fn faults(simulation: &Simulation, frames: &[Frame<'_>]) -> Vec<grn_figures::Fault> {
    let mark = |fault: &Fault| {
        let place = frames.partition_point(|frame| frame.tick < fault.from);
        let frame = frames.get(place).filter(|_| fault.kind != FaultKind::Late)?;
        let position = pair(metres(frame.robots.get(fault.robot)?.position_um));
        Some(grn_figures::Fault { time: fault.from as f64 / f64::from(TICKS_PER_SECOND), position })
    };
    simulation.faults.faults().iter().filter_map(mark).collect()
}

/// A run of the swarm: where the robots went, and how well they held the pattern.
///
/// # Errors
/// Numbers that cannot be drawn.
pub fn run(simulation: &Simulation, trace: &Trace, scenario: &Scenario, blob: &Blob) -> Result<String, FigureError> {
    let scale = f64::from(blob.scale);
    let frames: Vec<Frame<'_>> = trace.frames().collect();
    let stride = frames.len().div_ceil(SAMPLES).max(1);
    let sampled: Vec<(f64, &Frame<'_>)> =
        frames.iter().enumerate().step_by(stride).map(|(place, frame)| (trace.seconds(place), frame)).collect();
    let robots = frames.first().map_or(0, |frame| frame.robots.len());
    let trajectory =
        |robot: usize| sampled.iter().map(|(_, frame)| pair(metres(frame.robots[robot].position_um))).collect();
    let trajectories: Vec<Vec<[f64; 2]>> = (0..robots).map(trajectory).collect();
    let world = scenario.scaled(scale);
    // A pattern that does not close has no radius.
    let radius = Some(simulation.ring_radius_m).filter(|radius| radius.is_finite());
    let window = window_around(trajectories.iter().flatten().copied(), radius.map(|radius| 1.5 * radius));
    let ruler = PatternRuler::new(blob, scenario).ok();
    let service = Service::of(simulation);
    let course = trace.header().course(&world);
    let mut scene = Scene::of(scenario, 0.0);
    let mut radial_error = |seconds: f64, frame: &Frame<'_>| {
        scene.move_to(scenario, course.time_at(seconds));
        median_error(frame, ruler.as_ref(), scene.walls(), &service)
    };
    grn_figures::trace(&grn_figures::TraceFigure {
        window,
        walls: outlines(world.fixed_walls().fixed()),
        target_paths: paths(&world),
        trajectories,
        body_radius: BODY_RADIUS,
        instants: instants(&frames, trace, scenario, blob, &course, &service),
        faults: faults(simulation, &frames),
        times: sampled.iter().map(|(time, _)| *time).collect(),
        gaps: gaps(&sampled, scenario.targets().len(), &service),
        radial_error: sampled.iter().map(|&(seconds, frame)| radial_error(seconds, frame)).collect(),
        radial_band: None,
    })
}

/// The window with a margin around points: the given one, else a tenth of their extent.
fn window_around(points: impl Iterator<Item = [f64; 2]>, margin: Option<f64>) -> Window {
    let bounds = Bounds::around(points.map(|[x, y]| Point::new(x, y)));
    let (low, high) = bounds.map_or(([0.0; 2], [1.0; 2]), |bounds| (pair(bounds.low), pair(bounds.high)));
    let margin = margin.unwrap_or_else(|| 0.1 * (high[0] - low[0]).max(high[1] - low[1]).max(0.1));
    Window { min: low.map(|edge| edge - margin), max: high.map(|edge| edge + margin) }
}

/// `None` while the target is not there.
fn gaps(sampled: &[(f64, &Frame<'_>)], targets: usize, service: &Service) -> Vec<Vec<Option<f64>>> {
    let mut bearings = Bearings::default();
    let mut gap = |frame: &Frame<'_>, target: usize| {
        let target = metres(frame.targets_um[target]?);
        bearings.take(target, service.of_frame(frame).map(|robot| metres(robot.position_um)));
        Some(bearings.largest_gap().to_degrees())
    };
    (0..targets).map(|target| sampled.iter().map(|(_, frame)| gap(frame, target)).collect()).collect()
}

/// `None` where no robot finds the pattern.
fn median_error(frame: &Frame<'_>, ruler: Option<&PatternRuler<'_>>, walls: &Walls, service: &Service) -> Option<f64> {
    let targets: Vec<_> = frame.targets_um.iter().flatten().map(|&target| metres(target)).collect();
    let distance = |position| ruler.and_then(|ruler| ruler.distance(metres(position), &targets, walls));
    // As in the metrics, an unknown distance is longer than any other.
    let known = |robot: &RobotState| distance(robot.position_um).unwrap_or(f64::INFINITY);
    let mut errors: Vec<f64> = service.of_frame(frame).map(known).collect();
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() / 2).copied().filter(|error| error.is_finite())
}

fn instants(
    frames: &[Frame<'_>],
    trace: &Trace,
    scenario: &Scenario,
    blob: &Blob,
    course: &Course,
    service: &Service,
) -> Vec<grn_figures::Instant> {
    let Some(last) = frames.len().checked_sub(1) else { return Vec::new() };
    let seconds = trace.seconds(last).floor();
    let whole_second = |instant: usize| (seconds * instant as f64 / (INSTANTS - 1) as f64).round();
    let place = |instant: usize| ((whole_second(instant) / trace.seconds(1)) as usize).min(last);
    let mut places: Vec<usize> = (0..INSTANTS).map(place).collect();
    // A run of few seconds has fewer moments.
    places.dedup();
    let scale = f64::from(blob.scale);
    let unscaled = |target: &[i32; 2]| {
        let point = metres(*target);
        Point::new(point.x / scale, point.y / scale)
    };
    let moment = |&place: &usize| {
        let targets = frames[place].targets_um.iter().flatten().map(unscaled).collect();
        Moment { targets, walls: scenario.walls_at(course.time_at(trace.seconds(place))) }
    };
    let world = World::at(scenario.clone(), places.iter().map(moment).collect());
    let model = Model::new(&blob.network, f64::from(blob.level_fraction)).ok();
    let mut tracer = Tracer::new(&world);
    let rings: Vec<Contours> = model
        .iter()
        .flat_map(|model| tracer.trace_all(model).map(|(_, contours)| contours).collect::<Vec<_>>())
        .collect();
    let scaled = |ring: &Vec<Point<f64>>| ring.iter().map(|point| [point.x * scale, point.y * scale]).collect();
    let instant = |(number, &place): (usize, &usize)| grn_figures::Instant {
        time: trace.seconds(place),
        robots: frames[place]
            .robots
            .iter()
            .enumerate()
            .map(|(number, robot)| grn_figures::Pose {
                position: pair(metres(robot.position_um)),
                heading: heading(robot.heading_q14),
                in_service: service.has(number, frames[place].tick),
            })
            .collect(),
        targets: frames[place].targets_um.iter().flatten().map(|&target| pair(metres(target))).collect(),
        walls: outlines(world.snapshots()[number].walls().moving())
            .into_iter()
            .map(|outline| outline.into_iter().map(|[x, y]| [x * scale, y * scale]).collect())
            .collect(),
        contours: rings.get(number).map(|contours| contours.rings.iter().map(scaled).collect()).unwrap_or_default(),
    };
    places.iter().enumerate().map(instant).collect()
}

fn heading([cos, sin]: [i16; 2]) -> f64 {
    libm::atan2(f64::from(sin), f64::from(cos))
}
