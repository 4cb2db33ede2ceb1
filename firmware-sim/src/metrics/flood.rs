//! Whether the swarm cages its targets: can one of them leave, wherever robots and walls leave a way open?
//!
//! A cage is told by a flood: from a target over a square lattice, stopped by walls and by discs around robots. A way that
//! reaches [`ESCAPE`] leads out. Walls are part of a cage, and robots behind a wall are not.
//!
//! Lengths below are shares of the ring's d_max, so that they follow the world's scale.

use crate::geometry::{Bounds, Polygon, Walls, length_squared};
use grn_core::geometry::{Point, Vector};

/// Spacing of the lattice.
const STEP: f64 = 1.0 / 20.0;
/// A robot keeps a target from everything nearer than this: two robots leave a way open if they are twice as far apart.
pub const GUARDED: f64 = 1.0 / 4.0;
/// A target that comes so far from where it was has left.
pub const ESCAPE: f64 = 1.75;

/// Floods the places around targets; keeps what it has learned of the fixed walls.
pub(super) struct Flood {
    d_max: f64,
    step: f64,
    /// How many steps it is from a target to the edge of the window that is looked at.
    reach: i32,
    /// Where the fixed walls are, as far as was asked already.
    fixed: Lattice<Option<bool>>,
    window: Lattice<bool>,
    open: Vec<[i32; 2]>,
}

/// A value for each lattice point in a rectangle.
struct Lattice<T> {
    corner: [i32; 2],
    columns: i32,
    values: Vec<T>,
}

impl<T: Copy> Lattice<T> {
    fn new(corner: [i32; 2], [columns, rows]: [i32; 2], value: T) -> Self {
        Lattice { corner, columns, values: vec![value; (columns * rows) as usize] }
    }

    fn index(&self, [column, row]: [i32; 2]) -> Option<usize> {
        let (column, row) = (column - self.corner[0], row - self.corner[1]);
        let index = row * self.columns + column;
        ((0..self.columns).contains(&column) && row >= 0 && (index as usize) < self.values.len())
            .then_some(index as usize)
    }
}

/// Of walls that spread over more places than this nothing is kept.
const MOST_KEPT: f64 = 4e6;

impl Flood {
    /// Among fixed walls, which are those of every moment, and around a ring that ends at `d_max`, metres.
    pub fn new(walls: &Walls, d_max: f64) -> Self {
        let step = STEP * d_max;
        let reach = (ESCAPE / STEP).ceil() as i32 + 1;
        let fixed = walls.fixed().iter().map(Polygon::bounds).reduce(Bounds::joined);
        let [low, size] = fixed.map_or([[0.0; 2]; 2], |Bounds { low, high }| {
            let low = [low.x, low.y].map(|least| (least / step).floor() - 1.0);
            [low, [(high.x / step).ceil() + 2.0 - low[0], (high.y / step).ceil() + 2.0 - low[1]]]
        });
        let size = if size[0] * size[1] <= MOST_KEPT { size } else { [0.0; 2] };
        let whole = |pair: [f64; 2]| pair.map(|number| number as i32);
        Flood {
            d_max,
            step,
            reach,
            fixed: Lattice::new(whole(low), whole(size), None),
            window: Lattice::new([0, 0], [2 * reach + 1; 2], false),
            open: Vec::new(),
        }
    }

    /// Whether no way leads from `target` out between the walls and these robots, all in metres. A robot that is nearer to the
    /// target than it [guards](GUARDED) holds nothing: the target is past it.
    pub fn is_caged(&mut self, target: Point<f64>, robots: impl Iterator<Item = Point<f64>>, walls: &Walls) -> bool {
        let start = self.nearest(target);
        self.window.corner = start.map(|coordinate| coordinate - self.reach);
        self.window.values.fill(false);
        let guarded = GUARDED * self.d_max;
        let escape = ESCAPE * self.d_max;
        for robot in robots {
            let away = length_squared(robot - target);
            if away >= guarded * guarded && away < (escape + guarded) * (escape + guarded) {
                self.close(robot, guarded);
            }
        }
        for wall in walls.moving() {
            self.close_wall(wall);
        }
        self.open.clear();
        self.visit(start, walls);
        while let Some(place) = self.open.pop() {
            if length_squared(self.point(place) - target) >= escape * escape {
                return false;
            }
            for step in [[1, 0], [0, 1], [-1, 0], [0, -1]] {
                self.visit([place[0] + step[0], place[1] + step[1]], walls);
            }
        }
        true
    }

    fn nearest(&self, point: Point<f64>) -> [i32; 2] {
        [point.x, point.y].map(|coordinate| (coordinate / self.step).round() as i32)
    }

    fn point(&self, place: [i32; 2]) -> Point<f64> {
        let [x, y] = place.map(|coordinate| f64::from(coordinate) * self.step);
        Vector::new(x, y)
    }

    /// Closes the window's places in the box around `centre` for which `is_closed`.
    fn close_where(&mut self, [low, high]: [Point<f64>; 2], is_closed: impl Fn(Point<f64>) -> bool) {
        let ([left, bottom], [right, top]) = (self.nearest(low), self.nearest(high));
        for row in bottom..=top {
            for column in left..=right {
                if let Some(index) = self.window.index([column, row])
                    && is_closed(self.point([column, row]))
                {
                    self.window.values[index] = true;
                }
            }
        }
    }

