//! Materials as pictures: flat, as height maps, lit on a sphere, a cube or a plane, and all of them on one sheet.

use anyhow::{Result, bail};
use image::{ImageBuffer, Luma, Rgb};
use rayon::prelude::*;

use super::materials::{Material, MaterialKind, Parameters, Texel};

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

/// An object to show a material on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solid {
    /// A ball of radius 1.
    Sphere,
    /// A cube with edges of 1.3, seen from above a corner.
    Cube,
    /// A square leaning back.
    Plane,
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
    fn pixel(&self) -> f32 {
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

fn word(x: f32) -> u16 {
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
fn encoded(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
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

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn normalised(v: [f32; 3]) -> [f32; 3] {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// Towards the one light: from the upper left, before the object.
const LIGHT: [f32; 3] = [-0.45, 0.6, 0.66];
const BACKGROUND: f32 = 0.05;
/// Samples a pixel along each axis at least: edges of the objects are smooth.
pub const SAMPLES: u32 = 2;
/// Half of what the view of a solid is wide, units of the object: a little more than any of them takes.
const HALF_VIEW: f32 = 1.45;

/// Where the ray through (u, v) in [-1, 1]^2 along -z meets the object: point and normal in object space, and the normal
/// as the light sees it.
fn hit(solid: Solid, u: f32, v: f32) -> Option<([f32; 3], [f32; 3])> {
    match solid {
        Solid::Sphere => {
            let (x, y) = (u * 1.1, v * 1.1);
            let z2 = 1.0 - x * x - y * y;
            (z2 >= 0.0).then(|| ([x, y, z2.sqrt()], [x, y, z2.sqrt()]))
        }
        Solid::Plane => {
            // Leaning back by 50 degrees, seen in perspective from 4 units away.
            let (sin, cos) = 50.0_f32.to_radians().sin_cos();
            let ray = [u * 1.45, v * 1.45, -4.0];
            let towards = ray[1] * sin + ray[2] * cos;
            let t = -4.0 * cos / towards;
            let (x, y) = (t * ray[0], t * ray[1] * cos - (4.0 + t * ray[2]) * sin);
            (towards < 0.0 && x.abs() <= 1.0 && y.abs() <= 1.0).then_some(([x, y, 0.0], [0.0, sin, cos]))
        }
        Solid::Cube => {
            // Turned by 35 degrees about y, then tipped by 28 degrees towards the eye.
            let ((sa, ca), (sb, cb)) = (35.0_f32.to_radians().sin_cos(), 28.0_f32.to_radians().sin_cos());
            let to_object = |p: [f32; 3]| {
                let (y, z) = (p[1] * cb + p[2] * sb, p[2] * cb - p[1] * sb);
                [p[0] * ca - z * sa, y, p[0] * sa + z * ca]
            };
            let (origin, direction) = (to_object([u * 1.2, v * 1.2, 4.0]), to_object([0.0, 0.0, -1.0]));
            let half = 0.65;
            let (mut near, mut far, mut face) = (f32::MIN, f32::MAX, 0);
            for axis in 0..3 {
                let a = (-half - origin[axis]) / direction[axis];
                let b = (half - origin[axis]) / direction[axis];
                if a.min(b) > near {
                    (near, face) = (a.min(b), axis);
                }
                far = far.min(a.max(b));
            }
            (near <= far).then(|| {
                let p = std::array::from_fn(|axis| origin[axis] + near * direction[axis]);
                // The light turns with the object instead of the normal turning back.
                let sign = -direction[face].signum();
                let light = to_object(normalised(LIGHT));
                let mut normal = [0.0; 3];
                normal[face] = sign;
                let lambert = dot(normal, light).max(0.0);
                // A normal of the length that gives this diffuse light.
                (p, normalised(LIGHT).map(|x| x * lambert))
            })
        }
    }
}

/// The material on an object under one diffuse light; `scale` is units of the material a unit of the object.
pub fn lit(material: &Material, solid: Solid, size: [u32; 2], offset: [f32; 3], scale: f32) -> Picture {
    let light = normalised(LIGHT);
    let pixel = scale * 2.0 * HALF_VIEW / size[0].min(size[1]) as f32;
    shown(size, material.samples(pixel, SAMPLES), |u, v| {
        hit(solid, u, v).map(|(p, normal)| {
            let texel = material.at(std::array::from_fn(|axis| p[axis] * scale + offset[axis]));
            shaded(texel, dot(normal, light))
        })
    })
}

/// The linear light from a surface, by the cosine between its normal and the way to the light.
pub fn shaded(texel: Texel, cosine: f32) -> [f32; 3] {
    let shade = 0.12 + 0.95 * cosine.max(0.0);
    texel.linear().map(|c| c * shade)
}

/// A picture of an object from the linear light along rays, none where they miss it. A ray's u and v are from -1 to 1 over the
/// shorter side, to the right and up. `samples` rays a pixel along each axis.
pub fn shown(size: [u32; 2], samples: u32, ray: impl Fn(f32, f32) -> Option<[f32; 3]> + Sync) -> Picture {
    let smaller = size[0].min(size[1]) as f32;
    picture(size, |x, y| {
        let mut sum = [0.0; 3];
        for sample in 0..samples * samples {
            let place = |pixel: u32, s: u32| pixel as f32 + (s as f32 + 0.5) / samples as f32;
            let u = (2.0 * place(x, sample % samples) - size[0] as f32) / smaller;
            let v = (size[1] as f32 - 2.0 * place(y, sample / samples)) / smaller;
            for (sum, c) in sum.iter_mut().zip(ray(u, v).unwrap_or([BACKGROUND; 3])) {
                *sum += c / (samples * samples) as f32;
            }
        }
        sum.map(encoded)
    })
}

/// All materials on one sheet, in the order of [`MaterialKind::ALL`] by rows of four: each flat, with itself lit on a sphere below.
///
/// # Errors
/// Never: the defaults of every material are sound.
pub fn contact_sheet(cell: u32, seed: u64) -> Result<Picture> {
    let columns = 4;
    let gap = cell / 16;
    let rows = (MaterialKind::ALL.len() as u32).div_ceil(columns);
    let (width, height) = (gap + columns * (cell + gap), gap + rows * (cell + cell / 2 + gap));
    let mut sheet = Picture::from_pixel(width, height, Rgb([word(0.93); 3]));
    for (i, kind) in MaterialKind::ALL.into_iter().enumerate() {
        let material = Material::new(kind.name(), Parameters::Defaults, seed, None)?;
        let (left, top) = (gap + i as u32 % columns * (cell + gap), gap + i as u32 / columns * (cell + cell / 2 + gap));
        let view = View { size: [cell, cell], offset: [0.0; 3], scale: 3.0 };
        image::imageops::replace(&mut sheet, &flat(&material, &view), i64::from(left), i64::from(top));
        let ball = lit(&material, Solid::Sphere, [cell, cell / 2], [0.0; 3], 1.0);
        image::imageops::replace(&mut sheet, &ball, i64::from(left), i64::from(top + cell));
    }
    Ok(sheet)
}

#[cfg(test)]
mod tests {
    use super::*;

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
