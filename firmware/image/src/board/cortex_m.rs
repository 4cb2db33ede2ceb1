//! What all Cortex-M boards share. Start-up is cortex-m-rt's.

use core::arch::asm;
use cortex_m_rt::{ExceptionFrame, exception};

/// Asks the host for a semihosting operation; returns its answer.
///
/// # Safety
/// `block` must be what the operation wants.
pub unsafe fn host_call(operation: usize, block: *const usize) -> usize {
    let answer;
    // SAFETY: a breakpoint that the host answers in r0; it may read and write memory that the block names.
    unsafe { asm!("bkpt 0xab", inout("r0") operation => answer, in("r1") block, options(nostack)) };
    answer
}

#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    super::print("hard fault\n");
    super::exit(3)
}

/// The most stack used since start-up, bytes: cortex-m-rt paints it before `main` and nothing else writes below it.
pub fn stack_used() -> usize {
    unsafe extern "C" {
        static _stack_start: u32;
        static _stack_end: u32;
    }
    const PAINT: u32 = 0xcccc_cccc;
    let (top, mut lowest) = (&raw const _stack_start, &raw const _stack_end);
    // SAFETY: all words between both symbols of the linker script are RAM; those in use are read, not interpreted.
    while lowest < top && unsafe { lowest.read_volatile() } == PAINT {
        lowest = lowest.wrapping_add(1);
    }
    top as usize - lowest as usize
}
