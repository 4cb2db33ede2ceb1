//! Which solutions make the front, the axes that suit them, and the labels of knees.

use crate::canvas::paint::{Anchor, Font, Paint, Rect};
use crate::canvas::style::{GREY, SMALL};
use crate::canvas::svg::Svg;
use crate::canvas::text::{lines, width};
use crate::chart::axes::{Axis, Chart};
use crate::chart::place::Taken;
use crate::pareto::data::{ParetoPoint, Reference};

/// Indices of the feasible points that no other dominates, one for each complexity, simplest first.
pub(crate) fn front(points: &[ParetoPoint]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].feasible).collect();
    let knee_last = |i: usize| !points[i].is_knee();
    order.sort_by(|&a, &b| {
        let (p, q) = (&points[a], &points[b]);
        p.nodes.cmp(&q.nodes).then(p.f2.total_cmp(&q.f2)).then(knee_last(a).cmp(&knee_last(b))).then(a.cmp(&b))
    });
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let keep = points[i].f2 < best;
        best = best.min(points[i].f2);
        keep
    });
    // A knee the caller chose is shown even if this rule would not have it.
    for i in (0..points.len()).filter(|&i| points[i].is_knee()) {
        if !order.contains(&i) {
            order.push(i);
        }
    }
    order
}

/// The axis of f1, with a tick at every size that occurs unless they would stand too close.
pub(crate) fn complexity(points: &[ParetoPoint]) -> Axis {
    let nodes = points.iter().map(|p| f64::from(p.nodes));
    let (lo, hi) = nodes.fold((f64::INFINITY, 0.0_f64), |(lo, hi), n| (lo.min(n), hi.max(n)));
    let odd = points.iter().all(|p| p.nodes % 2 == 1);
    let least = libm::ceil((hi - lo) / 11.0).max(1.0);
    let mut step = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0].into_iter().find(|s| *s >= least).unwrap_or(least);
    let mut axis = Axis::stepped(lo - 0.7, hi + 0.7, step);
    if odd && step <= 2.0 {
        step = 2.0;
        let count = ((hi - lo) / step) as usize;
        axis.ticks = (0..=count).map(|i| lo + i as f64 * step).map(|n| (n, format!("{n:.0}"))).collect();
    }
    axis
}

/// The axis of f2, logarithmic where the values above 0 span more than a factor of ten.
pub(crate) fn error_axis(points: &[ParetoPoint], reference: Option<&Reference>) -> Axis {
    let values = || points.iter().map(|p| p.f2).chain(reference.map(|r| r.f2));
    let hi = values().fold(0.0, f64::max);
    let lo = values().filter(|f| *f > 0.0).fold(f64::INFINITY, f64::min).max(hi * 1e-9);
    if hi > 10.0 * lo && lo > 0.0 {
        // Room below for the words of a reference, which tends to be the least.
        return Axis::logarithmic(lo / libm::pow(hi / lo, 0.11), hi * libm::pow(hi / lo, 0.08));
    }
    let lo = values().fold(f64::INFINITY, f64::min);
    let margin = (hi - lo).max(hi * 0.1).max(1e-6) * 0.14;
    Axis::linear((lo - margin).max(0.0), hi + margin, 5.0)
}

/// The staircase in chart coordinates, from the simplest solution to the right edge.
pub(crate) fn staircase(points: &[ParetoPoint], front: &[usize], chart: &Chart) -> Vec<(f64, f64)> {
    let mut out: Vec<(f64, f64)> = Vec::new();
    let mut best = f64::INFINITY;
    for p in front.iter().map(|&i| &points[i]).filter(|p| p.feasible) {
        let (x, y) = (f64::from(p.nodes), chart.y.at(p.f2));
        if y >= best {
            continue;
        }
        out.push((x, if best.is_finite() { best } else { chart.y.hi }));
        out.push((x, y));
        best = y;
    }
    if best.is_finite() {
        out.push((chart.x.hi, best));
    }
    out
}

/// A knee's expression and where it stands.
pub(crate) struct Label {
    lines: Vec<String>,
    rect: Rect,
    at: (f64, f64),
}

const LINE: f64 = 9.0;

impl Label {
    /// The place around `at`, above and to the right first, that covers least with words and leader.
    pub fn fit(text: &str, at: (f64, f64), taken: &Taken) -> Option<Self> {
        let mut best: Option<(f64, Self)> = None;
        for limit in [170.0, 130.0, 95.0] {
            let lines = lines(text, SMALL, limit, 8);
            let w = lines.iter().map(|l| width(l, SMALL, false)).fold(0.0, f64::max) + 3.0;
            let h = lines.len() as f64 * LINE + 2.0;
            for (ring, gap) in [6.0, 10.0, 15.0, 22.0, 34.0, 48.0, 64.0, 80.0].into_iter().enumerate() {
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
                    let label = Self { lines: lines.clone(), rect: Rect::new(x, y, w, h), at };
                    let leader = label.leader().map_or(0.0, |(from, to)| 0.3 * taken.line_cost(from, to));
                    let own = ring as f64 * 7.0 + turn as f64 + lines.len() as f64 * 3.0;
                    let cost = taken.cost(&label.rect) + leader + own;
                    if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                        best = Some((cost, label));
                    }
                }
            }
        }
        best.map(|(_, label)| label)
    }

    /// The line from the knee to its words, where they are not next to each other.
    fn leader(&self) -> Option<((f64, f64), (f64, f64))> {
        let (r, at) = (&self.rect, self.at);
        let near = (at.0.clamp(r.x, r.right()), at.1.clamp(r.y, r.bottom()));
        let gap = libm::hypot(near.0 - at.0, near.1 - at.1);
        let start = (at.0 + (near.0 - at.0) * 4.8 / gap, at.1 + (near.1 - at.1) * 4.8 / gap);
        (gap > 9.0).then_some((start, near))
    }

    /// Keeps later labels off this one and its leader.
    pub fn take(&self, taken: &mut Taken) {
        taken.add(self.rect, 30.0);
        if let Some((from, to)) = self.leader() {
            taken.add_line(from, to, 30.0);
        }
    }

    pub fn draw(&self, svg: &mut Svg) {
        if let Some((from, to)) = self.leader() {
            svg.line(from, to, &Paint::stroke(GREY, 0.5));
        }
        svg.rect(&self.rect, 1.5, &Paint::fill("#FFFFFF"));
        for (i, line) in self.lines.iter().enumerate() {
            let base = self.rect.y + 8.0 + LINE * i as f64;
            svg.text(line, (self.rect.x + 1.5, base), &Font::new(SMALL, Anchor::Start));
        }
    }
}
