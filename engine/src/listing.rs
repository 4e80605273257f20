//! Lists of facts: enumerations and sets of flags, each defined once with all that is told of it.
//!
//! An entry has a name, its doc comment, which is its description, and every field of the list's
//! facts. What shows, parses or documents such a list iterates over it. An entry that lacks a fact, a
//! number or key that stands twice, and a flag out of the order of its bits do not compile.

/// Defines an enum, what is told of each variant, `ALL`, `KEYS` and `from_key`.
///
/// The facts are a struct with `key`, `description`, and whatever else the entries name.
#[macro_export]
macro_rules! enumeration {
    (
        $(#[$about:meta])*
        pub enum $Name:ident tells $Facts:ident {
            $(
                $(#[doc = $description:literal])+
                $Variant:ident $(= $number:literal)? { $($fact:ident: $value:expr),+ $(,)? }
            )+
        }
    ) => {
        $(#[$about])*
        pub enum $Name {
            $($(#[doc = $description])+ $Variant $(= $number)?,)+
        }

        impl $Name {
            /// All of them, in the order of the list.
            pub const ALL: &'static [Self] = &[$(Self::$Variant),+];

            /// Their keys, in the same order.
            pub const KEYS: &'static [&'static str] = &[$(Self::$Variant.facts().key),+];

            /// What is told of it.
            pub const fn facts(self) -> &'static $Facts {
                match self {
                    $(Self::$Variant => {
                        const FACTS: $Facts = $Facts {
                            description: concat!($($description),+).trim_ascii(),
                            $($fact: $value),+
                        };
                        &FACTS
                    })+
                }
            }

            /// The one with this key, if there is one.
            pub fn from_key(key: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|known| known.facts().key == key)
            }
        }

        const _: () = assert!($crate::listing::are_distinct($Name::KEYS), "a key stands twice");
    };
}

/// Defines a set of flags over a recorded `u64`, what is told of each flag, `FACTS`, `KEYS`,
/// `from_key`, and the words of the flags that are set as its `Display`.
///
/// The facts are a struct with `flag`, `key`, `words`, `description`, and whatever else the entries
/// name. Bits without a name, of a newer log, are kept.
macro_rules! flags {
    (
        $(#[$about:meta])*
        pub struct $Name:ident tells $Facts:ident {
            $(
                $(#[doc = $description:literal])+
                $FLAG:ident = $bit:literal { $($fact:ident: $value:expr),+ $(,)? }
            )+
        }
    ) => {
        $(#[$about])*
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize,
        )]
        #[serde(transparent)]
        pub struct $Name(u64);

        bitflags::bitflags! {
            impl $Name: u64 {
                $($(#[doc = $description])+ const $FLAG = 1 << $bit;)+
            }
        }

        impl $Name {
            /// What is told of each flag, in the order of the bits.
            pub const FACTS: &'static [$Facts] = &[$($Facts {
                flag: Self::$FLAG,
                description: concat!($($description),+).trim_ascii(),
                $($fact: $value),+
            }),+];

            /// The keys, in the same order.
            pub const KEYS: &'static [&'static str] = &{
                let mut keys = [""; Self::FACTS.len()];
                let mut i = 0;
                while i < keys.len() {
                    keys[i] = Self::FACTS[i].key;
                    i += 1;
                }
                keys
            };

            /// The flag with this key, if there is one.
            pub fn from_key(key: &str) -> Option<Self> {
                Self::FACTS.iter().find(|known| known.key == key).map(|known| known.flag)
            }

            /// What is told of those that are set, in the order of the bits.
            pub fn told(self) -> impl Iterator<Item = &'static $Facts> {
                Self::FACTS.iter().filter(move |known| self.contains(known.flag))
            }
        }

        /// The words of those that are set, or `nothing`.
        impl core::fmt::Display for $Name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                $crate::listing::write_words(f, self.told().map(|known| known.words))
            }
        }

        const _: () = {
            let mut i = 1;
            while i < $Name::FACTS.len() {
                let (before, here) = (&$Name::FACTS[i - 1], &$Name::FACTS[i]);
                assert!(before.flag.bits() < here.flag.bits(), "flags stand by their bits");
                i += 1;
            }
            assert!($crate::listing::are_distinct($Name::KEYS), "a key stands twice");
        };
    };
}
pub(crate) use flags;

/// Whether no key stands twice; compared when the list is compiled.
pub const fn are_distinct(keys: &[&str]) -> bool {
    let mut i = 0;
    while i < keys.len() {
        let mut j = i + 1;
        while j < keys.len() {
            if are_same(keys[i].as_bytes(), keys[j].as_bytes()) {
                return false;
            }
            j += 1;
        }
        i += 1;
    }
    true
}

const fn are_same(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

/// Words with commas between them; `nothing` where there are none.
pub(crate) fn write_words(
    f: &mut core::fmt::Formatter<'_>,
    words: impl Iterator<Item = &'static str>,
) -> core::fmt::Result {
    let mut first = true;
    for word in words {
        f.write_str(if first { "" } else { ", " })?;
        f.write_str(word)?;
        first = false;
    }
    if first { f.write_str("nothing") } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::are_distinct;

    #[test]
    fn a_key_that_stands_twice_is_found() {
        assert!(are_distinct(&["speed", "height", "rotor_speed", "spee", ""]));
        assert!(!are_distinct(&["speed", "height", "speed"]));
    }
}
