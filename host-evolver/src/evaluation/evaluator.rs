//! Evaluating models, no further than it takes to see which ones win.
//!
//! How several models are evaluated together, for the search and for CMA-ES:
//!
//! 1. Every model starts with a bound: the f2 and violation it would have if it did as well as possible at every snapshot.
//! 2. The model with the best bound is evaluated at one more snapshot, and its bound rises to what is now known.
//! 3. A model whose bound is the best and that has been evaluated at every snapshot is the best: nobody can beat it.
//! 4. It ends when as many winners are found as are wanted, or the best bound is worse than a rival's value.
//!
//! This is racing (Maron and Moore 1994, *Hoeffding races*): candidates drop out as soon as they are sure to lose. Here the
//! bounds are exact instead of statistical, so the winners and their values are those of whole evaluations, bit for bit.

use super::constraints::Constraints;
use super::contour::View;
use super::error_table::ErrorTable;
use super::fitness::{Evaluation, WORST_F2, evaluate_snapshot};
use super::model::Model;
use super::tracer::{Tracer, error_table_of};
use super::world::{Snapshot, World};
use crate::model::tree::Tree;

/// Evaluates models in worlds; one per thread.
///
/// The order of snapshots is learned: those at which recent models did badly come first, so that a losing model drops out
/// early. Values do not depend on that order, because they are summed in the order of time.
pub struct Evaluator<'w> {
    worlds: &'w [World],
    constraints: Constraints,
    tracers: Vec<Tracer<'w>>,
    /// The world and the snapshot of each place that models are evaluated at.
    places: Vec<(usize, usize)>,
    /// For each place how badly recent models did there: an exponential average of f2 and weighted violation.
    difficulty: Vec<f64>,
}

impl<'w> Evaluator<'w> {
    /// An evaluator for `world` with the paper's constraints.
    pub fn new(world: &'w World) -> Self {
        Evaluator::among(std::slice::from_ref(world), Constraints::PAPER)
    }

    /// An evaluator for several worlds, whose morphogens are the same: a model is worth the mean of what it is in each.
    pub fn among(worlds: &'w [World], constraints: Constraints) -> Self {
        let places_in = |(world, snapshots): (usize, &World)| {
            (0..snapshots.snapshots().len()).map(move |snapshot| (world, snapshot))
        };
        let places: Vec<_> = worlds.iter().enumerate().flat_map(places_in).collect();
        let tracers = worlds.iter().map(Tracer::new).collect();
        Evaluator { worlds, constraints, tracers, difficulty: vec![0.0; places.len()], places }
    }

    /// The model that a tree's blob will hold, with sigmoid steepness k; `None` without a pattern.
    pub fn model_of(&self, tree: &Tree, steepness: f32) -> Option<Model> {
        let network = tree.network(steepness).ok()?;
        Model::new(&network, self.worlds.first()?.scenario().morphogen().level).ok()
    }

    /// Evaluates a model over all snapshots.
    pub fn evaluate(&mut self, model: &Model) -> Evaluation {
        let mut evaluation = PartialEvaluation::new(model, self);
        while !evaluation.is_complete() {
            evaluation.advance(self);
        }
        evaluation.bound
    }

    /// Evaluates several models until it is sure which are the `wanted` best of those at least as good as the rival.
    /// `None` stands for a model without a pattern.
    ///
    /// The values of these best ones are exact. Another model's value is a bound: never better than the winners' or the
    /// rival's, never worse than its own.
    pub fn evaluate_best(
        &mut self,
        models: &[Option<Model>],
        wanted: usize,
        rival: Option<&Evaluation>,
    ) -> Vec<Evaluation> {
        let mut race: Vec<PartialEvaluation<'_>> =
            models.iter().flatten().map(|model| PartialEvaluation::new(model, self)).collect();
        let mut running: Vec<usize> = (0..race.len()).collect();
        let mut winners = 0;
        while winners < wanted {
            // Of equal bounds incomplete ones come first, since they may still rise.
            let key = |place: &usize| (&race[running[*place]].bound, race[running[*place]].is_complete());
            let order = |a: &usize, b: &usize| key(a).0.order(key(b).0).then(key(a).1.cmp(&key(b).1));
            let Some(leader) = (0..running.len()).min_by(order) else { break };
            let leading = &mut race[running[leader]];
            if rival.is_some_and(|rival| !leading.bound.is_as_good_as(rival)) {
                break;
            }
            if leading.is_complete() {
                running.remove(leader);
                winners += 1;
            } else {
                leading.advance(self);
            }
        }
        let mut bounds = race.into_iter().map(|evaluation| evaluation.bound);
        let mut value = |_: &Model| bounds.next().unwrap_or(Evaluation::NO_PATTERN);
        models.iter().map(|model| model.as_ref().map_or(Evaluation::NO_PATTERN, &mut value)).collect()
    }

