//! Pixels that are known and stay: what is synthesised goes over into them.

use image::{GrayImage, RgbImage};

use super::canvas::Canvas;
use super::checks::is_bright;
use super::colour::{COLOUR_WEIGHTS, Weighted, weighted};
use super::sources::Place;

/// A patch where it meets pixels that are kept.
pub(super) struct Border {
    size: [usize; 2],
    /// Pixels over which a difference fades.
    reach: usize,
    /// What the patch newly filled: column and row in the region, and index on the canvas.
    pub(super) within: Vec<(usize, usize, usize)>,
    /// Of each pixel of the region that is kept and fits: how much it differs from the patch.
    differences: Vec<Option<Weighted>>,
}

impl Border {
    /// Nothing yet, of a region of `size`.
    pub(super) fn new(size: [usize; 2], reach: usize) -> Self {
        Self { size, reach, within: Vec::new(), differences: Vec::new() }
    }

    /// Notes a pixel that is kept, and what the patch has there.
    pub(super) fn differ(&mut self, u: usize, v: usize, kept: Weighted, new: Weighted) {
        self.differences.resize(self.size[0] * self.size[1], None);
        self.differences[v * self.size[0] + u] = Some(std::array::from_fn(|c| kept[c] - new[c]));
    }

    /// The mean difference of the pixels at most `radius` columns and rows away; none where there are none.
    fn mean(&self, [u, v]: [usize; 2], radius: usize) -> Option<Weighted> {
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for y in v.saturating_sub(radius)..(v + radius + 1).min(self.size[1]) {
            for x in u.saturating_sub(radius)..(u + radius + 1).min(self.size[0]) {
                let Some(difference) = self.differences[y * self.size[0] + x] else { continue };
                for (sum, difference) in sum.iter_mut().zip(difference) {
                    *sum += difference;
                }
                count += 1.0;
            }
        }
        (count > 0.0).then(|| sum.map(|sum| sum / count))
    }
}

impl Canvas {
    /// Takes the pixels of a picture as large as the canvas as known for good, but where `holes` are dark.
    pub(super) fn keep(&mut self, picture: &RgbImage, holes: &GrayImage) {
        self.kept = picture.enumerate_pixels().map(|(x, y, _)| is_bright(holes, x, y)).collect();
        for (i, (x, y, pixel)) in picture.enumerate_pixels().enumerate().filter(|&(i, _)| self.kept[i]) {
            self.colours[i] = weighted(pixel.0.map(f32::from));
            self.filled[i] = true;
            self.origins[i] = Some(Place { example: 0, x, y });
        }
        self.original = Some(picture.clone());
    }

    pub(super) fn is_kept(&self, i: usize) -> bool {
        self.kept.get(i).is_some_and(|is_kept| *is_kept)
    }

    /// Lets a patch go over into what is kept beside it: the mean difference near its border, less the farther in.
    pub(super) fn fade(&mut self, border: &Border) {
        if border.differences.is_empty() {
            return;
        }
        for &(u, v, i) in &border.within {
            let Some(away) = (1..=border.reach).find(|&away| border.mean([u, v], away).is_some()) else { continue };
            let Some(difference) = border.mean([u, v], away + 1) else { continue };
            let share = 1.0 - away as f32 / (border.reach + 1) as f32;
            for c in 0..3 {
                let moved = self.colours[i][c] + difference[c] * share;
                self.colours[i][c] = moved.clamp(0.0, COLOUR_WEIGHTS[c].sqrt());
            }
        }
    }

    /// Adds to `taken_out` what was synthesised in the eight pixels around each of those that are kept and do not fit.
    pub(super) fn take_out_beside(&self, kept: &[usize], taken_out: &mut Vec<usize>) {
        for &i in kept {
            let around = self.region([i % self.size[0], i / self.size[0]], [1, 1], 1);
            taken_out.extend(self.pixels(around).map(|(_, _, j)| j).filter(|&j| self.filled[j] && !self.is_kept(j)));
        }
    }

    /// Gives the pixels that were known their very colours.
    pub(super) fn restore_kept(&self, picture: &mut RgbImage) {
        let Some(original) = &self.original else { return };
        for ((pixel, original), is_kept) in picture.pixels_mut().zip(original.pixels()).zip(&self.kept) {
            if *is_kept {
                *pixel = *original;
            }
        }
    }
}
