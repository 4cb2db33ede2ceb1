//! Robots that run into each other, into walls or into targets with a body: pushed apart, and counted.

use crate::body::Pose;
use crate::geometry::{Edge, Walls, length_squared};
use crate::grid::WallIndex;
use grn_core::geometry::{Point, Vector};
use grn_core::robot::epuck2::BODY_RADIUS;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A contact ends when the gap has grown beyond this, metres: bodies that tremble at touching distance have one contact, not many.
pub const RELEASE_GAP: f64 = 0.001;
/// How often overlaps are resolved per tick; a push may cause the next overlap.
const PASSES: usize = 4;
/// How far apart bodies and walls may be and still be looked at in every pass, metres: more than pushes amount to in a tick. A
/// wall's index reaches as far.
const PUSHES: f64 = 0.03;

/// What touched in one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ContactCounts {
    /// Pairs of robots that began to touch.
    pub peer_events: u32,
    /// Robots that began to touch walls or targets.
    pub wall_events: u32,
    /// Pairs of robots in contact.
    pub peers: u32,
    /// Robots in contact with walls or targets.
    pub walls: u32,
}

impl ContactCounts {
    /// These, and the events of those before them.
    #[must_use]
    pub fn after(self, before: ContactCounts) -> ContactCounts {
        let peer_events = before.peer_events.saturating_add(self.peer_events);
        ContactCounts { peer_events, wall_events: before.wall_events.saturating_add(self.wall_events), ..self }
    }
}

/// What stands in robots' way besides robots.
#[derive(Clone, Copy, Debug)]
pub struct Solid<'a> {
    /// Walls.
    pub walls: &'a Walls,
    /// Where their edges are.
    pub index: &'a WallIndex,
    /// Targets, of which those that are there count.
    pub targets: &'a [Option<Point<f64>>],
    /// Radius of a target's body, metres; 0 for a target that is only a place.
    pub target_radius: f64,
}

impl Solid<'_> {
    /// Whether a robot at `position` can be pushed by something in this tick.
    fn is_near(&self, position: Point<f64>) -> bool {
        self.index.near(position).next().is_some() || self.targets_within(PUSHES, position).next().is_some()
    }

    /// The targets with a body that a robot at `position` is nearer to than `gap` metres.
    fn targets_within(&self, gap: f64, position: Point<f64>) -> impl Iterator<Item = Point<f64>> {
        let reach = self.target_radius + BODY_RADIUS + gap;
        let solid = self.targets.iter().flatten().copied().filter(|_| self.target_radius > 0.0);
        solid.filter(move |&target| length_squared(position - target) < reach * reach)
    }
}

/// Who touches whom.
#[derive(Debug)]
pub struct Contacts {
    /// Pairs in contact.
    touching: BTreeSet<(u16, u16)>,
    at_wall: Vec<bool>,
    /// Pairs that can overlap in this tick.
    close: Vec<(u16, u16)>,
    /// Robots that can overlap a wall in this tick.
    walled: Vec<u16>,
}

impl Contacts {
    /// No contacts among this many robots.
    pub fn new(robots: usize) -> Self {
        Contacts { touching: BTreeSet::new(), at_wall: vec![false; robots], close: Vec::new(), walled: Vec::new() }
    }

    /// Pushes overlapping bodies apart, and out of walls and targets, and counts. `near` holds every pair that can overlap; of these and
    /// of walls, those farther away than pushes reach are looked at once.
    pub fn resolve(&mut self, poses: &mut [Pose], near: &[(u16, u16)], solid: &Solid<'_>) -> ContactCounts {
        let mut counts = ContactCounts::default();
        let reach = 2.0 * BODY_RADIUS + PUSHES;
        let distance_squared =
            |&&(a, b): &&(u16, u16)| length_squared(poses[usize::from(b)].position - poses[usize::from(a)].position);
        self.close.clear();
        self.close.extend(near.iter().filter(|pair| distance_squared(pair) < reach * reach));
        self.walled.clear();
        self.walled.extend((0..).zip(&*poses).filter(|(_, pose)| solid.is_near(pose.position)).map(|(robot, _)| robot));
        for _ in 0..PASSES {
            let mut moved = false;
            for &(a, b) in &self.close {
                let (i, j) = (usize::from(a), usize::from(b));
                let offset = poses[j].position - poses[i].position;
                let squared = length_squared(offset);
                if squared >= 4.0 * BODY_RADIUS * BODY_RADIUS {
                    continue;
                }
                moved = true;
                let distance = squared.sqrt();
                let direction = if distance > 0.0 { offset * (1.0 / distance) } else { Vector::new(1.0, 0.0) };
                let push = direction * (BODY_RADIUS - distance / 2.0);
                poses[i].position = poses[i].position - push;
                poses[j].position = poses[j].position + push;
                counts.peer_events += u32::from(self.touching.insert((a, b)));
            }
            for robot in self.walled.iter().map(|&robot| usize::from(robot)) {
                if push_out(&mut poses[robot], solid) {
                    moved = true;
                    counts.wall_events += u32::from(!self.at_wall[robot]);
                    self.at_wall[robot] = true;
                }
            }
            if !moved {
                break;
            }
        }
        self.release(poses, solid);
        counts.peers = self.touching.len() as u32;
        counts.walls = self.at_wall.iter().map(|&touches| u32::from(touches)).sum();
        counts
    }

