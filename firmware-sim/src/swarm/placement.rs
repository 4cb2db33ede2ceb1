//! Where robots start.

use crate::body::Pose;
use crate::config::SwarmConfig;
use crate::geometry::{Walls, length_squared};
use crate::random::{Component, Stream};
use crate::scenario::{Disc, Scenario, Start};
use grn_core::geometry::Point;
use grn_core::robot::epuck2::BODY_RADIUS;
use grn_input::InputError;

/// Inner and outer radius of the ring in which robots start, in multiples of the scenario's `d_max`.
const START_RING: [f64; 2] = [0.3, 1.6];
/// The same for the places at a base station: outside the pattern, which must not form around them.
const BASE_RING: [f64; 2] = [1.6, 2.2];
/// Free space between robots at a base station, metres: one that comes home must get in between.
const BASE_CLEARANCE: f64 = 0.04;
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

/// Misses in a row after which a disc in which robots begin counts as full.
const DISC_PATIENCE: u32 = 20_000;

/// The robots of a run in `world`, which is in real metres, at the start: where the world says, else [`scattered`].
pub(super) fn starting(world: &Scenario, config: &SwarmConfig) -> Result<Vec<Pose>, InputError> {
    let count = config.lab.robots.count;
    let at_base = config.lab.base_station.sends;
    match world.start() {
        Some(Start::Within(disc)) => within(world, disc, count, at_base, config.seed).ok_or_else(|| {
            let way_out = format!(
                "{count} robots find no room between walls in this disc at scale {}; fewer robots, a larger scale or a larger radius \
                 are needed",
                config.scale
            );
            InputError::new("start.radius", format!("{:?}", disc.radius / config.scale), way_out)
        }),
        Some(Start::At(positions)) => at(world, positions, config),
        None => scattered(world, count, at_base, config.seed).ok_or_else(|| {
            let way_out = format!(
                "so many robots find no room in the region at scale {}; fewer robots, a larger scale or a larger region are needed",
                config.scale
            );
            InputError::new("robots", count, way_out)
        }),
    }
}

/// `count` robots at random places in a disc, with random headings, clear of walls and of each other; `None` when it is full before.
fn within(world: &Scenario, disc: &Disc, count: usize, at_base: bool, seed: u64) -> Option<Vec<Pose>> {
    let mut stream = Stream::new(seed, Component::Placement, 0);
    let walls = world.walls_at(0.0);
    let clearance = if at_base { BASE_CLEARANCE } else { CLEARANCE };
    let mut poses: Vec<Pose> = Vec::with_capacity(count);
    let mut misses = 0;
    while poses.len() < count {
        // Uniform by area.
        let radius = disc.radius * stream.unit().sqrt();
        let position = disc.centre + stream.direction() * radius;
        let heading = stream.direction();
        if free(world, &walls, &poses, position, clearance) {
            poses.push(Pose { position, heading });
            misses = 0;
        } else {
            misses += 1;
            if misses == DISC_PATIENCE {
                return None;
            }
        }
    }
    Some(poses)
}

/// Robots at the first of these places, with random headings.
fn at(world: &Scenario, positions: &[Point<f64>], config: &SwarmConfig) -> Result<Vec<Pose>, InputError> {
    let count = config.lab.robots.count;
    if positions.len() < count {
        let way_out = format!("the laboratory has {count} robots; a place is needed for each");
        return Err(InputError::new("start.positions", format!("{} places", positions.len()), way_out));
    }
    let mut stream = Stream::new(config.seed, Component::Placement, 0);
    let walls = world.walls_at(0.0);
    let mut poses: Vec<Pose> = Vec::with_capacity(count);
    for (place, &position) in positions.iter().take(count).enumerate() {
        if !free(world, &walls, &poses, position, 0.0) {
            let drawn = position * (1.0 / config.scale);
            let way_out = format!(
                "a robot, {} m across in the world at scale {}, does not fit here between walls and the robots before it",
                2.0 * BODY_RADIUS / config.scale,
                config.scale
            );
            let value = format!("[{:?}, {:?}]", drawn.x, drawn.y);
            return Err(InputError::new(format!("start.positions[{place}]"), value, way_out));
        }
        poses.push(Pose { position, heading: stream.direction() });
    }
    Ok(poses)
}

/// `count` robots at random places, with random headings, behind the first target's start: in the half of a ring around it
/// that lies against its way, so that the swarm has yet to go around it; inside the region, clear of walls and of each
/// other. The ring grows when they do not fit, and closes when the half plane is full. `None` when even the whole region,
/// at random, has no room. Those at a base station stand farther from the target, with no wall in between, and from each other.
fn scattered(world: &Scenario, count: usize, at_base: bool, seed: u64) -> Option<Vec<Pose>> {
    let mut stream = Stream::new(seed, Component::Placement, 0);
    let first = world.targets().iter().find(|target| target.presence().holds(0.0))?;
    let centre = first.path().at(0.0);
    let way = first.path().at(FIRST_STRETCH) - centre;
    let walls = world.walls_at(0.0);
    let (ring, clearance) = if at_base { (BASE_RING, BASE_CLEARANCE) } else { (START_RING, CLEARANCE) };
    let [inner, start_outer] = ring.map(|share| share * world.ring().d_max);
    let mut outer = start_outer;
    let region = world.region();
    let region_reach = 2.0 * (region[0] + region[1] + centre.length());
    let mut poses: Vec<Pose> = Vec::with_capacity(count);
    let mut misses = 0;
    let mut only_behind = true;
    while poses.len() < count {
        let (radius, bearing) = stream.in_ring([inner, outer]);
        let behind = if only_behind && bearing.dot(way) > 0.0 { -bearing } else { bearing };
        let position = centre + behind * radius;
        let heading = stream.direction();
        let walled_off = || at_base && walls.ray(centre, behind, radius).is_some();
        if free(world, &walls, &poses, position, clearance) && !walled_off() {
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
                outer = start_outer;
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
        let (way, heading) = (stream.direction(), stream.direction());
        let distance = least + stream.unit() * (most - least);
        let position = from.position + way * distance;
        if free(world, walls, poses, position, CLEARANCE) && walls.ray(from.position, way, distance).is_none() {
            return Pose { position, heading };
        }
    }
    Pose { heading: stream.direction(), ..from }
}

fn free(world: &Scenario, walls: &Walls, poses: &[Pose], position: Point<f64>, clearance: f64) -> bool {
    let apart = 2.0 * BODY_RADIUS + clearance;
    let [east, north] = world.region();
    (0.0..=east).contains(&position.x)
        && (0.0..=north).contains(&position.y)
        && poses.iter().all(|pose| length_squared(pose.position - position) >= apart * apart)
        && walls.signed_distance(position) >= BODY_RADIUS + CLEARANCE
}
