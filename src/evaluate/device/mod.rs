//! Evaluation on a Vulkan device: what a frame's candidates share, the memory a batch works in, and the two ways to draw and compare
//! them, in compute alone and with the graphics pipeline.

mod compute;
mod device_evaluator;
mod graphics;
mod host_buffers;
mod objective;
mod objective_segments;
mod open;
mod pose;
mod project;
mod raster;
mod raster_segments;
#[cfg(test)]
mod raster_tests;
mod runs;
mod scene;
mod segments;
#[cfg(test)]
mod tests;
mod workspace;

#[allow(
    dead_code,
    clippy::unreadable_literal,
    clippy::large_stack_arrays,
    reason = "written by the build; the variants of a stage are bound through one of them"
)]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/evaluate_stages.rs"));
}

pub use compute::Compute;
pub use device_evaluator::DeviceEvaluator;
pub use graphics::{
    Comparison, Coverage, Gathering, Graphics, GraphicsSettings, HostComparison, Packing, Projection, Tiling,
};
pub use open::{device_settings, open_device, open_instance};
