//! Resampling to the working size. Exact integer arithmetic: the same bytes on every machine.

use image::{GrayImage, RgbImage};

/// The picture at a smaller (or equal) size, each new pixel the mean of the area it covers, halves rounded up.
/// Along an axis where `size` is larger than the picture, pixels are repeated by the same rule.
pub(super) fn area_average(picture: RgbImage, size: [u32; 2]) -> RgbImage {
    let (from_width, from_height) = picture.dimensions();
    let [width, height] = size;
    if [from_width, from_height] == size || width == 0 || height == 0 || from_width == 0 || from_height == 0 {
        return picture;
    }
    if from_width.is_multiple_of(width) && from_height.is_multiple_of(height) {
        return box_average(&picture, size);
    }
    let columns = Span::cover(from_width, width);
    let rows = Span::cover(from_height, height);
    // The weights of one new pixel add up to this.
    let total = u64::from(from_width) * u64::from(from_height);
    let mut out = RgbImage::new(width, height);
    let stride = from_width as usize * 3;
    let source = picture.as_raw();
    let mut sums = vec![0_u64; stride];
    for (row, target) in rows.iter().zip(out.chunks_exact_mut(width as usize * 3)) {
        sums.fill(0);
        for (step, line) in source[row.first * stride..].chunks_exact(stride).take(row.weights.len()).enumerate() {
            let weight = u64::from(row.weights[step]);
            for (sum, &value) in sums.iter_mut().zip(line) {
                *sum += weight * u64::from(value);
            }
        }
        for (column, pixel) in columns.iter().zip(target.chunks_exact_mut(3)) {
            let mut mean = [0_u64; 3];
            for (&weight, sum) in column.weights.iter().zip(sums[column.first * 3..].chunks_exact(3)) {
                for (mean, &sum) in mean.iter_mut().zip(sum) {
                    *mean += u64::from(weight) * sum;
                }
            }
            for (value, sum) in pixel.iter_mut().zip(mean) {
                *value = ((2 * sum + total) / (2 * total)) as u8;
            }
        }
    }
    out
}

/// [`area_average`] where both ratios are whole: all weights are one.
fn box_average(picture: &RgbImage, size: [u32; 2]) -> RgbImage {
    let [width, height] = size;
    let (across, down) = ((picture.width() / width) as usize, (picture.height() / height) as usize);
    let stride = picture.width() as usize * 3;
    let area = (across * down) as u64;
    let mut out = RgbImage::new(width, height);
    let mut sums = vec![0_u32; stride];
    for (block, target) in picture.as_raw().chunks_exact(stride * down).zip(out.chunks_exact_mut(width as usize * 3)) {
        sums.fill(0);
        for line in block.chunks_exact(stride) {
            for (sum, &value) in sums.iter_mut().zip(line) {
                *sum += u32::from(value);
            }
        }
        for (cell, pixel) in sums.chunks_exact(across * 3).zip(target.chunks_exact_mut(3)) {
            for (channel, value) in pixel.iter_mut().enumerate() {
                let sum: u64 = cell.iter().skip(channel).step_by(3).map(|&value| u64::from(value)).sum();
                *value = ((2 * sum + area) / (2 * area)) as u8;
            }
        }
    }
    out
}

/// The old pixels under one new pixel along an axis, with how much of each: in units of 1/new of an old pixel, so the
/// weights are whole numbers that add up to the old size.
struct Span {
    first: usize,
    weights: Vec<u32>,
}

impl Span {
    fn cover(from: u32, to: u32) -> Vec<Self> {
        let (from, to) = (u64::from(from), u64::from(to));
        (0..to)
            .map(|index| {
                let (start, end) = (index * from, (index + 1) * from);
                let (first, past) = (start / to, end.div_ceil(to));
                let weights =
                    (first..past).map(|pixel| (end.min((pixel + 1) * to) - start.max(pixel * to)) as u32).collect();
                Self { first: first as usize, weights }
            })
            .collect()
    }
}

/// The silhouette at another size: 255 where the nearest pixel's value is at least 128, else 0.
pub(super) fn nearest_mask(mask: &GrayImage, size: [u32; 2]) -> GrayImage {
    let [width, height] = size;
    // The pixel under the centre of the new one: (x + 1/2) old/new, rounded down.
    let under =
        |index: u32, from: u32, to: u32| ((2 * u64::from(index) + 1) * u64::from(from) / (2 * u64::from(to))) as u32;
    GrayImage::from_fn(width, height, |x, y| {
        let value = mask.get_pixel(under(x, mask.width(), width), under(y, mask.height(), height))[0];
        image::Luma([if value >= 128 { 255 } else { 0 }])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(width: u32, height: u32) -> RgbImage {
        let mut state = 1_u32;
        RgbImage::from_fn(width, height, |_, _| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            image::Rgb([(state >> 24) as u8, (state >> 16) as u8, (state >> 8) as u8])
        })
    }

    /// The mean by definition, in floating point.
    fn slow(picture: &RgbImage, size: [u32; 2]) -> RgbImage {
        let (across, down) =
            (f64::from(picture.width()) / f64::from(size[0]), f64::from(picture.height()) / f64::from(size[1]));
        RgbImage::from_fn(size[0], size[1], |x, y| {
            let overlap = |from: u32, index: u32, ratio: f64| {
                let (start, end) = (f64::from(index) * ratio, f64::from(index + 1) * ratio);
                (end.min(f64::from(from + 1)) - start.max(f64::from(from))).max(0.0)
            };
            let mut sums = [0.0; 3];
            for (u, v, pixel) in picture.enumerate_pixels() {
                let weight = overlap(u, x, across) * overlap(v, y, down);
                for channel in 0..3 {
                    sums[channel] += weight * f64::from(pixel[channel]);
                }
            }
            image::Rgb(sums.map(|sum| (sum / (across * down) + 0.5 + 1e-9).floor() as u8))
        })
    }

    #[test]
    fn the_area_average_is_the_mean_by_definition() {
        for (from, to) in [([12, 8], [3, 4]), ([13, 7], [5, 3]), ([9, 9], [1, 1]), ([10, 6], [10, 4]), ([5, 4], [4, 4])]
        {
            let picture = noise(from[0], from[1]);
            assert_eq!(area_average(picture.clone(), to), slow(&picture, to), "{from:?} to {to:?}");
        }
        let picture = noise(6, 5);
        assert_eq!(area_average(picture.clone(), [6, 5]), picture);
    }

    #[test]
    fn masks_take_the_nearest_pixel_and_become_black_or_white() {
        let mask = GrayImage::from_fn(4, 2, |x, _| image::Luma([[0, 127, 128, 200][x as usize]]));
        assert_eq!(nearest_mask(&mask, [4, 1]).into_raw(), [0, 0, 255, 255]);
        assert_eq!(nearest_mask(&mask, [2, 1]).into_raw(), [0, 255]);
        assert_eq!(nearest_mask(&mask, [8, 1]).into_raw(), [0, 0, 0, 0, 255, 255, 255, 255]);
    }
}
