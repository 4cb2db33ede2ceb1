//! `grn robots`.

use super::connection::{ConnectionError, DEFAULT_BAUD, connect, described, failed};
use super::{Answer, Failure, options, output};
use grn_core::robot::link::message::{About, RobotStatus, Status};
use grn_link::{Patience, Port};
use std::collections::BTreeMap;
use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

#[derive(clap::Args)]
pub struct Arguments {
    /// Where to ask: serial ports, tcp:HOST:PORT, unix:PATH [default: all serial ports].
    ports: Vec<Port>,
    /// Baud rate of serial ports.
    #[arg(long, default_value_t = DEFAULT_BAUD, value_parser = options::baud, allow_hyphen_values = true)]
    baud: u32,
}

/// A port without a robot must not hold the list up.
const PATIENCE: Patience =
    Patience { response: Duration::from_millis(200), erasure: Duration::from_millis(200), tries: 3 };
/// How long connecting to one of many may take.
const CONNECT_LIMIT: Duration = Duration::from_secs(3);
/// How many ports are asked at the same time.
const THREADS: usize = 32;

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut ports = Vec::new();
    for port in
        if arguments.ports.is_empty() { Port::serial_ports().map_err(no_ports)? } else { arguments.ports.clone() }
    {
        // Asked twice at the same time a port would answer only once.
        if !ports.contains(&port) {
            ports.push(port);
        }
    }
    if ports.is_empty() {
        output::product("no serial ports here; name others as tcp:HOST:PORT or unix:PATH")?;
        return Ok(Answer::No);
    }
    let mut found = false;
    let mut printed = Ok(());
    ask_all(&ports, arguments.baud, |port, answer| {
        found |= answer.is_ok();
        let told = match answer {
            Ok((about, status)) => format!("{port}: {}", described(&about, &status)),
            Err(error) => failed(port, error).message().unwrap_or_default().to_owned(),
        };
        if printed.is_ok() {
            printed = output::product(told).map(|_| ());
        }
    });
    printed?;
    Ok(if found { Answer::Yes } else { Answer::No })
}

/// A system that does not tell its ports is no fault of who asks for them.
fn no_ports(error: io::Error) -> Failure {
    Failure::System(format!("the serial ports cannot be listed: {error}; name one"))
}

type Asked = Result<(About, RobotStatus), ConnectionError>;

/// Asks all ports at the same time and tells of them in their order, each as soon as those before it are told.
fn ask_all(ports: &[Port], baud: u32, mut tell: impl FnMut(&Port, Asked)) {
    let next = AtomicUsize::new(0);
    let claim = || {
        let place = next.fetch_add(1, Ordering::Relaxed);
        Some((place, ports.get(place)?))
    };
    thread::scope(|scope| {
        let (sender, answers) = mpsc::channel();
        for _ in 0..ports.len().min(THREADS) {
            let sender = sender.clone();
            scope.spawn(move || {
                while let Some((place, port)) = claim() {
                    // The receiver stays until all senders have gone.
                    let _ = sender.send((place, ask(port, baud)));
                }
            });
        }
        drop(sender);
        let (mut early, mut told) = (BTreeMap::new(), 0);
        for (place, answer) in answers {
            early.insert(place, answer);
            while let (Some(answer), Some(port)) = (early.remove(&told), ports.get(told)) {
                tell(port, answer);
                told += 1;
            }
        }
    });
}

fn ask(port: &Port, baud: u32) -> Asked {
    let (mut client, about) = connect(port, baud, CONNECT_LIMIT, PATIENCE)?;
    let status = client.ask(&Status)?;
    Ok((about, status))
}
