//! The articulated body: a tree of bones with degrees of freedom, truncated cones for its shape, virtual markers
//! (SPEC A3, A4).

mod skeleton;

pub use skeleton::{Body, Bone, Dof, DofAxis, Marker, Part};
