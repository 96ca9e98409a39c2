//! Edges: grey, 3×3 Gauss, an operator, threshold; kept near the silhouette (METHOD A5.2).

mod canny;
mod detector;
mod gradient;
mod laplace;
mod smooth;

use image::RgbImage;
use serde::Deserialize;

pub use gradient::Magnitude;

pub(super) use self::detector::Detector;

use self::canny::Gradients;
use self::detector::{MarkRow, RespondRow};
use self::gradient::GradientRows;
use self::laplace::crosses_zero;
use self::smooth::SmoothPicture;
use super::blobs::Components;
use super::{BitImage, Region};
use crate::files::choices;

choices! {
    /// What finds the edges. An operator of other weights is a line here; `glsl/features/edges.comp` takes them from it.
    "edge operator" pub enum Operator => pub(super) detector: Detector {
        /// Two perpendicular Sobels: a straight step of `s` grey levels has magnitude 3 `s` when smoothed, 4 `s` when not.
        "sobel" Sobel => Detector::across::<1, 2>(),
        /// Two perpendicular Prewitts: three quarters of that.
        "prewitt" Prewitt => Detector::across::<1, 1>(),
        /// The differences along two diagonals, half a pixel right below: a quarter of Sobel's and less smooth.
        "roberts" Roberts => Detector::diagonals(),
        /// Zero crossings of the mask 0 1 0, 1 -4 1, 0 1 0.
        "laplace4" LaplaceFour => Detector::crossings::<0, 1, -4>(),
        /// Zero crossings of the mask 1 1 1, 1 -8 1, 1 1 1.
        "laplace8" LaplaceEight => Detector::crossings::<1, 1, -8>(),
        // The product of the two second differences: it sees corners and texture, and no straight edge along a row or a column.
        /// Zero crossings of the mask 1 -2 1, -2 4 -2, 1 -2 1.
        "laplace-product" LaplaceProduct => Detector::crossings::<1, -2, 4>(),
        /// Sobels, thinned across the edge; what is weaker than `threshold` and at least `low` strong counts where it hangs
        /// together with something stronger.
        "canny" Canny => Detector::Canny,
    }
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
            Detector::Gradient(mark, _) => self.gradient(picture, region, mark, settings, edges),
            Detector::ZeroCrossings(respond, _) => self.laplace(picture, region, respond, settings, edges),
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
        mark: MarkRow,
        settings: &EdgeSettings,
        edges: &mut BitImage,
    ) {
        self.smooth.take(picture, region, settings.smooth);
        self.flags.clear();
        self.flags.resize(picture.width() as usize, 0);
        for y in region.y0..region.y1 {
            let rows = self.smooth.around((y - region.y0) as usize);
            let flags = &mut self.flags[region.x0 as usize..region.x1 as usize];
            mark(&mut self.rows, rows, flags, settings.magnitude, settings.threshold);
            edges.pack_row(y as usize, &self.flags);
        }
    }

    /// Where the Laplacian crosses zero.
    fn laplace(
        &mut self,
        picture: &RgbImage,
        region: Region,
        respond: RespondRow,
        settings: &EdgeSettings,
        edges: &mut BitImage,
    ) {
        // The neighbours' responses too.
        let outer = region.enlarged(1, picture.width(), picture.height());
        let (width, height) = (outer.width() as usize, outer.height() as usize);
        self.smooth.take(picture, outer, settings.smooth);
        self.responses.resize(width * height, 0);
        for (y, responses) in self.responses.chunks_exact_mut(width).take(height).enumerate() {
            respond(self.smooth.around(y), responses);
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
            self.rows.across::<1, 2, _>(self.smooth.around(y), self.gradients.row_mut(y), |gx, gy| (gx, gy));
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
