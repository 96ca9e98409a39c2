//! How a texture came about, as pictures.

use image::{Rgb, RgbImage};

use crate::texture::noise::mixed;

/// The patch that a pixel came with.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Owner {
    /// Counted from 1; 0 where the pixel was known.
    pub(super) patch: u32,
    /// Pixels of the patch.
    pub(super) area: u32,
}

/// The pixels of a texture of `size` by their patches, of which the largest have the sides `patch`: from blue (whole) over green and
/// yellow to red (pixels), each of its own shade; grey where the texture was known.
pub(super) fn decomposition([width, height]: [u32; 2], patch: [u32; 2], owners: &[Owner]) -> RgbImage {
    let levels = (patch[0] as f32 * patch[1] as f32).log2().max(1.0);
    RgbImage::from_fn(width, height, |x, y| {
        let owner = owners[(y * width + x) as usize];
        if owner.patch == 0 {
            return Rgb([110; 3]);
        }
        // 0 whole patches, 1 pixels.
        let depth = 1.0 - (owner.area.max(1) as f32).log2() / levels;
        let hue =
            [2.0 * depth - 0.5, 1.4 - (2.2 * depth - 1.0).abs() * 1.2, 1.2 - 2.4 * depth].map(|c| c.clamp(0.1, 1.0));
        let shade = 0.7 + 0.3 * (mixed(u64::from(owner.patch)) >> 8) as f32 / 16_777_216.0;
        let left = x > 0 && owners[(y * width + x - 1) as usize].patch != owner.patch;
        let above = y > 0 && owners[((y - 1) * width + x) as usize].patch != owner.patch;
        let border = if owner.area > 4 && (left || above) { 0.35 } else { 1.0 };
        Rgb(hue.map(|c| (255.0 * c * shade * border) as u8))
    })
}

/// The texture in dim grey with the pixels `anew` in red.
pub(super) fn resynthesised(picture: &RgbImage, anew: &[bool]) -> RgbImage {
    RgbImage::from_fn(picture.width(), picture.height(), |x, y| {
        if anew[(y * picture.width() + x) as usize] {
            return Rgb([235, 40, 30]);
        }
        let [r, g, b] = picture.get_pixel(x, y).0.map(u32::from);
        Rgb([((299 * r + 587 * g + 114 * b) / 1600) as u8; 3])
    })
}
