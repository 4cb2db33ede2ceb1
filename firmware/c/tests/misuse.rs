//! Whatever can be checked is refused with a status whose text says what to do, and nothing happens.
#![allow(clippy::unwrap_used)]

use grn_c::*;
use grn_core::blob::{Blob, MAGIC, max_encoded_size};
use grn_core::field::Kernel;
use grn_core::motif::Motif;
use grn_core::network::{Gene, Network, Source};
use sha2::Digest;
use std::ffi::{CStr, c_char};
use std::path::Path;
use std::ptr::{null, null_mut};
use std::{fs, slice};

const SIZE: usize = size_of::<GrnController>();
const F32: i32 = GrnNumber::F32 as i32;

fn model() -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/nand-xnor.grn")).unwrap()
}

fn load(storage: &mut GrnController, blob: &[u8]) -> GrnStatus {
    unsafe { grn_load(storage, SIZE, blob.as_ptr(), blob.len(), F32, 1) }
}

fn loaded() -> GrnController {
    let mut storage = GrnController::default();
    assert_eq!(load(&mut storage, &model()), GrnStatus::Ok);
    storage
}

fn text(pointer: *const c_char) -> &'static str {
    unsafe { CStr::from_ptr(pointer) }.to_str().unwrap()
}

fn tick(storage: &mut GrnController, percept: &GrnPercept) -> GrnCommand {
    let mut command = GrnCommand::default();
    assert_eq!(unsafe { grn_tick(storage, percept, &mut command) }, GrnStatus::Ok);
    command
}

/// A command nobody would mistake for that of a robot at rest.
fn wild() -> GrnCommand {
    let broadcast = GrnMessage { sender: 7, ..GrnMessage::default() };
    GrnCommand { left: 77, right: -77, has_broadcast: 1, reserved: 0, broadcast }
}

#[test]
fn null_pointers_are_refused() {
    let (blob, mut storage) = (model(), loaded());
    let (percept, mut command) = (GrnPercept::nothing(), GrnCommand::default());
    let refused = unsafe {
        [
            grn_load(null_mut(), SIZE, blob.as_ptr(), blob.len(), F32, 1),
            grn_check(null(), blob.len(), F32),
            grn_check(null(), 0, F32),
            grn_tick(null_mut(), &percept, &mut command),
            grn_tick(&mut storage, null(), &mut command),
            grn_tick(&mut storage, &percept, null_mut()),
            grn_morphogen(null(), &mut 0.0),
            grn_morphogen(&storage, null_mut()),
            grn_identity(null(), [0; GRN_IDENTITY_BYTES].as_mut_ptr()),
            grn_identity(&storage, null_mut()),
            grn_load(&mut storage, SIZE, null(), blob.len(), F32, 1),
            grn_percept_nothing(null_mut()),
        ]
    };
    assert_eq!(refused, [GrnStatus::NullPointer; 12]);
}

#[test]
fn misaligned_pointers_are_refused() {
    let (blob, mut storage) = (model(), loaded());
    let percept = GrnPercept::nothing();
    let mut room = [0_u64; SIZE / 8 + 1];
    let crooked = unsafe { room.as_mut_ptr().cast::<u8>().add(1) };
    let refused = unsafe {
        [
            grn_load(crooked.cast(), SIZE, blob.as_ptr(), blob.len(), F32, 1),
            grn_tick(crooked.cast(), &percept, &mut GrnCommand::default()),
            grn_tick(&mut storage, crooked.cast(), &mut GrnCommand::default()),
            grn_tick(&mut storage, &percept, crooked.cast()),
            grn_morphogen(&storage, crooked.cast()),
        ]
    };
    assert_eq!(refused, [GrnStatus::Misaligned; 5]);
    // Bytes have no alignment.
    let crooked_blob = unsafe { slice::from_raw_parts_mut(crooked, blob.len()) };
    crooked_blob.copy_from_slice(&blob);
    assert_eq!(load(&mut storage, crooked_blob), GrnStatus::Ok);
}

