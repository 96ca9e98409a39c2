//! What was seen in the frames that a person is measured in.

use std::sync::Arc;

use anyhow::{Result, bail};
use glam::DVec2;

use super::super::appearance::teach;
use super::super::figures::{Figure, figures, nearest, others};
use crate::body::Body;
use crate::evaluate::Reference;
use crate::features::{BitImage, Ignoring, Likelihood, Observation, SeenView};
use crate::geometry::Camera;
use crate::observe::{Appearance, Observer, silhouette_settings, take_likelihoods, take_observations};
use crate::sequence::Sequence;

/// For each view of a frame the pixels that count neither for nor against who is measured; none where all count. By the number of the frame
/// among those that are looked at.
pub(in crate::track) type LeaveOut<'a> = dyn FnMut(usize, &[SeenView<'_>]) -> Result<Vec<Option<Arc<BitImage>>>> + 'a;

/// Leaves out what shows others than who is meant, where several people are seen: of whom `choose` says which that is, if any.
pub(super) fn all_but<'a>(
    cameras: &'a [Camera],
    mut choose: impl FnMut(usize, &[Figure]) -> Result<Option<usize>> + 'a,
) -> impl FnMut(usize, &[SeenView<'_>]) -> Result<Vec<Option<Arc<BitImage>>>> + 'a {
    move |at, views| {
        let figures = figures(cameras, views);
        let own = choose(at, &figures)?.filter(|_| figures.len() > 1);
        Ok(own.map_or_else(Vec::new, |own| others(cameras, views, &figures, own)))
    }
}

/// The one of the people who stands nearest to where he is known to be in each frame.
pub(super) fn known_at(places: &[DVec2]) -> impl FnMut(usize, &[Figure]) -> Result<Option<usize>> {
    |frame, figures| Ok(places.get(frame).and_then(|place| nearest(figures, *place)))
}

/// Observations and, where evidence is weighed, likelihoods: `[frame][view]`.
pub(super) struct Seen {
    pub(super) observations: Vec<Vec<Observation>>,
    likelihoods: Vec<Vec<Likelihood>>,
}

impl Seen {
    /// Looks at frames, which rise, for one person.
    ///
    /// # Errors
    /// When a view has neither background nor masks, pictures cannot be read, or `leave_out` fails.
    pub(super) fn look(
        sequence: &Sequence,
        frames: &[usize],
        weighs_evidence: bool,
        leave_out: &mut LeaveOut<'_>,
    ) -> Result<Self> {
        if let Some(unknown) = sequence.unknown_background() {
            bail!("{unknown}, expected one of them to measure a person with");
        }
        let mut seen = Self { observations: Vec::new(), likelihoods: Vec::new() };
        let (Some(&first), Some(last)) = (frames.first(), frames.last()) else { return Ok(seen) };
        let mut settings = silhouette_settings(sequence)?;
        settings.likelihoods = weighs_evidence;
        let ignoring = Ignoring::new(&settings);
        let mut observer = Observer::new(sequence, settings, first..last + 1, first)?;
        while let Some(frame) = observer.read()? {
            if let Some(features) = observer.features(&frame, frames.contains(&frame.index))? {
                let views: Vec<SeenView<'_>> =
                    features.iter().map(|features| SeenView::Whole(&features.observation)).collect();
                let ignored = leave_out(seen.observations.len(), &views)?;
                if !ignored.is_empty() {
                    ignoring.apply(features, &ignored)?;
                }
                seen.observations.push(take_observations(features));
                seen.likelihoods.push(take_likelihoods(features));
            }
        }
        Ok(seen)
    }

    /// Observations of frames, to be compared by silhouettes.
    #[cfg(test)]
    pub(super) fn of(observations: Vec<Vec<Observation>>) -> Self {
        let likelihoods = observations.iter().map(|_| Vec::new()).collect();
        Self { observations, likelihoods }
    }

    /// Every second frame, the first among them, and the others.
    pub(super) fn halves(self) -> [Self; 2] {
        let [mut even, mut odd] = [(); 2].map(|()| Self { observations: Vec::new(), likelihoods: Vec::new() });
        for (at, (seen, likelihoods)) in self.observations.into_iter().zip(self.likelihoods).enumerate() {
            let half = if at % 2 == 0 { &mut even } else { &mut odd };
            half.observations.push(seen);
            half.likelihoods.push(likelihoods);
        }
        [even, odd]
    }

    /// Gives every frame its evidence, by the colours that a person with this body has in these poses, one a frame; by none without poses.
    ///
    /// # Errors
    /// When likelihoods do not fit their pictures.
    pub(super) fn weigh(&mut self, body: &Body, cameras: &[Camera], poses: &[Vec<f32>]) -> Result<()> {
        let mut appearance = Appearance::new(body);
        let reference = Reference::new(body, cameras);
        for ((pose, likelihoods), observations) in poses.iter().zip(&self.likelihoods).zip(&self.observations) {
            teach(&mut appearance, &reference, pose, (likelihoods, observations), 1.0)?;
        }
        let mut frames = self.likelihoods.iter().zip(&mut self.observations);
        frames.try_for_each(|(likelihoods, observations)| appearance.give(likelihoods, observations))
    }
}
