//! Judging models: no more than it takes to see who wins.

use super::contour::View;
use super::error_table::ErrorTable;
use super::fitness::{Evaluation, WORST_F2, evaluate_snapshot};
use super::model::Model;
use super::tracer::{Tracer, error_table_of};
use super::world::{Snapshot, World};
use crate::model::tree::Tree;

/// Judges models in one world; one per thread.
///
/// Moments at which recent models did badly come first, so that a model that loses does so soon. What a model is worth
/// does not depend on it: values are summed in the order of time.
pub struct Evaluator<'w> {
    world: &'w World,
    tracer: Tracer<'w>,
    /// How badly models have done of late at each moment.
    hardness: Vec<f64>,
}

impl<'w> Evaluator<'w> {
    /// A evaluator for `world`.
    pub fn new(world: &'w World) -> Self {
        Evaluator { world, tracer: Tracer::new(world), hardness: vec![0.0; world.snapshots().len()] }
    }

    /// The world models are judged in.
    pub fn world(&self) -> &'w World {
        self.world
    }

    /// The model that a tree's blob will hold, with sigmoid steepness k; `None` without a pattern.
    pub fn model_of(&self, tree: &Tree, steepness: f32) -> Option<Model> {
        let network = tree.network(steepness).ok()?;
        Model::new(&network, self.world.scenario().morphogen().level).ok()
    }

    /// Evaluates a model over all snapshots.
    pub fn evaluate(&mut self, model: &Model) -> Evaluation {
        let mut case = Case::new(model, self);
        while !case.is_closed() {
            case.look_on(self);
        }
        case.at_best
    }

    /// Evaluates several models until it is sure which are the `kept` best of them that are as good as the rival; `None`
    /// stands for one without a pattern. Only their values are exact; a model that is worse than they or the rival may
    /// get any value between theirs and its own.
    ///
    /// The model that is best as far as is known is looked at next, so the others get no more attention than it takes
    /// to see that they are worse.
    pub fn evaluate_best(
        &mut self,
        models: &[Option<Model>],
        kept: usize,
        rival: Option<&Evaluation>,
    ) -> Vec<Evaluation> {
        let mut cases: Vec<Case<'_>> = models.iter().flatten().map(|model| Case::new(model, self)).collect();
        let mut running: Vec<usize> = (0..cases.len()).collect();
        let mut found = 0;
        while found < kept {
            // Among equals those not closed yet come first: they may turn out worse.
            let key = |place: &usize| (&cases[running[*place]].at_best, cases[running[*place]].is_closed());
            let order = |a: &usize, b: &usize| key(a).0.order(key(b).0).then(key(a).1.cmp(&key(b).1));
            let Some(best) = (0..running.len()).min_by(order) else { break };
            let case = &mut cases[running[best]];
            if rival.is_some_and(|rival| !case.at_best.is_as_good_as(rival)) {
                break;
            }
            if case.is_closed() {
                running.remove(best);
                found += 1;
            } else {
                case.look_on(self);
            }
        }
        let mut cases = cases.into_iter();
        let mut value = |_: &Model| cases.next().map_or(Evaluation::NO_PATTERN, |case| case.at_best);
        models.iter().map(|model| model.as_ref().map_or(Evaluation::NO_PATTERN, &mut value)).collect()
    }

    fn learn(&mut self, place: usize, moment: Evaluation) {
        let badness = moment.f2 + VIOLATION_WEIGHT * moment.violation;
        self.hardness[place] += LEARNING_RATE * (badness - self.hardness[place]);
    }
}

/// How much the last model counts for how hard a moment is.
const LEARNING_RATE: f64 = 0.3;
/// How much harder a violation makes a moment than as much f2: most rivals are feasible.
const VIOLATION_WEIGHT: f64 = 10.0;

/// How hard a moment is at which at least every other model is lost.
const LOST_AS_A_RULE: f64 = (WORST_F2 + VIOLATION_WEIGHT) / 2.0;

