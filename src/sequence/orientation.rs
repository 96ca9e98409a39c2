//! How the stored pictures of a view are turned.

use serde::Deserialize;

use super::footage::Footage;
use super::turn::Turn;
use crate::files::choices;

choices! {
    /// How the stored pictures of a view are turned when they are read.
    "orientation" pub enum Orientation {
        /// Turned as a video is marked to be for display, as players and OpenCV show it.
        "upright" Upright,
        /// As they are stored.
        "stored" Stored,
        /// As they are stored, turned clockwise by 90 degrees.
        "90" Clockwise,
        /// As they are stored, turned by 180 degrees.
        "180" Half,
        /// As they are stored, turned clockwise by 270 degrees.
        "270" Counterclockwise,
        /// As they are stored, left for right.
        "mirrored" Mirrored,
    }
}

impl Orientation {
    /// How stored pictures are turned, where that does not depend on the file.
    pub(crate) fn turn(self) -> Option<Turn> {
        match self {
            Self::Upright => None,
            Self::Stored => Some(Turn::None),
            Self::Clockwise => Some(Turn::Clockwise),
            Self::Half => Some(Turn::Half),
            Self::Counterclockwise => Some(Turn::Counterclockwise),
            Self::Mirrored => Some(Turn::Mirrored),
        }
    }

    /// The orientation in which stored pictures are turned so.
    pub(crate) fn of(turn: Turn) -> Option<Self> {
        Self::ALL.into_iter().find(|orientation| orientation.turn() == Some(turn))
    }

    /// As a manifest has it: degrees as a number.
    pub(crate) fn value(self) -> toml::Value {
        let name = self.name();
        name.parse::<i64>().map_or_else(|_| name.into(), toml::Value::from)
    }

    /// Footage as a view wants it: as its manifest says, else as it fits the size that a camera is calibrated for, else upright.
    pub(crate) fn orient(own: Option<Self>, footage: Footage, size: Option<[u32; 2]>) -> Footage {
        match (own.map(Self::turn), size) {
            (Some(Some(turn)), _) => footage.put(turn),
            (None, Some(size)) => footage.fitting(size),
            _ => footage,
        }
    }
}

/// An orientation by its name, which may be a number.
pub(super) fn number_or_name<'de, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Orientation>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Written {
        Number(i64),
        Name(String),
    }
    let name = match Written::deserialize(deserializer)? {
        Written::Number(number) => number.to_string(),
        Written::Name(name) => name,
    };
    Orientation::from_name(&name).map(Some).map_err(serde::de::Error::custom)
}
