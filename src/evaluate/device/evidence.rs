//! Soft evidence of the observations on the device, and what candidates have of it.

use std::borrow::Cow;
use std::sync::Arc;

use anyhow::Result;
use rayon::prelude::*;

use super::held_evidence::HeldEvidence;
use super::host_buffers::HostCounts;
use super::scene::DeviceScene;
use crate::evaluate::bit_planes::{WORD_PIXELS, word_planes};
use crate::evaluate::evidence::{best_sums, no_evidence};
use crate::evaluate::shaders::layout;
use crate::features::{ColourTables, Evidence, HeldFrame, HeldView, Observation, PartClasses};
use crate::gpu::{Buffer, Memory, Recorder, StagedBuffer};

/// The evidence of a frame's observations, and the sums of a run.
#[derive(Debug)]
pub(crate) struct DeviceEvidence {
    /// How many classes there are. Room is for as many as there may be, so that what a search recorded serves whatever is learnt.
    classes: usize,
    /// One a view, of observations that the host brought.
    best: Option<Arc<[u32]>>,
    /// How the device makes it itself, once it does.
    held: Option<HeldEvidence>,
    /// Whether that of the newest frame is made so.
    is_held: bool,
    /// The class of each label, how many there are, the best of each view.
    pub(super) table: StagedBuffer,
    /// The bits of the codes of 32 pixels of a row, lowest first, `[group][class]` in the order of the scene's planes.
    pub(super) planes: StagedBuffer,
    /// `[candidate][view]`.
    pub(super) sums: Buffer,
    sums_out: Buffer,
}

impl DeviceEvidence {
    /// For so many classes at first and runs of so many candidates.
    pub(super) fn new(scene: &DeviceScene, classes: usize, candidates: u32) -> Result<Self> {
        let device = &scene.device;
        let most = PartClasses::MOST;
        // The scene has eight planes a group.
        let groups = scene.planes.buffer.size() as usize / size_of::<[u32; 8]>();
        let table = size_of::<layout::EvidenceTableHeader>() / size_of::<u32>() + scene.sizes.len();
        let [sums, sums_out] = Self::room(scene, candidates)?;
        Ok(Self {
            classes,
            best: None,
            held: None,
            is_held: false,
            table: StagedBuffer::new::<u32>(device, "evidence", table)?,
            planes: StagedBuffer::of(device, "observed evidence", &vec![[0_u32; Evidence::BITS]; groups * most])?,
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

    /// How many classes there are.
    pub(super) fn classes(&self) -> usize {
        self.classes
    }

    /// Has so many classes from now on; whether there were others.
    pub(super) fn set_classes(&mut self, classes: usize) -> bool {
        let is_new = self.classes != classes;
        if is_new {
            self.classes = classes;
            // What it has recorded is for the others.
            self.held = None;
        }
        is_new
    }

    /// The best of each view; of what the device makes itself, when it has.
    pub(super) fn best(&self) -> Option<&[u32]> {
        match &self.held {
            Some(held) if self.is_held => held.best(),
            _ => self.best.as_deref(),
        }
    }

    /// Takes what the device is to make evidence of, in as many classes, ahead of what runs next.
    pub(super) fn observe_held(
        &mut self,
        scene: &DeviceScene,
        frame: &HeldFrame,
        colours: &ColourTables,
    ) -> Result<()> {
        let mut held = match self.held.take() {
            Some(held) => held,
            None => HeldEvidence::new(scene, self.classes)?,
        };
        held.observe(frame, colours)?;
        self.held = Some(held);
        self.is_held = true;
        self.write_classes(colours.classes(), &[])
    }

    /// The classes of what the device makes itself.
    pub(super) fn held_classes(&self) -> Option<&PartClasses> {
        self.held.as_ref().filter(|_| self.is_held).and_then(HeldEvidence::part_classes)
    }

    /// Records how it is made of what is held of the views.
    pub(super) fn record_held(&self, recorder: &mut Recorder, scene: &DeviceScene, views: &[HeldView]) -> Result<()> {
        let held = self.held.as_ref().ok_or_else(no_evidence)?;
        held.record(recorder, scene, (&self.table, &self.planes.buffer), views)
    }

    /// The codes of single pixels of what the device made, each a view and its place in the picture's rows.
    pub(super) fn at(&mut self, scene: &DeviceScene, pixels: &[[usize; 2]]) -> Result<Vec<u32>> {
        let held = self.held.as_mut().filter(|_| self.is_held).ok_or_else(no_evidence)?;
        held.at(scene, &self.planes.buffer, pixels)
    }

    /// Takes the observations of a frame, which have evidence in as many classes.
    pub(super) fn observe(&mut self, scene: &DeviceScene, observations: &[Observation]) -> Result<()> {
        self.best = best_sums(observations);
        self.is_held = false;
        let firsts: Vec<u32> = scene.first_plane_words().collect();
        observations.par_iter().zip(firsts).try_for_each(|(view, first)| {
            let Some(evidence) = &view.evidence else { return Ok(()) };
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
            self.planes.staging.write(Evidence::BITS * self.classes * first as usize, &planes)
        })?;
        let classes = observations.iter().find_map(|view| view.evidence.as_ref()).map(Evidence::classes);
        classes.map_or(Ok(()), |classes| self.write_classes(classes, self.best().unwrap_or_default()))
    }

    /// Writes the class of each label and the best of each view, where it is known.
    fn write_classes(&self, classes: &PartClasses, best: &[u32]) -> Result<()> {
        let mut header: layout::EvidenceTableHeader = bytemuck::Zeroable::zeroed();
        header.count = u32::try_from(self.classes)?;
        for (label, class) in (0..).zip(&mut header.classes) {
            *class = u32::from(classes.of_label(label));
        }
        self.table.staging.write(0, bytemuck::cast_slice::<u8, u32>(bytemuck::bytes_of(&header)))?;
        let first = size_of::<layout::EvidenceTableHeader>() / size_of::<u32>();
        self.table.staging.write(first, best)
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
