//! What a recorded run is worth: encirclement, distance from the pattern, contacts, clearance and spacing.

mod whereabouts;

use crate::geometry::{Walls, length_squared};
use crate::trace::{RobotState, Trace, metres};
use core::f64::consts::{PI, TAU};
use grn_core::geometry::Point;
use serde::{Deserialize, Serialize};
use whereabouts::Whereabouts;
pub use whereabouts::{LEFT_AFTER_S, NEAR_TARGET, ON_PATTERN};

/// A target is encircled while every gap between neighbouring robots' bearings about it is below this, degrees.
pub const MAX_GAP_DEG: f64 = 90.0;
/// The swarm has formed once every target stays encircled for this long, seconds.
pub const FORMED_FOR_S: f64 = 2.0;

/// What metrics need to know besides the trace.
#[derive(Clone, Debug)]
pub struct MetricsOptions<'a> {
    /// Walls, in real metres, as the trace is.
    pub walls: &'a Walls,
    /// Radius of the pattern around a lone target in free space, real metres.
    pub ring_radius_m: f64,
    /// For every robot the tick from which on it is broken down, if it is, as from
    /// [`SwarmConfig::stop_ticks`](crate::config::SwarmConfig::stop_ticks); robots beyond the list's end never are. A
    /// broken robot counts only as something that others may touch.
    pub stop_ticks: &'a [Option<u64>],
}

/// The measures of one run. "After forming" is from [`formed_at_s`](Metrics::formed_at_s) to the end; what needs a
/// formed swarm is `None` without one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// How long the run was, seconds.
    pub duration_s: f64,
    /// The first time from which every target stayed encircled for at least [`FORMED_FOR_S`]; seconds from the start.
    pub formed_at_s: Option<f64>,
    /// Share of the moments after forming in which every target was encircled.
    pub encircled_share: Option<f64>,
    /// The same for every target by itself.
    pub encircled_share_by_target: Option<Vec<f64>>,
    /// Share of all moments of the run in which every target was encircled.
    pub encircled_share_of_run: f64,
    /// The largest angular gap about any target after forming, degrees.
    pub largest_gap_deg: Option<f64>,
    /// Median distance of robots from the pattern over robots and moments after forming, metres; an unknown distance is
    /// longer than any other, and `None` if it is the median.
    pub radial_error_median_m: Option<f64>,
    /// Its 95th percentile, likewise.
    pub radial_error_p95_m: Option<f64>,
    /// Share of robots and moments after forming for which the distance from the pattern is unknown.
    pub radial_error_unknown_share: Option<f64>,
    /// Robots that are off the pattern (see [`ON_PATTERN`]) at the end of the run, for [`LEFT_AFTER_S`] already or since the
    /// start.
    pub lost_robots: usize,
    /// Robots that were off the pattern for [`LEFT_AFTER_S`] after they had reached it, and came back.
    pub strayed_robots: usize,
    /// How often a robot began to touch a wall.
    pub wall_contacts: u64,
    /// How often a pair of robots began to touch.
    pub peer_contacts: u64,
    /// Time in contact with walls, summed over robots, seconds.
    pub wall_contact_s: f64,
    /// Time in contact, summed over pairs of robots, seconds.
    pub peer_contact_s: f64,
    /// The least distance between a robot's centre and a wall over the whole run, metres; `None` without walls.
    pub min_wall_clearance_m: Option<f64>,
    /// Evenness of spacing after forming, 0 to 1, averaged over targets and moments: the entropy of the angular gaps
    /// between the robots nearest to a target, as a share of that of equal gaps. `None` too when no target has two.
    pub spacing_evenness: Option<f64>,
}

/// The largest gap between neighbouring bearings of `robots` about `target`, radians in (0, 2π]; 2π with fewer than two
/// distinct bearings. Robots exactly at the target have no bearing. `bearings` is working space.
///
/// A gap below π is the same as the target lying strictly inside the robots' convex hull.
pub fn largest_gap(target: Point<f64>, robots: impl IntoIterator<Item = Point<f64>>, bearings: &mut Vec<f64>) -> f64 {
    collect_bearings(target, robots, bearings);
    gaps(bearings).fold(0.0, f64::max)
}

fn collect_bearings(target: Point<f64>, robots: impl IntoIterator<Item = Point<f64>>, bearings: &mut Vec<f64>) {
    bearings.clear();
    let offsets = robots.into_iter().map(|robot| robot - target).filter(|&offset| length_squared(offset) > 0.0);
    bearings.extend(offsets.map(|offset| libm::atan2(offset.y, offset.x)));
    bearings.sort_unstable_by(f64::total_cmp);
}

/// The gaps between sorted bearings, around the whole turn; without bearings, one whole turn.
fn gaps(bearings: &[f64]) -> impl Iterator<Item = f64> + '_ {
    let wrap = match (bearings.first(), bearings.last()) {
        (Some(first), Some(last)) => first + TAU - last,
        _ => TAU,
    };
    bearings.windows(2).map(|pair| pair[1] - pair[0]).chain([wrap])
}

