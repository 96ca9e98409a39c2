//! Segments of the observations on the device, and what is counted by them.

use std::sync::Arc;

use anyhow::Result;

use super::host_buffers::HostCounts;
use super::scene::DeviceScene;
use crate::evaluate::SegmentSums;
use crate::evaluate::shaders::layout;
use crate::features::{Observation, Segments};
use crate::gpu::{Buffer, Memory, Recorder, StagedBuffer};

/// The segments of a frame's observations, and the sums of a run.
#[derive(Debug)]
pub(crate) struct DeviceSegments {
    segments: Arc<Segments>,
    /// Weights, the number of each label, observed areas.
    pub(super) table: StagedBuffer,
    /// A word a segment for 32 pixels of a row, in the order of the scene's planes.
    pub(super) planes: StagedBuffer,
    /// Observed pixels, `[view][segment]`, in rows of the most segments.
    areas: Vec<u32>,
    /// `[candidate][view][segment]`.
    pub(super) sums: Buffer,
    sums_out: Buffer,
}

impl DeviceSegments {
    /// For runs of so many candidates.
    pub(super) fn new(scene: &DeviceScene, segments: &Arc<Segments>, candidates: u32) -> Result<Self> {
        let device = &scene.device;
        let words = scene.planes.buffer.size() as usize / size_of::<u32>();
        let table = size_of::<layout::SegmentTableHeader>() / 4 + scene.sizes.len() * Segments::MOST;
        let [sums, sums_out] = Self::buffers(scene, candidates)?;
        Ok(Self {
            segments: Arc::clone(segments),
            table: StagedBuffer::new::<u32>(device, "segments", table)?,
            planes: StagedBuffer::of(device, "observed segments", &vec![0_u32; words])?,
            areas: vec![0; scene.sizes.len() * Segments::MOST],
            sums,
            sums_out,
        })
    }

    fn buffers(scene: &DeviceScene, candidates: u32) -> Result<[Buffer; 2]> {
        let count = candidates as usize * scene.sizes.len() * Segments::MOST;
        let sums = |name, memory| scene.device.buffer::<layout::Sums>(name, count, memory);
        Ok([sums("segment sums", Memory::Device)?, sums("segment sums readback", Memory::Readback)?])
    }

    /// Makes room for runs of so many candidates.
    pub(super) fn reserve(&mut self, scene: &DeviceScene, candidates: u32) -> Result<()> {
        [self.sums, self.sums_out] = Self::buffers(scene, candidates)?;
        Ok(())
    }

    pub(super) fn segments(&self) -> &Arc<Segments> {
        &self.segments
    }

    /// Takes the observations of a frame, which have these segments.
    pub(super) fn observe(&mut self, scene: &DeviceScene, observations: &[Observation]) -> Result<()> {
        let mut header: layout::SegmentTableHeader = bytemuck::Zeroable::zeroed();
        for (weight, segment) in header.weights.iter_mut().zip(self.segments.as_slice()) {
            *weight = segment.weight;
        }
        for (label, number) in (0..).zip(&mut header.numbers) {
            *number = u32::from(self.segments.number(label));
        }
        self.areas.clear();
        for (segmentation, first) in
            observations.iter().filter_map(|view| view.segmentation.as_ref()).zip(scene.first_plane_words())
        {
            let mut of_view = segmentation.areas();
            of_view.resize(Segments::MOST, 0);
            self.areas.extend(of_view);
            let width = segmentation.dimensions().0 as usize;
            let mut planes = Vec::new();
            for pixels in segmentation.numbers().chunks_exact(width).flat_map(|row| row.chunks(32)) {
                let mut words = [0_u32; Segments::MOST];
                for (bit, &number) in pixels.iter().enumerate().filter(|(_, number)| **number > 0) {
                    words[usize::from(number) - 1] |= 1 << bit;
                }
                planes.extend(words);
            }
            self.planes.staging.write(Segments::MOST * first as usize, &planes)?;
        }
        self.table.staging.write(0, bytemuck::cast_slice::<u8, u32>(bytemuck::bytes_of(&header)))?;
        self.table.staging.write(size_of::<layout::SegmentTableHeader>() / 4, &self.areas)
    }

    /// Records the copies to the device's own memory.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.table.record_upload(recorder)?;
        self.planes.record_upload(recorder)
    }

    /// Records the copy of the sums to the host.
    pub(super) fn record_readback(&self, recorder: &mut Recorder) -> Result<()> {
        recorder.copy("read segment sums", (&self.sums, 0), (&self.sums_out, 0), self.sums.size())
    }

    /// The sums of a finished run, `[candidate][view][segment]` of the segments that there are, edges and proximity where they were asked
    /// for, else 0; what the host itself counted stands for the device's sums.
    pub(super) fn read(&self, counts: &HostCounts, sums: &mut [SegmentSums]) -> Result<()> {
        let count = self.segments.as_slice().len();
        let mut found: Vec<layout::Sums> = bytemuck::zeroed_vec(sums.len() / count * Segments::MOST);
        self.sums_out.read(0, &mut found)?;
        for (image, (row, found)) in sums.chunks_exact_mut(count).zip(found.chunks_exact(Segments::MOST)).enumerate() {
            for (segment, (sums, found)) in row.iter_mut().zip(found).enumerate() {
                let place = image * Segments::MOST + segment;
                let area_obs = self.areas[place % self.areas.len()];
                let layout::Sums { area_model, overlap, edges, proximity } = *found;
                *sums = SegmentSums { area_obs, area_model, overlap, edges, proximity };
            }
            if counts.sums.get(image).is_some_and(Option::is_some) {
                for (sums, found) in row.iter_mut().zip(&counts.segments[image * count..]) {
                    *sums = SegmentSums { area_obs: sums.area_obs, ..*found };
                }
            }
        }
        Ok(())
    }
}
