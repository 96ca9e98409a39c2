//! What users choose by name. A list is declared once, by [`choices!`]: each choice with its name and a line of help, from which
//! command lines, files, messages and docs/CHOICES.md take what they say of it.

use std::ffi::OsStr;
use std::fmt;
use std::marker::PhantomData;

use anyhow::{Error, Result, anyhow};
use clap::builder::{PossibleValue, TypedValueParser};
use serde::de::{Deserializer, Visitor};

use super::{listed, shortened};

/// One of a list of choices that have names.
pub trait Choice: Copy + Send + Sync + 'static {
    /// What is chosen, as messages call it: `backend`.
    const WHAT: &'static str;
    /// Every choice with its name and its line of help, in the order they are listed.
    const CHOICES: &'static [(Self, &'static str, &'static str)];

    /// The choice of that name.
    ///
    /// # Errors
    /// As [`unknown`].
    fn named(name: &str) -> Result<Self> {
        let found = Self::CHOICES.iter().find(|(_, known, _)| *known == name);
        found.map(|(choice, ..)| *choice).ok_or_else(|| unknown(Self::WHAT, name, &names::<Self>()))
    }
}

/// The names of a list.
pub fn names<T: Choice>() -> Vec<&'static str> {
    T::CHOICES.iter().map(|(_, name, _)| *name).collect()
}

/// The known name that is most like `found`, of equals the first; none where nothing is known.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // The distance takes memory as the product of both lengths.
    let found = shortened(found);
    known.into_iter().min_by_key(|name| strsim::damerau_levenshtein(&found, name))
}

/// The sentence for a name that is not known.
pub fn unknown(what: &str, found: &str, known: &[&str]) -> Error {
    let nearest = nearest(found, known.iter().copied()).unwrap_or("none");
    anyhow!("unknown {what} `{}`, the nearest is `{nearest}` (known: {})", shortened(found), listed(known))
}

/// What to say after an unknown name: the nearest known one and the list, which is cut when it is long.
pub fn expected(found: &str, known: &[&str]) -> String {
    let Some(nearest) = nearest(found, known.iter().copied()) else {
        return "expected none".to_string();
    };
    format!("the nearest known one is `{}` (known: {})", shortened(nearest), listed(known))
}

/// Reads a choice by its name out of any file.
///
/// # Errors
/// As [`Choice::named`].
pub fn deserialize<'de, T: Choice, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    struct Name<T>(PhantomData<T>);

    impl<T: Choice> Visitor<'_> for Name<T> {
        type Value = T;

        fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(out, "the name of a {}: {}", T::WHAT, names::<T>().join(", "))
        }

        fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<T, E> {
            T::named(name).map_err(E::custom)
        }
    }

    deserializer.deserialize_str(Name(PhantomData))
}

/// Reads a choice by its name off a command line, whose help lists them all.
#[derive(Clone, Copy, Debug)]
pub struct ChoiceParser<T>(PhantomData<T>);

impl<T> ChoiceParser<T> {
    /// The parser.
    pub fn new() -> Self {
        Self(PhantomData)
    }
}

impl<T> Default for ChoiceParser<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Choice> TypedValueParser for ChoiceParser<T> {
    type Value = T;

    fn parse_ref(&self, command: &clap::Command, arg: Option<&clap::Arg>, value: &OsStr) -> Result<T, clap::Error> {
        T::named.parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(T::CHOICES.iter().map(|(_, name, help)| PossibleValue::new(name).help(help.trim_start()))))
    }
}

