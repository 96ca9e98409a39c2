//! Where a patch meets pixels that are kept.

use super::colour::Weighted;

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

    /// Whether nothing that is kept was noted.
    pub(super) fn is_clear(&self) -> bool {
        self.differences.is_empty()
    }

    /// What is added to a pixel of the patch, so that it goes over into what is kept: the mean difference of the nearest pixels that
    /// are, and of those one farther, less the farther they are.
    pub(super) fn change(&self, at: [usize; 2]) -> Weighted {
        let nearest = (1..=self.reach).find(|&away| self.mean(at, away).is_some());
        let Some((away, difference)) = nearest.and_then(|away| Some((away, self.mean(at, away + 1)?))) else {
            return [0.0; 3];
        };
        difference.map(|difference| difference * (1.0 - away as f32 / (self.reach + 1) as f32))
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