/// Entropy of the gaps over that of equal ones, in [0, 1]; `None` with fewer than two bearings.
fn evenness(bearings: &[f64]) -> Option<f64> {
    if bearings.len() < 2 {
        return None;
    }
    let shares = gaps(bearings).map(|gap| gap / TAU).filter(|&share| share > 0.0);
    let entropy: f64 = shares.map(|share| -share * libm::log(share)).sum();
    Some((entropy / libm::log(bearings.len() as f64)).clamp(0.0, 1.0))
}

/// Is the largest gap, radians, small enough to encircle? Exactly 90° is not; positions are rounded to micrometres, so
/// rounding errors of an angle do not count.
pub fn encircles(largest_gap: f64) -> bool {
    largest_gap < MAX_GAP_DEG * PI / 180.0 - 1e-9
}

impl Metrics {
    /// Measures a run. `pattern_distance` gives the distance (metres) of a position from the pattern that belongs to these
    /// targets' positions, or `None` where it is not known.
    pub fn of(
        trace: &Trace,
        options: &MetricsOptions<'_>,
        mut pattern_distance: impl FnMut(Point<f64>, &[Point<f64>]) -> Option<f64>,
    ) -> Metrics {
        let per_second = f64::from(trace.header().ticks_per_second.max(1));
        let targets = usize::from(trace.header().targets);
        let gaps = gap_table(trace, options);
        let all = |frame: &&[f64]| frame.iter().all(|&gap| encircles(gap));
        let moments = || gaps.chunks_exact(targets.max(1));
        let needed = (FORMED_FOR_S * per_second).ceil() as usize;
        let formed = formed_at(moments().map(|frame| all(&frame)), needed);
        let whole_run = share(moments().filter(all).count(), trace.len());

        let after = formed.unwrap_or(trace.len());
        let mut errors = Errors::default();
        let mut evenness = Mean::default();
        let mut robots = vec![Whereabouts::default(); usize::from(trace.header().robots)];
        let left_after = (LEFT_AFTER_S * per_second).ceil() as usize;
        let mut bearings = Vec::with_capacity(robots.len());
        let mut here: Vec<Point<f64>> = Vec::with_capacity(targets);
        for (tick, frame) in trace.frames().enumerate() {
            here.clear();
            here.extend(frame.targets_um.iter().map(|&target| metres(target)));
            for (robot, position) in options.working(tick, frame.robots) {
                let distance = pattern_distance(position, &here).filter(|distance| !distance.is_nan());
                let on_pattern = distance.is_some_and(|distance| distance < ON_PATTERN * options.ring_radius_m);
                let reach = NEAR_TARGET * options.ring_radius_m;
                let near_target = || here.iter().any(|&target| length_squared(position - target) < reach * reach);
                robots[robot].observe(on_pattern || near_target(), left_after);
                if tick >= after {
                    errors.add(distance);
                }
            }
            if tick >= after {
                let positions = || options.working(tick, frame.robots).map(|(_, position)| position);
                spacing(positions, &here, &mut bearings, &mut evenness);
            }
        }
        let works_to_the_end = |robot: &usize| !options.is_stopped(*robot, trace.len().saturating_sub(1));
        let working = || (0..robots.len()).filter(works_to_the_end).filter_map(|robot| robots.get(robot));

        let mut counts = [0u64; 4];
        for contacts in trace.frames().map(|frame| frame.contacts) {
            let now = [contacts.wall_events, contacts.peer_events, contacts.walls, contacts.peers];
            counts.iter_mut().zip(now).for_each(|(sum, count)| *sum += u64::from(count));
        }
        let formed_moments = || moments().skip(after);
        let n = trace.len() - after;
        let of_target = |target: usize| {
            share(formed_moments().filter(|frame| frame.get(target).is_some_and(|&gap| encircles(gap))).count(), n)
        };
        let positions = trace.frames().flat_map(|frame| frame.robots.iter().map(|robot| metres(robot.position_um)));
        Metrics {
            duration_s: trace.len().saturating_sub(1) as f64 / per_second,
            formed_at_s: formed.map(|frame| frame as f64 / per_second),
            encircled_share: formed.map(|_| share(formed_moments().filter(all).count(), n)),
            encircled_share_by_target: formed.map(|_| (0..targets).map(of_target).collect()),
            encircled_share_of_run: whole_run,
            largest_gap_deg: formed.map(|_| formed_moments().flatten().copied().fold(0.0, f64::max).to_degrees()),
            radial_error_median_m: errors.percentile(50),
            radial_error_p95_m: errors.percentile(95),
            radial_error_unknown_share: formed.map(|_| errors.unknown_share()),
            lost_robots: working().filter(|robot| robot.is_lost(left_after)).count(),
            strayed_robots: working().filter(|robot| robot.has_strayed(left_after)).count(),
            wall_contacts: counts[0],
            peer_contacts: counts[1],
            wall_contact_s: counts[2] as f64 / per_second,
            peer_contact_s: counts[3] as f64 / per_second,
            min_wall_clearance_m: min_clearance(positions, options.walls),
            spacing_evenness: evenness.get(),
        }
    }
}

