//! A scenario prepared for evaluating many models: its morphogens on a lattice, which are the same for every model.
//!
//! What is known of the walls, the [`Ground`], is the same at every snapshot unless walls move, come or go.

use super::fine_lattice::FINE_STEP;
use super::ground::Ground;
use super::lanes::{Lanes, WIDTH, concentration};
use super::lattice::{Direction, LATTICE_STEP, Lattice};
use super::terms::Terms;
use firmware_sim::geometry::Walls;
use firmware_sim::scenario::{Morphogen, Scenario};
use grn_core::field::{Field, Kernel};
use grn_core::geometry::Point;
use std::sync::Arc;

/// Where things are at one instant.
#[derive(Clone, Debug)]
pub struct Moment {
    /// The targets that are there, metres.
    pub targets: Vec<Point<f64>>,
    /// The walls that are there, metres.
    pub walls: Walls,
}

/// A scenario at one instant, with its morphogens.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Its place among the snapshots with the same walls.
    pub(super) nth: usize,
    /// Where the targets are that are there, metres.
    pub targets: Vec<Point<f64>>,
    /// The walls that are there.
    pub(super) ground: Arc<Ground>,
    /// What the mother robots perceive of the walls, metres.
    pub obstacle_points: Vec<Point<f64>>,
    /// (x1, x2) at each target.
    pub(super) target_inputs: Vec<[f64; 2]>,
    /// (x1, x2) at each lattice node.
    pub(super) inputs: Vec<[f32; 2]>,
}

/// A scenario with its morphogens.
#[derive(Clone, Debug)]
pub struct World {
    scenario: Scenario,
    field: Field<f64>,
    snapshots: Vec<Snapshot>,
    /// The lattice on which patterns are judged.
    pub(super) coarse: Lattice,
    /// The lattice on which doubtful topology is decided.
    pub(super) fine: Lattice,
    pub(super) terms: Terms,
}

impl World {
    /// Prepares a scenario; takes a few hundredths of a second, more if its walls move.
    pub fn new(scenario: Scenario) -> World {
        let moment = |time| Moment { targets: scenario.targets_at(time), walls: scenario.walls_at(time) };
        let moments = scenario.snapshot_times().map(moment).collect();
        World::at(scenario, moments)
    }

    /// The same with other snapshots than the scenario's.
    pub fn at(scenario: Scenario, moments: Vec<Moment>) -> World {
        let morphogen = scenario.morphogen();
        let mut world = World {
            field: Field::new(morphogen.kernel, morphogen.target_width, morphogen.obstacle_width),
            snapshots: Vec::with_capacity(moments.len()),
            coarse: Lattice::over(scenario.region(), LATTICE_STEP),
            fine: Lattice::over(scenario.region(), FINE_STEP),
            terms: Terms::of(scenario.ring()),
            scenario,
        };
        let blurred = blurred(morphogen);
        // Moments with the same walls share what is known of these.
        let mut kinds: Vec<Walls> = Vec::new();
        let mut kind_of = |moment: &Moment| {
            kinds.iter().position(|walls| *walls == moment.walls).unwrap_or_else(|| {
                kinds.push(moment.walls.clone());
                kinds.len() - 1
            })
        };
        let kind_of: Vec<usize> = moments.iter().map(&mut kind_of).collect();
        let ground = |(kind, walls)| {
            let snapshots = kind_of.iter().filter(|&&other| other == kind).count();
            let ground = Ground::new(walls, &world.coarse, &world.fine, snapshots, blurred);
            let x2: Vec<f64> = ground.clearance.iter().map(|&clearance| world.x2_at(&ground, clearance)).collect();
            (Arc::new(ground), x2)
        };
        let grounds: Vec<(Arc<Ground>, Vec<f64>)> = kinds.into_iter().enumerate().map(ground).collect();
        let mut next = vec![0; grounds.len()];
        for (moment, kind) in moments.into_iter().zip(kind_of) {
            let (ground, x2) = &grounds[kind];
            let snapshot = world.snapshot(next[kind], moment.targets, ground, x2);
            world.snapshots.push(snapshot);
            next[kind] += 1;
        }
        world
    }

    fn snapshot(&self, nth: usize, targets: Vec<Point<f64>>, ground: &Arc<Ground>, x2: &[f64]) -> Snapshot {
        let x1 = self.coarse.nodes().map(|node| x1_at(&self.field, &targets, self.coarse.point(node)));
        Snapshot {
            nth,
            inputs: x1.zip(x2).map(|(x1, &x2)| [x1 as f32, x2 as f32]).collect(),
            target_inputs: targets.iter().map(|&target| self.inputs_among(ground, &targets, target)).collect(),
            obstacle_points: Scenario::obstacle_points(ground.walls(), &targets),
            ground: Arc::clone(ground),
            targets,
        }
    }

