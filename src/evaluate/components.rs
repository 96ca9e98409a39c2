//! What the comparison of one candidate image with one observation yields (METHOD A6).

use bytemuck::{Pod, Zeroable};

/// Sums over the pixels of one candidate in one view. All integers, so the same drawn image gives the same numbers in
/// any order on any device.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Pod, Zeroable)]
pub struct Components {
    /// Pixels of the observed silhouette.
    pub area_obs: u32,
    /// Pixels of the drawn silhouette.
    pub area_model: u32,
    /// Pixels in both.
    pub overlap: u32,
    /// Visible edge pixels drawn.
    pub edges: u32,
    /// Sum over visible edge pixels of the packed 7-bit proximity.
    pub proximity: u32,
}
