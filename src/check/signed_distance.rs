//! A silhouette as a height field: how far a pixel lies outside its border, negative inside.

use std::sync::Arc;

use glam::DVec2;

use crate::features::BitImage;
use crate::sequence::Turn;

/// Beyond this many grid steps outside the silhouette nothing is told apart.
const MARGIN: u32 = 16;

/// Signed distances from a silhouette's border, in pixels, sampled on a grid round it.
#[derive(Clone, Debug)]
pub(super) struct SignedDistance {
    picture: DVec2,
    origin: DVec2,
    step: f64,
    width: usize,
    height: usize,
    values: Vec<f32>,
    border: Vec<DVec2>,
    /// Where nothing is known.
    ignored: Option<Arc<BitImage>>,
}

impl SignedDistance {
    /// Measures a silhouette at every `step`-th pixel; None where it is empty. The border lies half way between a pixel
    /// inside and one outside. Of pixels that are `ignored` nothing is known: no border is beside one, and there is no distance there.
    pub(super) fn of(silhouette: &BitImage, step: u32, ignored: Option<Arc<BitImage>>) -> Option<Self> {
        let bounds = silhouette.bounds()?;
        let (width, height) = (silhouette.width(), silhouette.height());
        let step = step.max(1);
        let margin = MARGIN * step;
        let (x0, y0) = (bounds.x0.saturating_sub(margin), bounds.y0.saturating_sub(margin));
        let (x1, y1) = ((bounds.x1 + margin).min(width), (bounds.y1 + margin).min(height));
        let columns = ((x1 - x0).div_ceil(step)) as usize;
        let rows = ((y1 - y0).div_ceil(step)) as usize;
        let inside: Vec<bool> = (0..rows * columns)
            .map(|at| silhouette.get(x0 + (at % columns) as u32 * step, y0 + (at / columns) as u32 * step))
            .collect();
        let [outward, inward] =
            [true, false].map(|wanted| squared_distances(&inside, columns, rows, |is_inside| is_inside == wanted));
        let value = |(out, into): (&f64, &f64)| {
            let signed = if *out > 0.0 { out.sqrt() - 0.5 } else { 0.5 - into.sqrt() };
            (signed * f64::from(step)) as f32
        };
        let mut field = Self {
            picture: DVec2::new(f64::from(width), f64::from(height)),
            origin: DVec2::new(f64::from(x0), f64::from(y0)),
            step: f64::from(step),
            width: columns,
            height: rows,
            values: outward.iter().zip(&inward).map(value).collect(),
            border: Vec::new(),
            ignored,
        };
        field.border = field.find_border();
        Some(field)
    }

    /// The same of a picture that is turned or mirrored.
    pub(super) fn put(&self, turn: Turn) -> Self {
        let side = |length: f64| length as u32;
        let size = [side(self.picture.x), side(self.picture.y)];
        let [width, height] = turn.turned([self.width as u32, self.height as u32]).map(|side| side as usize);
        let corner = self.origin + DVec2::new(self.width as f64 - 1.0, self.height as f64 - 1.0) * self.step;
        let [first, last] = [self.origin, corner].map(|pixel| turn.place(pixel, size));
        let origin = first.min(last);
        let mut values = vec![0.0; self.values.len()];
        for (at, value) in self.values.iter().enumerate() {
            let (x, y) = (at % self.width, at / self.width);
            let pixel = self.origin + DVec2::new(x as f64, y as f64) * self.step;
            let cell = ((turn.place(pixel, size) - origin) / self.step).round();
            values[cell.y as usize * width + cell.x as usize] = *value;
        }
        let turned = turn.turned(size);
        let ignored = self.ignored.as_ref().map(|ignored| {
            let pixel = |x: u32, y: u32| {
                let from = turn.back().place(DVec2::new(f64::from(x), f64::from(y)), turned);
                ignored.get(from.x as u32, from.y as u32)
            };
            Arc::new(BitImage::from_fn(turned[0], turned[1], pixel))
        });
        Self {
            picture: DVec2::from_array(turned.map(f64::from)),
            origin,
            step: self.step,
            width,
            height,
            values,
            border: self.border.iter().map(|pixel| turn.place(*pixel, size)).collect(),
            ignored,
        }
    }

