//! What the build makes of `glsl/matrix/`.

#![allow(clippy::unreadable_literal, reason = "written by the build")]

include!(concat!(env!("OUT_DIR"), "/matrix_stages.rs"));
