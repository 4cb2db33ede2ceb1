//! A slot as a file for a programmer: Intel HEX, plain binary, and the commands that bring them onto a robot.

use crate::files::{self, FileError};
use crate::quoting::{gdb_load, shell_word};
use crate::sectors::Sector;
use grn_core::robot::slots;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::{SystemTime, UNIX_EPOCH};

/// Bytes in a line of a HEX file.
const HEX_LINE: usize = 16;

/// The content of a slot and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SlotFile {
    /// What lies there.
    pub bytes: Vec<u8>,
    /// Address of the first byte in the robot's memory.
    pub address: u32,
}

/// Absolute paths of the files that [`SlotFile::write`] writes: the commands that name them work from every folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SlotPaths {
    /// Intel HEX.
    hex: String,
    /// The bytes alone.
    binary: String,
    /// Commands for GDB and the e-puck2's on-board programmer.
    gdb: String,
}

impl SlotPaths {
    /// Names of the files, in the order of the fields.
    pub const NAMES: [&str; 3] = ["slot.hex", "slot.bin", "flash.gdb"];

    /// The paths in a folder.
    ///
    /// # Errors
    /// A folder that no command could name: its path is not UTF-8, or has a `~` behind a blank, which GDB replaces by a home
    /// folder whatever stands around it.
    pub fn in_folder(folder: &Path) -> Result<Self, FileError> {
        let absolute = std::path::absolute(folder)
            .map_err(|error| FileError::new(folder, format!("this is no path of a folder: {error}")))?;
        let path = |name: &str| match absolute.join(name).into_os_string().into_string() {
            Ok(path) => Ok(path),
            Err(_) => Err(FileError::new(folder, "its path is not UTF-8: choose another folder with --out")),
        };
        let [hex, binary, gdb] = SlotPaths::NAMES.map(path);
        let paths = SlotPaths { hex: hex?, binary: binary?, gdb: gdb? };
        if [" ~", "\t~"].iter().any(|home| paths.hex.contains(home)) {
            let told = "GDB takes a ~ behind a blank for a home folder: choose another folder with --out";
            return Err(FileError::new(folder, told));
        }
        Ok(paths)
    }

    /// The shell command that runs the GDB script.
    pub fn gdb_line(&self) -> String {
        format!("arm-none-eabi-gdb --batch --command {}", shell_word(&self.gdb))
    }
}

/// The number of an upload: of two slots the robot takes the one with the higher number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct UploadNumber(u32);

/// A number that no upload by a programmer has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UploadNumberError;

impl UploadNumber {
    /// The highest. Uploads through the link count on from it, and must never arrive at the end of 32 bits.
    pub const MAX: UploadNumber = UploadNumber(4_000_000_000);

    /// The present time in seconds since 1970, which fits until 2096.
    ///
    /// # Errors
    /// A clock that shows an earlier or later time.
    pub fn of_clock() -> Result<Self, UploadNumberError> {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).map_err(|_| UploadNumberError)?;
        u32::try_from(since.as_secs()).map_err(|_| UploadNumberError)?.try_into()
    }
}

impl TryFrom<u32> for UploadNumber {
    type Error = UploadNumberError;

    fn try_from(number: u32) -> Result<Self, UploadNumberError> {
        Some(UploadNumber(number)).filter(|number| *number <= UploadNumber::MAX).ok_or(UploadNumberError)
    }
}

impl FromStr for UploadNumber {
    type Err = UploadNumberError;

    fn from_str(text: &str) -> Result<Self, UploadNumberError> {
        text.parse::<u32>().map_err(|_| UploadNumberError)?.try_into()
    }
}

impl fmt::Display for UploadNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Display for UploadNumberError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "upload numbers are 0 to {}, so that later uploads can have higher ones; leave out --sequence to take the \
             seconds since 1970",
            UploadNumber::MAX
        )
    }
}

impl std::error::Error for UploadNumberError {}

/// How GDB reaches the programmer: a serial port, or HOST:PORT.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Programmer(String);

/// GDB cannot be told this name of a programmer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgrammerError;

impl Programmer {
    /// Where Linux puts the e-puck2's programmer if it is the only such device.
    pub const DEFAULT: &str = "/dev/ttyACM0";
}

impl FromStr for Programmer {
    type Err = ProgrammerError;

