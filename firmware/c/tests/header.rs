//! The committed header is the one that the sources give.

use std::env;
use std::fs;
use std::path::Path;

#[test]
fn the_header_is_up_to_date() {
    let home = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(home.join("cbindgen.toml")).expect("cbindgen.toml");
    let sources = ["status.rs", "storage.rs", "message.rs", "lib.rs"].map(|name| home.join("src").join(name));
    let builder =
        sources.iter().fold(cbindgen::Builder::new().with_config(config), |builder, source| builder.with_src(source));
    let mut made = Vec::new();
    builder.generate().expect("sources that cbindgen understands").write(&mut made);
    let made = String::from_utf8(made).expect("a header in UTF-8");
    let path = home.join("include/grn.h");
    if env::var_os("GRN_BLESS").is_some() {
        fs::write(&path, &made).expect("a header that can be written");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(made == committed, "include/grn.h is stale: write it anew with `cargo xtask c --bless`");
}
