//! An open device: its queue, memory, clock and what it is known to have lost.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use anyhow::{Result, anyhow, bail, ensure};
use ash::{amd, ext, khr, nv, vk};
use bytemuck::Pod;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use rayon::prelude::*;

use super::buffer::Buffer;
use super::capability::{Capabilities, DeviceFacts, PORTABILITY_SUBSET, QueuePlace, devices};
use super::compiled::{Compiled, Source};
use super::device_shared::{DeviceSettings, DeviceShared, Inspect, PIPELINES, kept_file};
use super::executables::Executable;
use super::fixed_function::Drawing;
use super::image::{Format, Image, ImageUse};
use super::instance::Instance;
use super::lanes::{BESIDE, LANES, Lanes, MAIN};
use super::lock::loader;
use super::marks::Marks;
use super::memory::Memory;
use super::pipeline::Pipeline;
use super::shader::ShaderStage;
use super::timing::{ClockPair, tick_mask};
use super::transform_feedback::FeedbackFunctions;
use super::validation::ValidationLog;

/// An open device; clones are the same device.
#[derive(Clone)]
pub struct Device {
    pub(super) shared: Arc<DeviceShared>,
    owner: Arc<Owner>,
    /// Where its recordings go in.
    pub(super) lane: usize,
}

/// What goes with the last handle, since it holds the device itself: the retirement queue is emptied then.
struct Owner {
    shared: Arc<DeviceShared>,
    compiled: Compiled,
}

