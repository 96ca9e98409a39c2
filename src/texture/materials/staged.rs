//! Materials as stages take them (`glsl/texture/materials.glsl`).

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
#[derive(Debug)]
pub(crate) struct Staged {
    /// `MATERIAL_*`.
    pub(super) kind: u32,
    /// Its numbers.
    pub(super) numbers: Vec<f32>,
    /// Its sums of noise.
    pub(super) sums: Vec<StagedSum>,
    /// Colours of bands, then heights of a surface.
    pub(super) tables: Vec<f32>,
}
