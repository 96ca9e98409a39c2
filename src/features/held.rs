//! A frame's observations that stay on the device which made them, and what the host knows of them.

use std::sync::Arc;
use std::sync::mpsc::Sender;

use anyhow::{Context, Result};

use super::{BitImage, ColourTables, Evidence, Observation, Region};
use crate::gpu::{Buffer, DevicePass};

/// One camera's packed observation in the two forms that evaluators on a device compare with.
#[derive(Clone, Debug)]
pub struct HeldView {
    /// The packed bytes, four pixels a word, rows padded to whole words.
    pub pixels: Buffer,
    /// Bit planes, eight words for 32 pixels of a row: planes 0..=6 the proximity bits, plane 7 the silhouette.
    pub planes: Buffer,
    /// What evidence is made of, where that is wanted.
    pub likelihood: Option<HeldLikelihood>,
}

/// How likely the pixels of one camera are as background, and what comes back of it.
#[derive(Clone, Debug)]
pub struct HeldLikelihood {
    /// A word a pixel: the log density of its colour as background in the lower half, in steps of 1 /
    /// [`super::likelihood::LOG_STEPS`], and in the upper one which colour it is.
    pub seen: Buffer,
    /// The bounding box of what does not look like background: width less the first column, height less the first row, one past the
    /// last column and row; 0 where nothing does.
    pub sides: Buffer,
    /// By how much that is enlarged, pixels.
    pub motion: u32,
    /// The pixels that surely are background whatever the person's colours, a bit picture, once evidence was made; and the host's copy.
    pub empty: Buffer,
    /// The host's copy of it.
    pub empty_out: Buffer,
}

/// What differs between the views of a frame whose evidence is made on the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HeldLook {
    /// Whether a ready mask tells what is foreground.
    pub is_masked: bool,
    /// Whether the camera sees in grey.
    pub is_grey: bool,
}

/// What a device saw in a frame. Its memory is one of two that take turns, and serves another frame when this is dropped.
#[derive(Debug)]
pub struct HeldFrame {
    pub(super) views: Vec<HeldView>,
    pub(super) silhouettes: Vec<BitImage>,
    pub(super) ignored: Vec<Option<Arc<BitImage>>>,
    pub(super) looks: Vec<HeldLook>,
    pub(super) colours: Option<Arc<ColourTables>>,
    pub(super) passes: Vec<DevicePass>,
    pub(super) lease: Lease,
}

impl HeldFrame {
    /// The observations, one a view, in the order of the cameras.
    pub fn views(&self) -> &[HeldView] {
        &self.views
    }

    /// The silhouettes, which the host has too, one a view: a bit of the eight of a pixel.
    pub fn silhouettes(&self) -> &[BitImage] {
        &self.silhouettes
    }

    /// The views' looks, where likelihoods were made.
    pub fn looks(&self) -> &[HeldLook] {
        &self.looks
    }

    /// The pixels that count neither for nor against a candidate, one a view.
    pub fn ignored(&self) -> &[Option<Arc<BitImage>>] {
        &self.ignored
    }

    /// What is known of the person's colours, by which evidence is made of likelihoods; none where none is made.
    pub fn colours(&self) -> Option<&ColourTables> {
        self.colours.as_deref()
    }

    /// Has evidence made of its likelihoods by these colours when it is handed over.
    pub fn set_colours(&mut self, colours: Arc<ColourTables>) {
        self.colours = Some(colours);
    }

    /// The pixels of each view that surely are background whatever the person's colours, once its evidence was made.
    ///
    /// # Errors
    /// When it holds no likelihoods, or the device fails.
    pub fn looks_empty(&self) -> Result<Vec<BitImage>> {
        let of_view = |(view, silhouette): (&HeldView, &BitImage)| {
            let likelihood = view.likelihood.as_ref().context("a device held observations without likelihoods")?;
            let mut empty = BitImage::new(silhouette.width(), silhouette.height());
            likelihood.empty_out.read(0, empty.words_mut())?;
            Ok(empty)
        };
        self.views.iter().zip(&self.silhouettes).map(of_view).collect()
    }

    /// The passes that made it, where they were timed.
    pub fn passes(&self) -> &[DevicePass] {
        &self.passes
    }

