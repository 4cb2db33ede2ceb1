//! The front: complexity against pattern error, with knees.

use super::axes::{Axis, Chart, Line};
use super::error::{FigureError, finite};
use super::style::{COLUMN, DATA, GREY, INK, LABEL, SMALL, THIN, VERMILLION};
use super::svg::{Anchor, Font, Key, Mark, Paint, Rect, Svg, legend};
use super::text::{width, wrap};

/// By which measure a point is a knee.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KneeKind {
    /// The angle between its neighbours (Branke et al. 2004, section 3.1).
    Angle,
    /// The expected marginal utility (Branke et al. 2004, section 3.2).
    Utility,
    /// Both.
    Both,
}

impl KneeKind {
    fn words(self) -> &'static str {
        match self {
            Self::Angle => "knee (angle)",
            Self::Utility => "knee (utility)",
            Self::Both => "knee",
        }
    }

    fn mark(self) -> Mark {
        match self {
            Self::Angle => Mark::Triangle,
            Self::Utility => Mark::Square,
            Self::Both => Mark::Diamond,
        }
    }
}

/// A solution of the final population.
#[derive(Debug, Clone, PartialEq)]
pub struct ParetoPoint {
    /// Objective f1: nodes of the tree, functions and terminals.
    pub nodes: u32,
    /// Objective f2: pattern error, dimensionless, 0 or more.
    pub f2: f64,
    /// Whether every target is enclosed and every obstacle cleared.
    pub feasible: bool,
    /// Whether it is a knee of the front.
    pub knee: Option<KneeKind>,
    /// Its expression, written beside a knee.
    pub label: String,
}

/// A horizontal line to compare with, such as the error of a perfect circle.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Its f2.
    pub f2: f64,
    /// What it is.
    pub label: String,
}

