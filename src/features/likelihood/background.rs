//! The density of a pixel's colour as background: lit as it is known, in shadow or a reflection, or neither (METHOD A12).

use std::sync::Arc;

use image::RgbImage;

use super::super::Region;
use super::super::light::GRID;
use super::super::plate::split_row;
use super::LOG_STEPS;
use super::picture_light::{
    BRIGHTEST, DARKEST, Light, LightTables, OUTLIERS, REFLECTION_FALL, REFLECTION_LOG, SHADOW_FALL, SHADOW_LOG,
    SHADOWED, SLOPES, Widths, shadow_share, widths,
};

/// A colour as luma, blue less luma and red less luma: a shadow changes the first and scales the other two.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Luminance {
    y: f32,
    b: f32,
    r: f32,
}

impl Luminance {
    #[inline]
    fn of([r, g, b]: [f32; 3]) -> Self {
        let y = 0.299 * r + 0.587 * g + 0.114 * b;
        Self { y, b: b - y, r: r - y }
    }

    /// Luma, so much that one can divide by it.
    fn bright(&self) -> f32 {
        self.y.max(4.0)
    }

    fn is_grey(&self) -> bool {
        self.b.abs() <= GREY && self.r.abs() <= GREY
    }
}

/// The least noise a channel, grey levels.
const LEAST_NOISE: [f32; 3] = [1.5, 1.0, 1.0];
/// A standard deviation over the median of absolute deviations of normal numbers.
const DEVIATION: f32 = 1.4826;
/// A camera sees in grey where no pixel's differences are larger than this, grey levels.
const GREY: f32 = 2.5;
/// The largest value of a channel.
const WHITE: f32 = 255.0;

/// The background's colours in one view, a plane a number.
#[derive(Clone, Debug)]
pub(crate) struct BackgroundColours {
    width: usize,
    y: Vec<f32>,
    b: Vec<f32>,
    r: Vec<f32>,
    /// 1 / luma and its logarithm, luma at least 4.
    inverse: Vec<f32>,
    log: Arc<[f32]>,
    /// The change of luma to the neighbours, grey levels.
    slopes: Arc<[u8]>,
    /// Whether there is no colour in it.
    is_grey: bool,
}

/// What a picture says before its pixels are judged one by one.
#[derive(Clone, Copy, Debug)]
pub(super) struct PictureLight {
    /// What to multiply the picture's channels with to have them in the background's light.
    dim: [f32; 3],
    /// As it was measured, a standard deviation a channel.
    noise: [f32; 3],
    light: Light,
}

