//! The kinds of missions.

/// What stands in the way of a mission's targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
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
