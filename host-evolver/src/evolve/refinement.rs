//! The last part of a run whose objectives are made from trials: θ of the best models are tuned on the closed loop itself.
//!
//! The search tunes θ for f2, which is cheap, and tries what comes out. How the swarm moves on a pattern is not in f2, so there is
//! something left to find near those θ: CMA-ES looks for it, by mean cost in a few trials, the same ones for all.

use super::individual::Individual;
use super::trials::Trials;
use crate::evaluation::{Evaluation, Evaluator};
use grn_core::network::THETA_RANGE;
use grn_optimisers::bounds::Bounds;
use grn_optimisers::cmaes::{self, Cmaes};
use grn_optimisers::nsga2::Scores;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// At most so many models are refined.
pub(super) const MOST_REFINED: usize = 4;
/// Trials of each candidate.
const TRIALS: usize = 4;
/// Initial step size, a twentieth of the range of θ.
const SIGMA: f64 = 0.1;
/// The streams of random numbers of the search end below this.
const FIRST_STREAM: u64 = 1 << 63;

/// A vector of θ that was looked at.
#[derive(Clone)]
struct Candidate {
    individual: Individual,
    cost: f64,
}

impl Candidate {
    fn scores(&self) -> Scores<1> {
        Scores { objectives: [self.cost], violation: self.individual.violation }
    }
}

/// `member` with θ that cost less in the closed loop, found with so many evaluations, or itself, if none are found; tried as
/// often as models on a front are. `None` if stopped.
pub(super) fn refined(
    trials: &Trials<'_>,
    evaluator: &mut Evaluator<'_>,
    member: &Individual,
    evaluations: usize,
    nth: u64,
) -> Option<Individual> {
    let settings = trials.settings;
    let start = member.tree.thetas();
    let (low, high) = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
    let population = 4 + (3.0 * libm::log(start.len() as f64)) as usize;
    let most = TRIALS.min(settings.realities);
    let mut rng = ChaCha8Rng::seed_from_u64(settings.seed);
    rng.set_stream(FIRST_STREAM + nth);
    let Ok(bounds) = Bounds::cube(start.len(), low, high) else { return Some(member.clone()) };
    let Ok(of_cma) = cmaes::Settings::new(population, SIGMA, evaluations.max(1)) else { return Some(member.clone()) };
    let Ok(mut cma) = Cmaes::new(&of_cma.passive(), &bounds, &start) else { return Some(member.clone()) };
    let first_trials = |individual: &Individual| individual.trials.iter().take(most).sum::<f64>() / most as f64;
    let mut best = Candidate { cost: first_trials(member), individual: member.clone() };
    // What costs half more again will not lead to something better.
    let hopeless = 1.5 * best.cost;
    for _ in 0..evaluations / population {
        if cma.stop().is_some() {
            break;
        }
        let vectors = cma.ask(&mut rng);
        let individual = |thetas: &Vec<f64>| {
            let tree = member.tree.with_thetas(thetas);
            let model = evaluator.model_of(&tree, settings.steepness);
            let evaluation = model.map_or(Evaluation::NO_PATTERN, |model| evaluator.evaluate(&model));
            Individual::new(tree, &settings.objectives, evaluation)
        };
        let mut individuals: Vec<Individual> = vectors.iter().map(individual).collect();
        let feasible: Vec<usize> = (0..individuals.len()).filter(|&place| individuals[place].is_feasible()).collect();
        trials.extend(&mut individuals, &feasible, most, hopeless)?;
        let candidate = |individual: Individual| Candidate { cost: individual.cost().unwrap_or(f64::MAX), individual };
        let found: Vec<Candidate> = individuals.into_iter().map(candidate).collect();
        let order = cmaes::rank(&found, |a, b| !b.scores().dominates(&a.scores()));
        if found[order[0]].scores().dominates(&best.scores()) {
            best = found[order[0]].clone();
        }
        cma.tell(&order);
    }
    let mut both = [best.individual, member.clone()];
    trials.extend(&mut both, &[0, 1], settings.realities, f64::INFINITY)?;
    let [best, member] = both;
    Some(if best.cost() < member.cost() { best } else { member })
}
