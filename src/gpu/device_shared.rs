//! An open device as everything made on it holds it: its queues, its memory's account, and what it is known to have lost.

use std::any::Any;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow};
use ash::{ext, khr, vk};
use gpu_allocator::vulkan::Allocator;

use crate::files::{Overwrite, write_atomically};

use super::capability::{Capabilities, DeviceFacts};
use super::instance::Instance;
use super::lanes::{Lanes, LastUse};
use super::lock::{loader, lock};
use super::loss::DeviceLost;
use super::marks::Marks;
#[cfg(test)]
use super::rough::Change;
use super::transform_feedback::FeedbackFunctions;

/// When passes leave marks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Breadcrumbs {
    /// Where that costs next to nothing: on devices with VK_AMD_buffer_marker or VK_NV_device_diagnostic_checkpoints.
    #[default]
    WhereCheap,
    /// Always, elsewhere by a fill of four bytes a pass.
    Always,
}

/// What a device tells of the stages that it runs, beside their times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Inspect {
    /// Nothing.
    #[default]
    Nothing,
    /// What its driver made of them ([`super::Device::compiled`]), where it has VK_KHR_pipeline_executable_properties.
    Compiled,
    /// What they do ([`super::PassTiming::work`]). They take several times as long.
    Work,
}

/// How a device is opened.
#[derive(Clone, Debug)]
pub struct DeviceSettings {
    /// Its place in Vulkan's list; without one, the best usable one by kind.
    pub index: Option<usize>,
    /// Changes what the device is taken to be capable of: how tests lower limits.
    pub lower: Option<fn(&mut Capabilities)>,
    /// Folder that keeps compiled pipelines between runs; without one they are compiled anew.
    pub pipeline_cache: Option<PathBuf>,
    /// Whether passes leave marks that tell how far a lost device came.
    pub breadcrumbs: Breadcrumbs,
    /// Whether the graphics pipeline is wanted; without, a queue for compute alone is taken where there is one.
    pub graphics: bool,
    /// How long a device may be at work without beginning another pass (or, without breadcrumbs, without coming to an end)
    /// before it is given up. Drivers reset a graphics card that hangs after seconds and say so; a software device may take
    /// minutes for one pass.
    pub patience: Duration,
    /// Lose the device, as a crash would, when it has run so many passes: a fault for tests to inject.
    pub lose_after_passes: Option<u64>,
    /// What it tells of the stages it runs.
    pub inspect: Inspect,
    /// Functions in place of VK_NV_device_diagnostic_checkpoints.
    #[cfg(test)]
    pub(crate) checkpoints: Option<fn() -> ash::nv::device_diagnostic_checkpoints::DeviceFn>,
    /// Changes the code of stages before they are compiled: how tests make a device inexact.
    #[cfg(test)]
    pub(crate) code: Option<Change>,
}

impl Default for DeviceSettings {
    fn default() -> Self {
        Self {
            index: None,
            lower: None,
            pipeline_cache: None,
            breadcrumbs: Breadcrumbs::default(),
            graphics: true,
            patience: Duration::from_secs(600),
            lose_after_passes: None,
            inspect: Inspect::default(),
            #[cfg(test)]
            checkpoints: None,
            #[cfg(test)]
            code: None,
        }
    }
}

/// What a recording held, and the value of its lane's timeline from which on the device is done with it.
pub(super) struct Retired {
    lane: usize,
    value: u64,
    _parts: Box<dyn Any + Send>,
}

/// What all handles of an open device share.
pub(super) struct DeviceShared {
    pub(super) raw: ash::Device,
    pub(super) instance: Instance,
    pub(super) facts: DeviceFacts,
    pub(super) debug: Option<ext::debug_utils::Device>,
    pub(super) feedback: Option<FeedbackFunctions>,
    pub(super) marks: Option<Marks>,
    /// Recordings so far, each of which has its number.
    pub(super) recordings: AtomicU64,
    pub(super) settings: DeviceSettings,
    pub(super) allocator: Mutex<Option<Allocator>>,
    /// Bytes taken of `facts.capabilities.memory`.
    pub(super) memory_used: AtomicU64,
    pub(super) pipelines: vk::PipelineCache,
    pub(super) lanes: Lanes,
    /// Nanoseconds that a pass took on average in the slowest recording so far.
    pub(super) pass_time: AtomicU64,
    pub(super) passes_run: AtomicU64,
    /// Whether nothing more may be run on it.
    pub(super) is_lost: AtomicBool,
    /// Whether it is lost because it was given up: it may still be at work, and nothing that it uses is ever freed.
    pub(super) is_given_up: AtomicBool,
    /// Recordings that were dropped while the device ran them.
    pub(super) retired: Mutex<Vec<Retired>>,
    pub(super) calibrated: Option<ext::calibrated_timestamps::Device>,
    /// Where the driver is asked what it made of stages.
    pub(super) executables: Option<khr::pipeline_executable_properties::Device>,
}

