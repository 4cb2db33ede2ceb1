use super::*;
use crate::chart::check::read;

fn quartiles(median: f64) -> Quartiles {
    Quartiles { lower: median * 0.5, median, upper: median * 2.0 }
}

fn figure(panels: usize, labels: &[&str]) -> ConvergenceFigure {
    let points: Vec<(u64, Quartiles)> = (1..=20).map(|i| (i * 1000, quartiles(1.0 / i as f64))).collect();
    let series = |label: &&str| ConvergenceSeries { label: (*label).to_owned(), points: points.clone() };
    let panel = |i| ConvergencePanel { title: format!("World {i}"), series: labels.iter().map(series).collect() };
    ConvergenceFigure { panels: (0..panels).map(panel).collect(), y_label: "f2 <best>".into() }
}

#[test]
fn each_series_is_a_line_and_a_band_named_once() {
    let figure = figure(4, &["MOGP, all motifs", "a & b"]);
    let pages = convergence(&figure).unwrap();
    assert_eq!(pages, convergence(&figure).unwrap());
    let [page] = &pages[..] else { panic!("{} pages", pages.len()) };
    let document = read(page);
    assert_eq!(document.count("fill-opacity"), 8);
    let words = |words: &str| document.texts.iter().filter(|text| *text == words).count();
    assert_eq!(words("a & b"), 1 + 4, "the legend, and the title of each band");
    assert_eq!(words("f2 <best>"), 2, "beside each row");
    assert_eq!(words("Evaluations of f2 (thousands)"), 4);
    assert_eq!(words("World 3"), 1);
}

#[test]
fn a_history_of_one_generation_is_a_mark() {
    let series = |label: &str| ConvergenceSeries { label: label.into(), points: vec![(800, quartiles(0.4))] };
    let panels = vec![ConvergencePanel { title: String::new(), series: vec![series("a"), series("b")] }];
    let pages = convergence(&ConvergenceFigure { panels, y_label: String::new() }).unwrap();
    let document = read(&pages[0]);
    assert_eq!(document.count("class=\"point\""), 2);
    assert_eq!(document.count("circle"), 1 + 1, "and the legend");
    assert!(document.says("800"), "the axis has a number at or near it: {:?}", document.texts);
}

#[test]
fn zero_evaluations_and_zero_values_can_be_drawn() {
    let series = vec![ConvergenceSeries { label: "a".into(), points: vec![(0, quartiles(0.0))] }];
    let panels = vec![ConvergencePanel { title: String::new(), series }];
    read(&convergence(&ConvergenceFigure { panels, y_label: String::new() }).unwrap()[0]);
}

#[test]
fn many_panels_and_many_series_go_on_overleaf() {
    let names: Vec<String> = (0..40).map(|i| format!("method {i}")).collect();
    let labels: Vec<&str> = names.iter().map(String::as_str).collect();
    let pages = convergence(&figure(40, &labels)).unwrap();
    assert!(pages.len() > 1);
    let documents: Vec<_> = pages.iter().map(|page| read(page)).collect();
    for i in 0..40 {
        let title = format!("World {i}");
        assert_eq!(documents.iter().filter(|document| document.says(&title)).count(), 1, "{title}");
    }
    assert!(documents.iter().all(|document| document.says("method 39")), "each page has its legend");
    let looks: std::collections::HashSet<_> = (0..36).map(|i| format!("{:?}", series(i))).collect();
    assert_eq!(looks.len(), 36, "up to 36 series differ");
}

#[test]
fn without_a_generation_the_figure_says_so() {
    let empty = ConvergenceSeries { label: "a".into(), points: Vec::new() };
    for panels in [vec![], vec![ConvergencePanel { title: "World".into(), series: vec![empty] }]] {
        let pages = convergence(&ConvergenceFigure { panels, y_label: String::new() }).unwrap();
        assert!(read(&pages[0]).texts.concat().starts_with("Nothing to draw"));
    }
}

#[test]
fn bad_data_is_named() {
    let change = |edit: fn(&mut ConvergenceFigure)| {
        let mut figure = figure(1, &["a", "b"]);
        edit(&mut figure);
        convergence(&figure)
    };
    let nan = change(|f| f.panels[0].series[1].points[3].1.median = f64::NAN);
    assert_eq!(nan, Err(FigureError::NotFinite { what: "quartile of point", index: 3 }));
    let order = change(|f| f.panels[0].series[1].points[3].1.lower = 9.0);
    assert!(matches!(order, Err(FigureError::OutOfRange { what: "quartiles of point", index: 3, .. })));
    let back = change(|f| f.panels[0].series[0].points[5].0 = 4000);
    assert!(matches!(back, Err(FigureError::OutOfRange { what: "evaluations of point", index: 5, .. })));
}