#[test]
fn storage_too_small_or_never_loaded_is_refused() {
    let blob = model();
    let mut storage = GrnController::default();
    let small = unsafe { grn_load(&mut storage, SIZE - 1, blob.as_ptr(), blob.len(), F32, 1) };
    assert_eq!(small, GrnStatus::StorageTooSmall);
    let mut command = wild();
    let status = unsafe { grn_tick(&mut storage, &GrnPercept::nothing(), &mut command) };
    assert_eq!((status, command), (GrnStatus::NotLoaded, GrnCommand::default()));
    assert_eq!(unsafe { grn_morphogen(&storage, &mut 0.0) }, GrnStatus::NotLoaded);
    assert_eq!(unsafe { grn_identity(&storage, [0; 8].as_mut_ptr()) }, GrnStatus::NotLoaded);
    for number in [0, 3, -1, i32::MAX] {
        assert_eq!(unsafe { grn_check(blob.as_ptr(), blob.len(), number) }, GrnStatus::UnknownNumber);
    }
}

#[test]
fn a_refused_blob_leaves_no_controller() {
    let mut storage = loaded();
    assert_eq!(load(&mut storage, b"nonsense"), GrnStatus::NotABlob);
    let status = unsafe { grn_tick(&mut storage, &GrnPercept::nothing(), &mut GrnCommand::default()) };
    assert_eq!(status, GrnStatus::NotLoaded);
    assert_eq!(load(&mut storage, &model()), GrnStatus::Ok);
}

#[test]
fn a_percept_of_zeros_is_refused_and_not_taken_for_obstacles_all_around() {
    // SAFETY: a percept is made of integers only.
    let zeros: GrnPercept = unsafe { std::mem::zeroed() };
    let mut command = wild();
    assert_eq!(unsafe { grn_tick(&mut loaded(), &zeros, &mut command) }, GrnStatus::Elapsed);
    assert_eq!(command, GrnCommand::default(), "the robot stops");
}

#[test]
fn with_nothing_perceived_the_robot_stands_still() {
    let mut told = GrnPercept { has_fix: 1, target_count: 9, ..GrnPercept::nothing() };
    assert_eq!(unsafe { grn_percept_nothing(&mut told) }, GrnStatus::Ok);
    assert_eq!(told, GrnPercept::nothing());
    let command = tick(&mut loaded(), &told);
    assert_eq!((command.left, command.right), (0, 0));
}

/// Nothing but a fix at the origin, looking east.
fn placed() -> GrnPercept {
    let fix = GrnFix { heading: [16_384, 0], ..GrnFix::default() };
    GrnPercept { has_fix: 1, fix, ..GrnPercept::nothing() }
}

#[test]
fn percepts_that_no_robot_can_have_are_refused_and_change_nothing() {
    type Spoil = fn(&mut GrnPercept);
    let spoils: [(Spoil, GrnStatus); 7] = [
        (|percept| percept.fix.heading = [90, 0], GrnStatus::Heading),
        (|percept| percept.fix.heading = [i16::MIN, i16::MIN], GrnStatus::Heading),
        (|percept| percept.fix.heading = [0, 15_871], GrnStatus::Heading),
        (|percept| percept.fix.position = [32_767_001, 0], GrnStatus::Position),
        (|percept| percept.fix.position = [0, i32::MIN], GrnStatus::Position),
        (|percept| percept.elapsed_us = 999, GrnStatus::Elapsed),
        (|percept| percept.elapsed_us = 250_001, GrnStatus::Elapsed),
    ];
    let (mut storage, mut undisturbed) = (loaded(), loaded());
    for (spoil, expected) in spoils {
        let mut percept = placed();
        spoil(&mut percept);
        let mut command = wild();
        assert_eq!(unsafe { grn_tick(&mut storage, &percept, &mut command) }, expected);
        assert_eq!(command, GrnCommand::default(), "the robot stops");
    }
    // Whose turn it is to speak would tell, had any of these been a tick.
    for _ in 0..8 {
        assert_eq!(tick(&mut storage, &placed()), tick(&mut undisturbed, &placed()));
    }
}

