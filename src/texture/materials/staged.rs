//! Materials as stages take them (`glsl/texture/materials.glsl`).

use super::midpoint::Displacement;
use crate::texture::noise::Sum;
use crate::texture::shaders::layout;

/// A sum of noise as stages take it.
#[derive(Debug)]
pub(crate) struct StagedSum {
    /// What is summed.
    pub(super) sum: Sum,
    /// Its octaves.
    pub(super) octaves: Vec<layout::NoiseOctave>,
}

/// A material as stages take it.
#[derive(Debug, Default)]
pub(crate) struct Staged {
    /// `MATERIAL_*`.
    pub(super) kind: u32,
    /// Its numbers.
    pub(super) numbers: Vec<f32>,
    /// Its sums of noise.
    pub(super) sums: Vec<StagedSum>,
    /// Colours of bands.
    pub(super) bands: Vec<f32>,
    /// The surface whose heights stand behind the bands.
    pub(super) surface: Option<Displacement>,
}