    /// Which of the two memories it has.
    pub fn place(&self) -> usize {
        self.lease.place
    }
}

/// The right to one of two memories: given back when dropped.
#[derive(Debug)]
pub(super) struct Lease {
    pub(super) place: usize,
    pub(super) given_back: Sender<usize>,
}

impl Drop for Lease {
    fn drop(&mut self) {
        // Without a chain there is nothing to give it back to.
        let _ = self.given_back.send(self.place);
    }
}

/// What the host knows of a view: everything, or the silhouette of what a device holds.
#[derive(Clone, Copy, Debug)]
pub enum SeenView<'a> {
    /// The observation itself.
    Whole(&'a Observation),
    /// The silhouette of one that a device holds, and the pixels that do not count.
    Silhouette(&'a BitImage, Option<&'a BitImage>),
}

impl<'a> SeenView<'a> {
    /// Of observations, one a view.
    pub fn all(observations: &'a [Observation]) -> Vec<Self> {
        observations.iter().map(Self::Whole).collect()
    }

    /// Width and height, pixels.
    pub fn size(self) -> [u32; 2] {
        match self {
            Self::Whole(observation) => [observation.width, observation.height],
            Self::Silhouette(silhouette, _) => [silhouette.width(), silhouette.height()],
        }
    }

    /// Whether a pixel, by its place in the picture's rows, is in the silhouette.
    pub fn is_person(self, at: usize) -> bool {
        match self {
            Self::Whole(observation) => observation.bytes[at] & Observation::SILHOUETTE != 0,
            Self::Silhouette(silhouette, _) => is_set(silhouette, at),
        }
    }

    /// Whether a pixel counts neither for nor against a candidate.
    pub fn ignores(self, at: usize) -> bool {
        match self {
            Self::Whole(observation) => observation.ignores(at),
            Self::Silhouette(_, ignored) => ignored.is_some_and(|ignored| is_set(ignored, at)),
        }
    }

    /// Whether there may be pixels that count neither for nor against a candidate.
    pub fn is_partly_ignored(self) -> bool {
        match self {
            Self::Whole(observation) => observation.ignored.is_some(),
            Self::Silhouette(_, ignored) => ignored.is_some(),
        }
    }

    /// How likely each pixel is of each class of parts, where the host knows that.
    pub fn evidence(self) -> Option<&'a Evidence> {
        match self {
            Self::Whole(observation) => observation.evidence.as_ref(),
            Self::Silhouette(..) => None,
        }
    }

    /// The silhouette's pixels.
    pub fn silhouette(self) -> BitImage {
        match self {
            Self::Whole(observation) => observation.silhouette(),
            Self::Silhouette(silhouette, _) => silhouette.clone(),
        }
    }

    /// The smallest region that holds the silhouette; none where there is none.
    pub fn bounds(self) -> Option<Region> {
        match self {
            Self::Whole(observation) => observation.silhouette().bounds(),
            Self::Silhouette(silhouette, _) => silhouette.bounds(),
        }
    }

    /// The number of silhouette pixels.
    pub fn area(self) -> u32 {
        match self {
            Self::Whole(observation) => observation.area(),
            Self::Silhouette(silhouette, _) => silhouette.count(),
        }
    }
}

/// Whether a pixel is set, by its place in the picture's rows.
fn is_set(image: &BitImage, at: usize) -> bool {
    let width = image.width() as usize;
    image.get((at % width) as u32, (at / width) as u32)
}

/// What was seen in a frame, wherever it is.
#[derive(Clone, Copy, Debug)]
pub enum SeenFrame<'a> {
    /// Observations of the host.
    Whole(&'a [Observation]),
    /// What a device made and holds.
    Held(&'a HeldFrame),
}

impl<'a> SeenFrame<'a> {
    /// What the host knows of the views.
    pub fn views(self) -> Vec<SeenView<'a>> {
        match self {
            Self::Whole(observations) => SeenView::all(observations),
            Self::Held(frame) => {
                let views = frame.silhouettes.iter().zip(&frame.ignored);
                views.map(|(silhouette, ignored)| SeenView::Silhouette(silhouette, ignored.as_deref())).collect()
            }
        }
    }
}
