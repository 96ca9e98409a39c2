//! Dilation and erosion of bit pictures: the twin of [`crate::features::morphology::Morphology`].

use anyhow::Result;

use super::generated::{layout, morphology_comp};
use super::{flat_groups, record_views};
use crate::features::device::{DeviceView, Plane};
use crate::features::morphology::{Element, Shape};
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct MorphologyStage {
    stage: ComputeStage,
}

/// What is done with the pixels under an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::features) enum Operation {
    /// One that is set sets the middle.
    Dilate,
    /// One that is clear clears the middle.
    Erode,
}

impl MorphologyStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &morphology_comp::SHADER, constants: &[] };
        Ok(Self { stage: ComputeStage::new(device, "morphology", stage)? })
    }

    /// Records it from one plane to another.
    pub(in crate::features) fn record(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        operation: Operation,
        element: Element,
        [from, to]: [Plane; 2],
    ) -> Result<()> {
        record_views(recorder, &self.stage, views, |view| {
            let bindings = morphology_comp::Bindings { before: view.plane(from), after: view.plane(to) };
            let push = layout::Morphology {
                width: view.picture.width,
                height: view.picture.height,
                stride: view.picture.stride,
                radius: element.radius as i32,
                square: u32::from(element.shape == Shape::Square),
                erode: u32::from(operation == Operation::Erode),
            };
            (bindings.bound(), push, flat_groups(view.words()))
        })
    }

    /// Records an opening; `work` is written over.
    pub(in crate::features) fn record_opening(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        element: Element,
        [from, work, to]: [Plane; 3],
    ) -> Result<()> {
        self.record(recorder, views, Operation::Erode, element, [from, work])?;
        self.record(recorder, views, Operation::Dilate, element, [work, to])
    }

    /// Records a closing; `work` is written over.
    pub(in crate::features) fn record_closing(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        element: Element,
        [from, work, to]: [Plane; 3],
    ) -> Result<()> {
        self.record(recorder, views, Operation::Dilate, element, [from, work])?;
        self.record(recorder, views, Operation::Erode, element, [work, to])
    }
}
