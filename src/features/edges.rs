//! The tracker's edges: grey, 3×3 Gauss, two perpendicular Sobels, threshold; kept near the silhouette (SPEC A5.2).

use image::RgbImage;
use serde::Deserialize;

use super::{BitImage, Region};

/// How the two derivatives become one magnitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Magnitude {
    /// √(gx² + gy²).
    Exact,
    /// |gx| + |gy|.
    Sum,
    /// max(|gx|, |gy|).
    Max,
}

impl Magnitude {
    /// Whether the gradient is at least `threshold` strong. All in integers: the exact magnitude is compared squared.
    #[inline]
    fn reaches(self, gx: i16, gy: i16, threshold: i16) -> bool {
        match self {
            Self::Exact => {
                let (gx, gy, threshold) = (i32::from(gx), i32::from(gy), i32::from(threshold));
                gx * gx + gy * gy >= threshold * threshold
            }
            Self::Sum => gx.abs() + gy.abs() >= threshold,
            Self::Max => gx.abs().max(gy.abs()) >= threshold,
        }
    }
}

/// The detector and the rows it keeps between frames.
#[derive(Clone, Debug, Default)]
pub struct EdgeDetector {
    /// Smoothed grey values of the region and one pixel around it, row-major.
    smooth: Vec<u8>,
    gray: [Vec<u8>; 3],
    columns: Vec<i16>,
    differences: Vec<i16>,
    sums: Vec<u16>,
    flags: Vec<u8>,
}

impl EdgeDetector {
    /// Marks in `edges` (of the picture's size) the pixels of `region` whose gradient is at least `threshold` strong;
    /// a step of `s` grey levels has the strength 3 `s` here. Pixels outside the picture repeat its border.
    pub fn detect(
        &mut self,
        picture: &RgbImage,
        region: Region,
        magnitude: Magnitude,
        threshold: i16,
        edges: &mut BitImage,
    ) {
        edges.clear();
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let (x0, x1) = (region.x0 as usize, (region.x1 as usize).min(width));
        let (y0, y1) = (region.y0 as usize, (region.y1 as usize).min(height));
        if x0 >= x1 || y0 >= y1 {
            return;
        }
        // One column more on each side for the Sobels.
        let stride = x1 - x0 + 2;
        self.smooth_rows(picture, x0, y0, stride, y1 - y0 + 2);
        self.columns.resize(stride, 0);
        self.differences.resize(stride, 0);
        self.flags.clear();
        self.flags.resize(width, 0);
        for y in y0..y1 {
            let above = &self.smooth[(y - y0) * stride..][..stride];
            let here = &self.smooth[(y - y0 + 1) * stride..][..stride];
            let below = &self.smooth[(y - y0 + 2) * stride..][..stride];
            for ((((column, difference), &a), &b), &c) in
                self.columns.iter_mut().zip(&mut self.differences).zip(above).zip(here).zip(below)
            {
                *column = i16::from(a) + 2 * i16::from(b) + i16::from(c);
                *difference = i16::from(c) - i16::from(a);
            }
            let flags = &mut self.flags[x0..x1];
            // The choice is made outside the loops over pixels, which then have no branch.
            match magnitude {
                Magnitude::Exact => flag_row(&self.columns, &self.differences, flags, |gx, gy| {
                    Magnitude::Exact.reaches(gx, gy, threshold)
                }),
                Magnitude::Sum => flag_row(&self.columns, &self.differences, flags, |gx, gy| {
                    Magnitude::Sum.reaches(gx, gy, threshold)
                }),
                Magnitude::Max => flag_row(&self.columns, &self.differences, flags, |gx, gy| {
                    Magnitude::Max.reaches(gx, gy, threshold)
                }),
            }
            edges.pack_row(y, &self.flags);
        }
    }

