//! SHA-256 over numbers, commands and bytes.

use core::fmt;
use grn_core::robot::{Command, Message, Millimetres};
use grn_core::scalar::{Q8_24, Scalar};
use sha2::{Digest as _, Sha256};

/// A number type whose values can be digested bit by bit.
pub trait Bits: Scalar {
    /// All bits of the value.
    fn bits(self) -> u32;
}

impl Bits for f32 {
    fn bits(self) -> u32 {
        self.to_bits()
    }
}

impl Bits for Q8_24 {
    fn bits(self) -> u32 {
        self.to_bits().cast_unsigned()
    }
}

/// A SHA-256 digest; displayed in hexadecimal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(pub [u8; 32]);

impl Digest {
    /// The digest in hexadecimal, two digits a byte.
    pub fn digits(&self) -> impl Iterator<Item = char> + '_ {
        let digit = |value: u8| char::from(if value < 10 { b'0' + value } else { b'a' + value - 10 });
        self.0.iter().flat_map(move |byte| [digit(byte >> 4), digit(byte & 15)])
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.digits().try_for_each(|digit| fmt::Write::write_char(f, digit))
    }
}

/// Takes in what is to be digested.
#[derive(Clone, Default)]
pub struct Hasher(Sha256);

impl Hasher {
    /// Takes bytes in as they are.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Takes a number in, least significant byte first.
    pub fn number<S: Bits>(&mut self, number: S) {
        self.bytes(&number.bits().to_le_bytes());
    }

    /// Takes a command in, with its message if it has one.
    pub fn command(&mut self, command: &Command) {
        self.bytes(&command.left.to_le_bytes());
        self.bytes(&command.right.to_le_bytes());
        self.bytes(&[u8::from(command.broadcast.is_some())]);
        if let Some(message) = &command.broadcast {
            self.message(message);
        }
    }

    fn message(&mut self, message: &Message) {
        self.bytes(&message.sender.to_le_bytes());
        self.bytes(&[u8::from(message.target.is_some()), message.obstacles.len() as u8]);
        self.position(message.position);
        if let Some(report) = &message.target {
            self.bytes(&[report.target, report.age]);
            self.position(report.position);
            self.bytes(&report.velocity.map(i8::cast_unsigned));
        }
        for report in &message.obstacles {
            self.bytes(&[report.age]);
            self.position(report.position);
        }
    }

    fn position(&mut self, Millimetres { x, y }: Millimetres) {
        self.bytes(&x.to_le_bytes());
        self.bytes(&y.to_le_bytes());
    }

    /// The digest of all that was taken in.
    pub fn finish(self) -> Digest {
        Digest(self.0.finalize().into())
    }
}
