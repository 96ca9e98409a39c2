//! Where in the example a region with some pixels known fits best: the weighted squared error of every placement at once
//! (METHOD B3), by cross-correlation with Fourier transforms or, for few known pixels, directly.

use std::ops::Range;

use anyhow::Result;
use image::RgbImage;
use phastft::fft_f32_dit_with_planner;
use phastft::planner::{Direction, PlannerDit32};

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
    /// Columns and rows that are transformed: the example's with zeros behind them, powers of two.
    padded: [usize; 2],
    /// Transforms of the channels and of their sum of squares, transposed.
    spectra: [Complex; 4],
    along: PlannerDit32,
    down: PlannerDit32,
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

/// Complex numbers, row by row: real parts and imaginary parts.
#[derive(Clone, Default)]
struct Complex {
    re: Vec<f32>,
    im: Vec<f32>,
}

impl Complex {
    fn zeros(count: usize) -> Self {
        Self { re: vec![0.0; count], im: vec![0.0; count] }
    }

    fn at(&self, i: usize) -> [f32; 2] {
        [self.re[i], self.im[i]]
    }

    /// Transforms each row of `columns` numbers.
    fn transform(&mut self, columns: usize, planner: &PlannerDit32, direction: Direction) {
        for (re, im) in self.re.chunks_exact_mut(columns).zip(self.im.chunks_exact_mut(columns)) {
            fft_f32_dit_with_planner(re, im, direction, planner);
        }
    }

    /// Its `rows` rows made columns.
    fn transposed(&self, rows: usize) -> Self {
        Self { re: transposed(&self.re, rows), im: transposed(&self.im, rows) }
    }
}

fn transposed(from: &[f32], rows: usize) -> Vec<f32> {
    let columns = from.len() / rows;
    let mut to = vec![0.0; from.len()];
    for (y, row) in from.chunks_exact(columns).enumerate() {
        for (x, value) in row.iter().enumerate() {
            to[x * rows + y] = *value;
        }
    }
    to
}

/// `a` times the conjugate of `b`.
fn times_conjugate(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0] * b[0] + a[1] * b[1], a[1] * b[0] - a[0] * b[1]]
}

impl Matcher {
    /// Prepares an example; `usable` says which of its pixels may be used, row by row.
    pub fn new(example: &RgbImage, usable: Option<&[bool]>) -> Self {
        let (width, height) = (example.width() as usize, example.height() as usize);
        let padded = [width, height].map(usize::next_power_of_two);
        let [along, down] = padded.map(PlannerDit32::new);
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
        let mut matcher = Self {
            width,
            height,
            planes,
            padded,
            spectra: Default::default(),
            along,
            down,
            forbidden,
            on_device: None,
        };
        let plane = |f: &dyn Fn(&Weighted) -> f32| {
            let mut values = Complex::zeros(padded[0] * padded[1]);
            for (row, colours) in values.re.chunks_exact_mut(padded[0]).zip(colours.chunks_exact(width.max(1))) {
                row.iter_mut().zip(colours).for_each(|(value, colour)| *value = f(colour));
            }
            values
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

    fn forward(&self, mut values: Complex) -> Complex {
        let [columns, rows] = self.padded;
        values.transform(columns, &self.along, Direction::Forward);
        let mut values = values.transposed(rows);
        values.transform(rows, &self.down, Direction::Forward);
        values
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
        let area = (self.padded[0] * self.padded[1]) as f32;
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
        let [wide, high] = self.padded;
        // Two real pictures share one complex transform.
        let packed = |pair: &(dyn Fn(&Known) -> (f32, f32) + Sync)| {
            let mut values = Complex::zeros(wide * high);
            for pixel in known {
                let (i, (re, im)) = (pixel.y * wide + pixel.x, pair(pixel));
                (values.re[i], values.im[i]) = (pixel.weight * re, pixel.weight * im);
            }
            self.forward(values)
        };
        let (mask_and_red, green_and_blue) = rayon::join(
            || packed(&|pixel| (1.0, pixel.colour[0])),
            || packed(&|pixel| (pixel.colour[1], pixel.colour[2])),
        );
        let constant: f32 = known.iter().map(|pixel| pixel.weight * squared_error(pixel.colour, [0.0; 3])).sum();
        // Transposed: index = x * high + y.
        let mut product = Complex::zeros(wide * high);
        for x in 0..wide {
            for y in 0..high {
                let i = x * high + y;
                let mirrored = (wide - x) % wide * high + (high - y) % high;
                let parts = |z: &Complex| {
                    let ([re, im], [there_re, there_im]) = (z.at(i), z.at(mirrored));
                    let sums = [re + there_re, im - there_im, im + there_im, there_re - re];
                    let [a, b, c, d] = sums.map(|sum| 0.5 * sum);
                    ([a, b], [c, d])
                };
                let ((mask, red), (green, blue)) = (parts(&mask_and_red), parts(&green_and_blue));
                let [red, green, blue, mask] = [(red, 0), (green, 1), (blue, 2), (mask, 3)]
                    .map(|(part, spectrum)| times_conjugate(self.spectra[spectrum].at(i), part));
                let sum = |axis: usize| mask[axis] - 2.0 * (red[axis] + green[axis] + blue[axis]);
                (product.re[i], product.im[i]) = (sum(0), sum(1));
            }
        }
        product.transform(high, &self.down, Direction::Inverse);
        let mut product = product.transposed(wide);
        product.transform(wide, &self.along, Direction::Inverse);
        let row = |y: usize| product.re[y * wide..][..columns].iter().map(|error| error + constant);
        (0..rows).flat_map(row).collect()
    }
}

#[cfg(test)]
mod tests;
