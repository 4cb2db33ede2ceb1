//! Why a command does not come to its end, and whose fault that is.

use super::exit::Exit;
use super::snippet;
use crate::cluster::ClusterError;
#[cfg(unix)]
use crate::emulation::{EmulationError, StartError};
use crate::evolve::SettingsError;
use crate::files::{FileError, is_fault_of_system};
use crate::simulation::SimulationError;
#[cfg(unix)]
use firmware_sim::link::qemu::EmulatorError;
use grn_core::blob::BlobError;
use grn_core::robot::slots::SlotError;
use grn_figures::{FigureError, PngError};
use grn_input::InputError;
use grn_link::LinkError;
use std::error::Error;
use std::fmt;
use std::io;

/// Why a command did not come to its end.
#[derive(Debug)]
pub enum Failure {
    /// Bad input, in words that name the file, the place, the value and the way out.
    Input(String),
    /// The system failed: a full disk, a device that breaks. The same command may work another time.
    System(String),
    /// This program failed: nothing that anybody gave it explains it.
    Program(String),
    /// Somebody asked to stop.
    Interrupted(String),
    /// A command line that clap has refused in its own words.
    Told,
}

/// Whose fault an error is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Of who gave a file, an option, a port.
    Input,
    /// Of the machine, or of a robot at a wire.
    System,
    /// Of this program.
    Program,
}

/// An error that says whose fault it is. One that does not cannot become a [`Failure`], so nothing is called bad input
/// because nobody thought of it.
pub trait Blame: Error + 'static {
    /// Whose fault it is.
    fn fault(&self) -> Fault;
}

impl Failure {
    fn of(fault: Fault, message: String) -> Failure {
        match fault {
            Fault::Input => Failure::Input(message),
            Fault::System => Failure::System(message),
            Fault::Program => Failure::Program(message),
        }
    }

    /// Changes its words.
    fn reworded(self, reword: impl FnOnce(String) -> String) -> Failure {
        match self {
            Failure::Input(message) => Failure::Input(reword(message)),
            Failure::System(message) => Failure::System(reword(message)),
            Failure::Program(message) => Failure::Program(reword(message)),
            Failure::Interrupted(_) | Failure::Told => self,
        }
    }

    /// Puts in front what it is about.
    pub fn about(self, place: impl fmt::Display) -> Failure {
        self.reworded(|message| format!("{place}: {message}"))
    }

    /// Adds what to do.
    pub fn with_way_out(self, way_out: &str) -> Failure {
        self.reworded(|message| format!("{message}; {way_out}"))
    }

    /// The same, where what was given has been checked and cannot be the reason.
    pub fn of_program(self) -> Failure {
        match self {
            Failure::Input(message) => Failure::Program(message),
            other => other,
        }
    }

    /// Its words; none if they are said already.
    pub fn message(&self) -> Option<&str> {
        match self {
            Failure::Input(message) | Failure::System(message) | Failure::Program(message) => Some(message),
            Failure::Interrupted(message) => Some(message),
            Failure::Told => None,
        }
    }

    /// How the process ends.
    pub fn exit(&self) -> Exit {
        match self {
            Failure::Input(_) | Failure::Told => Exit::BadInput,
            Failure::System(_) | Failure::Program(_) => Exit::Fault,
            Failure::Interrupted(_) => Exit::Interrupted,
        }
    }
}

impl<E: Blame> From<E> for Failure {
    fn from(error: E) -> Self {
        Failure::of(error.fault(), words(&error))
    }
}

/// Prefixes an error that does not know what it is about.
pub fn about<E: Blame>(place: impl fmt::Display) -> impl FnOnce(E) -> Failure {
    move |error| Failure::from(error).about(place)
}

