//! A frame's search as it is recorded for a device: what goes there and comes back, and what every kind of search records alike.

use anyhow::{Result, ensure};

use crate::evaluate::{DeviceEvaluator, Objective};
use crate::gpu::{Buffer, Device, Groups, Memory, Recorder, StagedBuffer};
use crate::search::SearchSpace;
use crate::search::shaders::{LOOK_GROUP, SEARCH_GROUP, layout, spread_comp};

/// A kind of search in the form that runs whole on a device.
pub(crate) trait DeviceForm {
    /// Invocations of the largest workgroup it needs.
    fn largest_workgroup(&self) -> u32 {
        LOOK_GROUP
    }

    /// Records a frame's iterations: from the frame's centre and spread to the outcome and its sums.
    ///
    /// # Errors
    /// When the device has no room, or they need more passes than a recording holds.
    fn record(&self, frame: &mut FrameRecording, space: &SearchSpace, iterations: usize) -> Result<()>;
}

/// What goes to the device and comes back in every frame.
pub(super) struct FrameMemory {
    pub(super) device: Device,
    pub(super) frame: StagedBuffer,
    pub(super) outcome: Buffer,
    /// Order of the best fitness after each iteration.
    pub(super) history: Buffer,
    /// The fitness of a filter's estimate.
    pub(super) fitness: Buffer,
    pub(super) sums: Buffer,
    pub(super) readback: Buffer,
    pub(super) places: Places,
}

/// Where things begin in the readback, words. The outcome's header begins it.
pub(super) struct Places {
    pub(super) values: usize,
    pub(super) history: usize,
    pub(super) fitness: usize,
    pub(super) sums: usize,
}

impl FrameMemory {
    pub(super) fn new(device: &Device, dofs: usize, iterations: usize, views: usize) -> Result<Self> {
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

    pub(super) fn record_readback(&self, recorder: &mut Recorder) -> Result<()> {
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
pub(super) struct Extent {
    pub(super) candidates: u32,
    pub(super) dofs: u32,
}

impl Extent {
    /// Workgroups for one invocation a block of random numbers of every candidate: as many candidates in x as the device
    /// allows and stacked in z, the dimensions in y.
    pub(super) fn block_groups(self, device: &Device) -> Groups<'static> {
        /// Dimensions that [`BLOCKS`] blocks of random numbers serve.
        const DIMENSIONS: u32 = 32;
        const BLOCKS: u32 = 8;
        let groups = self.candidates.div_ceil(SEARCH_GROUP / BLOCKS).max(1);
        let row = groups.min(device.capabilities().max_groups);
        Groups::Count([row, self.dofs.div_ceil(DIMENSIONS), groups.div_ceil(row)])
    }
}

/// A frame being recorded.
pub(crate) struct FrameRecording<'a> {
    pub(super) recorder: &'a mut Recorder,
    pub(super) evaluator: &'a mut dyn DeviceEvaluator,
    pub(super) objective: &'a Objective,
    pub(super) extent: Extent,
    pub(super) memory: &'a FrameMemory,
}

impl FrameRecording<'_> {
    pub(super) fn evaluate(&mut self, candidates: u32) -> Result<()> {
        self.evaluator.record(self.recorder, self.objective, candidates)
    }

    /// As many ones.
    pub(super) fn ones(&mut self, name: &str, count: u32) -> Result<Buffer> {
        let ones = self.values(name, count, 1)?;
        self.recorder.fill("ones", &ones, 1.0_f32.to_bits())?;
        Ok(ones)
    }

    /// The weighted mean of `count` rows, and its own evaluation.
    pub(super) fn estimate_mean(&mut self, rows: &Buffer, weights: &Buffer, count: u32) -> Result<()> {
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
    pub(super) fn evaluate_mean(&mut self) -> Result<()> {
        let row = 4 * u64::from(self.extent.dofs);
        let mean = 4 * self.memory.places.values as u64 + 2 * row;
        let positions = self.evaluator.poses().clone();
        self.recorder.copy("estimate", (&self.memory.outcome, mean), (&positions, 0), row)?;
        self.evaluate(1)
    }

    /// A buffer of `count` values a particle.
    pub(super) fn values(&self, name: &str, particles: u32, count: u32) -> Result<Buffer> {
        let len = usize::try_from(u64::from(particles) * u64::from(count))?;
        let device = self.evaluator.device();
        let (bytes, limit) = (4 * len as u64, device.capabilities().max_storage);
        ensure!(bytes <= limit, "{name} take {bytes} bytes, and this device binds at most {limit} at once");
        device.buffer::<f32>(name, len, Memory::Device)
    }
}
