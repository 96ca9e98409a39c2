//! Calibration from points known in the world and in the pictures (METHOD A2): pairs in, cameras with their residuals out; and
//! from a printed board (`board/`).
//!
//! In the order of the work: [`pairs`](Pair) and [`tracks`](parse_tracks) read, [`layout`](Layout) looks at what the
//! points can determine, `linear` is Tsai's radial alignment, `refine` Levenberg-Marquardt over all parameters,
//! [`calibrate`] both and the outliers.

mod board;
mod layout;
mod linear;
mod pairs;
mod parameters;
mod refine;
mod residuals;
mod solve;
mod table;
#[cfg(test)]
mod test_points;
mod tracks;

pub use board::{
    Board, BoardCalibration, BoardDetector, BoardKind, BoardMoment, BoardSettings, Floor, FloorFound, SeenCorner,
    calibrate_board,
};
pub use layout::Layout;
pub use pairs::{CameraPairs, Pair, parse_pairs};
pub use parameters::{Held, LensModel};
pub use residuals::{Residual, ResidualSummary};
pub use solve::{Calibration, CalibrationSettings, Estimate, calibrate};
pub use tracks::{TrackedPoint, join_tracks, parse_tracks};
