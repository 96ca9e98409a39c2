//! Poses in, components and fitness out: every candidate drawn into every camera and compared with what was seen
//! (METHOD A6, A7).

mod batch;
mod besides;
mod bit_planes;
mod components;
pub mod cpu;
pub mod device;
mod device_evaluator;
mod edge_term;
mod evaluator;
mod evidence;
mod mesh_projection;
mod mesh_raster;
mod objective;
mod projection;
mod raster;
mod reference;
mod rig;
mod score;
mod segments;
mod shaders;
mod view_counts;

pub use components::Components;
pub use device_evaluator::{DeviceEvaluator, ScoredBy, Scoring};
pub use edge_term::EdgeTerm;
pub use evaluator::{Evaluator, Footprint};
pub use evidence::EvidenceSum;
pub use mesh_projection::{EDGE_BIAS, MeshProjector, NEAR, NEAREST, ProjectedVertex};
pub use mesh_raster::draw_mesh;
pub use objective::{Area, Objective, ObjectiveKind, Terms, Views};
pub use projection::{PartQuad, Projector};
pub use raster::{CandidateImage, draw_quads};
pub use reference::{Reference, compare};
pub use score::score;
pub use segments::SegmentSums;
pub use view_counts::ViewCounts;
