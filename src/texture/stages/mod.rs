//! Noise on a device. A stage is one file here beside one shader of the same name under `glsl/texture/`.

mod noise;
#[cfg(test)]
mod tests;

#[allow(clippy::unreadable_literal, reason = "written by the build")]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/texture_stages.rs"));
}

pub use generated::layout;
pub use noise::{NoiseKind, NoiseRequest, NoiseSource, NoiseStage};
