//! Slots: what is in charge after whatever happened, power loss at every step included.
#![allow(clippy::unwrap_used, reason = "what only tests call")]

use embedded_storage::nor_flash::NorFlash;
use firmware_sim::flash::SimulatedFlash;
use grn_core::blob::{Blob, Identity};
use grn_core::robot::link::message::{Activate, REFUSED, encode_request};
use grn_core::robot::link::{Refusal, Server};
use grn_core::robot::slots::{Layout, MAX_BLOB, MIN_SLOT, SlotError, Slots, Stage, image};
use grn_core::robot::{Controller, Fix, Millimetres, Percept, Sighting};
use grn_core::scalar::NumberType;
use grn_tests::robots::{LAYOUT, Shipped, empty_flash};

type Outcome = Result<(), SlotError>;

fn start<F: NorFlash>(flash: F) -> Result<(Slots<F>, Option<Identity>), SlotError> {
    let mut slots = Slots::start(flash, LAYOUT, |_| true)?;
    let blob = slots.blob_in_charge()?;
    Ok((slots, blob.map(|blob| blob.identity())))
}

fn upload<F: NorFlash>(slots: &mut Slots<F>, blob: &Shipped) -> Outcome {
    slots.begin(blob.bytes.len() as u32, blob.identity)?;
    for (place, bytes) in blob.bytes.chunks(64).enumerate() {
        slots.chunk(place as u32 * 64, bytes)?;
    }
    slots.commit(|_| Ok::<(), SlotError>(()))
}

fn install<F: NorFlash>(slots: &mut Slots<F>, blob: &Shipped) -> Outcome {
    upload(slots, blob)?;
    slots.activate(blob.identity)?;
    slots.confirm(blob.identity)
}

/// A flash with the old blob confirmed in one slot and, older still, another in the other.
fn with_history(old: &Shipped, older: &Shipped, seed: u64) -> SimulatedFlash {
    let (mut slots, nothing) = start(empty_flash(seed)).unwrap();
    assert_eq!(nothing, None);
    install(&mut slots, older).unwrap();
    install(&mut slots, old).unwrap();
    slots.into_flash()
}

fn models() -> [Shipped; 3] {
    let model = Shipped::named("nand-xnor");
    [model.cruising_at(0.11), model.cruising_at(0.1), model]
}

#[test]
fn a_blob_goes_through_its_stages() -> Outcome {
    let [new, old, _] = models();
    let (mut slots, _) = start(empty_flash(0))?;
    install(&mut slots, &old)?;
    upload(&mut slots, &new)?;
    assert_eq!(slots.status()?.map(|slot| slot.stage), [Stage::Confirmed, Stage::Verified]);
    let (mut slots, active) = start(slots.into_flash())?;
    assert_eq!(active, Some(old.identity), "uploaded is not activated");
    slots.activate(new.identity)?;
    assert_eq!(slots.active_status()?.map(|slot| slot.stage), Some(Stage::Trial));
    assert_eq!(slots.begin(9, new.identity), Err(SlotError::OnTrial), "the fallback must stay");
    slots.confirm(new.identity)?;
    let (mut slots, active) = start(slots.into_flash())?;
    assert_eq!(active, Some(new.identity));
    slots.roll_back(new.identity)?;
    assert_eq!(slots.blob_in_charge()?.map(|blob| blob.identity()), Some(old.identity));
    slots.roll_back(new.identity)?;
    assert_eq!(slots.active_status()?.map(|slot| slot.identity), Some(old.identity), "asked again, nothing happens");
    let (mut slots, active) = start(slots.into_flash())?;
    assert_eq!(active, Some(old.identity));
    assert_eq!(slots.status()?.map(|slot| slot.stage), [Stage::Confirmed, Stage::Rejected]);
    assert_eq!(slots.activate(new.identity), Err(SlotError::NotThere), "rejected stays rejected");
    install(&mut slots, &new)
}

#[test]
fn a_trial_that_a_reset_ends_is_rolled_back() -> Outcome {
    let [new, old, _] = models();
    let (mut slots, _) = start(empty_flash(0))?;
    install(&mut slots, &old)?;
    upload(&mut slots, &new)?;
    slots.activate(new.identity)?;
    let (mut slots, active) = start(slots.into_flash())?;
    assert_eq!(active, Some(old.identity));
    assert_eq!(slots.status()?[1].stage, Stage::Rejected);
    Ok(())
}

#[test]
fn without_a_fallback_a_trial_goes_on() -> Outcome {
    let [new, ..] = models();
    let (mut slots, _) = start(empty_flash(0))?;
    upload(&mut slots, &new)?;
    slots.activate(new.identity)?;
    assert_eq!(slots.roll_back(new.identity), Err(SlotError::NoFallback));
    let (mut slots, active) = start(slots.into_flash())?;
    assert_eq!(active, Some(new.identity));
    slots.confirm(new.identity)
}

