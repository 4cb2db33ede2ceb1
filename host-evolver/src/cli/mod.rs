//! The command line: one file a subcommand.

mod campaign;
mod conditions;
mod connection;
mod draw;
mod eval;
mod evolve;
mod exit;
mod failure;
mod flash;
mod interrupt;
mod lab;
mod missions;
mod options;
mod output;
mod progress;
mod robots;
mod robustness;
mod scatter;
mod show;
mod simulate;
mod snippet;
mod survey;
mod trial;

use crate::files::FolderLock;
use clap::{Parser, Subcommand};
use exit::Exit;
use failure::{Failure, about};
use std::fmt;
use std::io::{ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

/// Evolve gene-regulatory-network controllers for robot swarms, prove them in simulation, look at them.
#[derive(Parser)]
#[command(name = "grn", version = crate::files::VERSION, after_help = exit::WORDS)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

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
    /// Draw worlds at random that a swarm can pass, each for a swarm of its own.
    Missions(missions::Arguments),
    /// Try controllers in many missions, and count in how many they cage the targets.
    Survey(survey::Arguments),
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

/// The command line as it was given, for whoever wants a folder that it writes.
fn this_command() -> String {
    std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

/// Takes the folder of an `--out` that is neither a run's nor a campaign's.
fn take_folder(folder: &Path) -> Result<FolderLock, Failure> {
    let manifest = folder.join("manifest.json");
    if manifest.exists() {
        let fault =
            "this is the folder of a run or campaign, which holds its own files only; choose another with --out";
        return Err(Failure::Input(format!("{}: {fault}", manifest.display())));
    }
    Ok(FolderLock::take(folder, &this_command())?)
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
    let exit = match answer {
        Ok(Answer::Yes) => Exit::Yes,
        Ok(Answer::No) => Exit::No,
        Err(failure) => told(&failure),
    };
    exit.into()
}

/// Says why a command failed, and how the process ends.
fn told(failure: &Failure) -> Exit {
    match failure {
        Failure::Input(message) | Failure::System(message) => output::notice(format_args!("grn: {message}")),
        Failure::Program(message) => {
            output::notice(format_args!("grn: {message}\nThis is a fault of grn itself: please report it."));
        }
        Failure::Interrupted(message) => output::notice(format_args!("grn: interrupted. {message}")),
        Failure::Told => {}
    }
    failure.exit()
}

/// Prints help or the version if they were asked for, else what is wrong with the command line.
fn explain(error: &clap::Error) -> Result<Answer, Failure> {
    let printed = error.print().and_then(|()| std::io::stdout().flush());
    match printed {
        _ if error.use_stderr() => Err(Failure::Told),
        Err(failure) if failure.kind() != ErrorKind::BrokenPipe => Err(output::cannot_print(&failure)),
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
        Command::Missions(arguments) => missions::run(arguments),
        Command::Survey(arguments) => survey::run(arguments),
        Command::Flash(arguments) => flash::run(arguments),
        Command::Robots(arguments) => robots::run(arguments),
        Command::Confirm(arguments) => trial::run(arguments, trial::End::Confirm),
        Command::Rollback(arguments) => trial::run(arguments, trial::End::RollBack),
        Command::Show(arguments) => show::run(arguments),
        Command::Eval(arguments) => eval::run(arguments),
        Command::Draw(arguments) => draw::run(arguments),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    /// Options whose values are words, names or paths. Every other one takes numbers, which may have a minus sign: what is
    /// wrong with them is then told with their range, and not that there is no option `-1`.
    const WORDS: [&str; 13] = [
        "class",
        "constraints",
        "image",
        "lab",
        "merge",
        "motifs",
        "number",
        "objectives",
        "out",
        "programmer",
        "set",
        "target",
        "to",
    ];

    #[test]
    fn every_option_with_a_number_takes_a_minus_sign() {
        let forgotten: Vec<String> = Cli::command()
            .get_subcommands()
            .flat_map(|command| {
                let options = command.get_opts().filter(|option| option.get_action().takes_values());
                let wrong = options.filter(|option| {
                    let name = option.get_long().unwrap_or_default();
                    option.is_allow_hyphen_values_set() == WORDS.contains(&name)
                });
                wrong.map(|option| format!("{} {}", command.get_name(), option.get_id())).collect::<Vec<_>>()
            })
            .collect();
        assert!(forgotten.is_empty(), "{forgotten:?}");
    }
}
