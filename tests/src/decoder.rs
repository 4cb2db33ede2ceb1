//! One exercise of the blob decoder, for property tests and for the fuzz target.

use grn_core::blob::{Blob, FORMAT_VERSION, MAGIC, max_encoded_size};
use sha2::Digest;

/// Feeds the decoder with `data` as it is and as the payload of an otherwise perfect envelope. Returns whether
/// something was accepted.
///
/// # Panics
/// If an accepted blob does not encode to its own bytes: that is the bug looked for.
pub fn exercise(data: &[u8]) -> bool {
    let sealed = sealed(data);
    let accepted = [data, &sealed].map(|bytes| {
        let decoded = Blob::<32>::decode(bytes);
        if let Ok(blob) = &decoded {
            let mut buffer = [0; max_encoded_size(32)];
            assert_eq!(blob.encode(&mut buffer), Ok(bytes), "an accepted blob must encode to its own bytes");
        }
        // A smaller robot must refuse or agree, never panic.
        let small = Blob::<2>::decode(bytes).is_ok();
        assert!(!small || decoded.is_ok(), "a smaller robot accepts what a larger one refuses");
        decoded.is_ok()
    });
    accepted.contains(&true)
}

/// The envelope of `docs/blob.md` around any payload.
pub fn sealed(payload: &[u8]) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.push(FORMAT_VERSION);
    bytes.extend((payload.len() as u16).to_le_bytes());
    bytes.extend(&sha2::Sha256::digest(payload)[..8]);
    bytes.extend(payload);
    bytes.extend(crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&bytes).to_le_bytes());
    bytes
}
