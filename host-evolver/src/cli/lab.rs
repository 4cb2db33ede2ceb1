//! `grn lab`.

use super::{Answer, Failure, output};
use firmware_sim::lab::{self, Shipped};

#[derive(clap::Args)]
pub struct Arguments {
    /// One of the laboratories that are shipped, or a file to check [default: list those that are shipped].
    laboratory: Option<String>,
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let Some(name) = &arguments.laboratory else {
        let line = |shipped: Shipped| format!("{:<17}{}", shipped.name(), shipped.summary());
        output::product(Shipped::ALL.map(line).join("\n"))?;
        return Ok(Answer::Yes);
    };
    let text = match Shipped::named(name) {
        Some(shipped) => shipped.text().to_owned(),
        None => lab::write(&lab::find(name)?),
    };
    output::product(text.trim_end())?;
    Ok(Answer::Yes)
}
