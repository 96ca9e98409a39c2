//! The search on a Vulkan device: all iterations of a frame in one submission, and only its result read back.
//!
//! It is the search of [`super::Pso`], [`super::HierarchicalPso`], [`super::ParticleFilter`], [`super::AnnealedFilter`] and MA-ES with
//! the same random numbers and, operation by operation, the same arithmetic: given the same fitness it finds the same poses to the bit. What it does is recorded once; a frame
//! writes its centre and spread, submits the recording and waits.

mod annealed;
mod evolution;
mod filter;
mod swarm;
#[cfg(test)]
mod tests;

use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};

use super::kinds::{Answer, SwarmLevel};
use super::shaders::{SEARCH_GROUP, layout, spread_comp};
use super::{Estimate, SearchKind, SearchSettings, SearchSpace, check_start};
use crate::evaluate::DeviceEvaluator;
use crate::evaluate::Objective;
use crate::gpu::{Buffer, Device, DevicePass, Groups, Memory, PassTiming, Recorder, Recording, StagedBuffer, Timing};

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
        let views = evaluator.views();
        let memory = FrameMemory::new(&device, space.dof_count(), settings.iterations, views)?;
        let mut recorder = device.recorder(timing)?;
        memory.frame.record_upload(&mut recorder)?;
        evaluator.record_upload(&mut recorder)?;
        let mut recording = FrameRecording { recorder: &mut recorder, evaluator, objective, extent, memory: &memory };
        match settings.kind {
            SearchKind::Pso => recording.swarm(settings, &[SwarmLevel::whole(space, settings.iterations)]),
            SearchKind::Hierarchical => {
                recording.swarm(settings, &settings.hierarchy.levels(space, settings.iterations))
            }
            SearchKind::ParticleFilter => recording.filter(settings),
            SearchKind::Annealed => recording.annealed(settings),
            SearchKind::MaEs => recording.evolution(settings),
            kind => bail!("the search {:?} has no form for devices", kind.name()),
        }
        .with_context(|| {
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
            words: vec![0; (memory.readback.size() / 4) as usize],
            memory,
        })
    }

    /// A whole frame, as [`super::Search::search_frame`] does it.
    ///
    /// # Errors
    /// When a length is not the number of degrees of freedom, a value is not finite, a spread is negative, no fitness was a
    /// finite number, or the device fails ([`crate::gpu::DeviceLost`]).
    pub fn search_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<DeviceFound> {
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
        self.recording.run()?;
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

/// What goes to the device and comes back in every frame.
struct FrameMemory {
    device: Device,
    frame: StagedBuffer,
    outcome: Buffer,
    /// Order of the best fitness after each iteration.
    history: Buffer,
    /// The fitness of a filter's estimate.
    fitness: Buffer,
    sums: Buffer,
    readback: Buffer,
    places: Places,
}

/// Where things begin in the readback, words. The outcome's header begins it.
struct Places {
    values: usize,
    history: usize,
    fitness: usize,
    sums: usize,
}

impl FrameMemory {
    fn new(device: &Device, dofs: usize, iterations: usize, views: usize) -> Result<Self> {
        let frame = size_of::<layout::FrameHeader>() / 4 + 4 * dofs;
        let header = size_of::<layout::OutcomeHeader>() / 4;
        let outcome = header + 3 * dofs;
        let places =
            Places { values: header, history: outcome, fitness: outcome + iterations, sums: outcome + iterations + 1 };
        let words = |name: &str, count: usize, memory| device.buffer::<u32>(name, count, memory);
        Ok(Self {
            device: device.clone(),
            frame: StagedBuffer::new::<u32>(device, "search frame", frame)?,
            outcome: words("search outcome", outcome, Memory::Device)?,
            history: words("best of each iteration", iterations, Memory::Device)?,
            fitness: words("estimate's fitness", 1, Memory::Device)?,
            sums: words("estimate's sums", 4 * views, Memory::Device)?,
            readback: words("search result", places.sums + 4 * views, Memory::Readback)?,
            places,
        })
    }

    fn record_readback(&self, recorder: &mut Recorder) -> Result<()> {
        let Places { history, fitness, sums, .. } = self.places;
        for (from, place) in
            [(&self.outcome, 0), (&self.history, history), (&self.fitness, fitness), (&self.sums, sums)]
        {
            recorder.copy("readback", (from, 0), (&self.readback, 4 * place as u64), from.size())?;
        }
        Ok(())
    }
}

/// How many candidates of how many values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Extent {
    candidates: u32,
    dofs: u32,
}

