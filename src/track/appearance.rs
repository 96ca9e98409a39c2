//! The person's colours over a run: what a frame's likelihoods become before it is searched, and what its pose teaches afterwards.

use anyhow::Result;

use super::feed::Prepared;
use crate::body::Body;
use crate::evaluate::Reference;
use crate::features::{Likelihood, Observation};
use crate::geometry::Camera;
use crate::observe::{Appearance, Lesson};

/// Frames at the beginning that all teach, and how many there are to one that teaches afterwards.
const EAGER: usize = 3;
const SELDOM: usize = 5;
/// How much of what was learnt is kept when a frame teaches.
const KEPT: f32 = 0.95;

/// The appearance of a run's person, and how her pose is drawn to learn it.
pub(super) struct RunAppearance {
    appearance: Appearance,
    reference: Reference,
}

impl RunAppearance {
    pub(super) fn new(body: &Body, cameras: &[Camera]) -> Self {
        Self { appearance: Appearance::new(body), reference: Reference::new(body, cameras) }
    }

    /// Gives a frame's observations the evidence that its likelihoods are by what is known now.
    ///
    /// # Errors
    /// When likelihoods do not fit their pictures.
    pub(super) fn observe(&self, prepared: &mut Prepared) -> Result<()> {
        self.appearance.give(&prepared.likelihoods, &mut prepared.observations)
    }

    /// Learns from a pose, `since` frames after the first. Whether a frame teaches depends on its number and its pose alone, so that a run
    /// that is resumed learns the same.
    ///
    /// # Errors
    /// As [`Appearance::learn`].
    pub(super) fn learn(&mut self, since: usize, prepared: &Prepared, pose: &[f32]) -> Result<()> {
        if since >= EAGER && !since.is_multiple_of(SELDOM) {
            return Ok(());
        }
        teach(&mut self.appearance, &self.reference, pose, (&prepared.likelihoods, &prepared.observations), KEPT)
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
    let drawn: Vec<Vec<u8>> = (0..likelihoods.len()).map(|view| reference.draw(pose, view).bytes).collect();
    let views = likelihoods.iter().zip(&drawn).zip(observations);
    let lessons: Vec<Lesson<'_>> =
        views.map(|((likelihood, drawn), observation)| Lesson { likelihood, drawn, observation }).collect();
    appearance.learn(&lessons, kept)
}
