//! What was seen in the frames that a person is measured in.

use anyhow::{Result, bail};

use super::super::appearance::teach;
use crate::body::Body;
use crate::evaluate::Reference;
use crate::features::{Likelihood, Observation};
use crate::geometry::Camera;
use crate::observe::{Appearance, Observer, silhouette_settings, take_likelihoods, take_observations};
use crate::sequence::Sequence;

/// Observations and, where evidence is weighed, likelihoods: `[frame][view]`.
pub(super) struct Seen {
    pub(super) observations: Vec<Vec<Observation>>,
    likelihoods: Vec<Vec<Likelihood>>,
}

impl Seen {
    /// Looks at frames, which rise.
    ///
    /// # Errors
    /// When a view has neither background nor masks, or pictures cannot be read.
    pub(super) fn look(sequence: &Sequence, frames: &[usize], weighs_evidence: bool) -> Result<Self> {
        if let Some(unknown) = sequence.unknown_background() {
            bail!("{unknown}, expected one of them to measure a person with");
        }
        let mut seen = Self { observations: Vec::new(), likelihoods: Vec::new() };
        let (Some(&first), Some(last)) = (frames.first(), frames.last()) else { return Ok(seen) };
        let mut settings = silhouette_settings(sequence)?;
        settings.likelihoods = weighs_evidence;
        let mut observer = Observer::new(sequence, settings, first..last + 1, first)?;
        while let Some(frame) = observer.read()? {
            if let Some(features) = observer.features(&frame, frames.contains(&frame.index))? {
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
