//! A mission: a world with the swarm that it is meant for.

use super::class::Class;
use super::draw::{centimetres, chance, rounded, whole};
use super::layout::{Layout, Moves, Obstacle, Orientation, Shape};
use super::obstacles::{Plan, drawn};
use super::robots::starts;
use super::sampling::Sampling;
use crate::random::{Component, Stream};
use crate::scenario::{InputError, Path, Scenario};
use core::fmt::Write;
use grn_core::geometry::{Point, Vector};

/// From one target to the next, metres along the way.
const SPACING: [f64; 2] = [1.5, 3.0];
/// Mothers for each target.
const MOTHERS: usize = 2;
/// How far targets go from one snapshot to the next, metres, unless that makes too many.
const SNAPSHOT_SPACING: f64 = 0.5;
const MOST_SNAPSHOTS: usize = 51;

/// A world with the swarm that it is meant for.
#[derive(Clone, Debug, PartialEq)]
pub struct Mission {
    /// Its name, and that of its file.
    pub name: String,
    /// Its class.
    pub class: Class,
    /// What determines all of it but its name, together with the sampling.
    pub seed: u64,
    /// How many robots it is for.
    pub robots: usize,
    /// Whether walls stop their radio.
    pub walls_block: bool,
    /// No wall is ever nearer to the path of a target, metres.
    pub clearance: f64,
    /// The world.
    pub scenario: Scenario,
}

impl Mission {
    /// Mission `number`, from 0, of those that `seed` determines.
    ///
    /// # Errors
    /// A world that is refused, which would be a fault of this program.
    pub fn drawn(seed: u64, number: usize, sampling: &Sampling) -> Result<Mission, InputError> {
        let class = sampling.class_of(number);
        let own_seed = Stream::new(seed, Component::Missions, number).seed();
        let name = format!("{number:04}-{}", class.name());
        let mut stream = Stream::new(own_seed, Component::Missions, class as usize);
        let (targets, robots) = sampling.swarm(&mut stream);
        let walls_block = chance(&mut stream, 0.5);
        let clearance = centimetres(&mut stream, sampling.clearance());
        let spacing = centimetres(&mut stream, SPACING);
        let plan = Plan { clearance, convoy: rounded(spacing * (targets - 1) as f64) };
        let (layout, travel) = drawn(class, &plan, &mut stream);
        let orientation = Orientation::new(&layout, chance(&mut stream, 0.5), whole(&mut stream, 0, 3));
        // The first target is the foremost.
        let paths = (0..targets).rev().map(|place| part(&layout.way, place as f64 * spacing, travel));
        let paths: Vec<Vec<Point<f64>>> =
            paths.map(|path| path.into_iter().map(|point| orientation.point(point)).collect()).collect();
        let world = world_text(&name, &layout, &orientation, &paths, travel);
        let scenario = Scenario::parse(&world)?;
        let ways: Vec<(Point<f64>, Vector<f64>)> =
            paths.iter().map(|path| (path[0], (path[1] - path[0]).direction().unwrap_or(Vector::ZERO))).collect();
        let places = starts(robots, &ways, &scenario.walls_at(0.0), scenario.region(), &mut stream);
        let places: Vec<[f64; 2]> = places.into_iter().map(|place| [place.x, place.y]).collect();
        let mothers = MOTHERS * targets;
        let swarm = format!("[swarm]\nrobots = {robots}\nmothers = {mothers}\nwalls_block_radio = {walls_block}\n");
        let scenario = Scenario::parse(&format!("{world}\n{swarm}\n[start]\npositions = {places:?}\n"))?;
        Ok(Mission { name, class, seed: own_seed, robots, walls_block, clearance, scenario })
    }

    /// Name of its file.
    pub fn file(&self) -> String {
        format!("{}.toml", self.name)
    }

