//! The model drawn over a picture, with soft edges.

use anyhow::{Result, ensure};
use glam::DVec2;
use image::{Rgb, RgbImage, imageops};

/// One flat part of the body as a camera sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverlayPolygon {
    /// Corners in pixels of the picture, in order round the part.
    pub corners: [DVec2; 4],
    /// Red, green, blue.
    pub colour: [u8; 3],
}

/// A picture being drawn on, larger or smaller than the original. Positions are always given in pixels of the original
/// (origin in the middle of the top-left pixel); what is not finite or far outside is left out.
#[derive(Clone, Debug)]
pub struct Canvas {
    pixels: RgbImage,
    scale: f64,
}

/// Points farther out than this many canvas pixels belong to no picture (parts close to the camera's plane).
const FARTHEST: f64 = 1e5;
/// Sub-pixels a side with which polygons are filled.
const SUB: u32 = 4;

/// A clear colour for a part: sides in different hues (left cool, right warm, middle green), nearer the hand or foot
/// the lighter. `label` is any small number for a part whose name does not say where it is.
pub fn part_colour(name: &str, label: u8) -> [u8; 3] {
    let step = match name {
        n if n.contains("thigh") || n.contains("upper") => 0,
        n if n.contains("calf") || n.contains("shank") || n.contains("forearm") => 1,
        n if n.contains("foot") || n.contains("hand") => 2,
        _ => usize::from(label) % 3,
    };
    let leg = ["thigh", "calf", "shank", "foot"].iter().any(|part| name.contains(part));
    match (name.starts_with("left") || name.ends_with("left"), name.starts_with("right") || name.ends_with("right")) {
        (true, _) if leg => [[40, 120, 220], [70, 160, 240], [130, 200, 250]][step],
        (true, _) => [[90, 80, 210], [130, 110, 235], [175, 155, 250]][step],
        (_, true) if leg => [[225, 95, 40], [245, 140, 60], [250, 190, 110]][step],
        (_, true) => [[210, 50, 100], [235, 95, 135], [250, 150, 180]][step],
        _ => [[40, 170, 120], [90, 195, 140], [150, 215, 90]][step],
    }
}

impl Canvas {
    /// Starts from a picture, resized by `scale` (at least to one pixel).
    pub fn new(picture: &RgbImage, scale: f64) -> Self {
        let scale = if scale.is_finite() { scale.clamp(0.01, 16.0) } else { 1.0 };
        let side = |length: u32| ((f64::from(length) * scale).round() as u32).max(1);
        let (width, height) = (side(picture.width()), side(picture.height()));
        let pixels = if (width, height) == picture.dimensions() {
            picture.clone()
        } else {
            imageops::resize(picture, width, height, imageops::FilterType::Triangle)
        };
        Self { pixels, scale }
    }

    /// The picture drawn so far.
    pub fn into_picture(self) -> RgbImage {
        self.pixels
    }

    /// Fills a polygon with `opacity` 0 to 1 and draws its outline.
    pub fn polygon(&mut self, polygon: &OverlayPolygon, opacity: f64) {
        let Some(corners) = self.place(polygon.corners) else { return };
        let (low, high) = corners.iter().fold((corners[0], corners[0]), |(l, h), &c| (l.min(c), h.max(c)));
        self.blend_box(low, high, polygon.colour, |p| {
            let inside = (0..SUB * SUB)
                .filter(|i| {
                    let shift = DVec2::new(f64::from(i % SUB) + 0.5, f64::from(i / SUB) + 0.5) / f64::from(SUB) - 0.5;
                    contains(&corners, p + shift)
                })
                .count();
            opacity * inside as f64 / f64::from(SUB * SUB)
        });
        for i in 0..4 {
            self.segment(corners[i], corners[(i + 1) % 4], 0.8, polygon.colour, 0.9);
        }
    }

    /// A line of `width` canvas pixels with round ends.
    pub fn line(&mut self, a: DVec2, b: DVec2, width: f64, colour: [u8; 3], opacity: f64) {
        if let Some([a, b]) = self.place([a, b]) {
            self.segment(a, b, 0.5 * width, colour, opacity);
        }
    }