impl std::fmt::Debug for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Device").field("name", &self.shared.facts.name).finish_non_exhaustive()
    }
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
        let [both, compute] = facts.queues;
        let queue = both.filter(|_| settings.graphics && facts.capabilities.graphics).or(compute);
        let Some(queue) = queue else { bail!("the Vulkan device {} has no queue for compute", facts.name) };
        let own = &mut facts.capabilities;
        own.graphics &= settings.graphics;
        own.timestamp_bits = own.timestamp_bits.min(queue.timestamp_bits);
        own.timestamps &= own.timestamp_bits > 0;
        let places: Vec<QueuePlace> = [queue.place(0)].into_iter().chain(facts.queue_beside(queue)).collect();
        Self::open_with(instance, facts, settings, &places)
    }

    fn open_with(
        instance: &Instance,
        facts: DeviceFacts,
        settings: DeviceSettings,
        places: &[QueuePlace],
    ) -> Result<Self> {
        let capabilities = facts.capabilities;
        let mut extensions = Vec::new();
        if capabilities.transform_feedback {
            extensions.push(ext::transform_feedback::NAME.as_ptr());
        }
        if capabilities.calibrated_timestamps {
            extensions.push(ext::calibrated_timestamps::NAME.as_ptr());
        }
        if facts.is_portability_subset {
            extensions.push(PORTABILITY_SUBSET.as_ptr());
        }
        if capabilities.buffer_markers {
            extensions.push(amd::buffer_marker::NAME.as_ptr());
        } else if capabilities.checkpoints {
            extensions.push(nv::device_diagnostic_checkpoints::NAME.as_ptr());
        }
        let asks = settings.inspect == Inspect::Compiled && capabilities.executable_properties;
        if asks {
            extensions.push(khr::pipeline_executable_properties::NAME.as_ptr());
        }
        let core = vk::PhysicalDeviceFeatures::default()
            .geometry_shader(capabilities.geometry_shader)
            .pipeline_statistics_query(capabilities.pipeline_statistics)
            .vertex_pipeline_stores_and_atomics(capabilities.vertex_stores)
            .fragment_stores_and_atomics(capabilities.fragment_stores);
        let mut vulkan_12 = vk::PhysicalDeviceVulkan12Features::default().timeline_semaphore(true);
        let mut vulkan_13 = vk::PhysicalDeviceVulkan13Features::default()
            .dynamic_rendering(true)
            .synchronization2(true)
            .subgroup_size_control(capabilities.subgroup_sizes.is_some())
            .compute_full_subgroups(capabilities.subgroup_sizes.is_some());
        let mut feedback = vk::PhysicalDeviceTransformFeedbackFeaturesEXT::default().transform_feedback(true);
        let mut executables =
            vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default().pipeline_executable_info(true);
        let priorities = [1.0; LANES];
        let of_family = |&QueuePlace { family, .. }: &QueuePlace| {
            let count = places.iter().filter(|place| place.family == family).count();
            vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&priorities[..count])
        };
        let queues: Vec<_> = places.iter().filter(|place| place.index == 0).map(of_family).collect();
        let mut info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .enabled_features(&core)
            .push_next(&mut vulkan_12)
            .push_next(&mut vulkan_13);
        if capabilities.transform_feedback {
            info = info.push_next(&mut feedback);
        }
        if asks {
            info = info.push_next(&mut executables);
        }
        let vulkan = &instance.shared.raw;
        let _alone = loader();
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
        let mut timelines = [vk::Semaphore::null(); LANES];
        for at in 0..LANES {
            let mut kind = vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
            let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
            // SAFETY: the device is open; so for the calls below.
            match unsafe { raw.create_semaphore(&info, None) } {
                Ok(timeline) => timelines[at] = timeline,
                Err(error) => {
                    // SAFETY: nothing uses them yet.
                    timelines[..at].iter().for_each(|made| unsafe { raw.destroy_semaphore(*made, None) });
                    drop(allocator);
                    return Err(fail("semaphore", &error));
                }
            }
        }
        // SAFETY: the places were found on this device, and these queues were asked for.
        let queue = |place: &QueuePlace| (*place, unsafe { raw.get_device_queue(place.family, place.index) });
        let lanes = Lanes::new(&places.iter().map(queue).collect::<Vec<_>>(), timelines);
        let saved =
            settings.pipeline_cache.as_ref().and_then(|folder| fs::read(kept_file(folder, &facts, PIPELINES)).ok());
        let info = vk::PipelineCacheCreateInfo::default().initial_data(saved.as_deref().unwrap_or_default());
        // A driver refuses data that is not its own, and no cache is as good as an empty one.
        // SAFETY: the data is a byte slice that lives through the call, and drivers check its header.
        let pipelines = unsafe { raw.create_pipeline_cache(&info, None) }.unwrap_or(vk::PipelineCache::null());
        let shared = Arc::new(DeviceShared {
            debug: instance.shared.has_debug_utils.then(|| ext::debug_utils::Device::new(vulkan, &raw)),
            feedback: capabilities.transform_feedback.then(|| FeedbackFunctions::load(vulkan, &raw)).flatten(),
            marks: marks(&capabilities, &settings, vulkan, &raw),
            recordings: AtomicU64::new(0),
            calibrated: capabilities
                .calibrated_timestamps
                .then(|| ext::calibrated_timestamps::Device::new(vulkan, &raw)),
            executables: asks.then(|| khr::pipeline_executable_properties::Device::new(vulkan, &raw)),
            raw,
            instance: instance.clone(),
            facts,
            settings,
            allocator: Mutex::new(Some(allocator)),
            memory_used: AtomicU64::new(0),
            pipelines,
            lanes,
            pass_time: AtomicU64::new(0),
            passes_run: AtomicU64::new(0),
            is_lost: AtomicBool::new(false),
            is_given_up: AtomicBool::new(false),
            retired: Mutex::new(Vec::new()),
        });
        let owner = Owner { shared: shared.clone(), compiled: Compiled::default() };
        Ok(Self { owner: Arc::new(owner), shared, lane: MAIN })
    }

    /// What it is and why it can be used.
    pub fn facts(&self) -> &DeviceFacts {
        &self.shared.facts
    }

    /// The same device, whose recordings go in beside those of others: by a queue of its own where the device has a second one, else
    /// by the same queue in turn with them. Recordings that use the same buffers wait for each other on the device, whichever way they
    /// went in; images stay with one queue.
    #[must_use]
    pub fn beside(&self) -> Self {
        Self { lane: BESIDE, ..self.clone() }
    }

    /// What it can do, as lowered by the settings.
    pub fn capabilities(&self) -> &Capabilities {
        &self.shared.facts.capabilities
    }

    /// Where something of this device and driver is kept beside its pipelines, `kind-DEVICE.ending`; none where those are not kept.
    pub fn kept_file(&self, kind: &str, ending: &str) -> Option<PathBuf> {
        let folder = self.shared.settings.pipeline_cache.as_ref()?;
        Some(kept_file(folder, &self.shared.facts, [kind, ending]))
    }

    /// The validation log of its instance.
    pub fn validation_log(&self) -> ValidationLog {
        self.shared.instance.validation_log()
    }

    /// Bytes of memory that can still be taken: its free budget, as far as the driver tells, within the engine's share.
    pub fn memory_available(&self) -> u64 {
        self.shared.memory_available()
    }

    /// The device's clock beside the host's, where it has calibrated timestamps.
    pub fn clock(&self) -> Option<ClockPair> {
        let functions = self.shared.calibrated.as_ref()?;
        let domain = [vk::CalibratedTimestampInfoEXT::default().time_domain(vk::TimeDomainEXT::DEVICE)];
        let period = f64::from(self.shared.facts.capabilities.timestamp_period_ns);
        // The quickest of three: another thread may have had the processor between the two clocks.
        let mask = tick_mask(self.shared.facts.capabilities.timestamp_bits);
        let pairs = (0..3).filter_map(|_| {
            let before = Instant::now();
            // SAFETY: the extension is enabled and offers the domain.
            let (ticks, _) = unsafe { functions.get_calibrated_timestamps(&domain) }.ok()?;
            let between = before.elapsed();
            Some((
                between,
                ClockPair { device_ns: (*ticks.first()? & mask) as f64 * period, host: before + between / 2 },
            ))
        });
        pairs.min_by_key(|(between, _)| *between).map(|(_, pair)| pair)
    }
}

