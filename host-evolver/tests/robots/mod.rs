//! What the tests of `grn flash`, `robots`, `confirm` and `rollback` share.
#![allow(dead_code, reason = "each test file uses some of it")]

use firmware_sim::flash::{SECTOR, SimulatedFlash};
use grn_core::robot::link::Server;
use grn_core::robot::slots::Layout;
use grn_core::scalar::NumberType;
use std::io::{Read, Write};
use std::net::TcpListener;
use std::process::{Command, Output};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

pub type Outcome = Result<(), Box<dyn std::error::Error>>;

pub fn grn(arguments: &[&str]) -> std::io::Result<Output> {
    Command::new(env!("CARGO_BIN_EXE_grn")).args(arguments).output()
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

pub fn model(name: &str) -> String {
    format!("{}/../models/{name}.grn", env!("CARGO_MANIFEST_DIR"))
}

/// A sound blob that no robot can drive with: its model does not tell targets from empty space.
pub fn unfit() -> String {
    format!("{}/tests/data/no-pattern.grn", env!("CARGO_MANIFEST_DIR"))
}

pub fn assert_answer(output: &Output, code: i32, words: &[&str]) {
    let said = text(&output.stdout) + &text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{said}");
    for word in words {
        assert!(said.contains(word), "{word:?} is not in {said:?}");
    }
}

/// A simulated robot at a TCP port; it serves one connection after the other until the tests end.
pub struct Robot {
    /// The port.
    pub port: String,
    /// How many requests it will still answer; then it falls silent.
    pub answers: Arc<AtomicUsize>,
}

impl Robot {
    /// It waits for its first blob.
    pub fn empty() -> std::io::Result<Robot> {
        let listener = TcpListener::bind("127.0.0.1:0")?;
        let port = format!("tcp:{}", listener.local_addr()?);
        let answers = Arc::new(AtomicUsize::new(usize::MAX));
        let left = Arc::clone(&answers);
        std::thread::spawn(move || {
            let (flash, layout) = (SimulatedFlash::erased(2, 0), Layout::adjacent(SECTOR as u32));
            let mut server = Server::<_, f32>::start(flash, layout, "robot 7", NumberType::F32).unwrap();
            for mut stream in listener.incoming().flatten() {
                let mut buffer = [0; 256];
                while let Ok(count @ 1..) = stream.read(&mut buffer) {
                    for &byte in &buffer[..count] {
                        let Some(answer) = server.receive(byte) else { continue };
                        let speaks = left.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |left| left.checked_sub(1));
                        if speaks.is_ok() {
                            let _ = stream.write_all(answer);
                        }
                    }
                }
            }
        });
        Ok(Robot { port, answers })
    }
}
