//! What the bytes of a framebuffer say of the part that shows, for a comparison on the host: its label, or its rank, of which the
//! image's parts in their order tell the label.

use anyhow::Result;

use super::settings::Packing;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::layout;
use crate::gpu::{Buffer, Memory, Recorder};

/// A number for each byte that a picture may hold.
pub(super) type ByteNumbers = [u8; 256];

/// The parts of a batch in their order on the host, where bytes are ranks.
#[derive(Debug)]
pub(super) struct PartOrders {
    quads_out: Option<Buffer>,
}

/// The same of a finished batch.
#[derive(Debug)]
pub(super) struct ByteLabels {
    /// `[image][place from the nearest on]`; none where bytes are labels.
    quads: Option<Vec<layout::Quad>>,
    parts: usize,
}

impl PartOrders {
    /// For the batches of a workspace, compared on the host or not.
    pub(super) fn new(
        scene: &DeviceScene,
        workspace: &Workspace,
        packing: Packing,
        compares_on_host: bool,
    ) -> Result<Self> {
        let is_ranked = compares_on_host && packing == Packing::Max;
        Ok(Self { quads_out: is_ranked.then(|| Self::room(scene, workspace)).transpose()? })
    }

    fn room(scene: &DeviceScene, workspace: &Workspace) -> Result<Buffer> {
        let count = workspace.batch as usize * scene.counts.views as usize * scene.counts.parts as usize;
        scene.device.buffer::<layout::Quad>("quads readback", count, Memory::Readback)
    }

    /// Makes room for the batches of another workspace.
    pub(super) fn reserve(&mut self, scene: &DeviceScene, workspace: &Workspace) -> Result<()> {
        if self.quads_out.is_some() {
            self.quads_out = Some(Self::room(scene, workspace)?);
        }
        Ok(())
    }

    /// Records the copy of a share's, where there is any.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        (scene, workspace): (&DeviceScene, &Workspace),
        share: Share,
    ) -> Result<()> {
        let Some(quads_out) = &self.quads_out else { return Ok(()) };
        let quads = u64::from(share.candidates) * u64::from(scene.counts.views) * u64::from(scene.counts.parts);
        let bytes = quads * size_of::<layout::Quad>() as u64;
        recorder.copy("readback", (&workspace.quads, 0), (quads_out, 0), bytes)
    }

    /// What tells the bytes of a finished batch of so many images apart, of a body of `parts` parts.
    pub(super) fn read(&self, images: usize, parts: usize) -> Result<ByteLabels> {
        let read = |buffer: &Buffer| {
            let mut quads: Vec<layout::Quad> = bytemuck::zeroed_vec(images * parts);
            buffer.read(0, &mut quads).map(|()| quads)
        };
        Ok(ByteLabels { quads: self.quads_out.as_ref().map(read).transpose()?, parts })
    }
}

impl ByteLabels {
    /// The numbers of an image's bytes, from those of labels; 0 for a rank that no part has.
    pub(super) fn numbers(&self, image: usize, of_label: impl Fn(u8) -> u8) -> ByteNumbers {
        let Some(quads) = &self.quads else { return std::array::from_fn(|byte| of_label(byte as u8 & 0x7f)) };
        let mut numbers = [0; 256];
        for (rank, quad) in (1..).zip(quads[image * self.parts..][..self.parts].iter().rev()) {
            numbers[2 * rank..2 * rank + 2].fill(of_label(quad.label as u8));
        }
        numbers
    }
}