impl DeviceShared {
    /// Submits command buffers that run `passes` on a lane, one submission after the other, the first one when the other lane has
    /// come to `after`. Gives the value of the lane's timeline that marks their end.
    pub(super) fn submit(
        &self,
        lane: usize,
        submissions: &[Vec<vk::CommandBuffer>],
        after: u64,
        passes: &[&String],
    ) -> Result<u64> {
        self.check_alive()?;
        let before = self.passes_run.fetch_add(passes.len() as u64, Ordering::Relaxed);
        if let Some(limit) = self.settings.lose_after_passes
            && before + passes.len() as u64 > limit
        {
            let pass = passes.get(limit.saturating_sub(before) as usize).map(|pass| (*pass).clone());
            // A crash leaves nothing running: let go of what was submitted before.
            let queues = self.lanes.every_queue();
            // SAFETY: the device is open, and its queues are locked while this waits.
            let _ = unsafe { self.raw.device_wait_idle() };
            drop(queues);
            return Err(self.lose(pass).into());
        }
        self.collect();
        let queue = self.lanes.queue(lane);
        let [own, other] = [lane, 1 - lane].map(|lane| self.lanes.of(lane));
        let mut value = own.submitted.load(Ordering::Relaxed);
        let mut waits = vec![reached(other.timeline, after)];
        waits.retain(|_| after > 0);
        for commands in submissions {
            value += 1;
            let commands: Vec<_> =
                commands.iter().map(|one| vk::CommandBufferSubmitInfo::default().command_buffer(*one)).collect();
            let signal = [reached(own.timeline, value)];
            let submit = [vk::SubmitInfo2::default()
                .wait_semaphore_infos(&waits)
                .command_buffer_infos(&commands)
                .signal_semaphore_infos(&signal)];
            // SAFETY: the queue is locked; the recording keeps its command buffers and all they use until the value is reached. What
            // it waits for was submitted before.
            unsafe { self.raw.queue_submit2(*queue, &submit, vk::Fence::null()) }
                .map_err(|result| self.failure(result, "submit work", || passes.first().map(|pass| (*pass).clone())))?;
            own.submitted.store(value, Ordering::Relaxed);
            waits.clear();
        }
        Ok(value)
    }

    /// Most passes of a submission, so that it is not at work for too long, by what passes have taken so far.
    pub(super) fn passes_a_submission(&self) -> usize {
        /// What a pass is taken to need before any has run: few on a graphics card need as much.
        const AT_FIRST: Duration = Duration::from_millis(2);
        let Some(longest) = self.facts.capabilities.longest_submission else { return usize::MAX };
        let pass = Duration::from_nanos(self.pass_time.load(Ordering::Relaxed)).max(AT_FIRST);
        (longest.as_nanos() / pass.as_nanos()).max(1) as usize
    }

    /// Takes note of how long a recording of so many passes was waited for.
    pub(super) fn note_pass_time(&self, taken: Duration, passes: usize) {
        let each = taken.as_nanos() as u64 / passes.max(1) as u64;
        self.pass_time.fetch_max(each, Ordering::Relaxed);
    }

    /// Waits until a lane's timeline has reached `value`, as long as the device gets on. `begun` tells the last one of `passes` that
    /// has begun; `begun_by_lost` does so of a device that is lost.
    pub(super) fn wait(
        &self,
        lane: usize,
        value: u64,
        passes: &[String],
        begun: impl Fn() -> Option<usize>,
        begun_by_lost: impl Fn() -> Option<usize>,
    ) -> Result<()> {
        const LOOK_EVERY: Duration = Duration::from_secs(1);
        self.check_alive()?;
        let patience = self.settings.patience;
        let between_looks = patience.min(LOOK_EVERY).as_nanos() as u64;
        let (semaphores, values) = ([self.lanes.of(lane).timeline], [value]);
        let info = vk::SemaphoreWaitInfo::default().semaphores(&semaphores).values(&values);
        let name = |pass: Option<usize>| pass.and_then(|pass| passes.get(pass).cloned());
        // The breadcrumbs are first read when the first look is due: most work is done by then.
        let (mut seen, mut since, begin) = (None, Instant::now(), Instant::now());
        loop {
            // SAFETY: the semaphore is a timeline of this device.
            match unsafe { self.raw.wait_semaphores(&info, between_looks) } {
                Ok(()) => {
                    // At least so long: the host may have come late.
                    self.note_pass_time(begin.elapsed(), passes.len());
                    return Ok(());
                }
                Err(vk::Result::TIMEOUT) => {}
                Err(result) => return Err(self.failure(result, "finish its work", || name(begun_by_lost()))),
            }
            let now = begun();
            if now != seen {
                (seen, since) = (now, Instant::now());
            } else if since.elapsed() >= patience {
                self.is_given_up.store(true, Ordering::Relaxed);
                return Err(DeviceLost { given_up_after: Some(patience), ..self.lose(name(begun())) }.into());
            }
        }
    }

