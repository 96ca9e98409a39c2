//! The articulated body: a tree of bones with degrees of freedom, truncated cones for its shape, virtual markers
//! (METHOD A3, A4); poses, and where a pose puts bones, joints and markers in the world.

mod adult;
mod animation;
mod bvh;
mod coordinates;
mod halpe26;
mod kinematics;
mod loader;
mod mesh;
mod model;
mod pose;
mod proportions;
mod retarget;
mod save;
mod skeleton;

pub use adult::ADULT_HEIGHT;
pub use coordinates::Coordinates;
pub use halpe26::HALPE26;
pub use loader::parse_body;
pub use mesh::{FrustumBase, Mesh, MeshEdge, MeshSource, MeshVertex, Skinning};
pub use model::Model;
pub use pose::{PoseTable, PoseWriter};
pub use proportions::{Proportion, Proportions};
pub use retarget::RetargetSettings;
pub(crate) use skeleton::without_side;
pub use skeleton::{Body, Bone, Dof, DofAxis, FreeEnd, Marker, Part};
