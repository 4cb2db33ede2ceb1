//! Opening a port, in bounded time.

use crate::port::Port;
use crate::wire::{Wire, read_within};
use core::fmt;
use core::time::Duration;
use serial2::{KeepSettings, SerialPort};
use std::io;
use std::net::{TcpStream, ToSocketAddrs};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

/// How long a wire may refuse to take bytes before sending fails: far more than a frame of 576 bytes needs at 9600 baud.
const SEND_LIMIT: Duration = Duration::from_secs(3);

/// Why a port was not opened.
#[derive(Debug)]
pub enum OpenError {
    /// The host's name has no address.
    Resolve(io::Error),
    /// The operating system refuses.
    Refused(io::Error),
    /// What lies there is neither a serial port nor a socket, as the port's name says.
    OtherKind(Kind),
    /// Another program uses the serial port.
    Busy,
    /// The serial port cannot be set to this baud rate.
    BaudRate(io::Error),
    /// Nobody answered in time.
    TimedOut {
        /// How long was waited.
        after: Duration,
    },
}

/// What lies at a path instead of a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A folder.
    Directory,
    /// A file.
    File,
    /// A Unix socket where a serial port is meant.
    Socket,
    /// A device or a pipe, but no serial port.
    Device,
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OpenError::Resolve(_) => f.write_str("no address is known for this host"),
            OpenError::Refused(_) => f.write_str("the port cannot be opened"),
            OpenError::OtherKind(Kind::Directory) => f.write_str("this is a directory"),
            OpenError::OtherKind(Kind::File) => f.write_str("this is a file"),
            OpenError::OtherKind(Kind::Socket) => f.write_str("this is a socket, not a serial port"),
            OpenError::OtherKind(Kind::Device) => f.write_str("this device is no serial port"),
            OpenError::Busy => f.write_str("another program uses the port"),
            OpenError::BaudRate(_) => f.write_str("the port cannot be set to this baud rate"),
            OpenError::TimedOut { after } => write!(f, "no connection within {} s", after.as_secs_f32()),
        }
    }
}

impl core::error::Error for OpenError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            OpenError::Resolve(error) | OpenError::Refused(error) | OpenError::BaudRate(error) => Some(error),
            OpenError::OtherKind(_) | OpenError::Busy | OpenError::TimedOut { .. } => None,
        }
    }
}

impl Port {
    /// Opens the port within `limit`; `baud` is for serial ports. A host with several addresses is tried at each of them.
    ///
    /// Nothing limits how long an operating system looks up a name or queues at a Unix socket. So a thread of its own opens
    /// the port; after `limit` it is left behind, and ends when the operating system lets it.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn open(&self, baud: u32, limit: Duration) -> Result<Box<dyn Wire>, OpenError> {
        let (port, deadline) = (self.clone(), Instant::now() + limit);
        let (opened, result) = mpsc::sync_channel(1);
        let open = move || {
            // Nobody waits for it any more when the limit is over.
            let _ = opened.send(match &port {
                Port::Serial(name) => serial(name, baud),
                Port::Tcp { host, number } => tcp(host, *number, deadline),
                Port::Unix(path) => unix(path),
            });
        };
        thread::Builder::new().name("open port".into()).spawn(open).map_err(OpenError::Refused)?;
        match result.recv_timeout(limit) {
            Ok(Err(OpenError::TimedOut { .. })) | Err(_) => Err(OpenError::TimedOut { after: limit }),
            Ok(result) => result,
        }
    }
}

fn tcp(host: &str, number: u16, deadline: Instant) -> Result<Box<dyn Wire>, OpenError> {
    let addresses: Vec<_> = (host, number).to_socket_addrs().map_err(OpenError::Resolve)?.collect();
    let mut refused = None;
    for (tried, address) in addresses.iter().enumerate() {
        // Each gets its share of what is left, so that the first, silent one does not keep us from the second.
        let untried = (addresses.len() - tried) as u32;
        let share = deadline.saturating_duration_since(Instant::now()) / untried;
        match TcpStream::connect_timeout(address, share.max(Duration::from_millis(1))) {
            Ok(stream) => return ready(stream).map_err(OpenError::Refused),
            Err(error) if error.kind() == io::ErrorKind::TimedOut => {}
            Err(error) => refused = Some(error),
        }
    }
    Err(refused.map_or(OpenError::TimedOut { after: Duration::ZERO }, OpenError::Refused))
}

