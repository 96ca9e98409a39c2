//! Connected components of a binary picture: the largest blobs, holes, and hysteresis.

use std::ops::Range;

use super::{BitImage, Region};

/// Which pixels are neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Connectivity {
    /// Left, right, above, below.
    Four,
    /// Diagonals too.
    Eight,
}

/// A connected set of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blob {
    /// Its pixels.
    pub area: u32,
    /// The smallest region that holds it.
    pub bounds: Region,
}

#[derive(Clone, Debug)]
struct Run {
    y: usize,
    columns: Range<usize>,
    /// Index of a run of the same component that came earlier, or of itself.
    parent: usize,
}

/// The components of one picture, as joined runs. Its memory is kept from picture to picture.
#[derive(Clone, Debug, Default)]
pub struct Components {
    runs: Vec<Run>,
    /// The component of each run, an index into `blobs`.
    component: Vec<usize>,
    blobs: Vec<Blob>,
    complement: BitImage,
    keep: Vec<bool>,
    order: Vec<usize>,
}

impl Components {
    /// Finds the components of `image`, in the reading order of their first pixels.
    pub fn find(&mut self, image: &BitImage, connectivity: Connectivity) -> &[Blob] {
        self.runs.clear();
        let reach = match connectivity {
            Connectivity::Four => 0,
            Connectivity::Eight => 1,
        };
        let runs = &mut self.runs;
        // Two cursors over the row above and this one would do; runs come in reading order, so one window suffices.
        let (mut above, mut this_row, mut row) = (0..0, 0, usize::MAX);
        image.for_each_run(|y, columns| {
            if y != row {
                above = if row.wrapping_add(1) == y { this_row..runs.len() } else { 0..0 };
                this_row = runs.len();
                row = y;
            }
            let index = runs.len();
            runs.push(Run { y, columns: columns.clone(), parent: index });
            while above.start < above.end && runs[above.start].columns.end + reach <= columns.start {
                above.start += 1;
            }
            for other in above.clone() {
                if runs[other].columns.start >= columns.end + reach {
                    break;
                }
                join(runs, other, index);
            }
        });
        self.component.clear();
        self.blobs.clear();
        for index in 0..self.runs.len() {
            let root = root(&mut self.runs, index);
            let run = &self.runs[index];
            let bounds = Region {
                x0: run.columns.start as u32,
                y0: run.y as u32,
                x1: run.columns.end as u32,
                y1: run.y as u32 + 1,
            };
            // A root is the earliest run of its component, so its blob is there when a later run asks.
            if root == index {
                self.component.push(self.blobs.len());
                self.blobs.push(Blob { area: run.columns.len() as u32, bounds });
            } else {
                let component = self.component[root];
                let blob = &mut self.blobs[component];
                blob.area += run.columns.len() as u32;
                blob.bounds.x0 = blob.bounds.x0.min(bounds.x0);
                blob.bounds.x1 = blob.bounds.x1.max(bounds.x1);
                blob.bounds.y1 = bounds.y1;
                self.component.push(component);
            }
        }
        &self.blobs
    }

    /// Leaves only the `count` largest blobs (8-connected) of at least `min_area` pixels and at least `min_share` of the
    /// largest one's area.
    pub fn keep_largest(&mut self, image: &mut BitImage, count: usize, min_area: u32, min_share: f32) {
        self.find(image, Connectivity::Eight);
        let largest = self.blobs.iter().map(|blob| blob.area).max().unwrap_or(0);
        let min_area = min_area.max((largest as f32 * min_share).ceil() as u32);
        self.order.clear();
        self.order.extend((0..self.blobs.len()).filter(|&at| self.blobs[at].area >= min_area));
        // Equal areas keep their reading order: the same picture always gives the same blobs.
        self.order.sort_by_key(|&at| std::cmp::Reverse(self.blobs[at].area));
        self.keep.clear();
        self.keep.resize(self.blobs.len(), false);
        self.order.iter().take(count).for_each(|&at| self.keep[at] = true);
        image.clear();
        self.draw_kept(image);
    }

    /// Fills the holes (4-connected, not touching the picture's border) of at most `max_area` pixels.
    pub fn fill_holes(&mut self, image: &mut BitImage, max_area: u32) {
        let mut complement = std::mem::take(&mut self.complement);
        complement.copy_from(image);
        complement.invert();
        self.find(&complement, Connectivity::Four);
        self.complement = complement;
        let (width, height) = (image.width(), image.height());
        self.keep.clear();
        self.keep.extend(self.blobs.iter().map(|blob| {
            let b = blob.bounds;
            blob.area <= max_area && b.x0 > 0 && b.y0 > 0 && b.x1 < width && b.y1 < height
        }));
        self.draw_kept(image);
    }

    /// Hysteresis: leaves of `weak` only the components (8-connected) with at least one pixel in `strong`.
    pub fn keep_touched(&mut self, weak: &mut BitImage, strong: &BitImage) {
        self.find(weak, Connectivity::Eight);
        self.keep.clear();
        self.keep.resize(self.blobs.len(), false);
        for (run, &component) in self.runs.iter().zip(&self.component) {
            if !self.keep[component] {
                self.keep[component] = strong.any_in_run(run.y, run.columns.clone());
            }
        }
        weak.clear();
        self.draw_kept(weak);
    }

