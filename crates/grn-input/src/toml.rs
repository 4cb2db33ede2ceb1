//! TOML texts whose every fault has a place.

use crate::syntax::unclosed;
use crate::{InputError, Place};
use serde::de::{Deserialize, DeserializeOwned, Deserializer, IgnoredAny, SeqAccess, Visitor};
use serde::{Serialize, Serializer};
use std::fmt;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Values longer than this are shown by their beginning.
const MOST_SHOWN: usize = 60;

/// Two numbers. An array of three is an error, which it is not for serde's `[f64; 2]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair(pub [f64; 2]);

impl Serialize for Pair {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Pair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Two;
        impl<'de> Visitor<'de> for Two {
            type Value = Pair;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("two numbers, [x, y]")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Pair, A::Error> {
                let mut next =
                    |count| numbers.next_element()?.ok_or_else(|| serde::de::Error::invalid_length(count, &self));
                let pair = Pair([next(0)?, next(1)?]);
                match numbers.next_element::<IgnoredAny>()? {
                    None => Ok(pair),
                    Some(_) => Err(serde::de::Error::invalid_length(3, &self)),
                }
            }
        }
        deserializer.deserialize_seq(Two)
    }
}

/// Parses a text into `F` and checks that.
///
/// # Errors
/// Text that is not TOML, a wrong type, an unknown or missing key, or what `check` says, with the place in the text.
pub fn parse<F: DeserializeOwned, T>(
    text: &str,
    check: impl FnOnce(F) -> Result<T, InputError>,
) -> Result<T, InputError> {
    let root = DeTable::parse(text).map_err(|error| syntax_error(text, &error))?;
    let file = F::deserialize(toml::de::Deserializer::from(root.clone())).map_err(|e| shape_error(text, &root, &e))?;
    check(file).map_err(|error| placed(text, &root, error))
}

/// The error with the place of its key in a text, if that can be found.
pub fn locate(text: &str, error: InputError) -> InputError {
    match DeTable::parse(text) {
        Ok(root) => placed(text, &root, error),
        Err(_) => error,
    }
}

fn placed(text: &str, root: &Spanned<DeTable<'_>>, error: InputError) -> InputError {
    if error.key().is_empty() || error.place().is_some() || error.file().is_some() {
        return error;
    }
    let Some((span, whole)) = span_of(root.get_ref(), error.key()) else { return error };
    let written = text.get(span.clone()).unwrap_or_default();
    // The span of a table is its header, and of a list perhaps the count is wrong: then the check tells the value.
    let show = whole && written.starts_with('[') == error.value().starts_with('[') && !error.value().is_empty();
    let show = show && !written.contains('\n') && written.len() <= MOST_SHOWN;
    let error = error.at(Place::of(text, span));
    if show { error.written(written) } else { error }
}

/// The bytes of the value of a key such as `target[1].path[0]`, or of the innermost part of it that is there; and whether
/// it is there as a whole.
fn span_of(root: &DeTable<'_>, key: &str) -> Option<(Range<usize>, bool)> {
    let mut table = Some(root);
    let mut value: Option<&Spanned<DeValue<'_>>> = None;
    let mut parts = key.split(['.', '[']).map(|part| part.trim_end_matches(']'));
    let whole = parts.all(|part| {
        let next = match (table, value.map(Spanned::get_ref)) {
            (Some(inner), _) => inner.get(part),
            (None, Some(DeValue::Array(list))) => part.parse().ok().and_then(|place: usize| list.get(place)),
            _ => None,
        };
        if let Some(next) = next {
            value = Some(next);
            table = next.get_ref().as_table();
        }
        next.is_some()
    });
    value.map(|value| (value.span(), whole))
}

fn syntax_error(text: &str, error: &toml::de::Error) -> InputError {
    let span = error.span().unwrap_or(0..0);
    if let Some((opened, mark)) = unclosed(text, span.start) {
        let way_out = match mark {
            "[" => "the list that begins here is not closed; add ]",
            "{" => "the table that begins here is not closed; add }",
            _ => "the text that begins here is not closed; end it with the same three quotes",
        };
        return InputError::new("", "", way_out).at(Place::of(text, opened..opened + mark.len()));
    }
    let place = Place::of(text, span);
    if place.text.trim_end().ends_with('=') {
        return InputError::new("", shown(&place.text), "a value is missing").at(place);
    }
    InputError::new("", shown(&place.text), error.message().trim().replace('\n', ", ")).at(place)
}

