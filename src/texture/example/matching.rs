//! Where in the example a region with some pixels known fits best: the weighted squared error of every placement at once
//! (METHOD B3), by cross-correlation with Fourier transforms or, for few known pixels, directly.

use std::ops::Range;
use std::sync::Arc;

use anyhow::Result;
use image::RgbImage;
use rustfft::num_complex::Complex32;
use rustfft::{Fft, FftPlanner};

use super::colour::{Known, Weighted, squared_error, weighted};
use super::device_matching::DeviceMatching;
use super::direct::{self, LANES};
use crate::gpu::Device;

/// Of so many known pixels one is summed, where a guess limits the sum: an estimate, for photographs and materials alike.
const SAVED: usize = 4;

/// How errors are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Sum over the known pixels, for each placement.
    Direct,
    /// Cross-correlation by Fourier transforms: the same cost however many are known.
    Fourier,
}

/// The example, prepared.
pub struct Matcher {
    width: usize,
    height: usize,
    /// Weighted channels, rows one after another; longer than the picture by [`LANES`], so that a row of placements may be
    /// read past its end.
    planes: [Vec<f32>; 3],
    /// Transforms of the channels and of their sum of squares, transposed.
    spectra: [Vec<Complex32>; 4],
    along: [Arc<dyn Fft<f32>>; 2],
    down: [Arc<dyn Fft<f32>>; 2],
    /// Pixels that may not be used above and left of each corner; empty when all may.
    forbidden: Vec<u32>,
    /// What measures instead of the processor.
    on_device: Option<DeviceMatching>,
}

impl std::fmt::Debug for Matcher {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Matcher").field("width", &self.width).field("height", &self.height).finish_non_exhaustive()
    }
}

/// `from` with `rows` rows, its columns made rows.
fn transposed(from: &[Complex32], rows: usize) -> Vec<Complex32> {
    let columns = from.len() / rows;
    let mut to = vec![Complex32::default(); from.len()];
    for (y, row) in from.chunks_exact(columns).enumerate() {
        for (x, value) in row.iter().enumerate() {
            to[x * rows + y] = *value;
        }
    }
    to
}

impl Matcher {
    /// Prepares an example; `usable` says which of its pixels may be used, row by row.
    pub fn new(example: &RgbImage, usable: Option<&[bool]>) -> Self {
        let (width, height) = (example.width() as usize, example.height() as usize);
        let mut planner = FftPlanner::new();
        let along = [planner.plan_fft_forward(width), planner.plan_fft_inverse(width)];
        let down = [planner.plan_fft_forward(height), planner.plan_fft_inverse(height)];
        let colours: Vec<Weighted> = example.pixels().map(|pixel| weighted(pixel.0.map(f32::from))).collect();
        let planes: [Vec<f32>; 3] = std::array::from_fn(|c| {
            colours.iter().map(|colour| colour[c]).chain(std::iter::repeat_n(0.0, LANES)).collect()
        });
        let mut forbidden = Vec::new();
        if let Some(usable) = usable {
            forbidden = vec![0; (width + 1) * (height + 1)];
            for y in 0..height {
                for x in 0..width {
                    let i = (y + 1) * (width + 1) + x + 1;
                    let above = forbidden[i - width - 1] + forbidden[i - 1] - forbidden[i - width - 2];
                    forbidden[i] = above + u32::from(!usable[y * width + x]);
                }
            }
        }
        let mut matcher =
            Self { width, height, planes, spectra: Default::default(), along, down, forbidden, on_device: None };
        let plane = |f: &dyn Fn(&Weighted) -> f32| -> Vec<Complex32> {
            colours.iter().map(|colour| Complex32::new(f(colour), 0.0)).collect()
        };
        matcher.spectra = [
            matcher.forward(plane(&|c| c[0])),
            matcher.forward(plane(&|c| c[1])),
            matcher.forward(plane(&|c| c[2])),
            matcher.forward(plane(&|c| squared_error(*c, [0.0; 3]))),
        ];
        matcher
    }

    /// The same matcher with its errors measured by a device: the same numbers to the bit.
    ///
    /// # Errors
    /// When the device has no memory for the example.
    pub fn on_device(mut self, device: &Device) -> Result<Self> {
        let colours: Vec<Weighted> =
            (0..self.width * self.height).map(|i| self.colour(i % self.width, i / self.width)).collect();
        self.on_device = Some(DeviceMatching::new(device, [self.width, self.height], &colours)?);
        Ok(self)
    }

