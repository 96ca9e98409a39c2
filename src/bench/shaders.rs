//! What the build makes of `glsl/bench/`.

#![allow(clippy::unreadable_literal, reason = "written by the build")]

include!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/bench.rs"));
