//! Fragments put together again.
//!
//! What one robot sends is kept apart from what others send by the sender and number in each fragment. A radio of 2 bytes has
//! room for three bits of the sender only, so the fragments of two robots may come together; then the checksum or the sender
//! in the message tells, and both are dropped.
//!
//! How a fragment is taken in:
//! 1. The message it belongs to is looked up. A message is over when its sender has begun another since, or after two
//!    seconds of silence; a fragment of the same number then belongs to a new message.
//! 2. If none is found, a place is taken: a free one, or that of a message that is complete or over. If there is none, the
//!    fragment is dropped: messages that are begun come first, or in a crowd none would ever be completed.
//! 3. Its data are put in. If they differ from what is there already, one of both is wrong, and all that was there goes.
//! 4. When no byte lacks, the checksum decides. A complete message is remembered for a while, to ignore its duplicates.

use super::fragments::{Data, Key, Piece};
use super::packed::{MAX_PACKED, length, read};
use crate::robot::message::Message;

/// How many messages are put together at the same time: as many as a robot hears in one tick.
const MESSAGES: usize = 8;
/// Ticks without a fragment after which a message is over.
const LIFETIME: u32 = 64;
/// Ticks by which a fragment may be late so that fragments of the sender's next message come before it.
const OVERTAKING: u32 = 4;
/// Ticks for which duplicates of a complete message are known as such. A sender uses a number again after 16 ticks.
const DUPLICATES: u32 = 8;

/// Puts fragments of messages together; takes 704 bytes.
///
/// It is made of integers only, and zeros are one that has heard nothing.
#[derive(Clone, Debug, Default)]
pub struct Assembler {
    messages: [Partial; MESSAGES],
}

/// What has arrived of one message. A place is free while nothing is known of its sender.
#[derive(Clone, Copy, Debug)]
struct Partial {
    key: Key,
    /// 1 once it was given out.
    complete: u8,
    /// Ticks of its first and its last fragment.
    began: u32,
    touched: u32,
    bytes: [u8; MAX_PACKED],
    /// Which bits of `bytes` have arrived.
    arrived: [u8; MAX_PACKED],
}

impl Default for Partial {
    fn default() -> Self {
        Partial {
            key: Key::default(),
            complete: 0,
            began: 0,
            touched: 0,
            bytes: [0; MAX_PACKED],
            arrived: [0; MAX_PACKED],
        }
    }
}

/// A fragment says otherwise than one before.
struct Contradiction;

impl Assembler {
    /// One that has heard nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes in a fragment; a message, if that completes it. What is no fragment is ignored.
    ///
    /// `tick`: the present control tick, counted from anywhere; it may wrap around.
    pub fn receive(&mut self, tick: u32, fragment: &[u8]) -> Option<Message> {
        let piece = Piece::read(fragment)?;
        let partial = self.place(piece.key, tick)?;
        if partial.complete != 0 {
            return None;
        }
        partial.touched = tick;
        if partial.put(piece.data).is_err() {
            *partial = Partial::begun(piece.key, tick);
            // Nothing is there that it could contradict.
            let _ = partial.put(piece.data);
        }
        let packed = partial.packed()?;
        let message = read(packed).ok().filter(|message| message.sender as u8 & piece.key.known == piece.key.sender);
        match message {
            Some(_) => partial.complete = 1,
            None => *partial = Partial::default(),
        }
        message
    }

    /// Where what belongs to a message is collected.
    fn place(&mut self, key: Key, tick: u32) -> Option<&mut Partial> {
        let found = self.messages.iter().position(|partial| partial.key == key);
        if let Some(index) = found {
            let over = self.is_over(index, tick);
            let partial = self.messages.get_mut(index)?;
            if over {
                *partial = Partial::begun(key, tick);
            }
            return Some(partial);
        }
        let free = self.messages.iter().position(|partial| partial.key.known == 0);
        let complete = || self.messages.iter().position(|partial| partial.complete != 0);
        let index = free.or_else(complete).or_else(|| (0..MESSAGES).find(|&index| self.is_over(index, tick)))?;
        let partial = self.messages.get_mut(index)?;
        *partial = Partial::begun(key, tick);
        Some(partial)
    }

