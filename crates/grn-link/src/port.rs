//! Where robots answer: serial ports and sockets, by their names.

use core::fmt;
use core::net::Ipv6Addr;
use core::str::FromStr;
use serial2::SerialPort;
use std::io;

/// Where a robot answers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Port {
    /// A serial port, by its name in the operating system.
    Serial(String),
    /// A TCP socket.
    Tcp {
        /// A name, or an address of version 4 or 6 without brackets.
        host: String,
        /// Its port number, from 1.
        number: u16,
    },
    /// A Unix socket, by its path.
    Unix(String),
}

/// Why text names no [`Port`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortError {
    /// It is empty.
    Empty,
    /// `tcp:` without a host.
    NoHost,
    /// `tcp:HOST` without a port number.
    NoNumber,
    /// What stands for the port number is none.
    Number,
    /// A host with colons that is no IPv6 address.
    Address,
    /// `unix:` without a path.
    NoPath,
}

impl fmt::Display for PortError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            PortError::Empty => "the name of the port is empty; give a serial port, tcp:HOST:PORT or unix:PATH",
            PortError::NoHost => "the host is missing; write tcp:HOST:PORT",
            PortError::NoNumber => "the port number is missing; write tcp:HOST:PORT with a number from 1 to 65535",
            PortError::Number => "the port number is none from 1 to 65535; write tcp:HOST:PORT",
            PortError::Address => "the host is no IPv6 address; write tcp:HOST:PORT, an IPv6 address in brackets",
            PortError::NoPath => "the path is missing; write unix:PATH",
        })
    }
}

impl core::error::Error for PortError {}

impl FromStr for Port {
    type Err = PortError;

    /// `tcp:HOST:PORT`, `unix:PATH`, or else the name of a serial port.
    ///
    /// ```
    /// use grn_link::Port;
    ///
    /// assert_eq!("tcp:[::1]:7000".parse(), Ok(Port::Tcp { host: "::1".into(), number: 7000 }));
    /// assert_eq!("/dev/ttyACM0".parse(), Ok(Port::Serial("/dev/ttyACM0".into())));
    /// assert!("tcp:robot:70000".parse::<Port>().is_err());
    /// ```
    fn from_str(text: &str) -> Result<Self, PortError> {
        match text.split_once(':') {
            Some(("tcp", address)) => tcp(address),
            Some(("unix", "")) => Err(PortError::NoPath),
            Some(("unix", path)) => Ok(Port::Unix(path.into())),
            _ if text.is_empty() => Err(PortError::Empty),
            _ => Ok(Port::Serial(text.into())),
        }
    }
}

fn tcp(address: &str) -> Result<Port, PortError> {
    let (host, number) = address.rsplit_once(':').ok_or(PortError::NoNumber)?;
    if host.is_empty() {
        return Err(PortError::NoHost);
    }
    if number.is_empty() || number.ends_with(']') {
        return Err(PortError::NoNumber);
    }
    let bare = host.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).unwrap_or(host);
    // Behind a percent sign stands the network interface of a link-local address.
    let without_interface = bare.split_once('%').map_or(bare, |(address, _)| address);
    if bare.contains([':', '[', ']']) && without_interface.parse::<Ipv6Addr>().is_err() {
        return Err(PortError::Address);
    }
    let number = number.parse().ok().filter(|&number| number != 0).ok_or(PortError::Number)?;
    Ok(Port::Tcp { host: bare.into(), number })
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Port::Serial(name) => f.write_str(name),
            Port::Tcp { host, number } if host.contains(':') => write!(f, "tcp:[{host}]:{number}"),
            Port::Tcp { host, number } => write!(f, "tcp:{host}:{number}"),
            Port::Unix(path) => write!(f, "unix:{path}"),
        }
    }
}

impl Port {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_ports_are_read_and_written() {
        let tcp = |host: &str| Port::Tcp { host: host.into(), number: 7000 };
        let cases = [
            ("tcp:robot-7.local:7000", tcp("robot-7.local")),
            ("tcp:192.168.1.7:7000", tcp("192.168.1.7")),
            ("tcp:[fe80::1%eth0]:7000", tcp("fe80::1%eth0")),
            ("unix:/run/a:b", Port::Unix("/run/a:b".into())),
            ("COM3", Port::Serial("COM3".into())),
        ];
        for (text, port) in cases {
            assert_eq!(text.parse(), Ok(port.clone()));
            assert_eq!(port.to_string(), text);
        }
        assert_eq!("tcp:::1:7000".parse(), Ok(tcp("::1")), "brackets may be left out");
    }

    #[test]
    fn wrong_names_of_ports_are_refused() {
        let cases = [
            ("", PortError::Empty),
            ("unix:", PortError::NoPath),
            ("tcp:", PortError::NoNumber),
            ("tcp:robot", PortError::NoNumber),
            ("tcp:robot:", PortError::NoNumber),
            ("tcp:[::1]", PortError::NoNumber),
            ("tcp::7000", PortError::NoHost),
            ("tcp:robot:0", PortError::Number),
            ("tcp:robot:65536", PortError::Number),
            ("tcp:robot:-1", PortError::Number),
            ("tcp:robot:http", PortError::Number),
            ("tcp:a:b:7000", PortError::Address),
            ("tcp:[robot]]:7000", PortError::Address),
        ];
        for (text, error) in cases {
            assert_eq!(text.parse::<Port>(), Err(error), "{text}");
        }
    }
}
