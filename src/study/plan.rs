//! The runs of a study.

use std::fmt;
use std::str::FromStr;

use anyhow::{Result, bail};
use serde::{Deserialize, Serialize};

use super::settings::Study;
use crate::body::{Body, FrustumBase, MeshSource};
use crate::track;

/// What the body is drawn as in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
#[serde(try_from = "String", into = "String")]
pub enum Model {
    /// Flat cones.
    Flat,
    /// The mesh of the body's file.
    Mesh,
    /// Frusta generated from the body's parts, whatever mesh its file names.
    Frusta(FrustumBase),
}

impl Model {
    /// How the tracker calls it.
    pub(super) fn tracked(self) -> track::Model {
        match self {
            Self::Flat => track::Model::Flat,
            Self::Mesh | Self::Frusta(_) => track::Model::Mesh,
        }
    }

    /// The body to be drawn so, where that is not the body as it is.
    pub(super) fn dressed(self, body: &Body) -> Option<Body> {
        match self {
            Self::Flat | Self::Mesh => None,
            Self::Frusta(base) => {
                // Parts that the file flattens stay so.
                let flattening = match &body.mesh {
                    Some(MeshSource::Frusta { flattening, .. }) => flattening.clone(),
                    _ => Default::default(),
                };
                Some(Body { mesh: Some(MeshSource::Frusta { base, flattening }), ..body.clone() })
            }
        }
    }
}

impl fmt::Display for Model {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flat => write!(out, "flat"),
            Self::Mesh => write!(out, "mesh"),
            Self::Frusta(FrustumBase::Square) => write!(out, "square"),
            Self::Frusta(FrustumBase::Elliptic { vertices }) => write!(out, "elliptic-{vertices}"),
        }
    }
}

impl FromStr for Model {
    type Err = anyhow::Error;

    fn from_str(name: &str) -> Result<Self> {
        let rungs = FrustumBase::LADDER.map(|vertices| Self::Frusta(FrustumBase::Elliptic { vertices }));
        let known = [Self::Flat, Self::Mesh, Self::Frusta(FrustumBase::Square)].into_iter().chain(rungs);
        let named = known.clone().find(|model| model.to_string() == name);
        let Some(model) = named else {
            let names: Vec<String> = known.map(|model| model.to_string()).collect();
            bail!("there is no model {name:?}, expected one of {}", names.join(", "));
        };
        Ok(model)
    }
}

impl TryFrom<String> for Model {
    type Error = anyhow::Error;

    fn try_from(name: String) -> Result<Self> {
        name.parse()
    }
}

impl From<Model> for String {
    fn from(model: Model) -> Self {
        model.to_string()
    }
}

/// One run: everything that decides what it yields.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// The sequence's name.
    pub sequence: String,
    /// Who scores the poses.
    pub backend: String,
    /// What the body is drawn as.
    pub model: Model,
    /// The objective function.
    pub objective: String,
    /// How poses are searched.
    pub search: String,
    /// Poses scored at once.
    pub particles: usize,
    /// Times that many poses are scored a frame.
    pub iterations: usize,
    /// The seed of the search.
    pub seed: u64,
    /// Which frames, `A..B`.
    pub frames: String,
    /// Factor on the width of the search round the previous pose.
    pub spread: f64,
}

impl Run {
    /// The name of its folder.
    pub fn folder(&self) -> String {
        let Self { sequence, backend, model, objective, search, particles, iterations, seed, .. } = self;
        format!("{sequence}_{backend}_{model}_{objective}_{search}_{particles}x{iterations}_seed{seed}")
    }
}

impl Study {
    /// Every run. All settings of one seed come before the next seed, so that a study that is stopped midway has something
    /// to say about each.
    ///
    /// # Errors
    /// When a sequence's frames are no range.
    pub fn runs(&self) -> Result<Vec<Run>> {
        let mut runs = Vec::new();
        for &seed in &self.seeds {
            for sequence in &self.sequences {
                let (name, frames) = (sequence.name(), sequence.frames()?.to_string());
                let spread = sequence.spread.unwrap_or(self.spread);
                for backend in &self.backends {
                    for &model in &self.models {
                        for objective in &self.objectives {
                            for search in &self.searches {
                                for &particles in &self.particles {
                                    for &iterations in &self.iterations {
                                        runs.push(Run {
                                            sequence: name.clone(),
                                            backend: backend.clone(),
                                            model,
                                            objective: objective.clone(),
                                            search: search.clone(),
                                            particles,
                                            iterations,
                                            seed,
                                            frames: frames.clone(),
                                            spread,
                                        });
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
        Ok(runs)
    }
}