    fn is_over(&self, index: usize, tick: u32) -> bool {
        let Some(partial) = self.messages.get(index) else { return false };
        let silence = tick.wrapping_sub(partial.touched);
        let lifetime = if partial.complete != 0 { DUPLICATES } else { LIFETIME };
        // Begun before it was last heard of, another message is not its successor.
        let successor = |other: &Partial| {
            let same_sender = (other.key.sender, other.key.known) == (partial.key.sender, partial.key.known);
            same_sender && tick.wrapping_sub(other.began) < silence
        };
        silence > lifetime || silence > OVERTAKING && self.messages.iter().any(successor)
    }
}

impl Partial {
    fn begun(key: Key, tick: u32) -> Self {
        Partial { key, began: tick, touched: tick, ..Partial::default() }
    }

    fn put(&mut self, data: Data<'_>) -> Result<(), Contradiction> {
        match data {
            Data::Bytes(place, bytes) => {
                (place..).zip(bytes).try_for_each(|(at, &byte)| self.put_bits(at, byte, u8::MAX))
            }
            Data::Bits(place, bits) => {
                let (at, shift) = (place * 6 / 8, place * 6 % 8);
                let [low, high] = (u16::from(bits) << shift).to_le_bytes();
                let [low_mask, high_mask] = (0b11_1111_u16 << shift).to_le_bytes();
                self.put_bits(at, low, low_mask)?;
                self.put_bits(at + 1, high, high_mask)
            }
        }
    }

    /// Puts in the bits of `mask`. What is beyond the longest message is in none.
    fn put_bits(&mut self, at: usize, byte: u8, mask: u8) -> Result<(), Contradiction> {
        let (Some(there), Some(arrived)) = (self.bytes.get_mut(at), self.arrived.get_mut(at)) else { return Ok(()) };
        if (*there ^ byte) & *arrived & mask != 0 {
            return Err(Contradiction);
        }
        *there = *there & !mask | byte & mask;
        *arrived |= mask;
        Ok(())
    }

    /// The message's bytes if none lacks. If its first byte is that of no message, or there is something behind its end, all
    /// bytes are given: too many for this message, so that they are refused.
    fn packed(&self) -> Option<&[u8]> {
        let [first, ..] = self.bytes;
        if self.arrived.first() != Some(&u8::MAX) {
            return None;
        }
        let Some(length) = length(first) else { return Some(&self.bytes) };
        let (message, behind) = self.bytes.split_at_checked(length)?;
        if !self.arrived.get(..length)?.iter().all(|&bits| bits == u8::MAX) {
            return None;
        }
        Some(if behind.iter().all(|&byte| byte == 0) { message } else { &self.bytes })
    }
}

#[cfg(test)]
mod tests {
    use super::super::fragments::{Fragment, Fragments, MAX_FRAGMENT, PayloadError};
    use super::super::packed::tests::message;
    use super::*;
    use crate::bounded::filled;
    use crate::robot::{Millimetres, ObstacleReport, TargetReport};
    use proptest::prelude::*;
    use std::vec::Vec;

    /// A message with all there can be in one.
    fn longest(sender: u16) -> Message {
        let position = Millimetres { x: 12_345, y: -23_456 };
        let target = Some(TargetReport { target: 3, position, velocity: [-100, 100], age: 7 });
        let obstacles = filled((0..4).map(|age| ObstacleReport { position: Millimetres { x: -1, y: 900 }, age }));
        Message { sender, position, target, obstacles }
    }

    fn cut(message: &Message, payload: usize, number: u8) -> Vec<Fragment> {
        Fragments::new(message, payload, number).unwrap().collect()
    }

    fn receive(assembler: &mut Assembler, tick: u32, fragments: &[Fragment]) -> Vec<Message> {
        fragments.iter().filter_map(|fragment| assembler.receive(tick, fragment)).collect()
    }