impl MetricsOptions<'_> {
    fn is_stopped(&self, robot: usize, tick: usize) -> bool {
        self.stop_ticks.get(robot).copied().flatten().is_some_and(|stop| tick as u64 >= stop)
    }

    /// The robots that are not broken down, with their positions in metres.
    fn working<'a>(&'a self, tick: usize, robots: &'a [RobotState]) -> impl Iterator<Item = (usize, Point<f64>)> + 'a {
        let working = robots.iter().enumerate().filter(move |&(robot, _)| !self.is_stopped(robot, tick));
        working.map(|(robot, state)| (robot, metres(state.position_um)))
    }
}

/// The largest gap, radians, per frame and target.
fn gap_table(trace: &Trace, options: &MetricsOptions<'_>) -> Vec<f64> {
    let mut bearings = Vec::with_capacity(usize::from(trace.header().robots));
    let mut table = Vec::with_capacity(trace.len() * usize::from(trace.header().targets));
    for (tick, frame) in trace.frames().enumerate() {
        for &target in frame.targets_um {
            let robots = options.working(tick, frame.robots).map(|(_, position)| position);
            table.push(largest_gap(metres(target), robots, &mut bearings));
        }
    }
    table
}

/// The first frame of the first `needed` + 1 frames in a row (`needed` ticks) that are all good.
fn formed_at(good: impl Iterator<Item = bool>, needed: usize) -> Option<usize> {
    let mut run = 0;
    for (frame, good) in good.enumerate() {
        run = if good { run + 1 } else { 0 };
        if run > needed {
            return Some(frame - needed);
        }
    }
    None
}

fn share(count: usize, of: usize) -> f64 {
    if of == 0 { 0.0 } else { count as f64 / of as f64 }
}

/// Adds the evenness about every target, of the robots that are nearer to it than to the others.
fn spacing<R: Iterator<Item = Point<f64>>>(
    robots: impl Fn() -> R,
    targets: &[Point<f64>],
    bearings: &mut Vec<f64>,
    mean: &mut Mean,
) {
    for (index, &target) in targets.iter().enumerate() {
        let nearest = |robot: Point<f64>| {
            let distances = targets.iter().map(|&other| length_squared(robot - other));
            distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(nearest, _)| nearest)
        };
        collect_bearings(target, robots().filter(|&robot| nearest(robot) == Some(index)), bearings);
        if let Some(value) = evenness(bearings) {
            mean.sum += value;
            mean.count += 1;
        }
    }
}

/// The least signed distance to walls; robots that cannot be nearer than the best so far cost one box test a wall.
fn min_clearance(positions: impl Iterator<Item = Point<f64>>, walls: &Walls) -> Option<f64> {
    let mut best = f64::INFINITY;
    for position in positions {
        let reach = best.max(0.0);
        let worth = best.is_infinite()
            || walls.polygons().iter().any(|wall| wall.bounds().distance_squared(position) < reach * reach)
            || best <= 0.0;
        if worth {
            best = best.min(walls.signed_distance(position));
        }
    }
    best.is_finite().then_some(best)
}

#[derive(Default)]
struct Mean {
    sum: f64,
    count: u64,
}

impl Mean {
    fn get(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

/// Distances as a histogram in tenths of millimetres: long runs have millions of them.
#[derive(Default)]
struct Errors {
    bins: Vec<u64>,
    unknown: u64,
    count: u64,
}

impl Errors {
    const BIN: f64 = 1e-4;
    /// Everything beyond 100 m is counted there.
    const MAX: usize = 1_000_000;

    fn add(&mut self, distance: Option<f64>) {
        self.count += 1;
        let Some(distance) = distance else {
            self.unknown += 1;
            return;
        };
        let bin = ((distance.abs() / Self::BIN) as usize).min(Self::MAX);
        if bin >= self.bins.len() {
            self.bins.resize(bin + 1, 0);
        }
        self.bins[bin] += 1;
    }

    fn unknown_share(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.unknown as f64 / self.count as f64 }
    }

    /// The middle of the bin that holds the nearest-rank percentile, metres; `None` if that is an unknown distance.
    fn percentile(&self, percent: u64) -> Option<f64> {
        let rank = (self.count * percent).div_ceil(100).max(1);
        let mut passed = 0;
        self.bins
            .iter()
            .position(|&count| {
                passed += count;
                passed >= rank
            })
            .map(|bin| (bin as f64 + 0.5) * Self::BIN)
    }
}

#[cfg(test)]
mod tests;
