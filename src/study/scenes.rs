//! The sequences of a study: opened, or made on the spot.

use std::fs;

use anyhow::{Context, Result};

use super::settings::SequenceSettings;
use super::taken::{taken, taken_truth};
use crate::body::{Body, Model};
use crate::files::{OutputFolder, Overwrite};
use crate::motion::{PointTrajectory, TrajectoryError, read_points, read_y_up_points};
use crate::sequence::Sequence;
use crate::synth::{Scene, SyntheticSequence};
use crate::track::{TrackSummary, tracked_points};

/// A sequence that is ready to be tracked.
pub(super) struct Prepared {
    settings: SequenceSettings,
    sequence: Sequence,
    body: Body,
    /// A truth of the study's own, which needs names paired or points left out.
    truth: Option<PointTrajectory>,
}

/// How far a run is from the truth.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Errors {
    pub(super) points: usize,
    pub(super) mean: Option<f64>,
    pub(super) std: Option<f64>,
    pub(super) without_offset: Option<f64>,
}

impl Prepared {
    /// Opens the sequence; a preset is made first, in `output`, unless an earlier call made it. `progress` is called with
    /// the frames made and to be made.
    ///
    /// # Errors
    /// When the sequence or its truth cannot be read, or a preset cannot be made.
    pub(super) fn new(
        settings: &SequenceSettings,
        output: &OutputFolder,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<Self> {
        let name = settings.name();
        let sequence = match (&settings.preset, &settings.path) {
            (Some(preset), _) => {
                let folder = OutputFolder::open(&output.path().join("sequences").join(&name))?;
                make(preset, settings.length, &folder, progress).with_context(|| format!("sequence {name:?}"))?;
                Sequence::open(folder.path())?
            }
            (None, Some(path)) => Sequence::open(path).with_context(|| format!("sequence {name:?}"))?,
            (None, None) => match &settings.drawn {
                Some(drawn) => drawn.open(output, progress).with_context(|| format!("sequence {name:?}"))?,
                None => anyhow::bail!("sequence {name:?} has neither `path` nor `preset`"),
            },
        };
        let whole = (sequence.truth.clone(), sequence.frame_count);
        let sequence = taken(sequence, settings, output).with_context(|| format!("sequence {name:?}"))?;
        let body = Body::load(&sequence.body)?;
        let is_paired = settings.truth.is_some() || !settings.map.is_empty() || !settings.exclude.is_empty();
        let is_other = settings.reversed || settings.every.is_some_and(|every| every > 1);
        let path = settings.truth.as_ref().or(whole.0.as_ref());
        let truth = path
            .filter(|_| is_paired || is_other || settings.truth_y_up)
            .map(|path| if settings.truth_y_up { read_y_up_points(path) } else { read_points(path) })
            .transpose()
            .with_context(|| format!("the truth of sequence {name:?}"))?;
        let truth = truth.map(|points| if is_other { taken_truth(&points, settings, whole.1) } else { points });
        Ok(Self { settings: settings.clone(), sequence, body, truth })
    }

    /// The sequence with the body of a run's model.
    ///
    /// # Errors
    /// When the model's body.toml cannot be written.
    pub(super) fn with_model(&self, model: Model, output: &OutputFolder) -> Result<Sequence> {
        let mut sequence = self.sequence.clone();
        if let Some(dressed) = model.dressed(&self.body) {
            let name = format!("bodies/{}_{model}", self.settings.name());
            sequence.body = output.file(&format!("{name}.toml"))?;
            output.alone(&name, || dressed.save(&sequence.body, Overwrite::Replace))?;
        }
        Ok(sequence)
    }

    /// The errors of a finished track, by the study's own truth or as the tracker compared them.
    ///
    /// # Errors
    /// When track and truth share no points or frames.
    pub(super) fn errors(&self, track: &OutputFolder, summary: &TrackSummary) -> Result<Errors> {
        let name = self.settings.name();
        let own = match (&self.truth, &self.sequence.truth) {
            (Some(truth), _) => truth,
            (None, Some(path)) => &read_points(path)?,
            (None, None) => return Ok(Errors::default()),
        };
        let in_real_time = summary.realtime.as_ref().and_then(|it| it.error_mm);
        if self.truth.is_none() && summary.error.is_none() && in_real_time.is_none() {
            return Ok(Errors::default());
        }
        let map: Vec<(String, String)> = self.settings.map.clone().into_iter().collect();
        let place = || format!("[[sequence]] {name:?}");
        let (_, ours, mut pairs) = tracked_points(track.path(), own, &map).with_context(place)?;
        pairs.exclude(&ours, own, &self.settings.exclude).with_context(place)?;
        let compare = |remove: bool| TrajectoryError::between(&ours, own, &pairs, remove).with_context(place);
        let (error, without) = (compare(false)?, compare(true)?);
        Ok(Errors {
            points: error.points.len(),
            mean: Some(error.mean),
            std: Some(error.std),
            without_offset: Some(without.mean),
        })
    }
}

fn make(
    preset: &str,
    length: Option<usize>,
    folder: &OutputFolder,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<()> {
    let mut scene = Scene::preset(preset)?;
    scene.frames = length.unwrap_or(scene.frames);
    let frames = scene.frames;
    let synthetic = SyntheticSequence::new(&scene)?;
    // Every process that makes a run looks; the empty room alone takes seconds to draw.
    if synthetic.is_written(folder)? {
        return Ok(());
    }
    let begun = fs::read_dir(folder.path())?.next().is_some();
    synthetic.write(folder, begun, None, &|done| {
        progress(done, frames);
        Ok(())
    })
}
