//! Transforms and camera models (METHOD A2, A3). Everything here is double precision; what a whole swarm is projected with
//! is the single-precision form in [`crate::evaluate`].

mod brown_conrady;
mod camera;
mod rotation;
mod tsai;
mod tsai_constants;
mod unit;

pub use brown_conrady::BrownConrady;
pub use camera::{Camera, LARGEST_SIDE, Lens};
pub use rotation::{EulerOrder, euler_matrix, rodrigues_matrix, rodrigues_vector};
pub use tsai::Tsai;
pub use tsai_constants::TsaiConstants;
pub use unit::LengthUnit;
