//! The floor, from moments at which the board lies on it.

use anyhow::{Result, bail, ensure};
use glam::{DAffine3, DMat3, DVec3};

use super::target::Board;
use crate::geometry::Camera;

/// When the board lies on the floor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Floor {
    /// At the moments at which it lies lowest, as level as the cameras hang.
    #[default]
    Lowest,
    /// In one frame.
    Frame(usize),
}

/// What was taken for the floor.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorFound {
    /// Frames in which the board lay there.
    pub frames: Vec<usize>,
    /// Degrees between the floor's normal and the mean upward direction of the pictures.
    pub tilt: f64,
}

/// A board counts as lying when its normal is this near to the mean upward direction of the pictures, degrees: cameras look
/// down by as much.
const LYING: f64 = 30.0;
/// It lies still where neither its middle moves by more than this, mm, …
const STILL: f64 = 15.0;
/// … nor its normal by more than this, degrees.
const STEADY: f64 = 3.0;

/// A board's place at a moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub(super) frame: usize,
    pub(super) world_from_board: DAffine3,
    /// How many cameras' corners say so.
    pub(super) corners: usize,
}

/// The board where it lies on the floor, as an entry of `boards`, and all frames in which it lies there.
///
/// # Errors
/// When no camera sees the board in the frame asked for, or it is never seen lying.
pub(super) fn find(board: &Board, boards: &[Placed], cameras: &[Camera], floor: Floor) -> Result<(Placed, FloorFound)> {
    let up = upwards(cameras);
    let normal = |placed: &Placed| -placed.world_from_board.matrix3.z_axis;
    let tilt = |placed: &Placed| degrees_between(normal(placed), up);
    let middle = |placed: &Placed| placed.world_from_board.transform_point3(board.middle());
    let chosen = match floor {
        Floor::Frame(frame) => {
            let seen = boards.iter().min_by_key(|placed| placed.frame.abs_diff(frame));
            match seen {
                Some(placed) if placed.frame == frame => placed,
                nearest => bail!(
                    "the board is not seen in frame {frame}, where it should lie on the floor{}",
                    nearest.map_or(String::new(), |near| format!(
                        "; the nearest frame looked at in which it is seen is {}",
                        near.frame
                    ))
                ),
            }
        }
        Floor::Lowest => {
            let lying = boards.iter().filter(|placed| tilt(placed) < LYING);
            let lowest = lying.min_by(|a, b| middle(a).dot(up).total_cmp(&middle(b).dot(up)));
            let Some(lowest) = lowest else {
                bail!(
                    "the board is never seen lying within {LYING} degrees of level, expected it on the floor for a moment, its \
                     print upwards; where the cameras themselves are turned, say in which frame with --floor"
                );
            };
            lowest
        }
    };
    let is_there = |placed: &&Placed| {
        middle(placed).distance(middle(chosen)) < STILL && degrees_between(normal(placed), normal(chosen)) < STEADY
    };
    let there: Vec<&Placed> = boards.iter().filter(is_there).collect();
    // Of the same place, the moment that most is known of.
    let best = match floor {
        Floor::Frame(_) => chosen,
        Floor::Lowest => there.iter().copied().max_by_key(|placed| placed.corners).unwrap_or(chosen),
    };
    let frames = there.iter().map(|placed| placed.frame).collect();
    Ok((*best, FloorFound { frames, tilt: tilt(best) }))
}

/// The world that stands on the floor, from the frame in which the cameras were placed: origin under the middle of the board,
/// x along its rows, z up. The board is `thickness` mm thick.
///
/// # Errors
/// When the board's print looks down.
pub(super) fn floor_from_world(board: &Board, lying: &Placed, thickness: f64) -> Result<DAffine3> {
    let pose = lying.world_from_board;
    let [x, y, z] = [pose.matrix3.x_axis, pose.matrix3.y_axis, pose.matrix3.z_axis];
    ensure!(pose.is_finite(), "the board on the floor has no place, expected it seen there");
    let origin = pose.transform_point3(board.middle()) + z * thickness;
    let world_from_floor = DAffine3::from_mat3_translation(DMat3::from_cols(x, -y, -z), origin);
    Ok(world_from_floor.inverse())
}

/// The angle between two directions of length 1.
fn degrees_between(one: DVec3, other: DVec3) -> f64 {
    one.dot(other).clamp(-1.0, 1.0).acos().to_degrees()
}

/// The mean upward direction of the pictures.
fn upwards(cameras: &[Camera]) -> DVec3 {
    let up = |camera: &Camera| -(camera.camera_from_world.matrix3.transpose() * DVec3::Y);
    cameras.iter().map(up).sum::<DVec3>().normalize_or(DVec3::Z)
}