    /// GDB takes the rest of the line as the name and knows no quotes there: blanks at the ends would be lost, and a
    /// line break or a backslash at the end would change the script.
    fn from_str(text: &str) -> Result<Self, ProgrammerError> {
        let one_line = !text.chars().any(char::is_control);
        let whole = !text.is_empty() && text.trim() == text && !text.ends_with('\\');
        if one_line && whole { Ok(Programmer(text.into())) } else { Err(ProgrammerError) }
    }
}

impl fmt::Display for Programmer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl fmt::Display for ProgrammerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "GDB cannot be given this name: it is empty, begins or ends with a blank, ends with a backslash or has \
             control characters; give a serial port like /dev/ttyACM0, or HOST:PORT",
        )
    }
}

impl std::error::Error for ProgrammerError {}

impl SlotFile {
    /// A blob, confirmed, for the slot in `sector`.
    ///
    /// # Errors
    /// What is wrong with the blob.
    pub fn new(blob: &[u8], sector: Sector, number: UploadNumber) -> Result<Self, slots::SlotError> {
        // The smallest sector has 16 KiB.
        const { assert!(slots::MIN_SLOT <= 16 * 1024) };
        Ok(SlotFile { bytes: slots::image(blob, number.0)?.to_vec(), address: sector.start() })
    }

    /// As Intel HEX with 32-bit addresses.
    pub fn hex(&self) -> String {
        let mut records = Vec::new();
        let mut upper = None;
        for (line, bytes) in (self.address..).step_by(HEX_LINE).zip(self.bytes.chunks(HEX_LINE)) {
            if upper != Some(line >> 16) {
                upper = Some(line >> 16);
                records.push(ihex::Record::ExtendedLinearAddress((line >> 16) as u16));
            }
            records.push(ihex::Record::Data { offset: line as u16, value: bytes.to_vec() });
        }
        records.push(ihex::Record::EndOfFile);
        // It fails only for records of more than 255 bytes or without an end.
        ihex::create_object_file_representation(&records).unwrap_or_default()
    }

    /// GDB commands that load the HEX file through the e-puck2's on-board Black Magic Probe.
    fn gdb_script(&self, paths: &SlotPaths, programmer: &Programmer) -> String {
        format!(
            "# arm-none-eabi-gdb --batch --command THIS_FILE   (or gdb-multiarch)\n\
             # The path below is that of the machine where this was written; change it if you move the files.\n\
             target extended-remote {programmer}\n\
             monitor swdp_scan\n\
             attach 1\n\
             {}\n\
             compare-sections\n\
             kill\n",
            gdb_load(&paths.hex)
        )
    }

    /// The shell command that writes the binary file over USB DFU.
    pub fn dfu_line(&self, paths: &SlotPaths) -> String {
        format!("dfu-util -d 0483:df11 -a 0 -s {:#010x} -D {}", self.address, shell_word(&paths.binary))
    }

    /// Writes `slot.hex`, `slot.bin` and `flash.gdb`.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, paths: &SlotPaths, programmer: &Programmer) -> Result<(), FileError> {
        let (hex, script) = (self.hex(), self.gdb_script(paths, programmer));
        let places = [&paths.hex, &paths.binary, &paths.gdb].map(PathBuf::from);
        files::write_together(places.into_iter().zip([hex.as_bytes(), &self.bytes, script.as_bytes()]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_lines_follow_the_addresses() {
        let file = SlotFile { bytes: (0..20).collect(), address: 0x080b_fff0 };
        let expected = ":02000004080BE7\n:10FFF000000102030405060708090A0B0C0D0E0F89\n:02000004080CE6\n:0400000010111213B6\n\
                        :00000001FF\n";
        assert_eq!(file.hex().to_uppercase(), expected);
        let paths = SlotPaths::in_folder(Path::new("/out")).unwrap();
        assert!(file.dfu_line(&paths).ends_with("-s 0x080bfff0 -D /out/slot.bin"));
    }

    #[test]
    fn a_programmer_is_one_name_on_one_line() {
        for name in ["/dev/ttyACM0", "COM3", "localhost:2331", "/dev/serial/by-id/with blank"] {
            assert_eq!(name.parse::<Programmer>().unwrap().to_string(), name);
        }
        for name in ["", " ", "/dev/ttyACM0 ", "/dev/x\nshell true", "/dev/x\\", "\u{1b}[2J"] {
            assert_eq!(name.parse::<Programmer>(), Err(ProgrammerError), "{name:?}");
        }
    }
}
