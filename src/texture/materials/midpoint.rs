//! Random mid-point displacement: a fractal surface over a square that repeats itself.

use crate::texture::noise::mixed;

/// How a surface is displaced, on the processor or a device.
#[derive(Clone, Debug)]
pub(in crate::texture) struct Displacement {
    /// Points a side.
    pub(in crate::texture) side: u32,
    /// What tells surfaces apart, already mixed.
    pub(in crate::texture) seed: u32,
    /// Of each level: how far displacements go in the middles of squares, and in those of sides.
    pub(in crate::texture) levels: Vec<[f32; 2]>,
}

impl Displacement {
    /// Displaces `2^levels` points a side. From level to level displacements shrink by `2^-smoothness`, so 0 is rough, 1 smooth.
    pub(in crate::texture) fn new(seed: u64, levels: u32, smoothness: f32) -> Self {
        let levels = levels.clamp(1, 11);
        let mut amplitude = 1.0_f32;
        let level = |_| {
            let level = [amplitude, 0.7 * amplitude];
            amplitude *= (-smoothness.clamp(0.0, 2.0)).exp2();
            level
        };
        Self { side: 1 << levels, seed: mixed(seed), levels: (0..levels).map(level).collect() }
    }
}

/// Heights over a torus of `side` x `side` points, scaled to [0, 1].
#[derive(Clone, Debug)]
pub struct Surface {
    side: usize,
    heights: Vec<f32>,
}

impl Surface {
    /// Displaces `2^levels` points a side. From level to level displacements shrink by `2^-smoothness`, so 0 is rough, 1 smooth.
    pub fn new(seed: u64, levels: u32, smoothness: f32) -> Self {
        Self::of(&Displacement::new(seed, levels, smoothness))
    }

    /// Displaced so.
    pub(super) fn of(displacement: &Displacement) -> Self {
        let side = displacement.side as usize;
        let mut heights = vec![0.0_f32; side * side];
        let die = |x: usize, y: usize| {
            let word = mixed(u64::from(displacement.seed) << 32 | (y * side + x) as u64);
            (word >> 8) as f32 / 8_388_608.0 - 1.0
        };
        for (level, [of_squares, of_sides]) in displacement.levels.iter().enumerate() {
            let step = side >> level;
            let half = step / 2;
            let wrap = |i: usize| i % side;
            // Middles of squares, from their four corners.
            for y in (half..side).step_by(step) {
                for x in (half..side).step_by(step) {
                    let (l, r, t, b) = (x - half, wrap(x + half), y - half, wrap(y + half));
                    let sum =
                        heights[t * side + l] + heights[t * side + r] + heights[b * side + l] + heights[b * side + r];
                    heights[y * side + x] = sum / 4.0 + of_squares * die(x, y);
                }
            }
            // Middles of sides, from the two ends and the two middles beside them.
            for y in (0..side).step_by(half) {
                let first = if (y / half).is_multiple_of(2) { half } else { 0 };
                for x in (first..side).step_by(step) {
                    let (l, r) = (wrap(x + side - half), wrap(x + half));
                    let (t, b) = (wrap(y + side - half), wrap(y + half));
                    let sum =
                        heights[y * side + l] + heights[y * side + r] + heights[t * side + x] + heights[b * side + x];
                    heights[y * side + x] = sum / 4.0 + of_sides * die(x, y);
                }
            }
        }
        let low = heights.iter().copied().fold(f32::MAX, f32::min);
        let range = heights.iter().copied().fold(f32::MIN, f32::max) - low;
        for height in &mut heights {
            *height = (*height - low) / range.max(f32::MIN_POSITIVE);
        }
        Self { side, heights }
    }

    /// Heights, row by row.
    #[cfg(test)]
    pub(in crate::texture) fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The height at a place; one repetition is a unit long. Cubic (Catmull and Rom) between points, so that light falls on it
    /// without creases.
    pub fn at(&self, x: f32, y: f32) -> f32 {
        let side = self.side as f32;
        let place = |v: f32| {
            let v = (v - v.floor()) * side;
            (v.floor(), v - v.floor())
        };
        let ((cx, tx), (cy, ty)) = (place(x), place(y));
        let weights = |t: f32| {
            let (t2, t3) = (t * t, t * t * t);
            [
                0.5 * (-t3 + 2.0 * t2 - t),
                0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
                0.5 * (-3.0 * t3 + 4.0 * t2 + t),
                0.5 * (t3 - t2),
            ]
        };
        let (wx, wy) = (weights(tx), weights(ty));
        let index = |c: f32, k: usize| (c as usize + self.side + k - 1) % self.side;
        let mut sum = 0.0;
        for (j, wy) in wy.into_iter().enumerate() {
            let row = &self.heights[index(cy, j) * self.side..][..self.side];
            sum += wy * (0..4).map(|i| wx[i] * row[index(cx, i)]).sum::<f32>();
        }
        sum.clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_repeat_and_fill_their_range() {
        let surface = Surface::new(1, 6, 0.8);
        let values: Vec<f32> = (0..4096).map(|i| surface.at((i % 64) as f32 / 64.0, (i / 64) as f32 / 64.0)).collect();
        assert!(values.contains(&0.0) && values.contains(&1.0));
        for i in 0..100 {
            let (x, y) = (i as f32 / 16.0 - 3.0, i as f32 / 32.0);
            assert_eq!(surface.at(x, y), surface.at(x + 1.0, y - 2.0));
        }
        assert_ne!(surface.at(0.3, 0.3), Surface::new(2, 6, 0.8).at(0.3, 0.3));
    }

    #[test]
    fn smooth_surfaces_are_smoother() {
        let roughness = |smoothness| {
            let surface = Surface::new(3, 8, smoothness);
            (0..255)
                .map(|i| (surface.at(i as f32 / 256.0, 0.4) - surface.at((i + 1) as f32 / 256.0, 0.4)).abs())
                .sum::<f32>()
        };
        assert!(roughness(0.2) > 2.0 * roughness(1.0));
    }
}
