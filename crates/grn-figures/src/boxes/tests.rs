use super::*;
use crate::chart::check::read;

fn group(label: &str, values: &[f64], infeasible: usize) -> BoxGroup {
    let feasible = values.iter().map(|v| Some(*v));
    BoxGroup { label: label.to_owned(), values: feasible.chain(vec![None; infeasible]).collect() }
}

fn figure(panels: usize) -> BoxFigure {
    let groups = vec![
        group("MOGP, all <motifs>", &[1.0, 2.0, 3.0, 4.0, 5.0, 30.0], 3),
        group("EH-GRN, structure 1", &[2.0, 2.5], 0),
        group("none", &[], 4),
    ];
    let panel = |i| BoxPanel { title: format!("World {i}"), groups: groups.clone() };
    BoxFigure { panels: (0..panels).map(panel).collect(), y_label: "f2 & more".into() }
}

#[test]
fn every_run_is_shown_and_bytes_repeat() {
    let svg = boxes(&figure(2)).unwrap();
    assert_eq!(svg, boxes(&figure(2)).unwrap());
    let document = read(&svg);
    for words in ["World 0", "World 1", "f2 & more", "3 of 9 infeasible", "4 of 4 infeasible", "MOGP, all <motifs>"] {
        assert!(document.texts.concat().replace(' ', "").contains(&words.replace(' ', "")), "{words}");
    }
    assert_eq!(document.count("class=\"group\""), 6);
    assert_eq!(document.count("circle"), 2 * 7, "all feasible runs but the outlier");
    let crosses = format!("stroke=\"{VERMILLION}\" stroke-width=\"0.7\" fill-rule");
    assert_eq!(document.count(&crosses), 2 * (2 * 7 + 1), "two strokes for each cross, one for the outlier");
}

#[test]
fn the_box_stands_at_the_quartiles() {
    let values: Vec<f64> = (0..=8).map(f64::from).collect();
    let panel = BoxPanel { title: String::new(), groups: vec![group("a", &values, 0)] };
    let svg = boxes(&BoxFigure { panels: vec![panel], y_label: String::new() }).unwrap();
    let tag = read(&svg).tags.into_iter().find(|tag| tag.contains(BLUE_TINT)).unwrap();
    let number = |name: &str| -> f64 {
        let from = tag.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
        tag[from..].split('"').next().unwrap().parse().unwrap()
    };
    // The axis ends 6 % of the values' span above them, and at 0 below.
    let scale = HEIGHT / (8.0 + 0.06 * 8.0);
    assert!((number("height") - 4.0 * scale).abs() < 0.02);
    assert!((number("y") - (15.0 + HEIGHT - 6.0 * scale)).abs() < 0.02);
}

#[test]
fn names_with_a_wide_word_stand_upright_within_the_figure() {
    let name = "Strukturauswahlverfahren, zweites";
    let many = vec![group(name, &[1.0, 2.0], 1); 12];
    let panel = BoxPanel { title: String::new(), groups: many };
    let svg = boxes(&BoxFigure { panels: vec![panel], y_label: String::new() }).unwrap();
    let document = read(&svg);
    assert_eq!(document.count("rotate(-90"), 12 + 2, "the names, and the words of an axis");
    assert_eq!(document.texts.iter().filter(|text| *text == name).count(), 2 * 12, "whole, and as titles");
    let height = |tag: &String| tag.split("height=\"").nth(1).and_then(|rest| rest.split('p').next()?.parse().ok());
    let found: f64 = document.tags.first().and_then(height).unwrap();
    assert!(found > HEIGHT + width(name, SMALL, false) + 12.0);
}

#[test]
fn points_are_spread_evenly() {
    let mut places: Vec<f64> = (0..30).map(spread).collect();
    places.sort_by(f64::total_cmp);
    assert!(places[0] >= -0.5 && places[29] < 0.5);
    assert!(places.windows(2).all(|pair| pair[1] - pair[0] > 0.01 && pair[1] - pair[0] < 0.07));
}

#[test]
fn bad_data_is_named() {
    let change = |edit: fn(&mut BoxFigure)| {
        let mut figure = figure(1);
        edit(&mut figure);
        boxes(&figure)
    };
    assert_eq!(change(|f| f.panels.clear()), Err(FigureError::Empty { what: "panels" }));
    assert_eq!(change(|f| f.panels[0].groups.clear()), Err(FigureError::Empty { what: "groups in a panel" }));
    assert_eq!(change(|f| f.panels[0].groups[1].values.clear()), Err(FigureError::Empty { what: "runs in a group" }));
    let nan = change(|f| f.panels[0].groups[0].values[4] = Some(f64::NAN));
    assert_eq!(nan, Err(FigureError::NotFinite { what: "value of run", index: 4 }));
    let groups = change(|f| f.panels[0].groups = vec![f.panels[0].groups[0].clone(); 13]);
    assert_eq!(groups, Err(FigureError::TooMany { what: "groups", found: 13, limit: 12 }));
    assert!(matches!(boxes(&figure(40)), Err(FigureError::TooMany { what: "panels", found: 40, .. })));
}
