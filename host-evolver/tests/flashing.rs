//! `grn flash` and `grn robots` as engineers use them: robots behind sockets, files for programmers, blobs that no robot takes.
#![allow(clippy::unwrap_used, reason = "what only tests call")]

mod robots;

use grn_core::blob::Blob;
use grn_core::network::{DEFAULT_GENES, Gene, Network, STEEPNESS_RANGE};
use grn_core::robot::Controller;
use grn_core::robot::link::frame::Receiver;
use grn_core::robot::link::message::{About, Identify, RESPONSE, Request, VERSION, encode_message};
use grn_core::scalar::{NumberType, Q8_24, Scalar};
use robots::{Outcome, Robot, assert_answer, grn, model, text, unfit};
use std::io::{Read, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

#[test]
fn a_robot_is_listed_flashed_and_tried() -> Outcome {
    let Robot { port, .. } = Robot::empty()?;
    let (old, new) = (model("nand-xnor"), model("andn-nand-xnor"));
    assert_answer(&grn(&["robots", &port])?, 0, &["robot 7", "f32", "slot 0: empty", "slot 1: empty"]);
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
    let listed = grn(&["robots", &port, "/dev/no-such-port"])?;
    assert_answer(
        &listed,
        1,
        &[&port, "nothing listens there", "/dev/no-such-port: the port cannot be opened: No such"],
    );
    assert_answer(&grn(&["flash", &model("nand-xnor")])?, 2, &["--to", "--out"]);
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
    let Robot { port, .. } = Robot::empty()?;
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

#[test]
fn a_blob_that_cannot_drive_a_robot_is_refused_before_anything_is_erased() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("files");
    let place = out.to_str().ok_or("not UTF-8")?;
    let (Robot { port, .. }, unfit) = (Robot::empty()?, unfit());
    let words = ["no-pattern.grn", "does not tell targets from empty space", "choose another front member"];
    for more in [&["--out", place][..], &["--out", place, "--dry-run"], &["--to", &port, "--dry-run"]] {
        for number in [&[][..], &["--number", "f32"], &["--number", "q8.24"]] {
            assert_answer(&grn(&[&["flash", &unfit], more, number].concat())?, 2, &words);
        }
    }
    assert!(!out.exists());
    assert_answer(&grn(&["flash", &unfit, "--to", &port])?, 2, &[&port, "does not tell targets from empty space"]);
    assert_answer(&grn(&["flash", &model("nand-xnor"), "--to", &port, "--number", "q8.24"])?, 2, &["computes in f32"]);
    assert_answer(&grn(&["robots", &port])?, 0, &["slot 0: empty", "slot 1: empty"]);
    Ok(())
}

#[test]
fn a_blob_for_one_number_type_only_is_flashed_when_that_is_said() -> Outcome {
    let folder = tempfile::tempdir()?;
    let [mut fit, mut unfit] = ["", ""];
    let small = spoilt(folder.path(), "small.grn", |bytes| {
        let blob = at_the_smallest_contrast(Blob::decode(bytes).unwrap());
        [fit, unfit] = if drives::<f32>(&blob) { ["f32", "q8.24"] } else { ["q8.24", "f32"] };
        *bytes = blob.encode(&mut [0; 1024]).unwrap().to_vec();
    })?;
    let (small, out) = (small.to_str().ok_or("not UTF-8")?, folder.path().join("files"));
    let flash = ["flash", small, "--out", out.to_str().ok_or("not UTF-8")?];
    let computes = format!("computes in {unfit}: the model does not tell targets from empty space");
    assert_answer(&grn(&flash)?, 2, &["small.grn", &computes, &format!("add --number {fit}")]);
    assert_answer(&grn(&[&flash[..], &["--number", unfit]].concat())?, 2, &[&computes]);
    assert!(!out.exists());
    assert_answer(&grn(&[&flash[..], &["--number", fit]].concat())?, 0, &["written"]);
    Ok(())
}

fn drives<S: Scalar>(blob: &Blob) -> bool {
    Controller::<S>::new(blob, 0).is_ok()
}

/// The blob with so weak a model that only one number type has a pattern of it.
fn at_the_smallest_contrast(blob: Blob) -> Blob {
    // Thresholds that no morphogen reaches: the steeper the sigmoid, the weaker the model.
    let genes = blob.network.genes().iter().map(|gene| Gene { theta: 2.0, ..gene.clone() });
    let weaker = |steepness| Blob { network: Network::new(steepness, genes.clone()).unwrap(), ..blob.clone() };
    let [mut fit, mut unfit] = [1.0, STEEPNESS_RANGE.1];
    assert!(drives::<f32>(&weaker(fit)) && !drives::<f32>(&weaker(unfit)));
    for _ in 0..30 {
        let middle = (fit + unfit) / 2.0;
        *(if drives::<f32>(&weaker(middle)) { &mut fit } else { &mut unfit }) = middle;
    }
    // Rounding makes the edge of each number type ragged.
    let near = (-5000..5000).map(|step| weaker(fit * (1.0 + step as f32 * 1e-6)));
    let one_only = near.into_iter().find(|blob| drives::<f32>(blob) != drives::<Q8_24>(blob));
    one_only.expect("both number types have the same patterns")
}

/// A robot that says this of itself and answers nothing else; the operations that it is asked for.
fn robot_of(about: About) -> std::io::Result<(String, std::sync::mpsc::Receiver<u8>)> {
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let port = format!("tcp:{}", listener.local_addr()?);
    let (asked, operations) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        for mut stream in listener.incoming().flatten() {
            let (mut receiver, mut byte) = (Receiver::new(), [0]);
            while let Ok(1) = stream.read(&mut byte) {
                let Some(frame) = receiver.receive(byte[0]) else { continue };
                let _ = asked.send(frame.operation);
                if frame.operation == Identify::OPERATION {
                    let header = [VERSION, frame.sequence, Identify::OPERATION | RESPONSE];
                    let _ = stream.write_all(&encode_message(header, &about).unwrap());
                }
            }
        }
    });
    Ok((port, operations))
}

