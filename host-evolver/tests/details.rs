//! Details smaller than the lattice: thin walls, doorways, columns and small rings, against a flood fill so fine that no wall
//! fits between its nodes, which shares no code with the evaluation but the model's.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::geometry::{Polygon, nearest_on_segment, point_in_polygon};
use firmware_sim::scenario::Scenario;
use grn_core::field::Kernel;
use grn_core::geometry::{Point, Vector};
use host_evolver::evaluation::{Evaluator, Model, Snapshot, Tracer, World};
use host_evolver::model::published::PUBLISHED;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::collections::HashMap;

/// Spacing of the flood fill, metres: less than the thinnest wall.
const STEP: f64 = 0.008;
/// A component that gets so far from its target is open, steps.
const FAR: i32 = 500;
/// Where a change of the level by this pattern error changes what the flood finds, neither answer is wrong.
const MARGINAL: f64 = 0.004;

/// Where the target is: on no node.
const TARGET: Point<f64> = Vector::new(5.07, 4.94);

/// A world of one target and these walls, in TOML.
fn world(widths: [f64; 2], kernel: Kernel, walls: &str) -> World {
    let text = format!(
        "name = \"details\"\nregion = [10.0, 10.0]\nsnapshots = 1\n\n[morphogen]\nkernel = \"{}\"\n\
         target_width = {:?}\nobstacle_width = {:?}\nlevel = 0.5\n\n[ring]\nd_min = 1.0\nd_max = 2.0\nd_obstacle = 2.0\n\
         steepness = 10.0\n\n[[target]]\npath = [[{:?}, {:?}]]\n{walls}",
        kernel.name(),
        widths[0],
        widths[1],
        TARGET.x,
        TARGET.y
    );
    World::new(Scenario::parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}")))
}

fn models() -> Vec<(&'static str, Model)> {
    let model = |level| {
        move |p: &host_evolver::model::published::Published| (p.name, Model::new(&p.network().unwrap(), level).unwrap())
    };
    PUBLISHED.iter().map(model(0.5)).chain(PUBLISHED.iter().map(model(0.35))).collect()
}

/// A wall of some thickness, centred at `centre`, as a table.
fn bar(centre: Point<f64>, angle: f64, [length, thickness]: [f64; 2]) -> String {
    let along = Vector::new(libm::cos(angle), libm::sin(angle)) * (length / 2.0);
    let aside = along.turned_left() * (thickness / length);
    let corners = [along + aside, aside - along, -along - aside, along - aside].map(|offset| centre + offset);
    format!("\n[[wall]]\npolygon = {:?}\n", corners.map(|corner| [corner.x, corner.y]))
}

/// A number in [0, 1).
fn share(random: &mut Pcg64) -> f64 {
    f64::from(random.next_u32()) / (f64::from(u32::MAX) + 1.0)
}

fn between(random: &mut Pcg64, low: f64, high: f64) -> f64 {
    low + (high - low) * share(random)
}

/// Whether the inside component of the target at a level is closed.
fn is_closed(world: &World, snapshot: &Snapshot, model: &Model, threshold: f64) -> bool {
    let target = snapshot.targets[0];
    let walls: Vec<&Polygon> = snapshot.walls().polygons().collect();
    // Whether a node is in a wall, and whether it is inside the pattern.
    let look = |place: (i32, i32)| {
        let point = target + Vector::new(f64::from(place.0), f64::from(place.1)) * STEP;
        let sides = walls.iter().flat_map(|wall| {
            let corners = wall.vertices();
            (0..corners.len()).map(move |i| (corners[i], corners[(i + 1) % corners.len()]))
        });
        let distance = |(a, b)| (nearest_on_segment(a, b, point) - point).length();
        let in_wall = walls.iter().any(|wall| wall.contains(point));
        let clearance = if in_wall { 0.0 } else { sides.map(distance).fold(f64::INFINITY, f64::min) };
        let morphogen = world.scenario().morphogen();
        let x1 = morphogen.kernel.concentration((point - target).length() / morphogen.target_width);
        let x2 =
            if walls.is_empty() { 0.0 } else { morphogen.kernel.concentration(clearance / morphogen.obstacle_width) };
        (in_wall, model.error(x1, x2) >= threshold)
    };
    let mut seen = HashMap::from([((0, 0), ())]);
    let mut open = vec![(0, 0)];
    if !look((0, 0)).1 {
        return false;
    }
    while let Some((column, row)) = open.pop() {
        for next in [(column + 1, row), (column - 1, row), (column, row + 1), (column, row - 1)] {
            if seen.insert(next, ()).is_some() {
                continue;
            }
            let (in_wall, inside) = look(next);
            if inside && (in_wall || next.0.abs() > FAR || next.1.abs() > FAR) {
                return false;
            }
            if inside {
                open.push(next);
            }
        }
    }
    true
}

