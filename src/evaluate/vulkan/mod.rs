//! Evaluation on a Vulkan device: what a frame's candidates share, the memory a batch works in, and the backends that chain
//! the stages of [`super::stages`].

mod compute;
mod device_evaluator;
mod drawn;
mod framebuffer;
mod graphics;
mod graphics_segments;
#[cfg(test)]
mod graphics_segments_tests;
mod graphics_settings;
#[cfg(test)]
mod graphics_tests;
mod host_ends;
mod mesh;
#[cfg(test)]
mod mesh_tests;
mod model;
mod open;
#[cfg(test)]
mod raster_tests;
mod readback;
mod runs;
mod segments;
#[cfg(test)]
mod tests;
mod tiles;
mod workspace;

pub use compute::Compute;
pub use device_evaluator::DeviceEvaluator;
pub(crate) use framebuffer::Framebuffer;
pub use graphics::Graphics;
pub use graphics_settings::{Comparison, GraphicsSettings, Projection, Tiling};
pub(crate) use mesh::{DeviceMesh, MeshRoom};
pub(crate) use model::{Counts, DeviceModel};
pub use open::{device_settings, open_device, open_instance};
pub use readback::HostComparison;
pub(crate) use tiles::{CANDIDATES_A_TILE, TileLayout};
pub(crate) use workspace::Workspace;

pub use super::stages::{Coverage, Gathering, Packing};
