//! Evaluation on a Vulkan device: what a frame's candidates share, the memory a batch works in, and the backends that chain
//! the stages of [`super::stages`].

mod compute;
mod device_evaluator;
mod model;
mod open;
#[cfg(test)]
mod raster_tests;
#[cfg(test)]
mod tests;
mod workspace;

pub use compute::Compute;
pub(crate) use device_evaluator::DeviceEvaluator;
pub(crate) use model::{Counts, DeviceModel};
pub use open::{device_settings, open_device, open_instance};
pub(crate) use workspace::Workspace;
