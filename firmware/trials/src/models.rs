//! The printed models, as they ship in `models/`.

use grn_core::blob::Blob;

/// How many models the paper prints.
pub const PRINTED: usize = 5;

/// The first printed model: two genes.
pub const NAND_XNOR: &[u8] = include_bytes!("../../../models/nand-xnor.grn");
/// Three genes.
pub const ANDN_NAND_XNOR: &[u8] = include_bytes!("../../../models/andn-nand-xnor.grn");
/// Two genes.
pub const ANDN_XNOR: &[u8] = include_bytes!("../../../models/andn-xnor.grn");
/// The structure of EH-GRN, thirteen genes.
pub const EH_GRN_1: &[u8] = include_bytes!("../../../models/eh-grn-1.grn");
/// The same structure with other thresholds.
pub const EH_GRN_2: &[u8] = include_bytes!("../../../models/eh-grn-2.grn");

const ALL: [&[u8]; PRINTED] = [NAND_XNOR, ANDN_NAND_XNOR, ANDN_XNOR, EH_GRN_1, EH_GRN_2];

/// Printed model number `number`, counted from 0, or `None` beyond the last one; `Some(None)` if its blob is not valid.
pub fn printed(number: usize) -> Option<Option<Blob>> {
    ALL.get(number).map(|bytes| Blob::decode(bytes).ok())
}
