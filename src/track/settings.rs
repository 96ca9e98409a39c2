//! Everything a run is asked for.

use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Result, ensure};

use super::journal::Numbering;
use super::{Drawing, FeaturesOn, FrameRange, ObjectiveChoice, Passes, Prediction, RealtimeSettings, Width};
use crate::body::Model;
use crate::evaluate::ObjectiveKind;
use crate::report::check_recordings_are_built;
use crate::search::{SearchKind, SearchSettings};
use crate::sequence::{STALL_TIMEOUT, Sequence};

/// How a sequence is tracked.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackSettings {
    /// Who scores the poses, and how.
    pub drawing: Drawing,
    /// The Vulkan devices that share the poses, by their numbers; without any the one of the environment, or the best.
    pub devices: Vec<usize>,
    /// Who makes the features; the bits are the same.
    pub features_on: FeaturesOn,
    /// What the body is drawn as.
    pub model: Model,
    /// What counts as a good pose; over the sequence's `[objective]` table. Where neither names a kind, `evidence` with the search `maes`
    /// and the flat model off line, unless body parts are told apart; else `sp`.
    pub objective: ObjectiveChoice,
    /// How poses are searched; its seed decides all random numbers.
    pub search: SearchSettings,
    /// Factor on the standard deviation with which a frame's search starts round the previous pose: the body's steps,
    /// scaled to the time between frames.
    pub spread: f64,
    /// Where a frame's search starts; without, as it suits the search ([`Self::prediction`]).
    pub predict: Option<Prediction>,
    /// How wide it starts; without, as it suits the search ([`Self::width`]).
    pub width: Option<Width>,
    /// How often the run goes over its frames; without, as it suits the search ([`Self::passes`]).
    pub passes: Option<Passes>,
    /// Measure the body again between the two passes of a run that has them, and go on with what is found where that fits better; without, as
    /// the sequence says, where it can be ([`Self::measures_again`]).
    pub measure_again: Option<bool>,
    /// Whether a lost person is searched for wider, and frames without a find are gaps in the results.
    pub recover: bool,
    /// Which frames.
    pub frames: FrameRange,
    /// A poses.csv to start from instead of the sequence's: one row, or one whose frame is the first to be tracked.
    pub start: Option<PathBuf>,
    /// Cut-off of a low-pass, Hz, by which the results are smoothed that are written beside them, into `smoothed/`; none without.
    pub smooth: Option<f64>,
    /// Every how many frames the model is drawn over the pictures; 0 for never.
    pub overlay_every: usize,
    /// Whether the label of the part that shows is drawn at every pixel of the videos, frame by frame.
    pub labels: bool,
    /// Measure every pass on the device, for the trace and the timings; it costs time of its own.
    pub trace: bool,
    /// Write the report as a recording too; only in builds with the feature `rerun`.
    pub recording: bool,
    /// Go on with the run that the output folder holds.
    pub resume: bool,
    /// How long a view may take for a picture.
    pub stall_timeout: Duration,
    /// Keep time with the pictures, and leave out what comes too fast.
    pub realtime: Option<RealtimeSettings>,
}

impl Default for TrackSettings {
    fn default() -> Self {
        Self {
            drawing: Drawing::default(),
            devices: Vec::new(),
            features_on: FeaturesOn::default(),
            model: Model::default(),
            objective: ObjectiveChoice::default(),
            search: SearchSettings::default(),
            spread: 1.0,
            predict: None,
            width: None,
            passes: None,
            measure_again: None,
            recover: true,
            frames: FrameRange::default(),
            start: None,
            smooth: None,
            overlay_every: 10,
            labels: false,
            trace: false,
            recording: false,
            resume: false,
            stall_timeout: STALL_TIMEOUT,
            realtime: None,
        }
    }
}

impl TrackSettings {
    /// Where a frame's search starts. What the track taught suits `maes`; the other searches start as they did before it.
    pub fn prediction(&self) -> Prediction {
        let usual = if self.search.kind == SearchKind::MaEs { Prediction::Learnt } else { Prediction::None };
        self.predict.unwrap_or(usual)
    }

    /// How wide a frame's search starts, chosen likewise.
    pub fn width(&self) -> Width {
        let usual = if self.search.kind == SearchKind::MaEs { Width::Learnt } else { Width::Steps };
        self.width.unwrap_or(usual)
    }

    /// What a good pose is where neither settings nor sequence say. Evidence, which is right more often, where `maes` compares the flat
    /// model off line; body parts that are told apart count in silhouettes alone, and real time has no time for it.
    pub(super) fn usual_objective(&self, has_segments: bool) -> ObjectiveKind {
        let weighs = self.search.kind == SearchKind::MaEs && self.model == Model::Flat && self.realtime.is_none();
        if weighs && !has_segments { ObjectiveKind::Evidence } else { ObjectiveKind::default() }
    }

    /// How often the run goes over its frames: twice with `maes` where there is time for it. The other searches go on as they did before it.
    pub fn passes(&self) -> Passes {
        let has_time = self.realtime.is_none() && self.search.kind == SearchKind::MaEs;
        self.passes.unwrap_or(if has_time { Passes::Both } else { Passes::Forward })
    }

