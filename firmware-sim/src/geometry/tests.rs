use super::*;
use grn_core::field::Obstacles;

fn polygon(points: &[(f64, f64)]) -> Result<Polygon, PolygonError> {
    Polygon::new(points.iter().map(|&(x, y)| Vector::new(x, y)).collect())
}

/// An L of area 3 in both windings.
fn both_windings() -> [Polygon; 2] {
    let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let mut reversed = points;
    reversed.reverse();
    [polygon(&points).unwrap(), polygon(&reversed).unwrap()]
}

#[test]
fn winding_does_not_matter() {
    for l in both_windings() {
        assert_eq!((l.area(), l.perimeter()), (3.0, 8.0));
        assert!(l.contains(Vector::new(0.5, 1.5)) && l.contains(Vector::new(1.5, 0.5)));
        assert!(!l.contains(Vector::new(1.5, 1.5)) && !l.contains(Vector::new(-0.1, 0.5)));
        assert_eq!(l.signed_distance(Vector::new(1.5, 1.25)), 0.25);
        assert_eq!(l.signed_distance(Vector::new(0.25, 0.5)), -0.25);
        assert_eq!(l.distance(Vector::new(0.25, 0.5)), 0.0);
        assert_eq!(l.distance(Vector::new(5.0, 4.0)), 18.0_f64.sqrt());
    }
}

#[test]
fn contains_agrees_with_the_winding_number_on_a_lattice() {
    // Rays through vertices are what naive crossing counts get wrong.
    let diamond = polygon(&[(0.0, -2.0), (2.0, 0.0), (0.0, 2.0), (-2.0, 0.0)]).unwrap();
    for i in -12..=12 {
        for j in -12..=12 {
            let p = Vector::new(f64::from(i) / 4.0, f64::from(j) / 4.0);
            let norm = p.x.abs() + p.y.abs();
            if norm != 2.0 {
                assert_eq!(diamond.contains(p), norm < 2.0, "{p:?}");
            }
        }
    }
}

#[test]
fn faulty_polygons_are_rejected() {
    use PolygonError::*;
    assert_eq!(polygon(&[(0.0, 0.0), (1.0, 0.0)]), Err(TooFewVertices(2)));
    assert_eq!(polygon(&[(0.0, 0.0), (1.0, f64::NAN), (1.0, 1.0)]), Err(NotFinite(1)));
    assert_eq!(polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)]), Err(RepeatedVertex(3)));
    assert_eq!(polygon(&[(0.0, 0.0), (1.0, 0.0), (3.0, 0.0)]), Err(NoArea));
    // A bow with unequal halves, a spike, and a vertex that touches another edge.
    assert_eq!(polygon(&[(0.0, 0.0), (4.0, 0.0), (1.0, 3.0), (1.0, -1.0)]), Err(SelfIntersecting(0, 2)));
    assert_eq!(polygon(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (2.0, 1.0), (0.0, 1.0)]), Err(SelfIntersecting(1, 2)));
    assert_eq!(polygon(&[(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 0.0), (0.0, 2.0)]), Err(SelfIntersecting(0, 2)));
}

#[test]
fn rays_meet_walls_at_the_right_distance() {
    let walls = Walls::new(vec![
        polygon(&[(2.0, -1.0), (3.0, -1.0), (3.0, 1.0), (2.0, 1.0)]).unwrap(),
        polygon(&[(-1.0, 4.0), (1.0, 4.0), (0.0, 6.0)]).unwrap(),
    ]);
    let east = Vector::new(1.0, 0.0);
    assert_eq!(walls.ray(Vector::ZERO, east, 10.0), Some(2.0));
    assert_eq!(walls.ray(Vector::ZERO, east, 1.9), None);
    assert_eq!(walls.ray(Vector::ZERO, -east, 10.0), None);
    assert_eq!(walls.ray(Vector::new(0.25, 0.0), Vector::new(0.0, 1.0), 10.0), Some(4.0));
    assert_eq!(walls.ray(Vector::new(2.5, 0.0), east, 10.0), Some(0.5));
    let diagonal = Vector::new(0.8, 0.6);
    assert_eq!(walls.ray(Vector::ZERO, diagonal, 10.0), None);
    assert!((walls.ray(Vector::new(0.4, -1.2), diagonal, 10.0).unwrap() - 2.0).abs() < 1e-12);
}

#[test]
fn rays_and_segments_meet_circles() {
    let (east, centre) = (Vector::new(1.0, 0.0), Vector::new(5.0, 3.0));
    assert_eq!(ray_circle(Vector::ZERO, east, centre, 5.0), Some(1.0));
    assert_eq!(ray_circle(Vector::ZERO, -east, centre, 5.0), None);
    assert_eq!(ray_circle(Vector::ZERO, east, centre, 2.9), None);
    assert_eq!(ray_circle(Vector::new(4.0, 3.0), east, centre, 2.0), Some(0.0));
    assert!(segment_meets_circle(Vector::ZERO, Vector::new(10.0, 0.0), centre, 3.0));
    assert!(!segment_meets_circle(Vector::ZERO, Vector::new(1.0, 0.0), centre, 4.9));
    assert_eq!(ray_segment(Vector::ZERO, east, Vector::new(2.0, 0.0), Vector::new(3.0, 0.0)), None);
}

