//! `grn eval`.

use super::output::Reader;
use super::{Answer, Failure, about, output};
use crate::files::read_blob;
use grn_core::blob::Blob;
use grn_core::network::Network;
use grn_core::scalar::{NumberType, Q8_24, Scalar};
use std::io::{BufRead, Read};
use std::path::PathBuf;
use std::str::FromStr;

/// The most bytes of a line.
const LONGEST_LINE: u64 = 1000;
/// The largest input: Q8.24 holds numbers below 128, and robots have x1 up to 4 and x2 up to 1.
const LARGEST: f64 = 100.0;

#[derive(clap::Args)]
pub struct Arguments {
    /// The controller.
    blob: PathBuf,
    /// Number type to compute in: f64, f32, q8.24.
    #[arg(long, default_value = "f64")]
    number: EvalNumber,
}

/// The host's reference, or what robots compute in.
#[derive(Clone, Copy)]
enum EvalNumber {
    F64,
    Robot(NumberType),
}

impl FromStr for EvalNumber {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, &'static str> {
        match text {
            "f64" => Ok(EvalNumber::F64),
            _ => text.parse().map(EvalNumber::Robot).map_err(|_| "f64, f32 or q8.24 is needed"),
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let blob = read_blob(&arguments.blob)?;
    let evaluate = evaluator(&blob, arguments.number);
    let mut input = std::io::stdin().lock();
    for number in 1.. {
        let mut line = Vec::new();
        let read = (&mut input).take(LONGEST_LINE).read_until(b'\n', &mut line).map_err(about("standard input"))?;
        if read == 0 {
            break;
        }
        let line = String::from_utf8_lossy(&line);
        let line = if number == 1 { line.trim_start_matches('\u{feff}') } else { &line };
        let line = line.trim_end_matches(['\r', '\n']);
        let [x1, x2] = parse(line).ok_or_else(|| {
            let shown: String = line.chars().take(60).collect();
            Failure::Input(format!(
                "standard input, line {number}: {shown:?} is not two numbers from -{LARGEST} to {LARGEST} like 0.5,0.25"
            ))
        })?;
        if output::product(evaluate(x1, x2))? == Reader::Gone {
            break;
        }
    }
    Ok(Answer::Yes)
}

fn parse(line: &str) -> Option<[f64; 2]> {
    let (x1, x2) = line.split_once(',')?;
    let number = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.abs() <= LARGEST);
    Some([number(x1)?, number(x2)?])
}

fn evaluator(blob: &Blob, number: EvalNumber) -> Box<dyn Fn(f64, f64) -> String> {
    fn steady<S: Scalar>(network: &Network<S>, x1: f64, x2: f64) -> S {
        network.steady_state(S::from_f64(x1), S::from_f64(x2))
    }
    let (in_f64, in_f32, in_q824) =
        (blob.network.cast::<f64>(), blob.network.cast::<f32>(), blob.network.cast::<Q8_24>());
    match number {
        EvalNumber::F64 => Box::new(move |x1, x2| steady(&in_f64, x1, x2).to_string()),
        EvalNumber::Robot(NumberType::F32) => Box::new(move |x1, x2| steady(&in_f32, x1, x2).to_string()),
        EvalNumber::Robot(NumberType::Q8_24) => Box::new(move |x1, x2| steady(&in_q824, x1, x2).to_f64().to_string()),
    }
}
