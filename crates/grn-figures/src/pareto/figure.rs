//! The front: complexity against pattern error, with knees.

use crate::canvas::error::{FigureError, finite, within};
use crate::canvas::note::nothing_to_draw;
use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::style::{COLUMN, DATA, GREY, INK, LABEL, SMALL, THIN};
use crate::canvas::svg::Svg;
use crate::canvas::text::{BOLD, lines, width};
use crate::chart::axes::{Chart, Line};
use crate::chart::legend::{Key, legend};
use crate::chart::place::Taken;
use crate::pareto::data::{ParetoPoint, Reference, front_look, knee_look, other_look};
use crate::pareto::front::{Label, complexity, error_axis, front, staircase};
use grn_optimisers::knee::Knee;

/// What an f2 can be: the formula's sums of sigmoids stay below 3.
const F2: (f64, f64) = (0.0, 1000.0);

/// Draws the final population, one column wide: the non-dominated feasible solutions joined by their
/// staircase, the others in light grey, knees marked and labelled with their expression. f2 is on a
/// logarithmic scale where it spans more than a factor of ten. Where nothing is feasible the figure says so, and
/// shows the infeasible solutions; an infeasible knee is drawn as an infeasible solution.
///
/// # Errors
/// An f2 that is not finite or not in 0 to 1000, no nodes.
pub fn pareto(points: &[ParetoPoint], title: &str, reference: Option<&Reference>) -> Result<String, FigureError> {
    finite("f2 of point", points.iter().map(|p| p.f2))?;
    within("f2 of point", points.iter().map(|p| p.f2), F2, "from 0 to 1000")?;
    if let Some(index) = points.iter().position(|p| p.nodes == 0) {
        return Err(FigureError::OutOfRange { what: "point", index, expected: "of at least one node" });
    }
    finite("f2 of reference", reference.map(|r| r.f2))?;
    within("f2 of reference", reference.map(|r| r.f2), F2, "from 0 to 1000")?;
    if points.is_empty() {
        return Ok(nothing_to_draw("there is no model"));
    }
    let front = front(points);
    let mut svg = Svg::default();
    let mut top = 6.0;
    for line in lines(title, LABEL * BOLD, COLUMN - 8.0, 3) {
        svg.text(&line, (COLUMN / 2.0, top + 5.0), &Font::new(LABEL, Anchor::Middle).bold());
        top += 11.0;
    }
    let entries = entries(points, &front);
    let y = error_axis(points, reference);
    let left = y.label_distance() + LABEL;
    let (base, _) = legend(&mut svg, left, top + 6.0, COLUMN - 4.0, SMALL, &entries);
    let rect = Rect::new(left, base + 8.0, COLUMN - left - 8.0, 140.0);
    let chart = Chart {
        rect,
        x: complexity(points),
        y,
        x_label: "Complexity f₁ (tree nodes)",
        y_label: "Pattern error f₂ (–)",
        x_numbers: true,
    };
    let stairs = staircase(points, &front, &chart);
    let mut drawn = vec![Line { points: stairs.clone(), colour: INK, width: DATA * 0.8, dash: &[] }];
    if let Some(r) = reference {
        let at = chart.y.at(r.f2);
        drawn.push(Line {
            points: vec![(chart.x.lo, at), (chart.x.hi, at)],
            colour: GREY,
            width: THIN,
            dash: &[3.0, 2.0],
        });
    }
    chart.draw(&mut svg, &drawn)?;
    let mut taken = Taken::new(rect);
    for pair in stairs.windows(2) {
        taken.add_line(chart.on_paper(pair[0]), chart.on_paper(pair[1]), 8.0);
    }
    let place = |p: &ParetoPoint| chart.place(f64::from(p.nodes), p.f2);
    for (i, p) in points.iter().enumerate() {
        if front.contains(&i) {
            taken.add_mark(place(p), 3.5, 12.0);
        } else {
            let (mark, r, paint) = other_look(p.feasible);
            svg.mark(mark, place(p), r, &paint);
            taken.add_mark(place(p), 2.2, 5.0);
        }
    }
    if let Some(r) = reference {
        name_reference(&mut svg, &chart, r, &mut taken);
    }
    for &i in &front {
        let p = &points[i];
        svg.open(if p.is_knee() { "knee" } else { "front" }, &p.label);
        let (mark, r, paint) = front_look(p.knee);
        svg.mark(mark, place(p), r, &paint);
        svg.close();
    }
    // The most complex first: its label can go to the right, which leaves the rest room above.
    for p in front.iter().rev().map(|&i| &points[i]).filter(|p| p.is_knee()) {
        if let Some(label) = Label::fit(&p.label, place(p), &taken) {
            label.draw(&mut svg);
            label.take(&mut taken);
        }
    }
    if front.is_empty() {
        say_infeasible(&mut svg, &chart, &taken);
    }
    Ok(svg.finish(COLUMN, rect.bottom() + 28.0))
}

/// Writes into the chart that no model is feasible, where that covers least.
fn say_infeasible(svg: &mut Svg, chart: &Chart, taken: &Taken) {
    let font = Font::new(LABEL, Anchor::Middle).bold();
    let words = "no model is feasible";
    let (w, h) = (font.width(words) + 8.0, LABEL + 5.0);
    let x = chart.rect.x + (chart.rect.w - w) / 2.0;
    let heights = (0..8).map(|i| chart.rect.y + 4.0 + (chart.rect.h - h - 8.0) * f64::from(i) / 7.0);
    if let Some(rect) = taken.cheapest(heights.map(|y| (Rect::new(x, y, w, h), 0.0))) {
        svg.rect(&rect, 2.0, &Paint::fill("#FFFFFF"));
        svg.text(words, (rect.x + w / 2.0, rect.bottom() - 3.8), &font);
    }
}