fn shown(line: &str) -> String {
    let line = line.trim();
    match line.char_indices().nth(MOST_SHOWN) {
        Some((end, _)) => format!("{} …", &line[..end]),
        None => line.to_owned(),
    }
}

/// From the message of serde, which names keys in backticks.
fn shape_error(text: &str, root: &Spanned<DeTable<'_>>, error: &toml::de::Error) -> InputError {
    let message = error.message().trim().replace('\n', ", ");
    let span = error.span().unwrap_or(0..0);
    let within = error.span().and_then(|span| key_at(root.get_ref(), span.start)).unwrap_or_default();
    let place = Place::of(text, span.clone());
    let names: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    if message.starts_with("unknown field") {
        let (unknown, known) = names.split_first().map_or(("", &[][..]), |(first, rest)| (*first, rest));
        let key = if within.ends_with(unknown) { within } else { joined(&within, unknown) };
        let nearest = known.iter().max_by(|a, b| likeness(unknown, a).total_cmp(&likeness(unknown, b)));
        let meant = nearest.filter(|near| likeness(unknown, near) > 0.75);
        let meant = meant.map_or(String::new(), |near| format!("; did you mean {near}?"));
        let expected = format!("unknown key{meant} (known here: {})", known.join(", "));
        return InputError::new(key, "", expected).at(place);
    }
    if message.starts_with("missing field") {
        let missing = names.first().copied().unwrap_or_default();
        return InputError::new(joined(&within, missing), "", "is missing; add it").at(place);
    }
    let written = text.get(span).unwrap_or_default();
    let expected = wrong_type(&message).unwrap_or(message);
    InputError::new(within, shown(written.lines().next().unwrap_or_default()), expected).at(place)
}

/// From `invalid type: WHAT IS THERE, expected WHAT IS NEEDED`, with Rust's names of types, to words of TOML.
fn wrong_type(message: &str) -> Option<String> {
    // An integer that is no i64 is of the right type for serde.
    let too_large = || message.strip_prefix("invalid value: ").filter(|rest| rest.ends_with("expected i64"));
    let (found, needed) = message.strip_prefix("invalid type: ").or_else(too_large)?.rsplit_once(", expected ")?;
    let needed = match needed {
        "f64" => "a number",
        "i64" if found.starts_with("floating point") => "a whole number, without point and exponent",
        "i64" if found.starts_with("integer") => return Some("must be a smaller whole number".into()),
        "i64" => "a whole number",
        "a sequence" => "a list",
        "a map" => "a table",
        "a boolean" => "true or false",
        "a string" => "a text in quotes",
        _ if needed.starts_with("struct ") => "a table",
        other => other,
    };
    let kinds = [
        ("floating point", "a number"),
        ("integer", "a whole number"),
        ("string", "a text"),
        ("boolean", "true or false"),
        ("sequence", "a list"),
        ("map", "a table"),
    ];
    let found = kinds.iter().find(|(kind, _)| found.starts_with(kind)).map_or(found, |(_, words)| words);
    Some(format!("must be {needed}, and is {found}"))
}

fn likeness(a: &str, b: &str) -> f64 {
    strsim::normalized_damerau_levenshtein(a, b).max(strsim::jaro_winkler(a, b) - 0.1)
}

fn joined(table: &str, key: &str) -> String {
    if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") }
}

/// The innermost key whose name or value holds a byte of the text.
fn key_at(table: &DeTable<'_>, at: usize) -> Option<String> {
    table.iter().find_map(|(name, value)| {
        let key = name.get_ref().as_ref();
        match within(value, at) {
            Some(rest) => Some(format!("{key}{rest}")),
            None => (name.span().contains(&at) || value.span().contains(&at)).then(|| key.to_owned()),
        }
    })
}

