//! A robot's image in QEMU, behind a link.

use core::error::Error;
use core::fmt;
use core::time::Duration;
use grn_link::Wire;
use std::fs::File;
use std::io::{self, Read};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Instant;

/// The board that the image is for; an STM32F405, of the e-puck2's family.
const MACHINE: &str = "netduinoplus2";
/// How long QEMU may take to open its end of the link.
const PATIENCE: Duration = Duration::from_secs(10);

/// Why an image does not run.
#[derive(Debug)]
pub enum EmulatorError {
    /// It cannot be read.
    Image(PathBuf, io::Error),
    /// It is no ELF file for Arm.
    NotAnImage(PathBuf),
    /// QEMU cannot be run.
    Run(io::Error),
    /// QEMU ended at once.
    Ended(ExitStatus),
    /// QEMU did not open its end of the link in time.
    Silent,
}

impl fmt::Display for EmulatorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EmulatorError::Image(path, error) if error.kind() == io::ErrorKind::NotFound => {
                write!(f, "{} is not there; build it with `cargo xtask target`", path.display())
            }
            EmulatorError::Image(path, _) => write!(f, "{}: the image cannot be read", path.display()),
            EmulatorError::NotAnImage(path) => {
                write!(
                    f,
                    "{} is no image, an ELF file for Arm; give one that `cargo xtask target` builds",
                    path.display()
                )
            }
            EmulatorError::Run(_) => f.write_str(
                "qemu-system-arm cannot be run; install it, on Debian with `apt-get install qemu-system-arm`",
            ),
            EmulatorError::Ended(status) => write!(f, "qemu-system-arm ended with {status}"),
            EmulatorError::Silent => f.write_str("qemu-system-arm opens no serial line"),
        }
    }
}

impl Error for EmulatorError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            EmulatorError::Image(_, error) | EmulatorError::Run(error) => Some(error),
            EmulatorError::NotAnImage(_) | EmulatorError::Ended(_) | EmulatorError::Silent => None,
        }
    }
}

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
    /// [`EmulatorError`].
    pub fn start(image: &Path, socket: PathBuf) -> Result<Self, EmulatorError> {
        check(image)?;
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
            .map_err(EmulatorError::Run)?;
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

/// Refuses what is no program for an Arm chip before QEMU takes it for a memory dump and runs that.
fn check(image: &Path) -> Result<(), EmulatorError> {
    let mut header = Vec::new();
    let read = File::open(image).and_then(|file| file.take(20).read_to_end(&mut header));
    read.map_err(|error| EmulatorError::Image(image.into(), error))?;
    // ELF of 32 bits, little-endian; its machine is 40, EM_ARM.
    let is_for_arm = header.starts_with(b"\x7fELF\x01\x01") && header.get(18..20) == Some(&[40, 0]);
    if is_for_arm { Ok(()) } else { Err(EmulatorError::NotAnImage(image.into())) }
}

fn connect(process: &mut Child, socket: &Path) -> Result<UnixStream, EmulatorError> {
    let begun = Instant::now();
    loop {
        if let Ok(wire) = UnixStream::connect(socket) {
            return Ok(wire);
        }
        if let Some(status) = process.try_wait().map_err(EmulatorError::Run)? {
            return Err(EmulatorError::Ended(status));
        }
        if begun.elapsed() > PATIENCE {
            return Err(EmulatorError::Silent);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_program_for_arm_is_not_run() {
        let image = std::env::temp_dir().join(format!("grn-no-image-{}", std::process::id()));
        let mut x86 = b"\x7fELF\x02\x01\x01".to_vec();
        x86.resize(18, 0);
        x86.extend([62, 0]);
        for content in [b"".as_slice(), b"GRNb", b"\x7fELF\x01\x01", &x86] {
            std::fs::write(&image, content).unwrap();
            let error = Emulator::start(&image, image.with_extension("socket")).unwrap_err();
            assert!(matches!(error, EmulatorError::NotAnImage(_)), "{error}");
        }
        std::fs::remove_file(&image).unwrap();
        let error = Emulator::start(&image, image.with_extension("socket")).unwrap_err().to_string();
        assert!(error.contains("is not there; build it"), "{error}");
    }
}
