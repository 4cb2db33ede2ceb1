//! The host's end of the link to a robot, real, emulated or simulated (the robot's is [`grn_core::robot::link`]).
//!
//! | module | what it holds |
//! |---|---|
//! | [`wire`] | what carries bytes: sockets, a robot in the same process |
//! | `port` (feature `serial`) | names of the places where robots answer: serial ports and sockets |
//! | `open` (feature `serial`) | opening a port, in bounded time |
//! | [`client`] | requests with repetition, and their errors |
//! | [`flashing`] | bringing a blob onto a robot: upload, verify, activate, confirm |
//!
//! A robot in this process gets a blob, and then drives with it:
//!
//! ```
//! use grn_core::blob::Blob;
//! use grn_core::robot::link::Server;
//! use grn_core::robot::link::message::Status;
//! use grn_core::robot::slots::Layout;
//! use grn_core::scalar::NumberType;
//! use grn_link::flashing::{Flashed, flash};
//! use grn_link::wire::LocalRobot;
//! use grn_link::{Client, Patience};
//! # use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
//! # struct Memory(Vec<u8>);
//! # impl ErrorType for Memory {
//! #     type Error = NorFlashErrorKind;
//! # }
//! # impl ReadNorFlash for Memory {
//! #     const READ_SIZE: usize = 1;
//! #     fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
//! #         bytes.copy_from_slice(&self.0[offset as usize..][..bytes.len()]);
//! #         Ok(())
//! #     }
//! #     fn capacity(&self) -> usize {
//! #         self.0.len()
//! #     }
//! # }
//! # impl NorFlash for Memory {
//! #     const WRITE_SIZE: usize = 1;
//! #     const ERASE_SIZE: usize = 1024;
//! #     fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
//! #         self.0[from as usize..to as usize].fill(0xff);
//! #         Ok(())
//! #     }
//! #     fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
//! #         self.0[offset as usize..][..bytes.len()].copy_from_slice(bytes);
//! #         Ok(())
//! #     }
//! # }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let flash_memory = Memory(vec![0xff; 2048]);
//! let server = Server::<_, f32>::start(flash_memory, Layout::adjacent(1024), "robot 7", NumberType::F32)?;
//! // For a real robot `"/dev/ttyACM0".parse::<Port>()?.open(115_200, limit)?` stands here.
//! let wire = LocalRobot::new(server);
//!
//! let (mut client, about) = Client::connect(wire, Patience::default())?;
//! assert_eq!(about.name, "robot 7");
//!
//! let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/nand-xnor.grn");
//! let bytes = std::fs::read(path)?;
//! let blob: Blob = Blob::decode(&bytes)?;
//! let flashed = flash(&mut client, &bytes, blob.identity(), true, |step| println!("{step:?}"))?;
//! assert_eq!(flashed, Flashed::InCharge);
//!
//! let status = client.ask(&Status)?;
//! assert_eq!(status.slots[0].identity, blob.identity());
//! # Ok(())
//! # }
//! ```

pub mod client;
pub mod flashing;
#[cfg(feature = "serial")]
pub mod open;
#[cfg(feature = "serial")]
pub mod port;
pub mod wire;

pub use client::{Client, LinkError, Patience};
#[cfg(feature = "serial")]
pub use open::OpenError;
#[cfg(feature = "serial")]
pub use port::Port;
pub use wire::Wire;
