//! What a run leaves behind: its results and the account of its times.

use anyhow::Result;
use serde_json::json;

use super::Run;
use crate::track::confidence::{Confidence, LossRule};
use crate::track::held::Held;
use crate::track::journal::{Extent, Journal};
use crate::track::labels;
use crate::track::pace::Finished;
use crate::track::progress::Progress;
use crate::track::results;
use crate::track::run_record::RunRecord;
use crate::track::smoothed;
use crate::track::summary::{TrackSummary, doubtful_sentence, left_out_sentences, lost_sentence, mean};

impl Run<'_> {
    /// Writes the results, unless the run was stopped.
    pub(crate) fn finish(
        mut self,
        record: &RunRecord,
        warnings: Vec<String>,
        progress: &mut dyn Progress,
    ) -> Result<TrackSummary> {
        let (sequence, output, body) = (self.sequence, self.output, &self.plan.body);
        let next = self.next_frame();
        let ends_anywhere = self.pace.ends_anywhere();
        let is_cut = self.is_cut || (!ends_anywhere && next < self.plan.range.end);
        let stopped_before = (is_cut && !ends_anywhere).then_some(next);
        let extent = Extent::of(body, &sequence.cameras);
        let frames = self.pace.all_frames(self.frames, &output.path().join(Journal::NAME), extent, self.done)?;
        let confidences = Confidence::of_all(body, LossRule::default(), &frames);
        let held = Held::new(&frames, &confidences, self.recovery.is_some());
        let mut summary = TrackSummary {
            first_frame: self.plan.range.start,
            lost: held.gap_count(),
            new_frames: 0,
            frames_per_second: 0.0,
            mean_fitness: mean(frames.iter().map(|result| f64::from(result.fitness))),
            mean_confidence: mean(confidences.iter().map(|frame| frame.confidence)),
            error: None,
            timings: Vec::new(),
            backend: [self.plan.backend.evaluator.name(), self.plan.backend.evaluator.variant()],
            warnings,
            is_cut,
            stopped_before,
            realtime: None,
            frames,
        };
        let has_passes = self.timings.has_device_passes();
        summary.timings = self.timings.finish()?;
        if self.settings.trace && summary.timings.iter().any(|timing| timing.name == "search") && !has_passes {
            let [name, variant] = summary.backend;
            summary.warnings.push(format!("the trace holds no device passes: {name} ({variant}) told of none"));
        }
        // Per frame: waiting for the features, searching, writing; the rest runs beside it.
        let busy: f64 = ["wait", "evaluate", "search", "output", "dissent", "measure", "hindsight"]
            .iter()
            .filter_map(|name| summary.timings.iter().find(|timing| timing.name == *name))
            .map(|timing| timing.total)
            .sum();
        let searched = summary.timings.iter().find(|timing| timing.name == "search").map_or(0, |timing| timing.count);
        summary.new_frames = searched as usize;
        summary.frames_per_second = if busy > 0.0 { searched as f64 / busy * 1e3 } else { 0.0 };
        if stopped_before.is_some() {
            return Ok(summary);
        }
        summary.warnings.extend(lost_sentence(&held));
        summary.warnings.extend(left_out_sentences(
            &sequence.cameras,
            &held,
            &summary.frames,
            self.settings.realtime.is_some(),
        ));
        summary.warnings.extend(doubtful_sentence(&body.joint_names(), &held, &confidences));
        if !summary.frames.is_empty() {
            let warning =
                results::write(output, body, &sequence.cameras, &summary.frames, &confidences, &held, sequence.fps)?;
            summary.warnings.extend(warning);
        }
        if let Some(cutoff) = self.settings.smooth.filter(|_| !summary.frames.is_empty()) {
            let has_gaps = self.recovery.is_some();
            let told = smoothed::write(output, sequence, body, &summary.frames, &confidences, has_gaps, cutoff)?;
            summary.warnings.extend(told);
        }
        if self.settings.labels && !summary.frames.is_empty() {
            let mesh = self.plan.mesh.as_ref();
            summary.warnings.extend(labels::write(output, sequence, body, mesh, &held, progress)?);
        }
        // A finished run that is gone on with has no times to tell; those of the run that did the work stay.
        if summary.new_frames > 0 || !output.path().join("stages.json").exists() {
            output.write("stages.json", |writer| {
                let object = json!({
                    "unit": "ms",
                    "frames": summary.new_frames,
                    "frames_per_second": summary.frames_per_second,
                    "stages": summary.timings,
                });
                Ok(serde_json::to_writer_pretty(writer, &object)?)
            })?;
        }
        let (settings, truth, done) = (self.settings, self.truth.as_ref(), self.done);
        let run =
            Finished { sequence, settings, output, body, confidences: &confidences, held: &held, truth, record, done };
        self.pace.close(&run, &mut summary)?;
        Ok(summary)
    }
}
