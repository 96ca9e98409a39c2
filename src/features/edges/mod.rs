//! Edges: grey, 3×3 Gauss, an operator, threshold; kept near the silhouette (METHOD A5.2).

mod canny;
mod gradient;
mod laplace;
mod smooth;

use image::RgbImage;
use serde::Deserialize;

pub use gradient::Magnitude;

use self::canny::Gradients;
use self::gradient::{Gradient, GradientRows};
use self::laplace::{Laplacian, crosses_zero};
use self::smooth::SmoothPicture;
use super::blobs::Components;
use super::{BitImage, Region};
use crate::files::choices;

choices! {
    /// What finds the edges. `glsl/features/edges.comp` knows them by their places in this list.
    "edge operator" pub enum Operator => detector: Detector {
        /// Two perpendicular Sobels: a straight step of `s` grey levels has magnitude 3 `s` when smoothed, 4 `s` when not.
        "sobel" Sobel => Detector::Gradient(Gradient::Sobel),
        /// Two perpendicular Prewitts: three quarters of that.
        "prewitt" Prewitt => Detector::Gradient(Gradient::Prewitt),
        /// The differences along two diagonals, half a pixel right below: a quarter of Sobel's and less smooth.
        "roberts" Roberts => Detector::Gradient(Gradient::Roberts),
        /// Zero crossings of the mask 0 1 0, 1 -4 1, 0 1 0.
        "laplace4" LaplaceFour => Detector::ZeroCrossings(Laplacian::Four),
        /// Zero crossings of the mask 1 1 1, 1 -8 1, 1 1 1.
        "laplace8" LaplaceEight => Detector::ZeroCrossings(Laplacian::Eight),
        /// Zero crossings of the mask 1 -2 1, -2 4 -2, 1 -2 1.
        "laplace-product" LaplaceProduct => Detector::ZeroCrossings(Laplacian::Product),
        /// Sobels, thinned across the edge; what is weaker than `threshold` and at least `low` strong counts where it hangs
        /// together with something stronger.
        "canny" Canny => Detector::Canny,
    }
}

/// What an operator does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Detector {
    /// Marks strong gradients.
    Gradient(Gradient),
    /// Marks zero crossings of a Laplacian.
    ZeroCrossings(Laplacian),
    /// Thins gradients and follows them.
    Canny,
}

/// How edges are found.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EdgeSettings {
    /// What finds them.
    pub operator: Operator,
    /// Whether the grey picture is smoothed by a 3×3 Gauss first.
    pub smooth: bool,
    /// How the two derivatives become one magnitude; the Laplacians have one only.
    pub magnitude: Magnitude,
    /// The weakest edge: its magnitude, or of the Laplacians how far the response jumps from one sign to the other.
    pub threshold: i16,
    /// The weakest edge that counts beside a stronger one, of Canny only.
    pub low: i16,
    /// Edges are kept where the silhouette dilated by a disc of this size is, pixels, odd.
    pub dilate: u32,
}

impl Default for EdgeSettings {
    fn default() -> Self {
        Self { operator: Operator::Sobel, smooth: true, magnitude: Magnitude::Exact, threshold: 70, low: 35, dilate: 7 }
    }
}

/// The detector and the rows it keeps between frames.
#[derive(Clone, Debug, Default)]
pub struct EdgeDetector {
    smooth: SmoothPicture,
    rows: GradientRows,
    gradients: Gradients,
    responses: Vec<i16>,
    flags: Vec<u8>,
    strong_flags: Vec<u8>,
    strong: BitImage,
    components: Components,
}

impl EdgeDetector {
    /// Marks in `edges` (of the picture's size) the edges among the pixels of `within` (likewise). Pixels outside the picture
    /// repeat its border.
    pub fn detect(&mut self, picture: &RgbImage, within: &BitImage, settings: &EdgeSettings, edges: &mut BitImage) {
        edges.clear();
        let Some(region) = within.bounds() else { return };
        match settings.operator.detector() {
            Detector::Gradient(masks) => self.gradient(picture, region, masks, settings, edges),
            Detector::ZeroCrossings(mask) => self.laplace(picture, region, mask, settings, edges),
            Detector::Canny => self.canny(picture, region, settings, edges),
        }
        edges.and(within);
        if settings.operator == Operator::Canny {
            // Only here, so that what hangs together does so inside of `within`.
            self.components.keep_touched(edges, &self.strong);
        }
    }

