//! Text files that carry the SHA-256 of their content in a last line, and of what they were made from: a file that was cut,
//! changed, or belongs elsewhere does not open.

const SEAL: &str = "# sha256 ";

/// The text with its seal; `origin` is what it was made from.
pub fn sealed(text: &str, origin: &str) -> String {
    format!("{text}{SEAL}{}\n", digest(text, origin))
}

/// The text without its seal, if that is right.
pub fn unsealed<'t>(sealed: &'t str, origin: &str) -> Option<&'t str> {
    let (text, seal) = sealed.rfind(SEAL).map(|at| sealed.split_at(at))?;
    (seal == format!("{SEAL}{}\n", digest(text, origin))).then_some(text)
}

fn digest(text: &str, origin: &str) -> String {
    sha256(format!("{}\n{text}", sha256(origin)))
}

/// The SHA-256 of some bytes, hexadecimal.
pub fn sha256(bytes: impl AsRef<[u8]>) -> String {
    use sha2::Digest;
    sha2::Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cut_and_every_flipped_bit_breaks_the_seal() {
        let whole = sealed("a,b\n1,2\n", "here");
        assert_eq!(unsealed(&whole, "here"), Some("a,b\n1,2\n"));
        assert_eq!(unsealed(&whole, "there"), None);
        for end in 0..whole.len() {
            assert_eq!(unsealed(&whole[..end], "here"), None, "cut at {end}");
        }
        for bit in 0..whole.len() * 8 {
            let mut bytes = whole.clone().into_bytes();
            bytes[bit / 8] ^= 1 << (bit % 8);
            let text = String::from_utf8_lossy(&bytes).into_owned();
            assert_eq!(unsealed(&text, "here"), None, "bit {bit}");
        }
    }
}
