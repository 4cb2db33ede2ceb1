use super::objective::{Candidate, Nodes, RingError};
use super::*;
use crate::evaluation::World;
use firmware_sim::scenario::Scenario;
use std::sync::atomic::AtomicBool;

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
    fn description(&self) -> &'static str {
        "edges from the root to the farthest leaf"
    }
    fn value(&self, candidate: &Candidate<'_>) -> f64 {
        candidate.tree.depth() as f64
    }
}

#[test]
fn a_third_objective_needs_nothing_but_itself() {
    let world = channel();
    let objectives = Objectives::new(vec![&Nodes, &RingError, &Depth]).unwrap();
    let mut search = Search::new(&world, Settings { objectives, ..small() }, None).unwrap();
    run(&mut search, 2);
    let front = search.front();
    let values: Vec<[f64; 3]> = front.iter().map(|m| [m.nodes as f64, m.f2, m.further[0]]).collect();
    let dominates = |a: &[f64; 3], b: &[f64; 3]| a != b && a.iter().zip(b).all(|(a, b)| a <= b);
    assert!(values.iter().all(|a| values.iter().all(|b| !dominates(a, b))), "{values:?}");
    assert!(front.iter().all(FrontMember::is_feasible));
    for individual in &search.state().population {
        assert_eq!(
            individual.objectives,
            [individual.tree.size() as f64, individual.f2, individual.tree.depth() as f64]
        );
    }
}

#[test]
fn an_objective_is_computed_once_for_every_individual() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    static ASKED: AtomicUsize = AtomicUsize::new(0);
    struct Counted;
    impl Objective for Counted {
        fn name(&self) -> &'static str {
            "counted"
        }
        fn description(&self) -> &'static str {
            "always 0"
        }
        fn value(&self, _: &Candidate<'_>) -> f64 {
            ASKED.fetch_add(1, Ordering::Relaxed);
            0.0
        }
    }
    let world = channel();
    let objectives = Objectives::new(vec![&Nodes, &RingError, &Counted]).unwrap();
    let settings = Settings { objectives, ..small() };
    let each = settings.evaluations_each();
    let mut search = Search::new(&world, settings, None).unwrap();
    run(&mut search, 2);
    search.front();
    assert_eq!(ASKED.load(Ordering::Relaxed), search.state().evaluations / each);
}

#[test]
fn wrong_objectives_are_refused_by_name() {
    for (text, word) in [
        ("nodes", "1 objectives"),
        ("nodes,f2,f2", "f2 stands there twice"),
        ("nodes,f3", "\"f3\" is no objective; there are nodes, f2"),
        ("nodes,f2,nodes,f2", "4 objectives"),
        ("", "is no objective"),
    ] {
        let error = text.parse::<Objectives>().unwrap_err().to_string();
        assert!(error.contains(word), "{text}: {error}");
    }
    assert_eq!("f2, nodes".parse::<Objectives>().unwrap().to_string(), "f2,nodes");
}
