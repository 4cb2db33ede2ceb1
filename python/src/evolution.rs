//! Evolution runs, with the folder that `grn evolve` leaves.

use crate::attention::attended;
use crate::blob::Blob;
use crate::errors::{about, failed, refused};
use crate::laboratory::{check_settings, found};
use crate::scenario::GivenScenario;
use firmware_sim::lab::Laboratory;
use firmware_sim::scenario;
use firmware_sim::swarm;
use grn_core::scalar::NumberType;
use host_evolver::evaluation::{ConstraintNames, World};
use host_evolver::evolve::{Advance, Milestone, Objectives, Search, Settings, Task};
use host_evolver::model::variation::MotifSet;
use host_evolver::record;
use host_evolver::run::{Manifest, RunFolder, of_world};
use host_evolver::simulation::{self, check_length, usual_config};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;

/// How far an evolution has come after a generation.
#[pyclass(frozen, get_all, module = "grn")]
#[derive(Clone)]
pub struct Progress {
    /// Evaluations of f2 spent.
    evaluations: usize,
    /// Evaluations in all.
    budget: usize,
    /// Best f2 of a feasible model, or None.
    best_f2: Option<f64>,
    /// Least mean cost J of a feasible model in its trials, or None.
    best_cost: Option<f64>,
    /// Feasible models in the population.
    feasible: usize,
    /// Models on the feasible front.
    front: usize,
    /// Share of the reference box that the front dominates, 0 to 1.
    hypervolume: f64,
}

#[pymethods]
impl Progress {
    fn __repr__(&self) -> String {
        let Progress { evaluations, budget, best_f2, .. } = self;
        let best = best_f2.map_or("None".into(), |f2| f2.to_string());
        format!("<Progress {evaluations}/{budget} evaluations, best_f2={best}>")
    }
}

/// What an evolution left.
#[pyclass(frozen, get_all, module = "grn")]
pub struct Found {
    /// The knee that is deployed.
    knee: Py<Blob>,
    /// Whether every model of the front is feasible.
    feasible: bool,
    /// Whether the knee works on the laboratory's simulated robots.
    works: bool,
    /// What the user should hear.
    notices: Vec<String>,
}

/// Everything that a run is made from.
struct Order {
    scenarios: Vec<scenario::Scenario>,
    settings: Settings,
    scale: f32,
    lab: Laboratory,
    out: PathBuf,
    resume: bool,
}

/// What the searching thread brings back.
struct Brought {
    knee: grn_core::blob::Blob,
    feasible: bool,
    works: bool,
    notices: Vec<String>,
}

/// Why there is nothing to bring back.
enum Ended {
    /// It was asked to stop.
    Stopped,
    /// It failed, in words.
    Failed(PyErr),
}

impl<E: std::error::Error + 'static> From<E> for Ended {
    fn from(error: E) -> Self {
        Ended::Failed(failed(&error))
    }
}

