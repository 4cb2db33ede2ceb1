//! Conversations with robots: how they begin, what is told of a robot, and what to do when one fails.

use super::Failure;
use super::failure::{Blame, Fault};
use grn_core::robot::link::Refusal;
use grn_core::robot::link::message::{About, RobotStatus};
use grn_core::robot::slots::{SlotStatus, Stage};
use grn_link::open::Kind;
use grn_link::{Client, LinkError, OpenError, Patience, Port, Wire};
use std::error::Error;
use std::fmt;
use std::io::ErrorKind;
use std::time::Duration;

/// Baud rate of serial ports when nothing else is said.
pub const DEFAULT_BAUD: u32 = 115_200;
/// How long connecting may take when one robot is meant.
pub const CONNECT_LIMIT: Duration = Duration::from_secs(5);

/// Why there is no conversation with a robot, or why it broke off.
#[derive(Debug)]
pub enum ConnectionError {
    Open(OpenError),
    Link(LinkError),
}

impl From<OpenError> for ConnectionError {
    fn from(error: OpenError) -> Self {
        ConnectionError::Open(error)
    }
}

impl From<LinkError> for ConnectionError {
    fn from(error: LinkError) -> Self {
        ConnectionError::Link(error)
    }
}

impl fmt::Display for ConnectionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ConnectionError::Open(error) => error.fmt(f),
            ConnectionError::Link(error) => error.fmt(f),
        }
    }
}

impl Error for ConnectionError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            ConnectionError::Open(error) => error.source(),
            ConnectionError::Link(error) => error.source(),
        }
    }
}

impl Blame for ConnectionError {
    fn fault(&self) -> Fault {
        match self {
            ConnectionError::Open(error) => match error {
                OpenError::Refused(error) => error.fault(),
                // Another port, name or baud rate is needed, or the robot switched on.
                OpenError::Resolve(_)
                | OpenError::OtherKind(_)
                | OpenError::Busy
                | OpenError::BaudRate(_)
                | OpenError::TimedOut { .. } => Fault::Input,
            },
            ConnectionError::Link(error) => match error {
                LinkError::Wire(_) | LinkError::Refused(Refusal::Flash) => Fault::System,
                LinkError::TooLong => Fault::Program,
                // Nobody answers at this port as a robot of ours does, or the robot cannot do what it is asked for.
                LinkError::Silent { .. } | LinkError::Refused(_) | LinkError::Unreadable => Fault::Input,
            },
        }
    }
}

/// Opens a port and asks who is there.
pub fn connect(
    port: &Port,
    baud: u32,
    limit: Duration,
    patience: Patience,
) -> Result<(Client<Box<dyn Wire>>, About), ConnectionError> {
    Ok(Client::connect(port.open(baud, limit)?, patience)?)
}

/// The failure of a command that needed this robot, with what to do about it.
pub fn failed(port: &Port, error: ConnectionError) -> Failure {
    let way_out = way_out(port, &error);
    let failure = Failure::from(error).about(port);
    match way_out {
        Some(way_out) => failure.with_way_out(&way_out),
        None => failure,
    }
}

/// What to do; `None` where the error says so itself.
fn way_out(port: &Port, error: &ConnectionError) -> Option<String> {
    Some(match error {
        ConnectionError::Open(error) => unopened(port, error).into(),
        ConnectionError::Link(LinkError::Silent { .. }) => {
            "is the robot on, does it run grn's firmware, are port and baud rate right?".into()
        }
        ConnectionError::Link(LinkError::Unreadable) => "update the robot's firmware or this program".into(),
        ConnectionError::Link(LinkError::Wire(_)) => "is the robot still on and connected?".into(),
        ConnectionError::Link(LinkError::Refused(Refusal::OnTrial)) => {
            format!("`grn confirm {port}` or `grn rollback {port}`")
        }
        ConnectionError::Link(LinkError::Refused(Refusal::NoFallback | Refusal::NoController)) => {
            format!("`grn flash BLOB --to {port}`")
        }
        ConnectionError::Link(_) => return None,
    })
}

fn unopened(port: &Port, error: &OpenError) -> &'static str {
    let serial = matches!(port, Port::Serial(_));
    match error {
        OpenError::Resolve(_) => "check its name, or give its address, as in tcp:192.168.1.7:PORT",
        OpenError::Busy => "end the program that uses it: a terminal, a debugger, another grn",
        OpenError::BaudRate(_) => "leave out --baud, or give a usual one: 9600, 115200, 230400",
        OpenError::TimedOut { .. } => "is the robot on and in reach, are address and port number right?",
        OpenError::OtherKind(Kind::Socket) => "write unix:PATH for a socket",
        OpenError::OtherKind(_) if serial => "give a serial port; `grn robots` without a port lists them",
        OpenError::OtherKind(_) => "give the path of a socket",
        OpenError::Refused(error) => match (error.kind(), port) {
            (ErrorKind::NotFound, Port::Serial(name)) if name.contains(':') => {
                "for a socket write tcp:HOST:PORT or unix:PATH"
            }
            (ErrorKind::NotFound, Port::Serial(_)) => {
                "is it plugged in? `grn robots` without a port lists the serial ports"
            }
            (ErrorKind::NotFound, _) => "start what listens there, or check the path",
            (ErrorKind::PermissionDenied, Port::Serial(_)) => {
                "ask for permission: on Linux `sudo usermod -aG dialout $USER`, then log in again"
            }
            (ErrorKind::PermissionDenied, _) => "the socket belongs to another user",
            (ErrorKind::ConnectionRefused, _) => "nothing listens there: start the robot, or check the port",
            _ => "check the port",
        },
    }
}

/// Bytes as they are written everywhere, as those of a blob's identity.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The slot in charge, if one is.
pub fn in_charge(status: &RobotStatus) -> Option<&SlotStatus> {
    status.slots.get(usize::from(status.active?))
}

/// What a robot is, and what is in its slots.
pub fn described(about: &About, status: &RobotStatus) -> String {
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
        let charge = if status.active == Some(place as u8) {
            format!(", in charge for {} ticks", status.ticks)
        } else {
            String::new()
        };
        let content =
            if slot.stage == Stage::Empty { String::new() } else { format!(" {}", hexadecimal(&slot.identity)) };
        text += &format!("\n  slot {place}:{content} {stage}{charge}");
    }
    text
}
