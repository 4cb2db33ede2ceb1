//! What a scenario may hold at most: as much as can be judged and simulated in reasonable memory and time.

use super::{Morphogen, OBSTACLE_SPACING, Ring, Scenario};
use grn_input::{InputError, Range};

/// The most targets a scenario may have. Robots know the nearest [`MAX_TARGETS`](grn_core::robot::percept::MAX_TARGETS) of them.
pub const MOST_TARGETS: usize = 10;
/// The most snapshots a scenario may ask for.
pub const MAX_SNAPSHOTS: usize = 10_000;
/// The most points of a path or polygon: whether a polygon crosses itself is found by comparing all pairs of its edges,
/// here half a million.
pub const MAX_POINTS: usize = 1000;
/// The most points of all walls together: each of a swarm's senses and each node of a lattice asks for the nearest edge.
pub const MAX_WALL_POINTS: usize = 20_000;

/// Spacing of the lattice on which patterns are judged, and its margin around the region, metres.
pub const LATTICE: [f64; 2] = [0.2, 5.0];
/// The most nodes of that lattice: 130 MB for what is known of each and of the 16 of a finer lattice in its place.
const MAX_NODES: f64 = (1 << 22) as f64;
/// The most nodes times snapshots: 8 bytes each, so 160 MB; a model is judged in about a tenth of a second.
const MAX_NODE_SNAPSHOTS: f64 = 2e7;
/// The same if walls change, so that what is known of them is kept for every snapshot: 43 bytes each.
const MAX_CHANGING_NODE_SNAPSHOTS: f64 = MAX_NODE_SNAPSHOTS / 5.0;
/// The most samples of the walls' outlines, and the most of them times snapshots: 16 bytes each, so 70 MB.
const MAX_SAMPLES: f64 = 20_000.0;
const MAX_SAMPLE_SNAPSHOTS: f64 = (1 << 22) as f64;
/// The most entries of the table of a term of the objective: 16 bytes each, so 17 MB.
const MAX_TABLE: f64 = (1 << 20) as f64;

/// Sides of the region. Fewer metres hold no robot; more cannot be told in messages even at the smallest scale, 0.01.
pub const REGION: Range<f64> = Range::new(0.5, 3000.0, "metres");
/// How far walls may stick out of the region.
pub const WALL_OVERHANG: f64 = 100.0;
/// Radii of discs.
pub const DISC_RADIUS: Range<f64> = Range::new(0.01, 100.0, "metres (not centimetres)");
/// How long a run may take, if the scenario says it.
pub const DURATION: Range<f64> = Range::new(0.1, 3_600_000.0, "seconds");
/// What a blob can hold.
pub const WIDTH: Range<f64> = Range::new(0.01, 100.0, "metres (not centimetres)");
/// What a blob can hold.
pub const LEVEL: Range<f64> = Range::new(0.01, 0.99, "(a share of the range from M(0,0) to M(1,0))");
/// Distances of the ring.
pub const DISTANCE: Range<f64> = Range::new(0.0, 100.0, "metres (not centimetres)");
/// Below, a step is wider than the longest distances that matter, 20 steps of 2 m; above, it is a millimetre.
pub const STEEPNESS: Range<f64> = Range::new(0.5, 1000.0, "per metre");

/// Entries of the table of a sigmoid over squared distances: as `Profile` of the objective makes it.
fn table_entries(distance: f64, steepness: f64) -> f64 {
    let reach = distance + 20.0 / steepness;
    reach * reach * (10.0 * steepness).max(100.0)
}

fn lattice_nodes(region: [f64; 2]) -> f64 {
    region.iter().map(|side| (side + 2.0 * LATTICE[1]) / LATTICE[0] + 9.0).product()
}

/// Whether walls that change can be kept for every snapshot.
pub(super) fn check_changing_walls(world: &Scenario) -> Result<(), InputError> {
    let most = (MAX_CHANGING_NODE_SNAPSHOTS / lattice_nodes(world.region())).floor();
    if !world.walls_change() || world.snapshots() as f64 <= most {
        return Ok(());
    }
    let expected = format!("with walls that move, come or go at most {most} fit into memory, or a smaller region");
    Err(InputError::new("snapshots", world.snapshots(), expected))
}

