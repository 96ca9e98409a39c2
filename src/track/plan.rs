//! A run prepared: everything it needs read and checked before anything is written.

use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use super::features_made::FeaturesMade;
use super::feed::Keeps;
use super::passes::SecondPass;
use super::searcher::Searcher;
use super::smoothed::smoothing;
use super::{BuiltBackend, Drawing, Passes, TrackSettings};
use crate::body::{Body, Mesh, PoseTable};
use crate::evaluate::Objective;
use crate::features::FeatureSettings;
use crate::gpu::Timing;
use crate::observe::{check_background, feature_settings};
use crate::search::{SearchSettings, SearchSpace};
use crate::sequence::Sequence;

/// The time the start pose is taken to be old, s: a pose set by hand is no nearer than one of a video of 25 frames/s.
const START_AGE: f64 = 1.0 / 25.0;

/// A run prepared.
pub(super) struct Plan {
    pub(super) body: Body,
    /// What the body is drawn as, when that is not the flat model.
    pub(super) mesh: Option<Mesh>,
    pub(super) range: Range<usize>,
    /// The pose the first frame's search starts round: mm, radians.
    pub(super) start: Vec<f32>,
    pub(super) start_path: PathBuf,
    pub(super) objective: Objective,
    pub(super) features: FeatureSettings,
    /// Who makes the features.
    pub(super) made: FeaturesMade,
    pub(super) backend: BuiltBackend,
    pub(super) search: Searcher,
    pub(super) space: SearchSpace,
    settings: SearchSettings,
    timing: Timing,
    fps: f64,
    spread: f64,
}

impl Plan {
    /// With `drawing` in place of the settings'.
    pub(super) fn new(sequence: &Sequence, settings: &TrackSettings, drawing: Drawing) -> Result<Self> {
        settings.check()?;
        settings.realtime.as_ref().map(|realtime| realtime.time_to_search(sequence)).transpose()?;
        let name = sequence.path.display().to_string();
        let range = settings.frames.within(sequence.frame_count, &name)?;
        // Frames are counters of the random numbers.
        u32::try_from(range.end).map_err(|_| anyhow::anyhow!("{name} has {} frames, too many", range.end))?;
        if let Some(cutoff) = settings.smooth {
            smoothing(cutoff, sequence.fps, range.len())?;
        }
        let body = Body::load(&sequence.body)?;
        let mut features = feature_settings(sequence)?;
        let usual = settings.usual_objective(!features.segment.is_empty());
        let objective = settings.objective.resolve_over(usual, sequence.objective.as_ref(), &name)?;
        objective.check_segments(!features.segment.is_empty()).with_context(|| name.clone())?;
        features.likelihoods = objective.weighs_evidence();
        check_background(sequence, &range)?;
        let Some(start_path) = settings.start.clone().or_else(|| sequence.start.clone()) else {
            bail!("{name} names no start pose, expected a poses.csv as `start` there or as --start");
        };
        let start = start_pose(&start_path, &body, range.start)?;
        let space = SearchSpace::of(&body)?;
        let mut start: Vec<f32> = start.into_iter().map(|value| value as f32).collect();
        // Rounding to single precision may have left the limits by a hair.
        space.clamp(&mut start);
        settings.search.check()?;
        let mesh = settings.model.mesh(&body)?;
        let mut backend = drawing.build(&settings.devices, mesh.as_ref(), &body, &sequence.cameras, &start)?;
        let made = FeaturesMade::choose(settings, &features, backend.evaluator.as_ref())?;
        if let Some(note) = &made.note {
            backend.reason = format!("{}; {note}", backend.reason);
        }
        let second = SecondPass::of(backend.evaluator.as_ref());
        if let (Passes::Both, SecondPass::InPlace(set)) = (settings.passes(), second) {
            let with = set.name();
            backend.reason =
                format!("{}; the second pass is the processor's, with {with} instructions", backend.reason);
        }
        let timing = if settings.trace { Timing::Statistics } else { Timing::Off };
        let search = Searcher::new(backend.evaluator.as_mut(), &objective, &settings.search, &space, timing)?;
        Ok(Self {
            range,
            start,
            start_path,
            objective,
            features,
            made,
            backend,
            search,
            space,
            settings: settings.search,
            timing,
            mesh,
            fps: sequence.fps,
            spread: settings.spread,
            body,
        })
    }

    /// What is kept of the frames that are searched.
    pub(super) fn keeps(&self) -> Keeps<'_> {
        self.made.device.as_ref().map_or(Keeps::Observations, |device| Keeps::OnDevice(device, self.timing))
    }

    /// What the search is made from.
    pub(super) fn search_settings(&self) -> &SearchSettings {
        &self.settings
    }

    /// Makes the search one of `particles` and `iterations`, when it is another yet.
    pub(super) fn resize(&mut self, particles: usize, iterations: usize) -> Result<()> {
        if [self.settings.particles, self.settings.iterations] != [particles, iterations] {
            self.settings = SearchSettings { particles, iterations, ..self.settings };
            let evaluator = self.backend.evaluator.as_mut();
            self.search = Searcher::new(evaluator, &self.objective, &self.settings, &self.space, self.timing)?;
        }
        Ok(())
    }

    /// Standard deviation to start a frame's search with.
    pub(super) fn spread(&self, is_first_frame: bool) -> Result<Vec<f32>> {
        let interval = 1.0 / self.fps;
        self.space.spread(self.spread * if is_first_frame { interval.max(START_AGE) } else { interval })
    }
}

/// The pose to start with: the file's only one, or that of the first frame.
fn start_pose(path: &Path, body: &Body, first: usize) -> Result<Vec<f64>> {
    let mut table = PoseTable::read(path, body)?;
    let row = if table.poses.len() == 1 {
        0
    } else {
        let Some(row) = table.frames.iter().position(|frame| *frame == first) else {
            bail!(
                "{} holds {} poses, none of frame {first}, expected one pose or one of that frame to start with",
                path.display(),
                table.poses.len()
            );
        };
        row
    };
    let pose = table.poses.swap_remove(row);
    body.check_limits(&pose).with_context(|| format!("{}: the start pose", path.display()))?;
    Ok(pose)
}