    /// Whether the person is measured again between two passes: where that was asked for here, or by a sequence that is gone over twice with
    /// the flat body.
    pub fn measures_again(&self, sequence: &Sequence) -> bool {
        let can = self.passes() == Passes::Both && self.model == Model::Flat;
        self.measure_again.unwrap_or(can && sequence.measure_again == Some(true))
    }

    /// Whether a lost person is searched for wider: that takes the time that real time has not.
    pub(super) fn may_recover(&self) -> bool {
        self.recover && self.realtime.is_none()
    }

    /// Whether a frame's limbs are looked for by themselves: where no second pass does.
    pub(super) fn may_look_for_limbs(&self) -> bool {
        self.recover && self.search.kind == SearchKind::MaEs && self.passes() == Passes::Forward
    }

    /// How the journal of a run from frame `first` on counts: real time leaves frames out.
    pub(super) fn numbering(&self, first: usize) -> Numbering {
        if self.realtime.is_some() { Numbering::Rising } else { Numbering::EachFrom(first) }
    }

    /// Whether the settings make sense by themselves.
    ///
    /// # Errors
    /// With the setting, what it is and what was expected.
    pub fn check(&self) -> Result<()> {
        ensure!((0.01..=100.0).contains(&self.spread), "spread is {}, expected 0.01 to 100", self.spread);
        ensure!(
            self.prediction() == Prediction::None || !self.search.kind.carries_on(),
            "the search {} carries its samples from frame to frame and starts from no predicted pose, expected --predict none",
            self.search.kind.name()
        );
        let stall = self.stall_timeout.as_secs_f64();
        ensure!((0.1..=86_400.0).contains(&stall), "the stall time-out is {stall} s, expected 0.1 to 86400");
        if self.recording {
            check_recordings_are_built()?;
        }
        if self.measure_again == Some(true) {
            ensure!(
                self.passes() == Passes::Both,
                "a person is measured again between two passes, and this run goes over its frames once: leave out --measure-again"
            );
            ensure!(
                self.model == Model::Flat,
                "the flat body is what is measured again, and this run draws a mesh: leave out --measure-again"
            );
        }
        if let Some(realtime) = &self.realtime {
            realtime.check()?;
            ensure!(
                self.smooth.is_none(),
                "smoothing without delay takes the frames that are yet to come, and a run in real time has none: leave out --smooth, or \
                 smooth its poses.csv afterwards (pantin convert --smooth)"
            );
            ensure!(
                !self.labels,
                "labels are drawn once all is done, and a run in real time goes on: leave out --labels, or track the recording off line"
            );
            ensure!(
                self.passes() == Passes::Forward,
                "a run in real time goes over its frames once, expected --passes forward"
            );
            ensure!(
                !self.recording,
                "a run in real time writes no report, so there is none to record: leave out --rerun"
            );
            ensure!(
                realtime.deadline.is_none() || matches!(self.search.kind, SearchKind::Pso | SearchKind::MaEs),
                "a deadline changes the number of poses from frame to frame, which --search {} cannot: expected maes or pso",
                self.search.kind.name()
            );
        }
        self.search.check()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::SearchKind;

    #[test]
    fn wrong_settings_are_named() {
        TrackSettings::default().check().unwrap();
        let error = TrackSettings { spread: f64::NAN, ..TrackSettings::default() }.check().unwrap_err().to_string();
        assert!(error.contains("spread is NaN"), "{error}");
        let mut settings = TrackSettings { predict: Some(Prediction::Velocity), ..TrackSettings::default() };
        settings.check().unwrap();
        settings.search.kind = SearchKind::ParticleFilter;
        let error = settings.check().unwrap_err().to_string();
        assert!(error.contains("the search pf carries its samples"), "{error}");
        let mut settings = TrackSettings::default();
        assert_eq!(settings.passes(), Passes::Both);
        settings.search.kind = SearchKind::Pso;
        assert_eq!(settings.passes(), Passes::Forward, "what the swarm gives stays what it was");
        settings = TrackSettings { realtime: Some(RealtimeSettings::default()), ..TrackSettings::default() };
        assert_eq!(settings.passes(), Passes::Forward);
        settings.passes = Some(Passes::Both);
        let error = settings.check().unwrap_err().to_string();
        assert!(error.contains("expected --passes forward"), "{error}");
        settings = TrackSettings { smooth: Some(6.0), passes: None, ..settings };
        let error = settings.check().unwrap_err().to_string();
        assert!(error.contains("leave out --smooth"), "{error}");
        settings = TrackSettings { smooth: None, labels: true, ..settings };
        let error = settings.check().unwrap_err().to_string();
        assert!(error.contains("leave out --labels"), "{error}");
        let again = TrackSettings { measure_again: Some(true), ..TrackSettings::default() };
        again.check().unwrap();
        let error = TrackSettings { passes: Some(Passes::Forward), ..again.clone() }.check().unwrap_err().to_string();
        assert!(error.contains("goes over its frames once: leave out --measure-again"), "{error}");
        let error = TrackSettings { model: Model::Mesh, ..again }.check().unwrap_err().to_string();
        assert!(error.contains("draws a mesh"), "{error}");
        let mut settings = TrackSettings::default();
        settings.search.particles = 0;
        let error = settings.check().unwrap_err().to_string();
        assert!(error.contains("particles is 0"), "{error}");
    }
}
