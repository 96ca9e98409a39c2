//! Vulkan, and nothing but: devices, memory, pipelines, and one way to run work. It knows nothing of bodies or cameras.
//!
//! Work is recorded as passes ([`Recorder`]) and run as often as wanted ([`Recording`]). A pass has a name, which is its debug
//! label, its row of timings and its breadcrumb should the device be lost. What a pass must wait for is derived from
//! what it reads and writes.

mod barriers;
mod buffer;
mod capability;
mod compiled;
mod copies;
mod counting;
mod descriptors;
mod device;
mod device_shared;
mod drawing;
mod executables;
mod fixed_function;
mod float_controls;
mod hazards;
mod image;
mod instance;
mod interface;
mod lanes;
mod lock;
mod loss;
mod marks;
mod memory;
mod pass;
mod pipeline;
mod recorder;
mod recording;
#[cfg(test)]
pub(crate) mod rough;
mod shader;
#[cfg(any(feature = "reload", test))]
pub mod shaders;
mod spirv;
mod staged;
mod timing;
mod transform_feedback;
mod validation;
mod work;

pub use buffer::Buffer;
pub use capability::{Capabilities, DeviceFacts, DeviceKind, devices};
pub use device::Device;
pub(crate) use device_shared::kept_file;
pub use device_shared::{Breadcrumbs, DeviceSettings, Inspect};
pub use executables::Executable;
pub use fixed_function::{Blend, Drawing, Topology};
pub use image::{Format, Image, ImageUse};
pub use instance::Instance;
pub use interface::{Access, BindingKind, ShaderKind};
pub use loss::{DeviceLost, OutOfMemory};
pub use memory::Memory;
pub use pass::{Clear, Dispatch, Draw, Feedback, Groups, Target, Viewport};
pub use pipeline::Pipeline;
pub use recorder::Recorder;
pub use recording::Recording;
pub(crate) use shader::words;
pub use shader::{Binding, BindingLayout, Bound, Shader, ShaderStage, SpecConstant};
pub use staged::StagedBuffer;
pub use timing::{ClockPair, DevicePass, PassStatistics, PassTiming, Timing, by_name};
pub use validation::{Validation, ValidationLog};
pub use work::Work;

#[cfg(test)]
mod generated {
    include!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/gpu.rs"));
}

#[cfg(test)]
mod lanes_tests;
#[cfg(test)]
pub(crate) mod test_device;
#[cfg(test)]
mod test_turn;
#[cfg(test)]
mod tests;
