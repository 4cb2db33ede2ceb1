//! What is in an image: as much of the ELF format as sizes and symbols need (32 bits, little-endian).

use std::fmt;
use std::fs;
use std::path::Path;

/// An image's file.
pub struct Elf {
    bytes: Vec<u8>,
    sections: Vec<Section>,
}

#[derive(Clone, Copy)]
struct Section {
    name: usize,
    kind: u32,
    flags: u32,
    offset: usize,
    size: usize,
    link: usize,
}

/// Bytes of each sort.
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
}

impl fmt::Display for Sizes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} bytes", self.lines().trim_end().replace('\n', ", "))
    }
}

const SYMBOL_TABLE: u32 = 2;
const NO_BITS: u32 = 8;
const WRITE: u32 = 1;
const ALLOCATED: u32 = 2;
const EXECUTABLE: u32 = 4;
const SYMBOL_BYTES: usize = 16;

impl Elf {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Elf, String> {
        let wrong = |what: &dyn fmt::Display| format!("{}: {what}", path.display());
        let bytes = fs::read(path).map_err(|error| wrong(&error))?;
        if !bytes.starts_with(b"\x7fELF\x01\x01") {
            return Err(wrong(&"not a little-endian 32-bit ELF file"));
        }
        let mut elf = Elf { bytes, sections: Vec::new() };
        elf.sections = elf.section_headers().ok_or_else(|| wrong(&"its section headers are damaged"))?;
        Ok(elf)
    }

    fn section_headers(&self) -> Option<Vec<Section>> {
        let start = self.word(0x20)?;
        let (size, count) = (self.half(0x2e)?, self.half(0x30)?);
        let header = |index: usize| {
            let field = |number: usize| self.word(start + index * size + 4 * number);
            Some(Section {
                name: field(0)?,
                kind: field(1)? as u32,
                flags: field(2)? as u32,
                offset: field(4)?,
                size: field(5)?,
                link: field(6)?,
            })
        };
        (0..count).map(header).collect()
    }

    /// Sizes of what is loaded or reserved.
    pub fn sizes(&self) -> Sizes {
        let names = self.half(0x32).and_then(|index| self.sections.get(index));
        let of_name = |section: &&Section| names.and_then(|names| self.string(names, section.name)) != Some(".slots");
        let sum = |of_sort: &dyn Fn(&Section) -> bool| {
            let sections = self.sections.iter().filter(|section| section.flags & ALLOCATED != 0).filter(of_name);
            sections.filter(|section| of_sort(section)).map(|section| section.size).sum()
        };
        let written = |section: &Section| section.flags & WRITE != 0;
        let executed = |section: &Section| section.flags & EXECUTABLE != 0;
        Sizes {
            code: sum(&executed),
            constants: sum(&|section| !executed(section) && !written(section)),
            data: sum(&|section| written(section) && section.kind != NO_BITS),
            zeroed: sum(&|section| written(section) && section.kind == NO_BITS),
        }
    }

    /// Names of all symbols, as the linker knows them.
    pub fn symbols(&self) -> impl Iterator<Item = &str> {
        let tables = self.sections.iter().filter(|section| section.kind == SYMBOL_TABLE);
        tables.flat_map(move |table| {
            let names = self.sections.get(table.link);
            (0..table.size / SYMBOL_BYTES)
                .filter_map(move |index| self.string(names?, self.word(table.offset + index * SYMBOL_BYTES)?))
        })
    }

    fn string(&self, table: &Section, at: usize) -> Option<&str> {
        let bytes = self.bytes.get(table.offset + at..)?;
        std::str::from_utf8(bytes.split(|&byte| byte == 0).next()?).ok()
    }

    fn word(&self, at: usize) -> Option<usize> {
        let bytes = self.bytes.get(at..)?.first_chunk()?;
        usize::try_from(u32::from_le_bytes(*bytes)).ok()
    }

    fn half(&self, at: usize) -> Option<usize> {
        self.bytes.get(at..)?.first_chunk().map(|bytes| usize::from(u16::from_le_bytes(*bytes)))
    }
}
