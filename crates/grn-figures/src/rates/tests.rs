use super::*;
use crate::canvas::style::PAGE_HEIGHT;
use crate::chart::check::read;

fn row(label: &str, successes: u64, trials: u64, interval: (f64, f64)) -> RateRow {
    RateRow { label: label.to_owned(), successes, trials, interval: Some(interval) }
}

fn figure() -> RatesFigure {
    let rows = vec![row("EH-GRN, structure 1", 15, 30, (0.25, 0.75)), row("<a> & b", 30, 30, (0.887, 1.0))];
    let first = RateGroup { title: "Compound channel".into(), rows };
    let second = RateGroup { title: String::new(), rows: vec![row("", 0, 9, (0.0, 0.1))] };
    RatesFigure { groups: vec![first, second], x_label: "Success rate (%)".into() }
}

#[test]
fn rates_are_written_and_stand_on_the_axis() {
    let pages = rates(&figure()).unwrap();
    assert_eq!(pages, rates(&figure()).unwrap());
    let document = read(&pages[0]);
    for words in ["EH-GRN, structure 1", "50 % (25–75)", "100 % (89–100)", "0 % (0–10)", "Compound channel"] {
        assert!(document.says(words), "{words}");
    }
    assert_eq!(document.count("class=\"rate\""), 3);
    let dots: Vec<f64> = document
        .tags
        .iter()
        .filter_map(|tag| tag.strip_prefix("circle cx=\""))
        .map(|tag| tag.split('"').next().unwrap().parse().unwrap())
        .collect();
    let [half, all, none] = dots[..] else { panic!("{dots:?}") };
    assert!((all - (COLUMN - NUMBERS)).abs() < 0.02, "100 % is at the axis's end");
    assert!((half - (all + none) / 2.0).abs() < 0.02);
}

#[test]
fn one_trial_is_one_of_one_and_has_no_interval() {
    let rows = vec![RateRow { label: "given".into(), successes: 1, trials: 1, interval: None }];
    let figure = RatesFigure { groups: vec![RateGroup { title: String::new(), rows }], x_label: String::new() };
    let document = read(&rates(&figure).unwrap()[0]);
    assert!(document.says("1 of 1") && !document.texts.iter().any(|text| text.contains("100–100")));
}

#[test]
fn what_is_too_much_for_a_page_goes_on_overleaf() {
    let group = |title: &str, count: usize| RateGroup {
        title: title.into(),
        rows: (0..count).map(|index| row(&format!("{title}{index}"), 1, 2, (0.4, 0.6))).collect(),
    };
    let groups = vec![group("a", 30), group("b", 13), group("c", 60)];
    let found = pages(&groups);
    let titles = |page: &Vec<RateGroup>| page.iter().map(|group| group.title.clone()).collect::<Vec<_>>();
    assert_eq!(found.iter().map(titles).collect::<Vec<_>>(), [vec!["a", "b"], vec!["b", "c"], vec!["c"]]);
    assert!(found.iter().all(|page| height(page) + 32.0 <= PAGE_HEIGHT + 2.0));
    let rows = |groups: Vec<RateGroup>| groups.into_iter().flat_map(|group| group.rows).collect::<Vec<_>>();
    assert_eq!(found.into_iter().flat_map(rows).collect::<Vec<_>>(), rows(groups.clone()));
    let documents = rates(&RatesFigure { groups, x_label: "%".into() }).unwrap();
    assert_eq!(documents.iter().map(|page| read(page).count("class=\"rate\"")).sum::<usize>(), 103);
}

#[test]
fn without_a_trial_the_figure_says_so() {
    let none = RatesFigure { groups: Vec::new(), x_label: String::new() };
    assert!(read(&rates(&none).unwrap()[0]).texts.concat().starts_with("Nothing to draw"));
}

#[test]
fn bad_data_is_named() {
    let change = |edit: fn(&mut RatesFigure)| {
        let mut figure = figure();
        edit(&mut figure);
        rates(&figure)
    };
    let nan = change(|f| f.groups[1].rows[0].interval = Some((f64::NAN, 1.0)));
    assert_eq!(nan, Err(FigureError::NotFinite { what: "rate of row", index: 2 }));
    let percent = change(|f| f.groups[0].rows[1].interval = Some((0.9, 100.0)));
    assert_eq!(percent, Err(FigureError::OutOfRange { what: "rate of row", index: 1, expected: "from 0 to 1" }));
    let outside = change(|f| f.groups[0].rows[0].successes = 1);
    assert!(matches!(outside, Err(FigureError::OutOfRange { index: 0, expected: "within its interval", .. })));
    let many = change(|f| f.groups[0].rows[0].successes = 31);
    assert!(matches!(many, Err(FigureError::OutOfRange { index: 0, .. })));
}