/// What is known so far of a model.
struct Case<'m> {
    model: &'m Model,
    table: Option<Option<ErrorTable>>,
    /// What the model is worth at each moment, as far as it is known.
    moments: Vec<Option<Evaluation>>,
    /// Moments to look at.
    ahead: Vec<usize>,
    /// Moments to look at on the fine lattice after those.
    doubtful: Vec<usize>,
    /// What the model is worth if it does as well as it can at the moments not known yet; its value once all are known.
    at_best: Evaluation,
}

impl<'m> Case<'m> {
    /// Looks only whether targets are inside: no table is needed for a moment at which none is.
    fn new(model: &'m Model, evaluator: &Evaluator<'_>) -> Self {
        let is_lost = |snapshot: &Snapshot| snapshot.target_inputs.iter().all(|&[x1, x2]| model.error(x1, x2) < 0.0);
        let lost = |snapshot| is_lost(snapshot).then_some(Evaluation::NO_PATTERN);
        let moments: Vec<_> = evaluator.world.snapshots().iter().map(lost).collect();
        let ahead = (0..moments.len()).filter(|&place| moments[place].is_none()).collect();
        let mut case =
            Case { model, table: None, moments, ahead, doubtful: Vec::new(), at_best: Evaluation::NO_PATTERN };
        case.sum_up(evaluator.world);
        case
    }

    fn is_closed(&self) -> bool {
        self.ahead.is_empty() && self.doubtful.is_empty()
    }

    /// Looks at one more moment.
    fn look_on(&mut self, evaluator: &mut Evaluator<'_>) {
        let world = evaluator.world;
        let table = self.table.get_or_insert_with(|| error_table_of(world, self.model)).as_ref();
        let view = |place: usize| View { model: self.model, snapshot: &world.snapshots()[place], table };
        let hardness = |&ahead: &usize| evaluator.hardness[self.ahead[ahead]];
        let hardest = (0..self.ahead.len()).max_by(|a, b| hardness(a).total_cmp(&hardness(b)));
        let (place, contours) = if let Some(hardest) = hardest {
            let place = self.ahead.swap_remove(hardest);
            let Some(contours) = evaluator.tracer.trace(view(place), evaluator.hardness[place] > LOST_AS_A_RULE) else {
                return self.doubtful.push(place);
            };
            (place, contours)
        } else if let Some(place) = self.doubtful.pop() {
            (place, evaluator.tracer.trace_finely(view(place)))
        } else {
            return;
        };
        let moment = evaluate_snapshot(world, &world.snapshots()[place], &contours);
        evaluator.learn(place, moment);
        self.moments[place] = Some(moment);
        self.sum_up(world);
    }

    /// Sums are rounded, but never fall when a term rises: so no model is worth more than at best.
    fn sum_up(&mut self, world: &World) {
        let least = Evaluation { f2: world.terms.least, violation: 0.0 };
        let mut sum = Evaluation { f2: 0.0, violation: 0.0 };
        for moment in &self.moments {
            let moment = moment.unwrap_or(least);
            sum = Evaluation { f2: sum.f2 + moment.f2, violation: sum.violation + moment.violation };
        }
        self.at_best = sum.over(self.moments.len() as f64);
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
    fn the_best_get_their_values_and_the_others_no_better_than_theirs() {
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
    fn no_model_is_worth_more_than_at_best() {
        let world = world("compound-channel");
        let mut evaluator = Evaluator::new(&world);
        for published in &PUBLISHED {
            let model = Model::new(&published.network().unwrap(), 0.5).unwrap();
            let value = evaluator.evaluate(&model);
            let mut case = Case::new(&model, &evaluator);
            while !case.is_closed() {
                let before = case.at_best;
                case.look_on(&mut evaluator);
                assert!(
                    before.is_as_good_as(&case.at_best) && case.at_best.is_as_good_as(&value),
                    "{}",
                    published.name
                );
            }
            assert_eq!(case.at_best, value, "{}", published.name);
        }
    }
}
