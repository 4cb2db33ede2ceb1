//! What is in an image: sizes and symbols.

use object::elf::{SHF_ALLOC, SHF_EXECINSTR, SHF_WRITE, SHT_NOBITS};
use object::{Object, ObjectSection, ObjectSymbol, SectionFlags};
use std::fmt;
use std::fs;
use std::path::Path;

/// What an image's file says about itself.
pub struct Elf {
    /// Sizes of what is loaded or reserved.
    pub sizes: Sizes,
    /// Names of all symbols, as the linker knows them.
    pub symbols: Vec<String>,
}

/// Bytes of each sort.
#[derive(Default)]
pub struct Sizes {
    /// Instructions: `.text`.
    pub code: usize,
    /// Constants: `.rodata`, the vector table.
    pub constants: usize,
    /// Variables with initial values.
    pub data: usize,
    /// Variables that are zero at first, but for the emulated slots.
    pub zeroed: usize,
}

impl Sizes {
    /// Static memory.
    pub fn memory(&self) -> usize {
        self.data + self.zeroed
    }

    /// A golden file's lines.
    pub fn lines(&self) -> String {
        let Sizes { code, constants, data, zeroed } = self;
        format!("text {code}\nrodata {constants}\ndata {data}\nbss {zeroed}\n")
    }

    /// Adds up the sections of an image.
    fn of(file: &object::File) -> object::Result<Sizes> {
        let mut sizes = Sizes::default();
        for section in file.sections() {
            let SectionFlags::Elf { sh_type, sh_flags } = section.flags() else { continue };
            if !sh_flags.contains(SHF_ALLOC) || section.name()? == ".slots" {
                continue;
            }
            let (executed, written) = (sh_flags.contains(SHF_EXECINSTR), sh_flags.contains(SHF_WRITE));
            let sum = match (executed, written) {
                (true, _) => &mut sizes.code,
                (false, false) => &mut sizes.constants,
                (false, true) if sh_type == SHT_NOBITS => &mut sizes.zeroed,
                (false, true) => &mut sizes.data,
            };
            *sum += section.size() as usize;
        }
        Ok(sizes)
    }
}

impl fmt::Display for Sizes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} bytes", self.lines().trim_end().replace('\n', ", "))
    }
}

impl Elf {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Elf, String> {
        let bytes = fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
        Elf::parse(&bytes).map_err(|error| format!("{}: {error}", path.display()))
    }

    fn parse(bytes: &[u8]) -> object::Result<Elf> {
        let file = object::File::parse(bytes)?;
        let symbols = file.symbols().map(|symbol| symbol.name().map(str::to_owned)).collect::<Result<_, _>>()?;
        Ok(Elf { sizes: Sizes::of(&file)?, symbols })
    }
}
