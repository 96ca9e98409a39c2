//! What the driver made of the stages of a pipeline (VK_KHR_pipeline_executable_properties).

use ash::vk;

use super::device_shared::DeviceShared;

/// A stage as the driver compiled it.
#[derive(Clone, Debug, PartialEq)]
pub struct Executable {
    /// The driver's name for it.
    pub name: String,
    /// Invocations of its subgroups.
    pub subgroup_size: u32,
    /// What the driver tells in numbers, under its own names: registers, spills, instructions, occupancy.
    pub statistics: Vec<(String, f64)>,
}

/// The flags that a pipeline of this device is made with.
pub(super) fn flags(device: &DeviceShared) -> vk::PipelineCreateFlags {
    if device.executables.is_some() {
        vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR
    } else {
        vk::PipelineCreateFlags::empty()
    }
}

/// The stages of a pipeline; none where the driver does not tell, or fails to.
pub(super) fn executables(device: &DeviceShared, pipeline: vk::Pipeline) -> Vec<Executable> {
    let Some(functions) = &device.executables else { return Vec::new() };
    let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
    // SAFETY: the extension is enabled and the pipeline alive; it was made with the flag that captures statistics.
    let stages = unsafe { functions.get_pipeline_executable_properties(&info) }.unwrap_or_default();
    let text = |bytes: Result<&std::ffi::CStr, _>| {
        bytes.map_or_else(
            |_: std::ffi::FromBytesUntilNulError| String::new(),
            |text| text.to_string_lossy().into_owned(),
        )
    };
    let of = |(index, stage): (u32, &vk::PipelineExecutablePropertiesKHR<'_>)| {
        let info = vk::PipelineExecutableInfoKHR::default().pipeline(pipeline).executable_index(index);
        // SAFETY: as above; the index is one of its stages.
        let told = unsafe { functions.get_pipeline_executable_statistics(&info) }.unwrap_or_default();
        Executable {
            name: text(stage.name_as_c_str()),
            subgroup_size: stage.subgroup_size,
            statistics: told.iter().map(|one| (text(one.name_as_c_str()), value(one))).collect(),
        }
    };
    (0..).zip(&stages).map(of).collect()
}

fn value(statistic: &vk::PipelineExecutableStatisticKHR<'_>) -> f64 {
    // SAFETY: the format says which of the union's numbers was written.
    unsafe {
        match statistic.format {
            vk::PipelineExecutableStatisticFormatKHR::BOOL32 => f64::from(statistic.value.b32),
            vk::PipelineExecutableStatisticFormatKHR::INT64 => statistic.value.i64 as f64,
            vk::PipelineExecutableStatisticFormatKHR::UINT64 => statistic.value.u64 as f64,
            _ => statistic.value.f64,
        }
    }
}