    #[test]
    fn fragments_have_exactly_these_bytes() {
        let message =
            Message { sender: 0x407, position: Millimetres { x: 258, y: -259 }, target: None, obstacles: filled([]) };
        // 20 07 04 02 01 fd fe and the checksum 6b 6f.
        let expected: [&[u8]; 3] = [&[7, 0x40, 0x20, 7, 4], &[7, 0x43, 2, 1, 0xfd], &[7, 0x46, 0xfe, 0x6b, 0x6f]];
        assert_eq!(cut(&message, 5, 1), expected);
        let small = cut(&message, 2, 1);
        assert_eq!(small.len(), 12);
        assert_eq!(small[..3], [[0x20, 0xf0], [0x5c, 0xf0], [0x80, 0xf0]].map(Fragment::from));
    }

    #[test]
    fn the_longest_message_takes_so_many_fragments() {
        let counts = [2, 3, 4, 8, 20, 21, 30, 32, 38, 39, 500].map(|payload| cut(&longest(9), payload, 0).len());
        assert_eq!(counts, [50, 37, 19, 7, 3, 2, 2, 2, 2, 1, 1]);
        assert_eq!(cut(&longest(9), 500, 0)[0].len(), MAX_FRAGMENT);
        for payload in [2, 3, 20] {
            let fragments = Fragments::new(&longest(9), payload, 5).unwrap();
            let all = cut(&longest(9), payload, 5);
            for index in [0, 1, all.len() - 1, all.len(), 64, 100, usize::MAX] {
                assert_eq!(fragments.clone().nth(index), all.get(index).cloned(), "{index} of {payload} bytes");
            }
        }
        for payload in [0, 1] {
            assert_eq!(Fragments::new(&longest(9), payload, 0).err(), Some(PayloadError { payload }));
        }
    }

    #[test]
    fn an_assembler_takes_as_much_memory_as_it_says() {
        assert_eq!(size_of::<Assembler>(), 704);
    }

    #[test]
    fn slow_radios_and_lost_messages_do_not_mix_what_has_the_same_number() {
        let mut assembler = Assembler::new();
        let (old, new) = (longest(1), Message { position: Millimetres { x: 1, y: 1 }, ..longest(1) });
        // One fragment a tick; the second half of the old message is lost, then a whole message, and numbers wrap around.
        for (tick, fragment) in (0..24).zip(cut(&old, 2, 0)) {
            assert_eq!(assembler.receive(tick, &fragment), None);
        }
        assert_eq!(receive(&mut assembler, 48, &cut(&old, 2, 1)[..1]), []);
        let got: Vec<Message> =
            (96..).zip(cut(&new, 2, 2)).filter_map(|(tick, f)| assembler.receive(tick, &f)).collect();
        assert_eq!(got, [new]);
    }

    #[test]
    fn in_a_crowd_what_is_begun_is_completed() {
        let mut assembler = Assembler::new();
        let crowd: Vec<Vec<Fragment>> = (0..20).map(|sender| cut(&longest(sender), 30, 0)).collect();
        let firsts: Vec<Fragment> = crowd.iter().map(|fragments| fragments[0].clone()).collect();
        let seconds: Vec<Fragment> = crowd.iter().map(|fragments| fragments[1].clone()).collect();
        assert_eq!(receive(&mut assembler, 0, &firsts), []);
        assert_eq!(receive(&mut assembler, 1, &seconds).len(), MESSAGES);
        // Silence makes room for others.
        assert_eq!(receive(&mut assembler, 100, &crowd.concat()).len(), crowd.len());
    }

    #[test]
    fn robots_with_equal_bits_of_their_numbers_are_not_taken_for_each_other() {
        // On a radio of 2 bytes, 1 and 9 look the same.
        let mut assembler = Assembler::new();
        let (one, nine) = (cut(&longest(1), 2, 0), cut(&longest(9), 2, 0));
        let mixed: Vec<Fragment> = one.iter().zip(&nine).flat_map(|(a, b)| [a.clone(), b.clone()]).collect();
        let got = receive(&mut assembler, 0, &mixed);
        assert!(got.iter().all(|message| *message == longest(1) || *message == longest(9)), "{got:?}");
        assert_eq!(receive(&mut assembler, 200, &nine), [longest(9)]);
    }