    /// Whether lattices with nodes so many metres apart show how x1 changes around targets.
    pub(super) fn shows_targets(&self, step: f64) -> bool {
        self.scenario.morphogen().target_width >= SHOWN_STEPS * step
    }

    /// The scenario it was made from.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Kernel and widths.
    pub fn field(&self) -> &Field<f64> {
        &self.field
    }

    /// The instants models are evaluated at.
    pub fn snapshots(&self) -> &[Snapshot] {
        &self.snapshots
    }

    /// (x1, x2) at any point, exactly.
    pub fn inputs_at(&self, snapshot: &Snapshot, point: Point<f64>) -> [f64; 2] {
        self.inputs_among(&snapshot.ground, &snapshot.targets, point)
    }

    fn inputs_among(&self, ground: &Ground, targets: &[Point<f64>], point: Point<f64>) -> [f64; 2] {
        [x1_at(&self.field, targets, point), self.x2_at(ground, ground.clearance_at(point))]
    }

    /// The same at eight points.
    pub(super) fn inputs_at_all(&self, snapshot: &Snapshot, points: &[Point<f64>; WIDTH]) -> [Lanes; 2] {
        let clearance = points.map(|point| snapshot.ground.clearance_at(point));
        [self.x1_at_all(snapshot, points), self.x2_at_all(&snapshot.ground, Lanes(clearance))]
    }

    fn x2_at(&self, ground: &Ground, clearance: f64) -> f64 {
        if ground.walls().is_empty() { 0.0 } else { self.field.obstacle_concentration(clearance.max(0.0)) }
    }

    pub(super) fn x1_at_all(&self, snapshot: &Snapshot, points: &[Point<f64>; WIDTH]) -> Lanes {
        let morphogen = self.scenario.morphogen();
        let contribution = |&target: &Point<f64>| {
            let squared = points.map(|point| (point - target).dot(point - target));
            concentration(morphogen.kernel, morphogen.target_width, Lanes(squared))
        };
        snapshot.targets.iter().map(contribution).fold(Lanes::splat(0.0), |sum, next| sum + next)
    }

    pub(super) fn x2_at_all(&self, ground: &Ground, clearance: Lanes) -> Lanes {
        if ground.walls().is_empty() {
            return Lanes::splat(0.0);
        }
        let morphogen = self.scenario.morphogen();
        let outside = Lanes(clearance.0.map(|clearance| clearance.max(0.0)));
        concentration(morphogen.kernel, morphogen.obstacle_width, outside * outside)
    }

    /// Whether an edge of the lattice cell around `point` is creased.
    pub(super) fn is_at_crease(&self, snapshot: &Snapshot, point: Point<f64>) -> bool {
        let Some(corner) = self.coarse.cell_around(point).and_then(|corners| corners.into_iter().min()) else {
            return false;
        };
        let creases = &snapshot.ground.creases;
        let [east, north] = creases[corner];
        let east_of_north = creases[self.coarse.neighbour(corner, Direction::NORTH)][0];
        east || north || east_of_north || creases[corner + 1][1]
    }

    /// Whether `point` is nearer than `distance` metres to a wall.
    pub(super) fn is_closer_than(&self, snapshot: &Snapshot, point: Point<f64>, distance: f64) -> bool {
        // Distance changes by at most a metre a metre, and the node beside is less than one lattice step away.
        let clearance = &snapshot.ground.clearance;
        let surely_clear = self.coarse.beside(point).is_some_and(|node| clearance[node] - LATTICE_STEP > distance);
        !surely_clear && snapshot.ground.clearance_at(point) < distance
    }
}

/// A morphogen that is narrower than so many steps is not shown by a lattice.
const SHOWN_STEPS: f64 = 2.0;

/// Nearer to walls than this the coarse lattice does not show x2, metres; 0 if it does everywhere.
fn blurred(morphogen: Morphogen) -> f64 {
    let reach = match morphogen.kernel {
        Kernel::Gaussian => 3.5,
        Kernel::Exponential => 6.0,
    };
    // Beyond this reach x2 is below 0.003.
    let width = morphogen.obstacle_width;
    if width < SHOWN_STEPS * LATTICE_STEP { reach * width + LATTICE_STEP } else { 0.0 }
}

impl Snapshot {
    /// The walls that are there.
    pub fn walls(&self) -> &Walls {
        self.ground.walls()
    }
}

fn x1_at(field: &Field<f64>, targets: &[Point<f64>], point: Point<f64>) -> f64 {
    targets.iter().map(|&target| field.target_concentration((point - target).length())).sum()
}
