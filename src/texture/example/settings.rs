//! What is wanted, and what is made of it.

use image::{GrayImage, RgbImage};

/// Pixels around one that its neighbourhood takes in: 7 x 7.
pub(super) const RADIUS: usize = 3;

/// What is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels of the result.
    pub size: [u32; 2],
    /// Width and height of a patch, pixels: powers of two, each of its own.
    pub patch: [u32; 2],
    /// Pixels by which patches overlap what is there.
    pub overlap: u32,
    /// Mean squared error of a patch's overlap, 0 to 1, above which it is split; 0 splits all into pixels.
    pub delta_max: f32,
    /// Squared error of a pixel of the overlap above which it is synthesised anew.
    pub delta_pixel: f32,
    /// What is chosen where nothing says what fits.
    pub seed: u64,
    /// The result continues over its borders into itself.
    pub tile: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { size: [256, 256], patch: [32, 32], overlap: 8, delta_max: 0.04, delta_pixel: 0.03, seed: 0, tile: false }
    }
}

/// A picture to synthesise from.
#[derive(Clone, Copy, Debug)]
pub struct Example<'a> {
    /// Its pixels.
    pub picture: &'a RgbImage,
    /// As large: dark where it may not be used. None where all of it may.
    pub mask: Option<&'a GrayImage>,
}

/// A texture and how it came about.
#[derive(Clone, Debug)]
pub struct Synthesis {
    /// The texture.
    pub picture: RgbImage,
    /// Its patches, coloured by their size: blue the largest, red single pixels; grey what was known.
    pub decomposition: RgbImage,
    /// The texture in grey, with the pixels that were synthesised anew in red.
    pub resynthesised: RgbImage,
    /// How many these are.
    pub resynthesised_count: usize,
}
