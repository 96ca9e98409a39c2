//! An open device: its queue, memory, clock and what it is known to have lost.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow, bail};
use ash::{ext, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};

use crate::files::{Overwrite, write_atomically};

use super::capability::{Capabilities, DeviceFacts, devices};
use super::compiled::Compiled;
use super::instance::Instance;
use super::loss::DeviceLost;
use super::recording::RecordingParts;
use super::transform_feedback::FeedbackFunctions;
use super::validation::ValidationLog;

/// How a device is opened.
#[derive(Clone, Debug)]
pub struct DeviceSettings {
    /// Its place in Vulkan's list; without one, the best usable one by kind.
    pub index: Option<usize>,
    /// Changes what the device is taken to be capable of: how tests lower limits.
    pub lower: Option<fn(&mut Capabilities)>,
    /// Folder that keeps compiled pipelines between runs; without one they are compiled anew.
    pub pipeline_cache: Option<PathBuf>,
    /// Whether every pass leaves a mark that tells how far a lost device came.
    pub breadcrumbs: bool,
    /// How long a device may be at work without beginning another pass (or, without breadcrumbs, without coming to an end)
    /// before it is given up. Drivers reset a graphics card that hangs after seconds and say so; a software device may take
    /// minutes for one pass.
    pub patience: Duration,
    /// Lose the device, as a crash would, when it has run so many passes: a fault for tests to inject.
    pub lose_after_passes: Option<u64>,
}

impl Default for DeviceSettings {
    fn default() -> Self {
        Self {
            index: None,
            lower: None,
            pipeline_cache: None,
            breadcrumbs: true,
            patience: Duration::from_secs(600),
            lose_after_passes: None,
        }
    }
}

/// An open device; clones are the same device.
#[derive(Clone)]
pub struct Device {
    pub(super) shared: Arc<DeviceShared>,
    owner: Arc<Owner>,
}

/// What goes with the last handle, since it holds the device itself: the retirement queue is emptied then.
struct Owner {
    shared: Arc<DeviceShared>,
    compiled: Compiled,
}

pub(super) struct DeviceShared {
    pub(super) raw: ash::Device,
    pub(super) instance: Instance,
    pub(super) facts: DeviceFacts,
    pub(super) debug: Option<ext::debug_utils::Device>,
    pub(super) feedback: Option<FeedbackFunctions>,
    pub(super) settings: DeviceSettings,
    pub(super) allocator: Mutex<Option<Allocator>>,
    /// Bytes taken of `facts.capabilities.memory`.
    pub(super) memory_used: AtomicU64,
    pub(super) pipelines: vk::PipelineCache,
    pub(super) timeline: vk::Semaphore,
    queue: Mutex<vk::Queue>,
    /// Value the timeline takes when the last submission is done.
    submitted: AtomicU64,
    passes_run: AtomicU64,
    /// Whether nothing more may be run on it.
    is_lost: AtomicBool,
    /// Whether it is lost because it was given up: it may still be at work, and nothing that it uses is ever freed.
    is_given_up: AtomicBool,
    /// Recordings that were dropped while the device ran them, and the timeline value that ends that.
    retired: Mutex<Vec<(u64, RecordingParts)>>,
    calibrated: Option<ext::calibrated_timestamps::Device>,
}

impl std::fmt::Debug for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Device").field("name", &self.shared.facts.name).finish_non_exhaustive()
    }
}

/// A moment on the device's clock and on the host's.
#[derive(Clone, Copy, Debug)]
pub struct ClockPair {
    /// Device time, nanoseconds from an arbitrary start.
    pub device_ns: f64,
    /// The same moment on the host.
    pub host: Instant,
}

impl Device {
    /// Opens a device.
    ///
    /// # Errors
    /// When there is no usable device (the reasons are in the sentence), or it cannot be opened.
    pub fn open(instance: &Instance, settings: DeviceSettings) -> Result<Self> {
        let found = devices(instance)?;
        let mut facts = match settings.index {
            Some(index) => {
                let count = found.len();
                let Some(facts) = found.into_iter().nth(index) else {
                    bail!("there is no Vulkan device {index}: this machine has {count}, counted from 0");
                };
                if !facts.usable {
                    bail!("the Vulkan device {} cannot be used: {}", facts.name, facts.reasons.join("; "));
                }
                facts
            }
            None => {
                let why: Vec<String> =
                    found.iter().map(|facts| format!("{}: {}", facts.name, facts.reasons.join("; "))).collect();
                let Some(facts) = found.into_iter().filter(|facts| facts.usable).min_by_key(|facts| facts.kind) else {
                    if why.is_empty() {
                        bail!("Vulkan finds no device on this machine: install a driver (Debian: mesa-vulkan-drivers)");
                    }
                    bail!("no Vulkan device of this machine can be used: {}", why.join("; "));
                };
                facts
            }
        };
        if let Some(lower) = settings.lower {
            lower(&mut facts.capabilities);
        }
        Self::open_with(instance, facts, settings)
    }

