//! Materials as pictures: flat, as height maps, and where rays meet a lit object; by the processor (a device: [`super::painter`]).

use anyhow::{Result, bail};
use image::{ImageBuffer, Luma, Rgb};
use rayon::prelude::*;

use super::materials::{Material, Texel};
use crate::arithmetic::real_power;

/// Pictures of 16 bits a channel; to 8 bits they are rounded when written.
pub type Picture = ImageBuffer<Rgb<u16>, Vec<u16>>;
/// Heights, 16 bits.
pub type Heights = ImageBuffer<Luma<u16>, Vec<u16>>;

/// Most pixels of a picture.
pub const MOST_PIXELS: u64 = 1 << 28;

/// Which part of a material a picture shows: the plane z = `offset[2]`, x to the right, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Pixels.
    pub size: [u32; 2],
    /// Object units at the picture's lower left corner, and the plane.
    pub offset: [f32; 3],
    /// Object units across the picture.
    pub scale: f32,
}

impl View {
    /// Fails for a picture without pixels, or of too many, or of no or unmeasurable extent.
    ///
    /// # Errors
    /// As said.
    pub fn checked(self) -> Result<Self> {
        check_size(self.size)?;
        if !(1e-3..=1e4).contains(&self.scale) {
            bail!("the scale makes a picture of {} units across, expected 0.001 to 10000", self.scale);
        }
        if let Some(offset) = self.offset.iter().find(|offset| !(-1e5..=1e5).contains(*offset)) {
            bail!("an offset of {offset} units, expected -1e5 to 1e5");
        }
        Ok(self)
    }

    /// Object units across and down.
    pub fn extent(&self) -> [f32; 2] {
        [self.scale, self.scale * self.size[1] as f32 / self.size[0] as f32]
    }

    /// Side of a pixel, object units.
    pub(super) fn pixel(&self) -> f32 {
        self.scale / self.size[0] as f32
    }

    /// The point at (u, v) of a pixel, each from 0 to 1.
    fn point(&self, x: u32, y: u32, [u, v]: [f32; 2]) -> [f32; 3] {
        let pixel = self.pixel();
        let up = self.size[1] - 1 - y;
        [self.offset[0] + (x as f32 + u) * pixel, self.offset[1] + (up as f32 + v) * pixel, self.offset[2]]
    }

    /// The mean over a pixel, of so many samples along each axis.
    fn mean<const N: usize>(&self, samples: u32, x: u32, y: u32, at: impl Fn([f32; 3]) -> [f32; N]) -> [f32; N] {
        let place = |sample: u32| (sample as f32 + 0.5) / samples as f32;
        let mut sum = [0.0; N];
        for sample in 0..samples * samples {
            let values = at(self.point(x, y, [place(sample % samples), place(sample / samples)]));
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
        sum.map(|sum| sum / (samples * samples) as f32)
    }
}

/// Fails for a picture without pixels, or of too many.
///
/// # Errors
/// As said.
pub fn check_size([width, height]: [u32; 2]) -> Result<()> {
    if width == 0 || height == 0 || u64::from(width) * u64::from(height) > MOST_PIXELS {
        bail!("a picture of {width} x {height} pixels, expected 1 to {MOST_PIXELS} pixels");
    }
    Ok(())
}

pub(super) fn word(x: f32) -> u16 {
    (x.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16
}

/// Fills a picture pixel by pixel, rows in parallel.
fn draw<const N: usize>(size: [u32; 2], pixel: impl Fn(u32, u32) -> [f32; N] + Sync) -> Vec<u16> {
    let mut words = vec![0; size[0] as usize * size[1] as usize * N];
    words.par_chunks_mut(size[0] as usize * N).enumerate().for_each(|(y, row)| {
        for (x, words) in row.chunks_exact_mut(N).enumerate() {
            for (word_of, value) in words.iter_mut().zip(pixel(x as u32, y as u32)) {
                *word_of = word(value);
            }
        }
    });
    words
}

fn picture(size: [u32; 2], pixel: impl Fn(u32, u32) -> [f32; 3] + Sync) -> Picture {
    // The buffer is as long as the size says, so this cannot fail.
    Picture::from_raw(size[0], size[1], draw(size, pixel)).unwrap_or_default()
}

/// Linear light as a screen shows it, sRGB.
pub(super) fn encoded(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * real_power(x.min(1.0), 1.0 / 2.4) - 0.055 }
}

/// The material, flat; where pixels are coarser than its detail, its mean over each. `view` is a checked one.
pub fn flat(material: &Material, view: &View) -> Picture {
    let samples = material.samples(view.pixel(), 1);
    if samples == 1 {
        return picture(view.size, |x, y| material.at(view.point(x, y, [0.5; 2])).colour);
    }
    picture(view.size, |x, y| view.mean(samples, x, y, |p| material.at(p).linear()).map(encoded))
}

/// Its heights.
pub fn heights(material: &Material, view: &View) -> Heights {
    let samples = material.samples(view.pixel(), 1);
    let words = draw(view.size, |x, y| view.mean(samples, x, y, |p| [material.at(p).height]));
    Heights::from_raw(view.size[0], view.size[1], words).unwrap_or_default()
}

const BACKGROUND: f32 = 0.05;
/// Samples a pixel along each axis at least: edges of the objects are smooth.
pub const SAMPLES: u32 = 2;

/// Where a ray meets an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The point in the material, its units.
    pub point: [f32; 3],
    /// The cosine between the surface's normal and the way to the light.
    pub cosine: f32,
}