pub(super) fn check_region(region: [f64; 2], snapshots: i64) -> Result<usize, InputError> {
    for (index, side) in region.into_iter().enumerate() {
        REGION.check(&format!("region[{index}]"), side)?;
    }
    let nodes = lattice_nodes(region);
    let show = format!("[{:?}, {:?}]", region[0], region[1]);
    if nodes > MAX_NODES {
        let expected =
            format!("{nodes:.1e} lattice nodes, 0.2 m apart, are more than {MAX_NODES:.1e}; make it smaller");
        return Err(InputError::new("region", show, expected));
    }
    let range = Range::new(1, MAX_SNAPSHOTS as i64, "(a whole one)");
    let count = range.check("snapshots", snapshots)? as f64;
    if nodes * count > MAX_NODE_SNAPSHOTS {
        let most = (MAX_NODE_SNAPSHOTS / nodes).floor();
        let expected =
            format!("too many for a region of {show} metres; at most {most} fit into memory, or a smaller region");
        return Err(InputError::new("snapshots", snapshots, expected));
    }
    Ok(snapshots as usize)
}

pub(super) fn check_morphogen(morphogen: &Morphogen) -> Result<(), InputError> {
    WIDTH.check("morphogen.target_width", morphogen.target_width)?;
    WIDTH.check("morphogen.obstacle_width", morphogen.obstacle_width)?;
    LEVEL.check("morphogen.level", morphogen.level)?;
    Ok(())
}

pub(super) fn check_ring(ring: &Ring, region: [f64; 2]) -> Result<(), InputError> {
    let Ring { d_min, d_max, d_obstacle, steepness } = *ring;
    DISTANCE.check("ring.d_min", d_min)?;
    DISTANCE.check("ring.d_max", d_max)?;
    DISTANCE.check("ring.d_obstacle", d_obstacle)?;
    STEEPNESS.check("ring.steepness", steepness)?;
    if d_max < d_min + 0.01 {
        return Err(InputError::new(
            "ring.d_max",
            format!("{d_max:?}"),
            format!("must be above d_min = {d_min:?} by a centimetre or more"),
        ));
    }
    let longest = region[0].max(region[1]);
    if d_max > longest {
        let expected =
            format!("a ring of this radius does not fit the region, whose longer side is {longest:?} metres");
        return Err(InputError::new("ring.d_max", format!("{d_max:?}"), expected));
    }
    let farthest = d_max.max(d_obstacle);
    if table_entries(farthest, steepness) > MAX_TABLE {
        let or_gentler = if steepness > 10.0 { ", or this smaller" } else { "" };
        let expected = format!(
            "with distances up to {farthest:?} metres a table of {:.1e} entries is needed, of at most {MAX_TABLE:.1e}; \
             make the ring's distances shorter{or_gentler}",
            table_entries(farthest, steepness)
        );
        return Err(InputError::new("ring.steepness", format!("{steepness:?}"), expected));
    }
    Ok(())
}

/// Outlines in metres of arc length, of all walls, and of the last one read.
pub(super) fn check_outline(key: &str, total: f64, points: usize, snapshots: usize) -> Result<(), InputError> {
    if points > MAX_WALL_POINTS {
        let expected = format!("with this one the walls have more than {MAX_WALL_POINTS} points; simplify them");
        return Err(InputError::new(key, format!("{points} points"), expected));
    }
    let most = MAX_SAMPLES.min(MAX_SAMPLE_SNAPSHOTS / snapshots as f64);
    if total / OBSTACLE_SPACING > most {
        let expected = format!(
            "with this one the walls' outlines are {total:.0} metres long, and at most {:.0} can be judged at {snapshots} \
             snapshots; shorten them",
            most * OBSTACLE_SPACING
        );
        return Err(InputError::new(key, "", expected));
    }
    Ok(())
}
