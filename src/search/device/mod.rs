//! The search on a Vulkan device: all iterations of a frame in one submission, and only its result read back.
//!
//! It is the search of [`super::Pso`], [`super::HierarchicalPso`], [`super::ParticleFilter`], [`super::AnnealedFilter`] and MA-ES with
//! the same random numbers and, operation by operation, the same arithmetic: given the same fitness it finds the same poses to the bit.
//! What it does is recorded once; a frame writes its centre and spread, submits the recording and waits.

mod annealed;
mod behind;
#[cfg(test)]
mod behind_tests;
mod evolution;
mod filter;
mod frame;
mod swarm;
#[cfg(test)]
mod tests;

use std::time::Instant;

use anyhow::{Context, Result, ensure};

pub(super) use frame::{DeviceForm, FrameRecording};
use frame::{Extent, FrameMemory};

use super::kinds::Answer;
use super::shaders::layout;
use super::{Estimate, SearchSettings, SearchSpace, check_start};
use crate::evaluate::DeviceEvaluator;
use crate::evaluate::Objective;
use crate::gpu::{DevicePass, PassTiming, Recording, Timing};

/// What a search on a device found in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceFound {
    /// The result.
    pub estimate: Estimate,
    /// Drawn area, overlap, edge pixels and proximity of its pose, one row a view.
    pub sums: Vec<[u32; 4]>,
    /// The best fitness after each iteration of a swarm, not a number while none was finite; empty for the others.
    pub best: Vec<f32>,
}

/// A search on a device. It keeps what it needs of the evaluator it was made for, which may go on being used otherwise,
/// and takes whatever observations that has been given last.
pub struct DeviceSearch {
    settings: SearchSettings,
    space: SearchSpace,
    recording: Recording,
    memory: FrameMemory,
    /// The pose last estimated, which a next frame's centre is compared with; empty before.
    estimated: Vec<f32>,
    views: usize,
    /// Whether observations are handed over on the device, and not uploaded by what is recorded.
    is_handed: bool,
    /// The words of [`FrameMemory::readback`].
    words: Vec<u32>,
}

impl DeviceSearch {
    /// Compiles and records the search of `settings` over `space` with this evaluator and objective. Timing asks for
    /// [`Self::timings`].
    ///
    /// # Errors
    /// As [`SearchSettings::build`]; when the device has no room, or the iterations need more passes than a recording holds.
    pub fn new(
        evaluator: &mut dyn DeviceEvaluator,
        objective: &Objective,
        settings: &SearchSettings,
        space: &SearchSpace,
        timing: Timing,
    ) -> Result<Self> {
        settings.check()?;
        settings.check_room(space)?;
        let extent = Extent { candidates: settings.particles as u32, dofs: space.dof_count() as u32 };
        evaluator.reserve(extent.candidates)?;
        let room = u64::from(extent.candidates) * u64::from(extent.dofs) * 4;
        let found = evaluator.poses().size();
        ensure!(found >= room, "the evaluator has {found} bytes for poses, and the search needs {room}: other bodies?");
        let device = evaluator.device().clone();
        let (views, is_handed) = (evaluator.views(), evaluator.is_handed_observations());
        let memory = FrameMemory::new(&device, space.dof_count(), settings.iterations, views)?;
        let mut recorder = device.recorder(timing)?;
        memory.frame.record_upload(&mut recorder)?;
        evaluator.record_upload(&mut recorder)?;
        let mut recording = FrameRecording { recorder: &mut recorder, evaluator, objective, extent, memory: &memory };
        settings.record(&mut recording, space).with_context(|| {
            let SearchSettings { particles, iterations, .. } = settings;
            format!("cannot record a search of {particles} particles and {iterations} iterations for the device")
        })?;
        memory.record_readback(&mut recorder)?;
        Ok(Self {
            settings: *settings,
            space: space.clone(),
            recording: recorder.finish()?,
            estimated: Vec::with_capacity(space.dof_count()),
            views,
            is_handed,
            words: vec![0; (memory.readback.size() / 4) as usize],
            memory,
        })
    }

    /// Whether it is recorded for observations that are handed over on the device ([`DeviceEvaluator::is_handed_observations`]).
    pub fn is_handed_observations(&self) -> bool {
        self.is_handed
    }

