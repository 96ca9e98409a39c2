//! What an operator does: code made for its weights, so that the loops over pixels know them, and the weights for a device.

use super::gradient::{GradientRows, Magnitude};
use super::laplace::respond;
use crate::features::shaders::{EDGES_ACROSS, EDGES_CROSSINGS, EDGES_DIAGONALS};

/// Marks the strong gradients of a row, given three rows with one column more on either side, and the threshold.
pub(super) type MarkRow = fn(&mut GradientRows, [&[u8]; 3], &mut [u8], Magnitude, i16);

/// Writes the responses of a row, from as much.
pub(super) type RespondRow = fn([&[u8]; 3], &mut [i16]);

/// Runs `$row` with what tells strong gradients as `$is_strong`. The choice of the magnitude is made here, outside the loops over
/// pixels, which then have no branch.
macro_rules! with_magnitude {
    ($magnitude:ident, $threshold:ident, $is_strong:ident => $row:expr) => {
        match $magnitude {
            Magnitude::Exact => {
                let $is_strong = |gx, gy| u8::from(Magnitude::Exact.reaches(gx, gy, $threshold));
                $row
            }
            Magnitude::Sum => {
                let $is_strong = |gx, gy| u8::from(Magnitude::Sum.reaches(gx, gy, $threshold));
                $row
            }
            Magnitude::Max => {
                let $is_strong = |gx, gy| u8::from(Magnitude::Max.reaches(gx, gy, $threshold));
                $row
            }
        }
    };
}

/// What `glsl/features/edges.comp` takes: which form of mask, and its weights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weights {
    pub(crate) form: u32,
    /// Of corners, sides and middle; across an edge there are outer ones, none, and a middle one.
    pub(crate) weights: [i16; 3],
}

/// What an operator does.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Detector {
    /// Marks strong gradients.
    Gradient(MarkRow, Weights),
    /// Marks zero crossings of a Laplacian.
    ZeroCrossings(RespondRow, Weights),
    /// Thins gradients and follows them.
    Canny,
}

impl Detector {
    /// Differences over two pixels, weighted across by (`OUTER` `MIDDLE` `OUTER`), along both axes.
    pub(super) fn across<const OUTER: i16, const MIDDLE: i16>() -> Self {
        let mark: MarkRow = |state, rows, flags, magnitude, threshold| with_magnitude!(magnitude, threshold, is_strong => state.across::<OUTER, MIDDLE, _>(rows, flags, is_strong));
        Self::Gradient(mark, Weights { form: EDGES_ACROSS, weights: [OUTER, 0, MIDDLE] })
    }

    /// Differences along the two diagonals of the square right below a pixel.
    pub(super) fn diagonals() -> Self {
        let mark: MarkRow = |state, rows, flags, magnitude, threshold| with_magnitude!(magnitude, threshold, is_strong => state.diagonals(rows, flags, is_strong));
        Self::Gradient(mark, Weights { form: EDGES_DIAGONALS, weights: [0; 3] })
    }

    /// A mask of these corners, sides and middle.
    pub(super) fn crossings<const CORNER: i16, const SIDE: i16, const MIDDLE: i16>() -> Self {
        let weights = Weights { form: EDGES_CROSSINGS, weights: [CORNER, SIDE, MIDDLE] };
        Self::ZeroCrossings(respond::<CORNER, SIDE, MIDDLE>, weights)
    }
}
