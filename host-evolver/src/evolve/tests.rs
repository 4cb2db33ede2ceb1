use super::*;
use firmware_sim::scenario::Scenario;

fn channel() -> World {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/channel.toml");
    World::new(Scenario::load(path).unwrap())
}

fn small() -> Settings {
    Settings { population: 12, evaluations: 12 * 20 * 4 + 60, ..Settings::default() }
}

fn run(search: &mut Search<'_>, threads: usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let go = AtomicBool::new(false);
    pool.install(|| while search.advance(&go, &|_| {}) == Advance::Generation {});
}

#[test]
fn threads_and_interruptions_change_nothing() {
    let world = channel();
    let mut one = Search::new(&world, small(), None).unwrap();
    run(&mut one, 1);
    let mut four = Search::new(&world, small(), None).unwrap();
    run(&mut four, 4);
    assert_eq!(one.state(), four.state());

    let mut first = Search::new(&world, small(), None).unwrap();
    let (go, stop) = (AtomicBool::new(false), AtomicBool::new(true));
    first.advance(&go, &|_| {});
    first.advance(&go, &|_| {});
    let before = first.state().clone();
    assert_eq!(first.advance(&stop, &|_| {}), Advance::Interrupted);
    assert_eq!(first.state(), &before);
    let saved = serde_json::to_string(first.state()).unwrap();
    let mut resumed = Search::new(&world, small(), Some(serde_json::from_str(&saved).unwrap())).unwrap();
    run(&mut resumed, 2);
    assert_eq!(one.state(), resumed.state());
}

#[test]
fn the_budget_is_spent_to_the_last_whole_individual() {
    let world = channel();
    let mut search = Search::new(&world, small(), None).unwrap();
    run(&mut search, 2);
    assert_eq!(search.state().evaluations, 12 * 20 * 4 + 60);
    assert_eq!(search.state().generation, 5);
    assert_eq!(search.state().population.len(), 12);
}

#[test]
fn survivors_have_different_structures_and_never_lose_the_best() {
    let world = channel();
    let mut search = Search::new(&world, small(), None).unwrap();
    run(&mut search, 2);
    let mut structures: Vec<_> = search.state().population.iter().map(|i| i.tree.structure()).collect();
    structures.sort();
    structures.dedup();
    assert_eq!(structures.len(), 12);
    let best: Vec<f64> = search.state().history.iter().map(|m| m.best_f2.unwrap_or(f64::INFINITY)).collect();
    assert!(best.windows(2).all(|pair| pair[1] <= pair[0]), "{best:?}");
}

#[test]
fn different_seeds_give_different_runs() {
    let world = channel();
    let mut fronts = [1, 2].map(|seed| {
        let mut search = Search::new(&world, Settings { seed, ..small() }, None).unwrap();
        run(&mut search, 2);
        search.front()
    });
    assert_ne!(fronts[0], fronts[1]);
    fronts[0].clear();
}

#[test]
fn senseless_settings_are_refused_by_name() {
    let world = channel();
    for (settings, word) in [
        (Settings { population: 1, ..small() }, "population"),
        (Settings { evaluations: 10, ..small() }, "evaluations"),
        (Settings { mutation: 1.5, ..small() }, "mutation"),
        (Settings { depth: (3, 2), ..small() }, "depth"),
        (Settings { de: DeSettings { population: 2, ..small().de }, ..small() }, "population"),
    ] {
        let error = Search::new(&world, settings, None).err().unwrap().to_string();
        assert!(error.contains(word), "{error}");
    }
}

/// A third objective in one place: how deep the tree is.
struct Depth;

impl Objective for Depth {
    fn name(&self) -> &'static str {
        "depth"
    }
    fn value(&self, individual: &Individual) -> f64 {
        individual.tree.depth() as f64
    }
}

#[test]
fn a_third_objective_needs_nothing_but_itself() {
    let world = channel();
    let grammar = Grammar::new(crate::model::variation::MotifSet::All, (1, 4), (0.0, 2.0));
    let objectives: [&dyn Objective; 3] = [&Nodes, &RingError, &Depth];
    let mut search = Search::with(&world, small(), objectives, Box::new(grammar), None).unwrap();
    let go = AtomicBool::new(false);
    while search.advance(&go, &|_| {}) == Advance::Generation {}
    let front = search.front();
    let scores: Vec<_> = front.iter().map(|member| scores(&member.individual, &objectives)).collect();
    assert!(scores.iter().all(|a| scores.iter().all(|b| !a.dominates(b))));
    assert!(front.iter().all(|member| member.individual.is_feasible()));
}
