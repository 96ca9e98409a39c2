//! Hardware structures that multiply matrices of integers, simulated bit by bit and cycle by cycle, what they cost, and products by
//! bit planes on today's machines (METHOD B5, docs/MATRIX.md).

mod adders;
mod device;
mod partial;
mod parts;
mod planes;
mod shaders;
mod square;
mod structure;
#[cfg(test)]
mod structure_tests;
mod survey;
mod unit;

pub use device::{DeviceProduct, DeviceWay};
pub use partial::Multiplier;
pub use parts::Parts;
pub use planes::bit_plane_product;
pub use square::{MOST_BITS, MOST_ROWS, Square, integer_product};
pub use structure::{Arrangement, Links, Simulated, Structure, StructureName};
pub use survey::{Fit, Rate, StructureRow, SurveySettings, Weights};
pub use unit::{UnitKind, UnitPlan};
