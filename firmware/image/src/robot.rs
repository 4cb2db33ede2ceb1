//! The robot: its controller and slots, served over a port.

use crate::board::print;
use crate::board::slots::{SLOT, SlotMemory};
use crate::port::Port;
use grn_core::robot::link::Server;
use grn_core::robot::slots::Layout;
use grn_core::scalar::{NumberType, Scalar};

/// Serves the link while bytes come; false if the slots cannot be used.
pub fn serve<S: Scalar>(number_type: NumberType, slots: SlotMemory, port: &mut impl Port) -> bool {
    // Taken by reference: moved out of its `Result` it would be on the stack twice.
    let Ok(server) = &mut Server::<_, S>::start(slots, Layout::adjacent(SLOT), "netduinoplus2", number_type) else {
        print("the slots cannot be used\n");
        return false;
    };
    port.start();
    while let Some(byte) = port.read() {
        if let Some(answer) = server.receive(byte) {
            port.write(answer);
        }
    }
    true
}
