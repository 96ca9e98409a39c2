//! A texture of any size from a small example: patch by patch, and where patches do not fit pixel by pixel (METHOD B3).

pub mod colour;
mod device_matching;
pub mod matching;
mod pictures;
#[cfg(test)]
mod tests;

use std::collections::BinaryHeap;

use anyhow::{Result, bail};
use image::{GrayImage, RgbImage};

use self::colour::{COLOUR_WEIGHTS, Known, Weighted, squared_error};
use self::matching::Matcher;
use self::pictures::Owner;
use super::noise::mixed;
use crate::gpu::Device;

/// Pixels around one that its neighbourhood takes in: 7 x 7.
const RADIUS: usize = 3;
/// Most pixels of a result.
const MOST_PIXELS: u64 = 1 << 26;
/// Most pixels of an example.
const MOST_EXAMPLE: u64 = 1 << 22;

/// What is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels of the result.
    pub size: [u32; 2],
    /// Side of a patch, pixels.
    pub patch: u32,
    /// Pixels by which patches overlap what is there.
    pub overlap: u32,
    /// Mean squared error of a patch's overlap, 0 to 1, above which it is split; 0 splits all into pixels.
    pub delta_max: f32,
    /// Squared error of a pixel of the overlap above which it is synthesised anew.
    pub delta_pixel: f32,
    /// What is chosen where nothing says what fits.
    pub seed: u64,
    /// The result continues over its borders into itself.
    pub tile: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { size: [256, 256], patch: 32, overlap: 8, delta_max: 0.04, delta_pixel: 0.03, seed: 0, tile: false }
    }
}

/// A texture and how it came about.
#[derive(Clone, Debug)]
pub struct Synthesis {
    /// The texture.
    pub picture: RgbImage,
    /// Its patches, coloured by their size: blue the largest, red single pixels.
    pub decomposition: RgbImage,
    /// The texture in grey, with the pixels that were synthesised anew in red.
    pub resynthesised: RgbImage,
    /// How many these are.
    pub resynthesised_count: usize,
}

/// Synthesises a texture; `mask` (as large as the example) is dark where the example may not be used. `advance` is called after
/// each of [`patch_count`] steps. The same result on every run, for any number of threads, and whether the processor measures
/// what fits or a `device` does.
///
/// # Errors
/// When a size or a setting makes no sense, the mask has another size than the example or leaves nothing of it, or the device
/// fails.
pub fn synthesise(
    example: &RgbImage,
    mask: Option<&GrayImage>,
    settings: &Settings,
    device: Option<&Device>,
    mut advance: impl FnMut(),
) -> Result<Synthesis> {
    check(example, mask, settings)?;
    let usable: Option<Vec<bool>> = mask.map(|mask| mask.pixels().map(|pixel| pixel.0[0] >= 128).collect());
    let mut matcher = Matcher::new(example, usable.as_deref());
    if let Some(device) = device {
        matcher = matcher.on_device(device)?;
    }
    let [width, height] = settings.size.map(|side| side as usize);
    let mut canvas = Canvas {
        matcher,
        settings: *settings,
        size: [width, height],
        colours: vec![[0.0; 3]; width * height],
        filled: vec![false; width * height],
        owners: vec![Owner::default(); width * height],
        anew: vec![false; width * height],
        patches: 0,
    };
    let side = settings.patch as usize;
    for y in (0..height).step_by(side) {
        for x in (0..width).step_by(side) {
            canvas.place(x, y, side, settings.overlap as usize)?;
            advance();
        }
    }
    let bytes = canvas.colours.iter().flat_map(|colour| {
        (0..3).map(|c| (colour[c] / COLOUR_WEIGHTS[c].sqrt() * 255.0 + 0.5).clamp(0.0, 255.0) as u8)
    });
    let picture = RgbImage::from_raw(settings.size[0], settings.size[1], bytes.collect()).unwrap_or_default();
    Ok(Synthesis {
        decomposition: pictures::decomposition(settings.size, settings.patch, &canvas.owners),
        resynthesised: pictures::resynthesised(&picture, &canvas.anew),
        resynthesised_count: canvas.anew.iter().filter(|&&anew| anew).count(),
        picture,
    })
}

/// Patches of a result before any is split.
pub fn patch_count(settings: &Settings) -> usize {
    let [columns, rows] = settings.size.map(|side| side.div_ceil(settings.patch.max(1)) as usize);
    columns * rows
}

