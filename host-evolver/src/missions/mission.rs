//! A mission: a world and the laboratory that it is for.

use super::class::Class;
use super::draw::{centimetres, chance, rounded, whole};
use super::layout::{Course, Frame, Layout, Obstacle, Shape};
use super::obstacles::{Plan, drawn};
use super::robots::starts;
use core::fmt::Write;
use firmware_sim::random::{Component, Stream};
use firmware_sim::scenario::{InputError, Path, Scenario};
use grn_core::geometry::{Point, Vector};

/// The most targets of a mission.
const MOST_TARGETS: usize = 10;
/// How probable a single target is; more are equally probable.
const SINGLE: f64 = 0.5;
/// From one target to the next, metres along the way.
const SPACING: [f64; 2] = [1.5, 3.0];
/// Robots for each target.
const ROBOTS: [usize; 2] = [10, 20];
/// Mothers for each target.
const MOTHERS: usize = 2;
/// From the way to the nearest wall, metres.
const CLEARANCE: [f64; 2] = [0.6, 1.2];
/// How far targets go from one snapshot to the next, metres, unless that makes too many.
const SNAPSHOT_SPACING: f64 = 0.5;
const MOST_SNAPSHOTS: usize = 51;

/// A world, and the laboratory that it is for.
#[derive(Clone, Debug, PartialEq)]
pub struct Mission {
    /// Its name, and that of its files.
    pub name: String,
    /// Its class.
    pub class: Class,
    /// What determines everything about it but the name.
    pub seed: u64,
    /// How many robots it is for.
    pub robots: usize,
    /// Whether walls stop radio in its laboratory.
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
    pub fn drawn(seed: u64, number: usize, class: Class) -> Result<Mission, InputError> {
        let own_seed = Stream::new(seed, Component::Missions, number).seed();
        let name = format!("{number:04}-{}", class.name());
        let mut stream = Stream::new(own_seed, Component::Missions, class as usize);
        let targets = if chance(&mut stream, SINGLE) { 1 } else { whole(&mut stream, 2, MOST_TARGETS) };
        let robots = targets * whole(&mut stream, ROBOTS[0], ROBOTS[1]);
        let walls_block = chance(&mut stream, 0.5);
        let clearance = centimetres(&mut stream, CLEARANCE);
        let spacing = centimetres(&mut stream, SPACING);
        let plan = Plan { clearance, convoy: rounded(spacing * (targets - 1) as f64) };
        let (layout, travel) = drawn(class, &plan, &mut stream);
        let frame = Frame::new(&layout, chance(&mut stream, 0.5), whole(&mut stream, 0, 3));
        // The first target is the foremost.
        let paths = (0..targets).rev().map(|place| part(&layout.way, place as f64 * spacing, travel));
        let paths: Vec<Vec<Point<f64>>> =
            paths.map(|path| path.into_iter().map(|point| frame.point(point)).collect()).collect();
        let world = world_text(&name, &layout, &frame, &paths, travel);
        let scenario = Scenario::parse(&world)?;
        let ways: Vec<(Point<f64>, Vector<f64>)> =
            paths.iter().map(|path| (path[0], (path[1] - path[0]).direction().unwrap_or(Vector::ZERO))).collect();
        let places = starts(robots, &ways, &scenario.walls_at(0.0), scenario.region(), &mut stream);
        let places: Vec<[f64; 2]> = places.into_iter().map(|place| [place.x, place.y]).collect();
        let scenario = Scenario::parse(&format!("{world}\n[start]\npositions = {places:?}\n"))?;
        Ok(Mission { name, class, seed: own_seed, robots, walls_block, clearance, scenario })
    }

    /// Name of the file of its world.
    pub fn world_file(&self) -> String {
        format!("{}.toml", self.name)
    }

    /// Name of the file of its laboratory.
    pub fn laboratory_file(&self) -> String {
        format!("{}.lab.toml", self.name)
    }

    /// The file of its world.
    pub fn world(&self) -> String {
        let targets = self.scenario.targets().len();
        let targets = if targets == 1 { "one target".to_owned() } else { format!("{targets} targets") };
        format!(
            "# A mission of the class {}: {targets}, {} robots; its laboratory is {}.\n\
             # No wall is ever nearer than {} m to a target's path. Robots' starts have room at scale 0.25 and above.\n{}",
            self.class.name(),
            self.robots,
            self.laboratory_file(),
            self.clearance,
            self.scenario.to_toml()
        )
    }

