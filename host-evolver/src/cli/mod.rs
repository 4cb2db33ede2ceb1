//! The command line: one file a subcommand.

mod campaign;
mod draw;
mod eval;
mod evolve;
mod flash;
mod interrupt;
mod robots;
mod scatter;
mod show;
mod simulate;

use clap::{Parser, Subcommand};
use std::fmt;
use std::process::ExitCode;

/// Evolve gene-regulatory-network controllers for robot swarms, prove them in simulation, look at them.
#[derive(Parser)]
#[command(name = "grn", version, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 done; 1 done, but the answer is no (not encircled, infeasible); 2 bad input; \
                          130 interrupted.";

#[derive(Subcommand)]
enum Command {
    /// Evolve controllers for a scenario, then simulate the knee of the front.
    Evolve(evolve::Arguments),
    /// Compare methods over scenarios and seeds, and try their models in other worlds.
    Campaign(campaign::Arguments),
    /// Run a blob on every robot of a simulated swarm.
    Simulate(simulate::Arguments),
    /// Throw round obstacles at random around the targets' paths of a scenario.
    Scatter(scatter::Arguments),
    /// Print what a blob holds: equations, tree, ring radius, sizes.
    Show(show::Arguments),
    /// Bring a blob onto a robot, or write it for a programmer.
    Flash(flash::Arguments),
    /// List the robots that answer on the given ports.
    Robots(robots::Arguments),
    /// Read `x1,x2` lines from standard input and print the steady state M of each.
    Eval(eval::Arguments),
    /// Draw a blob's pattern at each snapshot of a scenario.
    Draw(draw::Arguments),
}

/// What a command that came to its end has to say.
enum Answer {
    Yes,
    No,
}

/// Why a command did not come to its end.
enum Failure {
    /// Bad input, in words that name the file, the place, the value and the way out.
    Input(String),
    Interrupted(String),
}

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Failure::Input(error.to_string())
    }
}

/// Prefixes an error that does not know which file it is about.
fn about<E: fmt::Display>(place: impl fmt::Display) -> impl FnOnce(E) -> Failure {
    move |error| Failure::Input(format!("{place}: {error}"))
}

/// Runs the command line of this process.
pub fn run() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Evolve(arguments) => evolve::run(&arguments),
        Command::Campaign(arguments) => campaign::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Scatter(arguments) => scatter::run(&arguments),
        Command::Flash(arguments) => flash::run(&arguments),
        Command::Robots(arguments) => robots::run(&arguments),
        Command::Show(arguments) => show::run(&arguments),
        Command::Eval(arguments) => eval::run(&arguments),
        Command::Draw(arguments) => draw::run(&arguments),
    };
    match result {
        Ok(Answer::Yes) => ExitCode::SUCCESS,
        Ok(Answer::No) => ExitCode::from(1),
        Err(Failure::Input(message)) => {
            eprintln!("grn: {message}");
            ExitCode::from(2)
        }
        Err(Failure::Interrupted(message)) => {
            eprintln!("grn: interrupted. {message}");
            ExitCode::from(130)
        }
    }
}

/// Prints to standard output; a reader that has gone away ends the command quietly.
fn print(text: impl fmt::Display) -> Result<(), Failure> {
    use std::io::Write;
    let written = writeln!(std::io::stdout(), "{text}");
    match written {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => std::process::exit(0),
        other => other.map_err(about("standard output")),
    }
}

/// Prints a value as JSON.
fn print_json(value: &serde_json::Value) -> Result<(), Failure> {
    print(serde_json::to_string_pretty(value)?)
}