#[test]
fn what_does_not_fit_is_refused() -> Outcome {
    let [new, old, _] = models();
    for layout in [
        Layout { starts: [0, 1024], size: 2048 },
        Layout { starts: [512, 2048], size: 1024 },
        Layout { starts: [0, 3072], size: 2048 },
        Layout::adjacent(MIN_SLOT),
    ] {
        let refused = Slots::start(empty_flash(0), layout, |_| true).map(|_| ());
        assert_eq!(refused, Err(SlotError::Layout), "{layout:?}");
    }
    let (mut slots, _) = start(empty_flash(0))?;
    assert_eq!(slots.chunk(0, &[0; 8]), Err(SlotError::NoUpload));
    assert_eq!(slots.begin(MAX_BLOB as u32 + 1, new.identity), Err(SlotError::TooLong));
    slots.begin(20, new.identity)?;
    assert_eq!(slots.chunk(8, &[0; 8]), Err(SlotError::Chunk { expected: 0 }));
    assert_eq!(slots.chunk(0, &[0; 7]), Err(SlotError::Chunk { expected: 0 }));
    slots.chunk(0, &[0; 8])?;
    assert_eq!(slots.chunk(8, &[0; 16]), Err(SlotError::Chunk { expected: 8 }));
    assert_eq!(slots.chunk(u32::MAX, &[0; 16]), Err(SlotError::Chunk { expected: 8 }));
    assert_eq!(slots.commit(|_| Ok(())), Err(SlotError::Chunk { expected: 8 }));
    let misnamed = Shipped { identity: old.identity, ..new };
    assert_eq!(upload(&mut slots, &misnamed), Err(SlotError::OtherBlob));
    assert_eq!(slots.activate(old.identity), Err(SlotError::NotThere));
    Ok(())
}

#[test]
fn an_image_for_a_programmer_is_in_charge() -> Outcome {
    let [new, old, older] = models();
    for slot in [0, 1] {
        let mut flash = with_history(&old, &older, 0);
        let image = image(&new.bytes, 1_700_000_000)?;
        let start_of = LAYOUT.starts[slot] as usize;
        flash.bytes_mut()[start_of..start_of + image.len()].copy_from_slice(&image);
        let (mut slots, active) = start(flash)?;
        assert_eq!(active, Some(new.identity));
        assert_eq!(slots.status()?[slot].stage, Stage::Confirmed);
        install(&mut slots, &older)?;
        assert_eq!(start(slots.into_flash())?.1, Some(older.identity));
    }
    Ok(())
}

/// A flash whose blob in charge has the highest number there is; the other blob came from a programmer.
fn at_the_top(old: &Shipped, older: &Shipped) -> SimulatedFlash {
    let mut flash = empty_flash(5);
    let image = image(&older.bytes, u32::MAX - 1).unwrap();
    flash.bytes_mut()[..image.len()].copy_from_slice(&image);
    let (mut slots, _) = start(flash).unwrap();
    install(&mut slots, old).unwrap();
    assert_eq!(slots.status().unwrap().map(|slot| slot.sequence), [u32::MAX - 1, u32::MAX]);
    slots.into_flash()
}

#[test]
fn after_the_highest_number_no_upload_is_lost() -> Outcome {
    let [new, old, older] = models();
    assert_eq!(image(&new.bytes, u32::MAX), Err(SlotError::SequenceUsedUp));
    let before = at_the_top(&old, &older);
    let (mut slots, _) = start(before.clone())?;
    assert_eq!(upload(&mut slots, &new), Err(SlotError::SequenceUsedUp));
    let flash = slots.into_flash();
    assert_eq!(flash.bytes(), before.bytes(), "nothing is erased for an upload that would be lost");
    let (mut slots, active) = start(flash)?;
    assert_eq!(active, Some(old.identity));
    slots.roll_back(old.identity)?;
    install(&mut slots, &new)?;
    assert_eq!(start(slots.into_flash())?.1, Some(new.identity));
    Ok(())
}

#[test]
fn a_spoilt_blob_is_never_in_charge() -> Outcome {
    let [_, old, older] = models();
    let whole = with_history(&old, &older, 0);
    let (slots, active) = start(whole.clone())?;
    assert_eq!(active, Some(old.identity));
    let newer = if slots.active() == Some(0) { 0 } else { LAYOUT.starts[1] as usize };
    for at in 0..old.bytes.len() + 24 {
        let mut spoilt = whole.clone();
        let at = newer + if at < 24 { at } else { 128 + at };
        spoilt.bytes_mut()[at] ^= 0x10;
        assert_eq!(start(spoilt)?.1, Some(older.identity), "byte {at}");
    }
    Ok(())
}

type Powered<'f> = Slots<&'f mut SimulatedFlash>;