    /// The file of its laboratory: `ideal`, but for the number of robots and what walls do to radio.
    pub fn laboratory(&self) -> String {
        format!(
            "# For the mission {}.\nname = \"{}\"\nbase = \"ideal\"\n\n[robots]\ncount = {}\nmothers = {}\n\n[radio]\n\
             walls_block = {}\n",
            self.world_file(),
            self.name,
            self.robots,
            MOTHERS * self.scenario.targets().len(),
            self.walls_block
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
fn world_text(name: &str, layout: &Layout, frame: &Frame, paths: &[Vec<Point<f64>>], travel: f64) -> String {
    let [width, height] = frame.region();
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
    for Obstacle { shape, course: Course { path, turn_deg, times } } in &layout.obstacles {
        let placed = |points: &[Point<f64>]| pairs(&points.iter().map(|&point| frame.point(point)).collect::<Vec<_>>());
        let _ = match shape {
            Shape::Wall(corners) => write!(text, "\n[[wall]]\npolygon = {:?}\n", placed(corners)),
            Shape::Disc(centre, radius) => {
                let centre = frame.point(*centre);
                write!(text, "\n[[disc]]\ncentre = [{:?}, {:?}]\nradius = {radius:?}\n", centre.x, centre.y)
            }
        };
        if !path.is_empty() {
            let _ = writeln!(text, "path = {:?}", placed(path));
        }
        if !turn_deg.is_empty() {
            let turns: Vec<f64> = turn_deg.iter().map(|&degrees| frame.turn(degrees)).collect();
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
    use firmware_sim::config::SwarmConfig;
    use firmware_sim::{lab, swarm};

    fn drawn(seed: u64, count: usize) -> impl Iterator<Item = Mission> {
        (0..count).map(move |number| Mission::drawn(seed, number, Class::ALL[number % Class::ALL.len()]).unwrap())
    }

    #[test]
    fn every_mission_is_passable_and_its_swarm_fits() {
        let mut targets = [0; MOST_TARGETS + 1];
        let mut robots = Vec::new();
        for mission in drawn(1, 140) {
            let world = &mission.scenario;
            let ways: Vec<Point<f64>> = world
                .targets()
                .iter()
                .flat_map(|target| (0..=60).map(|step| target.path().at(f64::from(step) / 60.0)))
                .collect();
            let mut clearance = f64::INFINITY;
            for moment in 0..=100 {
                let walls = world.walls_at(f64::from(moment) / 100.0);
                clearance = ways.iter().map(|&place| walls.signed_distance(place)).fold(clearance, f64::min);
                if !world.walls_change() {
                    break;
                }
            }
            let stated = mission.clearance;
            assert!(clearance >= stated - 1e-6, "{}: {clearance} instead of {stated}", mission.name);
            assert!(clearance < stated + 0.7, "{}: {clearance} instead of {stated}", mission.name);
            let fastest = world.targets().iter().map(|target| target.path().length()).fold(0.0, f64::max);
            assert!(
                world.longest_path() <= fastest * 1.001,
                "{}: an obstacle is faster than the targets",
                mission.name
            );
            let lab = lab::parse(&mission.laboratory()).unwrap();
            assert_eq!((lab.robots.count, lab.radio.walls_block), (mission.robots, mission.walls_block));
            swarm::check(world, &SwarmConfig { lab, ..SwarmConfig::default() }).unwrap();
            assert_eq!(&Scenario::parse(&mission.world()).unwrap(), world);
            targets[world.targets().len()] += 1;
            robots.push(mission.robots);
        }
        assert!(targets[1] > 50 && targets[2..].iter().all(|&count| count > 0), "{targets:?}");
        robots.sort_unstable();
        assert!(robots[0] >= 10 && robots[0] < 14 && robots[139] > 150 && robots[139] <= 200, "{robots:?}");
    }

    #[test]
    fn equal_seeds_draw_equal_missions_and_others_do_not() {
        let text = |seed| drawn(seed, 14).map(|mission| mission.world() + &mission.laboratory()).collect::<String>();
        assert_eq!(text(5), text(5));
        assert_ne!(text(5), text(6));
    }
}