#[test]
fn what_a_robot_cannot_hold_is_refused_before_it_is_asked_to_erase() -> Outcome {
    let usual = || About {
        protocol: VERSION,
        blob_format: 1,
        genes: 32,
        blob_bytes: 400,
        number_type: NumberType::Q8_24,
        name: "little".try_into().unwrap_or_default(),
    };
    let cases = [
        (About { genes: 1, ..usual() }, ["2 genes", "the robot holds 1", "smaller front member"]),
        (About { blob_bytes: 50, ..usual() }, ["bytes", "in 50", "smaller front member"]),
        (About { blob_format: 2, ..usual() }, ["blob format 2", "this is 1", "update the firmware"]),
        (About { blob_format: 0, ..usual() }, ["blob format 0", "this is 1", "update the firmware"]),
    ];
    for (about, words) in cases {
        let (port, operations) = robot_of(about)?;
        assert_answer(&grn(&["flash", &model("nand-xnor"), "--to", &port])?, 2, &words);
        assert_eq!(operations.try_iter().collect::<Vec<_>>(), [Identify::OPERATION]);
    }
    Ok(())
}

#[test]
fn a_trial_is_confirmed_or_rolled_back_by_commands() -> Outcome {
    let Robot { port, .. } = Robot::empty()?;
    let (old, new) = (model("nand-xnor"), model("andn-nand-xnor"));
    let way_out = format!("grn flash BLOB --to {port}");
    for command in ["confirm", "rollback"] {
        assert_answer(&grn(&[command, &port])?, 2, &[&port, "no blob is in charge", &way_out]);
        assert_answer(&grn(&[command])?, 2, &["PORT"]);
    }
    assert_answer(&grn(&["flash", &old, "--to", &port, "--trial"])?, 0, &["grn confirm", "grn rollback"]);
    assert_answer(&grn(&["rollback", &port])?, 2, &["no other blob to fall back to", &way_out]);
    assert_answer(&grn(&["confirm", &port])?, 0, &[&port, "is confirmed", "slot 0:", "confirmed, in charge"]);
    assert_answer(&grn(&["confirm", &port])?, 0, &["was confirmed already"]);
    assert_answer(&grn(&["flash", &new, "--to", &port, "--trial"])?, 0, &["on trial"]);
    let refused = grn(&["flash", &old, "--to", &port])?;
    assert_answer(&refused, 2, &["on trial", &format!("grn confirm {port}"), &format!("grn rollback {port}")]);
    assert_answer(
        &grn(&["rollback", &port])?,
        0,
        &["is rolled back", "confirmed, in charge", "slot 1:", "rolled back\n"],
    );
    assert_answer(&grn(&["rollback", &port])?, 2, &["no other blob to fall back to"]);
    let both = grn(&["confirm", "/dev/no-such-port", &port])?;
    assert_answer(&both, 2, &["/dev/no-such-port: the port cannot be opened", "was confirmed already"]);
    Ok(())
}

/// Listens and never answers: programs that wait at a port, and firmware of somebody else.
fn silent() -> std::io::Result<(TcpListener, String)> {
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let port = format!("tcp:{}", listener.local_addr()?);
    Ok((listener, port))
}

