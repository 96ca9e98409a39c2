//! What the build makes of `glsl/synth/`.

#![allow(clippy::unreadable_literal, reason = "written by the build")]

include!(concat!(env!("OUT_DIR"), "/synth_stages.rs"));
