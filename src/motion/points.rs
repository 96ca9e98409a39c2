//! Named points over time.

use glam::DVec3;

/// Named points (markers or joints) over time in the world frame, z up, mm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointTrajectory {
    /// Names of the points.
    pub names: Vec<String>,
    /// Frames a second.
    pub rate: f64,
    /// Index of the first frame, counted from 0.
    pub first_frame: usize,
    /// One row a frame, one entry a name; `None` where the point is missing.
    pub frames: Vec<Vec<Option<DVec3>>>,
}
