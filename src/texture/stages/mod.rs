//! Noise on a device. A stage is one file here beside one shader of the same name under `glsl/texture/`.

mod matching;
mod noise;
mod noise_image;
mod request;
#[cfg(test)]
mod tests;

#[allow(clippy::unreadable_literal, reason = "written by the build")]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/texture_stages.rs"));
}

pub use generated::layout;
pub(super) use generated::{
    MATERIAL_BRICK, MATERIAL_CLOUDS, MATERIAL_FABRIC, MATERIAL_GRANITE, MATERIAL_LATTICES, MATERIAL_LAVA,
    MATERIAL_MARBLE, MATERIAL_NUMBERS, MATERIAL_WOOD,
};
pub(super) use matching::MatchStage;
pub use noise::NoiseStage;
pub use noise_image::NoiseImageStage;
pub use request::{NoiseKind, NoiseRequest, NoiseSource};
