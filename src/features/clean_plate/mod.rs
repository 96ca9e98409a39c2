//! A picture of the empty scene from pictures in which somebody moves about (METHOD A5.1): each pixel's most frequent colour, then
//! passes that leave out where a picture differs from what was found so far, and all that this encloses.
//!
//! What can be told from pictures alone, and what cannot: somebody who stands somewhere for less than about half of the time leaves
//! nothing behind; a place that is never seen empty is told by its colours that never settle ([`DoubtKind::NeverEmpty`]), one where
//! no colour is there clearly longest by that ([`DoubtKind::Unclear`]). What never changes at all counts as empty: nobody can tell a
//! person who stands like a statue from a statue.

mod absence;
mod colours;
mod fill;

use anyhow::{Result, bail, ensure};
use image::{GrayImage, RgbImage};
use rayon::prelude::*;

use self::absence::Absence;
use self::colours::Colours;
use self::fill::fill_in;
use super::blobs::Components;
use super::light::{gains, lit};
use super::morphology::{Element, Morphology, Shape};
use super::{BitImage, Region};

/// Pictures below which nothing can be said of what is there most of the time.
pub const FEWEST_PICTURES: usize = 12;

/// Passes after the first estimate.
pub const PASSES: usize = 2;

/// The share of the pictures that a pixel has to be seen empty in.
const SEEN: f32 = 0.08;
/// A second colour that is there this often, as a share of the first one's pictures, may be the empty scene as well, …
const RIVAL: f32 = 0.7;
/// … and a first one that is seen in fewer of the pictures than this may be somebody's.
const CLEAR: f32 = 0.3;
/// A picture's light has changed where its gain moved by more than this.
const SAME_LIGHT: f32 = 0.004;
/// Doubtful places smaller than this share of the picture are the noise of edges.
const LEAST_DOUBT: f64 = 2e-4;
/// All doubtful places of one kind together are worth a word from this share of the picture on.
const LEAST_SAID: f64 = 2e-3;

/// A picture of the empty scene that was learnt.
#[derive(Clone, Debug)]
pub struct LearntPlate {
    /// The empty scene.
    pub picture: RgbImage,
    /// The share of the pictures in which a pixel was seen empty, 255 for all of them.
    pub sure: GrayImage,
    /// Pictures it was learnt from.
    pub pictures: usize,
    /// How many of them show something that is not the empty scene.
    pub busy: usize,
    /// Where it is doubtful, and why; at most one of each kind.
    pub doubts: Vec<Doubt>,
}

/// Why a place of a plate is doubtful.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DoubtKind {
    /// Somebody is there in nearly all pictures. What stands there in the plate is filled in from around.
    NeverEmpty,
    /// No colour is there clearly longest: two are for about as long each, or none is for long. The plate holds the most frequent one.
    Unclear,
}

/// A doubtful place of a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doubt {
    /// Why.
    pub kind: DoubtKind,
    /// Its share of the picture.
    pub share: f64,
    /// The smallest box round all of it.
    pub bounds: Region,
}

impl LearntPlate {
    /// How much of the picture is doubtful, %.
    pub fn percent_doubtful(&self) -> f64 {
        100.0 * self.doubts.iter().map(|doubt| doubt.share).sum::<f64>()
    }

    /// Learns the empty scene from pictures of one size, spread over all that there is of it. `advance` hears of every pass,
    /// [`PASSES`] in all.
    ///
    /// # Errors
    /// When there are fewer than [`FEWEST_PICTURES`], or their sizes differ.
    pub fn of(pictures: &[RgbImage], advance: &mut dyn FnMut()) -> Result<Self> {
        ensure!(
            pictures.len() >= FEWEST_PICTURES,
            "{} pictures are too few to learn the empty scene from, expected at least {FEWEST_PICTURES}",
            pictures.len()
        );
        let (width, height) = pictures[0].dimensions();
        if let Some(other) = pictures.iter().find(|other| other.dimensions() != (width, height)) {
            let (found, high) = other.dimensions();
            bail!("pictures of one view are {width}x{height} and {found}x{high} pixels, expected one size");
        }
        let mut lesson = Lesson::new(pictures);
        for _ in 0..PASSES {
            lesson.look_again();
            advance();
        }
        Ok(lesson.told())
    }

