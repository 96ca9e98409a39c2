//! The framebuffer that candidate images are drawn into, and what finds them in it.

use anyhow::Result;

use super::settings::Packing;
use super::tiles::TileLayout;
use crate::evaluate::shaders::layout;
use crate::gpu::{Buffer, Clear, Device, Format, Image, ImageUse, Memory, Target};

/// The memory of a [`TileLayout`].
#[derive(Debug)]
pub(crate) struct Framebuffer {
    pub(crate) layout: TileLayout,
    /// Four candidates a texel.
    pub(crate) colour: Image,
    /// The same image as stages read it: one word a texel.
    pub(crate) words: Image,
    /// Where the packing needs it.
    pub(crate) depth: Option<Image>,
    /// The layout, as stages read it.
    pub(crate) tiles: Buffer,
    /// Where each image lies, `[candidate][view]` of the batch.
    pub(crate) placements: Buffer,
    /// Images that do not fit their tile: how many, 1, 1, and their numbers in the batch.
    pub(crate) listed: Buffer,
    /// What `listed` begins with before any image is listed.
    pub(crate) empty_list: Buffer,
}

impl Framebuffer {
    /// Memory for a layout; `whole` lets every tile show the picture from its origin on.
    ///
    /// # Errors
    /// When the device has no room.
    pub(crate) fn new(device: &Device, layout: TileLayout, packing: Packing, whole: bool) -> Result<Self> {
        let images = layout.candidates as usize * layout.views.len();
        let (header, rows) = layout.rows(whole);
        let bytes: Vec<u8> = bytemuck::bytes_of(&header).iter().chain(bytemuck::cast_slice(&rows)).copied().collect();
        let tiles = device.buffer::<u8>("tiles", bytes.len(), Memory::Upload)?;
        tiles.write(0, &bytes)?;
        let empty_list = device.buffer::<u32>("empty list", 3, Memory::Upload)?;
        empty_list.write(0, &[0_u32, 1, 1])?;
        let colour = device.image("framebuffer", Format::Rgba8, layout.size, ImageUse::Target)?;
        let depth = match packing {
            Packing::Max => None,
            Packing::Depth => {
                Some(device.image("framebuffer depth", Format::Depth32, layout.size, ImageUse::Target)?)
            }
        };
        Ok(Self {
            words: colour.words(),
            colour,
            depth,
            tiles,
            placements: device.buffer::<layout::Placement>("placements", images, Memory::Device)?,
            listed: device.buffer::<u32>("listed", 3 + images, Memory::Device)?,
            empty_list,
            layout,
        })
    }

    /// Its used area, cleared, to draw into.
    pub(crate) fn target(&self) -> Target<'_> {
        let [width, height] = self.layout.size;
        Target {
            colour: (&self.colour, Clear::Value([0.0; 4])),
            depth: self.depth.as_ref().map(|depth| (depth, Clear::Value([1.0; 4]))),
            area: [0, 0, width, height],
        }
    }
}