    fn open_with(instance: &Instance, facts: DeviceFacts, settings: DeviceSettings) -> Result<Self> {
        let capabilities = facts.capabilities;
        let mut extensions = Vec::new();
        if capabilities.transform_feedback {
            extensions.push(ext::transform_feedback::NAME.as_ptr());
        }
        if capabilities.calibrated_timestamps {
            extensions.push(ext::calibrated_timestamps::NAME.as_ptr());
        }
        let core = vk::PhysicalDeviceFeatures::default()
            .geometry_shader(capabilities.geometry_shader)
            .pipeline_statistics_query(capabilities.pipeline_statistics)
            .vertex_pipeline_stores_and_atomics(capabilities.vertex_stores)
            .fragment_stores_and_atomics(capabilities.fragment_stores);
        let mut vulkan_12 = vk::PhysicalDeviceVulkan12Features::default().timeline_semaphore(true);
        let mut vulkan_13 =
            vk::PhysicalDeviceVulkan13Features::default().dynamic_rendering(true).synchronization2(true);
        let mut feedback = vk::PhysicalDeviceTransformFeedbackFeaturesEXT::default().transform_feedback(true);
        let priorities = [1.0];
        let queues =
            [vk::DeviceQueueCreateInfo::default().queue_family_index(facts.queue_family).queue_priorities(&priorities)];
        let mut info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .enabled_features(&core)
            .push_next(&mut vulkan_12)
            .push_next(&mut vulkan_13);
        if capabilities.transform_feedback {
            info = info.push_next(&mut feedback);
        }
        let vulkan = &instance.shared.raw;
        // SAFETY: the handle belongs to the instance; features and extensions asked for were found present.
        let raw = unsafe { vulkan.create_device(facts.handle, &info, None) }
            .map_err(|result| anyhow!("the Vulkan device {} cannot be opened ({result})", facts.name))?;
        let fail = |what: &str, error: &dyn std::fmt::Display| {
            // SAFETY: nothing was made of the device yet, or it was destroyed before.
            unsafe { raw.destroy_device(None) };
            anyhow!("the Vulkan device {} gives no {what} ({error})", facts.name)
        };
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: vulkan.clone(),
            device: raw.clone(),
            physical_device: facts.handle,
            debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: gpu_allocator::AllocationSizes::default(),
        })
        .map_err(|error| fail("memory", &error))?;
        let mut kind = vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
        // SAFETY: the device is open; so for the calls below.
        let timeline = unsafe { raw.create_semaphore(&vk::SemaphoreCreateInfo::default().push_next(&mut kind), None) };
        let timeline = match timeline {
            Ok(timeline) => timeline,
            Err(error) => {
                drop(allocator);
                return Err(fail("semaphore", &error));
            }
        };
        // SAFETY: the family was found on this device, and one queue of it was asked for.
        let queue = unsafe { raw.get_device_queue(facts.queue_family, 0) };
        let saved = settings.pipeline_cache.as_ref().and_then(|folder| fs::read(cache_file(folder, &facts)).ok());
        let info = vk::PipelineCacheCreateInfo::default().initial_data(saved.as_deref().unwrap_or_default());
        // A driver refuses data that is not its own, and no cache is as good as an empty one.
        // SAFETY: the data is a byte slice that lives through the call, and drivers check its header.
        let pipelines = unsafe { raw.create_pipeline_cache(&info, None) }.unwrap_or(vk::PipelineCache::null());
        let shared = Arc::new(DeviceShared {
            debug: instance.shared.has_debug_utils.then(|| ext::debug_utils::Device::new(vulkan, &raw)),
            feedback: capabilities.transform_feedback.then(|| FeedbackFunctions::load(vulkan, &raw)).flatten(),
            calibrated: capabilities
                .calibrated_timestamps
                .then(|| ext::calibrated_timestamps::Device::new(vulkan, &raw)),
            raw,
            instance: instance.clone(),
            facts,
            settings,
            allocator: Mutex::new(Some(allocator)),
            memory_used: AtomicU64::new(0),
            pipelines,
            timeline,
            queue: Mutex::new(queue),
            submitted: AtomicU64::new(0),
            passes_run: AtomicU64::new(0),
            is_lost: AtomicBool::new(false),
            is_given_up: AtomicBool::new(false),
            retired: Mutex::new(Vec::new()),
        });
        let owner = Owner { shared: shared.clone(), compiled: Compiled::default() };
        Ok(Self { owner: Arc::new(owner), shared })
    }

    pub(super) fn compiled(&self) -> &Compiled {
        &self.owner.compiled
    }

    /// What it is and why it can be used.
    pub fn facts(&self) -> &DeviceFacts {
        &self.shared.facts
    }

    /// What it can do, as lowered by the settings.
    pub fn capabilities(&self) -> &Capabilities {
        &self.shared.facts.capabilities
    }

    /// The validation log of its instance.
    pub fn validation_log(&self) -> ValidationLog {
        self.shared.instance.validation_log()
    }

    /// Bytes of memory that can still be taken: its free budget, as far as the driver tells, within the engine's share.
    pub fn memory_available(&self) -> u64 {
        let own = self.shared.facts.capabilities.memory.saturating_sub(self.shared.memory_used.load(Ordering::Relaxed));
        if !self.shared.facts.has_memory_budget {
            return own;
        }
        let mut budget = vk::PhysicalDeviceMemoryBudgetPropertiesEXT::default();
        let mut properties = vk::PhysicalDeviceMemoryProperties2::default().push_next(&mut budget);
        // SAFETY: the handle belongs to the instance, and the device has the extension.
        unsafe {
            self.shared
                .instance
                .shared
                .raw
                .get_physical_device_memory_properties2(self.shared.facts.handle, &mut properties);
        }
        let memory = properties.memory_properties;
        let free = (0..memory.memory_heap_count as usize)
            .filter(|&heap| memory.memory_heaps[heap].flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL))
            .map(|heap| budget.heap_budget[heap].saturating_sub(budget.heap_usage[heap]))
            .max()
            .unwrap_or(own);
        own.min(free)
    }

    /// The device's clock beside the host's, where it has calibrated timestamps.
    pub fn clock(&self) -> Option<ClockPair> {
        let functions = self.shared.calibrated.as_ref()?;
        let domain = [vk::CalibratedTimestampInfoEXT::default().time_domain(vk::TimeDomainEXT::DEVICE)];
        let period = f64::from(self.shared.facts.capabilities.timestamp_period_ns);
        // The quickest of three: another thread may have had the processor between the two clocks.
        let pairs = (0..3).filter_map(|_| {
            let before = Instant::now();
            // SAFETY: the extension is enabled and offers the domain.
            let (ticks, _) = unsafe { functions.get_calibrated_timestamps(&domain) }.ok()?;
            let between = before.elapsed();
            Some((between, ClockPair { device_ns: *ticks.first()? as f64 * period, host: before + between / 2 }))
        });
        pairs.min_by_key(|(between, _)| *between).map(|(_, pair)| pair)
    }
}

