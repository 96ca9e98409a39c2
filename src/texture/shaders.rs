//! What the build makes of `glsl/texture/`.

#![allow(clippy::unreadable_literal, reason = "written by the build")]

include!(concat!(env!("OUT_DIR"), "/texture_stages.rs"));
