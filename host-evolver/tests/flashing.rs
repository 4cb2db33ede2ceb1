//! `grn flash` and `grn robots` as engineers use them: robots behind sockets, files for programmers, blobs that no robot takes.
#![allow(clippy::unwrap_used, reason = "what only tests call")]

use firmware_sim::flash::{SECTOR, SimulatedFlash};
use grn_core::blob::Blob;
use grn_core::network::{DEFAULT_GENES, Network};
use grn_core::robot::link::Server;
use grn_core::robot::slots::{self, Layout};
use grn_core::scalar::NumberType;
use std::io::{Read, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn grn(arguments: &[&str]) -> std::io::Result<Output> {
    Command::new(env!("CARGO_BIN_EXE_grn")).args(arguments).output()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn model(name: &str) -> String {
    format!("{}/../models/{name}.grn", env!("CARGO_MANIFEST_DIR"))
}

/// A simulated robot at a TCP port; it serves one connection after the other until the tests end.
fn robot() -> std::io::Result<String> {
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let port = format!("tcp:{}", listener.local_addr()?);
    std::thread::spawn(move || {
        let (flash, layout) = (SimulatedFlash::erased(2, 0), Layout::adjacent(SECTOR as u32));
        let mut server = Server::<_, f32>::start(flash, layout, "robot 7", NumberType::F32).unwrap();
        for mut stream in listener.incoming().flatten() {
            let mut buffer = [0; 256];
            while let Ok(count @ 1..) = stream.read(&mut buffer) {
                for &byte in &buffer[..count] {
                    if let Some(answer) = server.receive(byte) {
                        let _ = stream.write_all(answer);
                    }
                }
            }
        }
    });
    Ok(port)
}

fn assert_answer(output: &Output, code: i32, words: &[&str]) {
    let said = text(&output.stdout) + &text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{said}");
    for word in words {
        assert!(said.contains(word), "{word:?} is not in {said:?}");
    }
}

#[test]
fn a_robot_is_listed_flashed_and_tried() -> Outcome {
    let port = robot()?;
    let (old, new) = (model("nand-xnor"), model("andn-nand-xnor"));
    assert_answer(&grn(&["robots", &port])?, 0, &["robot 7", "F32", "slot 0: empty", "slot 1: empty"]);
    assert_answer(&grn(&["flash", &old, "--to", &port, "--dry-run"])?, 0, &["nothing is sent", "chunk at 64"]);
    assert_answer(&grn(&["robots", &port])?, 0, &["slot 0: empty"]);
    assert_answer(&grn(&["flash", &old, "--to", &port])?, 0, &["robot 7 is in charge"]);
    assert_answer(&grn(&["flash", &old, "--to", &port])?, 0, &["was in charge already"]);
    assert_answer(&grn(&["flash", &new, "--to", &port, "--trial"])?, 0, &["on trial"]);
    assert_answer(&grn(&["robots", &port])?, 0, &["slot 0:", "confirmed\n", "on trial, in charge for 0 ticks"]);
    assert_answer(&grn(&["flash", &old, "--to", &port])?, 2, &[&port, "confirm it or roll it back"]);
    assert_answer(&grn(&["flash", &new, "--to", &port])?, 0, &["was in charge already"]);
    assert_answer(&grn(&["robots", &port])?, 0, &["confirmed, in charge"]);
    Ok(())
}

#[test]
fn where_nobody_answers_the_port_is_named() -> Outcome {
    let closed = TcpListener::bind("127.0.0.1:0")?.local_addr()?.to_string();
    let port = format!("tcp:{closed}");
    assert_answer(&grn(&["flash", &model("nand-xnor"), "--to", &port])?, 2, &[&port, "refused"]);
    assert_answer(&grn(&["robots", &port, "/dev/no-such-port"])?, 1, &[&port, "/dev/no-such-port: No such file"]);
    assert_answer(&grn(&["flash", &model("nand-xnor")])?, 2, &["--to", "--out"]);
    Ok(())
}

#[test]
fn files_for_a_programmer_hold_the_slot() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("files");
    let place = out.to_str().ok_or("not UTF-8")?;
    let blob = model("nand-xnor");
    let flash = |more: &[&str]| grn(&[&["flash", &blob, "--out", place, "--sequence", "9"], more].concat());
    let lines =
        ["0x08080000 to 0x0808", "upload number 9", "arm-none-eabi-gdb", "dfu-util -d 0483:df11 -a 0 -s 0x08080000"];
    assert_answer(&flash(&["--dry-run"])?, 0, &lines);
    assert!(!out.exists());
    assert_answer(&flash(&[])?, 0, &lines);
    let image = slots::image(&std::fs::read(&blob)?, 9)?;
    assert_eq!(std::fs::read(out.join("slot.bin"))?, image.as_slice());
    let hex = std::fs::read_to_string(out.join("slot.hex"))?;
    assert!(hex.starts_with(":020000040808EA\n:10000000"), "{hex}");
    assert!(std::fs::read_to_string(out.join("flash.gdb"))?.contains("slot.hex"));
    for slot in ["0x080A0000", "0x08008000", "0x0800C000"] {
        assert_answer(&flash(&["--address", slot, "--dry-run"])?, 0, &[&format!("{} to", slot.to_lowercase())]);
    }
    Ok(())
}

#[test]
fn addresses_that_wrap_or_begin_no_sector_are_refused() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("files");
    let place = out.to_str().ok_or("not UTF-8")?;
    let cases = [
        ("0x3", "0x08000000 to 0x080FFFFF"),
        ("0xFFFFFFF8", "0x08000000 to 0x080FFFFF"),
        ("0x08100000", "0x08000000 to 0x080FFFFF"),
        ("0x20000000", "0x08000000 to 0x080FFFFF"),
        ("0x100000000", "no address of 32 bits"),
        ("0x080BFFF8", "inside sector 9, which begins at 0x080A0000"),
        ("0x08080004", "inside sector 8, which begins at 0x08080000"),
    ];
    for (address, words) in cases {
        for force in [&[][..], &["--force"]] {
            let common = ["flash", &model("nand-xnor"), "--out", place, "--address", address];
            let refused = grn(&[&common[..], force].concat())?;
            assert_answer(&refused, 2, &["--address", address, words, "give 0x08080000"]);
        }
    }
    assert!(!out.exists());
    Ok(())
}

