//! Pixels that are known and stay: what is synthesised goes over into them.

use image::{GrayImage, RgbImage};

use super::border::Border;
use super::canvas::Canvas;
use super::checks::is_bright;
use super::colour::{COLOUR_WEIGHTS, weighted};
use super::sources::Place;

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
        if border.is_clear() {
            return;
        }
        for &(u, v, i) in &border.within {
            let change = border.change([u, v]);
            for c in 0..3 {
                let moved = self.colours[i][c] + change[c];
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
