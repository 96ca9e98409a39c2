//! What a device can do at most, measured by a small stage for each kind of work.

use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};

use super::super::shaders::{PEAK_FLOAT, PEAK_INTEGER, PEAK_MEMORY, PEAK_SHARED, peak_comp};
use crate::gpu::{Device, Groups, Memory, Timing, Work};

/// A number for each kind of work: a device's peaks a second, or parts of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Peaks {
    /// Operations on whole numbers and bits.
    pub integer: f64,
    /// Operations in floating point.
    pub float: f64,
    /// Bytes of buffers and images.
    pub memory: f64,
    /// Bytes of the shared memory of workgroups.
    pub shared: f64,
}

impl Peaks {
    /// What part of these peaks that work in so many seconds is.
    pub(super) fn part(&self, work: &Work, seconds: f64) -> Self {
        let part = |done: u64, peak: f64| if peak > 0.0 && seconds > 0.0 { done as f64 / seconds / peak } else { 0.0 };
        Self {
            integer: part(work.integer, self.integer),
            float: part(work.float, self.float),
            memory: part(work.memory(), self.memory),
            shared: part(work.shared, self.shared),
        }
    }

    /// The kind with the largest number, by name.
    pub fn largest(&self) -> (&'static str, f64) {
        let all = [("integer", self.integer), ("float", self.float), ("memory", self.memory), ("shared", self.shared)];
        all.into_iter().fold(("none", 0.0), |most, one| if one.1 > most.1 { one } else { most })
    }
}

/// Workgroups: more than any device has room for at once.
const GROUPS: u32 = 4096;
/// A run takes so long at least, so that starting it does not count.
const LEAST_MS: f64 = 20.0;
/// Runs whose shortest is told.
const RUNS: usize = 15;
/// Bytes of the buffer that is read, where the device has them: more than caches hold.
const DATA: u64 = 256 << 20;

/// Measures the peaks of a device; `counting` is the same one, whose stages count their work.
///
/// # Errors
/// When the device has no timestamps or no room, or fails.
pub(super) fn measure(device: &Device, counting: &Device) -> Result<Peaks> {
    let most = DATA.min(device.capabilities().max_storage).min(device.memory_available() / 4);
    let quads = 1_u32 << (most / 16).max(1).ilog2();
    let rate = |kind: u32, of: fn(&Work) -> u64| -> Result<f64> {
        let mut test = Test::new(device, kind, quads)?;
        let mut rounds = 1;
        while test.run(rounds)?.0 < LEAST_MS && rounds < 1 << 20 {
            rounds *= 2;
        }
        let mut ms = f64::INFINITY;
        for _ in 0..RUNS {
            ms = ms.min(test.run(rounds)?.0);
        }
        // Every round does the same, so two small runs tell what a large one does.
        let mut test = Test::new(counting, kind, 1)?;
        let mut done = |rounds: u32| -> Result<u64> { Ok(of(&test.run(rounds)?.1.unwrap_or_default())) };
        let (one, two) = (done(1)?, done(2)?);
        let all = one + (two - one) * u64::from(rounds - 1);
        Ok(all as f64 / (ms * 1e-3))
    };
    Ok(Peaks {
        integer: rate(PEAK_INTEGER, |work| work.integer)?,
        float: rate(PEAK_FLOAT, |work| work.float)?,
        memory: rate(PEAK_MEMORY, Work::memory)?,
        shared: rate(PEAK_SHARED, |work| work.shared)?,
    })
}

/// One kind of work on a device.
struct Test<'a> {
    device: &'a Device,
    kind: u32,
    data: crate::gpu::Buffer,
    result: crate::gpu::Buffer,
    quads: u32,
}

impl<'a> Test<'a> {
    fn new(device: &'a Device, kind: u32, quads: u32) -> Result<Self> {
        let quads = if kind == PEAK_MEMORY { quads } else { 1 };
        let data = device.buffer::<[u32; 4]>("peak data", quads as usize, Memory::Device)?;
        let invocations = (GROUPS * peak_comp::SHADER.workgroup_size[0]) as usize;
        let result = device.buffer::<u32>("peak results", invocations, Memory::Device)?;
        // Memory that was never written may have no place of its own yet.
        let mut recorder = device.recorder(Timing::Off)?;
        recorder.fill("peak data", &data, 0x0123_4567)?;
        recorder.finish()?.run()?;
        Ok(Self { device, kind, data, result, quads })
    }

    /// Milliseconds of so many rounds, and their work where it is counted.
    fn run(&mut self, rounds: u32) -> Result<(f64, Option<Work>)> {
        let mut recorder = self.device.recorder(Timing::Stamps)?;
        let bindings = peak_comp::Bindings { data: &self.data, result: &self.result };
        let stride = GROUPS * peak_comp::SHADER.workgroup_size[0];
        let push = peak_comp::Push { rounds, mask: self.quads - 1, stride };
        let constants = peak_comp::Constants { kind: self.kind };
        recorder.run(bindings.dispatch(constants, push, Groups::Count([GROUPS, 1, 1])))?;
        let mut recording = recorder.finish()?;
        recording.run()?;
        let timings = recording.timings()?;
        ensure!(
            !timings.is_empty(),
            "the device {} has no timestamps: nothing can be profiled",
            self.device.facts().name
        );
        Ok((timings[0].ms(), timings[0].work))
    }
}
