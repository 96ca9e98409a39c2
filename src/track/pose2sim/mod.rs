//! A trial of Pose2Sim as a sequence of ours, and its track as the points that Pose2Sim goes on with (FORMATS).

mod manifest;
mod points;

pub use manifest::{Pose2SimGiven, pose2sim_manifest};
pub use points::{POSE2SIM_POINTS, Pose2SimPoints, pose2sim_points, pose2sim_written};

/// Our folder in a trial's.
pub const POSE2SIM_OWN: &str = "pantin";
