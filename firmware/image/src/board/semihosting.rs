//! Arm's semihosting, which RISC-V shares: the program asks its emulator or debugger to act on the host.

#[cfg(target_arch = "arm")]
use super::cortex_m::host_call;
#[cfg(target_arch = "riscv32")]
use super::riscv::host_call;

const SYS_OPEN: usize = 0x01;
const SYS_WRITE: usize = 0x05;
const SYS_EXIT_EXTENDED: usize = 0x20;
const APPLICATION_EXIT: usize = 0x2_0026;
const MODE_WRITE: usize = 4;

/// Writes to the host's standard output.
pub fn print(text: &str) {
    // The file ":tt", opened for writing, is standard output; opened once more it is the same stream.
    let name = c":tt";
    let open = [name.as_ptr() as usize, MODE_WRITE, name.count_bytes()];
    // SAFETY: the block holds the address and the length of a string with its terminating zero.
    let stream = unsafe { host_call(SYS_OPEN, open.as_ptr()) };
    let write = [stream, text.as_ptr() as usize, text.len()];
    // SAFETY: the block holds the address and the length of initialised bytes, which the host only reads.
    unsafe { host_call(SYS_WRITE, write.as_ptr()) };
}

/// Ends the emulation; the emulator exits with `code`.
pub fn exit(code: u8) -> ! {
    let block = [APPLICATION_EXIT, usize::from(code)];
    loop {
        // SAFETY: the block is as SYS_EXIT_EXTENDED wants it.
        unsafe { host_call(SYS_EXIT_EXTENDED, block.as_ptr()) };
    }
}