impl BackgroundColours {
    /// Of a picture of the empty scene.
    pub(crate) fn new(plate: &RgbImage) -> Self {
        let (width, height) = (plate.width() as usize, plate.height() as usize);
        let colours: Vec<Luminance> =
            plate.as_raw().as_chunks::<3>().0.iter().map(|pixel| Luminance::of(pixel.map(f32::from))).collect();
        let mut slopes = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let luma = |x: usize, y: usize| colours[y * width + x].y;
                let across = luma((x + 1).min(width - 1), y) - luma(x.saturating_sub(1), y);
                let down = luma(x, (y + 1).min(height - 1)) - luma(x, y.saturating_sub(1));
                slopes.push((0.5 * across.hypot(down)).round().min(SLOPES as f32 - 1.0) as u8);
            }
        }
        let [y, b, r, inverse] = planes(&colours);
        Self {
            width,
            y,
            b,
            r,
            inverse,
            log: colours.iter().map(|colour| colour.bright().ln()).collect(),
            slopes: slopes.into(),
            is_grey: colours.iter().all(Luminance::is_grey),
        }
    }

    /// The colours that a camera can tell in a picture which is `gain` times as bright as this background of `plate`: what would be brighter than
    /// white is white there. None where that is nothing.
    pub(super) fn overexposed(&self, plate: &RgbImage, gain: [f32; 3]) -> Option<Self> {
        let most = most(dim(gain));
        let pixels = || plate.as_raw().as_chunks::<3>().0.iter().map(|pixel| pixel.map(f32::from));
        let is_over = |pixel: [f32; 3]| pixel.iter().zip(most).any(|(value, most)| *value > most);
        if most.iter().all(|most| *most >= WHITE) || !pixels().any(is_over) {
            return None;
        }
        let colours: Vec<Luminance> =
            plate.as_raw().as_chunks::<3>().0.iter().map(|pixel| below(*pixel, most)).collect();
        let [y, b, r, inverse] = planes(&colours);
        let (log, slopes) = (Arc::clone(&self.log), Arc::clone(&self.slopes));
        Some(Self { width: self.width, y, b, r, inverse, log, slopes, is_grey: self.is_grey })
    }

    /// Whether there is no colour in a picture and the background.
    pub(super) fn is_grey(&self, picture: &RgbImage) -> bool {
        let mut pixels = picture.as_raw().as_chunks::<3>().0.iter();
        self.is_grey && pixels.all(|pixel| Luminance::of(pixel.map(f32::from)).is_grey())
    }

    /// The light of a picture that is `gain` times as bright as the background of `plate`, by [`Self::is_grey`]: its noise, and as many shadows as
    /// are usual.
    pub(super) fn light(picture: &RgbImage, plate: &RgbImage, gain: [f32; 3], is_grey: bool) -> PictureLight {
        let dim = dim(gain);
        let noise = noise(picture, plate, dim);
        PictureLight { dim, noise, light: Light::new(noise, shadow_share(0, 0), is_grey) }
    }

    /// The light of a picture with how much of what looks like background is in shadow in `near`, where the person may be.
    pub(super) fn shaded(&self, picture: &RgbImage, light: PictureLight, near: Region) -> PictureLight {
        let PictureLight { dim, noise, light: Light { is_grey, .. } } = light;
        let widths = widths(noise, SHADOWED, is_grey);
        let (columns, lines) = (near.x0 as usize..near.x1 as usize, near.y0 as usize..near.y1 as usize);
        let rows = picture.as_raw().chunks_exact(self.width * 3).enumerate();
        let (mut in_shadow, mut all) = (0, 0);
        for (y, row) in rows.take(lines.end).skip(lines.start).step_by(GRID / 2) {
            for x in columns.clone().step_by(GRID / 2) {
                let at = y * self.width + x;
                let seen = lit(row.as_chunks::<3>().0[x], dim);
                let known = [self.y[at], self.b[at], self.r[at], self.inverse[at], self.log[at]];
                let [lit, shadow] = hypotheses(seen, known, widths[usize::from(self.slopes[at])]);
                if lit.max(shadow) > 0.0 {
                    all += 1;
                    in_shadow += u32::from(shadow > lit);
                }
            }
        }
        PictureLight { dim, noise, light: Light::new(noise, shadow_share(in_shadow, all), is_grey) }
    }

    /// The light of a picture for a device that counts the shadows itself.
    pub(super) fn light_tables(&self, picture: &RgbImage, plate: &RgbImage, gain: [f32; 3]) -> LightTables {
        let dim = dim(gain);
        LightTables::new(dim, noise(picture, plate, dim), self.is_grey(picture))
    }

    /// Of each pixel the logarithm of its luma, at least 4, and the change of luma to its neighbours, below [`SLOPES`].
    pub(crate) fn planes(&self) -> (&[f32], &[u8]) {
        (&self.log, &self.slopes)
    }

    /// The log densities of the pixels of `region` of a picture as background.
    pub(super) fn judge(
        &self,
        picture: &RgbImage,
        PictureLight { dim, light, .. }: PictureLight,
        region: Region,
        densities: &mut [i16],
    ) {
        let widths = widths(light.noise, light.shadowed, light.is_grey);
        // A table a number, each of which stays near the processor.
        let of_slopes = [
            widths.each_ref().map(|widths| widths.y),
            widths.each_ref().map(|widths| widths.c),
            widths.each_ref().map(|widths| widths.lit),
            widths.each_ref().map(|widths| widths.shadow),
        ];
        let columns = region.x0 as usize..region.x1 as usize;
        let rows = picture.as_raw().chunks_exact(self.width * 3).enumerate();
        let mut channels = [const { Vec::new() }; 3];
        for (y, rgb) in rows.take(region.y1 as usize).skip(region.y0 as usize) {
            let rgb = &rgb[3 * columns.start..3 * columns.end];
            let at = y * self.width + columns.start..y * self.width + columns.end;
            let known = [&*self.y, &self.b, &self.r, &self.inverse, &self.log].map(|plane: &[f32]| &plane[at.clone()]);
            let slopes = &self.slopes[at.clone()];
            judge_row(rgb, dim, (known, slopes), &of_slopes, &mut channels, &mut densities[at]);
        }
    }
}

