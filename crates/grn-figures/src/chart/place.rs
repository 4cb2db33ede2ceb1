//! Where a label stands: the place among several that covers least of what is drawn already.

use crate::canvas::paint::Rect;

/// What is drawn already, each area with the cost of a square point of it covered.
#[derive(Debug)]
pub(crate) struct Taken {
    frame: Rect,
    areas: Vec<(Rect, f64)>,
}

/// Cost of leaving the frame: more than any cover.
const OUTSIDE: f64 = 1e5;

impl Taken {
    pub fn new(frame: Rect) -> Self {
        Self { frame, areas: Vec::new() }
    }

    pub fn add(&mut self, area: Rect, cost: f64) {
        self.areas.push((area, cost));
    }

    /// Adds a mark with all within `r` of its middle.
    pub fn add_mark(&mut self, at: (f64, f64), r: f64, cost: f64) {
        self.add(Rect::new(at.0 - r, at.1 - r, 2.0 * r, 2.0 * r), cost);
    }

    /// Adds a line as a chain of small squares.
    pub fn add_line(&mut self, from: (f64, f64), to: (f64, f64), cost: f64) {
        for at in steps(from, to) {
            self.add_mark(at, 1.0, cost);
        }
    }

    /// What a label at `rect` would cost.
    pub fn cost(&self, rect: &Rect) -> f64 {
        let covered: f64 = self.areas.iter().map(|(area, cost)| area.overlap(rect) * cost).sum();
        if self.frame.holds(rect) { covered } else { covered + OUTSIDE }
    }

    /// What a thin line would cost: as if it were two points wide.
    pub fn line_cost(&self, from: (f64, f64), to: (f64, f64)) -> f64 {
        let square = |at: (f64, f64)| Rect::new(at.0 - 1.0, at.1 - 1.0, 2.0, 2.0);
        steps(from, to).map(|at| self.cost(&square(at))).sum()
    }

    /// The cheapest of some places, each with a cost of its own; the first of equals.
    pub fn cheapest(&self, places: impl IntoIterator<Item = (Rect, f64)>) -> Option<Rect> {
        let mut best: Option<(f64, Rect)> = None;
        for (rect, own) in places {
            let cost = own + self.cost(&rect);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, rect));
            }
        }
        best.map(|(_, rect)| rect)
    }
}

fn steps(from: (f64, f64), to: (f64, f64)) -> impl Iterator<Item = (f64, f64)> {
    let length = libm::hypot(to.0 - from.0, to.1 - from.1);
    let count = (length / 2.0).clamp(1.0, 2000.0) as u32;
    (0..=count).map(move |i| {
        let share = f64::from(i) / f64::from(count);
        (from.0 + (to.0 - from.0) * share, from.1 + (to.1 - from.1) * share)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_free_place_inside_wins() {
        let mut taken = Taken::new(Rect::new(0.0, 0.0, 100.0, 100.0));
        taken.add_line((0.0, 50.0), (100.0, 50.0), 5.0);
        let places = [45.0, -5.0, 20.0, 60.0].map(|y| (Rect::new(10.0, y, 30.0, 10.0), 1.0));
        assert_eq!(taken.cheapest(places), Some(places[2].0));
        assert!(taken.line_cost((50.0, 40.0), (50.0, 60.0)) > 0.0);
        assert_eq!(taken.line_cost((50.0, 10.0), (50.0, 40.0)), 0.0);
        assert_eq!(taken.cheapest([]), None);
    }
}
