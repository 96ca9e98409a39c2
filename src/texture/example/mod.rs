//! A texture of any size from small examples: patch by patch, and where patches do not fit pixel by pixel; or the holes of an
//! example, filled in from the rest of it (METHOD B3).

mod anew;
mod border;
mod canvas;
mod checks;
pub mod colour;
mod device_matching;
mod direct;
mod keeping;
pub mod matching;
mod pictures;
mod settings;
mod sources;
#[cfg(test)]
mod tests;

use anyhow::Result;
use image::GrayImage;

use self::canvas::Canvas;
pub use self::settings::{Example, Settings, Synthesis};
use self::sources::Sources;
use crate::gpu::Device;

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
