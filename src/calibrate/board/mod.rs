//! Calibration from a printed board that is carried through the room (METHOD A2): lenses, places and the floor.
//!
//! In the order of the work: [`detector`](BoardDetector) finds the board's corners in pictures, `homography` makes a first
//! lens and pose of a view, `views` chooses those that say most, `start` joins the cameras, `bundle` is Levenberg-Marquardt
//! over lenses, cameras and boards together, `floor` turns the result upright.

mod bundle;
mod detector;
mod floor;
mod homography;
mod solve;
mod start;
mod target;
#[cfg(test)]
mod tests;
mod views;

pub use detector::BoardDetector;
pub use floor::{Floor, FloorFound};
pub use solve::{BoardCalibration, BoardSettings, calibrate_board};
pub use target::{Board, BoardKind, BoardMoment, SeenCorner};