    /// Messages of some robots, the payloads of their radios, and an order for all fragments, each at least once.
    fn traffic() -> impl Strategy<Value = (Vec<Message>, Vec<(usize, Fragment)>)> {
        let sent = proptest::collection::vec((message(), 2_usize..=40, any::<u8>()), 1..=MESSAGES);
        let fragments = sent.prop_map(|sent| {
            // Different in the three bits that the smallest radio has.
            let named = |(sender, (message, payload, number)): (u16, (Message, usize, u8))| {
                (Message { sender: message.sender & !7 | sender, ..message }, payload, number)
            };
            let sent: Vec<_> = (0..).zip(sent).map(named).collect();
            let fragments: Vec<(usize, Fragment)> = (0..)
                .zip(&sent)
                .flat_map(|(index, (message, payload, number))| {
                    cut(message, *payload, *number).into_iter().map(move |fragment| (index, fragment))
                })
                .collect();
            (sent.into_iter().map(|(message, ..)| message).collect::<Vec<_>>(), fragments)
        });
        fragments.prop_flat_map(|(messages, fragments)| {
            let twice = proptest::sample::subsequence(fragments.clone(), 0..=fragments.len());
            let all = twice.prop_map(move |twice| [&fragments[..], &twice].concat()).prop_shuffle();
            (Just(messages), all)
        })
    }

    proptest! {
        #[test]
        fn in_any_order_and_doubled_every_message_comes_once((messages, fragments) in traffic()) {
            let mut assembler = Assembler::new();
            let mut got: Vec<Message> = fragments.iter().filter_map(|(_, f)| assembler.receive(7, f)).collect();
            got.sort_by_key(|message| message.sender & 7);
            prop_assert_eq!(got, messages);
        }

        #[test]
        fn with_losses_whole_messages_come_and_no_others(
            (messages, mut fragments) in traffic(),
            lost in proptest::collection::vec(any::<proptest::sample::Index>(), 1..5),
        ) {
            let gone: Vec<(usize, Fragment)> = lost.iter().map(|index| index.get(&fragments).clone()).collect();
            fragments.retain(|fragment| !gone.contains(fragment));
            let whole = messages.iter().enumerate().filter(|(index, _)| !gone.iter().any(|(of, _)| of == index));
            let whole: Vec<Message> = whole.map(|(_, message)| message.clone()).collect();
            let mut assembler = Assembler::new();
            let mut got: Vec<Message> = fragments.iter().filter_map(|(_, f)| assembler.receive(7, f)).collect();
            got.sort_by_key(|message| message.sender & 7);
            prop_assert_eq!(got, whole);
        }

        #[test]
        fn a_flipped_bit_makes_no_other_message_and_does_no_lasting_harm(message in message(), payload in 2_usize..40) {
            let fragments = cut(&message, payload, 3);
            for bit in 0..fragments.iter().map(|fragment| fragment.len() * 8).sum() {
                let mut flipped = fragments.clone();
                let mut place = bit;
                for fragment in &mut flipped {
                    match fragment.get_mut(place / 8) {
                        Some(byte) => {
                            *byte ^= 1 << (place % 8);
                            break;
                        }
                        None => place -= fragment.len() * 8,
                    }
                }
                let mut assembler = Assembler::new();
                // Alone, a fragment with another number is the message all the same, and so it is with other bits behind
                // its end.
                let first = receive(&mut assembler, 0, &flipped);
                prop_assert!(first.is_empty() || (fragments.len() == 1 || payload == 2) && first == [message.clone()], "bit {}: {:?}", bit, first);
                let again: Vec<Message> = (1..=2).flat_map(|tick| receive(&mut assembler, tick, &fragments)).collect();
                prop_assert!(again.iter().all(|got| *got == message), "bit {}: {:?}", bit, again);
                prop_assert!(!(first.is_empty() && again.is_empty()), "bit {}", bit);
            }
        }

        #[test]
        fn nothing_that_is_heard_makes_it_panic(
            heard in proptest::collection::vec((any::<u32>(), proptest::collection::vec(any::<u8>(), 0..60)), 0..300),
        ) {
            let mut assembler = Assembler::new();
            for (tick, bytes) in heard {
                let _ = assembler.receive(tick, &bytes);
            }
        }
    }
}
