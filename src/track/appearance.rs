//! The person's colours over a run: what a frame's likelihoods become before it is searched, and what its pose teaches afterwards.

use std::sync::Arc;

use anyhow::Result;

use super::feed::Prepared;
use crate::body::Body;
use crate::evaluate::Reference;
use crate::features::{ColourTables, Likelihood, Observation, SeenView};
use crate::geometry::Camera;
use crate::observe::{Appearance, Lesson, SeenColours};

/// Frames at the beginning that all teach, and how many there are to one that teaches afterwards.
const EAGER: usize = 3;
const SELDOM: usize = 5;
/// How much of what was learnt is kept when a frame teaches.
const KEPT: f32 = 0.95;

/// The appearance of a run's person, and how her pose is drawn to learn it.
pub(super) struct RunAppearance {
    appearance: Appearance,
    /// What is known by now, for a device that makes the evidence.
    tables: Arc<ColourTables>,
    reference: Reference,
}

impl RunAppearance {
    pub(super) fn new(body: &Body, cameras: &[Camera]) -> Self {
        let appearance = Appearance::new(body);
        Self { tables: Arc::new(appearance.tables()), appearance, reference: Reference::new(body, cameras) }
    }

    /// Gives a frame's observations the evidence that its likelihoods are by what is known now; where a device holds them, it makes that when
    /// they are first compared with.
    ///
    /// # Errors
    /// When likelihoods do not fit their pictures.
    pub(super) fn observe(&self, prepared: &mut Prepared) -> Result<()> {
        if let Some(held) = &mut prepared.held {
            held.set_colours(Arc::clone(&self.tables));
            return Ok(());
        }
        self.appearance.give(&prepared.likelihoods, &mut prepared.observations)
    }

    /// What is known of the person's colours by now.
    #[cfg(test)]
    pub(super) fn tables(&self) -> &ColourTables {
        &self.tables
    }

    /// Whether a frame teaches, `since` frames after the first.
    pub(super) fn is_lesson(since: usize) -> bool {
        since < EAGER || since.is_multiple_of(SELDOM)
    }

    /// Learns from a pose, `since` frames after the first. Whether a frame teaches depends on its number and its pose alone, so that a run
    /// that is resumed learns the same. Of what a device holds the evidence has been made.
    ///
    /// # Errors
    /// As [`Appearance::learn`]; when the device fails.
    pub(super) fn learn(&mut self, since: usize, prepared: &Prepared, pose: &[f32]) -> Result<()> {
        if !Self::is_lesson(since) {
            return Ok(());
        }
        if let Some(held) = &prepared.held {
            let empty = held.looks_empty()?;
            let colours: Vec<_> = prepared
                .pictures
                .iter()
                .zip(&empty)
                .map(|(picture, empty)| SeenColours::Pictured(picture, empty))
                .collect();
            show(&mut self.appearance, &self.reference, pose, (&prepared.seen().views(), &colours), KEPT)?;
        } else {
            let seen = (&*prepared.likelihoods, &*prepared.observations);
            teach(&mut self.appearance, &self.reference, pose, seen, KEPT)?;
        }
        self.tables = Arc::new(self.appearance.tables());
        Ok(())
    }
}

/// Teaches an appearance the colours that a person has where `reference` draws this pose, in the likelihoods and observations of a frame's
/// views; what was learnt before counts `kept` times.
///
/// # Errors
/// As [`Appearance::learn`].
pub(super) fn teach(
    appearance: &mut Appearance,
    reference: &Reference,
    pose: &[f32],
    (likelihoods, observations): (&[Likelihood], &[Observation]),
    kept: f32,
) -> Result<()> {
    let colours: Vec<_> = likelihoods.iter().map(SeenColours::Likely).collect();
    show(appearance, reference, pose, (&SeenView::all(observations), &colours), kept)
}

/// The same of what is known of a frame's views.
fn show(
    appearance: &mut Appearance,
    reference: &Reference,
    pose: &[f32],
    (seen, colours): (&[SeenView<'_>], &[SeenColours<'_>]),
    kept: f32,
) -> Result<()> {
    let drawn: Vec<Vec<u8>> = (0..colours.len()).map(|view| reference.draw(pose, view).bytes).collect();
    let views = drawn.iter().zip(seen).zip(colours);
    let lessons: Vec<Lesson<'_>> = views.map(|((drawn, &seen), &colours)| Lesson { drawn, seen, colours }).collect();
    appearance.learn(&lessons, kept)
}