    /// A whole frame, as [`super::Search::search_frame`] does it.
    ///
    /// # Errors
    /// When a length is not the number of degrees of freedom, a value is not finite, a spread is negative, no fitness was a
    /// finite number, or the device fails ([`crate::gpu::DeviceLost`]).
    pub fn search_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<DeviceFound> {
        self.search_frame_behind(None, frame, centre, spread)
    }

    /// The same behind what hands the frame's observations over ([`DeviceEvaluator::handover`]), both as one submission.
    ///
    /// # Errors
    /// As [`Self::search_frame`].
    pub fn search_frame_behind(
        &mut self,
        handover: Option<&mut Recording>,
        frame: u32,
        centre: &[f32],
        spread: &[f32],
    ) -> Result<DeviceFound> {
        let dofs = self.space.dof_count();
        check_start(dofs, centre, spread)?;
        let goes_on = self.settings.kind.carries_on() && self.estimated == centre;
        self.estimated.clear();
        let seed = self.settings.seed;
        let header = layout::FrameHeader {
            number: frame,
            goes_on: u32::from(goes_on),
            seed: [seed as u32, (seed >> 32) as u32],
        };
        let staging = &self.memory.frame.staging;
        staging.write(0, &[header])?;
        let first = size_of::<layout::FrameHeader>() / 4;
        for (row, values) in [centre, spread, self.space.lower(), self.space.upper()].into_iter().enumerate() {
            staging.write(first + row * dofs, values)?;
        }
        self.recording.run_behind(handover)?;
        self.memory.device.validation_log().check()?;
        self.take(frame)
    }

    /// Reads the result.
    fn take(&mut self, frame: u32) -> Result<DeviceFound> {
        let dofs = self.space.dof_count();
        let words = self.words.as_mut_slice();
        self.memory.readback.read(0, words)?;
        let places = &self.memory.places;
        let key = words[0];
        let values = |row: usize| -> Vec<f32> {
            let first = places.values + row * dofs;
            words[first..first + dofs].iter().map(|word| f32::from_bits(*word)).collect()
        };
        let SearchSettings { particles, iterations, kind, .. } = self.settings;
        let scored = particles * iterations;
        ensure!(key != 0, "none of the {scored} poses of frame {frame} has a finite fitness");
        let answer = kind.answer();
        let (pose, fitness) = if answer == Answer::Mean {
            let fitness = f32::from_bits(words[places.fitness]);
            ensure!(fitness.is_finite(), "the estimate of frame {frame} has a fitness of {fitness}");
            (values(2), fitness)
        } else {
            (values(0), value_of(key))
        };
        let evaluations = scored + usize::from(kind.estimates_a_mean());
        if kind.carries_on() {
            self.estimated.extend_from_slice(&pose);
        }
        let history = &words[places.history..places.history + if answer == Answer::Best { iterations } else { 0 }];
        let sums = words[places.sums..places.sums + 4 * self.views].as_chunks::<4>().0;
        Ok(DeviceFound {
            estimate: Estimate { pose, fitness, spread: values(1), evaluations },
            sums: sums.to_vec(),
            best: history.iter().map(|&key| if key == 0 { f32::NAN } else { value_of(key) }).collect(),
        })
    }

    /// The name as `--search` takes it.
    pub fn name(&self) -> &'static str {
        self.settings.kind.name()
    }

    /// The times of the last frame's passes, where the search was made to measure them.
    ///
    /// # Errors
    /// When the device fails.
    pub fn timings(&self) -> Result<Vec<PassTiming>> {
        self.recording.timings()
    }

    /// The last frame's passes on the host's clock, `end` being when the frame was done; none where nothing is measured.
    ///
    /// # Errors
    /// When the device fails.
    pub fn passes_run(&self, end: Instant) -> Result<Vec<DevicePass>> {
        self.recording.passes_run(end)
    }
}

/// The number whose order `best.comp` keeps.
fn value_of(key: u32) -> f32 {
    f32::from_bits(if key & 0x8000_0000 != 0 { key & 0x7FFF_FFFF } else { !key })
}
