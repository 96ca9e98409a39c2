//! A recorded sequence of passes, submitted as often as wanted.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use anyhow::{Result, ensure};
use ash::vk;

use super::buffer::Buffer;
use super::device::Device;
use super::device_shared::DeviceShared;
use super::image::Image;
use super::lanes::note_use;
use super::pipeline::Pipeline;
use super::timing::{DevicePass, PassStatistics, PassTiming, on_host_clock, unwrapped};
use super::work::Work;

/// Passes ready to run. Each submission runs all of them in order; it keeps everything it uses alive until the device is done.
pub struct Recording {
    pub(super) device: Device,
    pub(super) parts: Option<RecordingParts>,
    /// Timeline value of the last submission, 0 before the first.
    pub(super) submitted: u64,
    /// Barriers between its passes.
    #[cfg(test)]
    pub(super) barriers: usize,
}

impl std::fmt::Debug for Recording {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Recording")
            .field("passes", &self.parts.as_ref().map(|p| p.passes.len()))
            .finish_non_exhaustive()
    }
}

/// What a recording holds, and what must outlive its run.
pub(super) struct RecordingParts {
    pub(super) device: Arc<DeviceShared>,
    /// Among those of the device.
    pub(super) number: u64,
    pub(super) pool: vk::CommandPool,
    /// The one being recorded, and those before it: each is a submission.
    pub(super) commands: vk::CommandBuffer,
    pub(super) ended: Vec<vk::CommandBuffer>,
    pub(super) descriptor_pools: Vec<vk::DescriptorPool>,
    pub(super) stamps: Option<vk::QueryPool>,
    pub(super) statistics: Option<vk::QueryPool>,
    /// One word a pass, set when it begins.
    pub(super) breadcrumbs: Option<Buffer>,
    /// Names of the passes in order.
    pub(super) passes: Vec<String>,
    /// What its passes count their work in.
    pub(super) counters: Vec<Counters>,
    pub(super) buffers: Vec<Buffer>,
    pub(super) images: Vec<Image>,
    pub(super) pipelines: Vec<Pipeline>,
}

/// How often each block of a pipeline's stages ran in a pass.
pub(super) struct Counters {
    pub(super) pass: usize,
    pub(super) pipeline: Pipeline,
    /// 64 bits a block.
    pub(super) buffer: Buffer,
}

impl Recording {
    /// Names of the passes in order.
    pub fn passes(&self) -> &[String] {
        self.parts.as_ref().map_or(&[], |parts| &parts.passes)
    }

    /// Barriers between the passes.
    #[cfg(test)]
    pub(crate) fn barriers(&self) -> usize {
        self.barriers
    }

    /// Hands the passes to the device and returns at once.
    ///
    /// # Errors
    /// [`super::DeviceLost`] when the device is gone; otherwise when this recording is still running, or the driver refuses.
    pub fn submit(&mut self) -> Result<()> {
        self.submit_behind(None)
    }

    /// The same behind the passes of another recording, both as one submission.
    ///
    /// # Errors
    /// As [`Self::submit`]; and when the two are for different queues.
    pub fn submit_behind(&mut self, ahead: Option<&mut Self>) -> Result<()> {
        let (device, lane) = (self.device.shared.clone(), self.device.lane);
        let mut all: Vec<&mut Self> = ahead.into_iter().chain([self]).collect();
        ensure!(
            all.iter().all(|one| one.device.lane == lane),
            "recordings for different queues cannot be one submission"
        );
        let mut submissions: Vec<Vec<vk::CommandBuffer>> = vec![Vec::new()];
        let (mut passes, mut after) = (Vec::new(), 0);
        for recording in &all {
            let Some(parts) = &recording.parts else { continue };
            // A command buffer runs once at a time.
            recording.wait()?;
            parts.set_back()?;
            // The first goes with what is ahead.
            let [first, more @ ..] = &*parts.commands_in_order() else { continue };
            submissions.iter_mut().last().into_iter().for_each(|last| last.push(*first));
            submissions.extend(more.iter().map(|one| vec![*one]));
            passes.extend(&parts.passes);
            let elsewhere = |buffer: &Buffer| buffer.shared.last_use[1 - lane].load(Ordering::Relaxed);
            after = parts.buffers.iter().map(elsewhere).fold(after, u64::max);
        }
        let submitted = device.submit(lane, &submissions, after, &passes)?;
        for recording in &mut all {
            recording.submitted = submitted;
            let buffers = recording.parts.iter().flat_map(|parts| &parts.buffers);
            buffers.for_each(|buffer| note_use(&buffer.shared.last_use, lane, submitted));
        }
        Ok(())
    }

