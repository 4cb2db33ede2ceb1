//! Laboratories as text: files, those that are shipped, and single values set on the command line.

use super::{Laboratory, Shipped};
use grn_input::{Found, InputError, locate, read_text};
use std::path::Path;
use toml::{Table, Value};

/// The laboratory that a file based on another one names, in the file.
const BASE: &str = "base";
const UNWRITABLE: &str = "a laboratory has text, numbers and tables only, which TOML holds";

/// The laboratory of this name, or in this file: a word without a dot or slash is a name.
///
/// # Errors
/// No such name, or what [`parse`] says of the file.
pub fn find(name_or_path: &str) -> Result<Laboratory, InputError> {
    if let Some(shipped) = Shipped::named(name_or_path) {
        return Ok(shipped.laboratory());
    }
    let path = Path::new(name_or_path);
    if !name_or_path.contains(['.', '/', '\\']) && !path.exists() {
        let known = Shipped::ALL.map(Shipped::name).join(", ");
        let way_out =
            format!("no laboratory of this name is shipped ({known}) and no file is called so; give one or the other");
        return Err(InputError::new("--lab", name_or_path, way_out));
    }
    parse(&read_text(path, Found::Laboratory)?).map_err(|error| error.in_file(path))
}

/// The laboratory in this text.
///
/// # Errors
/// Text that is not TOML, an unknown key, a wrong type or an impossible value, with its place.
pub fn parse(text: &str) -> Result<Laboratory, InputError> {
    // Read as it stands first: that finds every fault of its own with its place.
    let written = grn_input::parse(text, Ok::<Laboratory, InputError>)?;
    let base = match written.base.as_deref() {
        None => Shipped::Ideal,
        Some(name) => Shipped::named(name).ok_or_else(|| {
            let known = Shipped::ALL.map(Shipped::name).join(", ");
            locate(text, InputError::new(BASE, name, format!("must be a laboratory that is shipped: {known}")))
        })?,
    };
    let mut merged = table(&base.laboratory());
    merge(&mut merged, toml::from_str(text).map_err(|error| from_toml("", &error))?);
    let laboratory: Laboratory = merged.try_into().map_err(|error| from_toml("", &error))?;
    laboratory.checked().map_err(|error| locate(text, error))
}

/// The laboratory with one value replaced: `radio.loss=0.3`. The value is written as in a file.
///
/// # Errors
/// No such key, no value, or an impossible one; the error's key is the one that was to be set.
pub fn set(laboratory: Laboratory, assignment: &str) -> Result<Laboratory, InputError> {
    let Some((key, value)) = assignment.split_once('=').map(|(key, value)| (key.trim(), value.trim())) else {
        return Err(InputError::new("--set", assignment, "must be KEY=VALUE, such as radio.loss=0.3"));
    };
    let parsed: Table = toml::from_str(&format!("value = {value}"))
        .or_else(|_| toml::from_str(&format!("value = {}", Value::from(value))))
        .map_err(|error| from_toml(key, &error))?;
    let mut whole = table(&laboratory);
    let (Some(slot), Some(value)) = (entry(&mut whole, key), parsed.get("value")) else {
        return Err(unknown_key(key, &laboratory));
    };
    if slot.is_table() {
        let keys = slot.as_table().map(|table| table.keys().cloned().collect::<Vec<_>>().join(", "));
        let way_out = format!("is a table; set one of its keys ({})", keys.unwrap_or_default());
        return Err(InputError::new(key, value, way_out));
    }
    *slot = match (&*slot, value) {
        (Value::Float(_), Value::Integer(whole)) => Value::Float(*whole as f64),
        _ => value.clone(),
    };
    let changed: Laboratory = whole.try_into().map_err(|error| from_toml(key, &error))?;
    changed.checked()
}

/// A laboratory as a file holds it, every value written out.
pub fn write(laboratory: &Laboratory) -> String {
    match toml::to_string(laboratory) {
        Ok(text) => text,
        Err(error) => unreachable!("{UNWRITABLE}: {error}"),
    }
}

