//! Two slots in RAM that outlast a reset but not the emulator: QEMU's STM32F405 has no flash controller.

use core::ptr::NonNull;
use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash, check_erase, check_read, check_write,
};

/// Where the first slot begins; see `boards/netduinoplus2.x`. QEMU can fill it: `-device loader,addr=0x2001F800,…`.
pub const ADDRESS: usize = 0x2001_f800;
/// Bytes of a slot.
pub const SLOT: u32 = 1024;
const CAPACITY: usize = 2 * SLOT as usize;
const ERASED: u8 = 0xff;

/// RAM that behaves like NOR flash: erased to ones, written to zeros.
pub struct SlotMemory(NonNull<[u8; CAPACITY]>);

impl SlotMemory {
    /// The board's slots.
    ///
    /// # Safety
    /// There must be only one at a time.
    pub unsafe fn take() -> Self {
        // The address is not null.
        SlotMemory(unsafe { NonNull::new_unchecked(ADDRESS as *mut [u8; CAPACITY]) })
    }

    fn bytes(&mut self) -> &mut [u8] {
        // SAFETY: the linker keeps these bytes of RAM free, any content is valid, and this is their only owner.
        unsafe { self.0.as_mut() }
    }
}

impl ErrorType for SlotMemory {
    type Error = NorFlashErrorKind;
}

impl ReadNorFlash for SlotMemory {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
        check_read(self, offset, bytes.len())?;
        for (byte, stored) in bytes.iter_mut().zip(self.bytes().iter().skip(offset as usize)) {
            *byte = *stored;
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        CAPACITY
    }
}

impl NorFlash for SlotMemory {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SLOT as usize;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), NorFlashErrorKind> {
        check_erase(self, from, to)?;
        let length = (to - from) as usize;
        self.bytes().iter_mut().skip(from as usize).take(length).for_each(|byte| *byte = ERASED);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
        check_write(self, offset, bytes.len())?;
        for (stored, byte) in self.bytes().iter_mut().skip(offset as usize).zip(bytes) {
            *stored &= byte;
        }
        Ok(())
    }
}
