//! Prints on the host what the image of this name prints on the chip.

use grn_core::scalar::Q8_24;
use grn_trials::digests;

fn main() {
    print!("{}{}", digests::<f32>().lines::<f32>(), digests::<Q8_24>().lines::<Q8_24>());
}
