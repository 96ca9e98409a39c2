//! The features' work on a device, stage by stage. A stage is one file here beside one shader of the same name under
//! `glsl/features/`; the name is its debug label and its row of timings too. What is computed as one step is one file here with the
//! shaders of its passes. Each gives what its twin on the processor gives, bit by bit: most are whole numbers, and the rest adds,
//! multiplies and divides ([`quotient.glsl`](../../../glsl/features/quotient.glsl)) in the same order, nothing fused. Only a mixture
//! that adapts by density needs an exponential, which devices round as they like.

mod bounds;
mod bridge;
mod canny;
mod components;
mod difference;
mod distance;
mod edges;
mod mixture;
mod morphology;
mod pack;
mod ratios;
mod reach;
mod smooth;
#[cfg(test)]
mod tests;

#[allow(dead_code, clippy::unreadable_literal, reason = "written by the build")]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/features_stages.rs"));
}

pub(super) use bounds::BoundsStage;
pub(super) use bridge::BridgeStage;
pub(super) use canny::CannyStage;
pub(super) use components::{ComponentsStages, Keep};
pub(super) use difference::DifferenceStage;
pub(super) use distance::DistanceStage;
pub(super) use edges::EdgesStage;
pub(super) use generated::layout::{Picture, Rates};
pub(super) use generated::{
    DARK, MIXTURE_FIELDS, RATIO_COUNTS, RATIO_GRID, RATIO_LEAST, RATIO_MOST, RATIO_STEPS, ROW_GROUP,
};
pub(super) use mixture::MixtureStages;
pub(super) use morphology::{MorphologyStage, Operation};
pub(super) use pack::PackStage;
pub(super) use ratios::RatiosStages;
pub(super) use reach::ReachStage;
pub(super) use smooth::SmoothStage;

use anyhow::Result;
use bytemuck::NoUninit;

use super::Magnitude;
use super::device::DeviceView;
use crate::gpu::{Binding, ComputeStage, Groups, Recorder};

/// Most workgroups in one direction that every device runs.
const MOST_GROUPS: u32 = 65535;

/// Records one pass with a dispatch a view: its bindings, its push block and its workgroups.
fn record_views<'a, const N: usize, P: NoUninit>(
    recorder: &mut Recorder,
    stage: &ComputeStage,
    views: &[&'a DeviceView],
    dispatch: impl Fn(&'a DeviceView) -> ([Binding<'a>; N], P, [u32; 3]),
) -> Result<()> {
    let each: Vec<_> = views.iter().map(|view| dispatch(view)).collect();
    let dispatches: Vec<_> =
        each.iter().map(|(bindings, push, groups)| stage.dispatch(bindings, push, Groups::Count(*groups))).collect();
    recorder.compute(stage.name(), &dispatches)
}

/// Workgroups for every pixel of a picture, a part of a row each.
fn rows(picture: &Picture) -> [u32; 3] {
    [picture.width.div_ceil(ROW_GROUP), picture.height, 1]
}

/// Workgroups for so many invocations without rows or columns.
fn flat_groups(invocations: u32) -> [u32; 3] {
    let groups = invocations.div_ceil(ROW_GROUP);
    [groups.min(MOST_GROUPS), groups.div_ceil(MOST_GROUPS), 1]
}

/// The shaders' number of a magnitude.
fn magnitude(magnitude: Magnitude) -> u32 {
    match magnitude {
        Magnitude::Exact => generated::MAGNITUDE_EXACT,
        Magnitude::Sum => generated::MAGNITUDE_SUM,
        Magnitude::Max => generated::MAGNITUDE_MAX,
    }
}
