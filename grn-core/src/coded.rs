//! Enums whose variants stand in files and messages: one table, from which both directions come.

/// An enum whose variants have numeric codes, which never change once released, and names for people and text files.
macro_rules! coded {
    (
        $(#[$attribute:meta])*
        pub enum $name:ident {
            $($(#[$about:meta])* $variant:ident = ($code:literal, $text:literal)),+ $(,)?
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
        #[repr(u8)]
        pub enum $name {
            $($(#[$about])* #[serde(rename = $text)] $variant = $code),+
        }

        impl $name {
            /// All of them, in the order of their codes.
            pub const ALL: [$name; [$($code),+].len()] = [$($name::$variant),+];

            /// The numeric code, as in blobs.
            pub const fn code(self) -> u8 {
                self as u8
            }

            /// The one with this code, if there is one.
            pub const fn from_code(code: u8) -> Option<$name> {
                match code {
                    $($code => Some($name::$variant),)+
                    _ => None,
                }
            }

            /// Its name in text.
            pub const fn name(self) -> &'static str {
                match self {
                    $($name::$variant => $text),+
                }
            }
        }
    };
}
pub(crate) use coded;
