//! The kinds of missions.

use std::fmt;
use std::str::FromStr;

/// What stands in the way of a mission's targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Two long walls.
    Corridor,
    /// One to three doors in thin walls.
    Door,
    /// Three to eight discs on both sides of the way.
    Columns,
    /// A block around whose edge the way goes.
    Corner,
    /// A door whose leaves slide to and fro.
    SlidingDoor,
    /// A bar that sweeps to and fro about a hinge beside the way.
    SweepingBar,
    /// A disc that comes along the way against the targets, beside it.
    DriftingDisc,
}

impl Class {
    /// All of them.
    pub const ALL: [Class; 7] = [
        Class::Corridor,
        Class::Door,
        Class::Columns,
        Class::Corner,
        Class::SlidingDoor,
        Class::SweepingBar,
        Class::DriftingDisc,
    ];

    /// Its name in options, tables and names of files.
    pub const fn name(self) -> &'static str {
        match self {
            Class::Corridor => "corridor",
            Class::Door => "door",
            Class::Columns => "columns",
            Class::Corner => "corner",
            Class::SlidingDoor => "sliding-door",
            Class::SweepingBar => "sweeping-bar",
            Class::DriftingDisc => "drifting-disc",
        }
    }
}

/// No class has this name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownClass;

impl fmt::Display for UnknownClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "must be one of {}", Class::ALL.map(Class::name).join(", "))
    }
}

impl std::error::Error for UnknownClass {}

impl FromStr for Class {
    type Err = UnknownClass;

    fn from_str(name: &str) -> Result<Class, UnknownClass> {
        Class::ALL.into_iter().find(|class| class.name() == name).ok_or(UnknownClass)
    }
}
