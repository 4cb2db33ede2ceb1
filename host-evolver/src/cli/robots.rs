//! `grn robots`.

use super::flash::DEFAULT_BAUD;
use super::{Answer, Failure, output};
use grn_core::robot::link::message::{About, RobotStatus, Status};
use grn_core::robot::slots::Stage;
use grn_link::{Client, LinkError, Patience, Port, Wire};
use std::time::Duration;

#[derive(clap::Args)]
pub struct Arguments {
    /// Where to ask: serial ports, tcp:HOST:PORT, unix:PATH [default: all serial ports].
    ports: Vec<Port>,
    /// Baud rate of serial ports.
    #[arg(long, default_value_t = DEFAULT_BAUD)]
    baud: u32,
}

/// A port without a robot must not hold the list up.
const PATIENCE: Patience =
    Patience { response: Duration::from_millis(200), erasure: Duration::from_millis(200), tries: 3 };

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let ports = if arguments.ports.is_empty() { Port::serial_ports()? } else { arguments.ports.clone() };
    if ports.is_empty() {
        output::product("no serial ports here; name others as tcp:HOST:PORT or unix:PATH")?;
        return Ok(Answer::No);
    }
    let mut found = false;
    for port in ports {
        let answer = port.open(arguments.baud).map_err(LinkError::from).and_then(ask);
        found |= answer.is_ok();
        output::product(match answer {
            Ok((about, status)) => format!("{port}: {}", described(&about, &status)),
            Err(error) => format!("{port}: {error}"),
        })?;
    }
    Ok(if found { Answer::Yes } else { Answer::No })
}

fn ask(wire: Box<dyn Wire>) -> Result<(About, RobotStatus), LinkError> {
    let (mut client, about) = Client::connect(wire, PATIENCE)?;
    let status = client.ask(&Status)?;
    Ok((about, status))
}

fn described(about: &About, status: &RobotStatus) -> String {
    let About { protocol, blob_format, genes, number_type, name, .. } = about;
    let mut text =
        format!("{name}, {number_type}, link version {protocol}, blob format {blob_format}, at most {genes} genes");
    for (place, slot) in status.slots.iter().enumerate() {
        let stage = match slot.stage {
            Stage::Empty => "empty",
            Stage::Partial => "upload not finished",
            Stage::Verified => "ready",
            Stage::Trial => "on trial",
            Stage::Confirmed => "confirmed",
            Stage::Rejected => "rolled back",
        };
        let identity: String = slot.identity.iter().map(|byte| format!("{byte:02x}")).collect();
        let charge = if status.active == Some(place as u8) {
            format!(", in charge for {} ticks", status.ticks)
        } else {
            String::new()
        };
        let content = if slot.stage == Stage::Empty { String::new() } else { format!(" {identity}") };
        text += &format!("\n  slot {place}:{content} {stage}{charge}");
    }
    text
}