/// Evolves controllers for a scenario into a folder, and simulates the knee.
#[pyfunction]
#[pyo3(signature = (
    scenarios, *, out, evaluations, seed, paper, objectives, constraints, realities, motifs, scale, lab, set, threads, resume, progress
))]
#[expect(clippy::too_many_arguments, reason = "each is a keyword of its own in Python")]
pub fn evolve(
    py: Python<'_>,
    scenarios: Vec<GivenScenario<'_>>,
    out: PathBuf,
    evaluations: usize,
    seed: u64,
    paper: bool,
    objectives: Option<Vec<String>>,
    constraints: Option<Vec<String>>,
    realities: Option<usize>,
    motifs: &str,
    scale: f32,
    lab: String,
    set: Vec<String>,
    threads: usize,
    resume: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Found> {
    let scenarios = scenarios.into_iter().map(GivenScenario::get).collect::<PyResult<Vec<_>>>()?;
    if paper && (objectives.is_some() || constraints.is_some() || realities.is_some()) {
        return Err(refused("paper = True says what objectives, constraints and realities are: leave these out"));
    }
    let usual = if paper { Settings::default() } else { Settings::adaptive() };
    let objectives = objectives.map(Objectives::try_from).transpose().map_err(about("objectives"))?;
    let constraints = constraints.map(ConstraintNames::try_from).transpose().map_err(about("constraints"))?;
    let motifs = match motifs {
        "all" => MotifSet::All,
        "binary" => MotifSet::Binary,
        other => return Err(refused(format_args!("motifs = {other:?}: all or binary is needed"))),
    };
    let settings = Settings {
        seed,
        evaluations,
        motifs,
        objectives: objectives.unwrap_or(usual.objectives),
        constraints: constraints.unwrap_or(usual.constraints),
        realities: realities.unwrap_or(usual.realities),
        ..usual
    };
    scenarios.iter().try_for_each(|scenario| check_settings(scenario, &set))?;
    let order = Order { scenarios, settings, scale, lab: found(&lab, &set)?, out, resume };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(about("threads"))?;
    let tell =
        |py: Python<'_>, told: Progress| progress.as_ref().map_or(Ok(()), |call| call.call1(py, (told,)).map(drop));
    let ended = attended(py, tell, |stop, news| pool.install(|| order.carry_out(stop, news)))?;
    match ended {
        Ok(Brought { knee, feasible, works, notices }) => {
            Ok(Found { knee: Py::new(py, Blob { inner: knee })?, feasible, works, notices })
        }
        Err(Ended::Failed(error)) => Err(error),
        Err(Ended::Stopped) => Err(refused("interrupted")),
    }
}

impl Order {
    /// Does what `grn evolve` does: checks everything, takes the folder, searches, writes, simulates the knee.
    fn carry_out(&self, stop: &AtomicBool, news: &Sender<Progress>) -> Result<Brought, Ended> {
        let Order { scenarios, settings, scale, lab, out, resume } = self;
        let config = usual_config(*scale, lab.clone());
        for scenario in scenarios {
            let config = scenario.configured(config.clone());
            swarm::check(scenario, &config)?;
            check_length(scenario, &config)?;
        }
        let task = Task::new(scenarios.clone(), config)?;
        let manifest = Manifest::new(&task, settings.clone());
        Search::new(&task, settings.clone(), None)?;
        let (mut run, state) = if *resume {
            RunFolder::resume(out, "grn.evolve in Python", manifest, &task)?
        } else {
            (RunFolder::create(out, "grn.evolve in Python", manifest, &task)?, None)
        };
        let mut notices = run.notices().to_vec();
        let mut search = Search::new(&task, settings.clone(), state)?;
        loop {
            match search.advance(stop, &|_| ()) {
                Advance::Generation => run.save(search.state())?,
                Advance::Finished => break,
                Advance::Interrupted => return Err(Ended::Stopped),
            }
            // Nobody listens any more only when the caller has gone.
            let _ = search.state().history.last().map(|milestone| news.send(self.progress(milestone)));
        }
        let front = search.confirmed_front(stop, &|| ()).ok_or(Ended::Stopped)?;
        let feasible = front.iter().all(|member| member.is_feasible());
        let results = run.results(&search, &front)?;
        let (mut contents, knee) = (results.contents, results.knee);
        notices.extend(results.not_drawn);
        run.add(&contents)?;
        let mut works = feasible;
        let tried = if feasible { task.worlds() } else { &[] };
        for (place, scenario) in tried.iter().map(World::scenario).enumerate() {
            let watch =
                |_| if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
            let (config, number) = (scenario.configured(task.swarm().clone()), NumberType::F32);
            let mut recorder = record::recorder(scenario, &config);
            let simulation = simulation::simulate(&knee, scenario, config, number, &mut recorder, watch)?;
            let simulation = simulation.ok_or(Ended::Stopped)?;
            works &= simulation.verdict().works();
            let (recorded, not_drawn) = record::contents(&simulation, recorder.trace(), scenario, &knee);
            notices.extend(not_drawn);
            let below = of_world("simulation", place, tried.len(), "");
            contents.extend(recorded.into_iter().map(|(name, content)| (format!("{below}/{name}"), content)));
        }
        run.finish(&contents)?;
        Ok(Brought { knee, feasible, works, notices })
    }

    fn progress(&self, milestone: &Milestone) -> Progress {
        let &Milestone { evaluations, best_f2, best_cost, feasible, front, hypervolume } = milestone;
        Progress { evaluations, budget: self.settings.evaluations, best_f2, best_cost, feasible, front, hypervolume }
    }
}
