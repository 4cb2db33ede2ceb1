//! Round obstacles.

use super::*;

const COLUMNS: &str = include_str!("../../../../scenarios/adaptive/columns.toml");

fn error(more: &str) -> String {
    Scenario::parse(&format!("{COLUMNS}\n{more}")).map(|_| ()).unwrap_err().to_string()
}

#[test]
fn discs_stand_beside_walls_move_and_round_trip() {
    let more = "[[disc]]\ncentre = [3.0, 15.0]\nradius = 0.7\npath = [[3.0, 15.0], [9.0, 13.0]]\n\n\
                [[wall]]\npolygon = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]\npresent = [[0.0, 0.5]]\n\n\
                [[disc]]\ncentre = [3.0, 2.0]\nradius = 0.2\n\n\
                [[wall]]\npolygon = [[11.0, 1.0], [12.0, 1.0], [12.0, 2.0]]\n";
    let world = Scenario::parse(&format!("{COLUMNS}\n{more}")).unwrap();
    assert_eq!((world.fixed_walls().fixed().len(), world.fixed_discs().len(), world.moving_walls().len()), (7, 6, 2));
    assert_eq!(world.moving_walls()[1].disc(), Some(Disc { centre: Vector::new(3.0, 15.0), radius: 0.7 }));
    let at_end = world.walls_at(1.0);
    assert!((at_end.signed_distance(Vector::new(9.0, 13.0)) + 0.7).abs() < 0.7 * 0.000_61);
    for world in [world.scaled(0.3), world] {
        let text = world.to_toml();
        let again = Scenario::parse(&text).unwrap();
        assert_eq!(again.to_toml(), text);
        for time in [0.0, 0.37, 1.0] {
            let outlines = |world: &Scenario| -> Vec<Point<f64>> {
                world.walls_at(time).polygons().flat_map(|polygon| polygon.vertices().to_vec()).collect()
            };
            assert_eq!(outlines(&again), outlines(&world));
        }
    }
}

#[test]
fn a_disc_is_a_circle_to_within_what_is_stated() {
    for radius in [0.01, 0.3, 7.0] {
        let centre = Vector::new(12.0, 34.0);
        let outline = Polygon::disc(centre, radius);
        let samples = outline.boundary_samples(radius / 1000.0);
        let errors = samples.iter().map(|&point| ((point - centre).length() - radius) / radius);
        let (least, greatest) = errors.fold((0.0_f64, 0.0_f64), |(a, b), error| (a.min(error), b.max(error)));
        assert!((0.000_59..0.000_61).contains(&greatest) && (-0.000_61..-0.000_59).contains(&least));
        assert!((outline.area() / (core::f64::consts::PI * radius * radius) - 1.0).abs() < 1e-3);
        let checked = Polygon::new(outline.vertices().to_vec()).unwrap();
        assert!((outline.area() - checked.area()).abs() < 1e-12 * radius * radius * 1e3);
    }
}

#[test]
fn wrong_discs_are_refused_where_they_stand() {
    for (more, words) in [
        (
            "[[disc]]\ncentre = [3.0, 15.0]\nradius = 0.0",
            "disc[5].radius = 0.0: must be a number from 0.01 to 100 metres",
        ),
        ("[[disc]]\ncentre = [3.0, 15.0]\nradius = nan", "disc[5].radius = nan: must be"),
        (
            "[[disc]]\ncentre = [3.0, 150.0]\nradius = 1.0",
            "disc[5].centre = [3.0, 150.0]: must be finite and at most 100",
        ),
        ("[[disc]]\nradius = 1.0", "disc[5].centre: is missing"),
        ("[[disc]]\ncentre = [3.0, 15.0]\nradius = 1.0\nturn_deg = [0.0, 1.0]", "disc[5].turn_deg: unknown key"),
        (
            "[[disc]]\ncentre = [9.0, 9.5]\nradius = 0.6",
            "target[0].path[1] = [16.0, 9.0]: the straight way from the point before it meets disc[5]",
        ),
        (
            "[[disc]]\ncentre = [2.0, 9.5]\nradius = 0.6",
            "target[0].path[0] = [2.0, 9.0]: is inside disc[5] (counted from 0); move the target or the disc",
        ),
        (
            "[[disc]]\ncentre = [3.0, 15.0]\nradius = 1.0\npath = [[3.0, 15.0], [15.0, 4.0]]",
            "disc[5]: this wall runs into target[0] (counted from 0) at time",
        ),
        ("[[disc]]\ncentre = [3.0, 15.0]\nradius = 1.0\npath = [[3.0, 15.0]]", "disc[5].path: one point is no way"),
        ("[[disc]]\ncentre = [3.0, 15.0]\nradius = 1.0\ntimes = [0.0]", "disc[5].times: times are of a path"),
    ] {
        let shown = error(more);
        assert!(shown.contains(words), "{shown}\n{words}");
    }
    let crowd = "[[disc]]\ncentre = [3.0, 15.0]\nradius = 0.1\n".repeat(308);
    let shown = error(&crowd);
    assert!(shown.contains("disc[312].radius = 0.1: with this one the walls have more than 20000 points"), "{shown}");
}