fn ready(stream: TcpStream) -> io::Result<Box<dyn Wire>> {
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(SEND_LIMIT))?;
    Ok(Box::new(stream))
}

#[cfg(unix)]
fn unix(path: &str) -> Result<Box<dyn Wire>, OpenError> {
    match kind(path) {
        None | Some(Kind::Socket) => {}
        Some(kind) => return Err(OpenError::OtherKind(kind)),
    }
    let stream = std::os::unix::net::UnixStream::connect(path).map_err(OpenError::Refused)?;
    stream.set_write_timeout(Some(SEND_LIMIT)).map_err(OpenError::Refused)?;
    Ok(Box::new(stream))
}

#[cfg(not(unix))]
fn unix(_: &str) -> Result<Box<dyn Wire>, OpenError> {
    let unsupported = io::Error::new(io::ErrorKind::Unsupported, "this system has no Unix sockets");
    Err(OpenError::Refused(unsupported))
}

/// What lies at a path; `None` if that cannot be told, or nothing does.
#[cfg(unix)]
fn kind(path: &str) -> Option<Kind> {
    use std::os::unix::fs::FileTypeExt;
    let kind = std::fs::metadata(path).ok()?.file_type();
    Some(match kind {
        kind if kind.is_dir() => Kind::Directory,
        kind if kind.is_file() => Kind::File,
        kind if kind.is_socket() => Kind::Socket,
        _ => Kind::Device,
    })
}

#[cfg(not(unix))]
fn kind(path: &str) -> Option<Kind> {
    let kind = std::fs::metadata(path).ok()?.file_type();
    if kind.is_dir() { Some(Kind::Directory) } else { None }
}

fn serial(name: &str, baud: u32) -> Result<Box<dyn Wire>, OpenError> {
    let kind = kind(name);
    if let Some(kind @ (Kind::Directory | Kind::File | Kind::Socket)) = kind {
        return Err(OpenError::OtherKind(kind));
    }
    let refused = |error: io::Error| match (error.kind(), kind) {
        (io::ErrorKind::ResourceBusy, _) => OpenError::Busy,
        // What is there, may be used, and has no settings of a serial line.
        (io::ErrorKind::NotFound | io::ErrorKind::PermissionDenied, _) | (_, None) => OpenError::Refused(error),
        (_, Some(_)) => OpenError::OtherKind(Kind::Device),
    };
    // Its settings stay as they are until it is certain that nobody else uses it.
    let mut port = SerialPort::open(name, KeepSettings).map_err(refused)?;
    lock(&port)?;
    let mut settings = port.get_configuration().map_err(OpenError::Refused)?;
    settings.set_raw();
    settings.set_baud_rate(baud).map_err(OpenError::BaudRate)?;
    port.set_configuration(&settings).map_err(OpenError::BaudRate)?;
    port.set_write_timeout(SEND_LIMIT).map_err(OpenError::Refused)?;
    Ok(Box::new(SerialWire(port)))
}

/// Keeps others out who ask as we do (pyserial, picocom, tio, other processes of ours); until the port is closed.
#[cfg(unix)]
fn lock(port: &SerialPort) -> Result<(), OpenError> {
    use std::os::fd::AsFd;
    let file = std::fs::File::from(port.as_fd().try_clone_to_owned().map_err(OpenError::Refused)?);
    match file.try_lock() {
        Err(std::fs::TryLockError::WouldBlock) => Err(OpenError::Busy),
        // A system that knows no such locks does without.
        Ok(()) | Err(std::fs::TryLockError::Error(_)) => Ok(()),
    }
}

