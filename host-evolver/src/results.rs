//! The tables that every run leaves, of whatever method: `front.csv` with a blob for each member, and `history.csv`.

use crate::evolve::{FrontMember, Milestone, Objectives, deployed};
use crate::files::{self, Contents, FileError, read_blob};
use crate::model::notation::Digits;
use grn_core::blob::Blob;
use grn_optimisers::knee::Knee;
use std::path::Path;
use std::str::FromStr;

const FRONT: &str = "front.csv";
const HISTORY: &str = "history.csv";
const KNEE: &str = "knee.grn";

/// What every run leaves, whatever is on its front.
pub const ALWAYS: [&str; 3] = [FRONT, HISTORY, KNEE];

/// The files of a front and its history by their paths in the run's folder, and the blob of the knee that is deployed; a
/// blob for each member lies in the folder `blobs_in`, which ends in `/` if it is not the run's own.
///
/// # Errors
/// A front without members, or a model that no blob can hold, by the file.
pub fn contents(
    objectives: &Objectives,
    front: &[FrontMember],
    history: &[Milestone],
    blob_of: impl Fn(&FrontMember) -> Blob,
    blobs_in: &str,
) -> Result<(Contents, Blob), FileError> {
    let mut contents = Contents::new();
    let mut names = Vec::new();
    let mut knee = None;
    for (place, member) in front.iter().enumerate() {
        let name = format!("{blobs_in}{place:02}-{}-nodes.grn", member.nodes);
        let blob = blob_of(member);
        let bytes = files::blob_bytes(&blob).map_err(|error| FileError::internal(&name, error))?;
        if place == deployed(front) {
            contents.insert(KNEE.into(), bytes.clone());
            knee = Some(blob);
        }
        contents.insert(name.clone(), bytes);
        names.push(name);
    }
    contents.insert(FRONT.into(), front_csv(objectives, front, &names));
    contents.insert(HISTORY.into(), history_csv(history));
    let knee = knee.ok_or_else(|| FileError::internal(FRONT, "the front is empty"))?;
    Ok((contents, knee))
}

fn front_csv(objectives: &Objectives, front: &[FrontMember], blobs: &[String]) -> Vec<u8> {
    let further: Vec<&str> = objectives.further_names().collect();
    let header = ["nodes", "f2"].into_iter().chain(further).chain(["violation", "knee", "expression", "blob"]);
    let row = |(member, blob): (&FrontMember, &String)| {
        let numbers = [member.nodes as f64, member.f2].into_iter().chain(member.further.iter().copied());
        let numbers = numbers.chain([member.violation]).map(|number| number.to_string());
        numbers.chain([member.knee.to_string(), member.expression(Digits::All), blob.clone()]).collect::<Vec<_>>()
    };
    files::csv(header, front.iter().zip(blobs).map(row))
}

/// The front in a run's folder.
///
/// # Errors
/// A file that is missing or damaged.
pub fn read_front(folder: &Path) -> Result<Vec<FrontMember>, FileError> {
    let path = folder.join(FRONT);
    let text = files::read_text(&path)?;
    let damaged = |fault: String| FileError::new(&path, format!("damaged: {fault}; delete the run's folder"));
    let mut csv = csv::Reader::from_reader(text.as_bytes());
    let header = csv.headers().map_err(|error| damaged(error.to_string()))?.clone();
    let places = Columns::of(&header).ok_or_else(|| damaged("columns are missing".into()))?;
    let mut front = Vec::new();
    for record in csv.records() {
        let record = record.map_err(|error| damaged(error.to_string()))?;
        front.push(places.member(&record, folder, &damaged)?);
    }
    Ok(front)
}

/// Where the columns of a front are.
struct Columns {
    nodes: usize,
    f2: usize,
    further: std::ops::Range<usize>,
    violation: usize,
    knee: usize,
    blob: usize,
}

impl Columns {
    fn of(header: &csv::StringRecord) -> Option<Columns> {
        let place = |name: &str| header.iter().position(|column| column == name);
        let (f2, violation) = (place("f2")?, place("violation")?);
        let further = f2 + 1..violation;
        Some(Columns { nodes: place("nodes")?, f2, further, violation, knee: place("knee")?, blob: place("blob")? })
    }

    fn member(
        &self,
        record: &csv::StringRecord,
        folder: &Path,
        damaged: &impl Fn(String) -> FileError,
    ) -> Result<FrontMember, FileError> {
        let blob = record.get(self.blob).unwrap_or_default();
        let further = self.further.clone().map(|place| number(record, place, damaged));
        Ok(FrontMember {
            network: read_blob(&folder.join(blob))?.network,
            nodes: number(record, self.nodes, damaged)?,
            f2: number(record, self.f2, damaged)?,
            further: further.collect::<Result<_, _>>()?,
            violation: number(record, self.violation, damaged)?,
            knee: number::<Knee>(record, self.knee, damaged)?,
        })
    }
}

fn number<T: FromStr>(
    record: &csv::StringRecord,
    place: usize,
    damaged: &impl Fn(String) -> FileError,
) -> Result<T, FileError> {
    let text = record.get(place).unwrap_or_default();
    let line = record.position().map_or(0, csv::Position::line);
    text.parse().map_err(|_| damaged(format!("line {line}, column {}: {text:?}", place + 1)))
}

fn history_csv(history: &[Milestone]) -> Vec<u8> {
    let line = |milestone: &Milestone| {
        let Milestone { evaluations, best_f2, best_cost, feasible, front, hypervolume } = milestone;
        let known = |value: &Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
        let counts = [feasible.to_string(), front.to_string(), hypervolume.to_string()];
        [evaluations.to_string(), known(best_f2), known(best_cost)].into_iter().chain(counts).collect::<Vec<_>>()
    };
    files::csv(["evaluations", "best_f2", "best_cost", "feasible", "front", "hypervolume"], history.iter().map(line))
}

/// The history in a run's folder.
///
/// # Errors
/// A file that is missing or damaged.
pub fn read_history(folder: &Path) -> Result<Vec<Milestone>, FileError> {
    files::read_csv(&folder.join(HISTORY))
}