#[test]
fn sectors_that_the_stock_firmware_uses_need_force_and_a_warning() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("files");
    let place = out.to_str().ok_or("not UTF-8")?;
    let cases = [
        ("0x080C0000", "sector 10", "crashes at every start until this sector is erased"),
        ("0x080E0000", "sector 11", "parameters"),
        ("0x08000000", "sector 0", "program"),
        ("0x08040000", "sector 6", "program"),
    ];
    for (address, sector, why) in cases {
        let common = ["flash", &model("nand-xnor"), "--out", place, "--sequence", "9", "--address", address];
        for more in [&[][..], &["--dry-run"]] {
            let refused = grn(&[&common[..], more].concat())?;
            assert_answer(&refused, 2, &[address, sector, why, "--force", "0x08080000"]);
        }
        assert!(!out.exists());
        let rehearsed = grn(&[&common[..], &["--force", "--dry-run"]].concat())?;
        assert_answer(&rehearsed, 0, &[&format!("{} to", address.to_lowercase())]);
        let warning = text(&rehearsed.stderr);
        assert!(warning.contains("warning") && warning.contains(why), "{warning}");
    }
    Ok(())
}

/// Writes a blob that no robot takes.
fn spoilt(folder: &Path, name: &str, change: impl FnOnce(&mut Vec<u8>)) -> std::io::Result<PathBuf> {
    let mut bytes = std::fs::read(model("nand-xnor"))?;
    change(&mut bytes);
    let path = folder.join(name);
    std::fs::write(&path, bytes)?;
    Ok(path)
}

fn of_forty_genes(bytes: &mut Vec<u8>) {
    let blob = Blob::<64>::decode(bytes).unwrap();
    let genes = blob.network.genes();
    let many = genes.iter().take(1).cycle().take(39).chain(&genes[1..2]).cloned();
    let network = Network::new(blob.network.steepness(), many).unwrap();
    let mut buffer = [0; 1024];
    *bytes = Blob { network, ..blob }.encode(&mut buffer).unwrap().to_vec();
}

#[test]
fn what_no_robot_takes_is_refused_with_a_way_out() -> Outcome {
    let folder = tempfile::tempdir()?;
    let port = robot()?;
    let capacity = DEFAULT_GENES.to_string();
    let cases = [
        (
            spoilt(folder.path(), "old.grn", |bytes| bytes[4] -= 1)?,
            vec!["old.grn", "version 0", "write the blob again"],
        ),
        (spoilt(folder.path(), "future.grn", |bytes| bytes[4] += 1)?, vec!["future.grn", "version 2", "update"]),
        (spoilt(folder.path(), "short.grn", |bytes| bytes.truncate(50))?, vec!["short.grn", "copy or upload it again"]),
        (
            spoilt(folder.path(), "large.grn", of_forty_genes)?,
            vec!["large.grn", "40 genes", &capacity, "evolve a smaller one"],
        ),
        (folder.path().join("missing.grn"), vec!["missing.grn", "cannot be read"]),
    ];
    for (path, words) in cases {
        let path = path.to_str().ok_or("not UTF-8")?;
        assert_answer(&grn(&["flash", path, "--to", &port])?, 2, &words);
        assert_answer(&grn(&["flash", path, "--to", &port, "--dry-run"])?, 2, &words);
        assert_answer(&grn(&["show", path])?, 2, &words);
    }
    assert_answer(&grn(&["robots", &port])?, 0, &["slot 0: empty"]);
    Ok(())
}
