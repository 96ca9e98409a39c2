//! `--backend` of what draws pictures: the processor or a Vulkan device.

use anyhow::Result;

use super::output::tell;
use crate::evaluate::device::open_device;
use crate::files::choices;
use crate::gpu::{Device, DeviceKind};

choices! {
    /// What draws.
    #[derive(Default)]
    "place to draw" pub(super) enum Draws {
        /// The processor (the default).
        "cpu" #[default] Cpu,
        /// The Vulkan device.
        "device" Device,
        /// A Vulkan device that is no processor itself, else the processor.
        "auto" Auto,
    }
}

impl Draws {
    /// The device that draws; none for the processor. Where `auto` takes the processor, one sentence says why.
    ///
    /// # Errors
    /// When a device is asked for and none can be opened.
    pub(super) fn device(self) -> Result<Option<Device>> {
        let opened = match self {
            Self::Cpu => return Ok(None),
            Self::Device => return open_device().map(Some),
            Self::Auto => open_device(),
        };
        match opened {
            Ok(device) if device.facts().kind != DeviceKind::Cpu => return Ok(Some(device)),
            Ok(device) => {
                tell!("on the processor: the Vulkan device {} is the processor itself", device.facts().name)
            }
            Err(error) => tell!("on the processor: {error:#}"),
        }
        Ok(None)
    }
}
