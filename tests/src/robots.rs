//! Simulated robots with blobs on them and conversations with them, for the tests of slots and link.

use firmware_sim::flash::{SECTOR, SimulatedFlash};
use grn_core::blob::{Blob, Identity, max_encoded_size};
use grn_core::network::{DEFAULT_GENES, Network};
use grn_core::robot::link::Server;
use grn_core::robot::link::frame::{Frame, Receiver};
use grn_core::robot::slots::Layout;
use grn_core::scalar::NumberType;
use grn_link::wire::LocalRobot;
use grn_link::{Client, Patience};
use std::time::Duration;

/// Both slots in two sectors each.
pub const LAYOUT: Layout = Layout::adjacent(2 * SECTOR as u32);

/// An empty flash that [`LAYOUT`] fits.
pub fn empty_flash(seed: u64) -> SimulatedFlash {
    SimulatedFlash::erased(4, seed)
}

/// A blob that ships with the software.
#[derive(Clone, Debug)]
pub struct Shipped {
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// Its identity.
    pub identity: Identity,
}

impl Shipped {
    /// `models/NAME.grn`.
    ///
    /// # Panics
    /// If there is no such blob.
    pub fn named(name: &str) -> Self {
        let path = format!("{}/../models/{name}.grn", env!("CARGO_MANIFEST_DIR"));
        let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        Shipped::of(&bytes)
    }

    /// A blob's bytes.
    ///
    /// # Panics
    /// If they are none.
    pub fn of(bytes: &[u8]) -> Self {
        let blob = Blob::<DEFAULT_GENES>::decode(bytes).unwrap_or_else(|error| panic!("{error}"));
        Shipped { bytes: bytes.to_vec(), identity: blob.identity() }
    }

    /// The same blob with another cruising speed: another identity, the same length.
    ///
    /// # Panics
    /// If the speed is out of range.
    #[must_use]
    pub fn cruising_at(&self, speed: f32) -> Self {
        let decoded = Blob::<DEFAULT_GENES>::decode(&self.bytes);
        let mut blob = decoded.unwrap_or_else(|error| panic!("{error}"));
        blob.gains.cruise = speed;
        let mut buffer = [0; max_encoded_size(DEFAULT_GENES)];
        let bytes = blob.encode(&mut buffer).unwrap_or_else(|error| panic!("{error}"));
        Shipped::of(bytes)
    }
}

/// A sound blob of the printed two-gene model with so many genes, all but two idle: more than a robot may hold.
///
/// # Panics
/// If there are more than 64.
pub fn blob_of_genes(genes: usize) -> Vec<u8> {
    let blob = Blob::<64>::decode(&Shipped::named("nand-xnor").bytes).unwrap_or_else(|error| panic!("{error}"));
    let model = blob.network.genes();
    let idle = model.iter().take(1).cycle().take(genes - model.len());
    let network = Network::new(blob.network.steepness(), model.iter().take(1).chain(idle).chain(&model[1..]).cloned());
    let network = network.unwrap_or_else(|error| panic!("{error}"));
    let mut buffer = [0; max_encoded_size(64)];
    let bytes = Blob { network, ..blob }.encode(&mut buffer).map(<[u8]>::to_vec);
    bytes.unwrap_or_else(|error| panic!("{error}"))
}

/// A robot that computes in f32.
pub type TestServer = Server<SimulatedFlash, f32>;

/// Patience with a robot in the same process.
pub const PATIENCE: Patience =
    Patience { response: Duration::from_millis(100), erasure: Duration::from_millis(100), tries: 500 };

/// A robot with this flash.
///
/// # Panics
/// If its slots cannot be used.
pub fn server(flash: SimulatedFlash) -> TestServer {
    Server::start(flash, LAYOUT, "test robot", NumberType::F32).unwrap_or_else(|error| panic!("{error}"))
}

/// A conversation with a robot.
///
/// # Panics
/// If it does not answer.
pub fn client(server: TestServer) -> Client<LocalRobot<SimulatedFlash, f32>> {
    Client::connect(LocalRobot::new(server), PATIENCE).unwrap_or_else(|error| panic!("{error}")).0
}

/// Sends bytes as they are; the operation and payload of the answer.
pub fn say(server: &mut TestServer, bytes: &[u8]) -> Option<(u8, Vec<u8>)> {
    let mut receiver = Receiver::new();
    let mut answer = None;
    for &byte in bytes {
        for &answered in server.receive(byte).unwrap_or_default() {
            let frame = receiver.receive(answered);
            answer = frame.map(|Frame { operation, payload, .. }| (operation, payload.to_vec())).or(answer);
        }
    }
    answer
}
