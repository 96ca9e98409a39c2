//! Where in the example a region with some pixels known fits best: the weighted squared error of every placement at once
//! (METHOD B3), by cross-correlation with Fourier transforms or, for few known pixels, directly.

use std::sync::Arc;

use anyhow::Result;
use image::RgbImage;
use rayon::prelude::*;
use rustfft::num_complex::Complex32;
use rustfft::{Fft, FftPlanner};

use super::colour::{Known, Weighted, squared_error, weighted};
use super::device_matching::DeviceMatching;
use crate::gpu::Device;

/// Placements that the direct way measures in one go.
const LANES: usize = 16;

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

    /// Some placement of a region of `size`, chosen by `die`; none when no placement is usable.
    pub fn any(&self, size: [usize; 2], die: u32) -> Option<[usize; 2]> {
        let [columns, rows] = self.placements(size)?;
        let usable = |i: usize| self.is_usable(i % columns, i / columns, size).then_some([i % columns, i / columns]);
        let first = ((u64::from(die) * (columns * rows) as u64) >> 32) as usize;
        (first..columns * rows).chain(0..first).find_map(usable)
    }

    /// The usable placement of a region of `size` with the least sum of squared errors over its known pixels, and that sum; the
    /// uppermost, then leftmost of equal ones. None when no placement is usable. The same choice whichever way errors are
    /// measured: what Fourier transforms find good enough is measured again directly.
    ///
    /// # Errors
    /// When the device that measures fails.
    pub fn best(&self, size: [usize; 2], known: &[Known]) -> Result<Option<([usize; 2], f32)>> {
        let Some([columns, rows]) = self.placements(size) else { return Ok(None) };
        let way = self.cheaper(columns * rows, known.len());
        let errors = match &self.on_device {
            Some(matching) => matching.errors([columns, rows], known)?,
            None => self.errors(size, known, way),
        };
        let usable = |i: &usize| self.is_usable(i % columns, i / columns, size);
        let least = |best: Option<(usize, f32)>, (i, error): (usize, f32)| {
            if best.is_none_or(|(_, least)| error < least) { Some((i, error)) } else { best }
        };
        let places = 0..columns * rows;
        let mut best = places.clone().filter(usable).map(|i| (i, errors[i])).fold(None, least);
        if self.on_device.is_none()
            && way == Way::Fourier
            && let Some((_, rough)) = best
        {
            // Transforms in single precision err by some units of the last place of the sums that they pass through.
            let slack = 1e-4 + 4e-6 * ((self.width * self.height * known.len()) as f32).sqrt();
            let near = places.filter(|&i| errors[i] <= rough + 2.0 * slack).filter(usable);
            best = near.map(|i| (i, self.error_at(i % columns, i / columns, known))).fold(None, least);
        }
        Ok(best.map(|(i, error)| ([i % columns, i / columns], error)))
    }

    /// The sum of squared errors at one placement, to the bit as [`Way::Direct`] has it.
    fn error_at(&self, x: usize, y: usize, known: &[Known]) -> f32 {
        let mut sum = 0.0;
        for pixel in known {
            let texel = self.colour(x + pixel.x, y + pixel.y);
            for (texel, colour) in texel.iter().zip(pixel.colour) {
                let difference = texel - colour;
                sum += difference * difference;
            }
        }
        sum
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
                // Small sums are not worth waking threads for.
                let rows_a_task = (200_000 / (columns * known.len().max(1))).max(1);
                errors.par_chunks_mut(columns * rows_a_task).enumerate().for_each(|(task, errors)| {
                    for (row, errors) in errors.chunks_exact_mut(columns).enumerate() {
                        row_of_errors(&self.planes, self.width, task * rows_a_task + row, known, errors);
                    }
                });
                errors
            }
            Way::Fourier => self.correlated([columns, rows], known),
        }
    }

    /// sum m (T - O)^2 = m * T^2 - 2 mO * T + sum m O^2, `*` the cross-correlation: a product of transforms. Regions lie
    /// within the example, so the correlation's wrapping around never shows.
    fn correlated(&self, [columns, rows]: [usize; 2], known: &[Known]) -> Vec<f32> {
        let area = self.width * self.height;
        // Two real pictures share one complex transform.
        let packed = |pair: &(dyn Fn(&Known) -> (f32, f32) + Sync)| {
            let mut values = vec![Complex32::default(); area];
            for pixel in known {
                let (re, im) = pair(pixel);
                values[pixel.y * self.width + pixel.x] = Complex32::new(re, im);
            }
            self.forward(values)
        };
        let (mask_and_red, green_and_blue) = rayon::join(
            || packed(&|pixel| (1.0, pixel.colour[0])),
            || packed(&|pixel| (pixel.colour[1], pixel.colour[2])),
        );
        let constant: f32 = known.iter().map(|pixel| squared_error(pixel.colour, [0.0; 3])).sum();
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

/// One row of errors, sixteen placements at a time.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn row_of_errors(planes: &[Vec<f32>; 3], width: usize, row: usize, known: &[Known], errors: &mut [f32]) {
    for (chunk, errors) in errors.chunks_mut(LANES).enumerate() {
        let mut sums = [0.0_f32; LANES];
        for pixel in known {
            let from = (row + pixel.y) * width + chunk * LANES + pixel.x;
            for (plane, colour) in planes.iter().zip(pixel.colour) {
                let texels = &plane[from..from + LANES];
                for lane in 0..LANES {
                    let difference = texels[lane] - colour;
                    sums[lane] += difference * difference;
                }
            }
        }
        errors.copy_from_slice(&sums[..errors.len()]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::noise::mixed;
    use image::Rgb;

    fn example(width: u32, height: u32) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| {
            let word = mixed(u64::from(y * 1000 + x));
            Rgb([word as u8, (word >> 8) as u8, (word >> 16) as u8])
        })
    }

    #[test]
    fn both_ways_measure_what_the_definition_says() {
        for (width, height) in [(37, 22), (64, 64), (5, 40)] {
            let matcher = Matcher::new(&example(width, height), None);
            let size = [5, 7];
            let known: Vec<Known> = (0..20)
                .map(|i| {
                    let word = mixed(900 + i);
                    let colour = weighted([word as u8, (word >> 8) as u8, (word >> 16) as u8].map(f32::from));
                    Known { x: i as usize % 5, y: i as usize / 5 + i as usize % 2, colour }
                })
                .filter(|pixel| (pixel.x, pixel.y) != (0, 0))
                .collect();
            let mut once = std::collections::HashSet::new();
            let known: Vec<Known> = known.into_iter().filter(|pixel| once.insert((pixel.x, pixel.y))).collect();
            let (direct, fourier) =
                (matcher.errors(size, &known, Way::Direct), matcher.errors(size, &known, Way::Fourier));
            let columns = width as usize - 4;
            assert_eq!(direct.len(), columns * (height as usize - 6));
            for (i, (direct, fourier)) in direct.iter().zip(&fourier).enumerate() {
                let (x, y) = (i % columns, i / columns);
                let sum: f64 = known
                    .iter()
                    .map(|pixel| f64::from(squared_error(matcher.colour(x + pixel.x, y + pixel.y), pixel.colour)))
                    .sum();
                assert!((f64::from(*direct) - sum).abs() < 1e-4, "{direct} {sum}");
                assert!((f64::from(*fourier) - sum).abs() < 1e-3, "{fourier} {sum}");
            }
        }
    }

    #[test]
    fn the_choice_does_not_depend_on_the_way() {
        // Regions of pieces that are nowhere in the example, many of them nearly as good as the best.
        let picture = RgbImage::from_fn(64, 64, |x, y| {
            let word = mixed(u64::from(y * 1000 + x)) % 3;
            Rgb([(100 + x % 8 * 10 + word) as u8, (90 + y % 8 * 9 + word) as u8, 60])
        });
        let matcher = Matcher::new(&picture, None);
        for piece in 0..30_u64 {
            let known: Vec<Known> = (0..400)
                .map(|i| {
                    let colour = [(100 + (i % 20 + 3 * piece) % 80) as f32, (90 + (i / 20 * 7) % 60) as f32, 61.0];
                    Known { x: i as usize % 20, y: i as usize / 20, colour: weighted(colour) }
                })
                .collect();
            assert_eq!(matcher.cheaper(45 * 45, 400), Way::Fourier);
            let (place, error) = matcher.best([20, 20], &known).unwrap().unwrap();
            let direct = matcher.errors([20, 20], &known, Way::Direct);
            let least = direct.iter().copied().fold(f32::INFINITY, f32::min);
            let first = direct.iter().position(|error| *error == least).unwrap();
            assert_eq!((place, error.to_bits()), ([first % 45, first / 45], least.to_bits()));
        }
    }

    #[test]
    fn a_piece_of_the_example_is_found_where_it_is_unless_forbidden() {
        let picture = example(40, 30);
        let matcher = Matcher::new(&picture, None);
        let known: Vec<Known> =
            (0..64).map(|i| Known { x: i % 8, y: i / 8, colour: matcher.colour(11 + i % 8, 9 + i / 8) }).collect();
        let (place, error) = matcher.best([8, 8], &known).unwrap().unwrap();
        assert_eq!(place, [11, 9]);
        assert!(error < 1e-3);
        let usable: Vec<bool> = (0..1200).map(|i| i != 12 * 40 + 13).collect();
        let matcher = Matcher::new(&picture, Some(&usable));
        let ([x, y], _) = matcher.best([8, 8], &known).unwrap().unwrap();
        assert!(!(x..x + 8).contains(&13) || !(y..y + 8).contains(&12), "{x} {y} covers the forbidden pixel");
        assert_eq!(matcher.best([41, 1], &known).unwrap(), None);
        let none = Matcher::new(&picture, Some(&[false; 1200]));
        assert_eq!(none.any([1, 1], 77), None);
    }
}