#[cfg(unix)]
#[test]
fn ports_without_a_robot_do_not_hold_the_list_up() -> Outcome {
    let silent: Vec<_> = (0..40).map(|_| silent()).collect::<Result<_, _>>()?;
    // This one takes no connections any more, like a host that is switched off.
    let (full, _) = &silent[0];
    rustix::net::listen(full, 0)?;
    let address = full.local_addr()?;
    let queue = || std::net::TcpStream::connect_timeout(&address, Duration::from_millis(100)).ok();
    let _queue: Vec<_> = std::iter::from_fn(queue).take(9).collect();
    let robot = Robot::empty()?;
    let ports: Vec<&str> = silent.iter().map(|(_, port)| port.as_str()).chain([robot.port.as_str()]).collect();
    let begun = Instant::now();
    let listed = grn(&[&["robots"], &ports[..]].concat())?;
    let elapsed = begun.elapsed();
    assert_answer(&listed, 0, &["no connection within 3 s", "does not answer", "robot 7"]);
    let order: Vec<_> = ports.iter().map(|port| text(&listed.stdout).find(port)).collect();
    assert!(order.iter().all(Option::is_some) && order.is_sorted(), "told in another order: {order:?}");
    // One after the other they would take 40 times 0.6 s.
    assert!(elapsed < Duration::from_secs(15), "{elapsed:?}");
    let begun = Instant::now();
    assert_answer(
        &grn(&["flash", &model("nand-xnor"), "--to", ports[0]])?,
        2,
        &["no connection within 5 s", "is the robot on"],
    );
    assert!(begun.elapsed() < Duration::from_secs(15), "{:?}", begun.elapsed());
    Ok(())
}

#[cfg(unix)]
#[test]
fn what_is_no_port_is_told_with_a_way_out() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_str().unwrap_or_default().to_string();
    std::fs::write(path("file"), "x")?;
    let _socket = std::os::unix::net::UnixListener::bind(path("socket"))?;
    let cases = [
        (path("."), ["this is a directory", "`grn robots` without a port lists them"]),
        (path("file"), ["this is a file", "give a serial port"]),
        (path("socket"), ["this is a socket", "unix:PATH"]),
        ("/dev/null".into(), ["this device is no serial port", "give a serial port"]),
        (path("missing"), ["No such file", "is it plugged in?"]),
        ("localhost:7000".into(), ["No such file", "tcp:HOST:PORT"]),
        (format!("unix:{}", path("file")), ["this is a file", "give the path of a socket"]),
        (format!("unix:{}", path("missing")), ["No such file", "check the path"]),
        ("tcp:no-such-host.invalid:7000".into(), ["tcp:no-such-host.invalid:7000: no ", "address"]),
    ];
    for (port, words) in cases {
        assert_answer(&grn(&["robots", &port])?, 1, &words);
        assert_answer(&grn(&["flash", &model("nand-xnor"), "--to", &port])?, 2, &words);
        assert_answer(&grn(&["confirm", &port])?, 2, &words);
    }
    let cases = [
        ("tcp:robot:70000", "1 to 65535"),
        ("tcp:robot:0", "1 to 65535"),
        ("tcp:robot", "the port number is missing"),
        ("tcp::7000", "the host is missing"),
        ("tcp:a:b:7000", "in brackets"),
        ("unix:", "the path is missing"),
        ("", "give a serial port, tcp:HOST:PORT or unix:PATH"),
    ];
    assert_answer(&grn(&["robots", "--baud", "0", "/dev/null"])?, 2, &["--baud", "from 1 to"]);
    for (port, words) in cases {
        assert_answer(&grn(&["robots", port])?, 2, &[words]);
        assert_answer(&grn(&["flash", &model("nand-xnor"), "--to", port])?, 2, &[words]);
    }
    Ok(())
}

#[cfg(unix)]
#[test]
fn an_interrupted_upload_leaves_the_old_blob_in_charge_and_says_so() -> Outcome {
    let robot = Robot::empty()?;
    let port = robot.port.as_str();
    assert_answer(&grn(&["flash", &model("nand-xnor"), "--to", port])?, 0, &["is in charge"]);
    // Identify, status, begin and one chunk; then the robot falls silent.
    robot.answers.store(4, Ordering::SeqCst);
    let mut upload = Command::new(env!("CARGO_BIN_EXE_grn"));
    upload.args(["flash", &model("andn-nand-xnor"), "--to", port]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let upload = upload.spawn()?;
    let begun = Instant::now();
    while robot.answers.load(Ordering::SeqCst) > 0 {
        assert!(begun.elapsed() < Duration::from_secs(20), "the upload does not get so far");
        std::thread::sleep(Duration::from_millis(10));
    }
    let pressed = Instant::now();
    Command::new("kill").args(["-INT", &upload.id().to_string()]).status()?;
    let upload = upload.wait_with_output()?;
    assert!(pressed.elapsed() < Duration::from_secs(2), "{:?}", pressed.elapsed());
    assert_answer(&upload, 130, &["interrupted", port, "keeps the blob that was in charge", "can be repeated"]);
    robot.answers.store(usize::MAX, Ordering::SeqCst);
    assert_answer(&grn(&["robots", port])?, 0, &["confirmed, in charge", "upload not finished"]);
    assert_answer(&grn(&["flash", &model("andn-nand-xnor"), "--to", port])?, 0, &["is in charge"]);
    Ok(())
}
