//! Macros that define each part of a scene once: the Rust type, its decoder, its defaults, its
//! ranges, its encoder and its JSON Schema.

/// Defines a record: a map of known keys. A key `field: Type = shape;` is required; a key
/// `field: Type = shape, or default;` is optional. `finalize = f` names a function that is called
/// after reading, with the value and its node. `one_of = NAMES` makes the schema require exactly one
/// of these keys; `finalize` has to check the same.
macro_rules! record {
    (
        $(#[doc = $doc:literal])*
        #[derive($($derive:ident),*)]
        pub struct $name:ident = $noun:literal
            $(, finalize = $finalize:path)? $(, one_of = $one_of:expr)? ;
        $(
            $(#[doc = $field_doc:literal])*
            pub $field:ident : $type:ty = $shape:expr $(, or $default:expr)? ;
        )*
    ) => {
        $(#[doc = $doc])*
        #[derive($($derive),*)]
        pub struct $name {
            $( $(#[doc = $field_doc])* pub $field: $type, )*
        }

        impl $crate::scene::shape::Part for $name {
            fn decode(
                node: &qrt_syntax::tree::Node,
                at: &qrt_syntax::Place<'_>,
                problems: &mut qrt_syntax::Problems,
            ) -> Self {
                use $crate::scene::decode::Field;
                #[allow(unused_imports, reason = "a record of words alone needs one of them")]
                use $crate::scene::shape::{Part as _, Shape as _};
                const FIELDS: &[Field] = &[$(Field {
                    name: stringify!($field),
                    required: record!(@required $($default)?),
                }),*];
                if !$crate::scene::decode::record(problems, node, at, $noun, FIELDS) {
                    return Self::fallback();
                }
                let value = Self { $( $field: {
                    let at = at.key(stringify!($field));
                    match node.entry(stringify!($field)) {
                        Some(entry) => $shape.decode(&entry.value, &at, problems),
                        None => record!(@absent $shape, at, problems $(, $default)?),
                    }
                } ),* };
                $( let value = $finalize(value, node, at, problems); )?
                value
            }

            fn fallback() -> Self {
                use $crate::scene::shape::Shape as _;
                Self { $( $field: $shape.fallback() ),* }
            }

            fn check(
                &self,
                at: &qrt_syntax::Place<'_>,
                problems: &mut qrt_syntax::Problems,
            ) {
                use $crate::scene::shape::Shape as _;
                $( $shape.check(&self.$field, &at.key(stringify!($field)), problems); )*
            }

            fn encode(&self) -> $crate::scene::text::Data {
                use $crate::scene::shape::Shape as _;
                let mut entries = Vec::new();
                $( if let Some(value) = $shape.encode(&self.$field) {
                    entries.push((stringify!($field).to_owned(), value));
                } )*
                $crate::scene::text::Data::Map(entries)
            }

            fn schema() -> $crate::scene::text::Data {
                use $crate::scene::shape::Shape as _;
                let schema = $crate::scene::shape::record_schema(concat!($($doc),*), vec![$(
                    $crate::scene::shape::FieldSchema {
                        name: stringify!($field),
                        doc: concat!($($field_doc),*),
                        is_required: record!(@required $($default)?),
                        shape: $shape.schema(),
                        default: record!(@default $type, $shape $(, $default)?),
                    }
                ),*]);
                $( let schema = $crate::scene::shape::one_of(schema, $one_of); )?
                schema
            }
        }

        #[cfg(feature = "serde")]
        $crate::scene::serde::part!($name);
    };

    (@required) => { true };
    (@required $default:expr) => { false };

    (@absent $shape:expr, $at:ident, $problems:ident) => {{
        $problems.mark($at.path());
        $shape.fallback()
    }};
    (@absent $shape:expr, $at:ident, $problems:ident, $default:expr) => { $default };

    (@default $type:ty, $shape:expr) => { None };
    (@default $type:ty, $shape:expr, $default:expr) => {{
        let default: $type = $default;
        $shape.encode(&default)
    }};
}

/// Defines a variant: a map with exactly one of the keys, each with a part as its value.
macro_rules! variant {
    (
        $(#[doc = $doc:literal])*
        #[derive($($derive:ident),*)]
        pub enum $name:ident = $noun:literal;
        $( $(#[doc = $kind_doc:literal])* $kind:ident($part:ty) = $key:literal; )*
    ) => {
        $(#[doc = $doc])*
        #[derive($($derive),*)]
        pub enum $name {
            $( $(#[doc = $kind_doc])* $kind($part), )*
        }

        impl $name {
            /// The names of the kinds in a scene.
            pub const NAMES: &'static [&'static str] = &[$($key),*];

            /// The name of this kind in a scene.
            pub const fn kind(&self) -> &'static str {
                match self { $( Self::$kind(_) => $key, )* }
            }
        }

        $( impl From<$part> for $name {
            fn from(part: $part) -> Self {
                Self::$kind(part)
            }
        } )*

        impl $crate::scene::shape::Part for $name {
            fn decode(
                node: &qrt_syntax::tree::Node,
                at: &qrt_syntax::Place<'_>,
                problems: &mut qrt_syntax::Problems,
            ) -> Self {
                match $crate::scene::decode::variant(problems, node, at, $noun, Self::NAMES) {
                    $( Some(($key, node)) => {
                        let part = <$part as $crate::scene::shape::Part>::decode(
                            node, &at.key($key), problems,
                        );
                        Self::$kind(part)
                    } )*
                    _ => Self::fallback(),
                }
            }

            #[allow(unreachable_code)]
            fn fallback() -> Self {
                // The first kind is the fallback.
                $( return Self::$kind($crate::scene::shape::Part::fallback()); )*
            }

            fn check(
                &self,
                at: &qrt_syntax::Place<'_>,
                problems: &mut qrt_syntax::Problems,
            ) {
                match self {
                    $( Self::$kind(part) => {
                        $crate::scene::shape::Part::check(part, &at.key($key), problems);
                    } )*
                }
            }

            fn encode(&self) -> $crate::scene::text::Data {
                match self {
                    $( Self::$kind(part) => $crate::scene::text::Data::map([
                        ($key, $crate::scene::shape::Part::encode(part)),
                    ]), )*
                }
            }

            fn schema() -> $crate::scene::text::Data {
                $crate::scene::shape::variant_schema(concat!($($doc),*), vec![$((
                    $key,
                    concat!($($kind_doc),*),
                    <$part as $crate::scene::shape::Part>::schema(),
                )),*])
            }
        }

        #[cfg(feature = "serde")]
        $crate::scene::serde::part!($name);
    };
}

/// Defines a keyword: one of several words.
macro_rules! keyword {
    (
        $(#[doc = $doc:literal])*
        pub enum $name:ident = $noun:literal;
        $( $(#[doc = $word_doc:literal])* $word:ident = $text:literal; )*
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $name {
            $( $(#[doc = $word_doc])* $word, )*
        }

        impl $name {
            /// All words of the keyword, in the order of their definition.
            pub const ALL: &'static [Self] = &[$(Self::$word),*];
            /// Their names in scenes, in the order of [`Self::ALL`].
            pub const NAMES: &'static [&'static str] = &[$($text),*];

            /// The word's name in a scene.
            pub const fn name(self) -> &'static str {
                match self { $( Self::$word => $text, )* }
            }

            /// The word whose name in a scene is `name`; `None` if there is none.
            pub fn from_name(name: &str) -> Option<Self> {
                match name { $( $text => Some(Self::$word), )* _ => None }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl $crate::scene::shape::Keyword for $name {
            const NOUN: &'static str = $noun;
            const NAMES: &'static [&'static str] = Self::NAMES;
            const DOCS: &'static [&'static str] = &[$(concat!($($word_doc),*)),*];
            const VALUES: &'static [Self] = Self::ALL;
        }
    };
}

pub(crate) use {keyword, record, variant};