    fn learn(&mut self, place: usize, found: Evaluation) {
        let badness = found.f2 + VIOLATION_WEIGHT * found.violation;
        self.difficulty[place] += LEARNING_RATE * (badness - self.difficulty[place]);
    }
}

/// The weight of the latest model in a snapshot's difficulty.
const LEARNING_RATE: f64 = 0.3;
/// How much more a violation adds to a snapshot's difficulty than an equal f2: Deb's rule looks at it first.
const VIOLATION_WEIGHT: f64 = 10.0;

/// The difficulty of a snapshot at which every second model encloses no target.
const USUALLY_LOST: f64 = (WORST_F2 + VIOLATION_WEIGHT) / 2.0;

/// A model evaluated at some of the places.
struct PartialEvaluation<'m> {
    model: &'m Model,
    /// What it violates everywhere.
    islands: f64,
    /// `Some(None)` if no table is accurate enough for this model.
    table: Option<Option<ErrorTable>>,
    /// The value at each place, where it is known.
    values: Vec<Option<Evaluation>>,
    /// Places to evaluate on the coarse lattice.
    pending: Vec<usize>,
    /// Places that the coarse lattice left in doubt, to evaluate on the fine one.
    doubtful: Vec<usize>,
    /// The mean of known values and of the best possible one for the others; the model's value once all are known.
    bound: Evaluation,
}

impl<'m> PartialEvaluation<'m> {
    /// Places at which every target is outside the pattern are decided at once, without a table.
    fn new(model: &'m Model, evaluator: &Evaluator<'_>) -> Self {
        let Evaluator { worlds, constraints, places, .. } = evaluator;
        let is_lost = |snapshot: &Snapshot| snapshot.target_inputs.iter().all(|&[x1, x2]| model.error(x1, x2) < 0.0);
        let lost = |&(world, snapshot): &(usize, usize)| {
            is_lost(&worlds[world].snapshots()[snapshot]).then(|| Evaluation::all_lost(constraints))
        };
        let values: Vec<_> = places.iter().map(lost).collect();
        let mut evaluation = PartialEvaluation {
            model,
            islands: worlds.first().map_or(0.0, |world| constraints.islands(model, &world.scenario().morphogen())),
            table: None,
            pending: (0..values.len()).filter(|&place| values[place].is_none()).collect(),
            values,
            doubtful: Vec::new(),
            bound: Evaluation::NO_PATTERN,
        };
        evaluation.update_bound(evaluator);
        evaluation
    }

    fn is_complete(&self) -> bool {
        self.pending.is_empty() && self.doubtful.is_empty()
    }

