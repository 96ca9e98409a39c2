//! How the images of a batch share a framebuffer: tiles of four candidates of one view, one a channel (METHOD A9). Arithmetic
//! alone; the memory is the framebuffer's.

use anyhow::{Result, bail};

use crate::evaluate::shaders::layout;
use crate::features::SeenView;

/// Candidates of a tile, one a channel.
pub(crate) const CANDIDATES_A_TILE: u32 = 4;

/// The part of a framebuffer that one view's tiles take: rows of `per_row` tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ViewTiles {
    /// Of the first tile, framebuffer pixels.
    pub(crate) origin: [u32; 2],
    /// Of a tile, pixels; the width is a multiple of four.
    pub(crate) size: [u32; 2],
    /// Tiles side by side.
    pub(crate) per_row: u32,
}

/// A framebuffer's tiles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TileLayout {
    pub(crate) views: Vec<ViewTiles>,
    /// Pixels in use, from the origin on.
    pub(crate) size: [u32; 2],
    /// Candidates that it holds.
    pub(crate) candidates: u32,
}

impl TileLayout {
    /// Tiles of the given sizes, one a view, for as many of `candidates` as go into a framebuffer of at most `most_side` pixels a
    /// side and `most_pixels` in all. Tiles wider or higher than that are cut: images that need more are not drawn in them.
    ///
    /// # Errors
    /// When not even one tile a view fits.
    pub(crate) fn new(sizes: &[[u32; 2]], candidates: u32, most_side: u32, most_pixels: u64) -> Result<Self> {
        let sizes: Vec<[u32; 2]> = sizes
            .iter()
            .map(|&[width, height]| {
                let widest = (most_side / 4 * 4).max(4);
                [width.max(1).next_multiple_of(4).min(widest), height.clamp(1, most_side)]
            })
            .collect();
        let groups = candidates.max(1).div_ceil(CANDIDATES_A_TILE);
        let fitting = |groups| Self::of_groups(&sizes, groups, most_side, most_pixels);
        // The largest number of groups that fits, by bisection.
        let (mut least, mut most) = (0, groups);
        while least < most {
            let middle = least + (most - least).div_ceil(2);
            if fitting(middle).is_some() {
                least = middle;
            } else {
                most = middle - 1;
            }
        }
        match fitting(least).filter(|_| least > 0) {
            Some(layout) => Ok(Self { candidates: layout.candidates.min(candidates.max(1)), ..layout }),
            None => bail!(
                "not even one tile a view fits a framebuffer of {most_side} pixels a side and {most_pixels} in all"
            ),
        }
    }

    /// Tiles for exactly so many groups of four, as near to a square as fits.
    fn of_groups(sizes: &[[u32; 2]], groups: u32, most_side: u32, most_pixels: u64) -> Option<Self> {
        let area: u64 = sizes.iter().map(|[w, h]| u64::from(*w) * u64::from(*h) * u64::from(groups)).sum();
        let widest = sizes.iter().map(|size| size[0]).max()?;
        let square = (area as f64).sqrt().ceil() as u32;
        // The sides grow together until all rows find room.
        let mut side = square.clamp(widest, most_side.max(widest));
        loop {
            let mut views = Vec::new();
            let (mut width, mut top) = (0, 0_u32);
            for &size in sizes {
                let per_row = (side / size[0]).clamp(1, groups.max(1));
                views.push(ViewTiles { origin: [0, top], size, per_row });
                width = width.max(per_row * size[0]);
                top = top.saturating_add(groups.div_ceil(per_row).saturating_mul(size[1]));
            }
            let fits = width <= most_side && top <= most_side && u64::from(width) * u64::from(top) <= most_pixels;
            if fits {
                return Some(Self { views, size: [width, top], candidates: groups * CANDIDATES_A_TILE });
            }
            if side >= most_side {
                return None;
            }
            side = (side + side / 8 + 1).min(most_side);
        }
    }

    /// Side of the viewport, pixels: a power of two, so that clip coordinates are exact.
    pub(crate) fn viewport(&self) -> u32 {
        self.size[0].max(self.size[1]).next_power_of_two()
    }