#[test]
fn walls_are_obstacles() {
    let square = polygon(&[(2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0)]).unwrap();
    let far = polygon(&[(9.0, 9.0), (8.0, 9.0), (8.0, 8.0)]).unwrap();
    let walls = Walls::new(vec![far, square]);
    let away = |x, y| walls.offset_from_nearest(Vector::new(x, y)).unwrap();
    assert_eq!(away(3.0, 1.5), Vector::new(0.0, -0.5));
    assert_eq!(away(3.0, 3.5), Vector::ZERO);
    assert_eq!(away(3.0, 2.0), Vector::ZERO);
    let corner = away(5.0, 1.0);
    assert!((corner.length() - libm::sqrt(2.0)).abs() < 1e-15 && corner.x == -corner.y);
    assert_eq!(walls.signed_distance(Vector::new(3.0, 3.75)), -0.25);
    assert_eq!(walls.signed_distance(Vector::new(3.0, 4.75)), 0.75);
    assert_eq!(walls.containing(Vector::new(3.0, 3.0)), Some(1));
    assert_eq!(Walls::default().signed_distance(Vector::ZERO), f64::INFINITY);
    assert_eq!(Walls::default().offset_from_nearest(Vector::ZERO), None);
}

#[test]
fn samples_are_equally_spaced_and_do_not_close_twice() {
    let square = polygon(&[(0.0, 0.0), (0.7, 0.0), (0.7, 0.7), (0.0, 0.7)]).unwrap();
    assert_eq!(square.boundary_samples(0.7).len(), 4);
    assert_eq!(square.boundary_samples(0.35).len(), 8);
    let samples = square.boundary_samples(0.5);
    assert_eq!(samples.len(), 6);
    assert!((samples[2] - Vector::new(0.7, 0.3)).length() < 1e-15);
    assert!((samples[5] - Vector::new(0.0, 0.3)).length() < 1e-15);
}

#[test]
fn hulls_are_convex_and_hold_every_point() {
    let points: Vec<Point<f64>> = (0..40).map(|i| Vector::new(f64::from(i * 7 % 11), f64::from(i * 5 % 13))).collect();
    let hull = convex_hull(&points);
    let n = hull.len();
    assert!(n >= 3 && n < points.len());
    for i in 0..n {
        let (a, b, c) = (hull[i], hull[(i + 1) % n], hull[(i + 2) % n]);
        assert!((b - a).cross(c - b) > 0.0);
        assert!(points.iter().all(|&p| (b - a).cross(p - a) >= 0.0));
    }
    let square =
        [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (1.0, 1.0)].map(|(x, y)| Vector::new(x, y));
    assert_eq!(convex_hull(&square), [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| Vector::new(x, y)));
    assert!(point_in_polygon(&convex_hull(&square), Vector::new(1.0, 0.5)));
    assert_eq!(convex_hull(&[Vector::new(0.0, 0.0), Vector::new(1.0, 1.0), Vector::new(2.0, 2.0)]).len(), 2);
}

#[test]
fn the_grid_of_nearest_edges_tells_what_all_edges_tell() {
    let mut stream = crate::random::Stream::new(1, crate::random::Component::Obstacles, 0);
    let mut number = |low: f64, high: f64| low + (high - low) * stream.unit();
    let disc = |x: f64, y: f64, r: f64| {
        let corners = (0..7).map(|i| libm::sincos(f64::from(i) * 0.9)).map(|(sin, cos)| (x + r * cos, y + r * sin));
        polygon(&corners.collect::<Vec<_>>()).unwrap()
    };
    // Some overlap, so that the deepest counts.
    let polygons: Vec<Polygon> = (0..12).map(|_| disc(number(0.0, 9.0), number(-4.0, 3.0), number(0.2, 1.5))).collect();
    let walls = Walls::new(polygons.clone());
    for _ in 0..20_000 {
        let point = Vector::new(number(-6.0, 15.0), number(-8.0, 7.0));
        let nearest = polygons.iter().map(|p| p.nearest_boundary(point)).reduce(|a, b| if b.1 < a.1 { b } else { a });
        assert_eq!(walls.nearest_boundary(point), nearest);
        let depths = polygons.iter().map(|p| p.signed_distance(point));
        let deepest = depths.clone().filter(|depth| *depth < 0.0).fold(0.0, f64::min);
        let expected = if deepest < 0.0 { deepest } else { depths.fold(f64::INFINITY, f64::min) };
        assert_eq!(walls.signed_distance(point), expected);
        let away = if deepest < 0.0 { Vector::ZERO } else { point - nearest.unwrap().0 };
        assert_eq!(walls.offset_from_nearest(point), Some(away));
    }
}