    /// Evaluates at one more place, the most difficult first, or finds it doubtful.
    fn advance(&mut self, evaluator: &mut Evaluator<'_>) {
        let difficulty = |&pending: &usize| evaluator.difficulty[self.pending[pending]];
        let hardest = (0..self.pending.len()).max_by(|a, b| difficulty(a).total_cmp(&difficulty(b)));
        let is_coarse = hardest.is_some();
        let Some(place) = hardest.map(|hardest| self.pending.swap_remove(hardest)).or_else(|| self.doubtful.pop())
        else {
            return;
        };
        let (world, snapshot) = evaluator.places[place];
        let (world, tracer) = (&evaluator.worlds[world], &mut evaluator.tracers[world]);
        let snapshot = &world.snapshots()[snapshot];
        let table = self.table.get_or_insert_with(|| error_table_of(evaluator.worlds, self.model)).as_ref();
        let view = View { model: self.model, snapshot, table };
        let contours = if is_coarse {
            let Some(contours) = tracer.trace(view, evaluator.difficulty[place] > USUALLY_LOST) else {
                return self.doubtful.push(place);
            };
            contours
        } else {
            tracer.trace_finely(view)
        };
        let value = evaluate_snapshot(world, snapshot, &contours, &evaluator.constraints);
        evaluator.learn(place, value);
        self.values[place] = Some(value);
        self.update_bound(evaluator);
    }

    /// A rounded sum never falls when one of its terms rises, so the bound holds for rounded values too.
    fn update_bound(&mut self, evaluator: &Evaluator<'_>) {
        let mut values = self.values.iter();
        let mut of_all = Evaluation { f2: 0.0, violation: 0.0 };
        for world in evaluator.worlds {
            let best_possible = Evaluation { f2: world.terms.least, violation: 0.0 };
            let snapshots = world.snapshots().len();
            let mut sum = Evaluation { f2: 0.0, violation: 0.0 };
            for value in values.by_ref().take(snapshots) {
                sum = sum.plus(value.unwrap_or(best_possible));
            }
            of_all = of_all.plus(sum.over(snapshots as f64));
        }
        let Evaluation { f2, violation } = of_all.over(evaluator.worlds.len() as f64);
        self.bound = Evaluation { f2, violation: violation + self.islands };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::published::PUBLISHED;
    use firmware_sim::scenario::Scenario;

    fn world(name: &str) -> World {
        let path = format!("{}/../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        World::new(Scenario::load(path).unwrap())
    }

    #[test]
    fn winners_have_exact_values_and_the_others_bounds() {
        for name in ["channel", "compound-channel", "channel-two-targets"] {
            let world = world(name);
            let mut evaluator = Evaluator::new(&world);
            let mut models = vec![None];
            for published in &PUBLISHED {
                for level in [0.4, 0.5, 0.6] {
                    models.push(Model::new(&published.network().unwrap(), level).ok());
                }
            }
            let value = |model: &Option<Model>| model.as_ref().map(|model| Evaluator::new(&world).evaluate(model));
            let values: Vec<_> = models.iter().map(|model| value(model).unwrap_or(Evaluation::NO_PATTERN)).collect();
            let mut order: Vec<usize> = (0..values.len()).collect();
            order.sort_by(|&a, &b| values[a].order(&values[b]));
            let rival = values[order[2]];
            for (kept, rival) in [(1, None), (5, None), (values.len(), None), (5, Some(&rival))] {
                let found = evaluator.evaluate_best(&models, kept, rival);
                let exact = if rival.is_some() { 3 } else { kept };
                for (rank, &place) in order.iter().enumerate() {
                    let (found, worst) = (found[place], values[order[exact - 1]]);
                    if rank < exact {
                        assert_eq!(found, values[place], "{name}: model {place}");
                    } else {
                        assert!(
                            found.is_as_good_as(&values[place]) && worst.is_as_good_as(&found),
                            "{name}: {found:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn no_model_is_better_than_its_bound() {
        let world = world("compound-channel");
        let mut evaluator = Evaluator::new(&world);
        for published in &PUBLISHED {
            let model = Model::new(&published.network().unwrap(), 0.5).unwrap();
            let value = evaluator.evaluate(&model);
            let mut partial = PartialEvaluation::new(&model, &evaluator);
            while !partial.is_complete() {
                let before = partial.bound;
                partial.advance(&mut evaluator);
                assert!(
                    before.is_as_good_as(&partial.bound) && partial.bound.is_as_good_as(&value),
                    "{}",
                    published.name
                );
            }
            assert_eq!(partial.bound, value, "{}", published.name);
        }
    }
}
