//! What the graphics backend keeps on the device for a number of candidates, and how much of it there is room for.

use anyhow::Result;

use super::Graphics;
use super::drawn::Drawn;
use super::framebuffer::Framebuffer;
use super::project_feedback::ProjectFeedbackStage;
use super::readback::FramebufferCopy;
use super::settings::{Comparison, GraphicsSettings, Packing, Projection, Tiling};
use super::tiles::TileLayout;
use crate::evaluate::device::generated::layout;
use crate::evaluate::device::host_buffers::HostBuffers;
use crate::evaluate::device::scene::DeviceScene;
use crate::evaluate::device::workspace::Workspace;
use crate::gpu::{Buffer, Device, Memory, OutOfMemory};

/// Buffers for a number of candidates.
#[derive(Debug)]
pub(super) struct Room {
    pub(super) workspace: Workspace,
    pub(super) framebuffer: Framebuffer,
    /// Most candidates of a batch.
    pub(super) batch: u32,
    pub(super) ends: HostBuffers,
    /// What the images touched, for the host to fit tiles to.
    pub(super) bounds_out: Buffer,
    /// Of the framebuffer, for the comparison on the host.
    pub(super) copy: Option<FramebufferCopy>,
    /// For transform feedback.
    pub(super) captured: Option<Buffer>,
}

impl Room {
    pub(super) fn new(
        model: &DeviceScene,
        drawn: &mut Drawn,
        settings: &GraphicsSettings,
        tiles: &[[u32; 2]],
        candidates: u32,
    ) -> Result<Self> {
        let (device, counts) = (&model.device, model.counts);
        let candidates = candidates.max(1);
        let images = candidates as usize * counts.views as usize;
        let ends = HostBuffers::new(model, candidates)?;
        let bounds_out = device.buffer::<layout::Bounds>("bounds readback", images, Memory::Readback)?;
        drawn.reserve(model, candidates)?;
        let (framebuffer, copy) = make_framebuffer(device, settings, tiles, candidates)?;
        // The workspace last: it takes what is left.
        let workspace = Workspace::new(device, counts, candidates)?;
        let batch = workspace.batch.min(framebuffer.layout.candidates).min(drawn.most());
        let captured = match settings.projection {
            Projection::Compute => None,
            Projection::Feedback => Some(ProjectFeedbackStage::room(device, counts, workspace.batch)?),
        };
        Ok(Self { workspace, framebuffer, batch, ends, bounds_out, copy, captured })
    }
}

/// The largest framebuffer that `candidates` need and the device has room for, and the host's copy of it where it compares there.
pub(super) fn make_framebuffer(
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
        let made =
            Framebuffer::new(device, layout, settings.packing, settings.tiling == Tiling::Pictures).and_then(|made| {
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

impl Graphics {
    /// Room for so many candidates.
    pub(super) fn make_room(&mut self, candidates: u32) -> Result<()> {
        if candidates > self.room.workspace.candidates {
            // Recordings hold the old room; without them it is free before the new one is taken.
            self.runs.forget();
            self.room = Room::new(&self.model, &mut self.drawn, &self.settings, &self.tiles, candidates)?;
            if let Some(segments) = &mut self.segments {
                segments.reserve(&self.model, &self.room.workspace)?;
            }
        }
        Ok(())
    }

    /// Takes tiles of other sizes.
    pub(super) fn set_tiles(&mut self, tiles: Vec<[u32; 2]>) -> Result<()> {
        if tiles != self.tiles {
            // Recordings hold the old framebuffer; without them it is free before the new one is taken.
            self.runs.forget();
            let Room { workspace, .. } = &self.room;
            let candidates = workspace.candidates;
            let (framebuffer, copy) = make_framebuffer(&self.model.device, &self.settings, &tiles, candidates)?;
            self.room.batch = workspace.batch.min(framebuffer.layout.candidates).min(self.drawn.most());
            self.room.framebuffer = framebuffer;
            self.room.copy = copy;
            self.tiles = tiles;
        }
        Ok(())
    }
}