impl DeviceShared {
    /// Submits a command buffer that runs `passes`. Gives the timeline value that marks its end.
    pub(super) fn submit(&self, commands: vk::CommandBuffer, passes: &[String]) -> Result<u64> {
        self.check_alive()?;
        let before = self.passes_run.fetch_add(passes.len() as u64, Ordering::Relaxed);
        if let Some(limit) = self.settings.lose_after_passes
            && before + passes.len() as u64 > limit
        {
            let pass = passes.get(limit.saturating_sub(before) as usize).cloned();
            // A crash leaves nothing running: let go of what was submitted before.
            let queue = lock(&self.queue);
            // SAFETY: the device is open, and its one queue is locked while this waits.
            let _ = unsafe { self.raw.device_wait_idle() };
            drop(queue);
            return Err(self.lose(pass).into());
        }
        self.collect();
        let queue = lock(&self.queue);
        let value = self.submitted.load(Ordering::Relaxed) + 1;
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
        let signal = [vk::SemaphoreSubmitInfo::default()
            .semaphore(self.timeline)
            .value(value)
            .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands).signal_semaphore_infos(&signal)];
        // SAFETY: the queue is locked; the recording keeps its command buffer and all it uses until the value is reached.
        unsafe { self.raw.queue_submit2(*queue, &submit, vk::Fence::null()) }
            .map_err(|result| self.failure(result, "submit work", || passes.first().cloned()))?;
        self.submitted.store(value, Ordering::Relaxed);
        Ok(value)
    }

    /// Waits until the timeline has reached `value`, as long as the device gets on. `begun` tells the last one of `passes` that
    /// has begun.
    pub(super) fn wait(&self, value: u64, passes: &[String], begun: impl Fn() -> Option<usize>) -> Result<()> {
        const LOOK_EVERY: Duration = Duration::from_secs(1);
        self.check_alive()?;
        let patience = self.settings.patience;
        let between_looks = patience.min(LOOK_EVERY).as_nanos() as u64;
        let (semaphores, values) = ([self.timeline], [value]);
        let info = vk::SemaphoreWaitInfo::default().semaphores(&semaphores).values(&values);
        let last_pass = || begun().and_then(|pass| passes.get(pass).cloned());
        // The breadcrumbs are first read when the first look is due: most work is done by then.
        let (mut seen, mut since) = (None, Instant::now());
        loop {
            // SAFETY: the semaphore is a timeline of this device.
            match unsafe { self.raw.wait_semaphores(&info, between_looks) } {
                Ok(()) => return Ok(()),
                Err(vk::Result::TIMEOUT) => {}
                Err(result) => return Err(self.failure(result, "finish its work", last_pass)),
            }
            let now = begun();
            if now != seen {
                (seen, since) = (now, Instant::now());
            } else if since.elapsed() >= patience {
                self.is_given_up.store(true, Ordering::Relaxed);
                return Err(DeviceLost { given_up_after: Some(patience), ..self.lose(last_pass()) }.into());
            }
        }
    }

    /// Whether the device has done everything up to `value`, or never will.
    pub(super) fn has_done(&self, value: u64) -> bool {
        // SAFETY: the semaphore is a timeline of this device.
        unsafe { self.raw.get_semaphore_counter_value(self.timeline) }.is_ok_and(|done| done >= value)
            || self.is_lost.load(Ordering::Relaxed) && !self.is_given_up.load(Ordering::Relaxed)
    }

    /// Keeps what a recording held until the device is done with it.
    pub(super) fn retire(&self, value: u64, parts: RecordingParts) {
        lock(&self.retired).push((value, parts));
    }

    /// Drops the recordings that the device is done with.
    fn collect(&self) {
        let done: Vec<_> = {
            let mut retired = lock(&self.retired);
            if retired.is_empty() {
                return;
            }
            let (done, waiting) = retired.drain(..).partition(|(value, _)| self.has_done(*value));
            *retired = waiting;
            done
        };
        // Outside of the lock: dropping frees memory, which may come back here.
        drop(done);
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
            let path = cache_file(folder, &self.facts);
            write_atomically(&path, Overwrite::Replace, |file| Ok(file.write_all(&data)?))
        });
    }
}

