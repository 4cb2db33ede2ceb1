//! From a model and a moment to the pattern (model page, section 3).

use super::chart::Chart;
use super::contour::{Component, Follower, View};
use super::lattice::{Computed, Kept, Medium, NodeIndex};
use super::model::Model;
use super::world::{LATTICE_STEP, Snapshot, World};
use grn_core::geometry::Point;

/// Spacing of the lattice that decides doubtful topology, metres.
const FINE_STEP: f64 = LATTICE_STEP / 4.0;
/// A component's topology is in doubt when it changes within this pattern error: a cell of the lattice can hide a neck
/// or a gap that shallow.
const DOUBT: f64 = 0.02;

/// The pattern of one model at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contours {
    /// Closed contours that bound an inside component holding a target; metres, first point not repeated.
    pub rings: Vec<Vec<Point<f64>>>,
    /// Outlines of components that leak; only filled when asked for.
    pub leaks: Vec<Vec<Point<f64>>>,
    /// For each target whether a closed component holds it.
    pub enclosed: Vec<bool>,
}

/// Traces patterns; keeps its working memory from one to the next.
pub struct Tracer<'w> {
    world: &'w World,
    coarse: Follower<Kept<'w>>,
    fine: Option<Follower<Computed<'w>>>,
    chart: Chart,
    outline_leaks: bool,
}

impl<'w> Tracer<'w> {
    /// A tracer for one world.
    pub fn new(world: &'w World) -> Self {
        Tracer { world, coarse: Follower::new(Kept(world)), fine: None, chart: Chart::default(), outline_leaks: false }
    }

    /// A tracer that also fills [`Contours::leaks`], for drawing.
    pub fn with_leaks(world: &'w World) -> Self {
        Tracer { outline_leaks: true, ..Self::new(world) }
    }

    /// The patterns of `model` at each snapshot of the world, in turn.
    pub fn trace_all<'t>(&'t mut self, model: &'t Model) -> impl Iterator<Item = (&'w Snapshot, Contours)> + 't {
        let targets = self.world.scenario().paths().len();
        self.chart.draw(model, targets);
        self.world.snapshots().iter().map(move |snapshot| (snapshot, self.trace(model, snapshot)))
    }

    fn trace(&mut self, model: &Model, snapshot: &Snapshot) -> Contours {
        let world = self.world;
        let chart = (self.chart.accuracy() < DOUBT / 4.0).then_some(&self.chart);
        let view = View { model, snapshot, chart };
        let is_held = |&target: &Point<f64>| {
            let [x1, x2] = world.inputs_at(snapshot, target);
            model.error(x1, x2) >= 0.0
        };
        let held: Vec<bool> = snapshot.targets.iter().map(is_held).collect();
        if is_in_doubt(&mut self.coarse, &held, view) {
            let fine = self.fine.get_or_insert_with(|| Follower::new(Computed::new(world, FINE_STEP)));
            fine.begin();
            trace_on(fine, &held, self.outline_leaks, View { chart: None, ..view })
        } else {
            trace_on(&mut self.coarse, &held, self.outline_leaks, view)
        }
    }
}

/// What becomes of a target's component at some threshold; `Closed` says which of the closed components it is.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Outside,
    Leaks,
    Closed(usize),
}

/// Whether the fate of some target may differ within the doubtful range of thresholds.
///
/// Components grow as the threshold falls. One that is closed and holds a single target at the low end therefore is so
/// throughout; only the others have to be looked at from the high end too.
fn is_in_doubt<M: Medium>(follower: &mut Follower<M>, held: &[bool], view: View<'_>) -> bool {
    follower.begin();
    let mut fates = |threshold: f64| {
        fates(follower, held, threshold, view, |follower, start| follower.probe(start, threshold, view))
    };
    let low = fates(-DOUBT);
    let alone = |(place, fate): (usize, &Fate)| match fate {
        Fate::Outside => !held[place],
        Fate::Leaks => false,
        Fate::Closed(_) => low.iter().filter(|other| *other == fate).count() == 1,
    };
    !low.iter().enumerate().all(alone) && low != fates(DOUBT)
}

fn trace_on<M: Medium>(follower: &mut Follower<M>, held: &[bool], outline_leaks: bool, view: View<'_>) -> Contours {
    let (mut rings, mut leaks) = (Vec::new(), Vec::new());
    let fates = fates(follower, held, 0.0, view, |follower, start| {
        let component = follower.label(start, !outline_leaks, view);
        match component {
            Component::Closed => follower.follow(view, &mut rings),
            Component::Leaks if outline_leaks => follower.follow(view, &mut leaks),
            Component::Leaks => {}
        }
        component
    });
    let enclosed = fates.iter().map(|fate| matches!(fate, Fate::Closed(_))).collect();
    Contours { rings, leaks, enclosed }
}

/// The fate of each target, with `explore` called once for each component, from a node in it.
fn fates<M: Medium>(
    follower: &mut Follower<M>,
    held: &[bool],
    threshold: f64,
    view: View<'_>,
    mut explore: impl FnMut(&mut Follower<M>, NodeIndex) -> Component,
) -> Vec<Fate> {
    let mut explored = Vec::new();
    let before = follower.components();
    let targets = view.snapshot.targets.iter().zip(held);
    let fates = targets.map(|(&target, &held)| {
        let start = if held { follower.start(target, threshold, view) } else { None };
        let Some(start) = start else { return Fate::Outside };
        let known = follower.component_of(start).checked_sub(before + 1).map(usize::from);
        let place = known.unwrap_or_else(|| {
            explored.push(explore(follower, start));
            explored.len() - 1
        });
        match explored.get(place) {
            Some(Component::Closed) => Fate::Closed(place),
            _ => Fate::Leaks,
        }
    });
    fates.collect()
}
