//! The evidence of what a framebuffer shows, looked up pixel by pixel by the class of the part that shows there.

use std::borrow::Cow;

use anyhow::Result;

use super::byte_numbers::PartOrders;
use super::compare::Comparing;
use super::drawn::Drawn;
use super::framebuffer::Framebuffer;
use super::readback::Pictures;
use crate::evaluate::device::evidence::DeviceEvidence;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{
    evidence_comp, evidence_words_comp, layout, objective_evidence_comp, raster_evidence_comp,
};
use crate::features::{Evidence, Observation};
use crate::gpu::{Groups, Recorder, StagedBuffer};

/// Pixels that a stage reads together: rows are filled up to a whole number of them.
const TOGETHER: usize = 4;

/// The evidence that framebuffers are held against.
#[derive(Debug)]
pub(super) struct GraphicsEvidence {
    comparing: Comparing,
    /// Codes of parts that a picture may hold.
    codes: u32,
    /// The codes of every pixel, a word a pixel, placed as the scene's packed bytes.
    pixels: StagedBuffer,
    pub(super) orders: PartOrders,
}

impl GraphicsEvidence {
    /// For the batches of a workspace, compared so, on the device or on the host.
    pub(super) fn new(
        (scene, workspace): (&DeviceScene, &Workspace),
        drawn: &Drawn,
        (comparing, on_host): (Comparing, bool),
    ) -> Result<Self> {
        let device = &scene.device;
        let codes = drawn.codes(scene, comparing.packing);
        let listed = raster_evidence_comp::stage(raster_evidence_comp::Constants {
            listed: true,
            ignores: scene.counted.is_some(),
            ..raster_evidence_comp::Constants::default()
        });
        device.compile(&[
            evidence_comp::stage(constants(comparing, codes)),
            listed,
            objective_evidence_comp::stage(),
        ])?;
        let pixels = TOGETHER * (scene.pixels.buffer.size() as usize / size_of::<u32>());
        Ok(Self {
            comparing,
            codes,
            pixels: StagedBuffer::of(device, "evidence of pixels", &vec![0_u32; pixels])?,
            orders: PartOrders::new(scene, workspace, comparing.packing, on_host)?,
        })
    }

    /// Takes the observations of a frame.
    pub(super) fn observe(&self, scene: &DeviceScene, observations: &[Observation]) -> Result<()> {
        for (view, first) in observations.iter().zip(scene.first_pixel_words()) {
            let Some(evidence) = &view.evidence else { continue };
            let mut words = Cow::Borrowed(evidence.words());
            for at in view.ignored.iter().flat_map(|ignored| ignored.pixels()) {
                words.to_mut()[at] = Evidence::SAYS_NOTHING;
            }
            let width = view.width as usize;
            let first = TOGETHER * first as usize;
            if width.is_multiple_of(TOGETHER) {
                self.pixels.staging.write(first, &words)?;
                continue;
            }
            let mut rows = Vec::with_capacity(words.len().div_ceil(width) * width.next_multiple_of(TOGETHER));
            for row in words.chunks_exact(width) {
                rows.extend_from_slice(row);
                rows.resize(rows.len().next_multiple_of(TOGETHER), 0);
            }
            self.pixels.staging.write(first, &rows)?;
        }
        Ok(())
    }

    /// Records what it is of the evidence that the device made itself.
    pub(super) fn record_made(
        &self,
        recorder: &mut Recorder,
        scene: &DeviceScene,
        made: &DeviceEvidence,
    ) -> Result<()> {
        let classes = u32::try_from(made.classes())?;
        let constants = evidence_words_comp::Constants { ignores: scene.counted.is_some() };
        let each = scene.sizes.iter().zip(scene.first_plane_words()).zip(scene.first_pixel_words());
        recorder.run_all(each.map(|((&[width, height], first_group), first_word)| {
            let push = layout::EvidenceWords { width, height, first_group, first_word, classes };
            evidence_words_comp::Bindings {
                evidence_planes: &made.planes.buffer,
                counted_planes: scene.counted_planes(),
                evidence_pixels: &self.pixels.buffer,
            }
            .dispatch(constants, push, Groups::Flat(width.div_ceil(4) * height))
        }))
    }

    /// Records the copies to the device's own memory.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.pixels.record_upload(recorder)
    }

    /// Records the sums of a share, added to what is there.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        (scene, workspace): (&DeviceScene, &Workspace),
        (framebuffer, own): (&Framebuffer, &DeviceEvidence),
        share: Share,
    ) -> Result<()> {
        let bindings = evidence_comp::Bindings {
            placements: &framebuffer.placements,
            tiles: &framebuffer.tiles,
            cameras: &scene.cameras.buffer,
            framebuffer: &framebuffer.words,
            table: &own.table.buffer,
            quads: &workspace.quads,
            evidence_pixels: &self.pixels.buffer,
            all_evidence: &own.sums,
        };
        let groups = self.comparing.groups(scene, share);
        recorder.run(bindings.dispatch(constants(self.comparing, self.codes), scene.batch(share), groups))
    }

    /// What the host sums in the pictures of a finished batch of a body of `parts` parts, one an image; 0 of one that is not drawn
    /// there.
    pub(super) fn sum(&self, parts: usize, pictures: &Pictures<'_>, observations: &[Observation]) -> Result<Vec<i32>> {
        let labels = self.orders.read(pictures.count(), parts)?;
        Ok(pictures.sum_evidence(observations, |image, classes| labels.numbers(image, |label| classes.of_label(label))))
    }
}

fn constants(comparing: Comparing, codes: u32) -> evidence_comp::Constants {
    evidence_comp::Constants { edge_bit: comparing.packing.edge_bit(), codes, local_size_x: comparing.group }
}
