//! A pose on its way out.

use std::time::Duration;

use glam::DVec3;

/// A pose as it is found.
#[derive(Clone, Debug)]
pub(crate) struct LivePose {
    pub(crate) frame: usize,
    /// Of the frame in the sequence, s.
    pub(crate) time: f64,
    /// Its age when it was out, from the capture of its pictures.
    pub(crate) latency: Duration,
    /// In state-vector order: mm, radians.
    pub(crate) pose: Vec<f64>,
    /// In the order of [`crate::body::Body::joint_names`]: world, mm.
    pub(crate) joints: Vec<DVec3>,
    /// Expected error of each joint, mm.
    pub(crate) sigmas: Vec<f64>,
    /// In [0, 1].
    pub(crate) fitness: f64,
    /// In [0, 1].
    pub(crate) confidence: f64,
    /// The probability that the pose is off by more than 150 mm.
    pub(crate) wrong: f64,
    pub(crate) is_lost: bool,
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::body::Body;

    /// A pose of a body at a frame, 25 a second.
    pub(in crate::live) fn posed(body: &Body, frame: usize, pose: Vec<f64>) -> LivePose {
        let joints = body.joint_positions(&body.world_from_bones(&pose).unwrap());
        LivePose {
            frame,
            time: frame as f64 / 25.0,
            latency: Duration::from_micros(12_345),
            sigmas: vec![12.345_67; joints.len()],
            pose,
            joints,
            fitness: 0.75,
            confidence: 0.5,
            wrong: 0.125,
            is_lost: false,
        }
    }
}