    /// Fills `self.smooth` with `rows` rows of `stride` smoothed values, the first for the pixel left above (x0, y0).
    fn smooth_rows(&mut self, picture: &RgbImage, x0: usize, y0: usize, stride: usize, rows: usize) {
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        self.smooth.resize(stride * rows, 0);
        self.sums.resize(stride + 2, 0);
        self.gray.iter_mut().for_each(|row| row.resize(stride + 2, 0));
        // Position i of a grey row is the picture's column x0 + i - 2.
        let first = x0 as isize - 2;
        let gray_row = |y: isize, row: &mut [u8]| {
            let y = y.clamp(0, height as isize - 1) as usize;
            gray_columns(&picture.as_raw()[y * width * 3..][..width * 3], first, row);
        };
        for row in 0..rows {
            let y = (y0 + row) as isize - 1;
            if y < 0 || y >= height as isize {
                continue;
            }
            if row <= 1 {
                let [above, here, below] = &mut self.gray;
                gray_row(y - 1, above);
                gray_row(y, here);
                gray_row(y + 1, below);
            } else {
                self.gray.rotate_left(1);
                gray_row(y + 1, &mut self.gray[2]);
            }
            let [above, here, below] = &self.gray;
            for (((sum, &a), &b), &c) in self.sums.iter_mut().zip(above).zip(here).zip(below) {
                *sum = u16::from(a) + 2 * u16::from(b) + u16::from(c);
            }
            let smooth = &mut self.smooth[row * stride..][..stride];
            for (value, window) in smooth.iter_mut().zip(self.sums.windows(3)) {
                *value = ((window[0] + 2 * window[1] + window[2] + 8) >> 4) as u8;
            }
            // Where the region touches the picture's border the smoothed picture repeats its own border.
            if x0 == 0 {
                smooth[0] = smooth[1];
            }
            if x0 + stride - 2 == width {
                smooth[stride - 1] = smooth[stride - 2];
            }
        }
        if y0 == 0 {
            self.smooth.copy_within(stride..2 * stride, 0);
        }
        if y0 + rows - 2 == height {
            self.smooth.copy_within((rows - 2) * stride..(rows - 1) * stride, (rows - 1) * stride);
        }
    }
}

#[inline]
fn flag_row(columns: &[i16], differences: &[i16], flags: &mut [u8], reaches: impl Fn(i16, i16) -> bool) {
    for ((flag, c), d) in flags.iter_mut().zip(columns.windows(3)).zip(differences.windows(3)) {
        *flag = u8::from(reaches(c[2] - c[0], d[0] + 2 * d[1] + d[2]));
    }
}

/// The grey value of a colour: 0.30 red + 0.59 green + 0.11 blue, in 256ths.
#[inline]
fn gray(r: u8, g: u8, b: u8) -> u8 {
    ((77 * u16::from(r) + 151 * u16::from(g) + 28 * u16::from(b)) >> 8) as u8
}

