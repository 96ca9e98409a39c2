//! A recorded sequence of passes, submitted as often as wanted.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use anyhow::Result;
use ash::vk;

use super::buffer::Buffer;
use super::device::Device;
use super::device_shared::DeviceShared;
use super::image::Image;
use super::pipeline::Pipeline;
use super::timing::{DevicePass, PassStatistics, PassTiming, on_host_clock};

/// Passes ready to run. Each submission runs all of them in order; it keeps everything it uses alive until the device is done.
pub struct Recording {
    pub(super) device: Device,
    pub(super) parts: Option<RecordingParts>,
    /// Timeline value of the last submission, 0 before the first.
    pub(super) submitted: u64,
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
    pub(super) pool: vk::CommandPool,
    pub(super) commands: vk::CommandBuffer,
    pub(super) descriptor_pools: Vec<vk::DescriptorPool>,
    pub(super) stamps: Option<vk::QueryPool>,
    pub(super) statistics: Option<vk::QueryPool>,
    /// One word a pass, set when it begins.
    pub(super) breadcrumbs: Option<Buffer>,
    /// Names of the passes in order.
    pub(super) passes: Vec<String>,
    pub(super) buffers: Vec<Buffer>,
    pub(super) images: Vec<Image>,
    pub(super) pipelines: Vec<Pipeline>,
}

impl Recording {
    /// Names of the passes in order.
    pub fn passes(&self) -> &[String] {
        self.parts.as_ref().map_or(&[], |parts| &parts.passes)
    }

    /// Hands the passes to the device and returns at once.
    ///
    /// # Errors
    /// [`super::DeviceLost`] when the device is gone; otherwise when this recording is still running, or the driver refuses.
    pub fn submit(&mut self) -> Result<()> {
        let Some(parts) = &self.parts else { return Ok(()) };
        // A command buffer runs once at a time.
        self.wait()?;
        if let Some(breadcrumbs) = &parts.breadcrumbs {
            breadcrumbs.write(0, &vec![0_u32; parts.passes.len()])?;
        }
        self.submitted = self.device.shared.submit(parts.commands, &parts.passes)?;
        for buffer in &parts.buffers {
            buffer.shared.last_use.store(self.submitted, Ordering::Relaxed);
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
        let begun = || self.last_pass_begun();
        self.device.shared.wait(self.submitted, self.passes(), begun)
    }

    /// Runs all passes and waits for them.
    ///
    /// # Errors
    /// As [`Self::submit`] and [`Self::wait`].
    pub fn run(&mut self) -> Result<()> {
        self.submit()?;
        self.wait()
    }

    /// The last pass that left its mark, whether or not the device is at work.
    fn last_pass_begun(&self) -> Option<usize> {
        let parts = self.parts.as_ref()?;
        let breadcrumbs = parts.breadcrumbs.as_ref()?;
        (0..parts.passes.len()).rev().find(|&pass| breadcrumbs.glance(pass).is_some_and(|mark| mark != 0))
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
            // SAFETY: as above, with four counts a query.
            unsafe { device.raw.get_query_pool_results(statistics, 0, &mut counts, flags) }
                .map_err(|result| device.failure(result, "read its statistics", || None))?;
        }
        let period = f64::from(device.facts.capabilities.timestamp_period_ns);
        Ok(parts
            .passes
            .iter()
            .enumerate()
            .map(|(pass, name)| PassTiming {
                name: name.clone(),
                start_ns: ticks[2 * pass] as f64 * period,
                end_ns: ticks[2 * pass + 1] as f64 * period,
                statistics: parts.statistics.map(|_| {
                    let [vertices, primitives, fragments, compute] = counts[pass];
                    PassStatistics { vertices, primitives, fragments, compute }
                }),
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
        Ok(if timings.is_empty() { Vec::new() } else { on_host_clock(&timings, self.device.clock(), end) })
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        if let Some(parts) = self.parts.take()
            && !self.device.shared.has_done(self.submitted)
        {
            self.device.shared.retire(self.submitted, parts);
        }
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
