//! A robot's image in QEMU, behind a link.

use core::time::Duration;
use grn_link::Wire;
use std::io;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

/// The board that the image is for; an STM32F405, of the e-puck2's family.
const MACHINE: &str = "netduinoplus2";
/// How long QEMU may take to open its end of the link.
const PATIENCE: Duration = Duration::from_secs(10);

/// An emulated robot; it ends when it is dropped.
#[derive(Debug)]
pub struct Emulator {
    process: Child,
    socket: PathBuf,
    wire: UnixStream,
}

impl Emulator {
    /// Starts an image; `socket` names the Unix socket that becomes its serial line.
    ///
    /// # Errors
    /// A missing image or QEMU, or a QEMU that does not open the socket; in words with the way out.
    pub fn start(image: &Path, socket: PathBuf) -> io::Result<Self> {
        if !image.exists() {
            let missing = format!("{} is not there; build it with `cargo xtask target`", image.display());
            return Err(io::Error::new(io::ErrorKind::NotFound, missing));
        }
        let mut process = Command::new("qemu-system-arm")
            .args(["-M", MACHINE, "-display", "none", "-monitor", "none"])
            .arg("-chardev")
            .arg(format!("socket,id=link,path={},server=on,wait=on", socket.display()))
            .args(["-serial", "chardev:link", "-semihosting-config", "enable=on,target=native", "-kernel"])
            .arg(image)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| {
                let way_out = "install it, on Debian with `apt-get install qemu-system-arm`";
                io::Error::new(error.kind(), format!("qemu-system-arm cannot be run: {error}; {way_out}"))
            })?;
        match connect(&mut process, &socket) {
            Ok(wire) => Ok(Emulator { process, socket, wire }),
            Err(error) => {
                let _ = process.kill();
                let _ = process.wait();
                Err(error)
            }
        }
    }
}

fn connect(process: &mut Child, socket: &Path) -> io::Result<UnixStream> {
    let begun = Instant::now();
    loop {
        if let Ok(wire) = UnixStream::connect(socket) {
            return Ok(wire);
        }
        if let Some(status) = process.try_wait()? {
            return Err(io::Error::other(format!("qemu-system-arm ended with {status}")));
        }
        if begun.elapsed() > PATIENCE {
            return Err(io::Error::new(io::ErrorKind::TimedOut, "qemu-system-arm opens no serial line"));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // If it has ended already there is nothing to do.
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = std::fs::remove_file(&self.socket);
    }
}

impl Wire for Emulator {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.wire.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        self.wire.receive(buffer, patience)
    }
}
