//! Enumerations whose values have names: on command lines, in files and in pictures' metadata.

/// Defines an enumeration; [`ALL`](crate::render::Model::ALL) lists its values, and each value has
/// a name. A macro of qrt's own crates.
#[doc(hidden)]
#[macro_export]
macro_rules! named {
    (
        $(#[$about:meta])*
        pub enum $Enum:ident {
            $($(#[$note:meta])* $Value:ident = $name:literal,)+
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $Enum {
            $($(#[$note])* $Value,)+
        }

        impl $Enum {
            /// All values, in the order of their definition.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$Value),+];

            /// The name of the value in text.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$Value => $name,)+
                }
            }
        }
    };
}
pub(crate) use named;
