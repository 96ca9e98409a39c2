//! Foreground by difference from a picture of the empty scene, with a gain for lighting that has changed since.

use image::RgbImage;
use serde::Deserialize;

use super::light::gains;
use super::shadow::ShadowSettings;

/// The parameters of the plate difference.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PlateSettings {
    /// A pixel this far from the plate (distance in RGB, grey levels) may be foreground …
    pub weak: f32,
    /// … when its blob holds a pixel at least this far from it.
    pub strong: f32,
    /// In a narrow gap between foreground pixels, one this far from the plate is foreground too, and so is one where plate
    /// and picture are both dark: black clothes before black furniture.
    pub faint: f32,
    /// Size of the gaps that are bridged so, pixels, odd; 1 for none.
    pub bridge: u32,
    /// Whether each picture's brightness is first fitted to the plate's, channel by channel.
    pub gain: bool,
}

impl Default for PlateSettings {
    fn default() -> Self {
        Self { weak: 26.0, strong: 60.0, faint: 8.0, bridge: 15, gain: true }
    }
}

/// The sum of the channels below which a pixel is so dark that it says nothing when the plate is as dark: black clothes
/// before black furniture may not differ at all.
const DARK: f32 = super::shaders::DARK as f32;

/// What differs from the plate in one row, one flag (0 or 1) a pixel.
#[derive(Clone, Debug)]
pub(super) struct DifferenceRow {
    /// Different enough to be foreground, and not the plate in another light.
    pub weak: Vec<u8>,
    /// Likewise, and beyond doubt.
    pub strong: Vec<u8>,
    /// Different at all, or too dark to tell.
    pub faint: Vec<u8>,
}

impl DifferenceRow {
    /// A row without differences.
    pub(super) fn new(width: usize) -> Self {
        Self { weak: vec![0; width], strong: vec![0; width], faint: vec![0; width] }
    }
}

/// A background plate, one plane a channel.
#[derive(Clone, Debug)]
pub struct Plate {
    width: usize,
    planes: [Vec<f32>; 3],
    image: RgbImage,
    seen: [Vec<f32>; 3],
}

impl Plate {
    /// Takes a picture of the empty scene.
    pub fn new(image: RgbImage) -> Self {
        let width = image.width() as usize;
        let mut planes = [const { Vec::new() }; 3];
        for (channel, plane) in planes.iter_mut().enumerate() {
            *plane = image.pixels().map(|pixel| f32::from(pixel[channel])).collect();
        }
        Self { width, planes, image, seen: [const { Vec::new() }; 3] }
    }

    /// The picture as it was taken.
    pub(super) fn image(&self) -> &RgbImage {
        &self.image
    }

    /// What to multiply the plate with, channel by channel, so that it is as bright as `picture`: the median ratio over
    /// a grid of pixels, which no person covering less than half the picture can move far.
    pub fn gain(&self, picture: &RgbImage) -> [f32; 3] {
        gains(picture, &self.image)
    }

    /// Flags in one row of a picture what differs from the plate times `gain`.
    pub(super) fn compare_row(
        &mut self,
        y: usize,
        rgb: &[u8],
        gain: [f32; 3],
        settings: &PlateSettings,
        shadow: &ShadowSettings,
        flags: &mut DifferenceRow,
    ) {
        let row = y * self.width..(y + 1) * self.width;
        let plate = self.planes.each_ref().map(|plane| &plane[row.clone()]);
        flag_row(rgb, (plate, gain), (settings, shadow), &mut self.seen, flags);
    }
}

/// [`Plate::compare_row`] with the plate's own row; `planes` is room for the picture's channels. Compiled for the wider vectors too: no
/// operation is fused, so that every version gives the same flags.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn flag_row(
    rgb: &[u8],
    ([pr, pg, pb], gain): ([&[f32]; 3], [f32; 3]),
    (settings, shadow): (&PlateSettings, &ShadowSettings),
    planes: &mut [Vec<f32>; 3],
    flags: &mut DifferenceRow,
) {
    split_row(rgb, planes);
    let plate = pr.iter().zip(pg).zip(pb);
    let seen = planes[0].iter().zip(&planes[1]).zip(&planes[2]);
    let flags = flags.weak.iter_mut().zip(&mut flags.strong).zip(&mut flags.faint);
    let [least_weak, least_strong, least_faint] =
        [settings.weak, settings.strong, settings.faint].map(|distance| distance * distance);
    for ((((&pr, &pg), &pb), ((&r, &g), &b)), ((weak, strong), faint)) in plate.zip(seen).zip(flags) {
        // What would be brighter than white is white.
        let background = [(pr * gain[0]).min(255.0), (pg * gain[1]).min(255.0), (pb * gain[2]).min(255.0)];
        let (dr, dg, db) = (r - background[0], g - background[1], b - background[2]);
        let distance = dr * dr + dg * dg + db * db;
        let differs = !shadow.covers([r, g, b], background);
        let both_dark = (background[0] + background[1] + background[2]).max(r + g + b) < DARK;
        *weak = u8::from(differs & (distance >= least_weak));
        *strong = u8::from(differs & (distance >= least_strong));
        *faint = u8::from(both_dark | differs & (distance >= least_faint));
    }
}

