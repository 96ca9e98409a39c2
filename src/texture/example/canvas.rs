//! The texture while it is made: patches are placed, split and pasted.

use anyhow::Result;
use image::RgbImage;

use super::border::Border;
use super::colour::{COLOUR_WEIGHTS, Known, Weighted, squared_error};
use super::pictures::{self, Owner};
use super::settings::{RADIUS, Settings, Synthesis};
use super::sources::{Place, Sources};
use crate::texture::noise::mixed;

/// Most placements that are tried as guesses of a patch's.
const GUESSES: usize = 32;

/// The texture while it is made.
pub(super) struct Canvas {
    pub(super) sources: Sources,
    pub(super) settings: Settings,
    pub(super) size: [usize; 2],
    pub(super) colours: Vec<Weighted>,
    pub(super) filled: Vec<bool>,
    /// Where in the examples a pixel came from, for guesses alone.
    pub(super) origins: Vec<Option<Place>>,
    pub(super) owners: Vec<Owner>,
    pub(super) anew: Vec<bool>,
    pub(super) patches: u32,
    /// Pixels that were known and stay, with the picture that has them; empty when nothing is known.
    pub(super) kept: Vec<bool>,
    pub(super) original: Option<RgbImage>,
}

/// A rectangle of the canvas; with a tile its pixels wrap around.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    pub(super) x: isize,
    pub(super) y: isize,
    pub(super) size: [usize; 2],
}

impl Canvas {
    pub(super) fn new(sources: Sources, settings: Settings) -> Self {
        let size = settings.size.map(|side| side as usize);
        let area = size[0] * size[1];
        Self {
            sources,
            settings,
            size,
            colours: vec![[0.0; 3]; area],
            filled: vec![false; area],
            origins: vec![None; area],
            owners: vec![Owner::default(); area],
            anew: vec![false; area],
            patches: 0,
            kept: Vec::new(),
            original: None,
        }
    }

    /// The rectangle of `sides` at `at`, grown by `margin`; cut at the borders unless the texture continues over them.
    pub(super) fn region(&self, at: [usize; 2], sides: [usize; 2], margin: usize) -> Region {
        let cut = |axis: usize| -> (isize, usize) {
            let (from, limit) = (at[axis], self.size[axis]);
            let side = sides[axis].min(limit - from);
            if self.settings.tile {
                return (from as isize - margin as isize, side + 2 * margin);
            }
            let low = from.saturating_sub(margin);
            (low as isize, (from + side + margin).min(limit) - low)
        };
        let ((x, columns), (y, rows)) = (cut(0), cut(1));
        Region { x, y, size: [columns, rows] }
    }

    /// Every pixel of a region: column and row in it, and index on the canvas.
    pub(super) fn pixels(&self, region: Region) -> impl Iterator<Item = (usize, usize, usize)> + use<> {
        let [width, height] = self.size;
        (0..region.size[1]).flat_map(move |v| {
            let y = (region.y + v as isize).rem_euclid(height as isize) as usize;
            (0..region.size[0])
                .map(move |u| (u, v, y * width + (region.x + u as isize).rem_euclid(width as isize) as usize))
        })
    }

    fn known(&self, region: Region) -> Vec<Known> {
        self.pixels(region)
            .filter(|&(_, _, i)| self.filled[i])
            .map(|(x, y, i)| Known { x, y, colour: self.colours[i], weight: 1.0 })
            .collect()
    }

    /// Placements of a region that go on with what some of its pixels came from.
    fn guesses(&self, region: Region, known_count: usize) -> Vec<Place> {
        let mut guesses = Vec::new();
        let filled = self.pixels(region).filter(|&(_, _, i)| self.filled[i]);
        for (u, v, i) in filled.step_by((known_count / GUESSES).max(1)) {
            if let Some(corner) = self.origins[i].and_then(|origin| origin.corner(u, v))
                && !guesses.contains(&corner)
            {
                guesses.push(corner);
            }
        }
        guesses
    }

    pub(super) fn die(&self, [x, y]: [usize; 2]) -> u32 {
        mixed(u64::from(mixed(self.settings.seed)) << 32 ^ (y * self.size[0] + x) as u64)
    }