    /// What a user should know of the plate of a view, a sentence each.
    pub fn remarks(&self) -> Vec<String> {
        let of = self.pictures;
        let mut remarks = Vec::new();
        if self.busy == 0 {
            remarks.push(format!(
                "nothing moves in {of} pictures: nobody is in them, or somebody who stands still all the time and is then part \
                 of the plate"
            ));
        }
        for Doubt { kind, share, bounds } in &self.doubts {
            let place = format!(
                "{:.1} % of the picture (columns {} to {}, rows {} to {})",
                100.0 * share,
                bounds.x0,
                bounds.x1.saturating_sub(1),
                bounds.y0,
                bounds.y1.saturating_sub(1)
            );
            remarks.push(match kind {
                DoubtKind::NeverEmpty => format!(
                    "{place} is hardly ever seen empty in {of} pictures: somebody is there all the time, and it is filled in from around"
                ),
                DoubtKind::Unclear => format!(
                    "{place} has no look that is there clearly longest in {of} pictures: somebody stands there for half of the time, or a \
                     thing was moved, and the most frequent look was taken"
                ),
            });
        }
        remarks
    }
}

/// A plate in the making.
struct Lesson<'a> {
    pictures: &'a [RgbImage],
    /// What to multiply each picture with to have it in the estimate's light.
    dims: Vec<[f32; 3]>,
    estimate: RgbImage,
    pixels: Vec<Pixel>,
    /// Where each picture shows something else; `None` for one that shows hardly anything of the scene.
    absences: Vec<Option<Absence>>,
}

/// What a pixel was found to be.
#[derive(Clone, Copy, Default)]
struct Pixel {
    colour: [u8; 3],
    seen: u16,
    rival: u16,
}

impl<'a> Lesson<'a> {
    fn new(pictures: &'a [RgbImage]) -> Self {
        let (width, height) = pictures[0].dimensions();
        let absences = pictures.iter().map(|_| Some(Absence::nowhere(width, height))).collect();
        let dims = vec![[1.0; 3]; pictures.len()];
        let pixels = vec![Pixel::default(); width as usize * height as usize];
        let mut lesson = Self { pictures, dims, estimate: RgbImage::new(width, height), pixels, absences };
        lesson.estimate_where(|_, _| true);
        lesson
    }

    /// Looks for what differs from the estimate, and estimates again without it.
    fn look_again(&mut self) {
        let estimate = &self.estimate;
        let found = self.pictures.par_iter().map(|picture| {
            let dim = gains(picture, estimate).map(f32::recip);
            (dim, Absence::of(picture, dim, estimate))
        });
        let (dims, absences): (Vec<[f32; 3]>, Vec<Option<Absence>>) = found.unzip();
        let is_same = |(old, new): (&[f32; 3], &[f32; 3])| old.iter().zip(new).all(|(a, b)| (a - b).abs() < SAME_LIGHT);
        let is_lit_anew = !self.dims.iter().zip(&dims).all(is_same);
        // Where nobody was or is found, nothing else can come out.
        let mut touched = BitImage::new(estimate.width(), estimate.height());
        for absence in self.absences.iter().chain(&absences).flatten() {
            absence.add_to(&mut touched);
        }
        let is_fewer = self.absences.iter().zip(&absences).any(|(old, new)| old.is_some() != new.is_some());
        (self.dims, self.absences) = (dims, absences);
        self.estimate_where(|x, y| is_lit_anew || is_fewer || touched.get(x, y));
    }

    fn picture(&self, pixels: &[Pixel]) -> RgbImage {
        let mut picture = RgbImage::new(self.estimate.width(), self.estimate.height());
        picture.pixels_mut().zip(pixels).for_each(|(pixel, found)| pixel.0 = found.colour);
        picture
    }

