//! All materials on one sheet.

use anyhow::Result;
use image::Rgb;

use super::materials::{Material, MaterialKind, Parameters};
use super::noise::NoiseWay;
use super::painter::Painter;
use super::picture::{Picture, View, word};
use super::solids::{Solid, lit};
use crate::gpu::Device;

/// All materials on one sheet, in the order of [`MaterialKind::ALL`] by rows of four: each flat, with itself lit on a sphere below.
///
/// # Errors
/// When the device that draws fails.
pub fn contact_sheet(cell: u32, seed: u64, way: NoiseWay, device: Option<&Device>) -> Result<Picture> {
    let columns = 4;
    let gap = cell / 16;
    let rows = (MaterialKind::ALL.len() as u32).div_ceil(columns);
    let (width, height) = (gap + columns * (cell + gap), gap + rows * (cell + cell / 2 + gap));
    let mut sheet = Picture::from_pixel(width, height, Rgb([word(0.93); 3]));
    for (i, kind) in MaterialKind::ALL.into_iter().enumerate() {
        let material = Material::of_noise(way, kind.name(), Parameters::Defaults, seed, None)?;
        let painter = Painter::new(&material, device)?;
        let (left, top) = (gap + i as u32 % columns * (cell + gap), gap + i as u32 / columns * (cell + cell / 2 + gap));
        let view = View { size: [cell, cell], offset: [0.0; 3], scale: 3.0 };
        image::imageops::replace(&mut sheet, &painter.flat(&view)?, i64::from(left), i64::from(top));
        let ball = lit(&painter, Solid::Sphere, [cell, cell / 2], [0.0; 3], 1.0)?;
        image::imageops::replace(&mut sheet, &ball, i64::from(left), i64::from(top + cell));
    }
    Ok(sheet)
}