/// An error with those that it comes from, and the line of the file that it is about.
fn words(error: &(dyn Error + 'static)) -> String {
    let mut message = error.to_string();
    let mut link = error.source();
    while let Some(error) = link {
        let text = error.to_string();
        if !message.contains(&text) {
            message = format!("{message}: {text}");
        }
        link = error.source();
    }
    match snippet::of(error) {
        Some(snippet) => format!("{message}\n{snippet}"),
        None => message,
    }
}

/// Whose fault an operating system's refusal is, where something was asked of it for somebody.
fn of_system_below(error: &(dyn Error + 'static), otherwise: Fault) -> Fault {
    let mut link = Some(error);
    while let Some(error) = link {
        if error.downcast_ref().is_some_and(is_fault_of_system) {
            return Fault::System;
        }
        link = error.source();
    }
    otherwise
}

/// Errors that are always the fault of one and the same.
macro_rules! always {
    ($($error:ty => $fault:ident),+ $(,)?) => {
        $(impl Blame for $error {
            fn fault(&self) -> Fault {
                Fault::$fault
            }
        })+
    };
}

always! {
    BlobError => Input,
    SettingsError => Input,
    SlotError => Input,
    // What is drawn comes from models and worlds that were checked.
    FigureError => Program,
    PngError => Program,
}

impl Blame for io::Error {
    fn fault(&self) -> Fault {
        of_system_below(self, Fault::Input)
    }
}

impl Blame for InputError {
    fn fault(&self) -> Fault {
        of_system_below(self, Fault::Input)
    }
}

impl Blame for FileError {
    fn fault(&self) -> Fault {
        if self.is_internal() { Fault::Program } else { of_system_below(self, Fault::Input) }
    }
}

impl Blame for ClusterError {
    fn fault(&self) -> Fault {
        match self {
            ClusterError::NotBuilt { .. } | ClusterError::Unfit { .. } => Fault::Input,
            ClusterError::NoStart => Fault::System,
            ClusterError::Garbled { .. } => Fault::Program,
        }
    }
}

impl Blame for SimulationError {
    fn fault(&self) -> Fault {
        match self {
            SimulationError::Load(_) | SimulationError::NoPattern(_) | SimulationError::Config(_) => Fault::Input,
            // A brain at a wire has lost it; one in this process was given what no robot can perceive.
            SimulationError::Brain(error) if error.source.reason().is::<LinkError>() => Fault::System,
            SimulationError::Brain(_) => Fault::Program,
        }
    }
}

#[cfg(unix)]
impl Blame for EmulationError {
    fn fault(&self) -> Fault {
        match self {
            EmulationError::Simulation(error) => error.fault(),
            EmulationError::Sockets(_) => Fault::System,
            EmulationError::Robot(_, StartError::OtherNumber { .. }) => Fault::Input,
            EmulationError::Robot(_, StartError::Emulator(error)) => match error {
                EmulatorError::Image(..) | EmulatorError::NotAnImage(_) => of_system_below(error, Fault::Input),
                EmulatorError::Run(_) | EmulatorError::Ended(_) | EmulatorError::Silent => Fault::System,
            },
            EmulationError::Robot(_, StartError::Link(_)) => Fault::System,
            EmulationError::Robot(_, StartError::Blob(_)) => Fault::Program,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::connection::ConnectionError;
    use super::*;
    use firmware_sim::brain::BrainError;
    use firmware_sim::swarm::StepError;
    use grn_core::robot::link::Refusal;
    use grn_link::OpenError;
    use std::path::Path;

    fn broken() -> io::Error {
        io::ErrorKind::BrokenPipe.into()
    }

    fn missing() -> io::Error {
        io::ErrorKind::NotFound.into()
    }

    fn brain(reason: impl Into<Box<dyn Error + Send + Sync>>) -> SimulationError {
        SimulationError::Brain(StepError { robot: 3, tick: 50, source: BrainError::new(reason) })
    }

    #[test]
    fn what_nobody_gave_is_not_called_bad_input() {
        let input = |error: io::Error| InputError::new("", "", "cannot be read").from_source(error);
        let config = || InputError::new("radio.loss", 2, "0 to 1");
        let failures: Vec<(Failure, Exit)> = vec![
            (missing().into(), Exit::BadInput),
            (broken().into(), Exit::Fault),
            (input(missing()).into(), Exit::BadInput),
            (input(io::Error::from_raw_os_error(5)).into(), Exit::Fault),
            (FileError::new("x", "holds other things").into(), Exit::BadInput),
            (FileError::damaged("x", "cut").into(), Exit::BadInput),
            (FileError::from_system("x", "written", io::ErrorKind::StorageFull.into()).into(), Exit::Fault),
            (FileError::internal("x", "has no bytes").into(), Exit::Fault),
            (FigureError::Chart("no".into()).into(), Exit::Fault),
            (PngError::Size(0, 0).into(), Exit::Fault),
            (Failure::from(config()), Exit::BadInput),
            (Failure::from(config()).of_program(), Exit::Fault),
            (brain("no robot perceives this").into(), Exit::Fault),
            (brain(LinkError::Silent { tries: 8 }).into(), Exit::Fault),
            (ConnectionError::Open(OpenError::Refused(missing())).into(), Exit::BadInput),
            (ConnectionError::Open(OpenError::Refused(io::Error::from_raw_os_error(24))).into(), Exit::Fault),
            (ConnectionError::Link(LinkError::Silent { tries: 8 }).into(), Exit::BadInput),
            (ConnectionError::Link(LinkError::Refused(Refusal::OnTrial)).into(), Exit::BadInput),
            (ConnectionError::Link(LinkError::Refused(Refusal::Flash)).into(), Exit::Fault),
            (ConnectionError::Link(LinkError::Wire(broken())).into(), Exit::Fault),
            (ConnectionError::Link(LinkError::TooLong).into(), Exit::Fault),
        ];
        for (failure, exit) in failures {
            assert_eq!(failure.exit(), exit, "{failure:?}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn an_emulator_that_fails_is_not_bad_input_and_a_wrong_image_is() {
        let robot = |error| EmulationError::Robot(0, error);
        let emulator = |error| robot(StartError::Emulator(error));
        let image = || Path::new("image").to_owned();
        let cases = [
            (emulator(EmulatorError::Image(image(), missing())), Fault::Input),
            (emulator(EmulatorError::NotAnImage(image())), Fault::Input),
            (emulator(EmulatorError::Run(missing())), Fault::System),
            (emulator(EmulatorError::Silent), Fault::System),
            (robot(StartError::Link(LinkError::Unreadable)), Fault::System),
            (EmulationError::Sockets(missing()), Fault::System),
        ];
        for (error, fault) in cases {
            assert_eq!(error.fault(), fault, "{error}");
        }
    }

    #[test]
    fn the_chain_of_an_error_is_told_once_and_whole() {
        let error = brain(LinkError::Wire(broken()));
        assert!(error.source().is_some());
        let Failure::System(told) = about::<SimulationError>("blob.grn")(error) else { panic!("not the system's") };
        let expected = "blob.grn: robot 3 gave no command in tick 50: the connection failed: ";
        assert_eq!(told, format!("{expected}{}", broken()));
    }
}