fn check(example: &RgbImage, mask: Option<&GrayImage>, settings: &Settings) -> Result<()> {
    let Settings { size: [width, height], patch, overlap, delta_max, delta_pixel, .. } = *settings;
    let area = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
    let example_size = [example.width(), example.height()];
    if area(example_size) == 0 || area(example_size) > MOST_EXAMPLE {
        bail!("an example of {} x {} pixels, expected 1 to {MOST_EXAMPLE} pixels", example.width(), example.height());
    }
    if area([width, height]) == 0 || area([width, height]) > MOST_PIXELS {
        bail!("a texture of {width} x {height} pixels, expected 1 to {MOST_PIXELS} pixels");
    }
    if !(1..=4096).contains(&patch) {
        bail!("patches of {patch} pixels a side, expected 1 to 4096");
    }
    if !(RADIUS as u32..=1024).contains(&overlap) {
        bail!("patches that overlap by {overlap} pixels, expected {RADIUS} to 1024");
    }
    for (name, delta) in [("delta_max", delta_max), ("delta_pixel", delta_pixel)] {
        if !(0.0..=1.0).contains(&delta) {
            bail!("{name} is {delta}, expected a number from 0 to 1");
        }
    }
    if let Some(mask) = mask {
        if [mask.width(), mask.height()] != example_size {
            bail!(
                "the mask has {} x {} pixels, expected the example's {} x {}",
                mask.width(),
                mask.height(),
                example.width(),
                example.height()
            );
        }
        if mask.pixels().all(|pixel| pixel.0[0] < 128) {
            bail!("the mask is dark all over, so that no pixel of the example may be used");
        }
    }
    Ok(())
}

/// The texture while it is made.
struct Canvas {
    matcher: Matcher,
    settings: Settings,
    size: [usize; 2],
    colours: Vec<Weighted>,
    filled: Vec<bool>,
    owners: Vec<Owner>,
    anew: Vec<bool>,
    patches: u32,
}

/// A rectangle of the canvas; with a tile its pixels wrap around.
#[derive(Clone, Copy, Debug)]
struct Region {
    x: isize,
    y: isize,
    size: [usize; 2],
}

impl Canvas {
    /// The square of `side` at (x, y), grown by `margin`; cut at the borders unless the texture continues over them.
    fn region(&self, x: usize, y: usize, side: usize, margin: usize) -> Region {
        let [width, height] = self.size;
        let cut = |from: usize, limit: usize| -> (isize, usize) {
            let side = side.min(limit - from);
            if self.settings.tile {
                return (from as isize - margin as isize, side + 2 * margin);
            }
            let low = from.saturating_sub(margin);
            (low as isize, (from + side + margin).min(limit) - low)
        };
        let ((x, columns), (y, rows)) = (cut(x, width), cut(y, height));
        Region { x, y, size: [columns, rows] }
    }

    /// Every pixel of a region: column and row in it, and index on the canvas.
    fn pixels(&self, region: Region) -> impl Iterator<Item = (usize, usize, usize)> + use<> {
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
            .map(|(x, y, i)| Known { x, y, colour: self.colours[i] })
            .collect()
    }

    fn die(&self, x: usize, y: usize) -> u32 {
        mixed(u64::from(mixed(self.settings.seed)) << 32 ^ (y * self.size[0] + x) as u64)
    }

