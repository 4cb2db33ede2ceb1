//! The front: complexity against pattern error, with knees.

use crate::canvas::error::{FigureError, finite, within};
use crate::canvas::paint::{Anchor, Font, Mark, Paint, Rect};
use crate::canvas::style::{COLUMN, DATA, GREY, INK, LABEL, SMALL, THIN, VERMILLION};
use crate::canvas::svg::Svg;
use crate::canvas::text::width;
use crate::chart::axes::{Chart, Line};
use crate::chart::legend::{Key, legend};
use crate::chart::place::Taken;
use crate::pareto::data::{KneeKind, ParetoPoint, Reference};
use crate::pareto::front::{Label, complexity, error_axis, front, staircase};

/// What an f2 can be: the formula's sums of sigmoids stay below 3.
const F2: (f64, f64) = (0.0, 1000.0);

/// Draws the final population, one column wide: the non-dominated feasible solutions joined by their
/// staircase, the others in light grey, knees marked and labelled with their expression. f2 is on a
/// logarithmic scale where it spans more than a factor of ten.
///
/// # Errors
/// No feasible point, an f2 that is not finite or not in 0 to 1000, no nodes, an infeasible knee.
pub fn pareto(points: &[ParetoPoint], title: &str, reference: Option<&Reference>) -> Result<String, FigureError> {
    finite("f2 of point", points.iter().map(|p| p.f2))?;
    within("f2 of point", points.iter().map(|p| p.f2), F2, "from 0 to 1000")?;
    let expected = "of at least one node, and feasible if it is a knee";
    let bad = |p: &ParetoPoint| p.nodes == 0 || (p.knee.is_some() && !p.feasible);
    if let Some(index) = points.iter().position(bad) {
        return Err(FigureError::OutOfRange { what: "point", index, expected });
    }
    finite("f2 of reference", reference.map(|r| r.f2))?;
    within("f2 of reference", reference.map(|r| r.f2), F2, "from 0 to 1000")?;
    let front = front(points);
    if front.is_empty() {
        return Err(FigureError::Empty { what: "feasible solutions" });
    }
    let mut svg = Svg::default();
    let mut top = 6.0;
    if !title.is_empty() {
        svg.text(title, (COLUMN / 2.0, 11.0), &Font::new(LABEL, Anchor::Middle).bold());
        top = 18.0;
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
    let mut lines = vec![Line { points: stairs.clone(), colour: INK, width: DATA * 0.8, dash: &[] }];
    if let Some(r) = reference {
        let at = chart.y.at(r.f2);
        lines.push(Line {
            points: vec![(chart.x.lo, at), (chart.x.hi, at)],
            colour: GREY,
            width: THIN,
            dash: &[3.0, 2.0],
        });
    }
    chart.draw(&mut svg, &lines)?;
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
        svg.open(if p.knee.is_some() { "knee" } else { "front" }, &p.label);
        let (mark, r, paint) = front_look(p.knee);
        svg.mark(mark, place(p), r, &paint);
        svg.close();
    }
    // The most complex first: its label can go to the right, which leaves the rest room above.
    for p in front.iter().rev().map(|&i| &points[i]).filter(|p| p.knee.is_some()) {
        if let Some(label) = Label::fit(&p.label, place(p), &taken) {
            label.draw(&mut svg);
            label.take(&mut taken);
        }
    }
    Ok(svg.finish(COLUMN, rect.bottom() + 28.0))
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

fn other_look(feasible: bool) -> (Mark, f64, Paint) {
    if feasible {
        (Mark::Circle, 1.7, Paint::fill("#C4C4C4"))
    } else {
        (Mark::Cross, 1.6, Paint::stroke("#B0B0B0", 0.7))
    }
}

fn front_look(knee: Option<KneeKind>) -> (Mark, f64, Paint) {
    match knee {
        Some(kind) => (kind.mark(), 3.2, Paint::stroke(INK, THIN).filled(VERMILLION)),
        None => (Mark::Circle, 2.4, Paint::stroke(INK, 0.9).filled("#FFFFFF")),
    }
}

fn entries(points: &[ParetoPoint], front: &[usize]) -> Vec<(Key, &'static str)> {
    let mut entries = Vec::new();
    let mut add = |look: (Mark, f64, Paint), words| entries.push((Key::Mark(look.0, look.1, look.2), words));
    if front.iter().any(|&i| points[i].knee.is_none()) {
        add(front_look(None), "non-dominated");
    }
    let kinds = [KneeKind::Both, KneeKind::Angle, KneeKind::Utility];
    let present = |kind: &KneeKind| front.iter().any(|&i| points[i].knee == Some(*kind));
    let present: Vec<KneeKind> = kinds.into_iter().filter(present).collect();
    for &kind in &present {
        let only = kind == KneeKind::Both && present.len() == 1;
        add(front_look(Some(kind)), if only { "knee" } else { kind.words() });
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

    fn point(nodes: u32, f2: f64, feasible: bool, knee: Option<KneeKind>, label: &str) -> ParetoPoint {
        ParetoPoint { nodes, f2, feasible, knee, label: label.to_owned() }
    }

    fn sample() -> Vec<ParetoPoint> {
        vec![
            point(7, 0.0140, true, None, "ANDN(x1,x2)"),
            point(3, 0.31, true, None, "XOR(x1,x2)"),
            point(5, 0.0152, true, Some(KneeKind::Both), "XNOR(NAND(x1,x1),x2)"),
            point(5, 0.2, true, None, "a & b <c>"),
            point(9, 0.1, false, None, ""),
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
        assert!(document.says("XNOR(NAND(x1,x1),x2)"));
        assert!(document.says("perfect circle"));
        assert!(document.says("T & <1>"));
        assert_eq!(document.count("class=\"knee\""), 1);
        assert_eq!(document.count("class=\"front\""), 2);
        assert!(document.says("5") && document.says("0.1"), "ticks");
    }

    #[test]
    fn one_point_and_zero_error_can_be_drawn() {
        read(&pareto(&[point(1, 0.0, true, None, "x1")], "", None).unwrap());
        read(&pareto(&[point(1, 0.0, true, None, "x1"), point(1, 3.0, true, None, "")], "", None).unwrap());
    }

    #[test]
    fn bad_data_is_named() {
        let empty = FigureError::Empty { what: "feasible solutions" };
        assert_eq!(pareto(&[], "", None), Err(empty.clone()));
        assert_eq!(pareto(&[point(3, 0.1, false, None, "")], "", None), Err(empty));
        let mut points = sample();
        points[3].f2 = f64::NAN;
        assert_eq!(pareto(&points, "", None), Err(FigureError::NotFinite { what: "f2 of point", index: 3 }));
        points[3].f2 = -1.0;
        assert!(matches!(pareto(&points, "", None), Err(FigureError::OutOfRange { index: 3, .. })));
    }
}
