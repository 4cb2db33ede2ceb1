//! What carries bytes between host and robot.

use core::time::Duration;
use embedded_storage::nor_flash::NorFlash;
use grn_core::robot::link::Server;
use grn_core::scalar::Scalar;
use std::collections::VecDeque;
use std::io::{self, Read, Write};
use std::net::TcpStream;

/// A stream of bytes to and from one robot.
pub trait Wire: Send {
    /// Sends all of these.
    ///
    /// # Errors
    /// What the operating system says; the wire is of no further use then.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Waits for bytes, about as long as `patience` at most, and puts them to the front of `buffer`. How many; 0 if none came.
    ///
    /// # Errors
    /// What the operating system says, or that the other side has gone; the wire is of no further use then.
    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize>;
}

impl<W: Wire + ?Sized> Wire for Box<W> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        (**self).send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        (**self).receive(buffer, patience)
    }
}

impl<W: Wire + ?Sized> Wire for &mut W {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        (**self).send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        (**self).receive(buffer, patience)
    }
}

/// The result of a read with a time limit as [`Wire::receive`] gives it: no bytes if the limit passed or a signal came.
///
/// # Errors
/// All others; an end of the stream becomes [`io::ErrorKind::UnexpectedEof`].
pub fn read_within(read: io::Result<usize>) -> io::Result<usize> {
    match read {
        Ok(0) => Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the other side has gone")),
        Err(error) => match error.kind() {
            io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted => Ok(0),
            _ => Err(error),
        },
        Ok(count) => Ok(count),
    }
}

impl Wire for TcpStream {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        self.set_read_timeout(Some(patience))?;
        read_within(self.read(buffer))
    }
}

#[cfg(unix)]
impl Wire for std::os::unix::net::UnixStream {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        self.set_read_timeout(Some(patience))?;
        read_within(self.read(buffer))
    }
}

/// A robot in this process; it answers what is sent before `send` returns.
pub struct LocalRobot<F, S> {
    server: Server<F, S>,
    answers: VecDeque<u8>,
}

impl<F: NorFlash, S: Scalar> LocalRobot<F, S> {
    /// A wire to this robot.
    pub fn new(server: Server<F, S>) -> Self {
        LocalRobot { server, answers: VecDeque::new() }
    }

    /// The robot.
    pub fn server(&mut self) -> &mut Server<F, S> {
        &mut self.server
    }

    /// The robot, giving up the wire.
    pub fn into_server(self) -> Server<F, S> {
        self.server
    }
}

impl<F: NorFlash + Send, S: Scalar> Wire for LocalRobot<F, S> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        for &byte in bytes {
            self.answers.extend(self.server.receive(byte).unwrap_or_default());
        }
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], _: Duration) -> io::Result<usize> {
        self.answers.read(buffer)
    }
}
