//! The evaluator's work on a device, stage by stage. A stage is one file here beside one shader of the same name under
//! `glsl/evaluate/`; the name is its debug label and its row of timings too.

mod compare;
mod compare_segments;
mod draw;
mod draw_mesh;
mod objective;
mod objective_segments;
mod place;
mod pose;
mod project;
mod project_feedback;
mod raster;
mod raster_segments;
mod skin;

#[allow(
    dead_code,
    clippy::unreadable_literal,
    clippy::large_stack_arrays,
    reason = "written by the build; the variants of a stage are bound through one of them"
)]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/evaluate_stages.rs"));
}

pub(crate) use compare::CompareStage;
pub use compare::Gathering;
pub(crate) use compare_segments::{CompareSegmentsStage, ObservedSegments};
pub(crate) use draw::DrawStage;
pub use draw::{Coverage, Packing};
pub(crate) use draw_mesh::DrawMeshStage;
#[cfg(test)]
pub(crate) use generated::{MESH_EDGE_BIAS, MESH_NEAR, MESH_NEAREST};
pub(crate) use generated::{MOST_SEGMENTS, OUTLINE_VERTICES, layout};
pub(crate) use objective::ObjectiveStage;
pub(crate) use objective_segments::ObjectiveSegmentsStage;
pub(crate) use place::PlaceStage;
pub(crate) use pose::PoseStage;
pub(crate) use project::{MOST_PARTS, ProjectStage};
pub(crate) use project_feedback::ProjectFeedbackStage;
pub(crate) use raster::RasterStage;
pub(crate) use raster_segments::RasterSegmentsStage;
pub(crate) use skin::SkinStage;

/// Which candidates of a run a recorded pass works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Share {
    /// The first one.
    pub(crate) first: u32,
    /// How many.
    pub(crate) candidates: u32,
}
