//! Pointers from C, checked as far as they can be: against null and misalignment.

use crate::status::GrnStatus;
use core::slice;

/// No blob is longer: a header of 15 bytes, a payload of at most 2^16 - 1, and a checksum of 4.
const LONGEST_BLOB: usize = 15 + u16::MAX as usize + 4;

fn checked<T>(pointer: *const T) -> Result<(), GrnStatus> {
    if pointer.is_null() {
        Err(GrnStatus::NullPointer)
    } else if !pointer.is_aligned() {
        Err(GrnStatus::Misaligned)
    } else {
        Ok(())
    }
}

/// # Safety
/// Null, or what it points to is of type `T`, and nobody writes it during `'a`.
pub unsafe fn shared<'a, T>(pointer: *const T) -> Result<&'a T, GrnStatus> {
    checked(pointer)?;
    // SAFETY: not null and aligned; the caller vouches for the rest.
    Ok(unsafe { &*pointer })
}

/// # Safety
/// Null, or what it points to is of type `T`, and nobody else uses it during `'a`.
pub unsafe fn exclusive<'a, T>(pointer: *mut T) -> Result<&'a mut T, GrnStatus> {
    checked(pointer)?;
    // SAFETY: not null and aligned; the caller vouches for the rest.
    Ok(unsafe { &mut *pointer })
}

/// # Safety
/// Null, or there is room for a `T`, which nobody else uses now.
pub unsafe fn write<T>(pointer: *mut T, value: T) -> Result<(), GrnStatus> {
    checked(pointer)?;
    // SAFETY: not null and aligned; the caller vouches for the room.
    unsafe { pointer.write(value) };
    Ok(())
}

/// # Safety
/// Null, or there is room for these bytes, which nobody else uses now.
pub unsafe fn copy(bytes: &[u8], pointer: *mut u8) -> Result<(), GrnStatus> {
    checked(pointer)?;
    // SAFETY: not null; the caller vouches for the room, and nobody else uses it, so that it is not that of `bytes`.
    unsafe { pointer.copy_from_nonoverlapping(bytes.as_ptr(), bytes.len()) };
    Ok(())
}

/// The bytes of a blob or a message; of more than any blob can have, as many as show that it is too long.
///
/// # Safety
/// Null, or there are `length` bytes, which nobody writes during `'a`.
pub unsafe fn bytes<'a>(pointer: *const u8, length: usize) -> Result<&'a [u8], GrnStatus> {
    checked(pointer)?;
    // SAFETY: not null; the caller vouches for `length` bytes, and no more than that are taken.
    Ok(unsafe { slice::from_raw_parts(pointer, length.min(LONGEST_BLOB + 1)) })
}