    /// Fills the square of `side` at (x, y): as one patch if one fits, else by quarters.
    fn place(&mut self, x: usize, y: usize, side: usize, overlap: usize) -> Result<()> {
        if x >= self.size[0] || y >= self.size[1] {
            return Ok(());
        }
        if side == 1 {
            self.pixel(x, y)?;
            let i = y * self.size[0] + x;
            self.patches += 1;
            self.owners[i] = Owner { patch: self.patches, side: 1 };
            return Ok(());
        }
        let region = self.region(x, y, side, overlap);
        // A region wider than a texture that wraps around would meet itself.
        let fits = (0..2).all(|axis| region.size[axis] <= self.size[axis]);
        if fits && self.settings.delta_max > 0.0 {
            let known = self.known(region);
            let found = if known.is_empty() {
                self.matcher.any(region.size, self.die(x, y)).map(|place| (place, 0.0))
            } else {
                self.matcher.best(region.size, &known)?
            };
            if let Some((place, error)) = found
                && error <= self.settings.delta_max * known.len() as f32
            {
                return self.paste(region, [x, y], side, place, overlap);
            }
        }
        let half = side.div_ceil(2);
        for (dx, dy) in [(0, 0), (half, 0), (0, half), (half, half)] {
            // The second half of an odd side is one pixel shorter.
            let (width, height) = (if dx == 0 { half } else { side - half }, if dy == 0 { half } else { side - half });
            if width == height {
                self.place(x + dx, y + dy, width, (overlap / 2).max(RADIUS))?;
            } else {
                for v in 0..height {
                    for u in 0..width {
                        self.place(x + dx + u, y + dy + v, 1, RADIUS)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Copies the example at `place` into `region`: its square as it is, feathered into what was there around it. Pixels there
    /// that differ too much are taken out and synthesised anew.
    fn paste(
        &mut self,
        region: Region,
        [x, y]: [usize; 2],
        side: usize,
        place: [usize; 2],
        overlap: usize,
    ) -> Result<()> {
        self.patches += 1;
        let owner = Owner { patch: self.patches, side: side as u32 };
        let corner = [(x as isize - region.x) as usize, (y as isize - region.y) as usize];
        let end = [side.min(self.size[0] - x), side.min(self.size[1] - y)];
        let mut taken_out = Vec::new();
        for (u, v, i) in self.pixels(region) {
            let new = self.matcher.colour(place[0] + u, place[1] + v);
            let outside = |axis: usize, c: usize| {
                let last = corner[axis] + end[axis] - 1;
                corner[axis].saturating_sub(c).max(c.saturating_sub(last))
            };
            let away = outside(0, u).max(outside(1, v));
            if !self.filled[i] {
                if away == 0 {
                    (self.colours[i], self.filled[i], self.owners[i]) = (new, true, owner);
                }
            } else if squared_error(self.colours[i], new) > self.settings.delta_pixel {
                taken_out.push(i);
            } else {
                let share = 1.0 - away as f32 / (overlap + 1) as f32;
                for (old, new) in self.colours[i].iter_mut().zip(new) {
                    *old += (new - *old) * share;
                }
            }
        }
        self.synthesise_anew(&taken_out)
    }

    /// Synthesises pixels one by one, always the one with the most known neighbours; of those the uppermost, leftmost.
    fn synthesise_anew(&mut self, pixels: &[usize]) -> Result<()> {
        for &i in pixels {
            self.filled[i] = false;
            self.anew[i] = true;
        }
        let width = self.size[0];
        let neighbours = |canvas: &Self, i: usize| {
            let around = canvas.region(i % width, i / width, 1, RADIUS);
            canvas.pixels(around).filter(|&(_, _, j)| canvas.filled[j]).count()
        };
        let entry = |canvas: &Self, i: usize| (neighbours(canvas, i), std::cmp::Reverse(i));
        let mut queue: BinaryHeap<(usize, std::cmp::Reverse<usize>)> = pixels.iter().map(|&i| entry(self, i)).collect();
        while let Some((count, std::cmp::Reverse(i))) = queue.pop() {
            if self.filled[i] {
                continue;
            }
            // Counts only grow: an entry that is behind the times goes back with the present one.
            let now = neighbours(self, i);
            if now > count {
                queue.push((now, std::cmp::Reverse(i)));
                continue;
            }
            self.pixel(i % width, i / width)?;
            let around = self.region(i % width, i / width, 1, RADIUS);
            for (_, _, j) in self.pixels(around) {
                if self.anew[j] && !self.filled[j] {
                    queue.push(entry(self, j));
                }
            }
        }
        Ok(())
    }

    /// Fills one pixel from its neighbourhood, smaller where the example or its mask have no room for 7 x 7.
    fn pixel(&mut self, x: usize, y: usize) -> Result<()> {
        for radius in (0..=RADIUS).rev() {
            let region = self.region(x, y, 1, radius);
            if (0..2).any(|axis| region.size[axis] > self.size[axis]) {
                continue;
            }
            let known = self.known(region);
            let found = if known.is_empty() {
                self.matcher.any(region.size, self.die(x, y))
            } else {
                self.matcher.best(region.size, &known)?.map(|(place, _)| place)
            };
            if let Some(place) = found {
                let (u, v) = ((x as isize - region.x) as usize, (y as isize - region.y) as usize);
                let i = y * self.size[0] + x;
                self.colours[i] = self.matcher.colour(place[0] + u, place[1] + v);
                self.filled[i] = true;
                break;
            }
        }
        Ok(())
    }
}
