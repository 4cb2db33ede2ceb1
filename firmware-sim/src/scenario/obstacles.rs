//! The walls and discs of a file, checked.

use super::limits::{self, WALL_OVERHANG};
use super::points::{checked_point, checked_points};
use super::tables::{DiscTable, WallTable};
use super::timing::checked_motion;
use super::{Disc, MovingWall, Presence};
use crate::geometry::{Polygon, PolygonError, Walls};
use grn_core::geometry::Point;
use grn_input::{InputError, Pair};

/// What is solid in a world.
pub(super) struct Obstacles {
    /// Those that stand still: walls, then discs.
    pub fixed: Walls,
    /// The discs among them.
    pub fixed_discs: Vec<Disc>,
    /// Walls, then discs, that move, come or go.
    pub moving: Vec<MovingWall>,
    /// What those that stand still are called in the file: `wall[2]`, `disc[0]`.
    keys: Vec<String>,
}

impl Obstacles {
    /// The tables' obstacles in a world of this region, metres, and so many snapshots.
    pub fn checked(
        walls: Vec<WallTable>,
        discs: Vec<DiscTable>,
        region: [f64; 2],
        snapshots: usize,
    ) -> Result<Obstacles, InputError> {
        let mut reading = Reading { region, snapshots, ..Reading::default() };
        for (place, wall) in walls.into_iter().enumerate() {
            reading.take_wall(place, wall)?;
        }
        for (place, disc) in discs.into_iter().enumerate() {
            reading.take_disc(place, disc)?;
        }
        let Reading { fixed, fixed_discs, moving, keys, .. } = reading;
        Ok(Obstacles { fixed: Walls::new(fixed), fixed_discs, moving, keys })
    }

    /// What the obstacle that stands still and holds the point is called.
    pub fn fixed_containing(&self, point: Point<f64>) -> Option<&str> {
        self.fixed.containing(point).map(|place| self.keys[place].as_str())
    }

    /// What the obstacle that stands still is called that the straight way between two points meets first.
    pub fn first_fixed_between(&self, start: Point<f64>, end: Point<f64>) -> Option<&str> {
        let (direction, reach) = ((end - start).direction()?, (end - start).length());
        let met = |(polygon, key): (&Polygon, _)| Some((key, polygon.ray(start, direction, reach)?));
        let hits = self.fixed.fixed().iter().zip(&self.keys).filter_map(met);
        hits.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(key, _)| key.as_str())
    }
}

/// Obstacles read so far.
#[derive(Default)]
struct Reading {
    region: [f64; 2],
    snapshots: usize,
    /// Arc length of all outlines, metres, and their points.
    outlines: f64,
    points: usize,
    fixed: Vec<Polygon>,
    fixed_discs: Vec<Disc>,
    moving: Vec<MovingWall>,
    keys: Vec<String>,
}

impl Reading {
    fn take_wall(&mut self, place: usize, table: WallTable) -> Result<(), InputError> {
        let WallTable { polygon: vertices, path, turn_deg, times, present } = table;
        let wall = format!("wall[{place}]");
        let key = format!("{wall}.polygon");
        let polygon = checked_points(&key, &vertices, self.region, WALL_OVERHANG)?;
        let polygon = Polygon::new(polygon).map_err(|error| polygon_error(&key, &vertices, error))?;
        self.count(&key, &polygon)?;
        let path = checked_points(&format!("{wall}.path"), &path, self.region, WALL_OVERHANG)?;
        let motion = checked_motion(&wall, path, turn_deg, times)?;
        self.take(
            &wall,
            MovingWall { place, disc: None, drawn: polygon, motion, presence: presence(&wall, &present)? },
        );
        Ok(())
    }

    fn take_disc(&mut self, place: usize, table: DiscTable) -> Result<(), InputError> {
        let DiscTable { centre, radius, path, times, present } = table;
        let key = format!("disc[{place}]");
        let centre = checked_point(&format!("{key}.centre"), centre, self.region, WALL_OVERHANG)?;
        limits::DISC_RADIUS.check(&format!("{key}.radius"), radius)?;
        let disc = Disc { centre, radius };
        let drawn = disc.outline();
        self.count(&format!("{key}.radius"), &drawn)?;
        let path = checked_points(&format!("{key}.path"), &path, self.region, WALL_OVERHANG)?;
        if path.len() == 1 {
            let expected = "one point is no way: add a second one, or leave the path out";
            return Err(InputError::new(format!("{key}.path"), "", expected));
        }
        let motion = checked_motion(&key, path, Vec::new(), times)?;
        self.take(&key, MovingWall { place, disc: Some(disc), drawn, motion, presence: presence(&key, &present)? });
        Ok(())
    }

    /// Counts an outline, which the file describes under `key`.
    fn count(&mut self, key: &str, outline: &Polygon) -> Result<(), InputError> {
        self.outlines += outline.perimeter();
        self.points += outline.vertices().len();
        limits::check_outline(key, self.outlines, self.points, self.snapshots)
    }

    /// Keeps an obstacle, among those that stand still if it neither moves nor comes or goes.
    fn take(&mut self, key: &str, wall: MovingWall) {
        if wall.motion.is_some() || !wall.presence.is_always() {
            return self.moving.push(wall);
        }
        self.fixed.push(wall.drawn);
        self.fixed_discs.extend(wall.disc);
        self.keys.push(key.to_owned());
    }
}

fn presence(key: &str, spans: &[Pair]) -> Result<Presence, InputError> {
    Presence::checked(&format!("{key}.present"), spans)
}

fn polygon_error(key: &str, vertices: &[Pair], error: PolygonError) -> InputError {
    let at = |vertex: usize| vertices.get(vertex).map(|pair| format!("{:?}", pair.0)).unwrap_or_default();
    let next = |vertex: usize| (vertex + 1) % vertices.len().max(1);
    match error {
        PolygonError::TooFewVertices(count) => {
            InputError::new(key, format!("{count} points"), "a polygon needs at least 3 points")
        }
        PolygonError::NotFinite(vertex) => {
            InputError::new(format!("{key}[{vertex}]"), at(vertex), "coordinates must be finite")
        }
        PolygonError::RepeatedVertex(vertex) => InputError::new(
            format!("{key}[{vertex}]"),
            at(vertex),
            "must differ from the next point (the last point is joined to the first by itself)",
        ),
        PolygonError::SelfIntersecting(a, b) => InputError::new(
            format!("{key}[{b}]"),
            at(b),
            format!(
                "the edge from here to {} meets the one from {} to {}; the outline must not cross or touch itself",
                at(next(b)),
                at(a),
                at(next(a))
            ),
        ),
        PolygonError::NoArea => InputError::new(key, "", "encloses no area; points must not lie on a line"),
    }
}