    /// Bones as pale lines with a dark rim and the joints as dots.
    pub fn skeleton(&mut self, bones: &[[DVec2; 2]]) {
        for (width, colour) in [(3.6, [20, 24, 30]), (1.8, [255, 255, 255])] {
            for [a, b] in bones {
                self.line(*a, *b, width, colour, 0.85);
            }
        }
        for joint in bones.iter().flatten() {
            self.line(*joint, *joint, 5.0, [20, 24, 30], 0.9);
            self.line(*joint, *joint, 3.0, [255, 214, 70], 1.0);
        }
    }

    /// The boundary of a silhouette: `inside(x, y)` for pixels of a picture of `size`, in its original resolution.
    pub fn silhouette(&mut self, size: [u32; 2], inside: impl Fn(u32, u32) -> bool, colour: [u8; 3]) {
        // Where two neighbours differ, the border between them is a line of the picture.
        for y in 0..size[1] {
            for x in 0..size[0] {
                let here = inside(x, y);
                let (fx, fy) = (f64::from(x), f64::from(y));
                if x + 1 < size[0] && inside(x + 1, y) != here {
                    self.line(DVec2::new(fx + 0.5, fy - 0.5), DVec2::new(fx + 0.5, fy + 0.5), 1.2, colour, 0.9);
                }
                if y + 1 < size[1] && inside(x, y + 1) != here {
                    self.line(DVec2::new(fx - 0.5, fy + 0.5), DVec2::new(fx + 0.5, fy + 0.5), 1.2, colour, 0.9);
                }
            }
        }
    }

    /// Canvas positions of points of the picture, if all can be drawn.
    fn place<const N: usize>(&self, points: [DVec2; N]) -> Option<[DVec2; N]> {
        let placed = points.map(|p| (p + 0.5) * self.scale - 0.5);
        placed.iter().all(|p| p.is_finite() && p.abs().max_element() < FARTHEST).then_some(placed)
    }