/// The log densities of some pixels of a row; `channels` is room for the picture's. Compiled for the wider vectors too: no operation is fused,
/// so that every version gives the same numbers.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn judge_row(
    rgb: &[u8],
    dim: [f32; 3],
    (known, slopes): ([&[f32]; 5], &[u8]),
    [wy, wc, lit, shadow]: &[[f32; SLOPES]; 4],
    channels: &mut [Vec<f32>; 3],
    densities: &mut [i16],
) {
    split_row(rgb, channels);
    let count = densities.len();
    let [red, green, blue] = channels.each_ref().map(|plane| &plane[..count]);
    let [y, b, r, inverse, log] = known.map(|plane| &plane[..count]);
    let slopes = &slopes[..count];
    let outlier = OUTLIERS.ln();
    for at in 0..count {
        let seen = Luminance::of([red[at] * dim[0], green[at] * dim[1], blue[at] * dim[2]]);
        let slope = usize::from(slopes[at]) % SLOPES;
        let widths = Widths { y: wy[slope], c: wc[slope], lit: lit[slope], shadow: shadow[slope] };
        let [lit, shadow] = hypotheses(seen, [y[at], b[at], r[at], inverse[at], log[at]], widths);
        densities[at] = (lit.max(shadow).max(outlier) * LOG_STEPS) as i32 as i16;
    }
}

/// Luma, the two differences and 1 / luma of colours, a plane each.
fn planes(colours: &[Luminance]) -> [Vec<f32>; 4] {
    let plane = |of: fn(&Luminance) -> f32| colours.iter().map(of).collect();
    [
        plane(|colour| colour.y),
        plane(|colour| colour.b),
        plane(|colour| colour.r),
        plane(|colour| 1.0 / colour.bright()),
    ]
}

/// What to multiply a picture's channels with that is `gain` times as bright as the background.
fn dim(gain: [f32; 3]) -> [f32; 3] {
    gain.map(|gain| 1.0 / gain.max(1e-3))
}

/// The most that a background's channels can be where the picture's are white, in the background's light.
fn most(dim: [f32; 3]) -> [f32; 3] {
    dim.map(|dim| WHITE * dim)
}

/// A background's colour with channels of no more than that.
#[inline]
fn below(pixel: [u8; 3], most: [f32; 3]) -> Luminance {
    Luminance::of([0, 1, 2].map(|channel| f32::from(pixel[channel]).min(most[channel])))
}

/// The noise of a picture whose channels are multiplied with `dim` to be in the light of the plate, a standard deviation a channel.
fn noise(picture: &RgbImage, plate: &RgbImage, dim: [f32; 3]) -> [f32; 3] {
    let most = most(dim);
    let [seen, known] = [picture, plate].map(|image| image.as_raw().chunks_exact(image.width() as usize * 3));
    let mut deviations = [const { Vec::new() }; 3];
    for (seen, known) in seen.zip(known).step_by(GRID) {
        let pixels = seen.as_chunks::<3>().0.iter().zip(known.as_chunks::<3>().0).step_by(GRID);
        for (seen, known) in pixels {
            let (seen, known) = (lit(*seen, dim), below(*known, most));
            let off = [seen.y - known.y, seen.b - known.b, seen.r - known.r];
            deviations.iter_mut().zip(off).for_each(|(list, value)| list.push(value.abs()));
        }
    }
    let mut noise = LEAST_NOISE;
    for (noise, list) in noise.iter_mut().zip(&mut deviations) {
        let middle = list.len() / 2;
        if middle < list.len() {
            let (_, median, _) = list.select_nth_unstable_by(middle, f32::total_cmp);
            *noise = noise.max(DEVIATION * *median);
        }
    }
    noise
}

#[inline]
fn lit(seen: [u8; 3], dim: [f32; 3]) -> Luminance {
    Luminance::of([f32::from(seen[0]) * dim[0], f32::from(seen[1]) * dim[1], f32::from(seen[2]) * dim[2]])
}

