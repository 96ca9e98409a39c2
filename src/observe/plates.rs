//! Plates learnt from footage in which somebody moves, for views that have neither a plate nor masks.

use std::borrow::Cow;
use std::sync::Arc;

use anyhow::{Context, Result};

use crate::features::LearntPlate;
use crate::features::clean_plate::{FEWEST_PICTURES, PASSES};
use crate::files::listed;
use crate::sequence::{DOUBTFUL, Footage, Sequence, View};

/// Hears of long work: what is being done, how many steps of it are done, and of how many.
pub type Advance<'a> = dyn FnMut(&'static str, usize, usize) + 'a;

/// What the learning of plates is called.
const WORK: &str = "learning the background";

/// What a plate is learnt from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlateLesson {
    /// Pictures at most, evenly spread over the footage.
    pub pictures: usize,
    /// Bytes that they may take at most: of large pictures there are fewer, but never less than [`FEWEST_PICTURES`].
    pub bytes: usize,
    /// Width and height to learn it at, pixels; those of the footage without.
    pub size: Option<[u32; 2]>,
}

impl Default for PlateLesson {
    fn default() -> Self {
        Self { pictures: 120, bytes: 768 << 20, size: None }
    }
}

impl PlateLesson {
    /// How many pictures of a size are looked at where there are `total`.
    fn count(&self, total: usize, [width, height]: [u32; 2]) -> usize {
        let fit = self.bytes / (width as usize * height as usize * 3).max(1);
        self.pictures.min(fit).max(FEWEST_PICTURES).min(total)
    }
}

/// Learns the empty scene that footage shows, from pictures all over it. `progress` hears how many steps of how many are done.
///
/// # Errors
/// When it is live, too short, or cannot be read.
pub fn learn_plate(
    footage: &Footage,
    lesson: &PlateLesson,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<LearntPlate> {
    let size = lesson.size.unwrap_or(footage.size);
    let count = lesson.count(footage.frame_count, size);
    // A pass over the pictures takes about as long as reading a tenth of them.
    let step = count.div_ceil(10);
    let (mut done, total) = (0, count + PASSES * step);
    let mut pictures = Vec::with_capacity(count);
    for picture in footage.spread(count, size)? {
        pictures.push(picture?);
        done += 1;
        progress(done, total);
    }
    let mut advance = || {
        done += step;
        progress(done, total);
    };
    LearntPlate::of(&pictures, &mut advance).with_context(|| footage.shown.clone())
}

/// A plate learnt for a view.
#[derive(Clone, Debug)]
pub struct ViewPlate {
    /// The camera's name.
    pub camera: String,
    /// What was learnt.
    pub plate: LearntPlate,
}

/// A sequence in which every view that can have a plate has one.
#[derive(Clone, Debug)]
pub struct Plated<'a> {
    /// The sequence; its own where nothing had to be learnt.
    pub sequence: Cow<'a, Sequence>,
    /// The plates that were learnt.
    pub learnt: Vec<ViewPlate>,
}

impl<'a> Plated<'a> {
    /// A sequence for which nothing is learnt.
    pub fn as_it_is(sequence: &'a Sequence) -> Self {
        Self { sequence: Cow::Borrowed(sequence), learnt: Vec::new() }
    }

    /// What a user should know of the plates that were learnt, a sentence each.
    pub fn remarks(&self) -> Vec<String> {
        let of_view = |ViewPlate { camera, plate }: &ViewPlate| {
            let remarks = plate.remarks().into_iter();
            remarks
                .map(|remark| format!("the background of camera {camera:?} was learnt: {remark}"))
                .collect::<Vec<_>>()
        };
        self.learnt.iter().flat_map(of_view).collect()
    }

    /// A sentence for whoever reads how far a track is expected to be off, where a plate may hold the person: errors are expected from what the
    /// silhouettes show, and a limb that is part of the plate is not among it.
    pub fn doubt(&self) -> Option<String> {
        let stated = self.sequence.views.iter().filter(|view| view.background.is_some());
        let stated = stated.map(|view| (view.camera.as_str(), view.background_doubtful));
        let learnt = self.learnt.iter().map(|view| (view.camera.as_str(), view.plate.percent_doubtful()));
        let doubtful = stated.chain(learnt).filter(|(_, doubtful)| *doubtful > DOUBTFUL);
        let cameras: Vec<&str> = doubtful.map(|(camera, _)| camera).collect();
        (!cameras.is_empty()).then(|| {
            format!(
                "the plates of {} may hold the person, and the expected errors (sigma, wrong) are too small where they do: limbs that are part of a \
                 plate are missing in what they are judged by",
                listed(&cameras)
            )
        })
    }
}

/// Whether a view's plate is to be learnt before its frames are looked at: it has neither plate nor masks, it has an end, and the
/// manifest does not ask for a mixture that learns as the frames go by (`[features.mixture]`), which all that is too short for a plate
/// is left to.
fn wants_plate(sequence: &Sequence, view: &View) -> bool {
    let learns_on = sequence.features.as_ref().is_some_and(|table| table.contains_key("mixture"));
    view.learns_background() && !sequence.is_live() && !learns_on && sequence.frame_count >= FEWEST_PICTURES
}

/// The sequence with plates, at the working size, for the views of recordings that have neither plate nor masks, learnt from all of
/// their frames.
///
/// # Errors
/// When a recording cannot be read.
pub fn with_plates<'a>(sequence: &'a Sequence, progress: &mut Advance<'_>) -> Result<Plated<'a>> {
    let wanting: Vec<usize> =
        (0..sequence.views.len()).filter(|&at| wants_plate(sequence, &sequence.views[at])).collect();
    let mut plated = Plated::as_it_is(sequence);
    for (turn, &at) in wanting.iter().enumerate() {
        let view = &sequence.views[at];
        let lesson = PlateLesson { size: Some(sequence.sizes[at]), ..PlateLesson::default() };
        let mut one = |done: usize, total: usize| progress(WORK, turn * total + done, wanting.len() * total);
        let plate = learn_plate(&view.footage(), &lesson, &mut one)
            .with_context(|| format!("{}: the background of camera {:?}", sequence.path.display(), view.camera))?;
        plated.sequence.to_mut().views[at].learnt = Some(Arc::new(plate.picture.clone()));
        plated.learnt.push(ViewPlate { camera: view.camera.clone(), plate });
    }
    Ok(plated)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_are_fewer_and_short_footage_is_taken_whole() {
        let lesson = PlateLesson::default();
        assert_eq!(lesson.count(100, [480, 270]), 100);
        assert_eq!(lesson.count(5000, [1920, 1080]), 120);
        assert_eq!(lesson.count(5000, [3840, 2160]), 32);
        assert_eq!(PlateLesson { bytes: 1, ..lesson }.count(5000, [8, 8]), FEWEST_PICTURES);
    }
}
