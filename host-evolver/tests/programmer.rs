//! `grn flash --out`: files and commands for a robot's programmer.
#![allow(clippy::unwrap_used, reason = "what only tests call")]

mod robots;

use grn_core::robot::slots;
use robots::{Outcome, assert_answer, grn, model, text};
use std::collections::BTreeMap;
use std::io::{BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::Command;

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

#[test]
fn upload_numbers_leave_room_for_the_next_upload() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("files");
    let place = out.to_str().ok_or("not UTF-8")?;
    let flash = |number: &str| grn(&["flash", &model("nand-xnor"), "--out", place, "--sequence", number]);
    for number in ["4294967295", "4294967294", "4000000001", "4294967296", "-1", "1e3", ""] {
        assert_answer(&flash(number)?, 2, &["--sequence", "0 to 4000000000", "leave out --sequence"]);
    }
    assert!(!out.exists());
    for number in ["0", "4000000000"] {
        assert_answer(&flash(number)?, 0, &[&format!("upload number {number}")]);
        let bytes = std::fs::read(out.join("slot.bin"))?;
        assert_eq!(bytes[8..12], number.parse::<u32>()?.to_le_bytes());
    }
    Ok(())
}

/// Names of folders that a careless script takes apart.
const AWKWARD: [&str; 9] = [
    "fl ash",
    "it's mine",
    "\"quoted\"",
    "back\\slash \\",
    "line\nbreak '\" \\ %d",
    "100 % $HOME `id` #1",
    "tab\tand\rreturn",
    "größe 5 µm",
    "-x~ /~root",
];

#[test]
fn folders_that_gdb_cannot_be_told_are_refused() -> Outcome {
    let folder = tempfile::tempdir()?;
    for name in ["my ~", "my ~/files", "a\t~root"] {
        let out = folder.path().join(name);
        let place = out.to_str().ok_or("not UTF-8")?;
        assert_answer(&grn(&["flash", &model("nand-xnor"), "--out", place])?, 2, &[place, "home folder", "--out"]);
    }
    assert_eq!(std::fs::read_dir(folder.path())?.count(), 0);
    Ok(())
}

/// As much of GDB's remote protocol as `load` needs: the memory that was written to when GDB goes.
fn target(listener: &TcpListener) -> std::io::Result<BTreeMap<u32, u8>> {
    let mut memory = BTreeMap::new();
    let (mut stream, _) = listener.accept()?;
    let mut bytes = BufReader::new(stream.try_clone()?).bytes();
    while let Some(Ok(byte)) = bytes.next() {
        if byte != b'$' {
            continue;
        }
        let packet: Vec<u8> = bytes.by_ref().map_while(Result::ok).take_while(|&byte| byte != b'#').collect();
        let _checksum = (bytes.next(), bytes.next());
        stream.write_all(b"+")?;
        let hexadecimal = |text: &str| u32::from_str_radix(text, 16).unwrap();
        let answer = match packet[0] {
            b'q' if packet.starts_with(b"qSupported") => "PacketSize=1000".into(),
            b'?' => "S05".into(),
            b'g' | b'p' => "0".repeat(16),
            b'm' => "00".into(),
            b'M' => {
                let packet = text(&packet[1..]);
                let (place, data) = packet.split_once(':').unwrap();
                let first = hexadecimal(place.split_once(',').unwrap().0);
                for (at, byte) in (0..data.len() / 2).map(|at| (at, &data[2 * at..2 * at + 2])) {
                    memory.insert(first + at as u32, hexadecimal(byte) as u8);
                }
                "OK".into()
            }
            b'H' | b'G' | b'P' => "OK".into(),
            _ => String::new(),
        };
        send(&mut stream, &answer)?;
    }
    Ok(memory)
}

fn send(stream: &mut TcpStream, packet: &str) -> std::io::Result<()> {
    let checksum = packet.bytes().fold(0_u8, u8::wrapping_add);
    stream.write_all(format!("${packet}#{checksum:02x}").as_bytes())
}

/// The script is run by GDB itself, without what only a real programmer understands.
#[test]
fn gdb_loads_the_slot_from_folders_with_awkward_names() -> Outcome {
    if Command::new("gdb").arg("--version").output().is_err() {
        println!("no GDB here: only the grammar is tested, in src/quoting.rs");
        return Ok(());
    }
    let folder = tempfile::tempdir()?;
    for name in AWKWARD {
        let out = folder.path().join(name);
        let listener = TcpListener::bind("127.0.0.1:0")?;
        let address = listener.local_addr()?.to_string();
        let place = out.to_str().ok_or("not UTF-8")?;
        let flash = ["flash", &model("nand-xnor"), "--out", place, "--sequence", "9", "--programmer", &address];
        assert_answer(&grn(&flash)?, 0, &["written"]);
        let script = std::fs::read_to_string(out.join("flash.gdb"))?;
        let understood =
            |line: &&str| !["monitor", "attach", "compare", "kill"].iter().any(|word| line.starts_with(word));
        let script: Vec<&str> = script.lines().filter(understood).chain(["disconnect"]).collect();
        let path = folder.path().join("script.gdb");
        std::fs::write(&path, script.join("\n"))?;
        let target = std::thread::spawn(move || target(&listener));
        let gdb = Command::new("gdb").args(["--nx", "--batch", "--command"]).arg(&path).output()?;
        let said = text(&gdb.stdout) + &text(&gdb.stderr);
        // If GDB went away without a word the target would wait for ever.
        let _ = TcpStream::connect(&address);
        let memory = target.join().map_err(|_| "the target failed")??;
        assert!(memory.into_values().eq(std::fs::read(out.join("slot.bin"))?), "{name:?}: {said}");
    }
    Ok(())
}

/// The shell itself takes the printed commands apart.
#[cfg(unix)]
#[test]
fn printed_commands_survive_the_shell() -> Outcome {
    let folder = tempfile::tempdir()?;
    let tools = folder.path().join("tools");
    std::fs::create_dir(&tools)?;
    for tool in ["arm-none-eabi-gdb", "dfu-util"] {
        use std::os::unix::fs::PermissionsExt;
        let path = tools.join(tool);
        std::fs::write(&path, "#!/bin/sh\nfor last in \"$@\"; do :; done; cat \"$last\"\n")?;
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755))?;
    }
    let search = format!("{}:{}", tools.display(), std::env::var("PATH")?);
    for name in AWKWARD {
        let out = folder.path().join(name);
        let place = out.to_str().ok_or("not UTF-8")?;
        let told = grn(&["flash", &model("nand-xnor"), "--out", place, "--sequence", "9"])?;
        let told = text(&told.stdout);
        for (tool, file) in [("arm-none-eabi-gdb", "flash.gdb"), ("dfu-util", "slot.bin")] {
            let from = told.find(&format!("\n  {tool}")).ok_or("no command")?;
            let to = told[from..].find("\nover USB").map_or(told.len(), |length| from + length);
            let shell = Command::new("sh").args(["-c", &told[from..to]]).env("PATH", &search).output()?;
            assert_eq!(shell.stdout, std::fs::read(out.join(file))?, "{name:?}: {}", text(&shell.stderr));
        }
    }
    Ok(())
}
