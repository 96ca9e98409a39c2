//! Segments compared in a framebuffer: the part of a drawn pixel is read from its byte, a label, or a rank that the image's parts in
//! their order tell the label of.

use anyhow::Result;

use super::byte_numbers::PartOrders;
use super::compare::{Comparing, ObservedSegments};
use super::drawn::Drawn;
use super::readback::Pictures;
use super::settings::HostComparison;
use crate::evaluate::device::scene::{DeviceScene, packed};
use crate::evaluate::device::segments::DeviceSegments;
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::segments::SegmentSums;
use crate::evaluate::shaders::{objective_segments_comp, raster_segments_comp};
use crate::features::{Observation, Segments};
use crate::gpu::{Recorder, StagedBuffer};

/// What a framebuffer is compared with segment by segment, beside the segments themselves.
#[derive(Debug)]
pub(super) struct GraphicsSegments {
    /// Codes that a picture may hold: in few ones the comparison keeps what they mean in registers.
    codes: u32,
    /// The bit of a byte that says edge.
    edge_bit: u32,
    /// The number of every observed pixel, packed as the scene's bytes.
    numbers: StagedBuffer,
    pub(super) orders: PartOrders,
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
        let codes = drawn.codes(scene, packing);
        let compare = comparing.segments_stage(codes, segments.as_slice().len() as u32);
        let ignores = scene.counted.is_some();
        let listed = raster_segments_comp::Constants { listed: true, ignores, ..Default::default() };
        let objective = objective_segments_comp::Constants { segment_edges: false };
        device.compile(&[compare, raster_segments_comp::stage(listed), objective_segments_comp::stage(objective)])?;
        let words = scene.pixels.buffer.size() as usize / size_of::<u32>();
        Ok(Self {
            codes,
            edge_bit: packing.edge_bit(),
            numbers: StagedBuffer::of(device, "observed segment numbers", &vec![0_u32; words])?,
            orders: PartOrders::new(scene, workspace, packing, on_host)?,
        })
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

    /// What the device compares with, and whether it counts edges too.
    pub(super) fn observed<'a>(&'a self, segments: &'a DeviceSegments, edges: bool) -> ObservedSegments<'a> {
        ObservedSegments { segments, numbers: &self.numbers.buffer, codes: self.codes, edges }
    }

    /// What the host counts in the pictures of a finished batch of a body of `parts` parts, `[image][segment]`, edges where they are
    /// asked for; anything of images that are not drawn there.
    pub(super) fn count(
        &self,
        (segments, edges): (&Segments, bool),
        parts: usize,
        pictures: &Pictures<'_>,
        observations: &[Observation],
        how: HostComparison,
    ) -> Result<Vec<SegmentSums>> {
        let labels = self.orders.read(pictures.count(), parts)?;
        let numbers = |image| labels.numbers(image, |label| segments.number(label));
        let counted = (segments.as_slice().len(), edges.then_some(self.edge_bit));
        Ok(pictures.compare_segments(observations, counted, numbers, how))
    }
}
