//! A change of the light over the whole picture: how much brighter a picture is than the background known, channel by channel.

use image::RgbImage;

use super::shaders::{RATIO_COUNTS, RATIO_GRID, RATIO_LEAST, RATIO_MOST, RATIO_STEPS};

/// The steps a ratio is counted in.
const STEPS: usize = RATIO_STEPS as usize;

/// Every how many rows and columns a pixel is asked.
pub(super) const GRID: usize = RATIO_GRID as usize;

/// Ratios of a picture to its background over a grid of pixels, counted.
pub(super) struct Ratios {
    counts: [[u32; RATIO_COUNTS as usize]; 3],
}

impl Ratios {
    /// None yet.
    pub(super) fn new() -> Self {
        Self { counts: [[0; RATIO_COUNTS as usize]; 3] }
    }

    /// Counts a pixel.
    #[inline]
    pub(super) fn add(&mut self, seen: [u8; 3], background: [u8; 3]) {
        for channel in 0..3 {
            let (seen, background) = (u32::from(seen[channel]), u32::from(background[channel]));
            // Dark pixels say nothing about a ratio, and saturated ones lie.
            if (32..=235).contains(&background) && seen <= 250 {
                let ratio = (seen * RATIO_STEPS + background / 2) / background;
                if let Some(count) = self.counts[channel].get_mut(ratio as usize) {
                    *count += 1;
                }
            }
        }
    }

    /// What to multiply the background with so that it is as bright as the picture: the median ratio, which no person
    /// covering less than half the picture can move far.
    pub(super) fn gains(&self) -> [f32; 3] {
        let [least, most] = [RATIO_LEAST, RATIO_MOST].map(|steps| steps as f32 / STEPS as f32);
        self.counts.map(|counts| median(&counts).clamp(least, most))
    }
}

/// What to multiply `background` with, channel by channel, so that it is as bright as `picture`, of the same size.
pub(super) fn gains(picture: &RgbImage, background: &RgbImage) -> [f32; 3] {
    let mut ratios = Ratios::new();
    let bytes = (picture.width() as usize * 3).max(1);
    let rows = picture.as_raw().chunks_exact(bytes).zip(background.as_raw().chunks_exact(bytes));
    for (seen, background) in rows.step_by(GRID) {
        let pixels = seen.as_chunks().0.iter().zip(background.as_chunks().0);
        pixels.step_by(GRID).for_each(|(&seen, &background)| ratios.add(seen, background));
    }
    ratios.gains()
}

/// A colour whose channels are multiplied with `dim`.
pub(super) fn lit(colour: [u8; 3], dim: [f32; 3]) -> [i16; 3] {
    [0, 1, 2].map(|channel: usize| (f32::from(colour[channel]) * dim[channel] + 0.5) as i16)
}

/// The median of counted ratios (steps of 1/[`STEPS`]); 1 when none was counted.
fn median(counts: &[u32]) -> f32 {
    let half = counts.iter().sum::<u32>() / 2;
    let mut below = 0;
    for (step, &count) in counts.iter().enumerate() {
        if below + count > half {
            return step as f32 / STEPS as f32;
        }
        below += count;
    }
    1.0
}
