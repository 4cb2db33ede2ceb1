use super::objective::{Candidate, Nodes, RingError};
use super::*;
use crate::simulation::usual_config;
use firmware_sim::config::SwarmConfig;
use firmware_sim::lab::Laboratory;
use firmware_sim::scenario::Scenario;
use std::sync::atomic::AtomicBool;

fn scenario(name: &str) -> Scenario {
    Scenario::load(format!("{}/../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn channel() -> Task {
    Task::in_one(scenario("channel"), usual_config(0.25, Laboratory::default()))
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
    let task = channel();
    let mut one = Search::new(&task, small(), None).unwrap();
    run(&mut one, 1);
    let mut four = Search::new(&task, small(), None).unwrap();
    run(&mut four, 4);
    assert_eq!(one.state(), four.state());

    let mut first = Search::new(&task, small(), None).unwrap();
    let (go, stop) = (AtomicBool::new(false), AtomicBool::new(true));
    first.advance(&go, &|_| {});
    first.advance(&go, &|_| {});
    let before = first.state().clone();
    assert_eq!(first.advance(&stop, &|_| {}), Advance::Interrupted);
    assert_eq!(first.state(), &before);
    let saved = serde_json::to_string(first.state()).unwrap();
    let mut resumed = Search::new(&task, small(), Some(serde_json::from_str(&saved).unwrap())).unwrap();
    run(&mut resumed, 2);
    assert_eq!(one.state(), resumed.state());
}

#[test]
fn the_budget_is_spent_to_the_last_whole_individual() {
    let task = channel();
    let mut search = Search::new(&task, small(), None).unwrap();
    run(&mut search, 2);
    assert_eq!(search.state().evaluations, 12 * 20 * 4 + 60);
    assert_eq!(search.state().generation, 5);
    assert_eq!(search.state().population.len(), 12);
}

#[test]
fn survivors_have_different_structures_and_never_lose_the_best() {
    let task = channel();
    let mut search = Search::new(&task, small(), None).unwrap();
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
    let task = channel();
    let mut fronts = [1, 2].map(|seed| {
        let mut search = Search::new(&task, Settings { seed, ..small() }, None).unwrap();
        run(&mut search, 2);
        search.front()
    });
    assert_ne!(fronts[0], fronts[1]);
    fronts[0].clear();
}

#[test]
fn senseless_settings_are_refused_by_name() {
    let task = channel();
    for (settings, word) in [
        (Settings { population: 1, ..small() }, "population"),
        (Settings { evaluations: 10, ..small() }, "evaluations"),
        (Settings { mutation: 1.5, ..small() }, "mutation"),
        (Settings { depth: (3, 2), ..small() }, "depth"),
        (Settings { de: DeSettings { population: 2, ..small().de }, ..small() }, "population"),
    ] {
        let error = Search::new(&task, settings, None).err().unwrap().to_string();
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
    let task = channel();
    let objectives = Objectives::new(vec![&Nodes, &RingError, &Depth]).unwrap();
    let mut search = Search::new(&task, Settings { objectives, ..small() }, None).unwrap();
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

/// A run that is tried on swarms, small enough for a test.
fn tried() -> Settings {
    Settings { population: 6, evaluations: 6 * 20 * 3, realities: 3, ..Settings::adaptive() }
}

/// A swarm whose run is short.
fn quick() -> Task {
    let swarm = usual_config(0.25, Laboratory::default());
    let scenarios = ["channel", "open"].map(scenario).to_vec();
    Task::new(scenarios, SwarmConfig { target_speed_m_per_s: 0.1, ..swarm }).unwrap()
}

#[test]
fn trials_depend_on_neither_threads_nor_interruptions() {
    let task = quick();
    let go = AtomicBool::new(false);
    let confirmed = |search: &Search<'_>, threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| search.confirmed_front(&go)).unwrap()
    };
    let mut one = Search::new(&task, tried(), None).unwrap();
    run(&mut one, 1);
    let mut first = Search::new(&task, tried(), None).unwrap();
    first.advance(&go, &|_| {});
    let saved = serde_json::to_string(first.state()).unwrap();
    let mut resumed = Search::new(&task, tried(), Some(serde_json::from_str(&saved).unwrap())).unwrap();
    run(&mut resumed, 3);
    assert_eq!(one.state(), resumed.state());
    assert_eq!(confirmed(&one, 1), confirmed(&resumed, 3));
    let stop = AtomicBool::new(true);
    assert!(one.confirmed_front(&stop).is_none());
}

#[test]
fn who_is_on_the_front_has_had_all_trials_and_others_few() {
    let task = quick();
    let mut search = Search::new(&task, tried(), None).unwrap();
    run(&mut search, 2);
    let population = &search.state().population;
    let trials = |individual: &Individual| individual.trials.len();
    assert!(population.iter().filter(|one| one.is_feasible()).all(|one| trials(one) >= 2));
    assert!(population.iter().filter(|one| !one.is_feasible()).all(|one| trials(one) == 0));
    let best =
        population.iter().filter(|one| one.is_feasible()).min_by(|a, b| a.cost().partial_cmp(&b.cost()).unwrap());
    assert_eq!(best.map(trials), Some(3));
    let least = search.state().history.last().and_then(|last| last.best_cost);
    assert_eq!(best.and_then(Individual::cost), least);
}

#[test]
fn the_knee_of_tried_models_is_confirmed_by_trials_that_the_search_has_not_seen() {
    let task = quick();
    let mut search = Search::new(&task, tried(), None).unwrap();
    run(&mut search, 2);
    let front = search.confirmed_front(&AtomicBool::new(false)).unwrap();
    assert_eq!(front.iter().filter(|member| member.knee.parsimony).count(), 1);
    assert!(front.iter().all(|member| !member.knee.angle && !member.knee.utility));
    let costs: Vec<f64> = front.iter().map(|member| member.further[0]).collect();
    assert!(costs.windows(2).all(|pair| pair[1] < pair[0]), "{costs:?}");
    let seen: Vec<f64> = search.state().population.iter().filter_map(Individual::cost).collect();
    assert!(costs.iter().all(|cost| !seen.contains(cost)), "these would be the trials of the search: {costs:?}");
}

#[test]
fn worlds_with_different_morphogens_have_no_common_model() {
    let swarm = usual_config(0.25, Laboratory::default());
    let other = scenario("channel").to_toml().replace("target_width = 1.5", "target_width = 1.4");
    let other = Scenario::parse(&other).unwrap();
    let error = Task::new(vec![scenario("open"), scenario("channel"), other], swarm.clone()).unwrap_err();
    assert!(error.to_string().contains("worlds 1 and 3 have different [morphogen]"), "{error}");
    assert_eq!(Task::new(Vec::new(), swarm).unwrap_err(), TaskError::NoWorld);
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
