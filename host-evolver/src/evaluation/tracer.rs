//! From a model and a snapshot to the pattern (model page, section 3).

use super::contour::{Component, Follower, View};
use super::error_table::ErrorTable;
use super::lattice::NodeIndex;
use super::medium::{Computed, Kept, Medium};
use super::model::Model;
use super::world::{Snapshot, World};
use grn_core::geometry::Point;

/// Topology is in doubt if raising or lowering the level by this pattern error changes it: a necking or a gap that shallow
/// can hide within one cell of the coarse lattice.
const DOUBT: f64 = 0.02;
/// Where a leak is expected, this many nodes are searched for it before the component is flooded as if it were closed:
/// enough to reach a wall on either lattice.
const LOOKED_AT_FOR_LEAKS: usize = 200;
/// The largest error of a table that models may be traced by.
const CHART_TOLERANCE: f64 = DOUBT / 4.0;

/// The pattern of one model at one snapshot.
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
    outline_leaks: bool,
}

impl<'w> Tracer<'w> {
    /// A tracer for one world.
    pub fn new(world: &'w World) -> Self {
        Tracer { world, coarse: Follower::new(Kept(world)), fine: None, outline_leaks: false }
    }

    /// A tracer that also fills [`Contours::leaks`], for drawing.
    pub fn with_leaks(world: &'w World) -> Self {
        Tracer { outline_leaks: true, ..Self::new(world) }
    }

    /// The patterns of `model` at each snapshot of the world, in turn.
    pub fn trace_all<'t>(&'t mut self, model: &'t Model) -> impl Iterator<Item = (&'w Snapshot, Contours)> + 't {
        let table = error_table_of(std::slice::from_ref(self.world), model);
        self.world.snapshots().iter().map(move |snapshot| {
            let view = View { model, snapshot, table: table.as_ref() };
            (snapshot, self.trace(view, false).unwrap_or_else(|| self.trace_finely(view)))
        })
    }

    /// The pattern at a snapshot, unless the coarse lattice leaves its topology in doubt. `expects_leak` changes only the
    /// speed: faster for patterns that leak, slower for others.
    pub(super) fn trace(&mut self, view: View<'_>, expects_leak: bool) -> Option<Contours> {
        let mut attempt = Attempt { outline_leaks: self.outline_leaks, expects_leak, ..Attempt::default() };
        let doubtful = attempt.trace(&mut self.coarse, view);
        (!doubtful).then(|| attempt.contours())
    }

    /// The pattern at a snapshot on the fine lattice, which is believed.
    pub(super) fn trace_finely(&mut self, view: View<'_>) -> Contours {
        let fine = self.fine.get_or_insert_with(|| Follower::new(Computed(self.world)));
        let outline_leaks = self.outline_leaks;
        let mut attempt = Attempt { outline_leaks, expects_leak: true, is_final: true, ..Attempt::default() };
        attempt.trace(fine, view);
        attempt.contours()
    }
}

/// The table to trace a model by in a world; `None` if none is accurate enough.
pub(super) fn error_table_of(worlds: &[World], model: &Model) -> Option<ErrorTable> {
    let targets = worlds.iter().map(|world| world.scenario().targets().len()).max();
    ErrorTable::of(model, targets.unwrap_or(1), CHART_TOLERANCE)
}

/// What becomes of a target's component; `Closed` says which component it is.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Outside,
    Leaks,
    Closed(u32),
}

/// The pattern as one lattice shows it.
#[derive(Default)]
struct Attempt {
    outline_leaks: bool,
    /// Whether to look for leaks before anything else.
    expects_leak: bool,
    /// Whether this lattice is the fine one, which is believed.
    is_final: bool,
    rings: Vec<Vec<Point<f64>>>,
    leaks: Vec<Vec<Point<f64>>>,
    fates: Vec<Fate>,
}

impl Attempt {
    /// Traces the pattern. Returns whether some target's fate differs within the doubtful range of thresholds.
    ///
    /// Components only grow as the threshold falls. So a component that holds one target and is closed at the lowest
    /// threshold is closed at every threshold. All others are checked at the highest threshold as well.
    fn trace<M: Medium>(&mut self, follower: &mut Follower<M>, view: View<'_>) -> bool {
        follower.begin();
        let mut shared = false;
        for (&target, [x1, x2]) in view.snapshot.targets.iter().zip(&view.snapshot.target_inputs) {
            let held = view.model.error(*x1, *x2) >= 0.0;
            let start = if held { follower.start(target, 0.0, view) } else { None };
            let fate = match start.map(|start| (start, follower.component_of(start))) {
                None if held && !self.is_final && follower.start(target, -DOUBT, view).is_some() => return true,
                None => Fate::Outside,
                Some((start, known)) if !follower.is_current(known) => match self.explore(follower, start, view) {
                    Some(fate) => fate,
                    None => return true,
                },
                Some((_, known)) => {
                    shared = true;
                    if self.fates.contains(&Fate::Closed(known)) { Fate::Closed(known) } else { Fate::Leaks }
                }
            };
            self.fates.push(fate);
        }
        let sure = self.is_final || !(shared || self.fates.contains(&Fate::Leaks));
        !sure && !same_when_narrowed(follower, &self.fates, view)
    }

    /// The fate of the targets in the component of `start`, if that is not in doubt.
    fn explore<M: Medium>(&mut self, follower: &mut Follower<M>, start: NodeIndex, view: View<'_>) -> Option<Fate> {
        if self.expects_leak && !self.outline_leaks && follower.finds_leak(start, 0.0, LOOKED_AT_FOR_LEAKS, view) {
            return Some(Fate::Leaks);
        }
        match follower.label(start, !self.outline_leaks, view) {
            Component::Leaks => {
                if self.outline_leaks {
                    follower.follow(view, &mut self.leaks);
                }
                Some(Fate::Leaks)
            }
            Component::Closed => {
                if !self.is_final && follower.widen(-DOUBT, view) == Component::Leaks {
                    return None;
                }
                follower.follow(view, &mut self.rings);
                Some(Fate::Closed(follower.last_component()))
            }
        }
    }

    fn contours(self) -> Contours {
        let enclosed = self.fates.iter().map(|fate| matches!(fate, Fate::Closed(_))).collect();
        Contours { rings: self.rings, leaks: self.leaks, enclosed }
    }
}

/// Whether the targets have the given fates, in the same components, at the high end of the doubtful thresholds too.
fn same_when_narrowed<M: Medium>(follower: &mut Follower<M>, fates: &[Fate], view: View<'_>) -> bool {
    let first = follower.last_component();
    let mut narrowed: Vec<(u32, Fate)> = Vec::with_capacity(fates.len());
    for (&target, &fate) in view.snapshot.targets.iter().zip(fates) {
        if fate == Fate::Outside {
            continue;
        }
        let Some(start) = follower.start(target, DOUBT, view) else { return false };
        let known = follower.component_of(start);
        if known <= first {
            let closed = !follower.finds_leak(start, DOUBT, usize::MAX, view);
            if closed == (fate == Fate::Leaks) {
                return false;
            }
            narrowed.push((follower.last_component(), fate));
        } else if !narrowed.contains(&(known, fate)) {
            return false;
        }
    }
    // Two components at the high end that are one at the middle.
    let split = |&(component, fate): &(u32, Fate)| {
        fate != Fate::Leaks && narrowed.iter().any(|&(other, fate_of_it)| other != component && fate_of_it == fate)
    };
    !narrowed.iter().any(split)
}
