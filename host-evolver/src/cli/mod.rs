//! The command line: one file a subcommand.

mod campaign;
mod conditions;
mod connection;
mod draw;
mod eval;
mod evolve;
mod flash;
mod interrupt;
mod lab;
mod options;
mod output;
mod progress;
mod robots;
mod robustness;
mod scatter;
mod show;
mod simulate;
mod snippet;
mod trial;

use crate::files;
use clap::{Parser, Subcommand};
use std::error::Error;
use std::fmt;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

/// Evolve gene-regulatory-network controllers for robot swarms, prove them in simulation, look at them.
#[derive(Parser)]
#[command(name = "grn", version = crate::files::VERSION, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 done; 1 done, but the answer is no (not encircled, infeasible); 2 bad input; \
                          3 the system failed (disk full, broken device, no threads); 130 interrupted.";

#[derive(Subcommand)]
enum Command {
    /// Evolve controllers for a scenario, then simulate the knee of the front.
    Evolve(evolve::Arguments),
    /// Compare methods over scenarios and seeds, and try their models in other worlds.
    Campaign(campaign::Arguments),
    /// Run a blob on every robot of a simulated swarm.
    Simulate(simulate::Arguments),
    /// Print a laboratory, the conditions of a simulation, with comments.
    Lab(lab::Arguments),
    /// Throw round obstacles at random around the targets' paths of a scenario.
    Scatter(scatter::Arguments),
    /// Print what a blob holds: equations, tree, ring radius, sizes.
    Show(show::Arguments),
    /// Bring a blob onto a robot, or write it for a programmer.
    Flash(flash::Arguments),
    /// List the robots that answer on the given ports.
    Robots(robots::Arguments),
    /// Keep the blob that is in charge of a robot: end its trial.
    Confirm(trial::Arguments),
    /// Take the blob out of charge of a robot and put the one before it back.
    Rollback(trial::Arguments),
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
    /// The system failed: a full disk, a device that breaks. The same command may work another time.
    System(String),
    Interrupted(String),
    /// A command line that clap has refused in its own words.
    Told,
}

impl Failure {
    /// Whose fault an error is follows from what lies under it.
    fn new(error: &(dyn Error + 'static)) -> Failure {
        let mut message = error.to_string();
        let mut of_system = false;
        let mut link = Some(error);
        while let Some(error) = link {
            let text = error.to_string();
            if !message.contains(&text) {
                message = format!("{message}: {text}");
            }
            of_system |= error.downcast_ref().is_some_and(files::is_fault_of_system);
            link = error.source();
        }
        if let Some(snippet) = snippet::of(error) {
            message = format!("{message}\n{snippet}");
        }
        if of_system { Failure::System(message) } else { Failure::Input(message) }
    }

    /// Puts in front what it is about.
    fn about(self, place: impl fmt::Display) -> Failure {
        match self {
            Failure::Input(message) => Failure::Input(format!("{place}: {message}")),
            Failure::System(message) => Failure::System(format!("{place}: {message}")),
            other => other,
        }
    }
}

impl<E: Error + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Failure::new(&error)
    }
}

/// The command line as it was given, for whoever wants a folder that it writes.
fn this_command() -> String {
    std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

/// Prefixes an error that does not know which file it is about.
fn about<E: Into<Box<dyn Error>>>(place: impl fmt::Display) -> impl FnOnce(E) -> Failure {
    move |error| Failure::new(error.into().as_ref()).about(place)
}

/// That the system gives no threads is not the fault of who asks for them.
fn no_threads(error: impl fmt::Display) -> Failure {
    Failure::System(format!("threads cannot be started: {error}"))
}

/// Runs the command line of this process.
pub fn run() -> ExitCode {
    let answer = match Cli::try_parse() {
        Ok(cli) => answer(&cli.command),
        Err(error) => explain(&error),
    };
    match answer {
        Ok(Answer::Yes) => ExitCode::SUCCESS,
        Ok(Answer::No) => ExitCode::from(1),
        Err(Failure::Input(message)) => {
            output::notice(format_args!("grn: {message}"));
            ExitCode::from(2)
        }
        Err(Failure::Told) => ExitCode::from(2),
        Err(Failure::System(message)) => {
            output::notice(format_args!("grn: {message}"));
            ExitCode::from(3)
        }
        Err(Failure::Interrupted(message)) => {
            output::notice(format_args!("grn: interrupted. {message}"));
            ExitCode::from(interrupt::CODE)
        }
    }
}

/// Prints help or the version if they were asked for, else what is wrong with the command line.
fn explain(error: &clap::Error) -> Result<Answer, Failure> {
    let printed = error.print().and_then(|()| std::io::stdout().flush());
    match printed {
        _ if error.use_stderr() => Err(Failure::Told),
        Err(failure) if failure.kind() != ErrorKind::BrokenPipe => Err(Failure::new(&failure).about("standard output")),
        _ => Ok(Answer::Yes),
    }
}

fn answer(command: &Command) -> Result<Answer, Failure> {
    match command {
        Command::Evolve(arguments) => evolve::run(arguments),
        Command::Campaign(arguments) => campaign::run(arguments),
        Command::Simulate(arguments) => simulate::run(arguments),
        Command::Lab(arguments) => lab::run(arguments),
        Command::Scatter(arguments) => scatter::run(arguments),
        Command::Flash(arguments) => flash::run(arguments),
        Command::Robots(arguments) => robots::run(arguments),
        Command::Confirm(arguments) => trial::run(arguments, trial::End::Confirm),
        Command::Rollback(arguments) => trial::run(arguments, trial::End::RollBack),
        Command::Show(arguments) => show::run(arguments),
        Command::Eval(arguments) => eval::run(arguments),
        Command::Draw(arguments) => draw::run(arguments),
    }
}