    fn close(&mut self, robot: Point<f64>, radius: f64) {
        let corner = Vector::new(radius, radius);
        self.close_where([robot - corner, robot + corner], |place| length_squared(place - robot) <= radius * radius);
    }

    fn close_wall(&mut self, wall: &Polygon) {
        let bounds = wall.bounds();
        let corner = Vector::new(self.step, self.step);
        let half = self.step / 2.0;
        self.close_where([bounds.low - corner, bounds.high + corner], |place| is_within(wall, place, half));
    }

    /// Goes to a place that is neither closed nor visited; what is visited is closed.
    fn visit(&mut self, place: [i32; 2], walls: &Walls) {
        let Some(index) = self.window.index(place) else { return };
        if !self.window.values[index] && !self.is_in_fixed_wall(place, walls) {
            self.window.values[index] = true;
            self.open.push(place);
        }
    }

    fn is_in_fixed_wall(&mut self, place: [i32; 2], walls: &Walls) -> bool {
        let (point, half) = (self.point(place), self.step / 2.0);
        let is_wall = || walls.fixed().iter().any(|wall| is_within(wall, point, half));
        match self.fixed.index(place) {
            Some(index) => *self.fixed.values[index].get_or_insert_with(is_wall),
            None => is_wall(),
        }
    }
}

/// Whether a place is in a wall or so near to it. With half a step a wall is at least as thick as the lattice, and no step leads
/// through it.
fn is_within(wall: &Polygon, place: Point<f64>, distance: f64) -> bool {
    let squared = distance * distance;
    wall.bounds().distance_squared(place) <= squared
        && (wall.contains(place) || wall.nearest_boundary(place).1 <= squared)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

    fn ring(count: u32, radius: f64) -> Vec<Point<f64>> {
        let bearing = |robot: u32| libm::sincos(f64::from(robot) / f64::from(count) * TAU);
        (0..count).map(bearing).map(|(sin, cos)| Vector::new(9.0 + radius * cos, 9.0 + radius * sin)).collect()
    }

    fn wall(corners: [[f64; 2]; 4]) -> Polygon {
        Polygon::new(corners.map(|[x, y]| Vector::new(x, y)).to_vec()).unwrap()
    }

    const TARGET: Point<f64> = Point { x: 9.0, y: 9.0 };

    fn caged(robots: &[Point<f64>], walls: &Walls) -> bool {
        Flood::new(walls, 2.0).is_caged(TARGET, robots.iter().copied(), walls)
    }

    #[test]
    fn a_ring_cages_if_neighbours_are_near_enough() {
        let free = Walls::default();
        // 12 robots at 1.5 m are 0.78 m apart, at 2.2 m 1.14 m; discs of 0.5 m around them leave 0.14 m open.
        assert!(caged(&ring(12, 1.5), &free));
        assert!(!caged(&ring(12, 2.2), &free));
        assert!(caged(&ring(16, 2.2), &free));
        assert!(!caged(&ring(12, 1.5)[..10], &free), "two robots are missing");
        assert!(!caged(&[], &free));
        assert!(!caged(&[TARGET; 5], &free), "who sits on the target holds nothing");
    }

    #[test]
    fn robots_behind_walls_hold_nothing_and_walls_are_part_of_the_cage() {
        let corridor = [
            wall([[5.0, 9.8], [13.0, 9.8], [13.0, 10.0], [5.0, 10.0]]),
            wall([[5.0, 8.0], [13.0, 8.0], [13.0, 8.2], [5.0, 8.2]]),
        ];
        let corridor = Walls::new(corridor.to_vec());
        let ends = [-1.5, 1.5].map(|x| [-0.4, 0.4].map(|y| TARGET + Vector::new(x, y))).concat();
        assert!(caged(&ends, &corridor));
        assert!(!caged(&ends, &Walls::default()));
        assert!(!caged(&ends[..2], &corridor), "one end is open");
        let outside: Vec<_> = ring(40, 1.6).into_iter().filter(|robot| (robot.y - 9.0).abs() > 0.95).collect();
        assert!(!caged(&outside, &corridor));
    }

    #[test]
    fn no_way_leads_through_a_thin_wall_whether_it_moves_or_not() {
        let thin = wall([[8.513, 5.0], [8.5131, 5.0], [8.5131, 13.0], [8.513, 13.0]]);
        let half: Vec<_> = ring(14, 1.7).into_iter().filter(|robot| robot.x > 8.2).collect();
        assert!(!caged(&half, &Walls::default()));
        assert!(caged(&half, &Walls::new(vec![thin.clone()])));
        let mut moving = Walls::default();
        moving.set_moving([thin].into_iter());
        assert!(caged(&half, &moving));
    }

    #[test]
    fn a_large_world_is_flooded_as_a_small_one_is() {
        let near = wall([[5.0, 9.8], [13.0, 9.8], [13.0, 10.0], [5.0, 10.0]]);
        let far = wall([[9000.0, 9000.0], [9001.0, 9000.0], [9001.0, 9001.0], [9000.0, 9001.0]]);
        for radius in [1.0, 1.5, 2.2] {
            let robots: Vec<_> = ring(12, radius).into_iter().filter(|robot| robot.y < 9.9).collect();
            let walls = [Walls::new(vec![near.clone()]), Walls::new(vec![near.clone(), far.clone()])];
            assert_eq!(caged(&robots, &walls[0]), caged(&robots, &walls[1]), "{radius}");
        }
    }
}
