//! What a device can do, in one table: what the engine requires, what it uses when present, and the limits it sizes by.

use std::ffi::CStr;

use std::time::Duration;

use anyhow::{Context as _, Result};
use ash::{amd, ext, khr, nv, vk};

use super::Instance;

/// What kind of device it is, the preferred ones first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DeviceKind {
    /// A graphics card with memory of its own.
    Discrete,
    /// Graphics in the processor's package.
    Integrated,
    /// A part of a card lent to a virtual machine.
    Virtual,
    /// Vulkan computed by the processor.
    Cpu,
    /// Something else.
    Other,
}

impl DeviceKind {
    /// The name that `pantin devices` prints.
    pub fn name(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::Integrated => "integrated",
            Self::Virtual => "virtual",
            Self::Cpu => "cpu",
            Self::Other => "other",
        }
    }
}

/// Features and limits of a device. Tests lower them: whatever is false or small here is then neither enabled nor exceeded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capabilities {
    /// Invocations of a subgroup.
    pub subgroup_size: u32,
    /// Least and largest subgroup that a compute stage can be held to, all of them full; none where it cannot.
    pub subgroup_sizes: Option<[u32; 2]>,
    /// Most subgroups of such a workgroup.
    pub max_subgroups: u32,
    /// Arithmetic over a subgroup in compute stages.
    pub subgroup_arithmetic: bool,
    /// Ballots over a subgroup in compute stages.
    pub subgroup_ballot: bool,
    /// Shuffles over a subgroup in compute stages.
    pub subgroup_shuffle: bool,
    /// A queue for the graphics pipeline.
    pub graphics: bool,
    /// A second queue for compute, whose work the device may do beside the first one's.
    pub second_queue: bool,
    /// Blending of four bytes a texel, by the largest value.
    pub max_blend: bool,
    /// Geometry stages.
    pub geometry_shader: bool,
    /// VK_EXT_transform_feedback, with at least one stream.
    pub transform_feedback: bool,
    /// Statistics of a pass: invocations, primitives.
    pub pipeline_statistics: bool,
    /// Writes from vertex and geometry stages to storage buffers.
    pub vertex_stores: bool,
    /// Writes from fragment stages to storage buffers.
    pub fragment_stores: bool,
    /// Timestamps around passes.
    pub timestamps: bool,
    /// Bits of a timestamp: it begins anew when they are full.
    pub timestamp_bits: u32,
    /// Nanoseconds of a timestamp's tick.
    pub timestamp_period_ns: f32,
    /// Timestamps on the host's clock.
    pub calibrated_timestamps: bool,
    /// VK_AMD_buffer_marker: marks between passes that cost next to nothing.
    pub buffer_markers: bool,
    /// VK_NV_device_diagnostic_checkpoints: such marks that are told once the device is lost.
    pub checkpoints: bool,
    /// VK_KHR_pipeline_executable_properties: what the driver made of a stage.
    pub executable_properties: bool,
    /// Sums and products can be asked to round to the nearest.
    pub rounds_to_nearest: bool,
    /// Numbers below 2^-126 can be asked to be kept.
    pub keeps_denormals: bool,
    /// Largest side of a two-dimensional image or framebuffer, pixels.
    pub max_image: u32,
    /// Largest storage buffer, bytes.
    pub max_storage: u64,
    /// Storage buffers of a stage.
    pub stage_buffers: u32,
    /// Whether many workgroups run at a time, as on a card: what each of them does anew then takes as long as once, and what waits for
    /// another pass costs more. Not where the processor computes.
    pub wide: bool,
    /// Largest workgroup count in x.
    pub max_groups: u32,
    /// Largest workgroup.
    pub max_workgroup: u32,
    /// Shared memory of a workgroup, bytes.
    pub shared_memory: u32,
    /// Push constants, bytes.
    pub push_constants: u32,
    /// Sub-pixel bits of the rasteriser.
    pub sub_pixel_bits: u32,
    /// Memory the engine may take, bytes.
    pub memory: u64,
    /// How long a submission should be at work at most, before the driver takes the device for hung and resets it; none where
    /// nobody does.
    pub longest_submission: Option<Duration>,
}

/// A device of this machine, and whether the engine can use it.
#[derive(Clone, Debug)]
pub struct DeviceFacts {
    /// Its place in Vulkan's list.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: DeviceKind,
    /// Vulkan version it offers: major, minor, patch.
    pub vulkan: [u32; 3],
    /// Driver and its version, in the driver's own words.
    pub driver: String,
    /// Features and limits.
    pub capabilities: Capabilities,
    /// Whether the engine can use it.
    pub usable: bool,
    /// One sentence for each requirement it fails and each option it lacks.
    pub reasons: Vec<String>,
    pub(super) handle: vk::PhysicalDevice,
    /// A family of queues for graphics and compute, and one for compute, alone where there is such a one.
    pub(super) queues: [Option<Queue>; 2],
    /// All families for compute.
    families: Vec<Queue>,
    /// An implementation on another interface, whose extension must be asked for.
    pub(super) is_portability_subset: bool,
    pub(super) has_memory_budget: bool,
}

