//! Processor in the loop: a robot's controller on another machine, asked through the link.

use crate::brain::{Brain, BrainError};
use grn_core::blob::Identity;
use grn_core::robot::link::message::{Homeward, Reset};
use grn_core::robot::{Command, Millimetres, Percept};
use grn_link::{Client, LinkError, Wire, flashing};

/// A controller behind a link.
pub struct RemoteBrain<W> {
    client: Client<W>,
    number: u16,
}

impl<W: Wire> RemoteBrain<W> {
    /// Puts a blob in charge of the robot and begins anew as robot `number` of its swarm.
    ///
    /// # Errors
    /// [`LinkError`].
    pub fn start(mut client: Client<W>, blob: &[u8], identity: Identity, number: u16) -> Result<Self, LinkError> {
        flashing::flash(&mut client, blob, identity, false, |_| {})?;
        client.ask(&Reset { robot: number })?;
        Ok(RemoteBrain { client, number })
    }
}

impl<W: Wire> Brain for RemoteBrain<W> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        self.client.ask(percept).map_err(BrainError::new)
    }

    fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, BrainError> {
        self.client.ask(&Homeward { home, percept: percept.clone() }).map_err(BrainError::new)
    }

    fn reboot(&mut self) -> Result<(), BrainError> {
        self.client.ask(&Reset { robot: self.number }).map_err(BrainError::new)
    }
}