/// The value of a key with dots.
fn entry<'t>(table: &'t mut Table, key: &str) -> Option<&'t mut Value> {
    match key.split_once('.') {
        None => table.get_mut(key),
        Some((first, rest)) => entry(table.get_mut(first)?.as_table_mut()?, rest),
    }
}

fn table(laboratory: &Laboratory) -> Table {
    match Table::try_from(laboratory) {
        Ok(table) => table,
        Err(error) => unreachable!("{UNWRITABLE}: {error}"),
    }
}

fn merge(base: &mut Table, own: Table) {
    for (key, value) in own {
        match (base.get_mut(&key), value) {
            (Some(Value::Table(inner)), Value::Table(own)) => merge(inner, own),
            (_, value) => drop(base.insert(key, value)),
        }
    }
}

/// Every key with a value, with dots.
fn keys(table: &Table, before: &str) -> Vec<String> {
    let key_of = |(key, value): (&String, &Value)| match value {
        Value::Table(inner) => keys(inner, &format!("{before}{key}.")),
        _ => vec![format!("{before}{key}")],
    };
    table.iter().flat_map(key_of).collect()
}

fn unknown_key(key: &str, laboratory: &Laboratory) -> InputError {
    let known = keys(&table(laboratory), "");
    let nearest = known.iter().max_by(|a, b| strsim::jaro_winkler(key, a).total_cmp(&strsim::jaro_winkler(key, b)));
    let meant = nearest.map_or(String::new(), |near| format!("; did you mean {near}?"));
    InputError::new(key, "", format!("unknown key{meant} (grn lab NAME lists them)"))
}

fn from_toml(key: &str, error: &toml::de::Error) -> InputError {
    InputError::new(key, "", error.message().trim().replace('\n', ", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_as_in_the_base() {
        let tracked = Shipped::Tracked.laboratory();
        let mine = parse("name = \"mine\"\nbase = \"e-puck2-tracked\"\n[radio]\nloss = 0.5\n").unwrap();
        assert_eq!((mine.radio.loss, mine.name.as_str()), (0.5, "mine"));
        assert_eq!(mine.localisation, tracked.localisation);
        assert_eq!(mine.radio.latency_s, tracked.radio.latency_s);
        assert_eq!(parse("").unwrap(), Laboratory::default());
    }

    #[test]
    fn what_is_written_is_read() {
        for shipped in Shipped::ALL {
            let laboratory = shipped.laboratory();
            assert_eq!(parse(&write(&laboratory)).unwrap(), laboratory);
        }
    }

    #[test]
    fn one_value_can_be_set() {
        let set = |assignment| set(Laboratory::default(), assignment).map_err(|error| error.to_string());
        assert_eq!(set("radio.loss=0.3").unwrap().radio.loss, 0.3);
        assert_eq!(set(" radio.loss = 1 ").unwrap().radio.loss, 1.0);
        assert_eq!(set("robots.count=7").unwrap().robots.count, 7);
        assert!(!set("timing.in_phase=false").unwrap().timing.in_phase);
        assert_eq!(set("proximity.response=webots").unwrap().proximity.response, crate::lab::Response::Webots);
        for (assignment, expected) in [
            ("radio.loss=1.5", "radio.loss = 1.5: must be a number from 0 to 1"),
            ("radio.lost=0.5", "radio.lost: unknown key; did you mean radio.loss?"),
            ("radio=0.5", "radio = 0.5: is a table; set one of its keys (bodies_block, "),
            ("loss", "--set = loss: must be KEY=VALUE"),
            ("radio.loss=much", "radio.loss: invalid type: string \"much\", expected"),
            ("radio.loss=", "radio.loss: "),
            ("radio.loss.x=1", "radio.loss.x: unknown key"),
        ] {
            let error = set(assignment).unwrap_err();
            assert!(error.starts_with(expected), "{assignment}: {error}");
        }
    }
}
