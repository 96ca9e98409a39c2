//! C3D, the binary format of motion capture (www.c3d.org): 512-byte blocks, a header, parameters in groups, then points
//! and analog samples frame by frame, in the number formats of three processors, as integers or reals.
//!
//! The reader and the writer are this crate's own. The one crate for the format, `c3dio` 0.8, reads the six encodings
//! right, but refuses a real file whose analog offsets are reals, returns fewer frames of a truncated file without a
//! word, and computes in 16 bits what overflows past frame 131071 or 4095 points. It stays as a second opinion in the
//! tests.

mod numbers;
mod parameters;
mod read;
mod write;

pub use read::parse_c3d;
pub(super) use write::POINTS;
pub use write::write_c3d;

/// Everything in a C3D file is counted in blocks of this many bytes.
const BLOCK: usize = 512;

/// Groups of POINT whose points are no positions: Vicon stores angles, forces, moments and powers as if they were
/// markers.
const NOT_POSITIONS: [&str; 6] = ["ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS"];

/// The group that says how points were smoothed; files of points that were not have none.
const SMOOTHING: &str = "SMOOTHING";
/// In it the cut-off of [`super::LowPass`], Hz.
const CUT_OFF: &str = "CUT_OFF";
/// In it [`super::LowPass::FILTER`].
const FILTER: &str = "FILTER";
