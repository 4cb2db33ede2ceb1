//! The tables that every run leaves, of whatever method: `front.csv` with a blob for each member, and `history.csv`.

use crate::evolve::{FrontMember, Milestone, Objectives};
use crate::files::{self, FileError, read_blob};
use grn_optimisers::knee::Knee;
use std::path::Path;
use std::str::FromStr;

const FRONT: &str = "front.csv";
const HISTORY: &str = "history.csv";

/// Writes a front's table; `blobs` are the members' blobs, by their paths within the folder.
///
/// # Errors
/// What the operating system says.
pub fn write_front(
    folder: &Path,
    objectives: &Objectives,
    front: &[FrontMember],
    blobs: &[String],
) -> Result<(), FileError> {
    let further: Vec<&str> = objectives.further_names().collect();
    let header = ["nodes", "f2"].into_iter().chain(further).chain(["violation", "knee", "expression", "blob"]);
    let row = |(member, blob): (&FrontMember, &String)| {
        let numbers = [member.nodes as f64, member.f2].into_iter().chain(member.further.iter().copied());
        let numbers = numbers.chain([member.violation]).map(|number| number.to_string());
        numbers.chain([member.knee.to_string(), member.expression(), blob.clone()]).collect::<Vec<_>>()
    };
    let rows = front.iter().zip(blobs).map(row);
    files::write(&folder.join(FRONT), files::csv(header, rows))
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

/// Writes a history.
///
/// # Errors
/// What the operating system says.
pub fn write_history(folder: &Path, history: &[Milestone]) -> Result<(), FileError> {
    files::write_csv(&folder.join(HISTORY), history)
}

/// The history in a run's folder.
///
/// # Errors
/// A file that is missing or damaged.
pub fn read_history(folder: &Path) -> Result<Vec<Milestone>, FileError> {
    files::read_csv(&folder.join(HISTORY))
}
