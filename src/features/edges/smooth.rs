//! From colour to grey, smoothed by a 3×3 Gauss; what lies outside the picture repeats its border.

use image::RgbImage;

use crate::features::Region;

/// Grey values of a region and one pixel around it, and the rows they are made from, kept between frames.
#[derive(Clone, Debug, Default)]
pub(super) struct SmoothPicture {
    stride: usize,
    values: Vec<u8>,
    gray: [Vec<u8>; 3],
    sums: Vec<u16>,
}

impl SmoothPicture {
    /// The three rows around row `y` of the region, each with one column more on either side.
    pub(super) fn around(&self, y: usize) -> [&[u8]; 3] {
        [y, y + 1, y + 2].map(|row| &self.values[row * self.stride..][..self.stride])
    }

    /// Takes the grey values of a region inside the picture that is not empty; `smooth` or as they are.
    pub(super) fn take(&mut self, picture: &RgbImage, region: Region, smooth: bool) {
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let (x0, y0) = (region.x0 as usize, region.y0 as usize);
        let (stride, rows) = (region.width() as usize + 2, region.height() as usize + 2);
        self.stride = stride;
        self.values.resize(stride * rows, 0);
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
            let values = &mut self.values[row * stride..][..stride];
            if smooth {
                for (((sum, &a), &b), &c) in self.sums.iter_mut().zip(above).zip(here).zip(below) {
                    *sum = u16::from(a) + 2 * u16::from(b) + u16::from(c);
                }
                for (value, window) in values.iter_mut().zip(self.sums.windows(3)) {
                    *value = ((window[0] + 2 * window[1] + window[2] + 8) >> 4) as u8;
                }
            } else {
                values.copy_from_slice(&here[1..=stride]);
            }
            // Where the region touches the picture's border the smoothed picture repeats its own border.
            if x0 == 0 {
                values[0] = values[1];
            }
            if x0 + stride - 2 == width {
                values[stride - 1] = values[stride - 2];
            }
        }
        if y0 == 0 {
            self.values.copy_within(stride..2 * stride, 0);
        }
        if y0 + rows - 2 == height {
            self.values.copy_within((rows - 2) * stride..(rows - 1) * stride, (rows - 1) * stride);
        }
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
