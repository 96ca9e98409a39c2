//! Evaluation on a Vulkan device: what a frame's candidates share, the memory a batch works in, and the backends that chain
//! the stages of [`super::stages`].

mod device_evaluator;
mod model;
#[cfg(test)]
mod raster_tests;
#[cfg(test)]
mod tests;
mod workspace;

#[expect(unused_imports, reason = "the first backend on a device implements it")]
pub(crate) use device_evaluator::DeviceEvaluator;
pub(crate) use model::{Counts, DeviceModel};
pub(crate) use workspace::Workspace;