/// The log density of a colour as lit background and as background in another light, over the uniform one; of the background luma, the two
/// differences, 1 / luma and its logarithm are given.
#[inline(always)]
fn hypotheses(seen: Luminance, [y, b, r, inverse, log]: [f32; 5], widths: Widths) -> [f32; 2] {
    let (dy, db, dr) = (seen.y - y, seen.b - b, seen.r - r);
    let lit = widths.lit - 0.5 * (dy * dy * widths.y + (db * db + dr * dr) * widths.c);
    let bright = seen.y * inverse;
    let below = SHADOW_LOG - (1.0 - bright) * (1.0 / SHADOW_FALL);
    let above = REFLECTION_LOG - (bright - 1.0) * (1.0 / REFLECTION_FALL);
    let (db, dr) = (seen.b - bright * b, seen.r - bright * r);
    let shadow = widths.shadow - log + if bright < 1.0 { below } else { above } - 0.5 * (db * db + dr * dr) * widths.c;
    let is_shadow = (DARKEST..=BRIGHTEST).contains(&bright);
    [lit, if is_shadow { shadow } else { -1e4 }]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plate() -> RgbImage {
        RgbImage::from_fn(64, 48, |x, y| image::Rgb([(100 + x) as u8, (110 + y) as u8, 90]))
    }

    fn judged(picture: &RgbImage) -> Vec<i16> {
        let colours = BackgroundColours::new(&plate());
        let light = BackgroundColours::light(picture, &plate(), [1.0; 3], colours.is_grey(picture));
        let mut densities = vec![0; 64 * 48];
        colours.judge(picture, light, Region::whole(64, 48), &mut densities);
        densities
    }

    #[test]
    fn the_background_lit_or_in_shadow_is_likely_and_skin_is_not() {
        let mut picture = plate();
        picture.put_pixel(20, 20, image::Rgb([210, 150, 130]));
        let shaded = picture.get_pixel(40, 30).0.map(|v| (f32::from(v) * 0.75).round() as u8);
        picture.put_pixel(40, 30, image::Rgb(shaded));
        let densities = judged(&picture);
        let at = |x: usize, y: usize| f32::from(densities[y * 64 + x]) / LOG_STEPS;
        assert!((11.0..13.0).contains(&at(5, 5)), "{}", at(5, 5));
        assert!(at(40, 30) > 4.0, "a shadow: {}", at(40, 30));
        assert!((at(20, 20) - OUTLIERS.ln()).abs() < 0.05, "neither: {}", at(20, 20));
    }

    /// A wall that turns white where the light is turned up is the wall, and a dark thing before it is not.
    #[test]
    fn an_overexposed_background_is_background() {
        let wall = |x: u32, y: u32| if x < 20 { [230, 200, 190] } else { [(100 + x) as u8, (100 + y) as u8, 90] };
        let plate = RgbImage::from_fn(64, 48, |x, y| image::Rgb(wall(x, y)));
        let mut picture = plate.clone();
        picture.put_pixel(40, 20, image::Rgb([90, 60, 50]));
        picture.iter_mut().for_each(|value| *value = (f32::from(*value) * 1.5).round() as u8);
        assert_eq!(picture.pixels().filter(|pixel| pixel.0 == [255; 3]).count(), 20 * 48);
        let known = BackgroundColours::new(&plate);
        let judged = |colours: &BackgroundColours| {
            let light = BackgroundColours::light(&picture, &plate, [1.5; 3], false);
            let mut densities = vec![0; 64 * 48];
            colours.judge(&picture, light, Region::whole(64, 48), &mut densities);
            let surely_not = densities.iter().filter(|density| **density < 0).count();
            (f32::from(densities[20 * 64 + 40]) / LOG_STEPS, surely_not)
        };
        let colours = known.overexposed(&plate, [1.5; 3]).unwrap();
        let (thing, others) = judged(&colours);
        assert!(thing < -5.0 && others == 1, "{thing}, {others}");
        assert!(judged(&known).1 > 19 * 48, "the white wall is another colour by the plate as it is");
        // Nothing turns white in the light of the plate, in less, or where all is dark.
        assert!([1.0, 0.7].iter().all(|gain| known.overexposed(&plate, [*gain; 3]).is_none()));
        let dark = RgbImage::from_pixel(64, 48, image::Rgb([100; 3]));
        assert!(BackgroundColours::new(&dark).overexposed(&dark, [2.0; 3]).is_none());
    }

    #[test]
    fn a_grey_camera_is_judged_by_luma_alone() {
        let grey = |value: u32| image::Rgb([value as u8; 3]);
        let plate = RgbImage::from_fn(64, 48, |x, _| grey(120 + x / 8));
        let mut picture = plate.clone();
        picture.put_pixel(20, 20, grey(60));
        picture.put_pixel(40, 20, grey(112));
        let judged = |picture: &RgbImage| {
            let colours = BackgroundColours::new(&plate);
            let light = BackgroundColours::light(picture, &plate, [1.0; 3], colours.is_grey(picture));
            let mut densities = vec![0; 64 * 48];
            colours.judge(picture, light, Region::whole(64, 48), &mut densities);
            (
                light.light.is_grey,
                [(5, 5), (20, 20), (40, 20)].map(|(x, y)| f32::from(densities[y * 64 + x]) / LOG_STEPS),
            )
        };
        let (is_grey, [lit, dark, shaded]) = judged(&picture);
        // What is half as bright is hardly a shadow, what is a little darker may well be one.
        assert!(is_grey && lit > 3.0 && dark < -2.0 && shaded > -1.0, "{lit} {dark} {shaded}");
        // With one coloured pixel the camera is no grey one, and no grey pixel of another colour than the wall's shadow.
        picture.put_pixel(0, 0, image::Rgb([200, 20, 20]));
        let (is_grey, [_, dark, _]) = judged(&picture);
        assert!(!is_grey && dark > 3.0, "{dark}");
    }

    /// The formulas once more, in double precision and without tables.
    #[test]
    fn densities_are_the_formulas() {
        let picture = RgbImage::from_fn(64, 48, |x, y| {
            let at = x * 31 + y * 17;
            image::Rgb([(at % 200) as u8, (at * 7 % 220) as u8, (at * 3 % 180) as u8])
        });
        let plate = plate();
        let colours = BackgroundColours::new(&plate);
        let light = BackgroundColours::light(&picture, &plate, [1.0; 3], colours.is_grey(&picture)).light;
        let densities = judged(&picture);
        let luminance = |p: [u8; 3]| {
            let [r, g, b] = p.map(f64::from);
            let y = 0.299 * r + 0.587 * g + 0.114 * b;
            [y, b - y, r - y]
        };
        for (at, (seen, known)) in picture.pixels().zip(plate.pixels()).enumerate() {
            let ([sy, sb, sr], [py, pb, pr]) = (luminance(seen.0), luminance(known.0));
            let slope = f64::from(colours.slopes[at]);
            let noise = light.noise.map(f64::from);
            let (vy, vc) = (noise[0].powi(2) + (0.35 * slope).powi(2), noise[1] * noise[2] + (0.2 * slope).powi(2));
            let normal = |d: f64, v: f64| -0.5 * d * d / v - 0.5 * (std::f64::consts::TAU * v).ln();
            let uniform = (256.0_f64.powi(3) * 0.587).ln();
            let odds = f64::from(light.shadowed);
            let lit =
                uniform + (1.0 - odds - 0.002).ln() + normal(sy - py, vy) + normal(sb - pb, vc) + normal(sr - pr, vc);
            let a = sy / py;
            let fall = if a < 1.0 {
                (0.7_f64 / 0.12).ln() - (1.0 - a) / 0.12
            } else {
                (0.3_f64 / 0.04).ln() - (a - 1.0) / 0.04
            };
            let shadow = uniform + odds.ln() - py.ln() + fall + normal(sb - a * pb, vc) + normal(sr - a * pr, vc);
            let shadow = if (0.45..=1.15).contains(&a) { shadow } else { f64::NEG_INFINITY };
            let expected = lit.max(shadow).max(0.002_f64.ln()) * 64.0;
            assert!(
                (f64::from(densities[at]) - expected).abs() < 1.5,
                "pixel {at}: {} is not {expected}",
                densities[at]
            );
        }
    }
}