/// A family of queues.
#[derive(Clone, Copy, Debug)]
pub(super) struct Queue {
    pub(super) family: u32,
    pub(super) timestamp_bits: u32,
    /// How many queues it has.
    count: u32,
    has_graphics: bool,
}

/// A queue to open: its family, its place there, and the bits of its timestamps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct QueuePlace {
    pub(super) family: u32,
    pub(super) index: u32,
    pub(super) timestamp_bits: u32,
}

impl Queue {
    /// Its first queue, or its second.
    pub(super) fn place(self, index: u32) -> QueuePlace {
        QueuePlace { family: self.family, index, timestamp_bits: self.timestamp_bits }
    }
}

impl DeviceFacts {
    /// A queue for compute beside the first one of a family: another one of it, else of another family, rather one without graphics.
    pub(super) fn queue_beside(&self, first: Queue) -> Option<QueuePlace> {
        if !self.capabilities.second_queue {
            return None;
        }
        if first.count > 1 {
            return Some(first.place(1));
        }
        let others = self.families.iter().filter(|other| other.family != first.family);
        others.min_by_key(|other| other.has_graphics).map(|other| other.place(0))
    }
}

/// What Vulkan implementations on top of another interface have in place of a full one; ash names it with its beta functions.
pub(super) const PORTABILITY_SUBSET: &CStr = c"VK_KHR_portability_subset";

/// Drivers reset a device that is at one submission for some seconds, some after half of one.
const LONGEST_SUBMISSION: Duration = Duration::from_millis(200);

/// A row of the capability table.
struct Row {
    required: bool,
    present: fn(&Capabilities) -> bool,
    without: &'static str,
}

const TABLE: &[Row] = &[
    Row {
        required: true,
        present: |c| c.max_workgroup >= 128,
        without: "workgroups hold fewer than 128 invocations, which the compute stages need",
    },
    Row { required: true, present: |c| c.push_constants >= 128, without: "push constants hold fewer than 128 bytes" },
    Row {
        required: false,
        present: |c| c.subgroup_arithmetic && c.subgroup_shuffle && c.subgroup_ballot && c.subgroup_size >= 4,
        without: "no subgroup arithmetic and shuffles of 4 or more: comparison goes through shared memory",
    },
    Row {
        required: false,
        present: |c| c.subgroup_sizes.is_some(),
        without: "no choice of the subgroup size: stages take what the driver gives",
    },
    Row {
        required: false,
        present: |c| c.graphics,
        without: "no queue for graphics: what draws with the graphics pipeline cannot run",
    },
    Row {
        required: false,
        present: |c| c.second_queue,
        without: "one queue: features that are made there take turns with the search of the frame before",
    },
    Row {
        required: false,
        present: |c| c.max_blend,
        without: "no blending of 8-bit colours: candidates share a framebuffer by depth (the packing depth)",
    },
    Row {
        required: false,
        present: |c| c.transform_feedback,
        without: "no transform feedback: vertices are projected by a compute stage",
    },
    Row {
        required: false,
        present: |c| c.geometry_shader,
        without: "no geometry stage: vertices alone make what is drawn",
    },
    Row {
        required: false,
        present: |c| c.timestamps,
        without: "no timestamps: stages are timed by the host, all together",
    },
    Row { required: false, present: |c| c.pipeline_statistics, without: "no pipeline statistics" },
    Row {
        required: false,
        present: |c| c.calibrated_timestamps,
        without: "no calibrated timestamps: traces align the device's clock to the end of a submission",
    },
];

/// Every device of the machine, in Vulkan's order.
///
/// # Errors
/// When the loader cannot list them.
pub fn devices(instance: &Instance) -> Result<Vec<DeviceFacts>> {
    // SAFETY: the instance is alive.
    let handles =
        unsafe { instance.shared.raw.enumerate_physical_devices() }.context("Vulkan cannot list its devices")?;
    Ok(handles.into_iter().enumerate().map(|(index, handle)| facts(instance, index, handle)).collect())
}

