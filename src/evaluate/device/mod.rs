//! Evaluation on a Vulkan device: what a frame's candidates share, the memory a batch works in, and the two ways to draw and compare
//! them, in compute alone and with the graphics pipeline.

#[cfg(test)]
mod any_device_tests;
mod backend;
mod compute;
mod drawn_mesh;
mod evidence;
mod graphics;
mod handover;
#[cfg(test)]
mod handover_tests;
mod held_evidence;
mod host_buffers;
mod mesh;
#[cfg(test)]
mod mesh_tests;
mod open;
mod passes;
mod raster_kernel;
#[cfg(test)]
mod raster_tests;
mod rasteriser;
mod resources;
mod runs;
mod scene;
mod segments;
mod shared;
mod spans;
mod stage_groups;
mod summed;
#[cfg(test)]
mod tests;
mod tuning;
mod workspace;

pub use backend::DeviceBackend;
pub use compute::Compute;
pub use graphics::{
    Channels, Comparison, Coverage, Gathering, Graphics, GraphicsSettings, HostComparison, Packing, Primitives,
    Projection, Tiling,
};
pub(crate) use open::open_devices;
pub use open::{device_settings, open_device, open_instance};
pub use raster_kernel::{RasterKernel, RowWay};
pub use shared::Shared;
pub(crate) use stage_groups::StageGroups;
pub use tuning::kept_kernels;
