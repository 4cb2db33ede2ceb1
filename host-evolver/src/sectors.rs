//! The flash sectors of the e-puck2's STM32F407, and which of them can hold a slot.

use std::fmt;
use std::str::FromStr;

/// First address of the flash.
const FLASH: u32 = 0x0800_0000;
/// KiB of each sector, in order (reference manual RM0090, table 5).
const KIBIBYTES: [u32; 12] = [16, 16, 16, 16, 64, 128, 128, 128, 128, 128, 128, 128];

/// A sector of the flash: what is erased at once, and so what a slot takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sector(usize);

/// What a sector holds when a slot is not written there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// A slot of the e-puck2's C firmware with the grn library.
    SlotOfCFirmware,
    /// A slot of grn's own image; program of the e-puck2's C firmware.
    SlotOfOwnImage,
    /// Program, of any firmware.
    Program,
    /// The Aseba program of the e-puck2's C firmware.
    Aseba,
    /// The parameters of the e-puck2's C firmware.
    Parameters,
}

/// Why text is not the address of a sector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AddressError {
    /// No number of 32 bits.
    NotANumber,
    /// Not in the flash.
    OutsideFlash,
    /// In the flash, but not where a sector begins.
    InsideSector(Sector),
}

impl Sector {
    /// Where a slot for the e-puck2's C firmware goes if nothing else is said: its first one.
    pub const DEFAULT: Sector = Sector(8);

    /// Its number, from 0.
    pub fn number(self) -> usize {
        self.0
    }

    /// Address of its first byte.
    pub fn start(self) -> u32 {
        FLASH + KIBIBYTES.iter().take(self.0).sum::<u32>() * 1024
    }

    /// How many bytes it has.
    pub fn size(self) -> u32 {
        KIBIBYTES.get(self.0).map_or(0, |kibibytes| kibibytes * 1024)
    }

    /// What it holds otherwise.
    pub fn content(self) -> Content {
        match self.0 {
            2 | 3 => Content::SlotOfOwnImage,
            8 | 9 => Content::SlotOfCFirmware,
            10 => Content::Aseba,
            11 => Content::Parameters,
            _ => Content::Program,
        }
    }

    fn all() -> impl Iterator<Item = Sector> {
        (0..KIBIBYTES.len()).map(Sector)
    }
}

impl Content {
    /// What goes wrong when a slot is written there; `None` where slots belong.
    pub fn danger(self) -> Option<&'static str> {
        match self {
            Content::SlotOfCFirmware | Content::SlotOfOwnImage => None,
            Content::Program => Some("a robot keeps its program there and will not start without it"),
            Content::Aseba => Some(
                "the e-puck2's C firmware keeps its Aseba program there and takes the slot's first bytes for its length: \
                 it crashes at every start until this sector is erased",
            ),
            Content::Parameters => Some(
                "the e-puck2's C firmware keeps its parameters there: they are lost, and it reads the slot as parameters \
                 until this sector is erased",
            ),
        }
    }
}

impl FromStr for Sector {
    type Err = AddressError;

    /// The sector that begins at an address, decimal or with 0x.
    fn from_str(text: &str) -> Result<Self, AddressError> {
        let digits = text.strip_prefix("0x").or(text.strip_prefix("0X"));
        let number = digits.map_or_else(|| text.parse(), |digits| u32::from_str_radix(digits, 16));
        let address = number.map_err(|_| AddressError::NotANumber)?;
        let around = |sector: &Sector| (sector.start()..sector.start() + sector.size()).contains(&address);
        let sector = Sector::all().find(around).ok_or(AddressError::OutsideFlash)?;
        if sector.start() == address { Ok(sector) } else { Err(AddressError::InsideSector(sector)) }
    }
}

/// As the address where it begins.
impl fmt::Display for Sector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "0x{:08X}", self.start())
    }
}

impl fmt::Display for AddressError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AddressError::NotANumber => f.write_str("this is no address of 32 bits")?,
            AddressError::OutsideFlash => f.write_str("the STM32F407's flash is 0x08000000 to 0x080FFFFF")?,
            AddressError::InsideSector(sector) => write!(
                f,
                "a slot begins where a sector of the flash begins; this is inside sector {}, which begins at {sector}",
                sector.number()
            )?,
        }
        f.write_str(
            "; give 0x08080000 or 0x080A0000 for the e-puck2's C firmware, 0x08008000 or 0x0800C000 for grn's own image",
        )
    }
}

impl std::error::Error for AddressError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sectors_begin_where_the_reference_manual_says() {
        let starts: Vec<String> = Sector::all().map(|sector| sector.to_string()).collect();
        let expected = [
            "0x08000000",
            "0x08004000",
            "0x08008000",
            "0x0800C000",
            "0x08010000",
            "0x08020000",
            "0x08040000",
            "0x08060000",
            "0x08080000",
            "0x080A0000",
            "0x080C0000",
            "0x080E0000",
        ];
        assert_eq!(starts, expected);
        let last = Sector(11);
        assert_eq!(last.start() + last.size(), 0x0810_0000);
    }

    #[test]
    fn the_default_is_a_slot_and_four_sectors_are_slots() {
        assert_eq!("0x08080000".parse(), Ok(Sector::DEFAULT));
        let safe: Vec<usize> =
            Sector::all().filter(|sector| sector.content().danger().is_none()).map(Sector::number).collect();
        assert_eq!(safe, [2, 3, 8, 9]);
    }

    #[test]
    fn addresses_that_begin_no_sector_are_refused() {
        assert_eq!("134742016".parse(), Ok(Sector::DEFAULT));
        for text in ["", "0x", "slot", "-1", "0x1_0000", "0x180A00000", "4294967296"] {
            assert_eq!(text.parse::<Sector>(), Err(AddressError::NotANumber), "{text}");
        }
        for text in ["0", "0x07FFFFFF", "0x08100000", "0x20000000", "0xFFFFFFF8"] {
            assert_eq!(text.parse::<Sector>(), Err(AddressError::OutsideFlash), "{text}");
        }
        for (text, sector) in [("0x08080008", 8), ("0x0809FFF8", 8), ("0x080C0100", 10), ("0x0800BFFF", 2)] {
            assert_eq!(text.parse::<Sector>(), Err(AddressError::InsideSector(Sector(sector))), "{text}");
        }
    }
}