    fn segment(&mut self, a: DVec2, b: DVec2, half_width: f64, colour: [u8; 3], opacity: f64) {
        let along = b - a;
        let squared = along.length_squared();
        let reach = half_width + 1.0;
        self.blend_box(a.min(b) - reach, a.max(b) + reach, colour, |p| {
            let t = if squared > 0.0 { ((p - a).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
            let distance = (a + along * t).distance(p);
            opacity * (half_width + 0.5 - distance).clamp(0.0, 1.0)
        });
    }

    /// Mixes `colour` into the pixels from `low` to `high` with the weight that `weight` gives at their middles.
    fn blend_box(&mut self, low: DVec2, high: DVec2, colour: [u8; 3], weight: impl Fn(DVec2) -> f64) {
        let (width, height) = self.pixels.dimensions();
        if high.x < -1.0 || high.y < -1.0 {
            return;
        }
        let last = |value: f64, side: u32| (value.ceil().max(0.0) as u32).min(side.saturating_sub(1));
        for y in low.y.floor().max(0.0) as u32..=last(high.y, height) {
            for x in low.x.floor().max(0.0) as u32..=last(high.x, width) {
                if x >= width || y >= height {
                    continue;
                }
                let weight = weight(DVec2::new(f64::from(x), f64::from(y))).clamp(0.0, 1.0);
                if weight > 0.0 {
                    let pixel = self.pixels.get_pixel_mut(x, y);
                    for (old, new) in pixel.0.iter_mut().zip(colour) {
                        *old = (f64::from(*old) * (1.0 - weight) + f64::from(new) * weight).round() as u8;
                    }
                }
            }
        }
    }
}

/// Even-odd rule.
fn contains(corners: &[DVec2; 4], p: DVec2) -> bool {
    let mut inside = false;
    for i in 0..4 {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

/// Pictures in rows of `columns` with a gap of `gap` white pixels; smaller ones stand at the top left of their cell.
///
/// # Errors
/// When there is no picture or no column.
pub fn side_by_side(pictures: &[RgbImage], columns: usize, gap: u32) -> Result<RgbImage> {
    ensure!(!pictures.is_empty() && columns > 0, "no pictures to put side by side");
    let columns = columns.min(pictures.len());
    let rows = pictures.len().div_ceil(columns) as u32;
    let width = pictures.iter().map(RgbImage::width).max().unwrap_or(1);
    let height = pictures.iter().map(RgbImage::height).max().unwrap_or(1);
    let all = (columns as u32 * (width + gap) - gap, rows * (height + gap) - gap);
    let mut sheet = RgbImage::from_pixel(all.0, all.1, Rgb([255; 3]));
    for (index, picture) in pictures.iter().enumerate() {
        let (column, row) = ((index % columns) as u32, (index / columns) as u32);
        imageops::replace(&mut sheet, picture, i64::from(column * (width + gap)), i64::from(row * (height + gap)));
    }
    Ok(sheet)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: u32, height: u32) -> RgbImage {
        RgbImage::from_pixel(width, height, Rgb([100; 3]))
    }

    fn rectangle(low: [f64; 2], high: [f64; 2]) -> OverlayPolygon {
        let corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]].map(DVec2::from);
        OverlayPolygon { corners, colour: [255, 0, 0] }
    }

    #[test]
    fn a_rectangle_covers_its_pixels_and_no_others() {
        let mut canvas = Canvas::new(&grey(20, 10), 2.0);
        canvas.polygon(&rectangle([4.5, 2.5], [9.5, 6.5]), 0.5);
        let picture = canvas.into_picture();
        assert_eq!(picture.dimensions(), (40, 20));
        assert_eq!(picture.get_pixel(14, 9).0, [178, 50, 50], "half red inside");
        assert_eq!(picture.get_pixel(25, 9).0, [100; 3], "nothing outside");
        assert_eq!(picture.get_pixel(14, 16).0, [100; 3]);
    }

    #[test]
    fn wild_positions_change_nothing_and_do_not_hang() {
        let mut canvas = Canvas::new(&grey(8, 8), 1.0);
        for value in [f64::NAN, f64::INFINITY, -1e300, 1e7] {
            canvas.polygon(&rectangle([value, 0.0], [4.0, 4.0]), 1.0);
            canvas.line(DVec2::splat(value), DVec2::ONE, 3.0, [1, 2, 3], 1.0);
        }
        canvas.line(DVec2::splat(-500.0), DVec2::new(-20.0, 3.0), 3.0, [1, 2, 3], 1.0);
        canvas.line(DVec2::splat(500.0), DVec2::new(20.0, 30.0), 3.0, [1, 2, 3], 1.0);
        assert_eq!(canvas.into_picture(), grey(8, 8));
        assert_eq!(Canvas::new(&grey(8, 8), f64::NAN).into_picture(), grey(8, 8));
    }

    #[test]
    fn a_silhouette_is_outlined_where_it_ends() {
        let mut canvas = Canvas::new(&grey(10, 10), 4.0);
        canvas.silhouette([10, 10], |x, y| (3..6).contains(&x) && (3..6).contains(&y), [0, 255, 0]);
        let picture = canvas.into_picture();
        assert!(picture.get_pixel(12, 18).0[1] > 150, "left border");
        assert_eq!(picture.get_pixel(18, 18).0, [100; 3], "its middle stays");
        assert_eq!(picture.get_pixel(4, 4).0, [100; 3]);
    }

    #[test]
    fn pictures_stand_side_by_side() {
        let sheet = side_by_side(&[grey(4, 3), grey(4, 3), grey(4, 3)], 2, 1).unwrap();
        assert_eq!(sheet.dimensions(), (9, 7));
        assert_eq!(sheet.get_pixel(5, 0).0, [100; 3]);
        assert_eq!(sheet.get_pixel(8, 6).0, [255; 3]);
        assert!(side_by_side(&[], 2, 1).is_err());
    }
}