/// How often evaluation and flood fill agree, disagree at the margin, and how often a wall decides.
#[derive(Debug, Default)]
struct Tally {
    closed: usize,
    open: usize,
    marginal: usize,
    faults: Vec<String>,
}

impl Tally {
    fn add(&mut self, world: &World, (name, model): &(&str, Model), place: &str) {
        for (index, (snapshot, contours)) in Tracer::new(world).trace_all(model).enumerate() {
            let found = contours.enclosed[0];
            if found == is_closed(world, snapshot, model, 0.0) {
                *(if found { &mut self.closed } else { &mut self.open }) += 1;
            } else if [-MARGINAL, MARGINAL].iter().any(|&level| found == is_closed(world, snapshot, model, level)) {
                self.marginal += 1;
            } else {
                let walls = world.scenario().to_toml();
                self.faults.push(format!("{place}, {name} at {index}: found {found}\n{walls}"));
            }
        }
    }

    fn judge(&self) {
        println!("{} closed, {} open, {} marginal", self.closed, self.open, self.marginal);
        assert!(self.faults.is_empty(), "{} faults, the first:\n{}", self.faults.len(), self.faults[0]);
        assert!(self.marginal * 20 <= self.closed + self.open, "too often neither");
        assert!(self.closed > 20 && self.open > 20, "nothing is decided: {self:?}");
    }
}

#[test]
fn thin_walls_of_any_angle_count_as_a_flood_fill_finds_them() {
    let (mut random, models, mut tally) = (Pcg64::seed_from_u64(1), models(), Tally::default());
    for case in 0..300 {
        let (kernel, width) = [
            (Kernel::Gaussian, 0.9),
            (Kernel::Gaussian, 0.9),
            (Kernel::Gaussian, 0.3),
            (Kernel::Gaussian, 0.1),
            (Kernel::Exponential, 0.9),
        ][case % 5];
        let angle = between(&mut random, 0.0, std::f64::consts::TAU);
        let from_target = Vector::new(libm::cos(angle), libm::sin(angle)) * between(&mut random, 0.15, 3.5);
        let size = [between(&mut random, 0.3, 5.0), between(&mut random, 0.01, 0.2)];
        let wall_angle = between(&mut random, 0.0, 3.2);
        let aside = Vector::new(-libm::sin(wall_angle), libm::cos(wall_angle)).dot(from_target).abs();
        if aside < size[1] / 2.0 + 0.02 {
            continue; // The target might be in it.
        }
        let walls = bar(TARGET + from_target, wall_angle, size);
        let world = world([1.5, width], kernel, &walls);
        tally.add(&world, &models[case % models.len()], &format!("case {case}"));
    }
    tally.judge();
}

