//! Sizes and offsets of all structures, checked while this crate is compiled; the header's assertions are made from them.
//!
//! A structure of the header never changes in a released version, and none has padding.

use crate::message::{
    GrnCommand, GrnFix, GrnHeard, GrnMessage, GrnMillimetres, GrnObstacleReport, GrnPercept, GrnSighting,
    GrnTargetReport,
};
use core::mem::offset_of;

/// A structure of the header.
#[derive(Debug)]
pub struct Layout {
    /// Its name in C.
    pub name: &'static str,
    /// Its bytes.
    pub size: usize,
    /// Its fields in order, each with its offset.
    pub fields: &'static [(&'static str, usize)],
}

/// The size of a field.
const fn size_of_field<S, F>(_: fn(&S) -> &F) -> usize {
    size_of::<F>()
}

macro_rules! layouts {
    ($($structure:ident $size:literal { $($field:ident $offset:literal),* })*) => {
        /// All structures that C code sees the fields of.
        pub const LAYOUTS: &[Layout] = &[$(Layout {
            name: stringify!($structure),
            size: $size,
            fields: &[$((stringify!($field), $offset)),*],
        }),*];

        $(const _: () = {
            // Every field is named, so that a new one is missed here.
            let _ = |value: $structure| { let $structure { $($field: _),* } = value; };
            let mut end = 0;
            $(
                assert!(offset_of!($structure, $field) == $offset, "a field of a released structure has moved");
                assert!(end == $offset, "padding before a field: put a reserved one there");
                end += size_of_field(|value: &$structure| &value.$field);
            )*
            assert!(end == size_of::<$structure>(), "padding at the end: put a reserved field there");
            assert!($size == size_of::<$structure>(), "a released structure has another size");
        };)*
    };
}

layouts! {
    GrnMillimetres 4 { x 0, y 2 }
    GrnSighting 6 { target 0, reserved 1, position 2 }
    GrnTargetReport 10 { target 0, reserved0 1, position 2, velocity 6, age 8, reserved1 9 }
    GrnObstacleReport 6 { position 0, age 4, reserved 5 }
    GrnMessage 44 {
        sender 0, position 2, has_target 6, reserved0 7, target 8, obstacle_count 18, reserved1 19, obstacles 20
    }
    GrnHeard 46 { message 0, age_ms 44 }
    GrnFix 16 { position 0, heading 8, age_ms 12, reserved 14 }
    GrnPercept 464 {
        elapsed_us 0, fix 4, proximity 20, has_fix 36, target_count 37, targets 38, obstacle_count 62, heard_count 63,
        obstacles 64, heard 96
    }
    GrnCommand 50 { left 0, right 2, has_broadcast 4, reserved 5, broadcast 6 }
}