    /// Fills the rectangle of `sides` at `at`: as one patch if one fits, else by quarters, or by halves where a side is one pixel.
    pub(super) fn place(&mut self, at: [usize; 2], sides: [usize; 2], overlap: usize) -> Result<()> {
        if (0..2).any(|axis| at[axis] >= self.size[axis]) {
            return Ok(());
        }
        if !self.kept.is_empty() && self.pixels(self.region(at, sides, 0)).all(|(_, _, i)| self.filled[i]) {
            return Ok(());
        }
        if sides == [1, 1] {
            self.pixel(at)?;
            self.patches += 1;
            self.owners[at[1] * self.size[0] + at[0]] = Owner { patch: self.patches, area: 1 };
            return Ok(());
        }
        let region = self.region(at, sides, overlap);
        // A region wider than a texture that wraps around would meet itself.
        let fits = (0..2).all(|axis| region.size[axis] <= self.size[axis]);
        if fits && self.settings.delta_max > 0.0 {
            let known = self.known(region);
            let found = if known.is_empty() {
                self.sources.any(region.size, self.die(at)).map(|place| (place, 0.0))
            } else {
                let guesses = self.guesses(region, known.len());
                self.sources.best(region.size, &known, guesses.into_iter())?
            };
            if let Some((place, error)) = found
                && error <= self.settings.delta_max * known.len() as f32
            {
                return self.paste(region, at, sides, place, overlap);
            }
        }
        let halves = sides.map(|side| side.div_ceil(2));
        for y in (0..sides[1]).step_by(halves[1]) {
            for x in (0..sides[0]).step_by(halves[0]) {
                self.place([at[0] + x, at[1] + y], halves, (overlap / 2).max(RADIUS))?;
            }
        }
        Ok(())
    }

    /// Copies an example at `place` into `region`: its rectangle as it is, feathered into what was there around it. Pixels there
    /// that differ too much are taken out and synthesised anew. Where they are kept, the rectangle gives way in their stead.
    fn paste(&mut self, region: Region, at: [usize; 2], sides: [usize; 2], place: Place, overlap: usize) -> Result<()> {
        self.patches += 1;
        let owner = Owner { patch: self.patches, area: (sides[0] * sides[1]) as u32 };
        let corner = [(at[0] as isize - region.x) as usize, (at[1] as isize - region.y) as usize];
        let outside = |axis: usize, c: usize| {
            let last = corner[axis] + sides[axis].min(self.size[axis] - at[axis]) - 1;
            corner[axis].saturating_sub(c).max(c.saturating_sub(last))
        };
        let pixels: Vec<(usize, usize, usize, usize)> =
            self.pixels(region).map(|(u, v, i)| (u, v, i, outside(0, u).max(outside(1, v)))).collect();
        let (mut taken_out, mut beside_kept) = (Vec::new(), Vec::new());
        let mut border = Border::new(region.size, overlap);
        for (u, v, i, away) in pixels {
            let origin = place.moved(u, v);
            let new = self.sources.colour(origin);
            if !self.filled[i] {
                if away == 0 {
                    (self.colours[i], self.filled[i], self.owners[i]) = (new, true, owner);
                    self.origins[i] = Some(origin);
                    border.within.push((u, v, i));
                }
            } else if squared_error(self.colours[i], new) > self.settings.delta_pixel {
                if self.is_kept(i) { beside_kept.push(i) } else { taken_out.push(i) }
            } else if self.is_kept(i) {
                border.differ(u, v, self.colours[i], new);
            } else {
                let share = 1.0 - away as f32 / (overlap + 1) as f32;
                for (old, new) in self.colours[i].iter_mut().zip(new) {
                    *old += (new - *old) * share;
                }
            }
        }
        if !self.kept.is_empty() {
            self.fade(&border);
            self.take_out_beside(&beside_kept, &mut taken_out);
        }
        taken_out.sort_unstable();
        taken_out.dedup();
        self.synthesise_anew(&taken_out)
    }

    /// The finished texture.
    pub(super) fn synthesis(self) -> Synthesis {
        let bytes = self.colours.iter().flat_map(|colour| {
            (0..3).map(|c| (colour[c] / COLOUR_WEIGHTS[c].sqrt() * 255.0 + 0.5).clamp(0.0, 255.0) as u8)
        });
        let [width, height] = self.settings.size;
        let mut picture = RgbImage::from_raw(width, height, bytes.collect()).unwrap_or_default();
        self.restore_kept(&mut picture);
        Synthesis {
            decomposition: pictures::decomposition(self.settings.size, self.settings.patch, &self.owners),
            resynthesised: pictures::resynthesised(&picture, &self.anew),
            resynthesised_count: self.anew.iter().filter(|&&anew| anew).count(),
            picture,
        }
    }
}
