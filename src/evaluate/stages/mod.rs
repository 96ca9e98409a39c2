//! The evaluator's work on a device, stage by stage. A stage is one file here beside one shader of the same name under
//! `glsl/evaluate/`; the name is its debug label and its row of timings too.

mod objective;
mod pose;
mod project;
mod raster;

#[allow(dead_code, clippy::unreadable_literal, clippy::large_stack_arrays, reason = "written by the build")]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/evaluate_stages.rs"));
}

pub(crate) use generated::layout;
pub(crate) use objective::ObjectiveStage;
pub(crate) use pose::PoseStage;
pub(crate) use project::{MOST_PARTS, ProjectStage};
pub(crate) use raster::RasterStage;

/// Which candidates of a run a recorded pass works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Share {
    /// The first one.
    pub(crate) first: u32,
    /// How many.
    pub(crate) candidates: u32,
}
