//! Which number type a robot computes in, as a value.

use core::fmt;
use core::str::FromStr;
use serde::{Deserialize, Serialize};

/// A number type that robots compute in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum NumberType {
    /// IEEE-754 single precision.
    #[serde(rename = "f32")]
    F32,
    /// Fixed point, 24 fractional bits, for robots without a floating-point unit.
    #[serde(rename = "q8.24")]
    Q8_24,
}

impl NumberType {
    /// Both.
    pub const ALL: [NumberType; 2] = [NumberType::F32, NumberType::Q8_24];

    /// The name users type and read: `f32`, `q8.24`.
    pub const fn name(self) -> &'static str {
        match self {
            NumberType::F32 => "f32",
            NumberType::Q8_24 => "q8.24",
        }
    }
}

impl fmt::Display for NumberType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A text that names no [`NumberType`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownNumberType;

impl fmt::Display for UnknownNumberType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("f32 or q8.24 is needed")
    }
}

impl core::error::Error for UnknownNumberType {}

impl FromStr for NumberType {
    type Err = UnknownNumberType;

    fn from_str(text: &str) -> Result<Self, UnknownNumberType> {
        NumberType::ALL.into_iter().find(|number| number.name() == text).ok_or(UnknownNumberType)
    }
}