    /// Estimates pixels from the colours that are not left out there.
    fn estimate_where(&mut self, is_asked: impl Fn(u32, u32) -> bool + Sync) {
        let width = self.estimate.width();
        let usable: Vec<usize> = (0..self.pictures.len()).filter(|&at| self.absences[at].is_some()).collect();
        let least = (SEEN * usable.len() as f32).ceil() as usize;
        let mut pixels = std::mem::take(&mut self.pixels);
        let rows = pixels.par_chunks_mut((width as usize).max(1)).enumerate();
        rows.for_each_init(
            || Colours::new(usable.len()),
            |colours, (y, row)| {
                for (x, pixel) in row.iter_mut().enumerate().filter(|(x, _)| is_asked(*x as u32, y as u32)) {
                    let first = 3 * (y * width as usize + x);
                    colours.take(usable.iter().map(|&at| {
                        let bytes = self.pictures[at].as_raw();
                        let seen = [bytes[first], bytes[first + 1], bytes[first + 2]];
                        let is_there = self.absences[at].as_ref().is_some_and(|absence| absence.is_at(x, y));
                        (lit(seen, self.dims[at]), !is_there)
                    }));
                    let (colour, seen) = colours.dominant(least);
                    // A colour that most pictures show has no rival.
                    let rival = if 5 * seen < 3 * usable.len() { colours.rival(colour) } else { 0 };
                    *pixel = Pixel { colour, seen: seen as u16, rival: rival as u16 };
                }
            },
        );
        self.estimate = self.picture(&pixels);
        self.pixels = pixels;
    }

    fn told(self) -> LearntPlate {
        let (width, height) = self.estimate.dimensions();
        let mut picture = self.estimate.clone();
        let pixels = &self.pixels;
        let usable = self.absences.iter().flatten().count().max(1);
        let at = |x: u32, y: u32| pixels[y as usize * width as usize + x as usize];
        let least = SEEN * usable as f32;
        let never = cleaned(BitImage::from_fn(width, height, |x, y| f32::from(at(x, y).seen) < least));
        let mut unclear = cleaned(BitImage::from_fn(width, height, |x, y| {
            let Pixel { seen, rival, .. } = at(x, y);
            f32::from(rival) >= RIVAL * f32::from(seen) || f32::from(seen) < CLEAR * usable as f32
        }));
        unclear.and_not(&never);
        let mut sure = GrayImage::new(width, height);
        for (sure, pixel) in sure.pixels_mut().zip(pixels) {
            sure.0 = [(usize::from(pixel.seen) * 255 / usable) as u8];
        }
        let doubt = |kind: DoubtKind, where_: &BitImage| {
            let share = f64::from(where_.count()) / (f64::from(width) * f64::from(height));
            where_.bounds().filter(|_| share >= LEAST_SAID).map(|bounds| Doubt { kind, share, bounds })
        };
        let doubts = [doubt(DoubtKind::NeverEmpty, &never), doubt(DoubtKind::Unclear, &unclear)];
        fill_in(&mut picture, &never);
        let busy = self.absences.iter().filter(|absence| absence.as_ref().is_none_or(Absence::is_somewhere)).count();
        LearntPlate {
            picture,
            sure,
            pictures: self.pictures.len(),
            busy,
            doubts: doubts.into_iter().flatten().collect(),
        }
    }
}

/// Without specks.
fn cleaned(mut doubtful: BitImage) -> BitImage {
    let pixels = f64::from(doubtful.width()) * f64::from(doubtful.height());
    Morphology::default().open(&mut doubtful, Element { shape: Shape::Disc, radius: 1 });
    Components::default().keep_largest(&mut doubtful, usize::MAX, (LEAST_DOUBT * pixels).ceil() as u32, 0.0);
    doubtful
}

#[cfg(test)]
mod tests;
