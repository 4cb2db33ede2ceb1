//! Processor in the loop: the controllers of a swarm's first robots run in QEMU, from the image that is flashed.

use crate::files::blob_bytes;
use crate::simulation::{Simulation, SimulationError, native, run};
use firmware_sim::brain::Brain;
use firmware_sim::config::SwarmConfig;
use firmware_sim::link::RemoteBrain;
use firmware_sim::link::qemu::Emulator;
use firmware_sim::scenario::Scenario;
use firmware_sim::trace::Observer;
use grn_core::blob::Blob;
use grn_core::scalar::{NumberType, Q8_24};
use grn_link::{Client, Patience};
use std::fmt;
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

/// [`simulate`](crate::simulation::simulate) with some of the robots emulated; the trace is the same, bit for bit.
///
/// # Errors
/// [`SimulationError`]; `Ok(None)` if `watch` stopped it.
pub fn simulate(
    blob: &Blob,
    scenario: &Scenario,
    config: SwarmConfig,
    number: NumberType,
    emulation: &Emulation,
    observer: &mut dyn Observer,
    watch: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Simulation>, SimulationError> {
    // Sockets are removed when the emulators have ended.
    let sockets = tempfile::tempdir().map_err(|error| SimulationError::Emulator(error.to_string()))?;
    let emulated = (0..emulation.robots).map(|robot| emulation.start(robot, sockets.path(), blob, number));
    let emulated = emulated.collect::<Result<Vec<_>, _>>()?;
    match number {
        NumberType::F32 => run(blob, scenario, config, number, mixed(emulated, native::<f32>(blob)?), observer, watch),
        NumberType::Q8_24 => {
            run(blob, scenario, config, number, mixed(emulated, native::<Q8_24>(blob)?), observer, watch)
        }
    }
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
    ) -> Result<Box<dyn Brain>, SimulationError> {
        let fault = |error: &dyn fmt::Display| SimulationError::Emulator(format!("emulated robot {robot}: {error}"));
        let emulator = Emulator::start(&self.image, sockets.join(robot.to_string())).map_err(|error| fault(&error))?;
        let (client, about) = Client::connect(emulator, Patience::default()).map_err(|error| fault(&error))?;
        if about.number_type != number {
            let (image, found) = (self.image.display(), about.number_type);
            return Err(fault(&format!("{image} computes in {found}, not {number}; choose another with --image")));
        }
        let bytes = blob_bytes(blob).map_err(|error| fault(&error))?;
        let brain = RemoteBrain::start(client, &bytes, blob.identity(), robot as u16).map_err(|error| fault(&error))?;
        Ok(Box::new(brain))
    }
}
