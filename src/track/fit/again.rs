//! Measuring a tracked person again, in the poses of the track: one posture leaves open where straight limbs have their joints, and how far
//! the flesh lies off the bones; bent and turned limbs tell (METHOD A3).

use anyhow::Result;
use glam::DVec2;

use super::FitSettings;
use super::fitter::Fitter;
use super::following::Following;
use super::scorer::stature;
use super::seen::{LeaveOut, Seen, all_but, known_at};
use crate::body::Body;
use crate::evaluate::Objective;
use crate::observe::Advance;
use crate::search::{SearchKind, SearchSettings, SearchSpace};
use crate::sequence::Sequence;
use crate::track::summary::mean;

/// By how much the frames that were not measured in must fit better on average, for the new body to be believed: in fitness, and in standard
/// errors of that mean. Cones gain as much by taking after people whose joints they had right, which costs up to two millimetres; from here on the
/// joints of skinned people came 3 to 11 mm nearer (METHOD A3).
const GAIN: f64 = 0.004;
const STANDARD_ERRORS: f64 = 2.0;

/// What is known of a person who was tracked.
pub(in crate::track) struct TrackedPoses<'a> {
    pub(in crate::track) sequence: &'a Sequence,
    pub(in crate::track) body: &'a Body,
    /// What a good pose is.
    pub(in crate::track) objective: Objective,
    /// Frames, rising: every second one is measured in, the others judge.
    pub(in crate::track) frames: Vec<usize>,
    /// The pose of each.
    pub(in crate::track) poses: Vec<Vec<f32>>,
    pub(in crate::track) seed: u64,
    /// What shows others, where that is known; else it is seen by who stands where.
    pub(in crate::track) others: Option<&'a mut LeaveOut<'a>>,
}

/// A body that was measured again.
pub(in crate::track) struct Remeasured {
    pub(in crate::track) body: Body,
    /// By how much the frames that judge fit better with it, and its standard error.
    pub(in crate::track) gain: [f64; 2],
}

impl Remeasured {
    /// Whether the frames that judge believe it.
    pub(in crate::track) fn is_believed(&self) -> bool {
        let [gain, error] = self.gain;
        gain > GAIN && gain > STANDARD_ERRORS * error
    }
}

/// Measures the person again; none where the body lacks the joints of the default one.
///
/// # Errors
/// As [`super::fit`].
pub(in crate::track) fn measure_again(
    tracked: TrackedPoses<'_>,
    progress: &mut Advance<'_>,
) -> Result<Option<Remeasured>> {
    let TrackedPoses { sequence, body, objective, frames, poses, seed, others } = tracked;
    if stature(body).is_err() {
        return Ok(None);
    }
    let usual = FitSettings::default();
    let search = SearchSettings {
        kind: SearchKind::Pso,
        particles: usual.particles,
        iterations: usual.iterations,
        seed,
        ..SearchSettings::default()
    };
    let weighs_evidence = objective.weighs_evidence();
    let place = |pose: &Vec<f32>| {
        let pose: Vec<f64> = pose.iter().map(|value| f64::from(*value)).collect();
        Ok(body.world_from_bones(&pose)?[0].translation.truncate())
    };
    let places = poses.iter().map(place).collect::<Result<Vec<DVec2>>>()?;
    let seen = match others {
        Some(others) => Seen::look(sequence, &frames, weighs_evidence, others)?,
        None => {
            let apart = &mut all_but(&sequence.cameras, known_at(&places));
            Seen::look(sequence, &frames, weighs_evidence, apart)?
        }
    };
    let [measured_in, judging] = seen.halves();
    let half = |first: usize| -> Vec<Vec<f32>> { poses.iter().skip(first).step_by(2).cloned().collect() };
    let (mut own, judges) = (half(0), half(1));

    let mut fitter = Fitter::new(body, &sequence.cameras, measured_in, search, objective, progress)?;
    fitter.expect(own.len(), true, false, false, true);
    if weighs_evidence {
        fitter.relook(body, &own)?;
    }
    let remeasured = fitter.reshape(body, &mut own)?.rounded();

    let mut judge = Fitter::new(body, &sequence.cameras, judging, search, objective, progress)?;
    if weighs_evidence {
        judge.relook(body, &judges)?;
    }
    let before = judge.settled_fitness(&judges)?;
    let steps = SearchSpace::of(body)?.spread(1.0 / 25.0)?;
    let follow = |pose: &Vec<f32>| Following::new(body, pose, &steps)?.with(&remeasured);
    let moved: Vec<Vec<f32>> = judges.iter().map(follow).collect::<Result<_>>()?;
    judge.scorer.set_body(&remeasured)?;
    let after = judge.settled_fitness(&moved)?;
    let gains: Vec<f64> = after.iter().zip(&before).map(|(after, before)| f64::from(after - before)).collect();
    Ok(Some(Remeasured { body: remeasured, gain: mean_and_error(&gains) }))
}

/// A mean and its standard error.
fn mean_and_error(values: &[f64]) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = mean(values.iter().copied());
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    [mean, (squares / (count - 1.0).max(1.0) / count.max(1.0)).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_sure_is_believed() {
        let believed = |gains: &[f64]| {
            Remeasured { body: Body::adult(1750.0).unwrap(), gain: mean_and_error(gains) }.is_believed()
        };
        let [mean, error] = mean_and_error(&[0.01, 0.02, 0.03]);
        assert!((mean - 0.02).abs() < 1e-12 && (error - 0.01 / 3.0_f64.sqrt()).abs() < 1e-12, "{mean} {error}");
        assert!(believed(&[0.01, 0.02, 0.03]));
        assert!(!believed(&[0.0030, 0.0035, 0.0040]), "no more than another shape of the parts gains");
        assert!(!believed(&[0.08, -0.04, 0.03]), "one frame says so, another one says the contrary");
    }
}
