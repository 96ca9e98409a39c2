//! Where a picture does not show the empty scene.

use image::RgbImage;

use super::super::BitImage;
use super::super::blobs::Components;
use super::super::light::lit;
use super::super::morphology::{Element, Morphology, Shape};

/// A pixel this far from the estimate, grey levels in RGB, shows something else: shadows are left out as well.
const DIFFERENT: i32 = 24;
/// Gaps up to this part of the picture's shorter side are closed: clothes may have the wall's colour.
const GAP: u32 = 24;
/// Room round what differs, pixels: the soft border of whoever moves.
const ROOM: u32 = 2;
/// Blobs smaller than this share of the picture are noise, …
const LEAST: f64 = 2e-4;
/// … and so are those smaller than this share of the largest.
const LEAST_OF_LARGEST: f32 = 0.02;
/// Where more than this share of a picture differs, it says nothing: a camera that is moved, a lamp that goes on.
const MOST: f64 = 0.7;

/// The pixels of a picture that do not show the empty scene.
pub(super) struct Absence(BitImage);

impl Absence {
    /// A picture that is taken to be empty.
    pub(super) fn nowhere(width: u32, height: u32) -> Self {
        Self(BitImage::new(width, height))
    }

    /// What differs from the `estimate` in a picture whose channels are multiplied with `dim`, with what lies between; `None` where
    /// that is nearly all of it.
    pub(super) fn of(picture: &RgbImage, dim: [f32; 3], estimate: &RgbImage) -> Option<Self> {
        let (width, height) = picture.dimensions();
        let pixels = f64::from(width) * f64::from(height);
        let (seen, known) = (picture.as_raw().as_chunks::<3>().0, estimate.as_raw().as_chunks::<3>().0);
        let mut found = BitImage::from_fn(width, height, |x, y| {
            let at = y as usize * width as usize + x as usize;
            let (seen, known) = (lit(seen[at], dim), known[at]);
            let off = [0, 1, 2].map(|channel: usize| i32::from(seen[channel]) - i32::from(known[channel]));
            off.iter().map(|off| off * off).sum::<i32>() >= DIFFERENT * DIFFERENT
        });
        let (mut morphology, mut components) = (Morphology::default(), Components::default());
        let disc = |radius: u32| Element { shape: Shape::Disc, radius };
        morphology.open(&mut found, disc(1));
        components.keep_largest(&mut found, usize::MAX, (LEAST * pixels).ceil() as u32, LEAST_OF_LARGEST);
        morphology.close(&mut found, disc(width.min(height) / GAP));
        components.fill_holes(&mut found, (pixels / 50.0) as u32);
        morphology.dilate(&mut found, disc(ROOM));
        (f64::from(found.count()) <= MOST * pixels).then_some(Self(found))
    }

    /// Marks them in a picture.
    pub(super) fn add_to(&self, marked: &mut BitImage) {
        marked.or(&self.0);
    }

    /// Whether a pixel is one of them.
    pub(super) fn is_at(&self, x: usize, y: usize) -> bool {
        self.0.get(x as u32, y as u32)
    }

    /// Whether there is any.
    pub(super) fn is_somewhere(&self) -> bool {
        self.0.count() > 0
    }
}
