//! A texture of any size from small examples: patch by patch, and where patches do not fit pixel by pixel; or the holes of an
//! example, filled in from the rest of it (METHOD B3).

mod anew;
mod canvas;
mod checks;
pub mod colour;
mod device_matching;
mod direct;
mod keeping;
pub mod matching;
mod pictures;
mod sources;
#[cfg(test)]
mod tests;

use anyhow::Result;
use image::{GrayImage, RgbImage};

use self::canvas::Canvas;
use self::sources::Sources;
use crate::gpu::Device;

/// Pixels around one that its neighbourhood takes in: 7 x 7.
const RADIUS: usize = 3;

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

/// Synthesises a texture from one or more examples, whose placements compete; of equal ones the first example's is taken. With
/// `holes`, a picture as large as the first example and the result, that example is kept where they are bright and synthesised
/// where they are dark, and no placement touches a hole. `advance` is called after each of [`patch_count`] steps. The same result
/// on every run, for any number of threads, and whether the processor measures what fits or a `device` does.
///
/// # Errors
/// When a size or a setting makes no sense, a mask has another size than its example, no pixel of the examples is known and may be
/// used, or the device fails.
pub fn synthesise(
    examples: &[Example<'_>],
    holes: Option<&GrayImage>,
    settings: &Settings,
    device: Option<&Device>,
    mut advance: impl FnMut(),
) -> Result<Synthesis> {
    checks::check(examples, holes, settings)?;
    let mut canvas = Canvas::new(Sources::new(examples, holes, device)?, *settings);
    if let (Some(holes), Some(first)) = (holes, examples.first()) {
        canvas.keep(first.picture, holes);
    }
    let [width, height] = settings.size.map(|side| side as usize);
    let sides = settings.patch.map(|side| side as usize);
    for y in (0..height).step_by(sides[1]) {
        for x in (0..width).step_by(sides[0]) {
            canvas.place([x, y], sides, settings.overlap as usize)?;
            advance();
        }
    }
    Ok(canvas.synthesis())
}

/// Patches of a result before any is split.
pub fn patch_count(settings: &Settings) -> usize {
    let [columns, rows] = [0, 1].map(|axis| settings.size[axis].div_ceil(settings.patch[axis].max(1)) as usize);
    columns * rows
}