#[test]
fn every_byte_of_a_command_is_written() {
    let mut storage = loaded();
    for _ in 0..8 {
        let written = [0x00_u8, 0xff].map(|before| {
            // SAFETY: a command is made of integers only.
            let mut command: GrnCommand = unsafe { std::mem::transmute([before; size_of::<GrnCommand>()]) };
            // SAFETY: a controller that is loaded may be copied.
            let mut same = unsafe { std::ptr::read(&storage) };
            assert_eq!(unsafe { grn_tick(&mut same, &placed(), &mut command) }, GrnStatus::Ok);
            // SAFETY: as above.
            unsafe { std::mem::transmute::<GrnCommand, [u8; size_of::<GrnCommand>()]>(command) }
        });
        assert_eq!(written[0], written[1]);
        tick(&mut storage, &placed());
    }
}

#[test]
fn counts_beyond_the_arrays_are_refused_and_change_nothing() {
    type Spoil = fn(&mut GrnPercept);
    let spoils: [(Spoil, GrnStatus); 6] = [
        (|percept| percept.target_count = 5, GrnStatus::TooManyTargets),
        (|percept| percept.obstacle_count = 9, GrnStatus::TooManyObstacles),
        (|percept| percept.heard_count = 9, GrnStatus::TooManyHeard),
        (|percept| percept.heard_count = 255, GrnStatus::TooManyHeard),
        (
            |percept| {
                percept.heard_count = 1;
                percept.heard[0].message.obstacle_count = 5;
            },
            GrnStatus::TooManyReported,
        ),
        (
            |percept| {
                percept.heard_count = 8;
                percept.heard[7].message.obstacle_count = 255;
            },
            GrnStatus::TooManyReported,
        ),
    ];
    let mut storage = loaded();
    for (spoil, expected) in spoils {
        let mut percept = placed();
        spoil(&mut percept);
        let mut command = wild();
        assert_eq!(unsafe { grn_tick(&mut storage, &percept, &mut command) }, expected);
        assert_eq!(command, GrnCommand::default(), "the robot stops");
    }
    // Whose turn it is to speak would tell, had any of these been a tick. What is beyond the counts does not matter.
    let mut percept = GrnPercept { target_count: 1, ..placed() };
    let mut undisturbed = loaded();
    for _ in 0..8 {
        percept.heard[0].message.obstacle_count = 0;
        let expected = tick(&mut undisturbed, &percept);
        percept.heard[0].message.obstacle_count = 255;
        assert_eq!(tick(&mut storage, &percept), expected);
    }
}

#[test]
fn a_robot_that_is_called_home_drives_there() {
    let mut storage = loaded();
    let mut command = wild();
    let homeward = |storage: &mut GrnController, command: &mut GrnCommand| unsafe {
        grn_tick_home(storage, &placed(), GrnMillimetres { x: -30_000, y: 0 }, command)
    };
    assert_eq!(homeward(&mut storage, &mut command), GrnStatus::Ok);
    assert!(command.left < -100 && command.right == command.left, "{command:?}");
    assert_eq!(tick(&mut storage, &placed()).left, 0, "nothing is known, so a tick leads nowhere");
    assert_eq!(homeward(&mut GrnController::default(), &mut command), GrnStatus::NotLoaded);
    assert_eq!(command, GrnCommand::default());
}

/// A network of `N` genes as a blob.
fn blob_of<const N: usize>() -> Vec<u8> {
    let gene = |index: u8| Gene {
        motif: Motif::Pos,
        inputs: [if index == 0 { Source::X1 } else { Source::Gene(index - 1) }].into_iter().collect(),
        theta: 0.5,
    };
    let small = Blob::<32>::decode(&model()).unwrap();
    let blob = Blob::<N> {
        network: Network::new(1.0, (0..N as u8).map(gene)).unwrap(),
        field: small.field,
        level_fraction: small.level_fraction,
        scale: small.scale,
        step: small.step,
        time_scale: small.time_scale,
        gains: small.gains,
    };
    blob.encode(&mut vec![0; max_encoded_size(N)]).unwrap().to_vec()
}

fn changed(at: usize, value: u8) -> Vec<u8> {
    let mut blob = model();
    blob[at] = value;
    blob
}

/// The blob with other parameters.
fn tuned(tune: impl FnOnce(&mut Blob)) -> Vec<u8> {
    let mut blob = Blob::<32>::decode(&model()).unwrap();
    tune(&mut blob);
    blob.encode(&mut [0; max_encoded_size(32)]).unwrap().to_vec()
}

