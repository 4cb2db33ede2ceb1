//! STM32F405 as QEMU's netduinoplus2 has it: no clocks or pins to set up.

/// A peripheral's register.
struct Register(*mut u32);

impl Register {
    const fn at(address: usize) -> Self {
        Register(address as *mut u32)
    }

    fn read(&self) -> u32 {
        // SAFETY: every register below is an aligned word of a peripheral that QEMU's board and the STM32F405 have.
        unsafe { self.0.read_volatile() }
    }

    fn write(&self, value: u32) {
        // SAFETY: as for reading; none of them makes the hardware touch the program's memory.
        unsafe { self.0.write_volatile(value) }
    }
}

/// USART1, the emulator's first serial port, byte by byte.
pub mod uart {
    use super::Register;
    use crate::port::Port;

    const STATUS: Register = Register::at(0x4001_1000);
    const DATA: Register = Register::at(0x4001_1004);
    const CONTROL: Register = Register::at(0x4001_100c);
    const RECEIVED: u32 = 1 << 5;
    const TRANSMIT_EMPTY: u32 = 1 << 7;
    const ENABLE: u32 = 1 << 13 | 1 << 5 | 1 << 3 | 1 << 2;

    /// USART1 is interrupt 37: bit 5 of the second word of these registers of the interrupt controller.
    const INTERRUPT_ENABLE: Register = Register::at(0xe000_e104);
    const INTERRUPT_CLEAR: Register = Register::at(0xe000_e284);
    const INTERRUPT: u32 = 1 << 5;

    /// USART1.
    pub struct Uart;

    impl Port for Uart {
        /// Switches sender and receiver on: say something first.
        fn start(&mut self) {
            // SAFETY: an interrupt only wakes the processor; with interrupts masked it is not served.
            unsafe { core::arch::asm!("cpsid i", options(nomem, nostack)) };
            INTERRUPT_ENABLE.write(INTERRUPT);
            CONTROL.write(ENABLE);
        }

        /// Waits asleep; there is always a next byte.
        fn read(&mut self) -> Option<u8> {
            loop {
                INTERRUPT_CLEAR.write(INTERRUPT);
                if STATUS.read() & RECEIVED != 0 {
                    return Some(DATA.read() as u8);
                }
                // SAFETY: it waits for an interrupt to be pending, that of a byte among them.
                unsafe { core::arch::asm!("wfi", options(nomem, nostack)) };
            }
        }

        fn write(&mut self, bytes: &[u8]) {
            for &byte in bytes {
                while STATUS.read() & TRANSMIT_EMPTY == 0 {}
                DATA.write(u32::from(byte));
            }
        }
    }
}

/// TIM2 as a free-running counter: one count an instruction under `-icount shift=0`.
pub mod counter {
    use super::Register;

    const CONTROL: Register = Register::at(0x4000_0000);
    const COUNT: Register = Register::at(0x4000_0024);
    const PRESCALER: Register = Register::at(0x4000_0028);
    const RELOAD: Register = Register::at(0x4000_002c);

    /// Lets it run from 0.
    pub fn start() {
        PRESCALER.write(0);
        RELOAD.write(u32::MAX);
        CONTROL.write(1);
    }

    /// Instructions since [`start`], modulo 2^32.
    pub fn read() -> u32 {
        COUNT.read()
    }
}