/// Writes what a reference line is below or above one of its ends.
fn name_reference(svg: &mut Svg, chart: &Chart, reference: &Reference, taken: &mut Taken) {
    let y = chart.place(chart.x.lo, reference.f2).1;
    let w = width(&reference.label, SMALL, false) + 2.0;
    let (left, right) = (chart.rect.x + 1.0, chart.rect.right() - w - 1.0);
    let places = [(right, y + 1.2), (left, y + 1.2), (right, y - 10.0), (left, y - 10.0)];
    let places = places.map(|(x, top)| (Rect::new(x, top, w, 8.8), 0.0));
    taken.add_line((chart.rect.x, y), (chart.rect.right(), y), 6.0);
    if let Some(rect) = taken.cheapest(places) {
        let font = Font::new(SMALL, Anchor::Start).colour(GREY);
        svg.text(&reference.label, (rect.x + 1.0, rect.y + 6.9), &font);
        taken.add(rect, 20.0);
    }
}

fn entries(points: &[ParetoPoint], front: &[usize]) -> Vec<(Key, &'static str)> {
    let mut entries = Vec::new();
    let mut add = |look: (Mark, f64, Paint), words| entries.push((Key::Mark(look.0, look.1, look.2), words));
    if front.iter().any(|&i| !points[i].is_knee()) {
        add(front_look(Knee::default()), "non-dominated");
    }
    let kinds = [(true, true), (true, false), (false, true)];
    let kinds = kinds.map(|(angle, utility)| Knee { angle, utility, parsimony: false });
    let kinds = [kinds[0], kinds[1], kinds[2], Knee { parsimony: true, ..Knee::default() }];
    let present: Vec<Knee> = kinds.into_iter().filter(|kind| front.iter().any(|&i| points[i].knee == *kind)).collect();
    for &kind in &present {
        let only = kind == kinds[0] && present.len() == 1;
        let words = knee_look(kind).map_or("", |(words, _)| words);
        add(front_look(kind), if only { "knee" } else { words });
    }
    let others = || points.iter().enumerate().filter(|(i, _)| !front.contains(i)).map(|(_, p)| p);
    if others().any(|p| p.feasible) {
        add(other_look(true), "dominated");
    }
    if others().any(|p| !p.feasible) {
        add(other_look(false), "infeasible");
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::check::read;

    const NONE: Knee = Knee { angle: false, utility: false, parsimony: false };
    const BOTH: Knee = Knee { angle: true, utility: true, parsimony: false };

    fn point(nodes: u32, f2: f64, feasible: bool, knee: Knee, label: &str) -> ParetoPoint {
        ParetoPoint { nodes, f2, feasible, knee, label: label.to_owned() }
    }

    fn sample() -> Vec<ParetoPoint> {
        vec![
            point(7, 0.0140, true, NONE, "(ANDN x1 x2)"),
            point(3, 0.31, true, NONE, "(XOR x1 x2)"),
            point(5, 0.0152, true, BOTH, "(XNOR (NAND x1 x1) x2)"),
            point(5, 0.2, true, NONE, "a & b <c>"),
            point(9, 0.1, false, NONE, ""),
        ]
    }

    #[test]
    fn the_front_leaves_out_dominated_and_infeasible_points() {
        assert_eq!(front(&sample()), [1, 2, 0]);
    }

    #[test]
    fn knees_are_labelled_and_bytes_repeat() {
        let reference = Reference { f2: 0.01339, label: "perfect circle".into() };
        let svg = pareto(&sample(), "T & <1>", Some(&reference)).unwrap();
        assert_eq!(svg, pareto(&sample(), "T & <1>", Some(&reference)).unwrap());
        let document = read(&svg);
        assert!(document.says("(XNOR (NAND x1 x1) x2)"));
        assert!(document.says("perfect circle"));
        assert!(document.says("T & <1>"));
        assert_eq!(document.count("class=\"knee\""), 1);
        assert_eq!(document.count("class=\"front\""), 2);
        assert!(document.says("5") && document.says("0.1"), "ticks");
    }

    #[test]
    fn one_point_and_zero_error_can_be_drawn() {
        read(&pareto(&[point(1, 0.0, true, NONE, "x1")], "", None).unwrap());
        read(&pareto(&[point(1, 0.0, true, NONE, "x1"), point(1, 3.0, true, NONE, "")], "", None).unwrap());
    }

    #[test]
    fn a_front_without_a_feasible_model_shows_the_infeasible_ones_and_says_so() {
        let knee = BOTH;
        let document =
            read(&pareto(&[point(3, 0.1, false, knee, ""), point(5, 2.0, false, NONE, "")], "", None).unwrap());
        assert!(document.says("no model is feasible") && document.says("infeasible"));
        assert_eq!(document.count("class=\"knee\""), 0);
        assert_eq!(document.count("stroke=\"#B0B0B0\""), 2 * (2 + 1), "two strokes each, and one in the legend");
        let empty = read(&pareto(&[], "", None).unwrap());
        assert!(empty.texts.concat().starts_with("Nothing to draw"));
    }

    #[test]
    fn bad_data_is_named() {
        let mut points = sample();
        points[3].f2 = f64::NAN;
        assert_eq!(pareto(&points, "", None), Err(FigureError::NotFinite { what: "f2 of point", index: 3 }));
        points[3].f2 = -1.0;
        assert!(matches!(pareto(&points, "", None), Err(FigureError::OutOfRange { index: 3, .. })));
    }
}
