//! What a body is drawn as.

use anyhow::{Result, bail};

use crate::body::{Body, Mesh};

/// The model of a body that candidates are drawn with, as `--model` names it (SPEC A4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Model {
    /// Truncated cones as flat quadrilaterals with one depth each.
    #[default]
    Flat,
    /// The mesh that the body's `[mesh]` names, or elliptic frusta of 66 vertices; with a depth a pixel.
    Mesh,
}

impl Model {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Flat, Self::Mesh];

    /// The mesh that a body is drawn as; none for the flat model.
    ///
    /// # Errors
    /// As [`Mesh::of_body`].
    pub fn mesh(self, body: &Body) -> Result<Option<Mesh>> {
        match self {
            Self::Flat => Ok(None),
            Self::Mesh => Mesh::of_body(body).map(Some),
        }
    }

    /// The name as `--model` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Mesh => "mesh",
        }
    }

    /// The model of that name.
    ///
    /// # Errors
    /// When there is none; the sentence names those there are.
    pub fn from_name(name: &str) -> Result<Self> {
        match Self::ALL.into_iter().find(|model| model.name() == name) {
            Some(model) => Ok(model),
            None => bail!("there is no model `{name}`, expected one of {}", Self::ALL.map(Self::name).join(", ")),
        }
    }
}
