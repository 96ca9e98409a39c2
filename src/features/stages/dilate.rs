//! Dilation of a bit picture: the twin of [`crate::features::morphology::Morphology::dilate`].

use anyhow::Result;

use super::generated::dilate_comp;
use super::{Picture, ROW_GROUP, record_views};
use crate::features::device::DeviceView;
use crate::features::morphology::{Element, Shape};
use crate::gpu::{Device, Pipeline, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct DilateStage {
    pipeline: Pipeline,
}

impl DilateStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &dilate_comp::SHADER, constants: &[] };
        Ok(Self { pipeline: device.compute_pipeline(stage)? })
    }

    /// Records it: `silhouette` dilated by the element to `near`.
    pub(in crate::features) fn record(
        &self,
        recorder: &mut Recorder,
        views: &[DeviceView],
        element: Element,
    ) -> Result<()> {
        record_views(recorder, "dilate", &self.pipeline, views, |view| {
            let bindings = dilate_comp::Bindings { before: &view.silhouette, dilated: &view.near };
            let square = u32::from(element.shape == Shape::Square);
            let push = Picture { amount: element.radius as i32, square, ..view.picture };
            (bindings.bound(), push, [push.stride.div_ceil(ROW_GROUP), push.height, 1])
        })
    }
}
