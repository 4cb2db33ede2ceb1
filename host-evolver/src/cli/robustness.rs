//! `grn simulate --realities`.

use super::{Answer, Failure, about, options, output, progress};
use crate::files::{self, Contents};
use crate::realities::{self, ENOUGH_REALITIES, Reality, Robustness};
use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use grn_input::Range;
use indicatif::ProgressBar;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The most realities: a share is known to a percent then.
const MOST: u64 = 10_000;
/// So many of the worst ones are named.
const NAMED: usize = 3;

pub fn count(text: &str) -> Result<u64, String> {
    options::within(text, &Range::new(1, MOST, "(a whole one)"))
}

pub fn number(text: &str) -> Result<u64, String> {
    options::within(text, &Range::new(0, MOST, "(a whole one)"))
}

/// A blob to be tried in laboratories around a nominal one.
pub struct Experiment<'a> {
    pub blob: &'a Blob,
    pub scenario: &'a Scenario,
    pub config: &'a SwarmConfig,
    pub number: NumberType,
}

impl Experiment<'_> {
    /// Tries it in realities 1 to `count`, with a progress bar and Ctrl-C.
    pub fn run(&self, path: &Path, count: u64, stop: &AtomicBool) -> Result<Robustness, Failure> {
        let &Experiment { blob, scenario, config, number } = self;
        let style = progress::style("simulating {bar:40} {pos}/{len} realities · {left}", &progress::Found::default());
        let bar = ProgressBar::new(count).with_style(style);
        let result = realities::try_all(blob, scenario, config, number, 1..=count, stop, &|| bar.inc(1));
        bar.finish_and_clear();
        result
            .map_err(about(path.display()))?
            .ok_or_else(|| Failure::Interrupted("Nothing was kept; run it again.".into()))
    }

    /// One line a reality, and everything else.
    pub fn files(&self, robustness: &Robustness) -> Result<Contents, Failure> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        let unwritten = |error: String| Failure::Program(format!("realities.csv: {error}"));
        for reality in &robustness.realities {
            csv.serialize(reality).map_err(|error| unwritten(error.to_string()))?;
        }
        let csv = csv.into_inner().map_err(|error| unwritten(error.to_string()))?;
        let json = files::json(&self.json(robustness));
        Ok(Contents::from([("realities.csv".into(), csv), ("realities.json".into(), json.into_bytes())]))
    }

    /// Prints what came out; yes if it works often enough.
    pub fn tell(&self, robustness: &Robustness, as_json: bool) -> Result<Answer, Failure> {
        if as_json {
            output::product_json(&self.json(robustness))?;
        } else {
            output::report(self.table(robustness));
        }
        Ok(if robustness.is_enough() { Answer::Yes } else { Answer::No })
    }

    fn json(&self, robustness: &Robustness) -> Value {
        let (low, high) = robustness.interval();
        let identity: String = self.blob.identity().iter().map(|byte| format!("{byte:02x}")).collect();
        json!({
            "grn": files::VERSION,
            "blob": identity,
            "number": self.number,
            "scenario": self.scenario.name(),
            "swarm": self.config,
            "caged_share": robustness.mean(|reality| reality.caged_share),
            "pen": robustness.mean(|reality| reality.pen),
            "in_band_share": robustness.mean(|reality| reality.in_band_share),
            "contact_share": robustness.mean(|reality| reality.contact_share),
            "lost_share": robustness.mean(|reality| reality.lost_share),
            "formed_at_s": robustness.mean_formed_at_s(),
            "cost": robustness.mean(|reality| reality.cost),
            "realities": robustness.realities,
            "works": robustness.works(),
            "works_share": robustness.mean(|reality| f64::from(u8::from(reality.works))),
            "works_interval": [low, high],
            "of": robustness.realities.len(),
            "enough": robustness.is_enough(),
            "worst": robustness.worst(NAMED).iter().map(|reality| reality.number).collect::<Vec<_>>(),
        })
    }

    fn table(&self, robustness: &Robustness) -> String {
        let percent = |share: f64| if share.is_finite() { format!("{:.1} %", share * 100.0) } else { "unknown".into() };
        let error = |reality: &Reality| reality.radial_error_share.unwrap_or(f64::INFINITY);
        // Quantiles from the good end of each measure to its bad one.
        let row = |name: &str, measure: &dyn Fn(&Reality) -> f64, text: &dyn Fn(f64) -> String| {
            let cell = |share| robustness.quantile(share, measure).map_or(String::new(), text);
            format!("{name:<28}{:>12}{:>12}{:>12}\n", cell(0.5), cell(0.95), cell(1.0))
        };
        let seconds = |time: f64| if time.is_finite() { format!("{time:.0} s") } else { "never".into() };
        let mut text = format!("{:<28}{:>12}{:>12}{:>12}\n", "", "median", "19 of 20", "worst");
        text += &row("not caged", &|reality| 1.0 - reality.caged_share, &percent);
        text += &row("out of the band", &|reality| 1.0 - reality.in_band_share, &percent);
        text += &row("in contact", &|reality| reality.contact_share, &percent);
        text += &row("robots lost", &|reality| reality.lost_share, &percent);
        text += &row("formed after", &|reality| reality.formed_at_s.unwrap_or(f64::INFINITY), &seconds);
        text += &row("cost J", &|reality| reality.cost, &|cost| format!("{cost:.3}"));
        if robustness.realities.iter().any(|reality| reality.reformed_encircled_share.is_some()) {
            let left_open = |reality: &Reality| 1.0 - reality.reformed_encircled_share.unwrap_or(1.0);
            text += &row("not encircled once re-formed", &left_open, &percent);
        }
        text += &row("radial error / ring", &error, &percent);
        let (works, of) = (robustness.works(), robustness.realities.len());
        let (low, high) = robustness.interval();
        text += &format!(
            "works in {works} of {of} realities of {} (95 % interval {:.1} to {:.1} %; wanted: at least {:.0} %)\n",
            self.config.lab.name,
            low * 100.0,
            high * 100.0,
            ENOUGH_REALITIES * 100.0
        );
        let named = robustness.worst(NAMED).into_iter().map(|reality| {
            let fails = if reality.works { "works" } else { "fails" };
            format!("{} ({fails}, caged {}, J {:.3})", reality.number, percent(reality.caged_share), reality.cost)
        });
        text += &format!("worst: {}; see one with --reality NUMBER", named.collect::<Vec<_>>().join(", "));
        text
    }
}