    /// Its file: the world, with what it is.
    pub fn text(&self) -> String {
        let targets = self.scenario.targets().len();
        let targets = if targets == 1 { "one target".to_owned() } else { format!("{targets} targets") };
        format!(
            "# A mission of the class {}: {targets}, {} robots. No wall is ever nearer than {} m to a target's path, and\n\
             # robots have room where they begin at a scale of 0.25 and more.\n{}",
            self.class.name(),
            self.robots,
            self.clearance,
            self.scenario.to_toml()
        )
    }
}

/// The part of a way that begins `from` metres along it and is `length` metres long.
fn part(way: &[Point<f64>], from: f64, length: f64) -> Vec<Point<f64>> {
    let whole = Path::new(way.to_vec());
    let at = |metres: f64| whole.at(metres / whole.length());
    let mut passed = 0.0;
    let mut corners = Vec::new();
    for pair in way.windows(2) {
        passed += (pair[1] - pair[0]).length();
        if passed > from && passed < from + length {
            corners.push(pair[1]);
        }
    }
    [at(from)].into_iter().chain(corners).chain([at(from + length)]).collect()
}

/// The text of the world, without starts.
fn world_text(
    name: &str,
    layout: &Layout,
    orientation: &Orientation,
    paths: &[Vec<Point<f64>>],
    travel: f64,
) -> String {
    let [width, height] = orientation.region();
    let snapshots = ((travel / SNAPSHOT_SPACING) as usize + 1).min(MOST_SNAPSHOTS);
    let mut text = format!(
        "name = \"{name}\"\nregion = [{width:?}, {height:?}]\nsnapshots = {snapshots}\n\n\
         [morphogen]\nkernel = \"gaussian\"\ntarget_width = 1.5\nobstacle_width = 0.9\nlevel = 0.5\n\n\
         [ring]\nd_min = 1.0\nd_max = 2.0\nd_obstacle = 2.0\nsteepness = 10.0\n"
    );
    let pairs = |points: &[Point<f64>]| points.iter().map(|point| [point.x, point.y]).collect::<Vec<_>>();
    // Writing to a String cannot fail.
    for path in paths {
        let _ = write!(text, "\n[[target]]\npath = {:?}\n", pairs(path));
    }
    for Obstacle { shape, moves: Moves { path, turn_deg, times } } in &layout.obstacles {
        let placed =
            |points: &[Point<f64>]| pairs(&points.iter().map(|&point| orientation.point(point)).collect::<Vec<_>>());
        let _ = match shape {
            Shape::Wall(corners) => write!(text, "\n[[wall]]\npolygon = {:?}\n", placed(corners)),
            Shape::Disc(centre, radius) => {
                let centre = orientation.point(*centre);
                write!(text, "\n[[disc]]\ncentre = [{:?}, {:?}]\nradius = {radius:?}\n", centre.x, centre.y)
            }
        };
        if !path.is_empty() {
            let _ = writeln!(text, "path = {:?}", placed(path));
        }
        if !turn_deg.is_empty() {
            let turns: Vec<f64> = turn_deg.iter().map(|&degrees| orientation.turn(degrees)).collect();
            let _ = writeln!(text, "turn_deg = {turns:?}");
        }
        if !times.is_empty() {
            let _ = writeln!(text, "times = {times:?}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::SwarmConfig;
    use crate::swarm;

    fn drawn(seed: u64, count: usize) -> impl Iterator<Item = Mission> {
        (0..count).map(move |number| Mission::drawn(seed, number, &Sampling::default()).unwrap())
    }

    /// Where the targets are on their way, every few centimetres.
    fn ways(world: &Scenario) -> Vec<Point<f64>> {
        let steps = |target: &crate::scenario::Target| (target.path().length() / 0.05).ceil() as usize;
        let of_target = |target| {
            let last = steps(target);
            (0..=last).map(move |step| target.path().at(step as f64 / last as f64))
        };
        world.targets().iter().flat_map(of_target).collect()
    }

    #[test]
    fn every_mission_is_passable_and_its_swarm_fits() {
        let mut targets = [0; 11];
        let mut robots = Vec::new();
        let mut blocked = 0;
        for mission in drawn(1, 140) {
            let world = &mission.scenario;
            let ways = ways(world);
            let moments = if world.walls_change() { 100 } else { 0 };
            let clearance = (0..=moments)
                .map(|moment| world.walls_at(f64::from(moment) / 100.0))
                .flat_map(|walls| ways.iter().map(|&place| walls.signed_distance(place)).collect::<Vec<_>>())
                .fold(f64::INFINITY, f64::min);
            let stated = mission.clearance;
            assert!(clearance >= stated - 1e-6, "{}: {clearance} instead of {stated}", mission.name);
            assert!(clearance < stated + 0.7, "{}: {clearance} instead of {stated}", mission.name);
            let fastest = world.targets().iter().map(|target| target.path().length()).fold(0.0, f64::max);
            assert!(
                world.longest_path() <= fastest * 1.001,
                "{}: an obstacle is faster than the targets",
                mission.name
            );
            let config = world.configured(SwarmConfig::default());
            assert_eq!((config.lab.robots.count, config.lab.radio.walls_block), (mission.robots, mission.walls_block));
            assert_eq!(config.lab.robots.mothers, 2 * world.targets().len());
            swarm::check(world, &config).unwrap();
            assert_eq!(&Scenario::parse(&mission.text()).unwrap(), world);
            targets[world.targets().len()] += 1;
            robots.push(mission.robots);
            blocked += usize::from(mission.walls_block);
        }
        assert!(targets[1] > 50 && targets[2..].iter().all(|&count| count > 0), "{targets:?}");
        robots.sort_unstable();
        assert!(robots[0] >= 10 && robots[0] < 14 && robots[139] > 150 && robots[139] <= 200, "{robots:?}");
        assert!((50..=90).contains(&blocked), "{blocked}");
    }

    /// From the first target's start to its end over a lattice, always the clearance away from every wall that stands still.
    #[test]
    fn a_flood_at_the_clearance_gets_through() {
        const STEP: f64 = 0.05;
        for mission in drawn(3, 21) {
            let world = &mission.scenario;
            let walls = world.fixed_walls();
            let [width, height] = world.region().map(|side| (side / STEP) as i32);
            let is_free = |(x, y): (i32, i32)| {
                let place = Vector::new(f64::from(x) * STEP, f64::from(y) * STEP);
                // Nodes of the lattice lie beside the way.
                walls.signed_distance(place) >= mission.clearance - STEP
            };
            let node = |place: Point<f64>| ((place.x / STEP).round() as i32, (place.y / STEP).round() as i32);
            let path = world.targets()[0].path();
            let (start, end) = (node(path.at(0.0)), node(path.at(1.0)));
            let mut seen = std::collections::BTreeSet::from([start]);
            let mut edge = vec![start];
            while let Some((x, y)) = edge.pop() {
                for next in [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)] {
                    let inside = (0..=width).contains(&next.0) && (0..=height).contains(&next.1);
                    if inside && is_free(next) && seen.insert(next) {
                        edge.push(next);
                    }
                }
            }
            assert!(seen.contains(&end), "{}", mission.name);
        }
    }

    #[test]
    fn equal_seeds_draw_equal_missions_and_others_do_not() {
        let text = |seed| drawn(seed, 14).map(|mission| mission.text()).collect::<String>();
        assert_eq!(text(5), text(5));
        assert_ne!(text(5), text(6));
    }

    #[test]
    fn narrow_and_wide_ways_are_drawn_for_every_class() {
        for clearance in [0.3, 3.0] {
            let sampling = Sampling::new(&[], [1, 10], [10, 200], [clearance; 2]).unwrap();
            for number in 0..28 {
                let mission = Mission::drawn(9, number, &sampling).unwrap();
                assert_eq!(mission.clearance, clearance);
                swarm::check(&mission.scenario, &mission.scenario.configured(SwarmConfig::default())).unwrap();
            }
        }
    }
}
