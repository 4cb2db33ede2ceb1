//! The ways to a model that a campaign can compare. Another is a variant of [`Method`] and its run.

use crate::baselines::{self, rule_ring};
use crate::evaluation::{ConstraintNames, Constraints, Evaluation, Evaluator, Model, World};
use crate::evolve::eh_grn::{self, Structure};
use crate::evolve::{Advance, FrontMember, Milestone, Objectives, Search, Settings, Task};
use crate::model::describe;
use crate::model::variation::{Inputs, MotifSet};
use grn_core::network::Network;
use grn_optimisers::knee::Knee;
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;

/// An algorithm with what it leaves open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "algorithm", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Method {
    /// MOGP-NSGA-II with DE, the paper's Algorithm 1.
    Mogp {
        /// Motifs to build with.
        motifs: MotifSet,
        /// Generations of DE for each individual; one if not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        de_generations: Option<usize>,
        /// What is minimised; nodes and f2 if not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        objectives: Option<Objectives>,
        /// What patterns must keep to; the paper's, or all for objectives made from trials, if not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        constraints: Option<ConstraintNames>,
        /// Trials of models on the front; 16 if not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        realities: Option<usize>,
        /// What models may read; both inputs if not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        inputs: Option<Inputs>,
        /// Whether it is a random search.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        random: Option<bool>,
        /// Which member of the front is deployed; the knee if not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        deploys: Option<Deploys>,
    },
    /// EH-GRN with CMA-ES.
    EhGrn {
        /// Which printed structure.
        structure: Structure,
    },
    /// The ring by plain rules, which nothing is evolved for: see [`rule_ring`]. Where models are evaluated the circle that it aims at
    /// stands for it.
    RuleRing,
}

/// Which member of a front is deployed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Deploys {
    /// The knee.
    Knee,
    /// The one that is best in the last objective.
    Best,
}

/// What a run leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The non-dominated models, fewest nodes first, at least one.
    pub front: Vec<FrontMember>,
    /// One entry a generation.
    pub history: Vec<Milestone>,
}

impl Method {
    /// The settings of a search, if it is one.
    fn settings(&self, evaluations: usize, seed: u64) -> Option<Settings> {
        let Method::Mogp { motifs, de_generations, objectives, constraints, realities, inputs, random, .. } = self
        else {
            return None;
        };
        let tried = objectives.as_ref().is_some_and(Objectives::need_trials);
        let usual = if tried { Settings::adaptive() } else { Settings::default() };
        let mut settings = Settings {
            seed,
            evaluations,
            motifs: *motifs,
            inputs: inputs.unwrap_or(usual.inputs),
            random: random.unwrap_or(usual.random),
            constraints: constraints.unwrap_or(usual.constraints),
            realities: realities.unwrap_or(usual.realities),
            ..usual
        };
        settings.de.generations = de_generations.unwrap_or(settings.de.generations);
        settings.objectives = objectives.clone().unwrap_or(settings.objectives);
        Some(settings)
    }

    /// Runs of a campaign with so many seeds: one if seeds change nothing.
    pub fn runs(&self, seeds: u64) -> u64 {
        if self.follows_rules() { 1 } else { seeds }
    }

    /// What a run spends of a budget: evaluations of f2.
    pub fn spends(&self, evaluations: usize) -> usize {
        if self.follows_rules() { 1 } else { evaluations }
    }

    /// Whether robots follow rules instead of a model.
    pub fn follows_rules(&self) -> bool {
        *self == Method::RuleRing
    }

    /// What its fronts are fronts of.
    pub fn objectives(&self) -> Objectives {
        match self {
            Method::Mogp { objectives: Some(objectives), .. } => objectives.clone(),
            Method::Mogp { objectives: None, .. } | Method::EhGrn { .. } | Method::RuleRing => Objectives::paper(),
        }
    }

    /// The evaluations that its first generation takes.
    pub(super) fn least_evaluations(&self) -> usize {
        match self {
            Method::RuleRing => self.spends(0),
            _ => self.settings(0, 1).map_or(eh_grn::POPULATION, |settings| settings.least_evaluations()),
        }
    }

    /// Runs it; `None` if it was stopped. The outcome depends on its arguments only.
    pub fn run(&self, task: &Task, evaluations: usize, seed: u64, stop: &AtomicBool) -> Option<Outcome> {
        match self {
            Method::Mogp { deploys, .. } => {
                let mut outcome = mogp(task, self.settings(evaluations, seed)?, stop)?;
                if *deploys == Some(Deploys::Best) {
                    deploy_best(&self.objectives(), &mut outcome.front);
                }
                Some(outcome)
            }
            Method::EhGrn { structure } => baseline(task.worlds(), *structure, evaluations, seed, stop),
            Method::RuleRing => rule_ring(task.worlds()),
        }
    }
}

fn mogp(task: &Task, settings: Settings, stop: &AtomicBool) -> Option<Outcome> {
    let mut search = Search::new(task, settings, None).ok()?;
    loop {
        match search.advance(stop, &|_| ()) {
            Advance::Generation => {}
            Advance::Finished => break,
            Advance::Interrupted => return None,
        }
    }
    Some(Outcome { front: search.confirmed_front(stop, &|| ())?, history: search.state().history.clone() })
}

/// Makes the member that is best in the last objective the only knee.
fn deploy_best(objectives: &Objectives, front: &mut [FrontMember]) {
    let last = |member: &FrontMember| {
        let values = objectives.in_order(member.nodes as f64, member.f2, &member.further);
        values.last().copied().unwrap_or(f64::MAX)
    };
    let best = (0..front.len()).min_by(|&a, &b| last(&front[a]).total_cmp(&last(&front[b])));
    for (place, member) in front.iter_mut().enumerate() {
        member.knee = Knee { parsimony: best == Some(place), ..Knee::default() };
    }
}

/// The circle that the rules aim at in the first of the worlds, by what it is worth in all of them.
fn rule_ring(worlds: &[World]) -> Option<Outcome> {
    let scenario = worlds.first()?.scenario();
    let network = baselines::circle(rule_ring::radius(scenario.ring()), &scenario.morphogen()).ok()?;
    let model = Model::new(&network, scenario.morphogen().level).ok();
    let mut evaluator = Evaluator::among(worlds, Constraints::PAPER);
    let evaluation = model.map_or(Evaluation::NO_PATTERN, |model| evaluator.evaluate(&model));
    let nodes = describe::tree_size(&network);
    let history = vec![eh_grn::milestone(nodes, 1, &evaluation)];
    Some(Outcome { front: vec![only_member(network, nodes, evaluation)], history })
}

fn only_member(network: Network<f32>, nodes: usize, Evaluation { f2, violation }: Evaluation) -> FrontMember {
    let knee = Knee { angle: true, utility: true, parsimony: false };
    FrontMember { network, nodes, f2, further: Vec::new(), violation, knee }
}

fn baseline(
    worlds: &[World],
    structure: Structure,
    evaluations: usize,
    seed: u64,
    stop: &AtomicBool,
) -> Option<Outcome> {
    let (tuned, history) = eh_grn::search(structure, worlds, evaluations, seed, stop)?;
    let member = only_member(structure.network(&tuned.thetas)?, structure.nodes(), tuned.evaluation);
    Some(Outcome { front: vec![member], history })
}