/// Declares an enumeration of choices: what is chosen, then each with its line of help (its documentation), its name, its
/// attributes and its variant. With `=> method: Type` every choice has a value of that type too, which the method gives.
macro_rules! choices {
    (
        $(#[$attribute:meta])*
        $what:literal $visibility:vis enum $type:ident {
            $($(#[doc = $help:literal])+ $name:literal $(#[$mark:meta])* $variant:ident,)+
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        $visibility enum $type {
            $($(#[doc = $help])+ $(#[$mark])* $variant,)+
        }

        #[allow(dead_code, reason = "not everybody who chooses needs all of it")]
        impl $type {
            /// All of them, in the order they are listed.
            $visibility const ALL: [Self; [$($name),+].len()] = [$(Self::$variant),+];

            /// Its name, as command lines and files write it.
            $visibility const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }

            /// The choice of that name.
            ///
            /// # Errors
            /// One sentence with the nearest name and all names, where there is none.
            $visibility fn from_name(name: &str) -> anyhow::Result<Self> {
                $crate::files::Choice::named(name)
            }
        }

        impl $crate::files::Choice for $type {
            const WHAT: &'static str = $what;
            const CHOICES: &'static [(Self, &'static str, &'static str)] =
                &[$((Self::$variant, $name, concat!($($help),+))),+];
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                out.pad(self.name())
            }
        }

        impl serde::Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> serde::Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
                $crate::files::deserialize_choice(deserializer)
            }
        }

        impl clap::builder::ValueParserFactory for $type {
            type Parser = $crate::files::ChoiceParser<Self>;

            fn value_parser() -> Self::Parser {
                $crate::files::ChoiceParser::new()
            }
        }
    };
    (
        $(#[$attribute:meta])*
        $what:literal $visibility:vis enum $type:ident => $reach:vis $method:ident: $made:ty {
            $($(#[doc = $help:literal])+ $name:literal $(#[$mark:meta])* $variant:ident => $value:expr,)+
        }
    ) => {
        $crate::files::choices! {
            $(#[$attribute])*
            $what $visibility enum $type {
                $($(#[doc = $help])+ $name $(#[$mark])* $variant,)+
            }
        }

        impl $type {
            /// What it stands for.
            $reach fn $method(self) -> $made {
                match self {
                    $(Self::$variant => $value),+
                }
            }
        }
    };
}
pub(crate) use choices;

#[cfg(test)]
mod tests {
    use clap::Parser;

    choices! {
        /// A colour.
        #[derive(Default)]
        "colour" enum Colour => number: u32 {
            /// As blood.
            "red" Red => 3,
            /// As the sky,
            /// by day.
            "blue" #[default] Blue => 5,
        }
    }

    #[derive(Parser, Debug)]
    struct Arguments {
        #[arg(long, default_value_t)]
        colour: Colour,
    }

    const SENTENCE: &str = "unknown colour `rad`, the nearest is `red` (known: red, blue)";

    #[test]
    fn one_list_serves_everybody() {
        assert_eq!(Colour::ALL.map(Colour::name), ["red", "blue"]);
        assert_eq!(Colour::ALL.map(|colour| colour.number()), [3, 5]);
        assert_eq!(Colour::from_name("blue").unwrap(), Colour::default());
        assert_eq!(Colour::from_name("rad").unwrap_err().to_string(), SENTENCE);
        assert_eq!(format!("{:>5}", Colour::Red), "  red");
        let table: toml::Table = toml::from_str("a = 'red'\nb = 'rad'\nc = 1").unwrap();
        let read = |key: &str| table[key].clone().try_into::<Colour>().map_err(|error| error.to_string());
        assert_eq!(read("a"), Ok(Colour::Red));
        assert_eq!(read("b").unwrap_err().trim(), SENTENCE);
        assert!(read("c").unwrap_err().contains("the name of a colour: red, blue"), "{}", read("c").unwrap_err());
        assert_eq!(toml::Value::try_from(Colour::Blue).unwrap().as_str(), Some("blue"));
    }

    #[test]
    fn the_command_line_lists_and_checks() {
        let colour = |arguments: &[&str]| Arguments::try_parse_from(arguments).map(|it| it.colour);
        assert_eq!(colour(&["x"]).unwrap(), Colour::Blue);
        assert_eq!(colour(&["x", "--colour", "red"]).unwrap(), Colour::Red);
        let error = colour(&["x", "--colour", "rad"]).unwrap_err().to_string();
        assert!(error.contains(SENTENCE), "{error}");
        let help = colour(&["x", "--help"]).unwrap_err().to_string();
        assert!(help.contains("- red:") && help.contains("As the sky, by day."), "{help}");
    }
}