#[test]
fn doorways_of_thirty_centimetres_in_thin_walls_are_open() {
    let (mut random, models, mut tally) = (Pcg64::seed_from_u64(2), models(), Tally::default());
    for case in 0..200 {
        let width = [0.9, 0.3, 0.1][case % 3];
        let (angle, thickness) = (between(&mut random, 0.0, 3.2), between(&mut random, 0.01, 0.05));
        let along = Vector::new(libm::cos(angle), libm::sin(angle));
        let door =
            TARGET + along.turned_left() * between(&mut random, 0.1, 3.0) + along * between(&mut random, -0.3, 0.3);
        let walls = [1.0, -1.0].map(|side| bar(door + along * (side * 1.15), angle, [2.0, thickness])).concat();
        let world = world([1.5, width], Kernel::Gaussian, &walls);
        tally.add(&world, &models[case % models.len()], &format!("case {case}"));
    }
    tally.judge();
}

#[test]
fn a_thin_door_in_a_moving_world_closes_where_it_is() {
    let mut tally = Tally::default();
    for (case, model) in models().iter().enumerate() {
        let angle = 0.1 * case as f64;
        let door = bar(TARGET + Vector::new(0.3, 2.6), angle, [1.5, 0.02]);
        let motion = "path = [[5.3, 7.5], [5.2, 6.1]]\nturn_deg = [0.0, 40.0]\n";
        let world = world([1.5, 0.9], Kernel::Gaussian, &format!("{door}{motion}"));
        let text = world.scenario().to_toml().replace("snapshots = 1\n", "snapshots = 12\nduration_s = 100.0\n");
        let world = World::new(Scenario::parse(&text).unwrap());
        tally.add(&world, model, &format!("angle {angle}"));
    }
    tally.judge();
}

#[test]
fn a_wall_of_two_centimetres_counts_like_one_of_twenty_five() {
    let model = Model::new(&PUBLISHED[0].network().unwrap(), 0.5).unwrap();
    let [thin, thick] = [0.02, 0.25].map(|thickness| {
        let wall = bar(Vector::new(5.0, 5.85 + thickness / 2.0), 0.0, [8.0, thickness]);
        Evaluator::new(&world([1.5, 0.9], Kernel::Gaussian, &wall)).evaluate(&model)
    });
    assert_eq!(thin.violation, 1.0);
    assert_eq!(thin.violation, thick.violation);
}

#[test]
fn a_thin_column_is_touched_or_walked_around_but_not_overlooked() {
    for (name, model) in &models() {
        for width in [0.9, 0.1, 0.01] {
            for offset in [0.02, 0.07, 0.13] {
                let centre = TARGET + Vector::new(0.4 + offset, 0.3 + offset);
                let world = world([1.5, width], Kernel::Gaussian, &bar(centre, 0.4, [0.03, 0.02]));
                let (_, contours) = Tracer::new(&world).trace_all(model).next().unwrap();
                let around = contours.rings.iter().filter(|ring| point_in_polygon(ring, centre)).count();
                // Outside all rings, or in or beside a hole, which the node that stands for the column makes.
                let shown = around % 2 == 0 || contours.rings.len() > around;
                assert!(!contours.enclosed[0] || shown, "{name}, σ_o {width}, {offset}: {around} rings");
            }
        }
    }
}

#[test]
fn rings_as_small_as_a_scenario_may_ask_for_have_their_radius() {
    for (name, model) in &models() {
        for width in [0.01, 0.03, 0.1, 0.25, 0.5] {
            let world = world([width, 0.9], Kernel::Gaussian, "");
            let error = |radius: f64| model.error(Kernel::Gaussian.concentration(radius / width), 0.0);
            let outside = (1..4000).map(|i| f64::from(i) * 0.001 * width).find(|&radius| error(radius) < 0.0);
            let radius = outside.unwrap();
            let (_, contours) = Tracer::new(&world).trace_all(model).next().unwrap();
            assert_eq!((contours.enclosed[0], contours.rings.len()), (true, 1), "{name}, σ_t {width}, radius {radius}");
            for &point in &contours.rings[0] {
                let found = (point - TARGET).length();
                assert!(
                    (found - radius).abs() < 0.02 * radius + 0.001 * width,
                    "{name}, σ_t {width}: {found} not {radius}"
                );
            }
        }
    }
}