    /// Waits until the device has run the last submission.
    ///
    /// # Errors
    /// [`super::DeviceLost`], with the last pass that had begun.
    pub fn wait(&self) -> Result<()> {
        if self.submitted == 0 {
            return Ok(());
        }
        let (begun, begun_by_lost) = (|| self.last_pass_begun(), || self.last_pass_begun_by_lost());
        self.device.shared.wait(self.device.lane, self.submitted, self.passes(), begun, begun_by_lost)
    }

    /// Runs all passes and waits for them.
    ///
    /// # Errors
    /// As [`Self::submit`] and [`Self::wait`].
    pub fn run(&mut self) -> Result<()> {
        self.run_behind(None)
    }

    /// The same behind the passes of another recording, both as one submission.
    ///
    /// # Errors
    /// As [`Self::submit_behind`] and [`Self::wait`].
    pub fn run_behind(&mut self, ahead: Option<&mut Self>) -> Result<()> {
        self.submit_behind(ahead)?;
        self.wait()
    }

    /// The last pass that left its mark, whether or not the device is at work.
    pub(super) fn last_pass_begun(&self) -> Option<usize> {
        let parts = self.parts.as_ref()?;
        let breadcrumbs = parts.breadcrumbs.as_ref()?;
        (0..parts.passes.len()).rev().find(|&pass| breadcrumbs.glance(pass).is_some_and(|mark| mark != 0))
    }

    /// The same of a device that is lost, which may tell more.
    pub(super) fn last_pass_begun_by_lost(&self) -> Option<usize> {
        let device = &self.device.shared;
        self.last_pass_begun().or_else(|| {
            let queue = device.lanes.queue(self.device.lane);
            device.marks.as_ref()?.last_begun(*queue, self.parts.as_ref()?.number)
        })
    }

    /// The times of all passes of the last run, which must have been waited for; empty when the recording does not measure.
    ///
    /// # Errors
    /// When the device fails.
    pub fn timings(&self) -> Result<Vec<PassTiming>> {
        let Some((parts, stamps)) = self.parts.as_ref().and_then(|parts| Some((parts, parts.stamps?))) else {
            return Ok(Vec::new());
        };
        if self.submitted == 0 || parts.passes.is_empty() {
            return Ok(Vec::new());
        }
        let device = &self.device.shared;
        let count = parts.passes.len();
        let mut ticks = vec![0_u64; 2 * count];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: the pool has two queries a pass, all written by the finished run, and the slice holds as many.
        unsafe { device.raw.get_query_pool_results(stamps, 0, &mut ticks, flags) }
            .map_err(|result| device.failure(result, "read its timestamps", || None))?;
        let mut counts = vec![[0_u64; 4]; count];
        if let Some(statistics) = parts.statistics {
            let mut of_compute = vec![0_u64; count];
            // SAFETY: as above, with four counts a query, or one on a queue without graphics.
            unsafe {
                if device.facts.capabilities.graphics {
                    device.raw.get_query_pool_results(statistics, 0, &mut counts, flags)
                } else {
                    device.raw.get_query_pool_results(statistics, 0, &mut of_compute, flags)
                }
            }
            .map_err(|result| device.failure(result, "read its statistics", || None))?;
            counts.iter_mut().zip(&of_compute).for_each(|(all, own)| all[3] = all[3].max(*own));
        }
        let mut work: Vec<Option<Work>> = vec![None; count];
        for Counters { pass, pipeline, buffer } in &parts.counters {
            let blocks = &pipeline.shared.blocks;
            let mut runs = vec![0_u64; blocks.len()];
            buffer.read(0, &mut runs)?;
            let own = work[*pass].get_or_insert_default();
            runs.iter().zip(blocks).for_each(|(&runs, block)| own.add(runs, block));
        }
        let capabilities = &device.facts.capabilities;
        let period = f64::from(capabilities.timestamp_period_ns);
        let ticks = unwrapped(&ticks, capabilities.timestamp_bits);
        Ok(parts
            .passes
            .iter()
            .enumerate()
            .map(|(pass, name)| PassTiming {
                name: name.clone(),
                start_ns: ticks[2 * pass] * period,
                end_ns: ticks[2 * pass + 1] * period,
                statistics: parts.statistics.map(|_| {
                    let [vertices, primitives, fragments, compute] = counts[pass];
                    PassStatistics { vertices, primitives, fragments, compute }
                }),
                work: work[pass],
            })
            .collect())
    }
}

