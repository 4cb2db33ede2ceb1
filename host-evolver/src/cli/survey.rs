//! `grn survey`.

use super::conditions::Conditions;
use super::failure::{Blame, Fault};
use super::{Answer, Failure, interrupt, options, output, progress, robustness};
use crate::files::{self, FileError, read_blob};
use crate::missions::MissionRow;
use crate::simulation::DEFAULT_SPEED;
use crate::survey::{self, Contender, Group, Listener, Row, Survey, SurveyError};
use grn_core::scalar::NumberType;
use indicatif::ProgressBar;
use serde_json::{Value, json};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// How often what is done is written while more is being done.
const KEPT_EVERY: Duration = Duration::from_secs(20);
const WORDS: &str = "\
A mission counts as caged if its targets are caged at least 95 % of the time, in the mean over the realities. Shares of
missions have Wilson's 95 % interval. With --out, a survey that was stopped is gone on with by the same command, and one
with more blobs or missions takes over the trials that are in the file.";

#[derive(clap::Args)]
#[command(after_help = WORDS)]
pub struct Arguments {
    /// A folder that grn missions has filled.
    missions: PathBuf,
    /// The controllers.
    #[arg(required_unless_present = "circle", value_name = "BLOB")]
    blobs: Vec<PathBuf>,
    /// Try the best circle of each mission, too, which does not adapt.
    #[arg(long)]
    circle: bool,
    #[command(flatten)]
    conditions: Conditions,
    /// Simulate each mission in so many laboratories drawn around this one.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = robustness::count, allow_hyphen_values = true)]
    realities: u64,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1, value_parser = options::seed, allow_hyphen_values = true)]
    seed: u64,
    /// World metres per scenario metre [default: each blob's].
    #[arg(long, value_parser = options::scale, allow_hyphen_values = true)]
    scale: Option<f32>,
    /// Speed of the target with the longest path, metres per second in the world.
    #[arg(long, default_value_t = DEFAULT_SPEED, value_parser = options::speed, allow_hyphen_values = true)]
    speed: f64,
    /// Number type the robots compute in.
    #[arg(long, default_value = "f32")]
    number: NumberType,
    /// Threads to work with, up to 8 a core; the results do not depend on it [default: all cores].
    #[arg(long, value_parser = options::threads, allow_hyphen_values = true)]
    threads: Option<NonZeroUsize>,
    /// A line for each mission and model; kept while the survey runs, and gone on with.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

