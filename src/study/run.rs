//! A run of a study and the folder it has.

use serde::{Deserialize, Serialize};

use super::pace::Pace;
use crate::body::Model;
use crate::evaluate::ObjectiveKind;
use crate::search::SearchKind;
use crate::track::{Drawing, Passes};

/// What stands for the objective that `track` takes by itself.
pub(super) const USUAL: &str = "usual";

/// One run: everything that decides what it yields.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// The sequence's name.
    pub sequence: String,
    /// Who scores the poses, and how.
    pub backend: Drawing,
    /// What the body is drawn as.
    pub model: Model,
    /// The objective function, if not the one that `track` takes for this search and sequence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objective: Option<ObjectiveKind>,
    /// How poses are searched.
    pub search: SearchKind,
    /// Poses scored at once.
    pub particles: usize,
    /// Times that many poses are scored a frame.
    pub iterations: usize,
    /// How it keeps time.
    #[serde(default, skip_serializing_if = "Pace::is_usual")]
    pub pace: Pace,
    /// The seed of the search.
    pub seed: u64,
    /// Which frames, `A..B`.
    pub frames: String,
    /// Factor on the width of the search round the previous pose.
    pub spread: f64,
    /// How often it goes over its frames, if not as it suits the search.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub passes: Option<Passes>,
}

impl Run {
    /// The name of its objective function.
    pub(super) fn objective_name(&self) -> &'static str {
        self.objective.map_or(USUAL, ObjectiveKind::name)
    }

    /// Its folder within the study's.
    pub fn place(&self) -> String {
        format!("runs/{}", self.folder())
    }

    /// The name of its folder.
    pub fn folder(&self) -> String {
        let objective = self.objective_name();
        let Self { sequence, backend, model, search, particles, iterations, seed, .. } = self;
        let pace = if self.pace.is_usual() { String::new() } else { format!("_{}", self.pace) };
        format!("{sequence}_{backend}_{model}_{objective}_{search}_{particles}x{iterations}{pace}_seed{seed}")
    }
}
