//! Numbers as text, without the standard formatting and its panics.

use crate::board::print;

/// Prints a number in decimal.
pub fn decimal(number: usize) {
    let rest = number / 10;
    if rest > 0 {
        decimal(rest);
    }
    print(char::from(b'0' + (number % 10) as u8).encode_utf8(&mut [0; 4]));
}
