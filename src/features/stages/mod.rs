//! The features' work on a device, stage by stage. A stage is one file here beside one shader of the same name under
//! `glsl/features/`; the name is its debug label and its row of timings too. Everything is whole numbers, so that each gives
//! what its twin on the processor gives, bit by bit, on every device.

mod dilate;
mod distance;
mod edges;
mod pack;
mod reach;
mod smooth;

#[allow(dead_code, clippy::unreadable_literal, reason = "written by the build")]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/features_stages.rs"));
}

pub(super) use dilate::DilateStage;
pub(super) use distance::DistanceStage;
pub(super) use edges::EdgesStage;
pub(super) use generated::ROW_GROUP;
pub(super) use generated::layout::Picture;
pub(super) use pack::PackStage;
pub(super) use reach::ReachStage;
pub(super) use smooth::SmoothStage;

use anyhow::Result;

use super::device::DeviceView;
use crate::gpu::{Binding, Dispatch, Groups, Pipeline, Recorder};

/// Records one pass with a dispatch a view: its bindings, its push block and its workgroups.
fn record_views<'a, const N: usize>(
    recorder: &mut Recorder,
    name: &str,
    pipeline: &Pipeline,
    views: &'a [DeviceView],
    dispatch: impl Fn(&'a DeviceView) -> ([Binding<'a>; N], Picture, [u32; 3]),
) -> Result<()> {
    let each: Vec<_> = views.iter().map(dispatch).collect();
    let dispatches: Vec<_> = each
        .iter()
        .map(|(bindings, push, groups)| Dispatch {
            pipeline,
            bindings,
            push: bytemuck::bytes_of(push),
            groups: Groups::Count(*groups),
        })
        .collect();
    recorder.compute(name, &dispatches)
}

/// Workgroups for every pixel of a picture, a part of a row each.
fn rows(picture: &Picture) -> [u32; 3] {
    [picture.width.div_ceil(ROW_GROUP), picture.height, 1]
}
