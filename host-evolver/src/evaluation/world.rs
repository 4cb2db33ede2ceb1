//! A scenario prepared for evaluating many models: its morphogens on a lattice, which are the same for every model.

use super::fine_lattice::FineLattice;
use super::lanes::{Lanes, WIDTH, concentration};
use super::lattice::{Direction, LATTICE_STEP, Lattice, NodeIndex, Site, is_crease};
use super::terms::Terms;
use firmware_sim::scenario::Scenario;
use grn_core::field::Field;
use grn_core::geometry::{Point, Vector};
use std::sync::Arc;

/// Stands for "no wall near": every kernel is 0 there.
const FAR: f64 = 1e3;

/// A scenario at one instant.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Its place among the world's snapshots.
    pub(super) place: usize,
    /// Where the targets are, metres.
    pub targets: Vec<Point<f64>>,
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
    pub(super) lattice: Lattice,
    /// Signed distance to the nearest wall at each node, negative inside, at most [`FAR`].
    pub(super) clearance: Vec<f64>,
    /// For each node whether the edges from it to the east and to the north are creased.
    pub(super) creases: Vec<[bool; 2]>,
    /// What a pattern meets at each node.
    pub(super) sites: Vec<Site>,
    pub(super) fine: Arc<FineLattice>,
    pub(super) terms: Terms,
}

impl World {
    /// Prepares a scenario; takes a few hundredths of a second.
    pub fn new(scenario: Scenario) -> World {
        let snapshots = scenario.snapshot_targets();
        World::at(scenario, snapshots)
    }

    /// The same with other snapshots than the scenario's: where the targets are at each, metres.
    pub fn at(scenario: Scenario, snapshots: Vec<Vec<Point<f64>>>) -> World {
        let morphogen = scenario.morphogen();
        let lattice = Lattice::over(scenario.region(), LATTICE_STEP);
        let mut world = World {
            field: Field::new(morphogen.kernel, morphogen.target_width, morphogen.obstacle_width),
            snapshots: Vec::new(),
            clearance: Vec::new(),
            creases: Vec::new(),
            sites: Vec::new(),
            fine: Arc::new(FineLattice::over(scenario.region())),
            terms: Terms::of(scenario.ring()),
            lattice,
            scenario,
        };
        let points = world.lattice.nodes().map(|node| world.lattice.point(node));
        world.clearance = points.map(|point| world.clearance_at(point)).collect();
        world.creases = world.lattice.nodes().map(|node| world.creases_from(node)).collect();
        let site = |node| Site::of(&world.lattice, node, world.clearance[node]);
        world.sites = world.lattice.nodes().map(site).collect();
        let x2: Vec<f64> = world.clearance.iter().map(|&clearance| world.x2_at(clearance)).collect();
        let snapshots = snapshots.into_iter().enumerate();
        world.snapshots = snapshots.map(|(place, targets)| world.snapshot(place, targets, &x2)).collect();
        world
    }

    fn snapshot(&self, place: usize, targets: Vec<Point<f64>>, x2: &[f64]) -> Snapshot {
        let x1 = self.lattice.nodes().map(|node| x1_at(&self.field, &targets, self.lattice.point(node)));
        Snapshot {
            place,
            inputs: x1.zip(x2).map(|(x1, &x2)| [x1 as f32, x2 as f32]).collect(),
            target_inputs: targets.iter().map(|&target| inputs_at(self, &targets, target)).collect(),
            obstacle_points: self.scenario.obstacle_points(&targets),
            targets,
        }
    }

    fn creases_from(&self, node: NodeIndex) -> [bool; 2] {
        let point = self.lattice.point(node);
        [(Direction::EAST, Vector::new(0.5, 0.0)), (Direction::NORTH, Vector::new(0.0, 0.5))].map(
            |(direction, half)| {
                let Some(&end) = self.clearance.get(self.lattice.neighbour(node, direction)) else { return false };
                is_crease(self.clearance[node], self.clearance_at(point + half * LATTICE_STEP), end)
            },
        )
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
        inputs_at(self, &snapshot.targets, point)
    }

    /// The same at eight points.
    pub(super) fn inputs_at_all(&self, snapshot: &Snapshot, points: &[Point<f64>; WIDTH]) -> [Lanes; 2] {
        let clearance = points.map(|point| self.clearance_at(point));
        [self.x1_at_all(snapshot, points), self.x2_at_all(Lanes(clearance))]
    }

    pub(super) fn clearance_at(&self, point: Point<f64>) -> f64 {
        self.scenario.walls().signed_distance(point).min(FAR)
    }

    pub(super) fn x2_at(&self, clearance: f64) -> f64 {
        if self.scenario.walls().is_empty() { 0.0 } else { self.field.obstacle_concentration(clearance.max(0.0)) }
    }

    pub(super) fn x1_at_all(&self, snapshot: &Snapshot, points: &[Point<f64>; WIDTH]) -> Lanes {
        let morphogen = self.scenario.morphogen();
        let contribution = |&target: &Point<f64>| {
            let squared = points.map(|point| (point - target).dot(point - target));
            concentration(morphogen.kernel, morphogen.target_width, Lanes(squared))
        };
        snapshot.targets.iter().map(contribution).fold(Lanes::splat(0.0), |sum, next| sum + next)
    }

    pub(super) fn x2_at_all(&self, clearance: Lanes) -> Lanes {
        if self.scenario.walls().is_empty() {
            return Lanes::splat(0.0);
        }
        let morphogen = self.scenario.morphogen();
        let outside = Lanes(clearance.0.map(|clearance| clearance.max(0.0)));
        concentration(morphogen.kernel, morphogen.obstacle_width, outside * outside)
    }

    /// Whether an edge of the lattice cell around `point` is creased.
    pub(super) fn is_at_crease(&self, point: Point<f64>) -> bool {
        let Some(corner) = self.lattice.cell_around(point).and_then(|corners| corners.into_iter().min()) else {
            return false;
        };
        let [east, north] = self.creases[corner];
        let east_of_north = self.creases[self.lattice.neighbour(corner, Direction::NORTH)][0];
        east || north || east_of_north || self.creases[corner + 1][1]
    }

    /// Whether `point` is nearer than `distance` metres to a wall.
    pub(super) fn is_closer_than(&self, point: Point<f64>, distance: f64) -> bool {
        // Distance changes by at most a metre a metre, and the node beside is less than one lattice step away.
        let surely_clear =
            self.lattice.beside(point).is_some_and(|node| self.clearance[node] - LATTICE_STEP > distance);
        !surely_clear && self.clearance_at(point) < distance
    }
}

fn inputs_at(world: &World, targets: &[Point<f64>], point: Point<f64>) -> [f64; 2] {
    [x1_at(&world.field, targets, point), world.x2_at(world.clearance_at(point))]
}

fn x1_at(field: &Field<f64>, targets: &[Point<f64>], point: Point<f64>) -> f64 {
    targets.iter().map(|&target| field.target_concentration((point - target).length())).sum()
}
