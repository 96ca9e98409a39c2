//! Segments compared in a framebuffer: the part of a drawn pixel is read from its byte, a label, or a rank that the image's parts in
//! their order tell the label of.

use anyhow::Result;

use super::compare::{Comparing, ObservedSegments};
use super::drawn::Drawn;
use super::readback::{ByteNumbers, Pictures};
use super::settings::{HostComparison, Packing};
use crate::evaluate::device::scene::{DeviceScene, Share, packed};
use crate::evaluate::device::segments::DeviceSegments;
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::segments::SegmentSums;
use crate::evaluate::shaders::{LABELS, SHORT_CODES, layout, objective_segments_comp, raster_segments_comp};
use crate::features::{Observation, Segments};
use crate::gpu::{Buffer, Memory, Recorder, StagedBuffer};

/// What a framebuffer is compared with segment by segment, beside the segments themselves.
#[derive(Debug)]
pub(super) struct GraphicsSegments {
    packing: Packing,
    /// Codes that a picture may hold: in few ones the comparison keeps what they mean in registers.
    codes: u32,
    /// The number of every observed pixel, packed as the scene's bytes.
    numbers: StagedBuffer,
    /// Where the host compares and ranks are drawn: the parts of a batch in their order.
    quads_out: Option<Buffer>,
}

impl GraphicsSegments {
    /// For the batches of a workspace, compared so, on the device or on the host.
    pub(super) fn new(
        (scene, workspace): (&DeviceScene, &Workspace),
        drawn: &Drawn,
        segments: &Segments,
        (comparing, on_host): (Comparing, bool),
    ) -> Result<Self> {
        let device = &scene.device;
        let packing = comparing.packing;
        let largest_code = match packing {
            Packing::Max => scene.counts.parts,
            Packing::Depth => drawn.largest_label(scene),
        };
        let codes = if largest_code < SHORT_CODES { SHORT_CODES } else { LABELS };
        let compare = comparing.segments_stage(codes, segments.as_slice().len() as u32);
        let listed = raster_segments_comp::Constants { listed: true };
        device.compile(&[compare, raster_segments_comp::stage(listed), objective_segments_comp::stage()])?;
        let words = scene.pixels.buffer.size() as usize / size_of::<u32>();
        let is_ranked = on_host && packing == Packing::Max;
        Ok(Self {
            packing,
            codes,
            numbers: StagedBuffer::of(device, "observed segment numbers", &vec![0_u32; words])?,
            quads_out: is_ranked.then(|| Self::quads_room(scene, workspace)).transpose()?,
        })
    }

    fn quads_room(scene: &DeviceScene, workspace: &Workspace) -> Result<Buffer> {
        let count = workspace.batch as usize * scene.counts.views as usize * scene.counts.parts as usize;
        scene.device.buffer::<layout::Quad>("quads readback", count, Memory::Readback)
    }

    /// Makes room for the batches of another workspace.
    pub(super) fn reserve(&mut self, scene: &DeviceScene, workspace: &Workspace) -> Result<()> {
        if self.quads_out.is_some() {
            self.quads_out = Some(Self::quads_room(scene, workspace)?);
        }
        Ok(())
    }

    /// Takes the observations of a frame, which have these segments.
    pub(super) fn observe(&mut self, scene: &DeviceScene, observations: &[Observation]) -> Result<()> {
        let segmentations = observations.iter().filter_map(|view| view.segmentation.as_ref());
        for (segmentation, first) in segmentations.zip(scene.first_pixel_words()) {
            let rows = segmentation.numbers().chunks_exact(segmentation.dimensions().0 as usize);
            self.numbers.staging.write(first as usize, &rows.flat_map(packed).collect::<Vec<u32>>())?;
        }
        Ok(())
    }

    /// Records the copies to the device's own memory.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.numbers.record_upload(recorder)
    }

    /// What the device compares with.
    pub(super) fn observed<'a>(&'a self, segments: &'a DeviceSegments) -> ObservedSegments<'a> {
        ObservedSegments { segments, numbers: &self.numbers.buffer, codes: self.codes }
    }

    /// Records what the comparison of a share on the host needs beside the framebuffer.
    pub(super) fn record_orders(
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

    /// What the host counts in the pictures of a finished batch of a body of `parts` parts, `[image][segment]`; anything of images that are not drawn there.
    pub(super) fn count(
        &self,
        segments: &Segments,
        parts: usize,
        pictures: &Pictures<'_>,
        observations: &[Observation],
        how: HostComparison,
    ) -> Result<Vec<SegmentSums>> {
        let mut quads: Vec<layout::Quad> = Vec::new();
        if let Some(quads_out) = &self.quads_out {
            quads = bytemuck::zeroed_vec(pictures.count() * parts);
            quads_out.read(0, &mut quads)?;
        }
        let by_label: ByteNumbers = std::array::from_fn(|byte| segments.number(byte as u8 & 0x7f));
        let by_rank = |image: usize| -> ByteNumbers {
            let labels = &quads[image * parts..][..parts];
            let mut numbers = [0; 256];
            for (rank, quad) in (1..).zip(labels.iter().rev()) {
                numbers[2 * rank..2 * rank + 2].fill(segments.number(quad.label as u8));
            }
            numbers
        };
        let numbers = |image| if self.packing == Packing::Max { by_rank(image) } else { by_label };
        Ok(pictures.compare_segments(observations, segments.as_slice().len(), numbers, how))
    }
}
