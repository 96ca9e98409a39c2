//! Places that were never seen, filled in from around: colours flow in from the border, far ones coarsely, near ones finely.

use image::RgbImage;

use super::super::BitImage;

/// Colours with weights, a picture of a quarter as many pixels a level.
struct Level {
    width: usize,
    height: usize,
    /// Red, green, blue, each times the weight, and the weight.
    values: Vec<[f32; 4]>,
}

impl Level {
    fn of(picture: &RgbImage, unknown: &BitImage) -> Self {
        let known = |(x, y, pixel): (u32, u32, &image::Rgb<u8>)| {
            let [r, g, b] = pixel.0.map(f32::from);
            if unknown.get(x, y) { [0.0; 4] } else { [r, g, b, 1.0] }
        };
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        Self { width, height, values: picture.enumerate_pixels().map(known).collect() }
    }

    /// Half as wide and high; what a pixel knows weighs at most 1.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut values = vec![[0.0_f32; 4]; width * height];
        for (at, value) in self.values.iter().enumerate() {
            let into = &mut values[at / self.width / 2 * width + at % self.width / 2];
            into.iter_mut().zip(value).for_each(|(sum, value)| *sum += value);
        }
        for value in &mut values {
            let weight = value[3].max(1.0);
            value.iter_mut().for_each(|value| *value /= weight);
        }
        Self { width, height, values }
    }

    /// What is not known here is taken from a level of half the size, between its four nearest pixels.
    fn fill_from(&mut self, coarse: &Self) {
        let clamp = |at: isize, end: usize| at.clamp(0, end as isize - 1) as usize;
        for (at, value) in self.values.iter_mut().enumerate() {
            let missing = 1.0 - value[3];
            if missing <= 0.0 {
                continue;
            }
            let (x, y) = ((at % self.width) as isize, (at / self.width) as isize);
            // The pixel itself lies in one of the coarse pixels, a quarter of a pixel from its middle.
            let (side_x, side_y) = (x / 2 + 2 * (x % 2) - 1, y / 2 + 2 * (y % 2) - 1);
            let mut sum = [0.0_f32; 4];
            for (u, across) in [(x / 2, 0.75), (side_x, 0.25)] {
                for (v, down) in [(y / 2, 0.75), (side_y, 0.25)] {
                    let from = coarse.values[clamp(v, coarse.height) * coarse.width + clamp(u, coarse.width)];
                    sum.iter_mut().zip(from).for_each(|(sum, value)| *sum += across * down * value);
                }
            }
            if sum[3] > 0.0 {
                value.iter_mut().zip(sum).for_each(|(value, from)| *value += missing * from / sum[3]);
            }
        }
    }
}

/// Fills in the pixels of a picture that are `unknown`. Where all are, nothing is done.
pub(super) fn fill_in(picture: &mut RgbImage, unknown: &BitImage) {
    if unknown.count() == 0 || unknown.count() == picture.width() * picture.height() {
        return;
    }
    let mut levels = vec![Level::of(picture, unknown)];
    while let Some(level) = levels.last().filter(|level| level.width > 1 || level.height > 1) {
        levels.push(level.halved());
    }
    let mut filled: Option<Level> = None;
    while let Some(mut level) = levels.pop() {
        if let Some(coarse) = &filled {
            level.fill_from(coarse);
        }
        filled = Some(level);
    }
    let Some(level) = filled else { return };
    for ((x, y, pixel), value) in picture.enumerate_pixels_mut().zip(&level.values) {
        if unknown.get(x, y) {
            pixel.0 = [0, 1, 2].map(|channel: usize| value[channel].round().clamp(0.0, 255.0) as u8);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    #[test]
    fn a_hole_in_a_slope_is_filled_as_the_slope_goes_on() {
        let slope = RgbImage::from_fn(70, 50, |x, y| Rgb([(60 + x) as u8, (80 + y) as u8, 100]));
        let unknown = BitImage::from_fn(70, 50, |x, y| (30..42).contains(&x) && (10..40).contains(&y));
        let mut holed = slope.clone();
        for (x, y, pixel) in holed.enumerate_pixels_mut() {
            if unknown.get(x, y) {
                *pixel = Rgb([255, 0, 0]);
            }
        }
        fill_in(&mut holed, &unknown);
        let off = slope.pixels().zip(holed.pixels()).flat_map(|(a, b)| [0, 1, 2].map(|c: usize| a[c].abs_diff(b[c])));
        assert!(
            off.max().unwrap() <= 9,
            "{:?}",
            slope.as_raw().iter().zip(holed.as_raw()).max_by_key(|(a, b)| a.abs_diff(**b))
        );
        for (x, y, pixel) in holed.enumerate_pixels() {
            assert!(unknown.get(x, y) || pixel == slope.get_pixel(x, y));
        }
    }

    #[test]
    fn nothing_known_is_left_as_it_is() {
        let mut picture = RgbImage::from_pixel(3, 2, Rgb([7, 8, 9]));
        fill_in(&mut picture, &BitImage::from_fn(3, 2, |_, _| true));
        assert_eq!(picture, RgbImage::from_pixel(3, 2, Rgb([7, 8, 9])));
    }
}