impl Device {
    /// A buffer of `len` elements of `T`. What it holds at first is undefined.
    ///
    /// # Errors
    /// [`super::OutOfMemory`] when it does not fit; otherwise when it is empty or larger than a storage buffer may be.
    pub fn buffer<T: Pod>(&self, name: &str, len: usize, memory: Memory) -> Result<Buffer> {
        Buffer::new(&self.shared, name, (len as u64).saturating_mul(size_of::<T>() as u64), memory)
    }

    /// An image of `size` = [width, height] pixels. What it holds at first is undefined.
    ///
    /// # Errors
    /// [`super::OutOfMemory`] when it does not fit; otherwise when a side is zero or larger than the device allows, or the
    /// device cannot use the format so.
    pub fn image(&self, name: &str, format: Format, size: [u32; 2], purpose: ImageUse) -> Result<Image> {
        let image = Image::new(&self.shared, name, format, size, None, purpose)?;
        self.settle(&image)?;
        Ok(image)
    }

    /// An image of three dimensions, at most 256 texels each, for stages to read by texel.
    ///
    /// # Errors
    /// As [`Self::image`].
    pub fn volume(&self, name: &str, format: Format, [width, height, depth]: [u32; 3]) -> Result<Image> {
        let image = Image::new(&self.shared, name, format, [width, height], Some(depth), ImageUse::Sampled)?;
        self.settle(&image)?;
        Ok(image)
    }

    /// The pipeline of a compute stage.
    ///
    /// # Errors
    /// When the stage is not one for compute, exceeds a limit of the device, or its driver refuses it.
    pub fn compute_pipeline(&self, stage: &ShaderStage) -> Result<Pipeline> {
        let source = Source { stages: vec![stage.clone()], drawing: None };
        self.owner.compiled.of(source, |_| Pipeline::compute(&self.shared, stage))
    }

    /// The pipeline of these stages, without vertex buffers: vertex stages read storage buffers. Viewport and scissor are set a
    /// draw.
    ///
    /// # Errors
    /// When the device has no queue for graphics, or its driver refuses the pipeline.
    pub fn graphics_pipeline(&self, name: &str, stages: &[ShaderStage], drawing: &Drawing) -> Result<Pipeline> {
        ensure!(
            self.capabilities().graphics,
            "the Vulkan device {} has no queue for graphics, which {name} needs",
            self.shared.facts.name
        );
        let source = Source { stages: stages.to_vec(), drawing: Some(*drawing) };
        self.owner.compiled.of(source, |source| Pipeline::graphics(&self.shared, name, &source.stages, drawing))
    }

    /// What the driver made of the stages compiled so far, by pipeline, on a device opened with [`Inspect::Compiled`]; nothing where
    /// it does not tell.
    pub fn compiled(&self) -> Vec<(String, Vec<Executable>)> {
        self.owner.compiled.executables()
    }

    /// Compiles compute stages side by side ahead of their first use: drivers take up to a tenth of a second for one.
    ///
    /// # Errors
    /// As [`Self::compute_pipeline`].
    pub fn compile(&self, stages: &[ShaderStage]) -> Result<()> {
        stages.par_iter().try_for_each(|stage| self.compute_pipeline(stage).map(drop))
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        // What a device that was given up still uses stays for good: the recordings left in its queue hold it.
        if !self.shared.is_given_up.load(Ordering::Relaxed) {
            // SAFETY: no other thread holds one of the device's queues: this was its last handle. Failing means lost, so idle too.
            if unsafe { self.shared.raw.device_wait_idle() }.is_err() {
                self.shared.is_lost.store(true, Ordering::Relaxed);
            }
        }
        self.shared.collect();
    }
}

/// What leaves the marks of passes: words that can be read at any time where the device has both.
fn marks(
    capabilities: &Capabilities,
    settings: &DeviceSettings,
    instance: &ash::Instance,
    device: &ash::Device,
) -> Option<Marks> {
    #[cfg(test)]
    if let Some(functions) = settings.checkpoints {
        return Some(Marks::Checkpoints(functions()));
    }
    let _ = settings;
    if capabilities.buffer_markers {
        return Some(Marks::Words(amd::buffer_marker::Device::new(instance, device)));
    }
    let checkpoints = || nv::device_diagnostic_checkpoints::Device::new(instance, device).fp().clone();
    capabilities.checkpoints.then(checkpoints).map(Marks::Checkpoints)
}