    /// Forgets contacts whose gap has opened.
    fn release(&mut self, poses: &[Pose], solid: &Solid<'_>) {
        let Contacts { touching, at_wall, .. } = self;
        let limit = (2.0 * BODY_RADIUS + RELEASE_GAP) * (2.0 * BODY_RADIUS + RELEASE_GAP);
        touching.retain(|&(a, b)| {
            let offset = poses[usize::from(b)].position - poses[usize::from(a)].position;
            length_squared(offset) <= limit
        });
        let limit = (BODY_RADIUS + RELEASE_GAP) * (BODY_RADIUS + RELEASE_GAP);
        for (pose, at_wall) in poses.iter().zip(at_wall).filter(|(_, at_wall)| **at_wall) {
            let p = pose.position;
            let at_edge = |edge: &Edge| length_squared(edge.nearest(p) - p) <= limit;
            *at_wall = solid.index.near(p).any(at_edge) || solid.targets_within(RELEASE_GAP, p).next().is_some();
        }
    }
}

/// Moves a body that overlaps a wall or a target out of it; false if it overlaps none.
fn push_out(pose: &mut Pose, solid: &Solid<'_>) -> bool {
    let Solid { walls, index, target_radius, .. } = *solid;
    let mut pushed = false;
    for target in solid.targets_within(0.0, pose.position) {
        let outwards = (pose.position - target).direction().unwrap_or(Vector::new(1.0, 0.0));
        pose.position = target + outwards * (target_radius + BODY_RADIUS);
        pushed = true;
    }
    for edge in index.near(pose.position) {
        let boundary = edge.nearest(pose.position);
        let offset = pose.position - boundary;
        let squared = length_squared(offset);
        if squared >= BODY_RADIUS * BODY_RADIUS {
            continue;
        }
        let distance = squared.sqrt();
        let inside = walls.containing(pose.position).is_some();
        let outwards = match distance > 0.0 {
            true if inside => offset * (-1.0 / distance),
            true => offset * (1.0 / distance),
            // Exactly on the edge: of its two sides, the one outside.
            false => {
                let along = (edge.end() - edge.start()).direction().unwrap_or(Vector::ZERO);
                let left = along.turned_left();
                if walls.containing(boundary + left * BODY_RADIUS).is_some() { -left } else { left }
            }
        };
        pose.position = boundary + outwards * BODY_RADIUS;
        pushed = true;
    }
    pushed || dug_out(pose, walls)
}