/// The same within a value, as it is written behind the value's own key.
fn within(value: &Spanned<DeValue<'_>>, at: usize) -> Option<String> {
    match value.get_ref() {
        DeValue::Table(table) => key_at(table, at).map(|key| format!(".{key}")),
        DeValue::Array(list) => list.iter().enumerate().find_map(|(place, value)| match within(value, at) {
            Some(rest) => Some(format!("[{place}]{rest}")),
            None => value.span().contains(&at).then(|| format!("[{place}]")),
        }),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct File {
        region: Pair,
        ring: Ring,
        #[serde(default)]
        target: Vec<Target>,
    }

    #[derive(serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Ring {
        d_min: f64,
        count: i64,
    }

    #[derive(serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Target {
        path: Vec<Pair>,
    }

    const GOOD: &str = "region = [20.0, 1e1]\n[ring]\nd_min = 1.0\ncount = 3\n[[target]]\npath = [[1, 2], [3, 4]]\n";

    fn fault(from: &str, to: &str) -> String {
        assert!(GOOD.contains(from));
        let text = GOOD.replace(from, to);
        let check = |file: File| match file {
            File { region: Pair([_, north]), .. } if north > 10.0 => Err(InputError::new("region[1]", north, "no")),
            File { ring: Ring { d_min, .. }, .. } if d_min > 1.0 => Err(InputError::new("ring.d_min", d_min, "no")),
            File { ring: Ring { count, .. }, .. } if count > 3 => Err(InputError::new("ring.other", count, "no")),
            File { target, .. } if target.iter().any(|t| t.path[1].0[1] > 4.0) => {
                Err(InputError::new("target[0].path[1]", "[3, 9]", "no"))
            }
            _ => Ok(()),
        };
        parse(&text, check).unwrap_err().to_string()
    }

    #[test]
    fn every_fault_has_its_place() {
        for (from, to, expected) in [
            ("1e1", "1e9", "line 1:17: region[1] = 1e9: no"),
            ("1.0", "2.50", "line 3:9: ring.d_min = 2.50: no"),
            ("4", "9", "line 6:17: target[0].path[1] = [3, 9]: no"),
            ("count = 3", "count = 5", "line 2:1: ring.other = 5: no"),
            ("count", "cuont", "line 4:1: ring.cuont: unknown key; did you mean count? (known here: d_min, count)"),
            ("[ring]", "[[ring]]", "line 2:1: ring"),
            ("count = 3\n", "", "line 2:1: ring.count: is missing; add it"),
            (
                "3, 4",
                "3, 4, 5",
                "line 6:17: target[0].path[1] = [3, 4, 5]: invalid length 3, expected two numbers, [x, y]",
            ),
            ("3, 4", "3", "line 6:17: target[0].path[1] = [3]: invalid length 1, expected two numbers"),
            (
                "count = 3",
                "count = 3.5",
                "line 4:9: ring.count = 3.5: must be a whole number, without point and exponent, and is a number",
            ),
            ("count = 3", "count = 5e-324", "line 4:9: ring.count = 5e-324: must be a whole number"),
            (
                "count = 3",
                "count = 99999999999999999999",
                "line 4:9: ring.count = 99999999999999999999: must be a smaller whole number",
            ),
            (
                "count = 3",
                "count = 9223372036854775808",
                "line 4:9: ring.count = 9223372036854775808: must be a smaller whole number",
            ),
            ("d_min = 1.0", "d_min = \"1\"", "line 3:9: ring.d_min = \"1\": must be a number, and is a text"),
            ("d_min = 1.0", "d_min = [1]", "line 3:9: ring.d_min = [1]: must be a number, and is a list"),
            ("d_min = 1.0", "d_min = { m = 1 }", "line 3:9: ring.d_min = { m = 1 }: must be a number, and is a table"),
            ("d_min = 1.0", "d_min = 2026-01-01", "line 3:9: ring.d_min = 2026-01-01: must be a number, and is "),
            ("[20.0, 1e1]", "20.0", "line 1:10: region = 20.0: must be two numbers, [x, y], and is a number"),
            ("[[target]]", "[target]", "line 5:1: target = [target]: must be a list, and is a table"),
            ("[20.0, 1e1]", "[20.0, 1e1", "line 1:10: the list that begins here is not closed; add ]"),
            ("[[1, 2], [3, 4]]", "[[1, 2], [3, 4]", "line 6:23: path = [[1, 2], [3, 4]: unclosed array"),
            ("[ring]", "[ring", "line 2:6: [ring: unclosed table"),
            ("1.0", "1,0", "line 3:10: d_min = 1,0: "),
        ] {
            let error = fault(from, to);
            assert!(error.starts_with(expected), "{to}: {error}");
        }
    }
}