    /// As the stages read it; `whole` lets a tile show the picture from its origin on.
    pub(crate) fn rows(&self, whole: bool) -> (layout::TilesHeader, Vec<layout::ViewTiles>) {
        let to_clip = 2.0 / self.viewport() as f32;
        let rows = self.views.iter().map(|view| layout::ViewTiles {
            origin: view.origin,
            size: view.size,
            per_row: view.per_row,
            whole: u32::from(whole),
        });
        (layout::TilesHeader { to_clip: [to_clip; 2] }, rows.collect())
    }

    /// Left top of the tile of candidate `candidate` of the batch, as the stages compute it.
    #[cfg(test)]
    pub(crate) fn origin(&self, candidate: u32, view: usize) -> [u32; 2] {
        let ViewTiles { origin, size, per_row } = self.views[view];
        let group = candidate / CANDIDATES_A_TILE;
        [origin[0] + group % per_row * size[0], origin[1] + group / per_row * size[1]]
    }
}

/// The tiles of views of which only the observation is known: its silhouette, a quarter larger; the picture when there is none.
/// Where a search has recorded itself with tiles, those, as long as they are large enough.
pub(crate) fn first_tiles(views: &[SeenView<'_>], recorded: Option<&Vec<[u32; 2]>>) -> Vec<[u32; 2]> {
    let first = |view: &SeenView<'_>| {
        let picture = view.size();
        view.bounds().map_or(picture, |seen| {
            let sides = [seen.x1 - seen.x0, seen.y1 - seen.y0];
            [0, 1].map(|axis| (sides[axis] + sides[axis] / 4 + 16).min(picture[axis]))
        })
    };
    let seen: Vec<[u32; 2]> = views.iter().map(first).collect();
    let Some(recorded) = recorded else { return seen };
    let is_outgrown = seen.iter().zip(recorded).any(|(seen, tile)| seen[0] > tile[0] || seen[1] > tile[1]);
    if !is_outgrown {
        return recorded.clone();
    }
    // With room to grow into, so that this does not happen in every frame of an approach.
    let grown = seen.iter().zip(views).map(|(seen, view)| {
        let picture = view.size();
        [0, 1].map(|axis| (seen[axis] + seen[axis] / 4).min(picture[axis]))
    });
    grown.collect()
}

/// The tiles that views need for what their images touched, `bounds[candidate][view]`, one image in `spare` left out; and whether
/// one was too small. `pictures` are the sizes of the views' pictures.
pub(crate) fn fitted_tiles(
    tiles: &[[u32; 2]],
    bounds: &[layout::Bounds],
    pictures: &[[u32; 2]],
    spare: usize,
) -> (Vec<[u32; 2]>, bool) {
    let mut tiles = tiles.to_vec();
    let mut is_outgrown = false;
    for (view, tile) in tiles.iter_mut().enumerate() {
        let mut extents: Vec<[u32; 2]> = bounds
            .iter()
            .skip(view)
            .step_by(pictures.len())
            .filter(|bounds| bounds.low[0] < bounds.high[0] && bounds.low[1] < bounds.high[1])
            .map(|bounds| {
                let side = |axis: usize, low: i32| (bounds.high[axis] - low).unsigned_abs();
                [side(0, bounds.low[0] & !3), side(1, bounds.low[1])]
            })
            .collect();
        if let Some(needed) = fitting_tile(&mut extents, spare) {
            is_outgrown |= needed[0] > tile[0].next_multiple_of(4) || needed[1] > tile[1];
            *tile = next_tile(*tile, needed, pictures[view]);
        }
    }
    (tiles, is_outgrown)
}

/// The tile that a view needs so that all but one in `spare` of its images fit: `extents` are what the images touch, [width, height]
/// from the word of four pixels on where they begin, pixels. None when nothing is seen.
fn fitting_tile(extents: &mut [[u32; 2]], spare: usize) -> Option<[u32; 2]> {
    let last = extents.len().checked_sub(1)?;
    let place = last - extents.len() / spare;
    let mut side = |axis: usize| {
        extents.sort_unstable_by_key(|extent| extent[axis]);
        extents[place][axis]
    };
    Some([side(0).next_multiple_of(4), side(1).next_multiple_of(4)])
}