    /// Whether the device has done everything on a lane up to `value`, or never will.
    pub(super) fn has_done(&self, lane: usize, value: u64) -> bool {
        // SAFETY: the semaphore is a timeline of this device.
        value == 0
            || unsafe { self.raw.get_semaphore_counter_value(self.lanes.of(lane).timeline) }
                .is_ok_and(|done| done >= value)
            || self.is_lost.load(Ordering::Relaxed) && !self.is_given_up.load(Ordering::Relaxed)
    }

    /// Whether it has done everything that used something.
    pub(super) fn has_done_all(&self, last_use: &LastUse) -> bool {
        last_use.iter().enumerate().all(|(lane, value)| self.has_done(lane, value.load(Ordering::Relaxed)))
    }

    /// Keeps what a recording held until the device is done with it.
    pub(super) fn retire(&self, lane: usize, value: u64, parts: impl Any + Send) {
        lock(&self.retired).push(Retired { lane, value, _parts: Box::new(parts) });
    }

    /// Drops the recordings that the device is done with.
    pub(super) fn collect(&self) {
        let done: Vec<_> = {
            let mut retired = lock(&self.retired);
            if retired.is_empty() {
                return;
            }
            let (done, waiting) = retired.drain(..).partition(|one| self.has_done(one.lane, one.value));
            *retired = waiting;
            done
        };
        // Outside of the lock: dropping frees memory, which may come back here.
        drop(done);
    }

    /// Whether passes leave marks in a buffer.
    pub(super) fn leaves_breadcrumbs(&self) -> bool {
        matches!(self.marks, Some(Marks::Words(_))) || self.settings.breadcrumbs == Breadcrumbs::Always
    }

    /// An error if the device has been lost.
    pub(super) fn check_alive(&self) -> Result<()> {
        if self.is_lost.load(Ordering::Relaxed) {
            return Err(self.lost(None).into());
        }
        Ok(())
    }

    fn lose(&self, pass: Option<String>) -> DeviceLost {
        self.is_lost.store(true, Ordering::Relaxed);
        self.lost(pass)
    }

    fn lost(&self, pass: Option<String>) -> DeviceLost {
        DeviceLost { device: self.facts.name.clone(), pass, given_up_after: None }
    }

    /// The error of a Vulkan call that should have let the device `purpose`.
    pub(super) fn failure(
        &self,
        result: vk::Result,
        purpose: &str,
        pass: impl FnOnce() -> Option<String>,
    ) -> anyhow::Error {
        if result == vk::Result::ERROR_DEVICE_LOST {
            return self.lose(pass()).into();
        }
        anyhow!("the Vulkan device {} failed to {purpose} ({result})", self.facts.name)
    }

    /// Gives an object the name that capture tools and the validation layer show.
    pub(super) fn name(&self, handle: impl vk::Handle, name: &str) {
        if let Some(debug) = &self.debug
            && let Ok(name) = std::ffi::CString::new(name)
        {
            let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
            // SAFETY: the handle is one of this device and the name lives through the call. A failure costs the name only.
            let _ = unsafe { debug.set_debug_utils_object_name(&info) };
        }
    }

    fn save_pipelines(&self) {
        let Some(folder) = &self.settings.pipeline_cache else { return };
        // SAFETY: the cache belongs to this device.
        let Ok(data) = (unsafe { self.raw.get_pipeline_cache_data(self.pipelines) }) else { return };
        // A cache that cannot be kept costs time in the next run, nothing else.
        let _ = fs::create_dir_all(folder).map_err(anyhow::Error::from).and_then(|()| {
            let path = kept_file(folder, &self.facts, PIPELINES);
            write_atomically(&path, Overwrite::Replace, |file| Ok(file.write_all(&data)?))
        });
    }
}

/// Kind and ending of the file of compiled pipelines.
pub(super) const PIPELINES: [&str; 2] = ["pipelines", "bin"];

/// A file of a device and driver: another driver version has another one.
pub(crate) fn kept_file(folder: &Path, facts: &DeviceFacts, [kind, ending]: [&str; 2]) -> PathBuf {
    let plain: String = format!("{} {}", facts.name, facts.driver)
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || c == '.' { c.to_ascii_lowercase() } else { '-' })
        .collect();
    folder.join(format!("{kind}-{plain}.{ending}"))
}

impl Drop for DeviceShared {
    fn drop(&mut self) {
        // SAFETY: every resource and pipeline holds this struct, so all are gone, and the device is idle since `Owner`
        // went or the last recording was waited for.
        unsafe {
            let _ = self.raw.device_wait_idle();
            self.save_pipelines();
            self.raw.destroy_pipeline_cache(self.pipelines, None);
            self.lanes.all().iter().for_each(|lane| self.raw.destroy_semaphore(lane.timeline, None));
            drop(lock(&self.allocator).take());
            let _alone = loader();
            self.raw.destroy_device(None);
        }
    }
}

/// The moment when everything before has brought a timeline to `value`.
fn reached(timeline: vk::Semaphore, value: u64) -> vk::SemaphoreSubmitInfo<'static> {
    let all = vk::PipelineStageFlags2::ALL_COMMANDS;
    vk::SemaphoreSubmitInfo::default().semaphore(timeline).value(value).stage_mask(all)
}