/// Draws the final population, one column wide: the non-dominated feasible solutions joined by their
/// staircase, the others in light grey, knees marked and labelled with their expression. f2 is on a
/// logarithmic scale where it spans more than a factor of ten.
///
/// # Errors
/// No feasible point, an f2 that is not finite or below 0, no nodes.
pub fn pareto(
    points: &[ParetoPoint],
    title: &str,
    reference: Option<&Reference>,
) -> Result<String, FigureError> {
    finite("f2 of point", points.iter().map(|p| p.f2))?;
    finite("f2 of the reference", reference.iter().map(|r| r.f2))?;
    let bad = |p: &ParetoPoint| p.f2 < 0.0 || p.nodes == 0;
    if let Some(index) = points.iter().position(bad) {
        return Err(FigureError::OutOfRange {
            what: "point",
            index,
            expected: "of at least one node and f2 0",
        });
    }
    let front = front(points);
    if front.is_empty() {
        return Err(FigureError::Empty {
            what: "feasible solutions",
        });
    }
    let mut svg = Svg::default();
    let mut top = 6.0;
    if !title.is_empty() {
        svg.text(
            title,
            (COLUMN / 2.0, 11.0),
            &Font::new(LABEL, Anchor::Middle).bold(),
        );
        top = 18.0;
    }
    let entries = entries(points, &front);
    let (base, _) = legend(&mut svg, 40.0, top + 6.0, COLUMN - 4.0, SMALL, &entries);
    let rect = Rect::new(40.0, base + 8.0, COLUMN - 48.0, 140.0);
    let chart = Chart {
        rect,
        x: complexity(points),
        y: error_axis(points, reference),
        x_label: "Complexity f₁ (tree nodes)",
        y_label: "Pattern error f₂ (–)",
        x_numbers: true,
    };
    let stairs = staircase(points, &front, &chart);
    let mut lines = vec![Line {
        points: stairs.clone(),
        colour: INK,
        width: DATA * 0.8,
        dash: &[],
    }];
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
    let place = |p: &ParetoPoint| chart.place(f64::from(p.nodes), p.f2.max(floor(points)));
    for (i, p) in points
        .iter()
        .enumerate()
        .filter(|(i, _)| !front.contains(i))
    {
        let _ = i;
        let (mark, r, paint) = other_look(p.feasible);
        svg.mark(mark, place(p), r, &paint);
    }
    let mut taken: Vec<(Rect, f64)> = points
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let (x, y) = place(p);
            (
                Rect::new(x - 3.5, y - 3.5, 7.0, 7.0),
                if front.contains(&i) { 12.0 } else { 1.0 },
            )
        })
        .collect();
    for pair in stairs.windows(2) {
        let on_paper = |c: (f64, f64)| {
            let (x, y) = (c.0 - chart.x.lo, c.1 - chart.y.lo);
            (
                rect.x + x / (chart.x.hi - chart.x.lo) * rect.w,
                rect.bottom() - y / (chart.y.hi - chart.y.lo) * rect.h,
            )
        };
        let (a, b) = (on_paper(pair[0]), on_paper(pair[1]));
        let (x, y) = (a.0.min(b.0) - 1.0, a.1.min(b.1) - 1.0);
        taken.push((
            Rect::new(x, y, (a.0 - b.0).abs() + 2.0, (a.1 - b.1).abs() + 2.0),
            6.0,
        ));
    }
    if let Some(r) = reference {
        let y = chart.place(chart.x.lo, r.f2).1;
        let w = width(&r.label, SMALL, false);
        svg.text(
            &r.label,
            (rect.right() - 2.0, y - 2.5),
            &Font::new(SMALL, Anchor::End).colour(GREY),
        );
        taken.push((Rect::new(rect.right() - 2.0 - w, y - 9.0, w, 11.0), 12.0));
        taken.push((Rect::new(rect.x, y - 1.0, rect.w, 2.0), 6.0));
    }
    for &i in &front {
        let p = &points[i];
        svg.open(if p.knee.is_some() { "knee" } else { "front" }, &p.label);
        let (mark, r, paint) = front_look(p.knee);
        svg.mark(mark, place(p), r, &paint);
        if p.knee.is_some() {
            let label = Label::fit(&p.label, place(p), &rect, &taken);
            label.draw(&mut svg, place(p));
            taken.push((label.rect, 30.0));
        }
        svg.close();
    }
    Ok(svg.finish(COLUMN, rect.bottom() + 28.0))
}

/// Indices of the feasible points that no other dominates, one for each complexity, simplest first.
fn front(points: &[ParetoPoint]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].feasible).collect();
    let knee_last = |i: usize| points[i].knee.is_none();
    order.sort_by(|&a, &b| {
        let (p, q) = (&points[a], &points[b]);
        p.nodes
            .cmp(&q.nodes)
            .then(p.f2.total_cmp(&q.f2))
            .then(knee_last(a).cmp(&knee_last(b)))
            .then(a.cmp(&b))
    });
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let keep = points[i].f2 < best;
        best = best.min(points[i].f2);
        keep
    });
    // A knee the caller chose is shown even if this rule would not have it.
    for i in (0..points.len()).filter(|&i| points[i].knee.is_some() && points[i].feasible) {
        if !order.contains(&i) {
            order.push(i);
        }
    }
    order
}

/// The least f2 above 0 that is drawn: a logarithm has no place for 0.
fn floor(points: &[ParetoPoint]) -> f64 {
    points
        .iter()
        .map(|p| p.f2)
        .filter(|f| *f > 0.0)
        .fold(f64::INFINITY, f64::min)
        .min(1.0)
        / 2.0
}

fn complexity(points: &[ParetoPoint]) -> Axis {
    let nodes = points.iter().map(|p| f64::from(p.nodes));
    let (lo, hi) = nodes.fold((f64::INFINITY, 0.0_f64), |(lo, hi), n| {
        (lo.min(n), hi.max(n))
    });
    let odd = points.iter().all(|p| p.nodes % 2 == 1);
    let least = libm::ceil((hi - lo) / 11.0).max(1.0);
    let mut step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|s| *s >= least)
        .unwrap_or(least);
    let mut axis = Axis::stepped(lo - 0.7, hi + 0.7, step);
    if odd && step <= 2.0 {
        step = 2.0;
        let count = ((hi - lo) / step) as usize;
        axis.ticks = (0..=count)
            .map(|i| lo + i as f64 * step)
            .map(|n| (n, format!("{n:.0}")))
            .collect();
    }
    axis
}

