//! Segments compared in a framebuffer: the part of a drawn pixel is read from its byte, a label, or a rank that the image's parts in
//! their order tell the label of.

use anyhow::Result;

use super::compare_segments::{CompareSegmentsStage, ObservedSegments};
use super::drawn::Drawn;
use super::framebuffer::Framebuffer;
use super::readback::{ByteNumbers, Pictures};
use super::settings::{Gathering, HostComparison, Packing};
use crate::evaluate::device::raster_segments::RasterSegmentsStage;
use crate::evaluate::device::scene::{DeviceScene, Share, Uploaded, packed};
use crate::evaluate::device::segments::DeviceSegments;
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::segments::SegmentSums;
use crate::evaluate::shaders::layout;
use crate::features::{Observation, Segments};
use crate::gpu::{Buffer, Memory, Recorder};

/// The stages that compare a framebuffer segment by segment, and what they need beside the segments themselves.
#[derive(Debug)]
pub(super) struct GraphicsSegments {
    compare: CompareSegmentsStage,
    /// The number of every observed pixel, packed as the model's bytes.
    numbers: Uploaded,
    /// For what fits no tile, where that is scored.
    listed: Option<RasterSegmentsStage>,
    packing: Packing,
    /// Where the host compares and ranks are drawn: the parts of a batch in their order.
    quads_out: Option<Buffer>,
}

/// How a framebuffer is drawn and compared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comparing {
    pub(super) packing: Packing,
    pub(super) gathering: Gathering,
    /// Workgroups a tile.
    pub(super) bands: u32,
    pub(super) on_host: bool,
}

impl GraphicsSegments {
    /// For the runs and batches of a workspace.
    pub(super) fn new(
        (model, workspace): (&DeviceScene, &Workspace),
        drawn: &Drawn,
        segments: &Segments,
        how: Comparing,
    ) -> Result<Self> {
        let device = &model.device;
        let Comparing { packing, gathering, bands, on_host } = how;
        let largest_code = match packing {
            Packing::Max => model.counts.parts,
            Packing::Depth => drawn.largest_label(model),
        };
        let count = segments.as_slice().len() as u32;
        let is_scored_unplaced = drawn.scores_what_fits_no_tile();
        let (listed, compare) = rayon::join(
            || is_scored_unplaced.then(|| RasterSegmentsStage::new(device, true)).transpose(),
            || CompareSegmentsStage::new(device, gathering, (packing, largest_code), count, bands),
        );
        let words = model.pixels.size() as usize / size_of::<u32>();
        let mut made = Self {
            compare: compare?,
            numbers: Uploaded::new(device, "observed segment numbers", &vec![0_u32; words])?,
            listed: listed?,
            packing,
            quads_out: None,
        };
        if on_host && packing == Packing::Max {
            made.quads_out = Some(Self::quads_room(model, workspace)?);
        }
        Ok(made)
    }

    fn quads_room(model: &DeviceScene, workspace: &Workspace) -> Result<Buffer> {
        let count = workspace.batch as usize * model.counts.views as usize * model.counts.parts as usize;
        model.device.buffer::<layout::Quad>("quads readback", count, Memory::Readback)
    }

    /// Makes room for the batches of another workspace.
    pub(super) fn reserve(&mut self, model: &DeviceScene, workspace: &Workspace) -> Result<()> {
        if self.quads_out.is_some() {
            self.quads_out = Some(Self::quads_room(model, workspace)?);
        }
        Ok(())
    }

    /// Takes the observations of a frame, which have these segments.
    pub(super) fn observe(&mut self, model: &DeviceScene, observations: &[Observation]) -> Result<()> {
        let segmentations = observations.iter().filter_map(|view| view.segmentation.as_ref());
        for (segmentation, first) in segmentations.zip(model.first_pixel_words()) {
            let rows = segmentation.numbers().chunks_exact(segmentation.dimensions().0 as usize);
            self.numbers.staging.write(first as usize, &rows.flat_map(packed).collect::<Vec<u32>>())?;
        }
        Ok(())
    }

    /// Records the copies to the device's own memory.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.numbers.record(recorder)
    }

    /// Records the comparison of a share on the device.
    pub(super) fn record_comparison(
        &self,
        recorder: &mut Recorder,
        scene: (&DeviceScene, &Workspace),
        segments: &DeviceSegments,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        let observed = ObservedSegments { table: &segments.table.target, numbers: &self.numbers.target };
        self.compare.record(recorder, scene, framebuffer, observed, &segments.sums, share)
    }

    /// Records what the comparison of a share on the host needs beside the framebuffer.
    pub(super) fn record_orders(
        &self,
        recorder: &mut Recorder,
        (model, workspace): (&DeviceScene, &Workspace),
        share: Share,
    ) -> Result<()> {
        let Some(quads_out) = &self.quads_out else { return Ok(()) };
        let quads = u64::from(share.candidates) * u64::from(model.counts.views) * u64::from(model.counts.parts);
        let bytes = quads * size_of::<layout::Quad>() as u64;
        recorder.copy("readback", (&workspace.quads, 0), (quads_out, 0), bytes)
    }

    /// Records the sums of the images that fit no tile, where they are scored.
    pub(super) fn record_unplaced(
        &self,
        recorder: &mut Recorder,
        scene: (&DeviceScene, &Workspace),
        segments: &DeviceSegments,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        match &self.listed {
            Some(raster) => segments.record_sums(recorder, raster, scene, &framebuffer.listed, share),
            None => Ok(()),
        }
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
