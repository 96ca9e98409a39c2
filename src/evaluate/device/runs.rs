//! Runs from host to host: recorded once for a number of candidates and an objective, then only submitted.

use std::time::Instant;

use anyhow::Result;

use crate::evaluate::Objective;
use crate::evaluate::besides::Besides;
use crate::gpu::{DevicePass, PassTiming, Recording, Timing};

use super::handover::Handovers;
use super::scene::DeviceScene;

/// What a run ends in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Asked {
    /// What is summed of the candidates, on the host.
    Sums(Besides),
    Fitness(Objective),
}

impl Asked {
    /// What is summed besides the components.
    pub(super) fn besides(self) -> Besides {
        match self {
            Self::Sums(besides) => besides,
            Self::Fitness(objective) => Besides::of(&objective),
        }
    }
}

/// What a run is recorded for: a number of candidates, and what is asked of them.
pub(super) type RunKey = (u32, Asked);

/// Runs kept: a search asks for a few numbers of candidates over and over.
const MOST_RUNS: usize = 16;

/// The recorded runs of a backend, and the upload that goes ahead of them.
#[derive(Debug)]
pub(super) struct Runs {
    /// Brings body, cameras and observations to the device.
    upload: Recording,
    is_uploaded: bool,
    /// The latest last. A run is one recording or, where the host works in between, several.
    recorded: Vec<(RunKey, Vec<Recording>)>,
    timing: Timing,
    /// What ran since it was last asked for, once it is to be measured.
    passes: Option<Vec<DevicePass>>,
}

impl Runs {
    /// With the passes that bring everything to the device.
    pub(super) fn new(upload: Recording) -> Self {
        Self { upload, is_uploaded: false, recorded: Vec::new(), timing: Timing::Off, passes: None }
    }

    /// What runs are to be recorded with.
    pub(super) fn timing(&self) -> Timing {
        self.timing
    }

    /// Has every run from now on timed by stage.
    pub(super) fn time_stages(&mut self, timing: Timing) {
        self.timing = timing;
        self.recorded.clear();
    }

    /// Keeps the passes of every run from now on, or no longer.
    pub(super) fn measure_passes(&mut self, measured: bool) {
        if measured != self.passes.is_some() {
            self.passes = measured.then(Vec::new);
            self.time_stages(if measured { Timing::Statistics } else { Timing::Off });
        }
    }

    /// The passes since the last call.
    pub(super) fn take_passes(&mut self) -> Vec<DevicePass> {
        self.passes.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// The times of the last run's passes.
    pub(super) fn timings(&self) -> Result<Vec<PassTiming>> {
        let mut all = Vec::new();
        for recording in self.recorded.last().iter().flat_map(|(_, recordings)| recordings) {
            all.extend(recording.timings()?);
        }
        Ok(all)
    }

    /// Has body, cameras and observations brought to the device again.
    pub(super) fn outdate_upload(&mut self) {
        self.is_uploaded = false;
    }

    /// Exchanges the passes that bring everything to the device.
    pub(super) fn set_upload(&mut self, upload: Recording) {
        self.upload = upload;
        self.is_uploaded = false;
    }

    /// Gives up what was recorded, and with it the memory that it holds; whether there was anything.
    pub(super) fn clear(&mut self) -> bool {
        let is_any = !self.recorded.is_empty();
        self.recorded.clear();
        is_any
    }

    /// Makes the run of `key` the latest; false when it is not recorded.
    pub(super) fn select(&mut self, key: RunKey) -> bool {
        let place = self.recorded.iter().position(|(known, _)| *known == key);
        if let Some(place) = place {
            self.recorded[place..].rotate_left(1);
        }
        place.is_some()
    }

    /// Takes a run, now the latest.
    pub(super) fn add(&mut self, key: RunKey, recordings: Vec<Recording>) {
        if self.recorded.len() == MOST_RUNS {
            self.recorded.remove(0);
        }
        self.recorded.push((key, recordings));
    }

    /// Runs the latest, with the newest upload ahead of it, and what is handed over; `after` is called when its recording of that number
    /// is done.
    pub(super) fn run(
        &mut self,
        scene: &DeviceScene,
        handovers: &mut Handovers,
        mut after: impl FnMut(usize) -> Result<()>,
    ) -> Result<()> {
        if !self.is_uploaded {
            // The run that follows waits for it on the device.
            self.upload.submit()?;
            self.is_uploaded = true;
        }
        for (number, recording) in self.recorded.last_mut().into_iter().flat_map(|(_, run)| run).enumerate() {
            recording.run_behind(handovers.due())?;
            if let Some(passes) = &mut self.passes {
                passes.extend(recording.passes_run(Instant::now())?);
            }
            after(number)?;
        }
        scene.device.validation_log().check()
    }
}
