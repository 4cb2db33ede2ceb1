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
    let pages = boxes(&figure(2)).unwrap();
    assert_eq!(pages, boxes(&figure(2)).unwrap());
    let document = read(&pages[0]);
    for words in ["World 0", "World 1", "f2 & more", "3 of 9 infeasible", "4 of 4 infeasible", "MOGP, all <motifs>"] {
        assert!(document.texts.concat().replace(' ', "").contains(&words.replace(' ', "")), "{words}");
    }
    assert_eq!(document.count("class=\"group\""), 6);
    assert_eq!(document.count("circle"), 2 * 7 + 1, "all feasible runs but the outlier, and the legend");
    let crosses = format!("stroke=\"{VERMILLION}\" stroke-width=\"0.7\" fill-rule");
    assert_eq!(document.count(&crosses), 2 * (2 * 7 + 1) + 3, "two strokes a cross, one an outlier, and the legend");
    for words in ["run", "outlier (beyond 1.5 box heights)", "infeasible run"] {
        assert!(document.says(words), "the legend does not explain {words}");
    }
}

#[test]
fn the_box_stands_at_the_quartiles() {
    let values: Vec<f64> = (0..=8).map(f64::from).collect();
    let panel = BoxPanel { title: String::new(), groups: vec![group("a", &values, 0)] };
    let svg = boxes(&BoxFigure { panels: vec![panel], y_label: String::new() }).unwrap();
    let tag = read(&svg[0]).tags.into_iter().find(|tag| tag.contains(BLUE_TINT)).unwrap();
    let number = |name: &str| -> f64 {
        let from = tag.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
        tag[from..].split('"').next().unwrap().parse().unwrap()
    };
    // The axis ends 6 % of the values' span above them, and at 0 below.
    let scale = HEIGHT / (8.0 + 0.06 * 8.0);
    assert!((number("height") - 4.0 * scale).abs() < 0.02);
    assert!((number("y") - (16.0 + 5.0 + HEIGHT - 6.0 * scale)).abs() < 0.02);
}

#[test]
fn names_with_a_wide_word_stand_upright_within_the_figure() {
    let name = "Strukturauswahlverfahren, zweites";
    let many = vec![group(name, &[1.0, 2.0], 1); 12];
    let panel = BoxPanel { title: String::new(), groups: many };
    let pages = boxes(&BoxFigure { panels: vec![panel], y_label: String::new() }).unwrap();
    let document = read(&pages[0]);
    let lines = lines(name, SMALL, UPRIGHT, 9);
    assert_eq!(document.count("rotate(-90"), 12 * lines.len() + 2, "the names, and the words of an axis");
    assert_eq!(document.texts.iter().filter(|text| *text == name).count(), 12, "whole as titles");
    let height = |tag: &String| tag.split("height=\"").nth(1).and_then(|rest| rest.split('p').next()?.parse().ok());
    let found: f64 = document.tags.first().and_then(height).unwrap();
    assert!(found > HEIGHT + lines.iter().map(|line| width(line, SMALL, false)).fold(0.0, f64::max) + 12.0);
}

#[test]
fn few_runs_have_no_box() {
    let panel = |values: &[f64]| BoxPanel { title: String::new(), groups: vec![group("a", values, 0)] };
    let page = |values: &[f64]| {
        let figure = BoxFigure { panels: vec![panel(values)], y_label: String::new() };
        read(&boxes(&figure).unwrap()[0])
    };
    assert_eq!(page(&[1.0, 2.0, 3.0, 4.0]).count(BLUE_TINT), 0);
    assert_eq!(page(&[1.0, 2.0, 3.0, 4.0, 5.0]).count(BLUE_TINT), 1);
    assert_eq!(page(&[1.0]).count("circle"), 2, "one run, and the legend");
}

#[test]
fn many_scenarios_and_methods_go_on_overleaf() {
    let mut figure = figure(40);
    figure.panels[3].groups = (0..25).map(|i| group(&format!("method {i}"), &[1.0, 2.0], 0)).collect();
    let pages = boxes(&figure).unwrap();
    assert!(pages.len() > 1);
    let documents: Vec<_> = pages.iter().map(|page| read(page)).collect();
    let says = |words: &str| documents.iter().filter(|document| document.says(words)).count();
    assert!((0..40).filter(|i| *i != 3).all(|i| says(&format!("World {i}")) == 1));
    assert_eq!((1..=3).map(|part| says(&format!("World 3 ({part} of 3)"))).sum::<usize>(), 3);
    assert_eq!(documents.iter().map(|document| document.count("class=\"group\"")).sum::<usize>(), 39 * 3 + 25);
}

#[test]
fn without_runs_the_figure_says_so() {
    let none = BoxFigure { panels: vec![], y_label: String::new() };
    assert!(read(&boxes(&none).unwrap()[0]).texts.concat().starts_with("Nothing to draw"));
    let mut figure = figure(1);
    figure.panels[0].groups[1].values.clear();
    assert!(read(&boxes(&figure).unwrap()[0]).says("no run"));
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
    let nan = change(|f| f.panels[0].groups[0].values[4] = Some(f64::NAN));
    assert_eq!(nan, Err(FigureError::NotFinite { what: "value of run", index: 4 }));
}
