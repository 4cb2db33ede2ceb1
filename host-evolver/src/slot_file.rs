//! A slot as a file for a programmer: Intel HEX, plain binary, and the commands that bring them onto a robot.

use crate::files::{self, FileError};
use crate::sectors::Sector;
use grn_core::robot::slots;
use std::path::{Path, PathBuf};

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

/// The files that [`SlotFile::write`] writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Intel HEX.
    pub hex: PathBuf,
    /// The bytes alone.
    pub binary: PathBuf,
    /// Commands for GDB and the e-puck2's on-board programmer.
    pub gdb: PathBuf,
}

impl SlotFile {
    /// A blob, confirmed, for the slot in `sector`; of two slots the robot takes that with the higher sequence number.
    ///
    /// # Errors
    /// What is wrong with the blob.
    pub fn new(blob: &[u8], sector: Sector, sequence: u32) -> Result<Self, slots::SlotError> {
        // The smallest sector has 16 KiB.
        const { assert!(slots::MIN_SLOT <= 16 * 1024) };
        Ok(SlotFile { bytes: slots::image(blob, sequence)?.to_vec(), address: sector.start() })
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
    pub fn gdb_script(&self, hex: &Path, port: &str) -> String {
        format!(
            "# arm-none-eabi-gdb --batch --command THIS_FILE   (or gdb-multiarch)\n\
             target extended-remote {port}\n\
             monitor swdp_scan\n\
             attach 1\n\
             load {}\n\
             compare-sections\n\
             kill\n",
            hex.display()
        )
    }

    /// The command that writes the binary file over USB DFU.
    pub fn dfu_line(&self, binary: &Path) -> String {
        format!("dfu-util -d 0483:df11 -a 0 -s {:#010x} -D {}", self.address, binary.display())
    }

    /// The names of the files in a folder.
    pub fn names(folder: &Path) -> Written {
        Written { hex: folder.join("slot.hex"), binary: folder.join("slot.bin"), gdb: folder.join("flash.gdb") }
    }

    /// Writes `slot.hex`, `slot.bin` and `flash.gdb` into a folder.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, folder: &Path, port: &str) -> Result<Written, FileError> {
        let names = SlotFile::names(folder);
        files::write(&names.hex, self.hex())?;
        files::write(&names.binary, &self.bytes)?;
        files::write(&names.gdb, self.gdb_script(&names.hex, port))?;
        Ok(names)
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
        assert!(file.dfu_line(Path::new("slot.bin")).ends_with("-s 0x080bfff0 -D slot.bin"));
    }
}
