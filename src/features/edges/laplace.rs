//! Second derivatives: the masks of Laplace, and edges where they cross zero.
//!
//! A pixel is an edge where the response changes its sign between it and one of its four neighbours by at least the threshold.
//! Of the two pixels the one whose response is nearer to zero is marked, of equal ones the left or the upper. A pixel
//! whose response is zero is marked where two opposite neighbours differ so. Neighbours outside the picture do not count.

/// The responses of a row, from three rows with one column more on either side, to the mask whose corners, sides and middle these are.
pub(super) fn respond<const CORNER: i16, const SIDE: i16, const MIDDLE: i16>(
    [above, here, below]: [&[u8]; 3],
    out: &mut [i16],
) {
    let windows = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
    for (value, ((a, h), b)) in out.iter_mut().zip(windows) {
        let at = |window: &[u8], i: usize| i16::from(window[i]);
        let corners = at(a, 0) + at(a, 2) + at(b, 0) + at(b, 2);
        let sides = at(a, 1) + at(b, 1) + at(h, 0) + at(h, 2);
        *value = CORNER * corners + SIDE * sides + MIDDLE * at(h, 1);
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
