//! The backend that draws in compute: every candidate compared row by row in registers, in the reference's integers, with no
//! framebuffer.

use anyhow::Result;

use super::backend::DeviceBackend;
use super::evidence::DeviceEvidence;
use super::open::open_compute_device;
use super::passes::{self, Images, RASTER_TILE, raster_stage};
use super::rasteriser::Rasteriser;
use super::resources::Resources;
use super::scene::{DeviceScene, Share};
use super::segments::DeviceSegments;
use super::summed::Summed;
use super::workspace::Workspace;
use crate::body::Body;
use crate::evaluate::evaluator::Footprint;
use crate::evaluate::shaders::{
    objective_comp, objective_evidence_comp, objective_segments_comp, pose_comp, project_comp, raster_evidence_comp,
    raster_segments_comp,
};
use crate::geometry::Camera;
use crate::gpu::{Device, Recorder};

/// The evaluator that draws in compute, on a Vulkan device.
pub type Compute = DeviceBackend<ComputeRasteriser>;

/// Draws and compares in one stage, with no picture of a candidate in memory.
#[derive(Debug)]
pub struct ComputeRasteriser {
    has_subgroups: bool,
}

impl Compute {
    /// For a body and its cameras at working size, on the device of [`super::open_device`].
    ///
    /// # Errors
    /// As [`super::open_device`] and [`Self::on`].
    pub fn new(body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::on(&open_compute_device()?, body, cameras)
    }

    /// On a device.
    ///
    /// # Errors
    /// When a picture has no pixel or is too large, the body has no or too many parts, or the device fails.
    pub fn on(device: &Device, body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::with(DeviceScene::new(device, body, cameras)?, |_| {
            let raster = raster_stage(device, false, false);
            device.compile(&[raster, pose_comp::stage(), project_comp::stage(), objective_comp::stage()])?;
            Ok(ComputeRasteriser { has_subgroups: device.capabilities().subgroup_arithmetic })
        })
    }
}

impl Rasteriser for ComputeRasteriser {
    const NAME: &'static str = "compute";

    fn variant(&self) -> &'static str {
        if self.has_subgroups { "subgroup" } else { "shared" }
    }

    fn footprint(&self) -> Footprint {
        // Bits in registers: no pixel of a candidate is written to memory.
        Footprint { tile: RASTER_TILE, bytes_per_pixel: 0.0 }
    }

    fn set_segments(
        &mut self,
        scene: &DeviceScene,
        _workspace: &Workspace,
        segments: Option<&DeviceSegments>,
    ) -> Result<()> {
        if segments.is_some() {
            let raster = raster_segments_comp::stage(raster_segments_comp::Constants {
                listed: false,
                ignores: scene.counted.is_some(),
            });
            scene.device.compile(&[raster, objective_segments_comp::stage()])?;
        }
        Ok(())
    }

    fn set_evidence(
        &mut self,
        scene: &DeviceScene,
        _workspace: &Workspace,
        evidence: Option<&DeviceEvidence>,
    ) -> Result<()> {
        if evidence.is_some() {
            let raster = raster_evidence_comp::stage(raster_evidence_comp::Constants {
                listed: false,
                ignores: scene.counted.is_some(),
            });
            scene.device.compile(&[raster, objective_evidence_comp::stage()])?;
        }
        Ok(())
    }

    fn record_share(
        &self,
        recorder: &mut Recorder,
        resources: &Resources,
        summed: Summed<'_>,
        share: Share,
    ) -> Result<()> {
        let Resources { scene, workspace, .. } = resources;
        passes::project(recorder, scene, workspace, share)?;
        passes::raster(recorder, (scene, workspace), summed, Images::All, share)
    }
}
