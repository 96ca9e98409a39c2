//! The examples together: where in any of them a region fits best.

use anyhow::Result;
use image::GrayImage;

use super::checks::is_bright;
use super::colour::{Known, Weighted};
use super::matching::Matcher;
use super::settings::Example;
use crate::gpu::Device;

/// A pixel of an example, or a region by its upper left pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Which example.
    pub(super) example: u32,
    /// Column.
    pub(super) x: u32,
    /// Row.
    pub(super) y: u32,
}

impl Place {
    /// The one `u` to the right and `v` down.
    pub(super) fn moved(self, u: usize, v: usize) -> Self {
        Self { x: self.x + u as u32, y: self.y + v as u32, ..self }
    }

    /// The region's place whose pixel at (u, v) this is; none where it would begin outside.
    pub(super) fn corner(self, u: usize, v: usize) -> Option<Self> {
        Some(Self { x: self.x.checked_sub(u as u32)?, y: self.y.checked_sub(v as u32)?, ..self })
    }
}

/// The examples, prepared.
pub(super) struct Sources {
    matchers: Vec<Matcher>,
}

impl Sources {
    /// Prepares them; what the `holes` of the first hide is not used either.
    ///
    /// # Errors
    /// When the device has no memory for them.
    pub(super) fn new(examples: &[Example<'_>], holes: Option<&GrayImage>, device: Option<&Device>) -> Result<Self> {
        let matcher = |(i, &Example { picture, mask }): (usize, &Example<'_>)| {
            let hiding: Vec<&GrayImage> = mask.into_iter().chain(holes.filter(|_| i == 0)).collect();
            let is_usable = |(x, y, _)| hiding.iter().all(|given| is_bright(given, x, y));
            let usable: Option<Vec<bool>> =
                (!hiding.is_empty()).then(|| picture.enumerate_pixels().map(is_usable).collect());
            let matcher = Matcher::new(picture, usable.as_deref());
            if let Some(device) = device { matcher.on_device(device) } else { Ok(matcher) }
        };
        Ok(Self { matchers: examples.iter().enumerate().map(matcher).collect::<Result<_>>()? })
    }

    /// The colour of a pixel.
    pub(super) fn colour(&self, at: Place) -> Weighted {
        self.matchers[at.example as usize].colour(at.x as usize, at.y as usize)
    }

    /// Some usable placement of a region of `size`, chosen by `die` among those of all examples; none when there is none.
    pub(super) fn any(&self, size: [usize; 2], die: u32) -> Option<Place> {
        let counts: Vec<usize> = self.matchers.iter().map(|matcher| matcher.placement_count(size)).collect();
        let total: usize = counts.iter().sum();
        let mut first = ((u64::from(die) * total as u64) >> 32) as usize;
        let drawn = counts.iter().position(|&count| {
            let is_here = first < count;
            first -= if is_here { 0 } else { count };
            is_here
        })?;
        // From the drawn one on, then the following examples, in the end the drawn one's placements before it.
        let others = (drawn + 1..self.matchers.len()).chain(0..drawn).map(|i| (i, 0..counts[i]));
        let order = std::iter::once((drawn, first..counts[drawn])).chain(others).chain([(drawn, 0..first)]);
        for (i, placements) in order {
            if let Some([x, y]) = self.matchers[i].first_usable(size, placements) {
                return Some(Place { example: i as u32, x: x as u32, y: y as u32 });
            }
        }
        None
    }

    /// The usable placement of a region of `size` with the least sum of squared errors over its known pixels, and that sum; of equal
    /// ones the first example's, there the uppermost, then leftmost. None when no placement is usable. `guesses` are
    /// placements that may be good: they make the search shorter and change nothing.
    ///
    /// # Errors
    /// When the device that measures fails.
    pub(super) fn best(
        &self,
        size: [usize; 2],
        known: &[Known],
        guesses: impl Iterator<Item = Place>,
    ) -> Result<Option<(Place, f32)>> {
        let mut bound = f32::INFINITY;
        for guess in guesses {
            let matcher = &self.matchers[guess.example as usize];
            bound = bound.min(matcher.error_within(size, [guess.x as usize, guess.y as usize], known, bound));
        }
        let mut best: Option<(Place, f32)> = None;
        for (i, matcher) in self.matchers.iter().enumerate() {
            let limit = best.map_or(bound.next_up(), |(_, error)| error);
            if let Some(([x, y], error)) = matcher.best_below(size, known, limit)? {
                best = Some((Place { example: i as u32, x: x as u32, y: y as u32 }, error));
            }
        }
        Ok(best)
    }
}
