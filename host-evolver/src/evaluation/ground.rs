//! What is known of the walls on the lattices: the same for every model, and for every snapshot with the same walls.

use super::fine_lattice::{Run, no_runs};
use super::hidden::{Beside, hidden_from};
use super::lattice::{Direction, LATTICE_STEP, Lattice, NodeIndex, Site, is_crease};
use firmware_sim::geometry::Walls;
use grn_core::geometry::{Point, Vector};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Stands for "no wall near": every kernel is 0 there.
const FAR: f64 = 1e3;

/// Walls, and what a pattern meets of them.
#[derive(Debug)]
pub(super) struct Ground {
    walls: Walls,
    /// Signed distance to the nearest wall at each node, negative inside, at most [`FAR`].
    pub clearance: Vec<f64>,
    /// For each node whether the edges from it to the east and to the north are creased.
    pub creases: Vec<[bool; 2]>,
    /// What a pattern meets at each node.
    pub sites: Vec<Site>,
    /// What the coarse lattice does not show of the walls.
    hidden: BTreeMap<NodeIndex, Beside>,
    /// Nearer to walls than this x2 changes too fast for the coarse lattice, metres; 0 if nowhere.
    pub blurred: f64,
    /// What is known on the fine lattice so far.
    pub runs: Vec<OnceLock<Box<Run>>>,
    /// How many snapshots have these walls.
    pub snapshots: usize,
}

impl Ground {
    /// Among these walls, which are there at so many snapshots.
    pub fn new(walls: Walls, lattice: &Lattice, fine: &Lattice, snapshots: usize, blurred: f64) -> Ground {
        let (clearance, creases, sites, hidden) = (Vec::new(), Vec::new(), Vec::new(), BTreeMap::new());
        let mut ground = Ground { walls, clearance, creases, sites, hidden, blurred, runs: no_runs(fine), snapshots };
        ground.clearance = lattice.nodes().map(|node| ground.clearance_at(lattice.point(node))).collect();
        ground.creases = lattice.nodes().map(|node| ground.creases_from(lattice, node)).collect();
        ground.hidden = hidden_from(&ground.walls, lattice, &ground.clearance);
        let is_beside = |node| ground.clearance[node] < blurred || ground.hidden.contains_key(&node);
        let site = |node| Site::of(lattice, node, ground.clearance[node], is_beside(node));
        ground.sites = lattice.nodes().map(site).collect();
        ground
    }

    fn creases_from(&self, lattice: &Lattice, node: NodeIndex) -> [bool; 2] {
        let point = lattice.point(node);
        [(Direction::EAST, Vector::new(0.5, 0.0)), (Direction::NORTH, Vector::new(0.0, 0.5))].map(
            |(direction, half)| {
                let Some(&end) = self.clearance.get(lattice.neighbour(node, direction)) else { return false };
                is_crease(self.clearance[node], self.clearance_at(point + half * LATTICE_STEP), end)
            },
        )
    }

    /// What the coarse lattice does not show beside a node.
    pub fn beside(&self, node: NodeIndex) -> Option<&Beside> {
        self.hidden.get(&node)
    }

    /// The walls.
    pub fn walls(&self) -> &Walls {
        &self.walls
    }

    /// Signed distance to the nearest wall, metres, negative inside, at most [`FAR`].
    pub fn clearance_at(&self, point: Point<f64>) -> f64 {
        self.walls.signed_distance(point).min(FAR)
    }
}