    fn is_ignored(&self, pixel: DVec2) -> bool {
        self.ignored.as_ref().is_some_and(|ignored| {
            let [x, y] = pixel.round().max(DVec2::ZERO).to_array();
            ignored.get(x as u32, y as u32)
        })
    }

    /// The first and the last place of the picture, as [`Self::at`] takes them, pixels.
    pub(super) fn picture(&self) -> [DVec2; 2] {
        [DVec2::splat(-0.5), self.picture - 0.5]
    }

    /// Outside of these two corners (pixels) every place of the picture is [`Self::farthest`].
    pub(super) fn told_apart(&self) -> [DVec2; 2] {
        let cells = DVec2::new(self.width as f64, self.height as f64);
        [self.origin - self.step, self.origin + cells * self.step]
    }

    /// Whether there are places of which nothing is known.
    pub(super) fn has_ignored(&self) -> bool {
        self.ignored.is_some()
    }

    /// The largest distance told apart, pixels.
    pub(super) fn farthest(&self) -> f64 {
        f64::from(MARGIN) * self.step
    }

    /// The distance at a place in the picture, between the samples by their four neighbours; None outside the picture and where nothing
    /// is known.
    pub(super) fn at(&self, pixel: DVec2) -> Option<f64> {
        let half = DVec2::splat(0.5);
        if !(pixel.cmpge(-half).all() && pixel.cmplt(self.picture - half).all()) {
            return None;
        }
        if self.is_ignored(pixel) {
            return None;
        }
        let place = (pixel - self.origin) / self.step;
        let last = DVec2::new(self.width as f64 - 1.0, self.height as f64 - 1.0);
        if place.cmplt(DVec2::splat(-1.0)).any() || place.cmpgt(last + 1.0).any() {
            return Some(self.farthest());
        }
        let place = place.clamp(DVec2::ZERO, last);
        let (x, y) = (place.x as usize, place.y as usize);
        let (right, below) = ((x + 1).min(self.width - 1), (y + 1).min(self.height - 1));
        // A whole part that is not negative is what conversion leaves: rounding down is a call where processors may lack the instruction.
        let part = place - DVec2::new(x as f64, y as f64);
        let value = |x: usize, y: usize| f64::from(self.values[y * self.width + x]);
        let top = value(x, y) + part.x * (value(right, y) - value(x, y));
        let bottom = value(x, below) + part.x * (value(right, below) - value(x, below));
        Some((top + part.y * (bottom - top)).min(self.farthest()))
    }

    /// The pixels just inside the border, but for those at the picture's edge, where the person is cut off.
    pub(super) fn border(&self) -> &[DVec2] {
        &self.border
    }

    fn find_border(&self) -> Vec<DVec2> {
        let mut border = Vec::new();
        for y in 0..self.height {
            for x in 0..self.width {
                let pixel = self.origin + DVec2::new(x as f64, y as f64) * self.step;
                let is_cut =
                    pixel.cmplt(DVec2::splat(self.step)).any() || pixel.cmpgt(self.picture - 1.0 - self.step).any();
                let beside = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y];
                let is_covered = || beside.iter().any(|side| self.is_ignored(pixel + side * self.step));
                // The nearest pixel outside is a neighbour.
                if f64::from(self.values[y * self.width + x]) == -0.5 * self.step && !is_cut && !is_covered() {
                    border.push(pixel);
                }
            }
        }
        border
    }
}

/// Squared Euclidean distances, in grid steps, to the nearest cell that is `wanted`: lower envelopes of parabolas, first
/// along columns, then along rows.
fn squared_distances(cells: &[bool], width: usize, height: usize, wanted: impl Fn(bool) -> bool) -> Vec<f64> {
    // Far beyond any distance, and still finite when parabolas are subtracted.
    const NONE: f64 = 1e12;
    let mut values: Vec<f64> = cells.iter().map(|&cell| if wanted(cell) { 0.0 } else { NONE }).collect();
    let mut line = Vec::new();
    let mut hull = Vec::new();
    for x in 0..width {
        line.clear();
        line.extend((0..height).map(|y| values[y * width + x]));
        lower_envelope(&line, &mut hull, |y, value| values[y * width + x] = value);
    }
    for row in values.chunks_mut(width) {
        line.clear();
        line.extend_from_slice(row);
        lower_envelope(&line, &mut hull, |x, value| row[x] = value);
    }
    values
}

