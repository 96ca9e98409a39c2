//! What the build makes of `glsl/synth/`.

#![allow(clippy::unreadable_literal, reason = "written by the build")]

include!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/synth.rs"));
