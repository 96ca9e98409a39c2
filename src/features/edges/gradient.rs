//! First derivatives in two perpendicular directions, and how they become one magnitude.

use crate::files::choices;

choices! {
    /// How the two derivatives become one magnitude.
    "magnitude" pub enum Magnitude {
        /// √(gx² + gy²).
        "exact" Exact,
        /// |gx| + |gy|.
        "sum" Sum,
        /// max(|gx|, |gy|).
        "max" Max,
    }
}

impl Magnitude {
    /// Whether the gradient is at least `threshold` strong. All in integers: the exact magnitude is compared squared.
    #[inline]
    pub(super) fn reaches(self, gx: i16, gy: i16, threshold: i16) -> bool {
        match self {
            Self::Exact => {
                let (gx, gy, threshold) = (i32::from(gx), i32::from(gy), i32::from(threshold));
                gx * gx + gy * gy >= threshold * threshold
            }
            Self::Sum => gx.abs() + gy.abs() >= threshold,
            Self::Max => gx.abs().max(gy.abs()) >= threshold,
        }
    }

    /// A number that orders gradients as their magnitudes do: the magnitude, or its square for [`Self::Exact`].
    #[inline]
    pub(super) fn order(self, gx: i16, gy: i16) -> i32 {
        let (gx, gy) = (i32::from(gx), i32::from(gy));
        match self {
            Self::Exact => gx * gx + gy * gy,
            Self::Sum => gx.abs() + gy.abs(),
            Self::Max => gx.abs().max(gy.abs()),
        }
    }

    /// What [`Self::order`] gives for a magnitude.
    pub(super) fn order_of(self, threshold: i16) -> i32 {
        let threshold = i32::from(threshold);
        if self == Self::Exact { threshold * threshold } else { threshold }
    }
}

/// Rows of partial sums, kept between rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct GradientRows {
    columns: Vec<i16>,
    differences: Vec<i16>,
}

impl GradientRows {
    /// Writes `f(gx, gy)` for every pixel of a row, from three rows with one column more on either side: (-1 0 1) along and
    /// (`OUTER` `MIDDLE` `OUTER`) across.
    #[inline]
    pub(super) fn across<const OUTER: i16, const MIDDLE: i16, T>(
        &mut self,
        [above, here, below]: [&[u8]; 3],
        out: &mut [T],
        f: impl Fn(i16, i16) -> T,
    ) {
        self.columns.resize(here.len(), 0);
        self.differences.resize(here.len(), 0);
        for ((((column, difference), &a), &b), &c) in
            self.columns.iter_mut().zip(&mut self.differences).zip(above).zip(here).zip(below)
        {
            *column = OUTER * i16::from(a) + MIDDLE * i16::from(b) + OUTER * i16::from(c);
            *difference = i16::from(c) - i16::from(a);
        }
        for ((value, c), d) in out.iter_mut().zip(self.columns.windows(3)).zip(self.differences.windows(3)) {
            *value = f(c[2] - c[0], OUTER * d[0] + MIDDLE * d[1] + OUTER * d[2]);
        }
    }

    /// The same from the differences of the two diagonals of the square right below the pixel.
    #[inline]
    pub(super) fn diagonals<T>(&mut self, [_, here, below]: [&[u8]; 3], out: &mut [T], f: impl Fn(i16, i16) -> T) {
        // The window's middle is the pixel.
        for ((value, here), below) in out.iter_mut().zip(here.windows(3)).zip(below.windows(3)) {
            let [a, b, c, d] = [here[1], here[2], below[1], below[2]].map(i16::from);
            *value = f(a - d, b - c);
        }
    }
}
