//! Where robots begin, and targets that evade them.

use super::*;

fn with(more: &str) -> Result<Scenario, InputError> {
    Scenario::parse(&format!("{CHANNEL}\n{more}\n"))
}

fn evading(evade: &str) -> Result<Scenario, InputError> {
    let line = "path = [[3.0000, 10.0000], [17.0000, 10.0000]]";
    Scenario::parse(&CHANNEL.replace(line, &format!("{line}\nevade = {{ {evade} }}")))
}

#[test]
fn starts_and_evasions_round_trip_and_scale() {
    for more in
        ["[start]\ncentre = [3.0, 9.0]\nradius = 2.0", "[start]\npositions = [[2.0, 8.0], [2.0, 9.0], [2.5, 10.0]]"]
    {
        let world = with(more).unwrap();
        assert!(world.to_toml().contains(more), "{}", world.to_toml());
        assert_eq!(Scenario::parse(&world.to_toml()).unwrap(), world);
        let through_serde: Scenario = toml::from_str(&toml::to_string(&world).unwrap()).unwrap();
        assert_eq!(through_serde, world);
    }
    let start = with("[start]\ncentre = [3.0, 9.0]\nradius = 2.0").unwrap().scaled(0.5);
    assert_eq!(start.start(), Some(&Start::Within(Disc { centre: Vector::new(1.5, 4.5), radius: 1.0 })));
    let world = evading("distance = 1.2, reach = 0.5, speed = 0.25").unwrap();
    assert_eq!(Scenario::parse(&world.to_toml()).unwrap(), world);
    assert_eq!(world.scaled(0.5).targets()[0].evasion(), Some(Evasion { distance: 0.6, reach: 0.25, speed: 0.25 }));
    assert_eq!(channel().start(), None);
}

#[test]
fn wrong_starts_are_refused_where_they_stand() {
    for (more, words) in [
        ("[start]\ncentre = [3.0, 9.0]", "28:1: start: give centre and radius"),
        ("[start]\ncentre = [3.0, 9.0]\nradius = 1.0\npositions = [[2.0, 8.0]]", "28:1: start: give centre and radius"),
        ("[start]", "28:1: start: give centre and radius"),
        ("[start]\ncentre = [3.0, 29.0]\nradius = 1.0", "29:10: start.centre = [3.0, 29.0]: must lie in the region"),
        ("[start]\ncentre = [3.0, 9.0]\nradius = -1.0", "30:10: start.radius = -1.0: must be a number from 0.01"),
        ("[start]\ncentre = [9.0, 16.0]\nradius = 1.0", "29:10: start.centre = [9.0, 16.0]: is inside a wall"),
        ("[start]\npositions = []", "29:13: start.positions = []: 1 to 1000 places"),
        ("[start]\npositions = [[2.0, 8.0], [9.0, 16.0]]", "29:26: start.positions[1] = [9.0, 16.0]: is inside a wall"),
        ("[start]\nplaces = [[2.0, 8.0]]", "29:1: start.places: unknown key"),
    ] {
        let shown = with(more).map(|_| ()).unwrap_err().to_string();
        assert!(shown.contains(words), "{shown}\n{words}");
    }
}

#[test]
fn a_target_may_evade_as_far_as_it_has_room() {
    // The channel's walls are 4 m from the path.
    assert!(evading("distance = 1.0, reach = 2.95, speed = 1.0").is_ok());
    for (evade, words) in [
        (
            "distance = 1.0, reach = 3.01, speed = 1.0",
            "target[0].evade.reach = 3.01: the path comes within 3.00 metres",
        ),
        (
            "distance = -1.0, reach = 1.0, speed = 1.0",
            "target[0].evade.distance = -1.0: must be a number from 0 to 100",
        ),
        ("distance = 1.0, reach = 1.0, speed = 3.0", "target[0].evade.speed = 3.0: must be a number from 0.01 to 2"),
        ("distance = 1.0, reach = 1.0", "target[0].evade.speed: is missing"),
    ] {
        let shown = evading(evade).map(|_| ()).unwrap_err().to_string();
        assert!(shown.contains(words), "{shown}\n{words}");
    }
    let column = "[[disc]]\ncentre = [9.0, 12.0]\nradius = 1.0\npath = [[9.0, 12.0], [9.0, 11.5]]\n";
    let world = evading("distance = 1.0, reach = 0.9, speed = 1.0").unwrap().to_toml() + "\n" + column;
    let shown = Scenario::parse(&world).map(|_| ()).unwrap_err().to_string();
    assert!(shown.contains("target[0].evade.reach = 0.9: at time") && shown.contains("from a wall"), "{shown}");
}