/// min over q of (p - q)^2 + line[q], for every p. `hull` holds the parabolas of the envelope and where each begins.
fn lower_envelope(line: &[f64], hull: &mut Vec<(usize, f64)>, mut set: impl FnMut(usize, f64)) {
    hull.clear();
    for (q, value) in line.iter().enumerate() {
        let mut begin = f64::NEG_INFINITY;
        while let Some(&(other, start)) = hull.last() {
            let (a, b) = (q as f64, other as f64);
            begin = (value - line[other] + a * a - b * b) / (2.0 * (a - b));
            if begin > start {
                break;
            }
            hull.pop();
            begin = f64::NEG_INFINITY;
        }
        hull.push((q, begin));
    }
    let mut at = 0;
    for p in 0..line.len() {
        while hull.get(at + 1).is_some_and(|&(_, begin)| begin <= p as f64) {
            at += 1;
        }
        let (q, _) = hull[at];
        set(p, (p as f64 - q as f64).powi(2) + line[q]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_every_pixel_tried() {
        let blob =
            |x: u32, y: u32| (x > 5 && x < 30 && y > 8 && y < 20 && (x * 7 + y * 5) % 11 > 1) || (x == 40 && y == 3);
        let silhouette = BitImage::from_fn(60, 40, blob);
        let field = SignedDistance::of(&silhouette, 1, None).unwrap();
        for (x, y) in (0..60).flat_map(|x| (0..40).map(move |y| (x, y))) {
            let here = blob(x, y);
            let nearest = (0..60)
                .flat_map(|a| (0..40).map(move |b| (a, b)))
                .filter(|&(a, b)| blob(a, b) != here)
                .map(|(a, b)| (f64::from(a) - f64::from(x)).hypot(f64::from(b) - f64::from(y)) - 0.5)
                .fold(f64::INFINITY, f64::min);
            let expected = if here { -nearest } else { nearest.min(16.0) };
            let found = field.at(DVec2::new(f64::from(x), f64::from(y))).unwrap();
            // Beyond the grid's margin nothing is told apart; its last samples lie half a pixel nearer.
            assert!((found.min(15.5) - expected.min(15.5)).abs() < 1e-5, "{x} {y}: {found} {expected}");
        }
        assert!(field.at(DVec2::new(-0.6, 3.0)).is_none() && field.at(DVec2::new(3.0, 39.6)).is_none());
        assert!(field.at(DVec2::NAN).is_none());
        assert!(field.border().iter().all(|p| blob(p.x as u32, p.y as u32)));
        assert!(SignedDistance::of(&BitImage::new(9, 9), 1, None).is_none());
    }

    #[test]
    fn a_turned_silhouette_is_that_of_the_turned_picture() {
        let blob = |x: u32, y: u32| x > 5 && x < 30 && y > 8 && y < 20 && (x * 7 + y * 5) % 11 > 1;
        let corner = |x: u32, y: u32| x < 9 && y < 3;
        let image = |is_in: fn(u32, u32) -> bool| {
            image::GrayImage::from_fn(60, 40, |x, y| image::Luma([255 * u8::from(is_in(x, y))]))
        };
        let bits = |picture: &image::GrayImage| BitImage::of_gray(picture);
        let field = SignedDistance::of(&bits(&image(blob)), 1, Some(Arc::new(bits(&image(corner))))).unwrap();
        for turn in Turn::ALL {
            let [seen, ignored] = [image(blob), image(corner)]
                .map(|picture| bits(&turn.of(image::DynamicImage::ImageLuma8(picture)).into_luma8()));
            let expected = SignedDistance::of(&seen, 1, Some(Arc::new(ignored))).unwrap();
            let put = field.put(turn);
            assert_eq!(put.border.len(), expected.border.len());
            let [width, height] = turn.turned([60, 40]);
            for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
                let at = DVec2::new(f64::from(x), f64::from(y));
                assert_eq!(put.at(at), expected.at(at), "{turn:?} {at}");
            }
        }
    }
}
