//! What candidates look like: drawn together as a run draws them, and read back.

use std::ops::Range;

use anyhow::{Result, ensure};

use super::Graphics;
use super::rasteriser::GraphicsRasteriser;
use super::settings::{Comparison, GraphicsSettings, HostComparison, Packing};
use super::target::Target;
use crate::evaluate::device::resources::Resources;
use crate::evaluate::device::scene::Share;
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::raster::CandidateImage;
use crate::evaluate::shaders::layout;
use crate::gpu::{Memory, Timing};

impl Graphics {
    /// Pictures of candidates that are drawn at once, four a tile, `[candidate][view]`, in the reference's bytes. Where transform
    /// feedback projects there is room for as many as were scored.
    ///
    /// # Errors
    /// When poses are not whole rows, or the device fails or does not hold so many at once.
    pub(crate) fn pictures(&self, poses: &[f32]) -> Result<Vec<CandidateImage>> {
        let counts = self.resources.scene.counts;
        ensure!(
            poses.len().is_multiple_of(counts.dofs as usize),
            "{} numbers are no whole poses of {} degrees of freedom",
            poses.len(),
            counts.dofs
        );
        self.rasteriser.pictures(&self.resources, poses, 0..counts.views as usize)
    }
}

impl GraphicsRasteriser {
    /// As [`Graphics::pictures`], of some views.
    pub(super) fn pictures(
        &self,
        resources: &Resources,
        poses: &[f32],
        views: Range<usize>,
    ) -> Result<Vec<CandidateImage>> {
        let scene = &resources.scene;
        let (device, parts) = (&scene.device, scene.counts.parts as usize);
        let candidates = (poses.len() / scene.counts.dofs as usize) as u32;
        let workspace = Workspace::new(device, scene.counts, candidates)?;
        let settings = GraphicsSettings { comparison: Comparison::Host(HostComparison::Scalar), ..self.settings() };
        let Target { framebuffer, copy, .. } = Target::new(scene, &settings, &scene.sizes, candidates)?;
        for view in views.clone() {
            let [width, height] = scene.sizes[view];
            let held = framebuffer.layout.views[view].size;
            ensure!(
                held[0] >= width && held[1] >= height,
                "a picture of {width}x{height} is larger than the {}x{} that this device draws at once",
                held[0],
                held[1]
            );
        }
        let most = workspace.batch.min(framebuffer.layout.candidates);
        ensure!(
            candidates <= most,
            "this device draws at most {most} such candidates at once, and {candidates} were asked for"
        );
        let staging = device.buffer::<f32>("pose staging", poses.len(), Memory::Upload)?;
        staging.write(0, poses)?;
        let quads = candidates as usize * scene.sizes.len() * parts;
        let quads_out = device.buffer::<layout::Quad>("quads readback", quads, Memory::Readback)?;
        let share = Share { first: 0, candidates };
        let mut recorder = device.recorder(Timing::Off)?;
        scene.record_upload(&mut recorder)?;
        self.drawn().record_upload(&mut recorder)?;
        recorder.copy("upload poses", (&staging, 0), (&workspace.poses, 0), staging.size())?;
        self.drawn().record(&mut recorder, (scene, &workspace), &framebuffer, share)?;
        recorder.copy("read quads", (&workspace.quads, 0), (&quads_out, 0), quads_out.size())?;
        let Some(copy) = copy else { return Ok(Vec::new()) };
        copy.record(&mut recorder, &framebuffer)?;
        recorder.finish()?.run()?;
        let mut quads: Vec<layout::Quad> = bytemuck::zeroed_vec(quads);
        quads_out.read(0, &mut quads)?;
        let pictures = copy.read(&framebuffer, candidates)?;
        let mut images = Vec::new();
        for candidate in 0..candidates {
            for view in views.clone() {
                let [width, height] = scene.sizes[view];
                let drawn = pictures.image(candidate, view, [width, height]);
                let labels = &quads[(candidate as usize * scene.sizes.len() + view) * parts..][..parts];
                images.push(CandidateImage { width, height, bytes: in_labels(settings.packing, drawn, labels) });
            }
        }
        Ok(images)
    }
}

/// The bytes of a picture as labels with bit 7 on edges; `quads` are its parts from the nearest on.
fn in_labels(packing: Packing, drawn: Vec<u8>, quads: &[layout::Quad]) -> Vec<u8> {
    let label = |byte: u8| match usize::from(byte >> 1) {
        0 => 0,
        // 2 rank + edge, ranks counted from the farthest part on, 1 the farthest.
        rank => quads[quads.len() - rank.min(quads.len())].label as u8 | byte << 7,
    };
    match packing {
        Packing::Depth => drawn,
        Packing::Max => drawn.into_iter().map(label).collect(),
    }
}