/// The pipeline cache of a device and driver: another driver version has another file.
fn cache_file(folder: &std::path::Path, facts: &DeviceFacts) -> PathBuf {
    let plain: String = format!("{} {}", facts.name, facts.driver)
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || c == '.' { c.to_ascii_lowercase() } else { '-' })
        .collect();
    folder.join(format!("pipelines-{plain}.bin"))
}

impl Drop for Owner {
    fn drop(&mut self) {
        // What a device that was given up still uses stays for good: the recordings left in its queue hold it.
        if !self.shared.is_given_up.load(Ordering::Relaxed) {
            // SAFETY: no other thread holds the device's queue: this was its last handle. Failing means lost, so idle too.
            if unsafe { self.shared.raw.device_wait_idle() }.is_err() {
                self.shared.is_lost.store(true, Ordering::Relaxed);
            }
        }
        self.shared.collect();
    }
}

impl Drop for DeviceShared {
    fn drop(&mut self) {
        // SAFETY: every resource and pipeline holds this struct, so all are gone, and the device is idle since `Owner`
        // went or the last recording was waited for.
        unsafe {
            let _ = self.raw.device_wait_idle();
            self.save_pipelines();
            self.raw.destroy_pipeline_cache(self.pipelines, None);
            self.raw.destroy_semaphore(self.timeline, None);
            drop(lock(&self.allocator).take());
            self.raw.destroy_device(None);
        }
    }
}

/// A panic elsewhere leaves these values whole: each is replaced or read in one step.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
