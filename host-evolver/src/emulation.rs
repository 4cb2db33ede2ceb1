//! Processor in the loop: the controllers of a swarm's first robots run in QEMU, from the image that is flashed.

use crate::files::blob_bytes;
use crate::simulation::{Setting, Simulation, SimulationError, native, run};
use firmware_sim::brain::Brain;
use firmware_sim::config::SwarmConfig;
use firmware_sim::link::RemoteBrain;
use firmware_sim::link::qemu::{Emulator, EmulatorError};
use firmware_sim::scenario::Scenario;
use firmware_sim::trace::Observer;
use grn_core::blob::{Blob, BlobError};
use grn_core::scalar::{NumberType, Q8_24};
use grn_link::{Client, LinkError, Patience};
use std::error::Error;
use std::fmt;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Robots whose controllers run in emulators.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Emulation {
    /// The image they run.
    pub image: PathBuf,
    /// How many; the first of the swarm.
    pub robots: usize,
}

/// Why there was no simulation with emulated robots.
#[derive(Debug)]
pub enum EmulationError {
    /// As without emulated robots.
    Simulation(SimulationError),
    /// There is no folder for the sockets of the emulators.
    Sockets(io::Error),
    /// An emulated robot could not be started.
    Robot(usize, StartError),
}

/// Why an emulated robot could not be started.
#[derive(Debug)]
pub enum StartError {
    /// The image does not run.
    Emulator(EmulatorError),
    /// The robot does not do as it is asked.
    Link(LinkError),
    /// The image computes in another number type.
    OtherNumber {
        /// The image.
        image: PathBuf,
        /// What it computes in.
        found: NumberType,
        /// What was asked for.
        wanted: NumberType,
    },
    /// The blob has no bytes.
    Blob(BlobError),
}

impl fmt::Display for EmulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EmulationError::Simulation(error) => error.fmt(f),
            EmulationError::Sockets(_) => f.write_str("no folder for the emulators' sockets can be made"),
            EmulationError::Robot(robot, error) => write!(f, "emulated robot {robot}: {error}"),
        }
    }
}

impl Error for EmulationError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            EmulationError::Simulation(error) => error.source(),
            EmulationError::Sockets(error) => Some(error),
            EmulationError::Robot(_, error) => error.source(),
        }
    }
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StartError::Emulator(error) => error.fmt(f),
            StartError::Link(error) => error.fmt(f),
            StartError::OtherNumber { image, found, wanted } => {
                write!(f, "{} computes in {found}, not {wanted}; choose another with --image", image.display())
            }
            StartError::Blob(error) => error.fmt(f),
        }
    }
}

impl Error for StartError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            StartError::Emulator(error) => error.source(),
            StartError::Link(error) => error.source(),
            StartError::Blob(error) => error.source(),
            StartError::OtherNumber { .. } => None,
        }
    }
}

impl From<SimulationError> for EmulationError {
    fn from(error: SimulationError) -> Self {
        EmulationError::Simulation(error)
    }
}

/// [`simulate`](crate::simulation::simulate) with some of the robots emulated; the trace is the same, bit for bit.
///
/// # Errors
/// [`EmulationError`]; `Ok(None)` if `watch` stopped it.
pub fn simulate(
    blob: &Blob,
    scenario: &Scenario,
    config: SwarmConfig,
    number: NumberType,
    emulation: &Emulation,
    observer: &mut dyn Observer,
    watch: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Simulation>, EmulationError> {
    // Sockets are removed when the emulators have ended.
    let sockets = tempfile::tempdir().map_err(EmulationError::Sockets)?;
    let start = |robot| {
        let started = emulation.start(robot, sockets.path(), blob, number);
        started.map_err(|error| EmulationError::Robot(robot, error))
    };
    let emulated = (0..emulation.robots).map(start).collect::<Result<Vec<_>, _>>()?;
    let setting = Setting::new(blob, scenario, &config)?;
    let simulation = match number {
        NumberType::F32 => run(&setting, config, number, mixed(emulated, native::<f32>(blob)?), observer, watch),
        NumberType::Q8_24 => run(&setting, config, number, mixed(emulated, native::<Q8_24>(blob)?), observer, watch),
    };
    Ok(simulation?)
}

/// The brains of a swarm: emulated ones for the first robots, native ones for the rest.
fn mixed<B: Brain + 'static>(
    emulated: Vec<Box<dyn Brain>>,
    native: impl Fn(usize) -> B,
) -> impl FnMut(usize) -> Box<dyn Brain> {
    let mut emulated = emulated.into_iter();
    move |robot| emulated.next().unwrap_or_else(|| Box::new(native(robot)))
}

impl Emulation {
    fn start(
        &self,
        robot: usize,
        sockets: &Path,
        blob: &Blob,
        number: NumberType,
    ) -> Result<Box<dyn Brain>, StartError> {
        let emulator = Emulator::start(&self.image, sockets.join(robot.to_string())).map_err(StartError::Emulator)?;
        let (client, about) = Client::connect(emulator, Patience::default()).map_err(StartError::Link)?;
        if about.number_type != number {
            let (image, found) = (self.image.clone(), about.number_type);
            return Err(StartError::OtherNumber { image, found, wanted: number });
        }
        let bytes = blob_bytes(blob).map_err(StartError::Blob)?;
        let brain = RemoteBrain::start(client, &bytes, blob.identity(), robot as u16).map_err(StartError::Link)?;
        Ok(Box::new(brain))
    }
}