/// Grey values of `row.len()` columns from column `first` on; columns outside the picture repeat its border.
fn gray_columns(rgb: &[u8], first: isize, row: &mut [u8]) {
    let (pixels, _) = rgb.as_chunks::<3>();
    let width = pixels.len() as isize;
    let at = |column: isize| {
        let [r, g, b] = pixels[column.clamp(0, width - 1) as usize];
        gray(r, g, b)
    };
    let inner = (-first).clamp(0, row.len() as isize) as usize;
    let outer = (width - first).clamp(inner as isize, row.len() as isize) as usize;
    for (column, value) in (first..).zip(&mut row[..inner]) {
        *value = at(column);
    }
    if outer > inner {
        let start = (first + inner as isize) as usize;
        for (value, &[r, g, b]) in row[inner..outer].iter_mut().zip(&pixels[start..]) {
            *value = gray(r, g, b);
        }
    }
    for (column, value) in (first + outer as isize..).zip(&mut row[outer..]) {
        *value = at(column);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;
    use proptest::prelude::*;

    fn convolved(image: &[i32], width: i32, height: i32, kernel: [[i32; 3]; 3]) -> Vec<i32> {
        let at = |x: i32, y: i32| image[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
        let mut result = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let mut sum = 0;
                for (dy, row) in (-1..).zip(kernel) {
                    for (dx, weight) in (-1..).zip(row) {
                        sum += weight * at(x + dx, y + dy);
                    }
                }
                result.push(sum);
            }
        }
        result
    }

    /// The same by direct convolution of the whole picture with the three written-out kernels.
    fn expected(picture: &RgbImage, region: Region, magnitude: Magnitude, threshold: i32) -> BitImage {
        let (width, height) = (picture.width() as i32, picture.height() as i32);
        let gray: Vec<i32> = picture
            .pixels()
            .map(|p| (77 * i32::from(p[0]) + 151 * i32::from(p[1]) + 28 * i32::from(p[2])) / 256)
            .collect();
        let smooth: Vec<i32> = convolved(&gray, width, height, [[1, 2, 1], [2, 4, 2], [1, 2, 1]])
            .iter()
            .map(|sum| (sum + 8) / 16)
            .collect();
        let gx = convolved(&smooth, width, height, [[-1, 0, 1], [-2, 0, 2], [-1, 0, 1]]);
        let gy = convolved(&smooth, width, height, [[-1, -2, -1], [0, 0, 0], [1, 2, 1]]);
        BitImage::from_fn(picture.width(), picture.height(), |x, y| {
            let at = (y as i32 * width + x as i32) as usize;
            let (gx, gy) = (gx[at], gy[at]);
            let strength = match magnitude {
                Magnitude::Exact => f64::from(gx * gx + gy * gy).sqrt(),
                Magnitude::Sum => f64::from(gx.abs() + gy.abs()),
                Magnitude::Max => f64::from(gx.abs().max(gy.abs())),
            };
            x >= region.x0 && x < region.x1 && y >= region.y0 && y < region.y1 && strength >= f64::from(threshold)
        })
    }

    fn any_picture() -> impl Strategy<Value = RgbImage> {
        (1_u32..90, 1_u32..12).prop_flat_map(|(width, height)| {
            proptest::collection::vec(any::<u8>(), (width * height * 3) as usize)
                .prop_map(move |bytes| RgbImage::from_raw(width, height, bytes).unwrap())
        })
    }

    proptest! {
        #[test]
        fn matches_direct_convolution(
            picture in any_picture(),
            corners in (0_u32..90, 0_u32..90, 0_u32..12, 0_u32..12),
            threshold in 1_i16..600,
            whole in any::<bool>(),
        ) {
            let (width, height) = picture.dimensions();
            let region = if whole {
                Region::whole(width, height)
            } else {
                Region {
                    x0: corners.0.min(corners.1).min(width),
                    x1: corners.0.max(corners.1).min(width),
                    y0: corners.2.min(corners.3).min(height),
                    y1: corners.2.max(corners.3).min(height),
                }
            };
            let mut detector = EdgeDetector::default();
            let mut edges = BitImage::new(width, height);
            for magnitude in [Magnitude::Exact, Magnitude::Sum, Magnitude::Max] {
                // Twice: what the first left in the buffers must not show.
                for _ in 0..2 {
                    detector.detect(&picture, region, magnitude, threshold, &mut edges);
                    prop_assert_eq!(&edges, &expected(&picture, region, magnitude, i32::from(threshold)));
                }
            }
        }
    }

    #[test]
    fn a_step_is_an_edge_and_a_changed_pixel_shows() {
        let mut picture = RgbImage::from_fn(40, 9, |x, _| Rgb(if x < 20 { [20; 3] } else { [60; 3] }));
        let mut edges = BitImage::new(40, 9);
        let mut detector = EdgeDetector::default();
        let whole = Region::whole(40, 9);
        detector.detect(&picture, whole, Magnitude::Exact, 120, &mut edges);
        assert_eq!(edges, BitImage::from_fn(40, 9, |x, _| x == 19 || x == 20), "a step of 40 has strength 120");
        picture.put_pixel(5, 4, Rgb([255; 3]));
        assert_ne!(edges, expected(&picture, whole, Magnitude::Exact, 120));
    }
}