/// Moves a body that a wall has come down upon, so that it lies deep inside, to the nearest place outside that wall. No fixed wall
/// lets a body in so deep.
fn dug_out(pose: &mut Pose, walls: &Walls) -> bool {
    let Some(wall) = walls.moving().iter().find(|wall| wall.contains(pose.position)) else { return false };
    let (boundary, _) = wall.nearest_boundary(pose.position);
    let Some(outwards) = (boundary - pose.position).direction() else { return false };
    pose.position = boundary + outwards * BODY_RADIUS;
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polygon;

    fn pose(x: f64, y: f64) -> Pose {
        Pose { position: Vector::new(x, y), heading: Vector::new(1.0, 0.0) }
    }

    fn open() -> (Walls, WallIndex) {
        (Walls::default(), WallIndex::new(&Walls::default(), 0.1))
    }

    fn among<'a>(walls: &'a Walls, index: &'a WallIndex) -> Solid<'a> {
        Solid { walls, index, targets: &[], target_radius: 0.0 }
    }

    #[test]
    fn a_target_with_a_body_holds_and_is_counted() {
        let (walls, index) = open();
        let targets = [Some(Vector::new(0.0, 0.0)), None];
        let solid = Solid { targets: &targets, target_radius: 0.05, ..among(&walls, &index) };
        let mut contacts = Contacts::new(3);
        let mut poses = [pose(0.03, 0.04), pose(0.0, 0.0), pose(0.2, 0.0)];
        let counts = contacts.resolve(&mut poses, &[], &solid);
        assert_eq!((counts.wall_events, counts.walls, counts.peers), (2, 2, 0));
        assert!((poses[0].position - Vector::new(0.051, 0.068)).length() < 1e-12, "pushed straight outwards");
        assert!((poses[1].position.length() - 0.085).abs() < 1e-12 && poses[2] == pose(0.2, 0.0));
        let counts = contacts.resolve(&mut poses, &[], &solid);
        assert_eq!((counts.wall_events, counts.walls), (0, 2), "they still touch");
        poses[0] = pose(0.1, 0.1);
        assert_eq!(contacts.resolve(&mut poses, &[], &solid).walls, 1);
        let places = Solid { target_radius: 0.0, ..solid };
        let mut free = [pose(0.0, 0.0)];
        assert_eq!(Contacts::new(1).resolve(&mut free, &[], &places), ContactCounts::default());
    }

    #[test]
    fn overlapping_robots_part_equally() {
        let (walls, index) = open();
        let mut contacts = Contacts::new(2);
        let mut poses = [pose(0.0, 0.0), pose(0.05, 0.0)];
        let counts = contacts.resolve(&mut poses, &[(0, 1)], &among(&walls, &index));
        assert_eq!((counts.peer_events, counts.peers, counts.wall_events), (1, 1, 0));
        assert!((poses[0].position.x + 0.01).abs() < 1e-12 && (poses[1].position.x - 0.06).abs() < 1e-12);
        let mut same = [pose(1.0, 1.0), pose(1.0, 1.0)];
        contacts.resolve(&mut same, &[(0, 1)], &among(&walls, &index));
        assert!(((same[1].position - same[0].position).length() - 0.07).abs() < 1e-12);
    }

    #[test]
    fn a_contact_is_counted_once_until_released() {
        let (walls, index) = open();
        let mut contacts = Contacts::new(2);
        let mut events = Vec::new();
        // Overlap, tremble within the release gap, overlap, part, overlap.
        for gap in [-0.002, 0.0005, -0.001, 0.0005, 0.002, -0.001] {
            let mut poses = [pose(0.0, 0.0), pose(2.0 * BODY_RADIUS + gap, 0.0)];
            let counts = contacts.resolve(&mut poses, &[(0, 1)], &among(&walls, &index));
            events.push((counts.peer_events, counts.peers));
        }
        assert_eq!(events, [(1, 1), (0, 1), (0, 1), (0, 1), (0, 0), (1, 1)]);
    }

    #[test]
    fn walls_hold_and_are_counted() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Vector::new(x, y));
        let walls = Walls::new(vec![Polygon::new(square.to_vec()).unwrap()]);
        let index = WallIndex::new(&walls, 0.1);
        let mut contacts = Contacts::new(5);
        // Beside an edge, just inside it, on it, over a corner, and clear of it.
        let mut poses = [pose(0.5, -0.03), pose(0.5, 0.01), pose(1.0, 0.5), pose(1.02, 1.02), pose(-0.1, 0.5)];
        let counts = contacts.resolve(&mut poses, &[], &among(&walls, &index));
        assert_eq!((counts.wall_events, counts.walls), (4, 4));
        for (pose, (x, y)) in poses.iter().zip([(0.5, -0.035), (0.5, -0.035), (1.035, 0.5)]) {
            assert!((pose.position - Vector::new(x, y)).length() < 1e-12, "{pose:?}");
        }
        assert!(poses.iter().all(|p| walls.signed_distance(p.position) >= BODY_RADIUS - 1e-12));
        let counts = contacts.resolve(&mut poses, &[], &among(&walls, &index));
        assert_eq!((counts.wall_events, counts.walls), (0, 4));
        poses[0] = pose(0.5, -0.1);
        assert_eq!(contacts.resolve(&mut poses, &[], &among(&walls, &index)).walls, 3);
    }

    #[test]
    fn a_robot_pushed_against_a_wall_does_not_enter_it() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Vector::new(x, y));
        let walls = Walls::new(vec![Polygon::new(square.to_vec()).unwrap()]);
        let index = WallIndex::new(&walls, 0.1);
        let mut poses = [pose(0.5, -0.036), pose(0.5, -0.1)];
        let counts = Contacts::new(2).resolve(&mut poses, &[(0, 1)], &among(&walls, &index));
        assert_eq!((counts.peer_events, counts.wall_events), (1, 1));
        assert!(poses[0].position.y <= -BODY_RADIUS + 1e-12);
        assert!((poses[1].position - poses[0].position).length() > 0.0695);
    }
}
