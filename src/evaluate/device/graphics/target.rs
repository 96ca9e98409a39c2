//! What candidates are drawn into, and what the host sees of it.

use anyhow::Result;

use super::framebuffer::Framebuffer;
use super::readback::FramebufferCopy;
use super::settings::{Comparison, GraphicsSettings, Packing, Tiling};
use super::tiles::TileLayout;
use crate::evaluate::device::scene::DeviceScene;
use crate::evaluate::shaders::layout;
use crate::gpu::{Buffer, Device, Memory, OutOfMemory};

/// The framebuffer of a batch, and the host's buffers for a run.
#[derive(Debug)]
pub(super) struct Target {
    pub(super) framebuffer: Framebuffer,
    /// For the comparison on the host.
    pub(super) copy: Option<FramebufferCopy>,
    /// What the images of a run touched, for the host to fit tiles to.
    pub(super) bounds_out: Buffer,
}

impl Target {
    /// For runs of so many candidates, in tiles of these sizes.
    ///
    /// # Errors
    /// When not even one tile a view fits.
    pub(super) fn new(
        scene: &DeviceScene,
        settings: &GraphicsSettings,
        tiles: &[[u32; 2]],
        candidates: u32,
    ) -> Result<Self> {
        let images = candidates as usize * scene.sizes.len();
        let bounds_out = scene.device.buffer::<layout::Bounds>("bounds readback", images, Memory::Readback)?;
        let (framebuffer, copy) = largest(&scene.device, settings, tiles, candidates)?;
        Ok(Self { framebuffer, copy, bounds_out })
    }

    /// Takes tiles of other sizes for as many candidates.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn refit(
        &mut self,
        device: &Device,
        settings: &GraphicsSettings,
        tiles: &[[u32; 2]],
        candidates: u32,
    ) -> Result<()> {
        (self.framebuffer, self.copy) = largest(device, settings, tiles, candidates)?;
        Ok(())
    }
}

/// The largest framebuffer that `candidates` need and the device has room for, and the host's copy of it where it compares there.
fn largest(
    device: &Device,
    settings: &GraphicsSettings,
    tiles: &[[u32; 2]],
    candidates: u32,
) -> Result<(Framebuffer, Option<FramebufferCopy>)> {
    let on_host = matches!(settings.comparison, Comparison::Host(_));
    let texel = 4 * (1 + u64::from(settings.packing == Packing::Depth) + u64::from(on_host));
    let mut most_pixels = device.memory_available() / 2 / texel;
    if on_host {
        most_pixels = most_pixels.min(device.capabilities().max_storage / 4);
    }
    loop {
        let layout = TileLayout::new(tiles, candidates, device.capabilities().max_image, most_pixels)?;
        let is_whole = settings.tiling == Tiling::Pictures;
        let made = Framebuffer::new(device, layout, settings.packing, is_whole).and_then(|made| {
            let copy = if on_host { Some(FramebufferCopy::new(device, &made)?) } else { None };
            Ok((made, copy))
        });
        match made {
            // Until not even a tile is left, which the layout says.
            Err(error) if error.is::<OutOfMemory>() => most_pixels /= 2,
            made => return made,
        }
    }
}
