//! Transforms and camera models (SPEC A2, A3). Everything here is double precision; what a whole swarm is projected with
//! is the single-precision form in [`crate::evaluate`].

mod camera;
mod rotation;

pub use camera::{BrownConrady, Camera, Lens, Tsai};
pub use rotation::{EulerOrder, euler_matrix};
