//! The ways to a model that a campaign can compare. Another is a variant of [`Method`] and its run.

use crate::evaluation::{ConstraintNames, World};
use crate::evolve::eh_grn::{self, Structure};
use crate::evolve::{Advance, FrontMember, Milestone, Objectives, Search, Settings, Task};
use crate::model::variation::{Inputs, MotifSet};
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

    /// What its fronts are fronts of.
    pub fn objectives(&self) -> Objectives {
        match self {
            Method::Mogp { objectives: Some(objectives), .. } => objectives.clone(),
            Method::Mogp { objectives: None, .. } | Method::EhGrn { .. } => Objectives::paper(),
        }
    }

    /// The evaluations that its first generation takes.
    pub(super) fn least_evaluations(&self) -> usize {
        self.settings(0, 1).map_or(eh_grn::POPULATION, |settings| settings.least_evaluations())
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

fn baseline(
    worlds: &[World],
    structure: Structure,
    evaluations: usize,
    seed: u64,
    stop: &AtomicBool,
) -> Option<Outcome> {
    let (tuned, history) = eh_grn::search(structure, worlds, evaluations, seed, stop)?;
    let front = vec![FrontMember {
        network: structure.network(&tuned.thetas)?,
        nodes: structure.nodes(),
        f2: tuned.evaluation.f2,
        further: Vec::new(),
        violation: tuned.evaluation.violation,
        knee: Knee { angle: true, utility: true, parsimony: false },
    }];
    Some(Outcome { front, history })
}