impl Extent {
    /// Workgroups for one invocation a block of random numbers of every candidate: as many candidates in x as the device
    /// allows and stacked in z, the dimensions in y.
    fn block_groups(self, device: &Device) -> Groups<'static> {
        /// Dimensions that [`BLOCKS`] blocks of random numbers serve.
        const DIMENSIONS: u32 = 32;
        const BLOCKS: u32 = 8;
        let groups = self.candidates.div_ceil(SEARCH_GROUP / BLOCKS).max(1);
        let row = groups.min(device.capabilities().max_groups);
        Groups::Count([row, self.dofs.div_ceil(DIMENSIONS), groups.div_ceil(row)])
    }
}

/// A frame being recorded.
struct FrameRecording<'a> {
    recorder: &'a mut Recorder,
    evaluator: &'a mut dyn DeviceEvaluator,
    objective: &'a Objective,
    extent: Extent,
    memory: &'a FrameMemory,
}

impl FrameRecording<'_> {
    fn evaluate(&mut self, candidates: u32) -> Result<()> {
        self.evaluator.record(self.recorder, self.objective, candidates)
    }

    /// As many ones.
    fn ones(&mut self, name: &str, count: u32) -> Result<Buffer> {
        let ones = self.values(name, count, 1)?;
        self.recorder.fill("ones", &ones, 1.0_f32.to_bits())?;
        Ok(ones)
    }

    /// The weighted mean of `count` rows, and its own evaluation.
    fn estimate_mean(&mut self, rows: &Buffer, weights: &Buffer, count: u32) -> Result<()> {
        let (extent, memory) = (self.extent, self.memory);
        let factors = self.ones("everything moves", extent.dofs)?;
        let bindings = spread_comp::Bindings {
            frame: &memory.frame.buffer,
            outcome: &memory.outcome,
            rows,
            weights,
            factors: &factors,
        };
        let push = spread_comp::Push { count, dofs: extent.dofs, level: 0 };
        self.recorder.run(bindings.dispatch(push, Groups::Count([extent.dofs, 1, 1])))?;
        self.evaluate_mean()?;
        let (fitness, sums) = (self.evaluator.fitness().clone(), self.evaluator.sums().clone());
        self.recorder.copy("gather", (&fitness, 0), (&memory.fitness, 0), 4)?;
        self.recorder.copy("gather", (&sums, 0), (&memory.sums, 0), memory.sums.size())?;
        self.recorder.fill("no history", &memory.history, 0)
    }

    /// The evaluation of the mean that has been found.
    fn evaluate_mean(&mut self) -> Result<()> {
        let row = 4 * u64::from(self.extent.dofs);
        let mean = 4 * self.memory.places.values as u64 + 2 * row;
        let positions = self.evaluator.poses().clone();
        self.recorder.copy("estimate", (&self.memory.outcome, mean), (&positions, 0), row)?;
        self.evaluate(1)
    }

    /// A buffer of `count` values a particle.
    fn values(&self, name: &str, particles: u32, count: u32) -> Result<Buffer> {
        let len = usize::try_from(u64::from(particles) * u64::from(count))?;
        let device = self.evaluator.device();
        let (bytes, limit) = (4 * len as u64, device.capabilities().max_storage);
        ensure!(bytes <= limit, "{name} take {bytes} bytes, and this device binds at most {limit} at once");
        device.buffer::<f32>(name, len, Memory::Device)
    }
}