impl Recording {
    /// The passes of the last run on the host's time axis; `end` is when the host had waited for it. Where the device has
    /// calibrated timestamps they say when, else the last pass is taken to end at `end`.
    ///
    /// # Errors
    /// When the device fails.
    pub fn passes_run(&self, end: Instant) -> Result<Vec<DevicePass>> {
        let timings = self.timings()?;
        if timings.is_empty() {
            return Ok(Vec::new());
        }
        let capabilities = self.device.capabilities();
        let range_ns = f64::from(capabilities.timestamp_period_ns) * f64::from(capabilities.timestamp_bits).exp2();
        Ok(on_host_clock(&timings, self.device.clock(), range_ns, end))
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        if let Some(parts) = self.parts.take()
            && !self.device.shared.has_done(self.device.lane, self.submitted)
        {
            self.device.shared.retire(self.device.lane, self.submitted, parts);
        }
    }
}

impl RecordingParts {
    /// Its command buffers, first to last.
    fn commands_in_order(&self) -> Vec<vk::CommandBuffer> {
        self.ended.iter().copied().chain([self.commands]).collect()
    }

    /// Sets what its passes leave beside their results to nothing.
    fn set_back(&self) -> Result<()> {
        if let Some(breadcrumbs) = &self.breadcrumbs {
            breadcrumbs.write(0, &vec![0_u32; self.passes.len()])?;
        }
        for Counters { pipeline, buffer, .. } in &self.counters {
            buffer.write(0, &vec![0_u64; pipeline.shared.blocks.len()])?;
        }
        Ok(())
    }

    /// Goes on in a new command buffer.
    pub(super) fn begin_commands(&mut self) -> Result<()> {
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        // SAFETY: the device is open and the pool one of it; the command buffer is new.
        unsafe {
            let made = self.device.raw.allocate_command_buffers(&info);
            self.commands = made.map_err(|result| self.device.failure(result, "make a command buffer", || None))?[0];
            let begun = self.device.raw.begin_command_buffer(self.commands, &vk::CommandBufferBeginInfo::default());
            begun.map_err(|result| self.device.failure(result, "begin a command buffer", || None))
        }
    }

    /// Ends the command buffer that is being recorded.
    pub(super) fn end_commands(&self) -> Result<()> {
        // SAFETY: recording.
        unsafe { self.device.raw.end_command_buffer(self.commands) }
            .map_err(|result| self.device.failure(result, "finish a command buffer", || None))
    }
}

impl Drop for RecordingParts {
    fn drop(&mut self) {
        // SAFETY: dropped only when never submitted, or when the device is done with it.
        unsafe {
            for pool in &self.descriptor_pools {
                self.device.raw.destroy_descriptor_pool(*pool, None);
            }
            for pool in [self.stamps, self.statistics].into_iter().flatten() {
                self.device.raw.destroy_query_pool(pool, None);
            }
            self.device.raw.destroy_command_pool(self.pool, None);
        }
    }
}
