//! What lies in `models/` and `docs/` is what the code makes and reads.

use grn_core::blob::Blob;
use grn_tests::golden::{repository, shipped_models};

#[test]
fn shipped_blobs_are_the_printed_models() -> Result<(), Box<dyn std::error::Error>> {
    for (path, bytes) in shipped_models()? {
        let found = std::fs::read(&path)?;
        assert_eq!(found, bytes, "{} is not what the code makes; cargo xtask bless", path.display());
        Blob::<32>::decode(&found)?;
    }
    Ok(())
}

#[test]
fn the_golden_bytes_in_the_format_page_are_the_shipped_blob() -> Result<(), Box<dyn std::error::Error>> {
    let page = std::fs::read_to_string(repository("docs/blob.md"))?;
    let (_, block) = page.split_once("```hex\n").ok_or("docs/blob.md has no hex block")?;
    let (block, _) = block.split_once("```").ok_or("the hex block does not end")?;
    let digits = block.lines().map(|line| line.split('#').next().unwrap_or_default());
    let bytes: Result<Vec<u8>, _> =
        digits.flat_map(str::split_whitespace).map(|byte| u8::from_str_radix(byte, 16)).collect();
    assert_eq!(bytes?, std::fs::read(repository("models/nand-xnor.grn"))?);
    Ok(())
}
