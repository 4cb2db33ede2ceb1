//! The committed header is the one that the sources give.

use grn_c::layout::{LAYOUTS, Layout};
use grn_c::{GrnAssembler, GrnController};
use std::env;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Types come in this order. Functions of other modules are found through lib.rs.
const SOURCES: [&str; 4] = ["status.rs", "storage.rs", "message.rs", "lib.rs"];
const END: &str = "#endif  /* GRN_H */\n";

/// The version of the header, from that of the crate.
fn version() -> String {
    let [major, minor, patch] =
        [env!("CARGO_PKG_VERSION_MAJOR"), env!("CARGO_PKG_VERSION_MINOR"), env!("CARGO_PKG_VERSION_PATCH")];
    format!(
        "\n// The version of this header; grn_version says that of the library. Before 1.0.0 minor versions are not compatible\n\
         // with each other.\n\
         #define GRN_VERSION_MAJOR {major}\n\
         #define GRN_VERSION_MINOR {minor}\n\
         #define GRN_VERSION_PATCH {patch}\n\
         #define GRN_VERSION_STRING \"{}\"\n",
        env!("CARGO_PKG_VERSION")
    )
}

/// Assertions that a C or C++ compiler lays structures out as the library does.
fn assertions() -> String {
    let mut text = String::from(
        "// The compiler lays out all structures as the library does. Checked from C11 and C++11 on.\n\
         #if defined(__cplusplus) && __cplusplus >= 201103L\n\
         #define GRN_ASSERT_LAYOUT(condition) static_assert(condition, \"grn.h does not fit this compiler or its options\")\n\
         #elif !defined(__cplusplus) && defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L\n\
         #define GRN_ASSERT_LAYOUT(condition) _Static_assert(condition, \"grn.h does not fit this compiler or its options\")\n\
         #endif\n\
         #ifdef GRN_ASSERT_LAYOUT\n",
    );
    let mut assert = |condition: &str| writeln!(text, "GRN_ASSERT_LAYOUT({condition});").expect("a string takes text");
    assert(&format!("sizeof(GrnController) == {}", size_of::<GrnController>()));
    assert(&format!("sizeof(GrnAssembler) == {}", size_of::<GrnAssembler>()));
    assert("sizeof(GrnStatus) == 4 && sizeof(GrnNumber) == 4");
    for Layout { name, size, fields } in LAYOUTS {
        assert(&format!("sizeof({name}) == {size}"));
        for (field, offset) in *fields {
            assert(&format!("offsetof({name}, {field}) == {offset}"));
        }
    }
    text + "#undef GRN_ASSERT_LAYOUT\n#endif\n"
}

#[test]
fn the_header_is_up_to_date() {
    let home = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut config = cbindgen::Config::from_file(home.join("cbindgen.toml")).expect("cbindgen.toml");
    let percept = config.trailer.take().expect("the empty percept");
    config.after_includes = Some(version());
    let sources = SOURCES.map(|name| home.join("src").join(name));
    let builder =
        sources.iter().fold(cbindgen::Builder::new().with_config(config), |builder, source| builder.with_src(source));
    let mut made = Vec::new();
    builder.generate().expect("sources that cbindgen understands").write(&mut made);
    let made = String::from_utf8(made).expect("a header in UTF-8");
    let body = made.strip_suffix(END).expect("a header that ends with its guard");
    let made = format!("{body}{percept}\n{}\n{END}", assertions());
    let path = home.join("include/grn.h");
    if env::var_os("GRN_BLESS").is_some() {
        fs::write(&path, &made).expect("a header that can be written");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(made == committed, "include/grn.h is stale: write it anew with `cargo xtask c --bless`");
}
