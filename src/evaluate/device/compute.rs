//! The backend that draws in compute: every candidate compared row by row in registers, in the reference's integers, with no
//! framebuffer.

use anyhow::Result;

use super::backend::DeviceBackend;
use super::open::open_device;
use super::project::ProjectStage;
use super::raster::RasterStage;
use super::raster_segments::RasterSegmentsStage;
use super::rasteriser::Rasteriser;
use super::resources::Resources;
use super::scene::{DeviceScene, Share};
use super::segments::DeviceSegments;
use super::workspace::Workspace;
use crate::body::Body;
use crate::evaluate::evaluator::Footprint;
use crate::geometry::Camera;
use crate::gpu::{Device, Recorder};

/// The evaluator that draws in compute, on a Vulkan device.
pub type Compute = DeviceBackend<ComputeRasteriser>;

/// Draws and compares in one stage, with no picture of a candidate in memory.
#[derive(Debug)]
pub struct ComputeRasteriser {
    project: ProjectStage,
    raster: RasterStage,
    /// Compiled when the first segments are seen.
    raster_segments: Option<RasterSegmentsStage>,
}

impl Compute {
    /// For a body and its cameras at working size, on the device of [`open_device`].
    ///
    /// # Errors
    /// As [`open_device`] and [`Self::on`].
    pub fn new(body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::on(&open_device()?, body, cameras)
    }

    /// On a device.
    ///
    /// # Errors
    /// When a picture has no pixel or is too large, the body has no or too many parts, or the device fails.
    pub fn on(device: &Device, body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::with(DeviceScene::new(device, body, cameras)?, |_| {
            let (raster, project) = rayon::join(|| RasterStage::new(device), || ProjectStage::new(device));
            Ok(ComputeRasteriser { project: project?, raster: raster?, raster_segments: None })
        })
    }
}

impl Rasteriser for ComputeRasteriser {
    const NAME: &'static str = "compute";

    fn variant(&self) -> &'static str {
        self.raster.variant()
    }

    fn footprint(&self) -> Footprint {
        // Bits in registers: no pixel of a candidate is written to memory.
        Footprint { tile: RasterStage::TILE, bytes_per_pixel: 0.0 }
    }

    fn set_segments(
        &mut self,
        scene: &DeviceScene,
        _workspace: &Workspace,
        segments: Option<&DeviceSegments>,
    ) -> Result<()> {
        if segments.is_some() && self.raster_segments.is_none() {
            self.raster_segments = Some(RasterSegmentsStage::new(&scene.device, false)?);
        }
        Ok(())
    }

    fn record_share(&self, recorder: &mut Recorder, resources: &Resources, share: Share) -> Result<()> {
        let Resources { scene, workspace, segments, .. } = resources;
        self.project.record(recorder, scene, workspace, share)?;
        match segments.as_ref().zip(self.raster_segments.as_ref()) {
            None => self.raster.record(recorder, scene, workspace, share),
            // The list is not read.
            Some((segments, raster)) => {
                segments.record_sums(recorder, raster, (scene, workspace), &scene.cameras, share)
            }
        }
    }
}
