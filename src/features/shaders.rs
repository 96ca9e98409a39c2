//! What the build makes of `glsl/features/`.

#![allow(dead_code, clippy::unreadable_literal, reason = "written by the build")]

include!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features.rs"));