    fn draw_kept(&self, image: &mut BitImage) {
        for (run, &component) in self.runs.iter().zip(&self.component) {
            if self.keep[component] {
                image.set_run(run.y, run.columns.clone());
            }
        }
    }
}

/// The earliest run of a component, with the path to it halved on the way.
fn root(runs: &mut [Run], mut at: usize) -> usize {
    while runs[at].parent != at {
        runs[at].parent = runs[runs[at].parent].parent;
        at = runs[at].parent;
    }
    at
}

fn join(runs: &mut [Run], a: usize, b: usize) {
    let (a, b) = (root(runs, a), root(runs, b));
    // The earlier run stays the root.
    runs[a.max(b)].parent = a.min(b);
}

#[cfg(test)]
mod tests {
    use super::super::bit_image::any_bit_image;
    use super::*;
    use proptest::prelude::*;

    /// Components by flood fill: the pixels of each, in the reading order of their first pixels.
    fn flooded(image: &BitImage, connectivity: Connectivity) -> Vec<Vec<(u32, u32)>> {
        let mut left = image.clone();
        let mut components = Vec::new();
        for y in 0..image.height() {
            for x in 0..image.width() {
                if !left.get(x, y) {
                    continue;
                }
                left.set(x, y, false);
                let (mut pixels, mut stack) = (Vec::new(), vec![(x, y)]);
                while let Some((x, y)) = stack.pop() {
                    pixels.push((x, y));
                    for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)] {
                        if connectivity == Connectivity::Four && dx != 0 && dy != 0 {
                            continue;
                        }
                        let (nx, ny) = (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                        if left.get(nx, ny) {
                            left.set(nx, ny, false);
                            stack.push((nx, ny));
                        }
                    }
                }
                components.push(pixels);
            }
        }
        components
    }

    fn drawn<'a>(like: &BitImage, components: impl IntoIterator<Item = &'a Vec<(u32, u32)>>) -> BitImage {
        let mut image = BitImage::new(like.width(), like.height());
        components.into_iter().flatten().for_each(|&(x, y)| image.set(x, y, true));
        image
    }

    proptest! {
        #[test]
        fn components_match_flood_fill(image in any_bit_image(), eight in any::<bool>()) {
            let connectivity = if eight { Connectivity::Eight } else { Connectivity::Four };
            let expected: Vec<Blob> = flooded(&image, connectivity)
                .iter()
                .map(|pixels| Blob { area: pixels.len() as u32, bounds: drawn(&image, [pixels]).bounds().unwrap() })
                .collect();
            let mut components = Components::default();
            prop_assert_eq!(components.find(&image, connectivity), &expected[..]);
        }

        #[test]
        fn largest_blobs_match_flood_fill(image in any_bit_image(), count in 0_usize..5, min_area in 0_u32..30, share in 0_u8..5) {
            let share = f32::from(share) / 4.0;
            let mut expected = flooded(&image, Connectivity::Eight);
            let largest = expected.iter().map(Vec::len).max().unwrap_or(0) as f32;
            expected.retain(|pixels| pixels.len() as u32 >= min_area && pixels.len() as f32 >= largest * share);
            expected.sort_by_key(|pixels| std::cmp::Reverse(pixels.len()));
            expected.truncate(count);
            let mut kept = image.clone();
            Components::default().keep_largest(&mut kept, count, min_area, share);
            prop_assert_eq!(kept, drawn(&image, &expected));
        }

        #[test]
        fn holes_match_flood_fill(image in any_bit_image(), max_area in 0_u32..30) {
            let mut complement = image.clone();
            complement.invert();
            let holes = flooded(&complement, Connectivity::Four);
            let mut expected = drawn(&image, holes.iter().filter(|hole| {
                let border = |&(x, y): &(u32, u32)| {
                    x == 0 || y == 0 || x + 1 == image.width() || y + 1 == image.height()
                };
                hole.len() as u32 <= max_area && !hole.iter().any(border)
            }));
            image.for_each_run(|y, columns| expected.set_run(y, columns));
            let mut filled = image.clone();
            Components::default().fill_holes(&mut filled, max_area);
            prop_assert_eq!(filled, expected);
        }

        #[test]
        fn hysteresis_matches_flood_fill(weak in any_bit_image(), seeds in proptest::collection::vec((0_u32..140, 0_u32..24), 0..4)) {
            let strong = BitImage::from_fn(weak.width(), weak.height(), |x, y| seeds.contains(&(x, y)));
            let components = flooded(&weak, Connectivity::Eight);
            let expected =
                drawn(&weak, components.iter().filter(|pixels| pixels.iter().any(|&(x, y)| strong.get(x, y))));
            let mut kept = weak.clone();
            Components::default().keep_touched(&mut kept, &strong);
            prop_assert_eq!(kept, expected);
        }
    }

    #[test]
    fn one_cleared_pixel_splits_a_blob() {
        let mut image = BitImage::from_fn(130, 1, |_, _| true);
        let mut components = Components::default();
        assert_eq!(components.find(&image, Connectivity::Eight).len(), 1);
        image.set(64, 0, false);
        let areas: Vec<u32> = components.find(&image, Connectivity::Eight).iter().map(|blob| blob.area).collect();
        assert_eq!(areas, [64, 65]);
    }
}
