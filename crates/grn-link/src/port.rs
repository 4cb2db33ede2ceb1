//! Ways to a robot: serial ports and sockets.

use crate::wire::{Wire, read_within};
use serial2::SerialPort;
use std::convert::Infallible;
use std::fmt;
use std::io;
use std::net::TcpStream;
use std::str::FromStr;
use std::time::Duration;

/// Where a robot answers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Port {
    /// A serial port, by its name in the operating system.
    Serial(String),
    /// A TCP socket, `host:port`.
    Tcp(String),
    /// A Unix socket, by its path.
    Unix(String),
}

impl FromStr for Port {
    type Err = Infallible;

    /// `tcp:HOST:PORT`, `unix:PATH`, or else the name of a serial port.
    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(match text.split_once(':') {
            Some(("tcp", address)) => Port::Tcp(address.into()),
            Some(("unix", path)) => Port::Unix(path.into()),
            _ => Port::Serial(text.into()),
        })
    }
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Port::Serial(name) => f.write_str(name),
            Port::Tcp(address) => write!(f, "tcp:{address}"),
            Port::Unix(path) => write!(f, "unix:{path}"),
        }
    }
}

impl Port {
    /// Opens the way; `baud` is for serial ports.
    ///
    /// # Errors
    /// What the operating system says.
    pub fn open(&self, baud: u32) -> io::Result<Box<dyn Wire>> {
        Ok(match self {
            Port::Serial(name) => Box::new(SerialWire(SerialPort::open(name, baud)?)),
            Port::Tcp(address) => {
                let stream = TcpStream::connect(address)?;
                stream.set_nodelay(true)?;
                Box::new(stream)
            }
            #[cfg(unix)]
            Port::Unix(path) => Box::new(std::os::unix::net::UnixStream::connect(path)?),
            #[cfg(not(unix))]
            Port::Unix(_) => return Err(io::Error::new(io::ErrorKind::Unsupported, "no Unix sockets here; use tcp:")),
        })
    }

    /// The serial ports of this machine.
    ///
    /// # Errors
    /// What the operating system says.
    pub fn serial_ports() -> io::Result<Vec<Port>> {
        let mut names = SerialPort::available_ports()?;
        names.sort();
        Ok(names.into_iter().map(|name| Port::Serial(name.to_string_lossy().into_owned())).collect())
    }
}

struct SerialWire(SerialPort);

impl Wire for SerialWire {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        self.0.set_read_timeout(patience)?;
        read_within(self.0.read(buffer))
    }
}
