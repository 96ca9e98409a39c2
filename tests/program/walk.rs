//! A small sequence of a step forward.

use std::path::Path;

use pantin::body::{Body, PoseTable};
use pantin::geometry::Camera;

use super::drawn;

/// Frames of the sequence.
pub(crate) const FRAMES: usize = 6;

/// Four cameras round the origin, four metres away.
pub(crate) fn cameras() -> Vec<Camera> {
    drawn::Ring { radius: 4000.0, height: 1300.0, target: 900.0, size: [160, 120], focal: 190.0 }.cameras()
}

/// The true poses: a step forward with an arm going up.
pub(crate) fn poses(body: &Body) -> PoseTable {
    let names = body.dof_names();
    let index = |name: &str| names.iter().position(|dof| dof == name).unwrap();
    let pose = |frame: usize| {
        let t = frame as f64;
        let mut pose = body.standing_pose();
        pose[index("pelvis.tx")] += 15.0 * t;
        pose[index("left_hip.ry")] -= 0.05 * t;
        pose[index("right_hip.ry")] += 0.04 * t;
        pose[index("left_knee.ry")] += 0.06 * t;
        pose[index("right_shoulder.ry")] -= 0.08 * t;
        body.clamp_to_limits(&mut pose);
        pose
    };
    PoseTable { frames: (0..FRAMES).collect(), poses: (0..FRAMES).map(pose).collect() }
}

/// Writes the sequence into a folder.
pub(crate) fn write(folder: &Path) {
    let body = Body::adult(1750.0).unwrap();
    drawn::write(folder, "step", &body, &cameras(), &poses(&body));
}