    /// Columns and rows of the example.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The colour of a pixel of the example.
    pub fn colour(&self, x: usize, y: usize) -> Weighted {
        std::array::from_fn(|c| self.planes[c][y * self.width + x])
    }

    fn forward(&self, mut values: Vec<Complex32>) -> Vec<Complex32> {
        self.along[0].process(&mut values);
        let mut columns = transposed(&values, self.height);
        self.down[0].process(&mut columns);
        columns
    }

    /// Placements of a region of `size` that lie within the example: columns and rows of their upper left corners.
    fn placements(&self, size: [usize; 2]) -> Option<[usize; 2]> {
        (size[0] <= self.width && size[1] <= self.height).then(|| [self.width + 1 - size[0], self.height + 1 - size[1]])
    }

    fn is_usable(&self, x: usize, y: usize, size: [usize; 2]) -> bool {
        if self.forbidden.is_empty() {
            return true;
        }
        let at = |x: usize, y: usize| self.forbidden[y * (self.width + 1) + x];
        let (right, bottom) = (x + size[0], y + size[1]);
        at(right, bottom) + at(x, y) == at(right, y) + at(x, bottom)
    }

    /// Placements of a region of `size` within the example.
    pub fn placement_count(&self, size: [usize; 2]) -> usize {
        self.placements(size).map_or(0, |[columns, rows]| columns * rows)
    }

    /// The first usable one of these placements of a region of `size`, counted row by row.
    pub fn first_usable(&self, size: [usize; 2], mut placements: Range<usize>) -> Option<[usize; 2]> {
        let [columns, _] = self.placements(size)?;
        placements.find(|i| self.is_usable(i % columns, i / columns, size)).map(|i| [i % columns, i / columns])
    }

    /// The usable placement of a region of `size` with the least sum of squared errors over its known pixels, and that sum; the
    /// uppermost, then leftmost of equal ones. None when no placement is usable. The same choice whichever way errors are
    /// measured: what Fourier transforms find good enough is measured again directly.
    ///
    /// # Errors
    /// When the device that measures fails.
    pub fn best(&self, size: [usize; 2], known: &[Known]) -> Result<Option<([usize; 2], f32)>> {
        self.best_below(size, known, f32::INFINITY)
    }

    /// As [`Self::best`], but none either where no sum is below `limit`. The lower this is, the sooner a placement is given up.
    ///
    /// # Errors
    /// When the device that measures fails.
    pub fn best_below(&self, size: [usize; 2], known: &[Known], limit: f32) -> Result<Option<([usize; 2], f32)>> {
        let Some([columns, rows]) = self.placements(size) else { return Ok(None) };
        let usable = |i: &usize| self.is_usable(i % columns, i / columns, size);
        let least = |best: Option<(usize, f32)>, (i, error): (usize, f32)| {
            if error < best.map_or(limit, |(_, least)| least) { Some((i, error)) } else { best }
        };
        let places = 0..columns * rows;
        let best = if let Some(matching) = &self.on_device {
            let errors = matching.errors([columns, rows], known)?;
            places.filter(usable).map(|i| (i, errors[i])).fold(None, least)
        } else if self.is_given_up_soon(columns * rows, known.len(), limit) {
            direct::least(&self.planes, self.width, [columns, rows], known, limit, &usable)
        } else {
            let errors = self.errors(size, known, Way::Fourier);
            let Some((_, rough)) =
                places.clone().filter(usable).map(|i| (i, errors[i])).fold(None, |best, next| {
                    if best.is_none_or(|(_, least)| next.1 < least) { Some(next) } else { best }
                })
            else {
                return Ok(None);
            };
            // Transforms in single precision err by some units of the last place of the sums that they pass through.
            let slack = 1e-4 + 4e-6 * ((self.width * self.height * known.len()) as f32).sqrt();
            let near = places.filter(|&i| errors[i] <= rough + 2.0 * slack).filter(usable);
            near.map(|i| (i, self.error_at(i % columns, i / columns, known))).fold(None, least)
        };
        Ok(best.map(|(i, error)| ([i % columns, i / columns], error)))
    }

    /// The sum of squared errors at a placement of a region of `size`, to the bit as [`Way::Direct`] has it; infinite where the
    /// placement is not usable, and where the sum is found to exceed `limit`.
    pub fn error_within(&self, size: [usize; 2], [x, y]: [usize; 2], known: &[Known], limit: f32) -> f32 {
        let is_within = self.placements(size).is_some_and(|[columns, rows]| x < columns && y < rows);
        if !is_within || !self.is_usable(x, y, size) {
            return f32::INFINITY;
        }
        let mut sum = 0.0;
        for some in known.chunks(16) {
            sum = self.added(sum, [x, y], some);
            if sum > limit {
                return f32::INFINITY;
            }
        }
        sum
    }