/// Splits a row of interleaved bytes into one plane a channel.
#[inline(always)]
pub(super) fn split_row(rgb: &[u8], planes: &mut [Vec<f32>; 3]) {
    let (pixels, _) = rgb.as_chunks::<3>();
    for (channel, plane) in planes.iter_mut().enumerate() {
        plane.resize(pixels.len(), 0.0);
        for (value, pixel) in plane.iter_mut().zip(pixels) {
            *value = f32::from(pixel[channel]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    fn room() -> RgbImage {
        RgbImage::from_fn(80, 60, |x, y| Rgb([(60 + x) as u8, (70 + y) as u8, ((x * 7 + y * 3) % 90 + 60) as u8]))
    }

    fn flags(plate: &mut Plate, picture: &RgbImage, gain: [f32; 3]) -> (Vec<u8>, Vec<u8>) {
        let width = picture.width() as usize;
        let (mut weak, mut strong) = (vec![0; width * 60], vec![0; width * 60]);
        for (y, rgb) in picture.as_raw().chunks_exact(width * 3).enumerate() {
            let mut row = DifferenceRow::new(width);
            plate.compare_row(y, rgb, gain, &PlateSettings::default(), &ShadowSettings::default(), &mut row);
            weak[y * width..][..width].copy_from_slice(&row.weak);
            strong[y * width..][..width].copy_from_slice(&row.strong);
        }
        (weak, strong)
    }

    #[test]
    fn a_shadow_is_not_foreground_and_a_block_is() {
        let picture = RgbImage::from_fn(80, 60, |x, y| match (x, y) {
            (10..20, 10..30) => Rgb([250, 20, 20]),
            (40..60, 20..40) => Rgb(room().get_pixel(x, y).0.map(|v| (f32::from(v) * 0.7) as u8)),
            _ => *room().get_pixel(x, y),
        });
        let (weak, strong) = flags(&mut Plate::new(room()), &picture, [1.0; 3]);
        for (at, (weak, strong)) in weak.into_iter().zip(strong).enumerate() {
            let block = (10..20).contains(&(at % 80)) && (10..30).contains(&(at / 80));
            assert_eq!((weak, strong), (u8::from(block), u8::from(block)), "pixel {at}");
        }
    }

    #[test]
    fn black_on_black_is_only_faint() {
        let mut plate = Plate::new(RgbImage::from_pixel(3, 1, Rgb([40, 42, 20])));
        let mut row = DifferenceRow::new(3);
        let (settings, shadow) = (PlateSettings::default(), ShadowSettings::default());
        plate.compare_row(0, &[38, 40, 21, 40, 42, 20, 40, 80, 90], [1.0; 3], &settings, &shadow, &mut row);
        assert_eq!((row.weak, row.strong, row.faint), (vec![0, 0, 1], vec![0, 0, 1], vec![1, 1, 1]));
        // A bright wall seen again is nothing at all.
        let mut wall = Plate::new(RgbImage::from_pixel(1, 1, Rgb([200, 190, 170])));
        let mut row = DifferenceRow::new(1);
        wall.compare_row(0, &[196, 188, 171], [1.0; 3], &settings, &shadow, &mut row);
        assert_eq!((row.weak, row.strong, row.faint), (vec![0], vec![0], vec![0]));
    }

    #[test]
    fn the_gain_is_found_with_a_third_of_the_picture_covered() {
        let gains = [1.2_f32, 0.9, 1.05];
        let picture = RgbImage::from_fn(80, 60, |x, y| {
            if x < 26 {
                return Rgb([5, 250, 5]);
            }
            let pixel = room().get_pixel(x, y).0;
            Rgb([0, 1, 2].map(|c: usize| (f32::from(pixel[c]) * gains[c]).round() as u8))
        });
        let mut plate = Plate::new(room());
        let found = plate.gain(&picture);
        for (found, expected) in found.iter().zip(gains) {
            assert!((found - expected).abs() < 0.03, "{found} should be {expected}");
        }
        assert_eq!(plate.gain(&room()), [1.0; 3]);
        let covered = |flags: &[u8]| flags.iter().map(|&flag| usize::from(flag)).sum::<usize>();
        assert_eq!(covered(&flags(&mut plate, &picture, found).0), 26 * 60);
        assert!(covered(&flags(&mut plate, &picture, [1.0; 3]).0) > 26 * 60, "the gain was needed");
        // Brighter than white is white.
        let mut wall = Plate::new(RgbImage::from_pixel(4, 4, Rgb([220, 200, 90])));
        let white = RgbImage::from_pixel(4, 4, Rgb([255, 255, 171]));
        assert_eq!(covered(&flags(&mut wall, &white, [1.9; 3]).0), 0);
    }

    #[test]
    fn black_pictures_have_no_gain() {
        let plate = Plate::new(RgbImage::new(80, 60));
        assert_eq!(plate.gain(&room()), [1.0; 3]);
        assert_eq!(Plate::new(room()).gain(&RgbImage::new(80, 60)), [0.5; 3]);
    }
}
