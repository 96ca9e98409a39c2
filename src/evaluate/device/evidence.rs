//! Soft evidence of the observations on the device, and what candidates have of it.

use std::borrow::Cow;
use std::sync::Arc;

use anyhow::Result;

use super::host_buffers::HostCounts;
use super::scene::DeviceScene;
use crate::evaluate::bit_planes::{WORD_PIXELS, word_planes};
use crate::evaluate::evidence::best_sums;
use crate::evaluate::shaders::layout;
use crate::features::{Evidence, Observation};
use crate::gpu::{Buffer, Memory, Recorder, StagedBuffer};

/// The evidence of a frame's observations, and the sums of a run.
#[derive(Debug)]
pub(crate) struct DeviceEvidence {
    /// Room is for so many classes.
    classes: usize,
    /// One a view.
    best: Option<Arc<[u32]>>,
    /// The class of each label, how many there are, the best of each view.
    pub(super) table: StagedBuffer,
    /// The bits of the codes of 32 pixels of a row, lowest first, `[group][class]` in the order of the scene's planes.
    pub(super) planes: StagedBuffer,
    /// `[candidate][view]`.
    pub(super) sums: Buffer,
    sums_out: Buffer,
}

impl DeviceEvidence {
    /// For so many classes and runs of so many candidates.
    pub(super) fn new(scene: &DeviceScene, classes: usize, candidates: u32) -> Result<Self> {
        let device = &scene.device;
        // The scene has eight planes a group.
        let groups = scene.planes.buffer.size() as usize / size_of::<[u32; 8]>();
        let table = size_of::<layout::EvidenceTableHeader>() / size_of::<u32>() + scene.sizes.len();
        let [sums, sums_out] = Self::room(scene, candidates)?;
        Ok(Self {
            classes,
            best: None,
            table: StagedBuffer::new::<u32>(device, "evidence", table)?,
            planes: StagedBuffer::of(device, "observed evidence", &vec![[0_u32; Evidence::BITS]; groups * classes])?,
            sums,
            sums_out,
        })
    }

    fn room(scene: &DeviceScene, candidates: u32) -> Result<[Buffer; 2]> {
        let count = candidates as usize * scene.sizes.len();
        let sums = |name, memory| scene.device.buffer::<i32>(name, count, memory);
        Ok([sums("evidence sums", Memory::Device)?, sums("evidence sums readback", Memory::Readback)?])
    }

    /// Makes room for runs of so many candidates.
    pub(super) fn reserve(&mut self, scene: &DeviceScene, candidates: u32) -> Result<()> {
        [self.sums, self.sums_out] = Self::room(scene, candidates)?;
        Ok(())
    }

    /// How many classes it has room for.
    pub(super) fn classes(&self) -> usize {
        self.classes
    }

    /// The best of each view.
    pub(super) fn best(&self) -> Option<&[u32]> {
        self.best.as_deref()
    }

    /// Takes the observations of a frame, which have evidence in as many classes.
    pub(super) fn observe(&mut self, scene: &DeviceScene, observations: &[Observation]) -> Result<()> {
        self.best = best_sums(observations);
        let mut header: layout::EvidenceTableHeader = bytemuck::Zeroable::zeroed();
        header.count = u32::try_from(self.classes)?;
        for (view, first) in observations.iter().zip(scene.first_plane_words()) {
            let Some(evidence) = &view.evidence else { continue };
            for (label, class) in (0..).zip(&mut header.classes) {
                *class = u32::from(evidence.classes().of_label(label));
            }
            // Stages that add up codes do not count what is ignored.
            let mut words = Cow::Borrowed(evidence.words());
            for at in view.ignored.iter().flat_map(|ignored| ignored.pixels()) {
                words.to_mut()[at] = 0;
            }
            let rows = words.chunks_exact(view.width as usize);
            let mut planes = Vec::with_capacity(words.len().div_ceil(WORD_PIXELS) * self.classes);
            for pixels in rows.flat_map(|row| row.chunks(WORD_PIXELS)) {
                planes.extend_from_slice(&word_planes(pixels)[..Evidence::BITS * self.classes]);
            }
            self.planes.staging.write(Evidence::BITS * self.classes * first as usize, &planes)?;
        }
        self.table.staging.write(0, bytemuck::cast_slice::<u8, u32>(bytemuck::bytes_of(&header)))?;
        let first = size_of::<layout::EvidenceTableHeader>() / size_of::<u32>();
        self.table.staging.write(first, self.best().unwrap_or_default())
    }

    /// Records the copies to the device's own memory.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.table.record_upload(recorder)?;
        self.planes.record_upload(recorder)
    }

    /// Records the copy of the sums to the host.
    pub(super) fn record_readback(&self, recorder: &mut Recorder) -> Result<()> {
        recorder.copy("read evidence", (&self.sums, 0), (&self.sums_out, 0), self.sums.size())
    }

    /// The sums of a finished run, `[candidate][view]`; what the host itself summed stands for the device's.
    pub(super) fn read(&self, counts: &HostCounts, sums: &mut [i32]) -> Result<()> {
        self.sums_out.read(0, sums)?;
        for ((sum, own), drawn) in sums.iter_mut().zip(&counts.evidence).zip(&counts.sums) {
            if drawn.is_some() {
                *sum = *own;
            }
        }
        Ok(())
    }
}
