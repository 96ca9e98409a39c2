//! The flags that choose an objective function, shared by the commands that score poses.

use crate::evaluate::{EdgeTerm, ObjectiveKind};
use crate::track::ObjectiveChoice;

/// Flags over a sequence's `[objective]` table over the defaults.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct ObjectiveFlags {
    /// The objective function [default: the sequence's, else evidence for `fit` and, by `maes` off line, for `track`, sp for
    /// all else].
    #[arg(long, value_name = "NAME")]
    objective: Option<ObjectiveKind>,
    /// Share of "observed silhouette covered" against "drawn silhouette on the observed one" [default: 0.5].
    #[arg(long, value_name = "F")]
    beta: Option<f32>,
    /// Weight, or exponent, of the silhouette [default: 0.5; of evidence 0.75].
    #[arg(long, value_name = "F")]
    w1: Option<f32>,
    /// Weight, or exponent, of the edges [default: 0.5; beside evidence 0.25].
    #[arg(long, value_name = "F")]
    w2: Option<f32>,
    /// What the edge term is made of where [[features.segment]] tells body parts apart [default: whole].
    #[arg(long, value_name = "NAME")]
    edges: Option<EdgeTerm>,
}

impl ObjectiveFlags {
    /// What they choose.
    pub(super) fn choice(&self) -> ObjectiveChoice {
        ObjectiveChoice { kind: self.objective, beta: self.beta, w1: self.w1, w2: self.w2, edges: self.edges }
    }
}