/// What becomes of a tile of size `now` when `needed` is what its images took: nothing while they fit it and do not waste half
/// of it, else their need and a margin, at most the picture.
fn next_tile(now: [u32; 2], needed: [u32; 2], picture: [u32; 2]) -> [u32; 2] {
    const MARGIN: u32 = 8;
    let wide = picture[0].next_multiple_of(4);
    let wanted = [(needed[0] + MARGIN).next_multiple_of(4).min(wide), (needed[1] + MARGIN).min(picture[1])];
    let area = |size: [u32; 2]| u64::from(size[0]) * u64::from(size[1]);
    let fits = needed[0] <= now[0] && needed[1] <= now[1];
    if fits && 2 * area(wanted) > area(now) { now } else { wanted }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_do_not_overlap_and_stay_inside() {
        for (sizes, candidates, side) in [
            (vec![[104, 168], [120, 160], [61, 33]], 512, 16384),
            (vec![[104, 168], [120, 160]], 512, 700),
            (vec![[480, 270]], 7, 2000),
            (vec![[8, 8]; 5], 1, 64),
        ] {
            let layout = TileLayout::new(&sizes, candidates, side, u64::MAX).unwrap();
            assert!(layout.candidates > 0 && layout.candidates <= candidates);
            let mut taken = std::collections::HashMap::new();
            for candidate in (0..layout.candidates).step_by(4) {
                for (view, size) in sizes.iter().enumerate() {
                    let [left, top] = layout.origin(candidate, view);
                    let [width, height] = layout.views[view].size;
                    assert!(width >= size[0] && height == size[1] && width % 4 == 0 && left % 4 == 0);
                    assert!(left + width <= layout.size[0] && top + height <= layout.size[1], "{layout:?}");
                    assert!(layout.size[0] <= side && layout.size[1] <= side);
                    // Corners and centre of tiles of equal size on a grid tell all overlaps; views lie below each other.
                    assert!(taken.insert((left, top), (candidate, view)).is_none());
                }
            }
            for pair in layout.views.windows(2) {
                assert!(pair[1].origin[1] > pair[0].origin[1]);
            }
        }
    }

    #[test]
    fn what_does_not_fit_goes_into_batches_and_large_tiles_are_cut() {
        let layout = TileLayout::new(&[[100, 100]], 400, 256, u64::MAX).unwrap();
        assert_eq!((layout.candidates, layout.size), (16, [200, 200]));
        let layout = TileLayout::new(&[[100, 100]], 400, 16384, 35_000).unwrap();
        assert_eq!(layout.candidates, 12);
        let layout = TileLayout::new(&[[480, 270]], 9, 100, u64::MAX).unwrap();
        assert_eq!((layout.views[0].size, layout.candidates), ([100, 100], 4));
        let error = TileLayout::new(&[[480, 270], [480, 270]], 9, 100, u64::MAX).unwrap_err();
        assert_eq!(
            error.to_string(),
            "not even one tile a view fits a framebuffer of 100 pixels a side and 18446744073709551615 in all"
        );
    }

    #[test]
    fn the_viewport_makes_clip_coordinates_exact() {
        let layout = TileLayout::new(&[[104, 168]; 4], 512, 16384, u64::MAX).unwrap();
        let (header, rows) = layout.rows(true);
        assert!(rows.iter().all(|row| row.whole == 1));
        let side = layout.viewport() as f32;
        for snapped in [0, 1, 255, 256 * 2999 + 77, 256 * layout.size[0] - 1] {
            let pixel = snapped as f32 / 256.0 + 0.5;
            let clip = pixel * header.to_clip[0] - 1.0;
            assert_eq!((clip + 1.0) * (side / 2.0), pixel);
        }
    }

    #[test]
    fn tiles_follow_what_their_images_take() {
        let mut extents: Vec<[u32; 2]> = (0..100).map(|i| [i, 200 - i]).collect();
        assert_eq!(fitting_tile(&mut extents, 50), Some([100, 200]));
        assert_eq!(fitting_tile(&mut [[5, 9]], 50), Some([8, 12]));
        assert_eq!(fitting_tile(&mut [], 50), None);
        assert_eq!(next_tile([100, 100], [96, 90], [480, 270]), [100, 100], "fits");
        assert_eq!(next_tile([100, 100], [104, 90], [480, 270]), [112, 98], "grows");
        assert_eq!(next_tile([100, 100], [40, 40], [480, 270]), [48, 48], "shrinks");
        assert_eq!(next_tile([100, 100], [478, 400], [478, 270]), [480, 270], "no larger than the picture");
    }
}