/// Does `change` with the power failing after every number of steps, once and then again while the robot starts or the
/// change is repeated: `old` or `new` must be in charge each time, and then `new` can be installed.
fn survives_power_loss(
    before: &SimulatedFlash,
    old: &Shipped,
    new: &Shipped,
    change: impl Fn(&mut Powered<'_>) -> Outcome,
) {
    let attempt = |flash: &mut SimulatedFlash| start(flash).and_then(|(mut slots, _)| change(&mut slots));
    let in_charge = |flash: &SimulatedFlash| start(flash.clone().powered()).unwrap().1;
    let either = |flash: &SimulatedFlash| in_charge(flash).is_some_and(|id| [old.identity, new.identity].contains(&id));
    let mut after = before.clone();
    assert_eq!(attempt(&mut after), Ok(()));
    let steps = after.steps() - before.steps();
    assert!(steps > 0, "nothing was written");
    for first in 0..steps {
        let mut cut = before.clone().failing_after(first);
        assert!(attempt(&mut cut).is_err());
        assert!(either(&cut), "cut at step {first}");
        for second in 0..steps {
            let mut again = cut.clone().powered().failing_after(second);
            let _ = attempt(&mut again);
            assert!(either(&again), "cut at step {first}, then {second}");
            let (mut slots, _) = start(again.powered()).unwrap();
            assert_eq!(install(&mut slots, new), Ok(()), "after cuts at steps {first} and {second}");
            assert_eq!(in_charge(&slots.into_flash()), Some(new.identity));
        }
    }
}

#[test]
fn power_loss_at_every_step_of_an_upload() {
    let [new, old, older] = models();
    let before = with_history(&old, &older, 1);
    survives_power_loss(&before, &old, &new, |slots| upload(slots, &new));
}

#[test]
fn power_loss_at_every_step_of_putting_a_blob_in_charge() {
    let [new, old, older] = models();
    let before = with_history(&old, &older, 2);
    survives_power_loss(&before, &old, &new, |slots| install(slots, &new));
}

#[test]
fn power_loss_at_every_step_of_activating_confirming_and_rolling_back() {
    let [new, old, older] = models();
    let (mut slots, _) = start(with_history(&old, &older, 3)).unwrap();
    upload(&mut slots, &new).unwrap();
    let uploaded = slots.into_flash();
    survives_power_loss(&uploaded, &old, &new, |slots| slots.activate(new.identity));
    survives_power_loss(&uploaded, &old, &new, |slots| {
        slots.activate(new.identity)?;
        slots.confirm(new.identity)
    });
    let (mut slots, _) = start(uploaded).unwrap();
    slots.activate(new.identity).unwrap();
    slots.confirm(new.identity).unwrap();
    survives_power_loss(&slots.into_flash(), &old, &new, |slots| slots.roll_back(new.identity));
}

#[test]
fn power_loss_at_every_step_of_an_upload_over_a_higher_number() {
    let [new, old, rolled_back] = models();
    let (mut slots, _) = start(empty_flash(6)).unwrap();
    install(&mut slots, &old).unwrap();
    let mut flash = slots.into_flash();
    let (image, place) = (image(&rolled_back.bytes, u32::MAX - 1).unwrap(), LAYOUT.starts[1] as usize);
    flash.bytes_mut()[place..place + image.len()].copy_from_slice(&image);
    let (mut slots, active) = start(flash).unwrap();
    assert_eq!(active, Some(rolled_back.identity));
    slots.roll_back(rolled_back.identity).unwrap();
    survives_power_loss(&slots.into_flash(), &old, &new, |slots| install(slots, &new));
}

/// The old controller must not go on driving when the flash says that another blob is in charge.
#[test]
fn a_robot_whose_flash_cannot_be_read_after_a_change_of_blobs_stops() {
    let [new, old, older] = models();
    let (mut slots, _) = start(with_history(&old, &older, 4)).unwrap();
    upload(&mut slots, &new).unwrap();
    let uploaded = slots.into_flash();
    let fix = Some(Fix { position: [0; 2], heading: [1 << 14, 0], age_ms: 0 });
    let mut percept = Percept { fix, ..Percept::nothing() };
    let _ = percept.targets.push(Sighting { target: 0, position: Millimetres { x: 2000, y: 0 } });
    let drives = |blob: &Shipped| {
        let blob: Blob = Blob::decode(&blob.bytes).unwrap();
        Controller::<f32>::new(&blob, 0).unwrap().tick(&percept).unwrap()
    };
    assert_ne!(drives(&old), drives(&new), "the blobs cannot be told apart");
    let activate = encode_request(1, &Activate { identity: new.identity }).unwrap();
    let (mut started, mut stopped) = (0, 0);
    for reads in 0.. {
        let mut flash = uploaded.clone();
        flash.fail_reads_after(Some(reads));
        let Ok(mut server) = Server::<_, f32>::start(flash, LAYOUT, "robot", NumberType::F32) else { continue };
        started += 1;
        let answer = activate.iter().find_map(|&byte| server.receive(byte).map(<[u8]>::to_vec)).unwrap();
        let refused = answer.contains(&REFUSED);
        let driven = server.tick(&percept);
        let changed = server.into_flash().bytes() != uploaded.bytes();
        match (refused, changed) {
            (true, false) => assert_eq!(driven, Ok(drives(&old)), "after {reads} reads"),
            (true, true) => assert_eq!(driven, Err(Refusal::NoController), "after {reads} reads"),
            (false, changed) => {
                assert!(changed);
                assert_eq!(driven, Ok(drives(&new)));
                break;
            }
        }
        stopped += usize::from(changed);
    }
    assert!(started > stopped && stopped > 0, "{stopped} of {started}: the exercise has no edge");
}