#[cfg(not(unix))]
fn lock(_: &SerialPort) -> Result<(), OpenError> {
    // Windows opens a serial port only once.
    Ok(())
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

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::net::TcpListener;
    use std::os::unix::net::UnixListener;

    const LIMIT: Duration = Duration::from_secs(5);

    fn error(port: &Port) -> OpenError {
        match port.open(115_200, LIMIT) {
            Ok(_) => panic!("{port} was opened"),
            Err(error) => error,
        }
    }

    #[test]
    fn what_is_no_port_is_told() {
        let folder = std::env::temp_dir().join(format!("grn-link-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = |name: &str| folder.join(name).to_str().unwrap().to_string();
        std::fs::write(path("file"), "x").unwrap();
        let _listener = UnixListener::bind(path("socket")).unwrap();
        let kinds = [
            (Port::Serial(path(".")), Kind::Directory),
            (Port::Serial(path("file")), Kind::File),
            (Port::Serial(path("socket")), Kind::Socket),
            (Port::Serial("/dev/null".into()), Kind::Device),
            (Port::Unix(path(".")), Kind::Directory),
            (Port::Unix(path("file")), Kind::File),
            (Port::Unix("/dev/null".into()), Kind::Device),
        ];
        for (port, kind) in kinds {
            assert!(matches!(error(&port), OpenError::OtherKind(found) if found == kind), "{port}: {}", error(&port));
        }
        for port in [Port::Serial(path("missing")), Port::Unix(path("missing"))] {
            assert!(matches!(error(&port), OpenError::Refused(e) if e.kind() == io::ErrorKind::NotFound), "{port}");
        }
        assert!(Port::Unix(path("socket")).open(0, LIMIT).is_ok());
        std::fs::remove_dir_all(&folder).unwrap();
    }

    /// `localhost` resolves to addresses of version 6 and 4 where both exist; only one of them listens.
    #[test]
    fn every_address_of_a_host_is_tried() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let number = listener.local_addr().unwrap().port();
        assert!(Port::Tcp { host: "localhost".into(), number }.open(0, LIMIT).is_ok());
        let unknown = Port::Tcp { host: "no-such-host.invalid".into(), number };
        assert!(matches!(error(&unknown), OpenError::Resolve(_) | OpenError::TimedOut { .. }), "{}", error(&unknown));
    }

    #[test]
    fn a_serial_port_is_opened_once() {
        let (_robot, host) = SerialPort::pair().unwrap();
        let name = std::os::fd::AsFd::as_fd(&host);
        let link = format!("/proc/self/fd/{}", std::os::fd::AsRawFd::as_raw_fd(&name));
        // Other Unixes have no such folder.
        let Ok(name) = std::fs::read_link(link) else { return };
        let port = Port::Serial(name.to_str().unwrap().into());
        let open = port.open(115_200, LIMIT).map_err(|error| panic!("{error}"));
        assert!(matches!(error(&port), OpenError::Busy));
        drop(open);
        assert!(port.open(115_200, LIMIT).is_ok());
    }

    /// A host that answers nothing looks like this from outside: connections stay in a queue that is full.
    #[test]
    fn a_silent_host_is_given_up_after_the_limit() {
        const SHORT: Duration = Duration::from_millis(300);
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        rustix::net::listen(&listener, 0).unwrap();
        let address = listener.local_addr().unwrap();
        let queued = std::iter::from_fn(|| TcpStream::connect_timeout(&address, Duration::from_millis(100)).ok());
        let _queued: Vec<_> = queued.take(9).collect();
        let port = Port::Tcp { host: "127.0.0.1".into(), number: address.port() };
        let begun = Instant::now();
        let error = port.open(0, SHORT).map(|_| ()).unwrap_err();
        assert!(matches!(error, OpenError::TimedOut { after: SHORT }), "{error}");
        assert_eq!(error.to_string(), "no connection within 0.3 s");
        assert!(begun.elapsed() < 10 * SHORT, "{:?}", begun.elapsed());
    }

    #[test]
    fn a_full_unix_socket_is_given_up_after_the_limit() {
        const SHORT: Duration = Duration::from_millis(300);
        let path = std::env::temp_dir().join(format!("grn-link-full-{}", std::process::id()));
        let listener = UnixListener::bind(&path).unwrap();
        rustix::net::listen(&listener, 0).unwrap();
        let port = Port::Unix(path.to_str().unwrap().into());
        let opened: Vec<_> = (0..4).map(|_| port.open(0, SHORT)).collect();
        std::fs::remove_file(&path).unwrap();
        assert!(matches!(opened.last(), Some(Err(OpenError::TimedOut { .. }))));
    }
}
