//! What RISC-V needs: start-up and semihosting.

use core::arch::{asm, global_asm};

// One hart starts here, in machine mode, with everything loaded where it belongs. A trap ends in `trap`.
global_asm!(
    ".section .text.start",
    ".globl _start",
    "_start:",
    "la sp, _stack_start",
    "la t0, 3f",
    "csrw mtvec, t0",
    "la t0, __sbss",
    "la t1, __ebss",
    "1: bgeu t0, t1, 2f",
    "sw zero, 0(t0)",
    "addi t0, t0, 4",
    "j 1b",
    "2: call main",
    ".balign 4",
    "3: call {trap}",
    trap = sym trap,
);

extern "C" fn trap() -> ! {
    super::print("trap\n");
    super::exit(3)
}

/// Asks the host for a semihosting operation; returns its answer.
///
/// # Safety
/// `block` must be what the operation wants.
pub unsafe fn host_call(operation: usize, block: *const usize) -> usize {
    let answer;
    // SAFETY: three instructions of four bytes each, which the host knows for a call and answers in a0; it may read
    // and write memory that the block names.
    unsafe {
        asm!(
            ".balign 16",
            ".option push",
            ".option norvc",
            "slli x0, x0, 0x1f",
            "ebreak",
            "srai x0, x0, 7",
            ".option pop",
            inout("a0") operation => answer,
            in("a1") block,
            options(nostack),
        );
    }
    answer
}
