//! Bringing a blob onto a robot: upload, verify, activate, confirm.

use crate::client::{Client, LinkError};
use crate::wire::Wire;
use grn_core::blob::Identity;
use grn_core::robot::link::Refusal;
use grn_core::robot::link::message::{Activate, Begin, Chunk, Commit, Confirm, MAX_CHUNK, Status};
use grn_core::robot::slots::Stage;

/// The shortest chunk, bytes: robots write their slots in units of 8.
const MIN_CHUNK: usize = 8;
/// How often a chunk is sent before it is split in half: on a bad wire a shorter frame is more likely to arrive whole.
const TRIES_BEFORE_HALVING: u32 = 6;

/// How far flashing has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The robot erases a slot.
    Erasing,
    /// The robot takes the blob; it has this many bytes.
    Uploading(usize),
    /// The robot reads the blob back and checks it.
    Verifying,
    /// The robot puts the blob in charge.
    Activating,
    /// The robot keeps it.
    Confirming,
}

/// What flashing did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flashed {
    /// The blob is in charge.
    InCharge,
    /// It was in charge before.
    WasInCharge,
}

/// Uploads a blob and puts it in charge; with `confirm` its trial ends at once. `watch` hears of every step before it is
/// taken. After any failure all of it can be repeated.
///
/// # Errors
/// [`LinkError`]. If it comes before [`Progress::Activating`], the blob that was in charge still is; if it comes then, either
/// may be in charge; if it comes after that, the new one is.
pub fn flash<W: Wire>(
    client: &mut Client<W>,
    blob: &[u8],
    identity: Identity,
    confirm: bool,
    mut watch: impl FnMut(Progress),
) -> Result<Flashed, LinkError> {
    let status = client.ask(&Status)?;
    let active = status.active.and_then(|slot| status.slots.get(usize::from(slot)));
    let was_in_charge = active.is_some_and(|slot| slot.identity == identity);
    let ready = status.slots.iter().any(|slot| slot.identity == identity && slot.stage == Stage::Verified);
    if !was_in_charge {
        // A blob that was uploaded before may have spoilt since.
        let activated = ready && {
            watch(Progress::Activating);
            match client.ask(&Activate { identity }) {
                Err(LinkError::Refused(_)) => false,
                answer => answer.map(|()| true)?,
            }
        };
        if !activated {
            upload(client, blob, identity, &mut watch)?;
            watch(Progress::Activating);
            client.ask(&Activate { identity })?;
        }
    }
    if confirm {
        watch(Progress::Confirming);
        client.ask(&Confirm { identity })?;
    }
    Ok(if was_in_charge { Flashed::WasInCharge } else { Flashed::InCharge })
}

fn upload<W: Wire>(
    client: &mut Client<W>,
    blob: &[u8],
    identity: Identity,
    watch: &mut impl FnMut(Progress),
) -> Result<(), LinkError> {
    watch(Progress::Erasing);
    client.ask(&Begin { length: blob.len() as u32, identity })?;
    let mut offset = 0;
    let mut size = MAX_CHUNK;
    while let Some(rest) = blob.get(offset..).filter(|rest| !rest.is_empty()) {
        watch(Progress::Uploading(offset));
        let bytes = rest.iter().take(size).copied().collect::<heapless::Vec<u8, MAX_CHUNK>>();
        let end = offset + bytes.len();
        let chunk = Chunk { offset: offset as u32, bytes };
        let sent = if size > MIN_CHUNK { client.ask_up_to(TRIES_BEFORE_HALVING, &chunk) } else { client.ask(&chunk) };
        match sent {
            Ok(()) => offset = end,
            // The robot has the chunk; only its answers were lost.
            Err(LinkError::Refused(Refusal::Chunk { expected })) if expected as usize > offset => {
                offset = expected as usize;
            }
            Err(LinkError::Silent { .. }) if size > MIN_CHUNK => size /= 2,
            Err(error) => return Err(error),
        }
    }
    watch(Progress::Verifying);
    client.ask(&Commit)
}