    /// Where the gradient is strong.
    fn gradient(
        &mut self,
        picture: &RgbImage,
        region: Region,
        gradient: Gradient,
        settings: &EdgeSettings,
        edges: &mut BitImage,
    ) {
        self.smooth.take(picture, region, settings.smooth);
        self.flags.clear();
        self.flags.resize(picture.width() as usize, 0);
        let threshold = settings.threshold;
        for y in region.y0..region.y1 {
            let rows = self.smooth.around((y - region.y0) as usize);
            let flags = &mut self.flags[region.x0 as usize..region.x1 as usize];
            // The choice is made outside the loops over pixels, which then have no branch.
            match settings.magnitude {
                Magnitude::Exact => {
                    self.rows.map(gradient, rows, flags, |gx, gy| u8::from(Magnitude::Exact.reaches(gx, gy, threshold)))
                }
                Magnitude::Sum => {
                    self.rows.map(gradient, rows, flags, |gx, gy| u8::from(Magnitude::Sum.reaches(gx, gy, threshold)))
                }
                Magnitude::Max => {
                    self.rows.map(gradient, rows, flags, |gx, gy| u8::from(Magnitude::Max.reaches(gx, gy, threshold)))
                }
            }
            edges.pack_row(y as usize, &self.flags);
        }
    }

    /// Where the Laplacian crosses zero.
    fn laplace(
        &mut self,
        picture: &RgbImage,
        region: Region,
        mask: Laplacian,
        settings: &EdgeSettings,
        edges: &mut BitImage,
    ) {
        // The neighbours' responses too.
        let outer = region.enlarged(1, picture.width(), picture.height());
        let (width, height) = (outer.width() as usize, outer.height() as usize);
        self.smooth.take(picture, outer, settings.smooth);
        self.responses.resize(width * height, 0);
        for (y, responses) in self.responses.chunks_exact_mut(width).take(height).enumerate() {
            mask.row(self.smooth.around(y), responses);
        }
        self.flags.clear();
        self.flags.resize(picture.width() as usize, 0);
        for y in region.y0..region.y1 {
            for x in region.x0..region.x1 {
                let (column, row) = ((x - outer.x0) as usize, (y - outer.y0) as usize);
                let response = |x: usize, y: usize| (x < width && y < height).then(|| self.responses[y * width + x]);
                let neighbours = [
                    response(column.wrapping_sub(1), row),
                    response(column + 1, row),
                    response(column, row.wrapping_sub(1)),
                    response(column, row + 1),
                ];
                let here = self.responses[row * width + column];
                self.flags[x as usize] = u8::from(crosses_zero(here, neighbours, settings.threshold));
            }
            edges.pack_row(y as usize, &self.flags);
        }
    }

    /// Thinned gradients of at least `low` into `edges`, those of at least `threshold` into `self.strong`.
    fn canny(&mut self, picture: &RgbImage, region: Region, settings: &EdgeSettings, edges: &mut BitImage) {
        let outer = region.enlarged(1, picture.width(), picture.height());
        self.smooth.take(picture, outer, settings.smooth);
        self.gradients.resize(outer.width() as usize, outer.height() as usize);
        for y in 0..outer.height() as usize {
            self.rows.map(Gradient::Sobel, self.smooth.around(y), self.gradients.row_mut(y), |gx, gy| (gx, gy));
        }
        let magnitude = settings.magnitude;
        let [low, high] = [settings.low, settings.threshold].map(|threshold| magnitude.order_of(threshold));
        for flags in [&mut self.flags, &mut self.strong_flags] {
            flags.clear();
            flags.resize(picture.width() as usize, 0);
        }
        self.strong.resize(picture.width(), picture.height());
        for y in region.y0..region.y1 {
            for x in region.x0..region.x1 {
                let order = self.gradients.largest_across((x - outer.x0) as usize, (y - outer.y0) as usize, magnitude);
                self.flags[x as usize] = u8::from(order >= low);
                self.strong_flags[x as usize] = u8::from(order >= high);
            }
            edges.pack_row(y as usize, &self.flags);
            self.strong.pack_row(y as usize, &self.strong_flags);
        }
    }
}

#[cfg(test)]
mod tests;