/// The linear light from a surface, by the cosine between its normal and the way to the light.
fn shaded(texel: Texel, cosine: f32) -> [f32; 3] {
    let shade = 0.12 + 0.95 * cosine.max(0.0);
    texel.linear().map(|c| c * shade)
}

/// Where a sample of a pixel lies: u and v from -1 to 1 over the picture's shorter side, to the right and up.
pub(super) fn sample_place(size: [u32; 2], samples: u32, x: u32, y: u32, sample: u32) -> [f32; 2] {
    let smaller = size[0].min(size[1]) as f32;
    let place = |pixel: u32, s: u32| pixel as f32 + (s as f32 + 0.5) / samples as f32;
    [
        (2.0 * place(x, sample % samples) - size[0] as f32) / smaller,
        (size[1] as f32 - 2.0 * place(y, sample / samples)) / smaller,
    ]
}

/// A picture from the linear light along rays, none where there is nothing. `samples` rays a pixel along each axis.
pub(super) fn rendered(size: [u32; 2], samples: u32, ray: impl Fn(f32, f32) -> Option<[f32; 3]> + Sync) -> Picture {
    picture(size, |x, y| {
        let mut sum = [0.0; 3];
        for sample in 0..samples * samples {
            let [u, v] = sample_place(size, samples, x, y, sample);
            let light = ray(u, v).unwrap_or([BACKGROUND; 3]);
            sum.iter_mut().zip(light).for_each(|(sum, c)| *sum += c);
        }
        sum.map(|sum| encoded(sum / (samples * samples) as f32))
    })
}

/// A picture of a material where rays meet an object, as [`rendered`].
pub fn shown(
    material: &Material,
    size: [u32; 2],
    samples: u32,
    ray: impl Fn(f32, f32) -> Option<Seen> + Sync,
) -> Picture {
    rendered(size, samples, |u, v| ray(u, v).map(|seen| shaded(material.at(seen.point), seen.cosine)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::materials::Parameters;

    /// From far away grains and threads are their mean, neither noise nor moire; from near nothing changes.
    #[test]
    fn detail_finer_than_a_pixel_is_its_mean() {
        for (name, least) in [("granite", 4.0), ("fabric", 1.5)] {
            let material = Material::new(name, Parameters::Defaults, 1, None).unwrap();
            let grey = |picture: &Picture| -> Vec<f64> { picture.pixels().map(|pixel| f64::from(pixel[1])).collect() };
            let spread = |values: &[f64]| {
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
            };
            let far = View { size: [64, 64], offset: [0.0; 3], scale: 24.0 };
            let alone = picture(far.size, |x, y| material.at(far.point(x, y, [0.5; 2])).colour);
            let (sampled, single) = (spread(&grey(&flat(&material, &far))), spread(&grey(&alone)));
            assert!(sampled * least < single, "{name}: {sampled} of {single}");
            let near = View { scale: 1.0, ..far };
            let alone = picture(near.size, |x, y| material.at(near.point(x, y, [0.5; 2])).colour);
            assert!(flat(&material, &near) == alone, "{name}: from near it is the formula at each pixel");
        }
    }
}
