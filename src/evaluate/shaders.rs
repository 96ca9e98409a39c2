//! What the build makes of `glsl/evaluate/`: bindings, layouts and the numbers that both sides share.

#![allow(
    dead_code,
    clippy::unreadable_literal,
    clippy::large_stack_arrays,
    reason = "written by the build; the variants of a stage are bound through one of them"
)]

include!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate.rs"));

const _: () = assert!(LARGEST_SIDE == crate::geometry::LARGEST_SIDE, "pictures are as large as stages count");
const _: () = assert!(FARTHEST_PIXEL == LARGEST_SIDE as f32, "corners go as far as pictures do");
const _: () = assert!(crate::features::Evidence::NEUTRAL == EVIDENCE_NEUTRAL, "codes mean the same to the stages");
const _: () = assert!(
    crate::features::Segments::MOST == MOST_SEGMENTS as usize,
    "the stages have as many segments as observations may"
);