fn error_axis(points: &[ParetoPoint], reference: Option<&Reference>) -> Axis {
    let values = || points.iter().map(|p| p.f2).chain(reference.map(|r| r.f2));
    let hi = values().fold(0.0, f64::max);
    let lo = values()
        .map(|f| f.max(floor(points)))
        .fold(f64::INFINITY, f64::min);
    if hi > 10.0 * lo && lo > 0.0 {
        return Axis::logarithmic(lo / libm::pow(hi / lo, 0.08), hi * libm::pow(hi / lo, 0.10));
    }
    let lo = values().fold(f64::INFINITY, f64::min);
    let margin = (hi - lo).max(hi * 0.1).max(1e-6) * 0.12;
    Axis::linear((lo - margin).max(0.0), hi + 1.5 * margin, 5.0)
}

/// The staircase in chart coordinates, from the simplest solution to the right edge.
fn staircase(points: &[ParetoPoint], front: &[usize], chart: &Chart) -> Vec<(f64, f64)> {
    let mut out: Vec<(f64, f64)> = Vec::new();
    let mut best = f64::INFINITY;
    for p in front.iter().map(|&i| &points[i]).filter(|p| p.feasible) {
        let (x, y) = (f64::from(p.nodes), chart.y.at(p.f2.max(floor(points))));
        if y >= best {
            continue;
        }
        out.push((x, if best.is_finite() { best } else { chart.y.hi }));
        out.push((x, y));
        best = y;
    }
    out.push((chart.x.hi, best));
    out
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
        Some(kind) => (
            kind.mark(),
            3.2,
            Paint::stroke(INK, THIN).filled(VERMILLION),
        ),
        None => (Mark::Circle, 2.4, Paint::stroke(INK, 0.9).filled("#FFFFFF")),
    }
}

fn entries(points: &[ParetoPoint], front: &[usize]) -> Vec<(Key, &'static str)> {
    let mut entries = Vec::new();
    let mut add =
        |look: (Mark, f64, Paint), words| entries.push((Key::Mark(look.0, look.1, look.2), words));
    if front.iter().any(|&i| points[i].knee.is_none()) {
        add(front_look(None), "non-dominated");
    }
    for kind in [KneeKind::Both, KneeKind::Angle, KneeKind::Utility] {
        if front.iter().any(|&i| points[i].knee == Some(kind)) {
            add(front_look(Some(kind)), kind.words());
        }
    }
    let others = || {
        points
            .iter()
            .enumerate()
            .filter(|(i, _)| !front.contains(i))
            .map(|(_, p)| p)
    };
    if others().any(|p| p.feasible) {
        add(other_look(true), "dominated");
    }
    if others().any(|p| !p.feasible) {
        add(other_look(false), "infeasible");
    }
    entries
}

/// A knee's expression and where it stands.
struct Label {
    lines: Vec<String>,
    rect: Rect,
}