fn facts(instance: &Instance, index: usize, handle: vk::PhysicalDevice) -> DeviceFacts {
    let raw = &instance.shared.raw;
    let mut subgroups = vk::PhysicalDeviceSubgroupProperties::default();
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut sizes = vk::PhysicalDeviceSubgroupSizeControlProperties::default();
    let mut floats = vk::PhysicalDeviceFloatControlsProperties::default();
    // The first query goes without structs that a 1.0 device would not know.
    // SAFETY: the handle comes from this instance; so in all calls below.
    let first = unsafe { raw.get_physical_device_properties(handle) };
    let is_recent = first.api_version >= vk::API_VERSION_1_3;
    let mut properties = vk::PhysicalDeviceProperties2::default();
    if is_recent {
        properties =
            properties.push_next(&mut subgroups).push_next(&mut driver).push_next(&mut floats).push_next(&mut sizes);
    }
    // SAFETY: as above; the chained structs belong to versions the device has.
    unsafe { raw.get_physical_device_properties2(handle, &mut properties) };
    let limits = properties.properties.limits;
    // SAFETY: as above.
    let extensions = unsafe { raw.enumerate_device_extension_properties(handle) }.unwrap_or_default();
    let has = |name: &CStr| {
        extensions.iter().any(|extension| extension.extension_name_as_c_str().is_ok_and(|found| found == name))
    };

    let mut vulkan_12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut vulkan_13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut feedback = vk::PhysicalDeviceTransformFeedbackFeaturesEXT::default();
    let mut executables = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default();
    let mut features = vk::PhysicalDeviceFeatures2::default();
    if is_recent {
        features = features.push_next(&mut vulkan_12).push_next(&mut vulkan_13);
    }
    if has(ext::transform_feedback::NAME) {
        features = features.push_next(&mut feedback);
    }
    if has(khr::pipeline_executable_properties::NAME) {
        features = features.push_next(&mut executables);
    }
    // SAFETY: as above.
    unsafe { raw.get_physical_device_features2(handle, &mut features) };
    let core = features.features;

    // SAFETY: as above.
    let families = unsafe { raw.get_physical_device_queue_family_properties(handle) };
    let family_at = |at: usize| Queue {
        family: at as u32,
        timestamp_bits: families[at].timestamp_valid_bits,
        count: families[at].queue_count,
        has_graphics: families[at].queue_flags.contains(vk::QueueFlags::GRAPHICS),
    };
    let queue = |wanted: vk::QueueFlags, unwanted: vk::QueueFlags| {
        let fits = |family: &vk::QueueFamilyProperties| {
            family.queue_flags.contains(wanted) && !family.queue_flags.intersects(unwanted)
        };
        families.iter().position(fits).map(family_at)
    };
    let (graphics, compute) = (vk::QueueFlags::GRAPHICS, vk::QueueFlags::COMPUTE);
    let queues = [
        queue(graphics | compute, vk::QueueFlags::empty()),
        queue(compute, graphics).or_else(|| queue(compute, vk::QueueFlags::empty())),
    ];
    let computes = |at: &usize| families[*at].queue_flags.contains(compute);
    let for_compute: Vec<Queue> = (0..families.len()).filter(computes).map(family_at).collect();
    let timestamp_bits = queues.iter().flatten().next().map_or(0, |queue| queue.timestamp_bits);
    // SAFETY: as above.
    let texel = unsafe { raw.get_physical_device_format_properties(handle, vk::Format::R8G8B8A8_UNORM) };
    // SAFETY: as above.
    let memory = unsafe { raw.get_physical_device_memory_properties(handle) };
    let heaps = &memory.memory_heaps[..memory.memory_heap_count as usize];
    let device_local = heaps
        .iter()
        .filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL))
        .map(|heap| heap.size)
        .max()
        .unwrap_or(0);

    let in_compute = is_recent && subgroups.supported_stages.contains(vk::ShaderStageFlags::COMPUTE);
    let subgroup = |feature| in_compute && subgroups.supported_operations.contains(feature);
    let capabilities = Capabilities {
        subgroup_size: if is_recent { subgroups.subgroup_size } else { 1 },
        subgroup_sizes: (vulkan_13.subgroup_size_control != 0
            && vulkan_13.compute_full_subgroups != 0
            && sizes.required_subgroup_size_stages.contains(vk::ShaderStageFlags::COMPUTE))
        .then_some([sizes.min_subgroup_size, sizes.max_subgroup_size]),
        max_subgroups: sizes.max_compute_workgroup_subgroups,
        subgroup_arithmetic: subgroup(vk::SubgroupFeatureFlags::ARITHMETIC),
        subgroup_ballot: subgroup(vk::SubgroupFeatureFlags::BALLOT),
        subgroup_shuffle: subgroup(vk::SubgroupFeatureFlags::SHUFFLE),
        graphics: queues[0].is_some(),
        second_queue: for_compute.iter().map(|family| family.count).sum::<u32>() > 1,
        max_blend: texel.optimal_tiling_features.contains(vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND),
        geometry_shader: core.geometry_shader != 0,
        transform_feedback: feedback.transform_feedback != 0,
        pipeline_statistics: core.pipeline_statistics_query != 0,
        vertex_stores: core.vertex_pipeline_stores_and_atomics != 0,
        fragment_stores: core.fragment_stores_and_atomics != 0,
        timestamps: timestamp_bits > 0 && limits.timestamp_period > 0.0,
        timestamp_bits,
        timestamp_period_ns: limits.timestamp_period,
        calibrated_timestamps: has(ext::calibrated_timestamps::NAME) && has_own_clock(instance, handle),
        buffer_markers: has(amd::buffer_marker::NAME),
        checkpoints: has(nv::device_diagnostic_checkpoints::NAME),
        executable_properties: executables.pipeline_executable_info != 0,
        rounds_to_nearest: floats.shader_rounding_mode_rte_float32 != 0,
        keeps_denormals: floats.shader_denorm_preserve_float32 != 0,
        max_image: limits.max_image_dimension2_d.min(limits.max_framebuffer_width).min(limits.max_framebuffer_height),
        max_storage: u64::from(limits.max_storage_buffer_range),
        max_groups: limits.max_compute_work_group_count[0],
        max_workgroup: limits.max_compute_work_group_invocations.min(limits.max_compute_work_group_size[0]),
        shared_memory: limits.max_compute_shared_memory_size,
        push_constants: limits.max_push_constants_size,
        sub_pixel_bits: limits.sub_pixel_precision_bits,
        stage_buffers: limits.max_per_stage_descriptor_storage_buffers,
        wide: first.device_type != vk::PhysicalDeviceType::CPU,
        // A fifth is left to others: the display, the driver's own.
        memory: device_local / 5 * 4,
        longest_submission: (first.device_type != vk::PhysicalDeviceType::CPU).then_some(LONGEST_SUBMISSION),
    };

    let mut failures = Vec::new();
    if !is_recent {
        failures.push(format!(
            "it offers Vulkan {}.{}, and 1.3 is needed",
            vk::api_version_major(first.api_version),
            vk::api_version_minor(first.api_version)
        ));
    } else {
        for (present, name) in [
            (vulkan_13.dynamic_rendering, "dynamic rendering"),
            (vulkan_13.synchronization2, "synchronization2"),
            (vulkan_12.timeline_semaphore, "timeline semaphores"),
        ] {
            if present == 0 {
                failures.push(format!("it lacks {name}"));
            }
        }
    }
    if queues[1].is_none() {
        failures.push("none of its queues takes compute".to_string());
    }
    let mut lacks = Vec::new();
    for row in TABLE {
        if !(row.present)(&capabilities) {
            if row.required { &mut failures } else { &mut lacks }.push(row.without.to_string());
        }
    }
    let text = |bytes: vk::PhysicalDeviceDriverProperties<'_>| {
        let part = |text: std::result::Result<&CStr, _>| {
            text.map_or_else(|_: std::ffi::FromBytesUntilNulError| String::new(), |t| t.to_string_lossy().into_owned())
        };
        format!("{} {}", part(bytes.driver_name_as_c_str()), part(bytes.driver_info_as_c_str())).trim().to_string()
    };
    DeviceFacts {
        index,
        name: first.device_name_as_c_str().map_or_else(|_| "?".to_string(), |name| name.to_string_lossy().into_owned()),
        kind: match first.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
            vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
            vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::Virtual,
            vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
            _ => DeviceKind::Other,
        },
        vulkan: [
            vk::api_version_major(first.api_version),
            vk::api_version_minor(first.api_version),
            vk::api_version_patch(first.api_version),
        ],
        driver: text(driver),
        capabilities,
        usable: failures.is_empty(),
        reasons: failures.into_iter().chain(lacks).collect(),
        handle,
        queues,
        families: for_compute,
        is_portability_subset: has(PORTABILITY_SUBSET),
        has_memory_budget: has(ext::memory_budget::NAME),
    }
}

/// Whether timestamps of the device's clock can be taken at any moment; the host's is read beside them, whatever system it is.
fn has_own_clock(instance: &Instance, handle: vk::PhysicalDevice) -> bool {
    let functions = ext::calibrated_timestamps::Instance::new(&instance.shared.entry, &instance.shared.raw);
    // SAFETY: the handle belongs to the instance and the device has the extension.
    let domains = unsafe { functions.get_physical_device_calibrateable_time_domains(handle) }.unwrap_or_default();
    domains.contains(&vk::TimeDomainEXT::DEVICE)
}