impl Blame for SurveyError {
    fn fault(&self) -> Fault {
        match self {
            SurveyError::World(error) | SurveyError::Swarm(_, error) => error.fault(),
            SurveyError::Model(_, error) => error.fault(),
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let survey = arguments.survey()?;
    let (known, others) = survey.known(arguments.rows_of_file()?);
    if let (Some(out), Some(row)) = (&arguments.out, others.first()) {
        let fault = format!(
            "has {} lines of other trials, the first of {} in {}; choose another file with --out, or delete it",
            others.len(),
            row.model,
            row.mission
        );
        return Err(FileError::new(out, fault).into());
    }
    if let Some(out) = &arguments.out {
        files::probe(out)?;
    }
    let stop = interrupt::watch()?;
    let pool = options::pool(arguments.threads)?;
    let found = progress::Found::default();
    let taken_over = known.iter().flatten().count() as u64;
    let of_file: u64 = known.iter().flatten().map(|row| row.robot_ticks).sum();
    found.add(taken_over * arguments.realities);
    let style = progress::style("simulating {bar:40} {pos}/{len} runs · {left}", &found);
    let bar = ProgressBar::new(survey.trials() as u64 * arguments.realities).with_style(style);
    bar.inc(taken_over * arguments.realities);
    let begin = Instant::now();
    let kept: Mutex<Option<Instant>> = Mutex::new(None);
    let keep = |rows: &[Option<Row>]| {
        let Some(out) = &arguments.out else { return };
        let Ok(mut kept) = kept.try_lock() else { return };
        if kept.is_none_or(|last| last.elapsed() >= KEPT_EVERY) {
            // If that cannot be written now, it may be in the end; then it is told.
            let _ = files::write(out, csv(rows));
            *kept = Some(Instant::now());
        }
    };
    let listener = Listener { simulated: &|| bar.inc(1), rows: &keep };
    let rows = pool.install(|| survey.run(known, &stop, &listener));
    bar.finish_and_clear();
    let rows = rows?;
    if let Some(out) = &arguments.out {
        files::write(out, csv(&rows))?;
    }
    let done: Vec<Row> = rows.into_iter().flatten().collect();
    if done.len() < survey.trials() {
        return Err(Failure::Interrupted(match &arguments.out {
            Some(out) => format!(
                "{} holds {} of {} trials; the same command goes on",
                out.display(),
                done.len(),
                survey.trials()
            ),
            None => "Nothing was kept; with --out FILE.csv it could have gone on.".into(),
        }));
    }
    let models: Vec<&str> = survey.contenders().iter().map(|contender| contender.name.as_str()).collect();
    let groups = survey::groups(survey.missions(), &models, &done);
    let robot_ticks: u64 = done.iter().map(|row| row.robot_ticks).sum();
    let work = Work { robot_ticks, now: robot_ticks - of_file, seconds: begin.elapsed().as_secs_f64() };
    if arguments.json {
        output::product_json(&arguments.as_json(&survey, &groups, &work))?;
    } else {
        output::report(table(&groups));
        output::report(arguments.described(&survey, &work));
    }
    Ok(Answer::Yes)
}

/// What a survey took.
struct Work {
    robot_ticks: u64,
    /// Those of this process.
    now: u64,
    seconds: f64,
}

impl Arguments {
    fn survey(&self) -> Result<Survey, Failure> {
        let mut contenders = Vec::new();
        for path in &self.blobs {
            let mut blob = read_blob(path)?;
            blob.scale = self.scale.unwrap_or(blob.scale);
            files::blob_bytes(&blob).map_err(super::about("--scale"))?;
            contenders.push(Contender::blob(path.display().to_string(), blob));
        }
        if self.circle {
            contenders.push(Contender::best_circle(self.scale));
        }
        let names: Vec<&str> = contenders.iter().map(|contender| contender.name.as_str()).collect();
        if let Some(place) = (1..names.len()).find(|&place| names[..place].contains(&names[place])) {
            return Err(Failure::Input(format!("{}: is given twice; leave one of them out", names[place])));
        }
        let missions = MissionRow::read_all(&self.missions)?;
        let lab = self.conditions.laboratory()?;
        self.conditions.check_files(missions.iter().map(|mission| self.missions.join(&mission.file)))?;
        let conditions = survey::Conditions {
            lab,
            realities: self.realities,
            seed: self.seed,
            speed_m_per_s: self.speed,
            number: self.number,
        };
        let pool = options::pool(self.threads)?;
        Ok(pool.install(|| Survey::new(&self.missions, missions, contenders, conditions))?)
    }

    /// The rows that are in the file already.
    fn rows_of_file(&self) -> Result<Vec<Row>, Failure> {
        let Some(out) = self.out.as_deref().filter(|out| out.is_file()) else { return Ok(Vec::new()) };
        let text = files::read_text(out)?;
        files::parse_csv(&text).map_err(|error| {
            let fault = format!("is no table of a survey ({error}); choose another file with --out, or delete it");
            FileError::new(out, fault).into()
        })
    }

    fn as_json(&self, survey: &Survey, groups: &[Group], work: &Work) -> Value {
        let conditions = survey.conditions();
        json!({
            "grn": files::VERSION,
            "missions": self.missions,
            "laboratory": conditions.lab,
            "realities": conditions.realities,
            "seed": conditions.seed,
            "speed_m_per_s": conditions.speed_m_per_s,
            "number": conditions.number,
            "groups": groups,
            "robot_ticks": work.robot_ticks,
            "robot_ticks_now": work.now,
            "seconds": work.seconds,
        })
    }

    fn described(&self, survey: &Survey, work: &Work) -> String {
        let million = |ticks: u64| ticks as f64 / 1e6;
        let (models, missions) = (survey.contenders().len(), survey.missions().count());
        let pace = million(work.now) / work.seconds.max(1e-3);
        format!(
            "{models} models in {missions} missions in {} realities of {}: {:.1} million robot-ticks, of which {:.1} million in \
             these {:.0} s ({pace:.2} million a second)",
            self.realities,
            survey.conditions().lab.name,
            million(work.robot_ticks),
            million(work.now),
            work.seconds,
        )
    }
}

fn csv(rows: &[Option<Row>]) -> Vec<u8> {
    files::csv_records(&rows.iter().flatten().collect::<Vec<_>>())
}

/// A line for each group and model.
fn table(groups: &[Group]) -> String {
    let names = groups.iter().flat_map(|group| &group.models).map(|tally| tally.model.chars().count());
    let width = names.max().unwrap_or(0).max("model".len());
    let mut text = format!(
        "{:<14}{:>8}  {:<14}  {:<width$}{:>9}  {:<16}{:>8}{:>8}\n",
        "", "missions", "difficulty", "model", "caged", "95 % interval", "works", "cost J"
    );
    let percent = |share: f64| format!("{:.1} %", share * 100.0);
    for group in groups {
        let [least, most] = group.difficulty;
        let mut about = [group.name.clone(), group.missions.to_string(), format!("{least:.2} to {most:.2}")];
        for tally in &group.models {
            let [name, missions, difficulty] = about;
            about = Default::default();
            let [low, high] = tally.interval.map(|share| share * 100.0);
            text += &format!(
                "{name:<14}{missions:>8}  {difficulty:<14}  {:<width$}{:>9}  {:<16}{:>8}{:>8.3}\n",
                tally.model,
                percent(tally.caged_share),
                format!("{low:.1} to {high:.1} %"),
                percent(tally.works_share),
                tally.cost,
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::survey::Tally;

    #[test]
    fn the_table_has_a_line_for_each_group_and_model() {
        let tally = |model: &str, caged| Tally {
            model: model.into(),
            caged,
            caged_share: caged as f64 / 8.0,
            interval: [0.25, 0.75],
            works_share: 0.5,
            cost: 0.1234,
        };
        let group = |name: &str| Group {
            name: name.into(),
            missions: 8,
            difficulty: [0.0, 1.25],
            models: vec![tally("a.grn", 4), tally("circle", 1)],
        };
        let text = table(&[group("all"), group("sliding-door")]);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 5);
        assert_eq!(
            lines[1],
            "all                  8  0.00 to 1.25    a.grn    50.0 %  25.0 to 75.0 %    50.0 %   0.123"
        );
        assert!(lines[2].starts_with(&" ".repeat(40)) && lines[2].contains("circle   12.5 %"), "{}", lines[2]);
        assert!(lines[3].starts_with("sliding-door         8"), "{}", lines[3]);
    }
}
