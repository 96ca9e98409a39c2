//! The second pass of a run, now that all of its frames are known.

use std::time::Instant;

use anyhow::Result;

use super::Run;
use crate::track::Passes;
use crate::track::feed::{Frames, Keeps};
use crate::track::hindsight::Hindsight;
use crate::track::overlay::Overlay;
use crate::track::progress::Progress;

impl Run<'_> {
    /// Goes over all frames again, now that what comes after each is known; not where the run was stopped before its last.
    pub(in crate::track) fn look_back(&mut self, progress: &mut dyn Progress) -> Result<()> {
        if !self.looks_back() {
            return Ok(());
        }
        // Frames are compared with many at once, so the host has them.
        let mut feed = self.pace.feed(self.sequence, &self.plan, self.plan.range.start, &Keeps::Observations)?;
        self.look_back_over(feed.as_mut(), progress)
    }

    /// Whether all frames are done and are to be gone over again.
    pub(in crate::track) fn looks_back(&self) -> bool {
        self.settings.passes() != Passes::Forward && self.next_frame() >= self.plan.range.end
    }

    /// Goes over all frames again as `feed` shows them.
    pub(in crate::track) fn look_back_over(
        &mut self,
        feed: &mut dyn Frames,
        progress: &mut dyn Progress,
    ) -> Result<()> {
        let start = Instant::now();
        let body = self.plan.body.clone();
        let overlay = Overlay::new(&body, self.plan.mesh.as_ref(), &self.sequence.cameras)?;
        let hindsight = Hindsight {
            plan: &mut self.plan,
            probe: &self.probe,
            cameras: &self.sequence.cameras,
            fps: self.sequence.fps,
            pictures_every: self.settings.overlay_every,
        };
        let mut results = Vec::with_capacity(self.frames.len());
        let known = (self.appearance.as_ref(), &*self.frames);
        hindsight.look_back(feed, known, progress, &mut |result, pictures| {
            if let Some(pictures) = pictures {
                overlay.write(self.output, result.frame, pictures, &result.pose)?;
            }
            results.push(result);
            Ok(())
        })?;
        if results.len() < self.frames.len() {
            self.is_cut = true;
        } else {
            self.frames = results;
        }
        self.count_over_frames("hindsight", start);
        Ok(())
    }

    /// Counts the time since `start` as that of a stage which was done for all frames at once.
    pub(super) fn count_over_frames(&mut self, stage: &'static str, start: Instant) {
        // A finished run that is gone on with has no times to tell.
        if !self.timings.is_empty() {
            let each = start.elapsed() / u32::try_from(self.frames.len()).unwrap_or(u32::MAX).max(1);
            self.frames.iter().for_each(|_| self.timings.count(stage, each));
        }
    }
}
