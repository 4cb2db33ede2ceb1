//! The robot: its controller and slots, served over the first serial port.

use crate::board::slots::{SLOT, SlotMemory};
use crate::board::{print, uart};
use grn_core::robot::link::Server;
use grn_core::robot::link::message::Arithmetic;
use grn_core::robot::slots::Layout;
use grn_core::scalar::Scalar;

/// Serves the link for ever; an exit code if the slots cannot be used.
pub fn serve<S: Scalar>(arithmetic: Arithmetic, slots: SlotMemory) -> u8 {
    let Ok(mut server) = Server::<_, S>::start(slots, Layout::adjacent(SLOT), "netduinoplus2", arithmetic) else {
        print("the slots cannot be used\n");
        return 1;
    };
    uart::start();
    loop {
        if let Some(answer) = server.receive(uart::read()) {
            uart::write(answer);
        }
    }
}
