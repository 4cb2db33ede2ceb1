//! Where robots start.

use crate::body::Pose;
use crate::geometry::{Walls, length_squared};
use crate::random::{Component, Stream};
use crate::scenario::Scenario;
use core::f64::consts::TAU;
use grn_core::geometry::{Point, Vector};
use grn_core::robot::epuck2::BODY_RADIUS;

/// Inner and outer radius of the ring in which robots start, in multiples of the scenario's `d_max`.
const START_RING: [f64; 2] = [0.3, 1.6];
/// The share of its path by which a target shows which way it goes.
const FIRST_STRETCH: f64 = 1e-3;
/// Free space between bodies and around walls at the start, metres.
const CLEARANCE: f64 = 0.005;
/// How far a robot is carried, in multiples of the scenario's `d_max`.
const CARRIED: [f64; 2] = [0.5, 1.5];
/// Places that are tried for it.
const CARRIED_TRIES: u32 = 1000;
/// Misses in a row after which the ring is made a tenth wider.
const PATIENCE: u32 = 200;

/// `count` robots at random places, with random headings, behind the first target's start: in the half of a ring around it
/// that lies against its way, so that the swarm has yet to go around it; inside the region, clear of walls and of each
/// other. The ring grows when they do not fit, and closes when the half plane is full. `None` when even the whole region,
/// at random, has no room.
pub(super) fn scattered(world: &Scenario, count: usize, seed: u64) -> Option<Vec<Pose>> {
    let mut stream = Stream::new(seed, Component::Placement, 0);
    let first = world.targets().iter().find(|target| target.presence().holds(0.0))?;
    let centre = first.path().at(0.0);
    let way = first.path().at(FIRST_STRETCH) - centre;
    let walls = world.walls_at(0.0);
    let [inner, mut outer] = START_RING.map(|share| share * world.ring().d_max);
    let region = world.region();
    let region_reach = 2.0 * (region[0] + region[1] + centre.length());
    let mut poses: Vec<Pose> = Vec::with_capacity(count);
    let mut misses = 0;
    let mut only_behind = true;
    while poses.len() < count {
        // Uniform by area.
        let radius = (inner * inner + stream.unit() * (outer * outer - inner * inner)).sqrt();
        let bearing = turned(stream.unit());
        let behind = if only_behind && bearing.dot(way) > 0.0 { -bearing } else { bearing };
        let position = centre + behind * radius;
        let heading = turned(stream.unit());
        if free(world, &walls, &poses, position) {
            poses.push(Pose { position, heading });
            misses = 0;
            continue;
        }
        misses += 1;
        if misses == PATIENCE {
            misses = 0;
            outer *= 1.1;
            if outer > region_reach {
                if !only_behind {
                    return None;
                }
                only_behind = false;
                outer = START_RING[1] * world.ring().d_max;
            }
        }
    }
    Some(poses)
}

/// Where a robot is set down that is carried away: [`CARRIED`] off, without a wall in between, turned anyhow; where it was, if
/// there is no room.
pub(super) fn carried(world: &Scenario, walls: &Walls, poses: &[Pose], from: Pose, stream: &mut Stream) -> Pose {
    let [least, most] = CARRIED.map(|share| share * world.ring().d_max);
    for _ in 0..CARRIED_TRIES {
        let (way, heading) = (turned(stream.unit()), turned(stream.unit()));
        let distance = least + stream.unit() * (most - least);
        let position = from.position + way * distance;
        if free(world, walls, poses, position) && walls.ray(from.position, way, distance).is_none() {
            return Pose { position, heading };
        }
    }
    Pose { heading: turned(stream.unit()), ..from }
}

/// The unit vector after this share of a whole turn.
fn turned(share: f64) -> Vector<f64> {
    let (sin, cos) = libm::sincos(share * TAU);
    Vector::new(cos, sin)
}

fn free(world: &Scenario, walls: &Walls, poses: &[Pose], position: Point<f64>) -> bool {
    let apart = 2.0 * BODY_RADIUS + CLEARANCE;
    let [east, north] = world.region();
    (0.0..=east).contains(&position.x)
        && (0.0..=north).contains(&position.y)
        && poses.iter().all(|pose| length_squared(pose.position - position) >= apart * apart)
        && walls.signed_distance(position) >= BODY_RADIUS + CLEARANCE
}
