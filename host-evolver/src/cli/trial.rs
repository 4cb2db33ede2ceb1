//! `grn confirm` and `grn rollback`: how the trial of a blob ends.

use super::connection::{
    CONNECT_LIMIT, ConnectionError, DEFAULT_BAUD, connect, described, failed, hexadecimal, in_charge,
};
use super::{Answer, Failure, options, output, told};
use grn_core::robot::link::Refusal;
use grn_core::robot::link::message::{Confirm, RollBack, Status};
use grn_core::robot::slots::Stage;
use grn_link::{LinkError, Patience, Port};

#[derive(clap::Args)]
pub struct Arguments {
    /// The robots: serial ports, tcp:HOST:PORT, unix:PATH.
    #[arg(required = true, value_name = "PORT")]
    ports: Vec<Port>,
    /// Baud rate of serial ports.
    #[arg(long, default_value_t = DEFAULT_BAUD, value_parser = options::baud, allow_hyphen_values = true)]
    baud: u32,
}

/// How a trial ends.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The blob in charge stays.
    Confirm,
    /// The other one goes back in charge.
    RollBack,
}

/// Does it to every robot. If one fails the others are still asked, and the first failure is that of the command.
pub fn run(arguments: &Arguments, end: End) -> Result<Answer, Failure> {
    let mut failure = None;
    for port in &arguments.ports {
        match end_trial(port, arguments.baud, end) {
            Ok(told) => output::report(format!("{port}: {told}")),
            Err(error) => {
                let failed = failed(port, error);
                match failure {
                    Some(_) => drop(told(&failed)),
                    None => failure = Some(failed),
                }
            }
        }
    }
    failure.map_or(Ok(Answer::Yes), Err)
}

/// What was done, and what the robot's slots hold then.
fn end_trial(port: &Port, baud: u32, end: End) -> Result<String, ConnectionError> {
    let (mut client, about) = connect(port, baud, CONNECT_LIMIT, Patience::default())?;
    let status = client.ask(&Status)?;
    let slot = in_charge(&status).ok_or(LinkError::Refused(Refusal::NoController))?;
    let identity = slot.identity;
    let done = match (end, slot.stage) {
        (End::Confirm, Stage::Trial) => "is confirmed",
        (End::Confirm, _) => "was confirmed already",
        (End::RollBack, _) => "is rolled back",
    };
    // The robot does nothing twice, and nothing if another blob has come into charge meanwhile.
    match end {
        End::Confirm => client.ask(&Confirm { identity })?,
        End::RollBack => client.ask(&RollBack { identity })?,
    }
    let status = client.ask(&Status)?;
    Ok(format!("{} {done}\n{}", hexadecimal(&identity), described(&about, &status)))
}
