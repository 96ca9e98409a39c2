//! Dilation and erosion of bit pictures: the twin of [`crate::features::morphology::Morphology`].

use anyhow::Result;

use super::view::{DeviceView, Plane};
use crate::features::morphology::{Element, Shape};
use crate::features::shaders::{layout, morphology_comp};
use crate::gpu::Recorder;

/// What is done with the pixels under an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operation {
    /// One that is set sets the middle.
    Dilate,
    /// One that is clear clears the middle.
    Erode,
}

/// Records an operation from one plane to another.
pub(super) fn morphology(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    operation: Operation,
    element: Element,
    [from, to]: [Plane; 2],
) -> Result<()> {
    recorder.run_all(views.iter().map(|view| {
        let push = layout::Morphology {
            width: view.picture.width,
            height: view.picture.height,
            stride: view.picture.stride,
            radius: element.radius as i32,
            square: u32::from(element.shape == Shape::Square),
            erode: u32::from(operation == Operation::Erode),
        };
        let bindings = morphology_comp::Bindings { before: view.plane(from), after: view.plane(to) };
        bindings.dispatch(push, view.every_word())
    }))
}

/// Records an opening; `work` is written over.
pub(super) fn opening(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    element: Element,
    [from, work, to]: [Plane; 3],
) -> Result<()> {
    morphology(recorder, views, Operation::Erode, element, [from, work])?;
    morphology(recorder, views, Operation::Dilate, element, [work, to])
}

/// Records a closing; `work` is written over.
pub(super) fn closing(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    element: Element,
    [from, work, to]: [Plane; 3],
) -> Result<()> {
    morphology(recorder, views, Operation::Dilate, element, [from, work])?;
    morphology(recorder, views, Operation::Erode, element, [work, to])
}