#[test]
fn bad_blobs_are_refused_each_with_what_to_do() {
    let good = model();
    let blind = tuned(|blob| {
        let gene = Gene { motif: Motif::Pos, inputs: [Source::X2].into_iter().collect(), theta: 1.0 };
        blob.network = Network::new(1.0, [gene]).unwrap();
    });
    // So steep that even the last trace of a target is inside.
    let boundless = tuned(|blob| {
        let gene = |source, theta| Gene { motif: Motif::Pos, inputs: [source].into_iter().collect(), theta };
        let genes = [gene(Source::X1, 0.0), gene(Source::Gene(0), 0.5), gene(Source::Gene(1), 0.5)];
        blob.network = Network::new(16.0, genes).unwrap();
        blob.field.kernel = Kernel::Exponential;
        blob.level_fraction = 0.01;
    });
    // A motif of a later release, in an envelope without a fault.
    let mut payload = good[15..good.len() - 4].to_vec();
    let motif = payload.iter().position(|&byte| byte == Motif::Nand.code()).unwrap();
    payload[motif] = 99;
    let mut unknown_motif = [&good[..7], &sha2::Sha256::digest(&payload)[..8], &payload].concat();
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&unknown_motif);
    unknown_motif.extend(crc.to_le_bytes());
    let cases = [
        (good[..10].to_vec(), GrnStatus::BlobTruncated, "cut short: copy or upload it again"),
        (Vec::new(), GrnStatus::BlobTruncated, "cut short: copy or upload it again"),
        (good[..40].to_vec(), GrnStatus::BlobLength, "pass its exact length"),
        ([&good[..], &[0]].concat(), GrnStatus::BlobLength, "pass its exact length"),
        (vec![0xff; 64], GrnStatus::NotABlob, "not a GRN blob"),
        (changed(4, 0), GrnStatus::BlobTooOld, "write it again with this library's release"),
        (changed(4, 2), GrnStatus::BlobTooNew, "update this library"),
        (changed(30, 0x55), GrnStatus::BlobDamaged, "damaged: copy or upload it again"),
        (unknown_motif, GrnStatus::BlobUnknownCode, "update this library"),
        (blob_of::<33>(), GrnStatus::NetworkTooLarge, "evolve a smaller one"),
        (blind, GrnStatus::NoPattern, "does not tell targets from empty space"),
        (boundless, GrnStatus::NoRing, "does not close"),
        (tuned(|blob| blob.time_scale = 3.5), GrnStatus::StepsPerTick, "1 to 64 whole steps"),
    ];
    for (blob, expected, advice) in cases {
        let status = load(&mut GrnController::default(), &blob);
        assert_eq!(status, expected);
        for number in [GrnNumber::F32, GrnNumber::Q8_24] {
            assert_eq!(unsafe { grn_check(blob.as_ptr(), blob.len(), number as i32) }, expected);
        }
        let text = text(grn_status_text(status as i32));
        assert!(text.contains(advice), "{text}");
    }
    assert_eq!(load(&mut GrnController::default(), &blob_of::<32>()), GrnStatus::NoPattern, "32 genes are read");
}

#[test]
fn a_newer_blob_is_known_as_such_at_any_length() {
    let mut long = vec![0; 70_000];
    long[..4].copy_from_slice(&MAGIC);
    long[4] = 9;
    assert_eq!(load(&mut GrnController::default(), &long), GrnStatus::BlobTooNew);
    long[4] = 1;
    assert_eq!(load(&mut GrnController::default(), &long), GrnStatus::BlobLength);
}

#[test]
fn every_number_has_a_text() {
    let texts: Vec<&str> = (-1..64).map(|number| text(grn_status_text(number))).collect();
    let unknown = text(grn_status_text(i32::MIN));
    assert!(unknown.contains("not a status"));
    let mut known: Vec<&str> = texts.into_iter().filter(|&text| text != unknown).collect();
    assert!(known.iter().all(|text| text.is_ascii() && !text.contains('\n')));
    known.sort_unstable();
    known.dedup();
    assert_eq!(known.len(), 33, "each its own");
    assert_eq!(text(grn_version()), env!("CARGO_PKG_VERSION"));
    assert_eq!(grn_blob_format_version(), grn_core::blob::FORMAT_VERSION);
}
