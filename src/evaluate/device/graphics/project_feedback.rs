//! The projection by vertices whose outputs transform feedback captures, and the stage that brings them into order (SPEC A9): the
//! same quads as [`super::ProjectStage`]'s, for measuring one against the other.

use anyhow::Result;

use crate::evaluate::device::scene::{Counts, DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{PROJECT_GROUP, layout, order_comp, project_feedback_vert};
use crate::gpu::{
    Blend, Buffer, ComputeStage, Device, Draw, Drawing, Feedback, Groups, Memory, Pipeline, Recorder, Stage, Topology,
    Viewport,
};

/// The stage.
#[derive(Debug)]
pub(crate) struct ProjectFeedbackStage {
    capture: Pipeline,
    order: ComputeStage,
}

impl ProjectFeedbackStage {
    /// Its names in timings.
    pub(crate) const NAMES: [&'static str; 2] = ["project feedback", "order"];

    /// Compiles it, for devices with transform feedback.
    pub(crate) fn new(device: &Device) -> Result<Self> {
        let drawing = Drawing {
            topology: Topology::Points,
            colour: None,
            depth_test: false,
            depth_write: false,
            depth_bias: None,
            cull_clockwise: false,
            blend: Blend::Replace,
            channels: 0,
        };
        let vertex = Stage { shader: &project_feedback_vert::SHADER, constants: &[] };
        Ok(Self {
            capture: device.graphics_pipeline("project feedback", &[vertex], &drawing)?,
            order: ComputeStage::new(device, Self::NAMES[1], Stage { shader: &order_comp::SHADER, constants: &[] })?,
        })
    }

    /// Room for the captured parts of a batch of `candidates`.
    pub(crate) fn room(device: &Device, counts: Counts, candidates: u32) -> Result<Buffer> {
        let quads = candidates as usize * counts.views as usize * counts.parts as usize;
        device.buffer::<layout::Quad>("captured quads", quads, Memory::Device)
    }

    /// Records it: `workspace.world` through `captured` to `workspace.quads` and `workspace.bounds`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        captured: &Buffer,
        share: Share,
    ) -> Result<()> {
        let push: layout::Batch = model.batch(share);
        let images = share.candidates * model.counts.views;
        let vertices = images * model.counts.parts;
        let size = u64::from(vertices) * size_of::<layout::Quad>() as u64;
        recorder.feedback(
            Self::NAMES[0],
            &Feedback { buffer: captured, offset: 0, size },
            &[Draw {
                pipeline: &self.capture,
                bindings: &project_feedback_vert::Bindings {
                    parts: &model.parts,
                    cameras: &model.cameras,
                    world: &workspace.world,
                }
                .bound(),
                push: bytemuck::bytes_of(&push),
                viewport: Viewport { area: [0.0, 0.0, 1.0, 1.0], depth: [0.0, 1.0] },
                scissor: [0, 0, 1, 1],
                vertices: 0..vertices,
                instances: 0..1,
                indices: None,
                indirect: None,
            }],
        )?;
        let bindings = order_comp::Bindings {
            cameras: &model.cameras,
            captured,
            quads: &workspace.quads,
            all_bounds: &workspace.bounds,
        };
        self.order.record(
            recorder,
            &bindings.bound(),
            &push,
            Groups::Count([images.div_ceil(PROJECT_GROUP / model.counts.parts), 1, 1]),
        )
    }
}
