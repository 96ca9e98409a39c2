//! What the build makes of `glsl/features/`.

#![allow(dead_code, clippy::unreadable_literal, reason = "written by the build")]

include!(concat!(env!("OUT_DIR"), "/features_stages.rs"));
