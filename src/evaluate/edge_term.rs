//! What the edge term of an objective is made of (METHOD A7).

use crate::files::choices;

choices! {
    /// What the edge term is made of where observations tell body parts apart.
    #[derive(Default)]
    "edge term" pub enum EdgeTerm {
        /// All edges of the candidate together (the default).
        "whole" #[default] Whole,
        /// The edges of each segment by themselves, weighed as the silhouettes of the segments are.
        "segments" Segments,
    }
}