impl Label {
    /// The place among those around `at`, above and to the right first, that covers least.
    fn fit(text: &str, at: (f64, f64), frame: &Rect, taken: &[(Rect, f64)]) -> Self {
        let mut best: Option<(f64, Self)> = None;
        for limit in [400.0, 130.0, 95.0] {
            let lines = wrap(text, SMALL, limit);
            let w = lines
                .iter()
                .map(|l| width(l, SMALL, false))
                .fold(0.0, f64::max)
                + 3.0;
            let h = lines.len() as f64 * 9.0 + 2.0;
            for (ring, gap) in [6.0, 13.0, 22.0, 34.0, 48.0, 64.0, 80.0]
                .into_iter()
                .enumerate()
            {
                let around = [
                    (at.0 + gap * 0.8, at.1 - gap - h * 0.8),
                    (at.0 + gap, at.1 - h / 2.0),
                    (at.0 + 3.0, at.1 - gap - h),
                    (at.0 - w / 2.0, at.1 - gap - h),
                    (at.0 - w - 3.0, at.1 + gap),
                    (at.0 - gap - w, at.1 - h / 2.0),
                    (at.0 - w / 2.0, at.1 + gap),
                    (at.0 + gap * 0.8, at.1 + gap),
                ];
                for (turn, (x, y)) in around.into_iter().enumerate() {
                    let rect = Rect::new(x, y, w, h);
                    let outside = if frame.holds(&rect) { 0.0 } else { 5000.0 };
                    let covered: f64 = taken
                        .iter()
                        .map(|(r, weight)| r.overlap(&rect) * weight)
                        .sum();
                    let cost = covered
                        + outside
                        + ring as f64 * 7.0
                        + turn as f64
                        + lines.len() as f64 * 3.0;
                    if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                        best = Some((
                            cost,
                            Self {
                                lines: lines.clone(),
                                rect,
                            },
                        ));
                    }
                }
            }
        }
        best.map(|(_, label)| label).unwrap_or(Self {
            lines: vec![],
            rect: Rect::new(at.0, at.1, 0.0, 0.0),
        })
    }

    fn draw(&self, svg: &mut Svg, at: (f64, f64)) {
        let r = &self.rect;
        let near = (
            at.0.clamp(r.x, r.right()),
            at.1.clamp(r.y + 1.0, r.bottom() - 1.0),
        );
        let gap = libm::hypot(near.0 - at.0, near.1 - at.1);
        if gap > 9.0 {
            let start = (
                at.0 + (near.0 - at.0) * 4.5 / gap,
                at.1 + (near.1 - at.1) * 4.5 / gap,
            );
            svg.line(start, near, &Paint::stroke(GREY, 0.5));
        }
        svg.rect(r, 1.5, &Paint::fill("#FFFFFF"));
        for (i, line) in self.lines.iter().enumerate() {
            svg.text(
                line,
                (r.x + 1.5, r.y + 8.0 + 9.0 * i as f64),
                &Font::new(SMALL, Anchor::Start),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::read;
    use super::*;

    fn point(
        nodes: u32,
        f2: f64,
        feasible: bool,
        knee: Option<KneeKind>,
        label: &str,
    ) -> ParetoPoint {
        ParetoPoint {
            nodes,
            f2,
            feasible,
            knee,
            label: label.to_owned(),
        }
    }

    fn sample() -> Vec<ParetoPoint> {
        vec![
            point(7, 0.0140, true, None, "ANDN(x1,x2)"),
            point(3, 0.31, true, None, "XOR(x1,x2)"),
            point(
                5,
                0.0152,
                true,
                Some(KneeKind::Both),
                "XNOR(NAND(x1,x1),x2)",
            ),
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
        let reference = Reference {
            f2: 0.01339,
            label: "perfect circle".into(),
        };
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
        read(
            &pareto(
                &[
                    point(1, 0.0, true, None, "x1"),
                    point(1, 3.0, true, None, ""),
                ],
                "",
                None,
            )
            .unwrap(),
        );
    }

    #[test]
    fn bad_data_is_named() {
        let empty = FigureError::Empty {
            what: "feasible solutions",
        };
        assert_eq!(pareto(&[], "", None), Err(empty.clone()));
        assert_eq!(
            pareto(&[point(3, 0.1, false, None, "")], "", None),
            Err(empty)
        );
        let mut points = sample();
        points[3].f2 = f64::NAN;
        assert_eq!(
            pareto(&points, "", None),
            Err(FigureError::NotFinite {
                what: "f2 of point",
                index: 3
            })
        );
        points[3].f2 = -1.0;
        assert!(matches!(
            pareto(&points, "", None),
            Err(FigureError::OutOfRange { index: 3, .. })
        ));
    }
}
