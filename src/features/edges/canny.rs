//! Canny's thinning: a gradient is an edge only where it is the largest across the edge.

use super::gradient::Magnitude;

/// The gradients of a region, row-major.
#[derive(Clone, Debug, Default)]
pub(super) struct Gradients {
    width: usize,
    height: usize,
    values: Vec<(i16, i16)>,
}

impl Gradients {
    /// Makes room for `width` × `height` gradients.
    pub(super) fn resize(&mut self, width: usize, height: usize) {
        (self.width, self.height) = (width, height);
        self.values.resize(width * height, (0, 0));
    }

    /// A row, to be written.
    pub(super) fn row_mut(&mut self, y: usize) -> &mut [(i16, i16)] {
        &mut self.values[y * self.width..][..self.width]
    }

    /// The order of the magnitude at (x, y) when it is the largest across the edge, else -1.
    ///
    /// The direction of the gradient is one of four, in steps of 45 degrees. tan 22.5° is √2 - 1, so the gradient is nearer
    /// to a row than to a diagonal when (|gx| + |gy|)² < 2 gx², in whole numbers and never equal but at zero. Of equals across
    /// the edge the first in reading order stays; outside the region there is no gradient.
    pub(super) fn largest_across(&self, x: usize, y: usize, magnitude: Magnitude) -> i32 {
        let (gx, gy) = self.values[y * self.width + x];
        let here = magnitude.order(gx, gy);
        let (wide, tall) = (i32::from(gx).abs(), i32::from(gy).abs());
        let both = (wide + tall) * (wide + tall);
        let (dx, dy) = if both < 2 * wide * wide {
            (1, 0)
        } else if both < 2 * tall * tall {
            (0, 1)
        } else if (gx < 0) == (gy < 0) {
            (1, 1)
        } else {
            (-1, 1)
        };
        let before = self.order_at(x.wrapping_add_signed(-dx), y.wrapping_add_signed(-dy), magnitude);
        let after = self.order_at(x.wrapping_add_signed(dx), y.wrapping_add_signed(dy), magnitude);
        if here > before && here >= after { here } else { -1 }
    }

    fn order_at(&self, x: usize, y: usize, magnitude: Magnitude) -> i32 {
        if x >= self.width || y >= self.height {
            return 0;
        }
        let (gx, gy) = self.values[y * self.width + x];
        magnitude.order(gx, gy)
    }
}