    /// The sum of squared errors at one placement, to the bit as [`Way::Direct`] has it.
    fn error_at(&self, x: usize, y: usize, known: &[Known]) -> f32 {
        self.added(0.0, [x, y], known)
    }

    fn added(&self, mut sum: f32, [x, y]: [usize; 2], known: &[Known]) -> f32 {
        for pixel in known {
            let texel = self.colour(x + pixel.x, y + pixel.y);
            for (texel, colour) in texel.iter().zip(pixel.colour) {
                let difference = texel - colour;
                sum += pixel.weight * (difference * difference);
            }
        }
        sum
    }

    /// Whether to measure directly. Below a limit that a good guess has set most placements are given up after few pixels.
    fn is_given_up_soon(&self, placements: usize, known: usize, limit: f32) -> bool {
        let known = if limit < f32::INFINITY { known.div_ceil(SAVED) } else { known };
        self.cheaper(placements, known) == Way::Direct
    }

    /// The way that takes fewer operations, by count: an estimate, since products summed directly are vector code.
    fn cheaper(&self, placements: usize, known: usize) -> Way {
        let area = (self.width * self.height) as f32;
        let direct = placements as f32 * known as f32;
        if direct < 3.0 * area * (4.0 * area.max(2.0).log2() + 6.0) { Way::Direct } else { Way::Fourier }
    }

    /// The sum of squared errors over the known pixels of a region of `size`, for every placement within the example, row by row.
    pub fn errors(&self, size: [usize; 2], known: &[Known], way: Way) -> Vec<f32> {
        let Some([columns, rows]) = self.placements(size) else { return Vec::new() };
        match way {
            Way::Direct => {
                let mut errors = vec![0.0; columns * rows];
                for (row, errors) in errors.chunks_exact_mut(columns).enumerate() {
                    direct::row_of_errors(&self.planes, self.width, row, known, f32::INFINITY, errors);
                }
                errors
            }
            Way::Fourier => self.correlated([columns, rows], known),
        }
    }

    /// sum w (T - O)^2 = w * T^2 - 2 wO * T + sum w O^2, `*` the cross-correlation: a product of transforms. Regions lie
    /// within the example, so the correlation's wrapping around never shows.
    fn correlated(&self, [columns, rows]: [usize; 2], known: &[Known]) -> Vec<f32> {
        let area = self.width * self.height;
        // Two real pictures share one complex transform.
        let packed = |pair: &(dyn Fn(&Known) -> (f32, f32) + Sync)| {
            let mut values = vec![Complex32::default(); area];
            for pixel in known {
                let (re, im) = pair(pixel);
                values[pixel.y * self.width + pixel.x] = pixel.weight * Complex32::new(re, im);
            }
            self.forward(values)
        };
        let (mask_and_red, green_and_blue) = rayon::join(
            || packed(&|pixel| (1.0, pixel.colour[0])),
            || packed(&|pixel| (pixel.colour[1], pixel.colour[2])),
        );
        let constant: f32 = known.iter().map(|pixel| pixel.weight * squared_error(pixel.colour, [0.0; 3])).sum();
        // Transposed: index = x * height + y.
        let mut product = vec![Complex32::default(); area];
        for x in 0..self.width {
            for y in 0..self.height {
                let i = x * self.height + y;
                let mirrored = (self.width - x) % self.width * self.height + (self.height - y) % self.height;
                let parts = |z: &[Complex32]| {
                    let (here, there) = (z[i], z[mirrored].conj());
                    let difference = here - there;
                    (0.5 * (here + there), 0.5 * Complex32::new(difference.im, -difference.re))
                };
                let ((mask, red), (green, blue)) = (parts(&mask_and_red), parts(&green_and_blue));
                let cross = red.conj() * self.spectra[0][i]
                    + green.conj() * self.spectra[1][i]
                    + blue.conj() * self.spectra[2][i];
                product[i] = mask.conj() * self.spectra[3][i] - 2.0 * cross;
            }
        }
        self.down[1].process(&mut product);
        let mut product = transposed(&product, self.width);
        self.along[1].process(&mut product);
        let scale = 1.0 / area as f32;
        let row = |y: usize| product[y * self.width..][..columns].iter().map(|z| z.re * scale + constant);
        (0..rows).flat_map(row).collect()
    }
}

#[cfg(test)]
mod tests;
