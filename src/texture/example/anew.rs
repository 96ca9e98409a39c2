//! Single pixels: those that no patch fits, and those that a patch's neighbours disagree about.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use anyhow::Result;

use super::canvas::Canvas;
use super::colour::{Known, Weighted};
use super::settings::RADIUS;
use crate::arithmetic::exp_of_negative;

/// Standard deviation of the bell by which a neighbourhood's support falls off at borders of patches, pixels.
const BELL: f32 = 1.2;
/// How much of a pixel found there its four neighbours are in the end.
const BLEND: f32 = 0.15;

/// How much the pixels of a neighbourhood count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Support {
    /// All alike.
    Even,
    /// By a Gauss bell of their distance from the middle.
    Bell,
}

/// The bell's value at a distance, given squared: 1 in the middle.
fn bell(distance_squared: usize) -> f32 {
    exp_of_negative(distance_squared as f32 * (-0.5 / (BELL * BELL)))
}

impl Canvas {
    /// Synthesises pixels one by one, always the one with the most known neighbours, of those the uppermost, leftmost; and blends
    /// them when all are found.
    pub(super) fn synthesise_anew(&mut self, pixels: &[usize]) -> Result<()> {
        for &i in pixels {
            self.filled[i] = false;
            self.anew[i] = true;
        }
        let width = self.size[0];
        let neighbours = |canvas: &Self, i: usize| {
            let around = canvas.region([i % width, i / width], [1, 1], RADIUS);
            canvas.pixels(around).filter(|&(_, _, j)| canvas.filled[j]).count()
        };
        let entry = |canvas: &Self, i: usize| (neighbours(canvas, i), Reverse(i));
        let mut queue: BinaryHeap<(usize, Reverse<usize>)> = pixels.iter().map(|&i| entry(self, i)).collect();
        while let Some((count, Reverse(i))) = queue.pop() {
            if self.filled[i] {
                continue;
            }
            // Counts only grow: an entry that is behind the times goes back with the present one.
            let now = neighbours(self, i);
            if now > count {
                queue.push((now, Reverse(i)));
                continue;
            }
            self.pixel_of([i % width, i / width], Support::Bell)?;
            let around = self.region([i % width, i / width], [1, 1], RADIUS);
            for (_, _, j) in self.pixels(around) {
                if self.anew[j] && !self.filled[j] {
                    queue.push(entry(self, j));
                }
            }
        }
        let blended: Vec<Weighted> = pixels.iter().map(|&i| self.blended(i)).collect();
        for (&i, colour) in pixels.iter().zip(blended) {
            self.colours[i] = colour;
        }
        Ok(())
    }

    /// The colour of a pixel with a share of the mean of its neighbours above, left, right and below.
    fn blended(&self, i: usize) -> Weighted {
        let (x, y) = (i % self.size[0], i / self.size[0]);
        let around = self.region([x, y], [1, 1], 1);
        let (u, v) = ((x as isize - around.x) as usize, (y as isize - around.y) as usize);
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for (_, _, j) in self.pixels(around).filter(|&(a, b, j)| a.abs_diff(u) + b.abs_diff(v) == 1 && self.filled[j]) {
            for (sum, colour) in sum.iter_mut().zip(self.colours[j]) {
                *sum += colour;
            }
            count += 1.0;
        }
        if count == 0.0 {
            return self.colours[i];
        }
        std::array::from_fn(|c| self.colours[i][c] + (sum[c] / count - self.colours[i][c]) * BLEND)
    }

    /// Fills one pixel from its neighbourhood, smaller where the examples or their masks have no room for 7 x 7.
    pub(super) fn pixel(&mut self, at: [usize; 2]) -> Result<()> {
        self.pixel_of(at, Support::Even)
    }

    fn pixel_of(&mut self, [x, y]: [usize; 2], support: Support) -> Result<()> {
        for radius in (0..=RADIUS).rev() {
            let region = self.region([x, y], [1, 1], radius);
            if (0..2).any(|axis| region.size[axis] > self.size[axis]) {
                continue;
            }
            let (u, v) = ((x as isize - region.x) as usize, (y as isize - region.y) as usize);
            let (mut known, mut guesses) = (Vec::with_capacity(48), Vec::with_capacity(8));
            for (a, b, i) in self.pixels(region).filter(|&(_, _, i)| self.filled[i]) {
                let (across, down) = (a.abs_diff(u), b.abs_diff(v));
                let weight = if support == Support::Bell { bell(across * across + down * down) } else { 1.0 };
                known.push(Known { x: a, y: b, colour: self.colours[i], weight });
                if across.max(down) == 1
                    && let Some(corner) = self.origins[i].and_then(|origin| origin.corner(a, b))
                    && !guesses.contains(&corner)
                {
                    guesses.push(corner);
                }
            }
            if support == Support::Bell {
                // What counts most first: that shows soonest which placements are worse.
                known.sort_by(|one, other| other.weight.total_cmp(&one.weight));
            }
            let found = if known.is_empty() {
                self.sources.any(region.size, self.die([x, y]))
            } else {
                self.sources.best(region.size, &known, guesses.into_iter())?.map(|(place, _)| place)
            };
            if let Some(place) = found {
                let i = y * self.size[0] + x;
                let origin = place.moved(u, v);
                self.colours[i] = self.sources.colour(origin);
                self.filled[i] = true;
                self.origins[i] = Some(origin);
                break;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bell_is_a_gauss_bell() {
        for distance_squared in 0..=18_usize {
            let expected = (-(distance_squared as f64) / (2.0 * f64::from(BELL) * f64::from(BELL))).exp();
            assert!((f64::from(bell(distance_squared)) - expected).abs() < 1e-6, "{distance_squared}");
        }
        assert!(bell(0) == 1.0 && bell(1) > bell(2) && bell(18) < 0.05);
    }
}
