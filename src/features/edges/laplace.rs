//! Second derivatives: the three masks of Laplace, and edges where they cross zero.
//!
//! A pixel is an edge where the response changes its sign between it and one of its four neighbours by at least the threshold.
//! Of the two pixels the one whose response is nearer to zero is marked, of equal ones the left or the upper. A pixel
//! whose response is zero is marked where two opposite neighbours differ so. Neighbours outside the picture do not count.

/// A mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Laplacian {
    /// 0 1 0, 1 -4 1, 0 1 0.
    Four,
    /// 1 1 1, 1 -8 1, 1 1 1.
    Eight,
    /// 1 -2 1, -2 4 -2, 1 -2 1: the product of the two second differences. It sees corners and texture, and no straight edge
    /// along a row or a column.
    Product,
}

impl Laplacian {
    /// The responses of a row, from three rows with one column more on either side.
    pub(super) fn row(self, [above, here, below]: [&[u8]; 3], out: &mut [i16]) {
        let windows = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
        for (value, ((a, h), b)) in out.iter_mut().zip(windows) {
            let at = |window: &[u8], i: usize| i16::from(window[i]);
            let corners = at(a, 0) + at(a, 2) + at(b, 0) + at(b, 2);
            let sides = at(a, 1) + at(b, 1) + at(h, 0) + at(h, 2);
            *value = match self {
                Self::Four => sides - 4 * at(h, 1),
                Self::Eight => sides + corners - 8 * at(h, 1),
                Self::Product => corners - 2 * sides + 4 * at(h, 1),
            };
        }
    }
}

/// Whether the response `here` is a zero crossing; neighbours are none outside the picture.
pub(super) fn crosses_zero(here: i16, [left, right, up, down]: [Option<i16>; 4], threshold: i16) -> bool {
    let opposite = |a: i16, b: i16| i32::from(a) * i32::from(b) < 0 && (a - b).abs() >= threshold;
    if here == 0 {
        let pair = |a: Option<i16>, b: Option<i16>| matches!((a, b), (Some(a), Some(b)) if opposite(a, b));
        return pair(left, right) || pair(up, down);
    }
    let before = |other: Option<i16>| other.is_some_and(|other| opposite(here, other) && here.abs() < other.abs());
    let after = |other: Option<i16>| other.is_some_and(|other| opposite(here, other) && here.abs() <= other.abs());
    before(left) || before(up) || after(right) || after(down)
}
