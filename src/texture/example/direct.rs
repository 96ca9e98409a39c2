//! The placement with the least error, found by summing squares: sixteen placements at a time, each chunk given up as soon as none
//! of its sums can be the least. Squares are never negative, so a sum that has passed the limit stays above it, also rounded.

use rayon::prelude::*;

use super::colour::Known;

/// Placements that are measured in one go.
pub(super) const LANES: usize = 16;
/// Known pixels that are summed before sums are compared with the limit.
const PIXELS_A_LOOK: usize = 4;
/// Squares that are worth waking a thread for, were they all summed.
const WORK_A_TASK: usize = 1_000_000;

/// The first of the usable placements with the least sum below `limit`, counted row by row, and that sum.
pub(super) fn least(
    planes: &[Vec<f32>; 3],
    width: usize,
    [columns, rows]: [usize; 2],
    known: &[Known],
    limit: f32,
    usable: &(dyn Fn(&usize) -> bool + Sync),
) -> Option<(usize, f32)> {
    let rows_a_task = (WORK_A_TASK / (columns * known.len().max(1))).max(1);
    let among = |rows: std::ops::Range<usize>| {
        let mut errors = vec![0.0; columns];
        let mut best: Option<(usize, f32)> = None;
        for row in rows {
            let limit = best.map_or(limit, |(_, error)| error);
            if !row_of_errors(planes, width, row, known, limit, &mut errors) {
                continue;
            }
            for (x, &error) in errors.iter().enumerate() {
                let i = row * columns + x;
                if error < best.map_or(limit, |(_, error)| error) && usable(&i) {
                    best = Some((i, error));
                }
            }
        }
        best
    };
    if rows <= rows_a_task {
        return among(0..rows);
    }
    let tasks = (0..rows.div_ceil(rows_a_task)).into_par_iter();
    let found = tasks.map(|task| among(task * rows_a_task..((task + 1) * rows_a_task).min(rows)));
    // Of equal ones the first: the left side of a reduction lies before the right one.
    found.reduce(
        || None,
        |first, second| match (first, second) {
            (Some(first), Some(second)) => Some(if second.1 < first.1 { second } else { first }),
            (first, second) => first.or(second),
        },
    )
}

/// The sums of one row of placements, infinite where they are known to be `limit` or more before they are complete. Whether any is
/// below.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn row_of_errors(
    planes: &[Vec<f32>; 3],
    width: usize,
    row: usize,
    known: &[Known],
    limit: f32,
    errors: &mut [f32],
) -> bool {
    let mut is_any_below = false;
    for (chunk, errors) in errors.chunks_mut(LANES).enumerate() {
        let mut sums = [0.0_f32; LANES];
        let mut is_chunk_below = true;
        for some in known.chunks(PIXELS_A_LOOK) {
            for pixel in some {
                let from = (row + pixel.y) * width + chunk * LANES + pixel.x;
                for (plane, colour) in planes.iter().zip(pixel.colour) {
                    let texels = &plane[from..from + LANES];
                    for lane in 0..LANES {
                        let difference = texels[lane] - colour;
                        sums[lane] += pixel.weight * (difference * difference);
                    }
                }
            }
            is_chunk_below = sums.iter().fold(false, |any, sum| any | (*sum < limit));
            if !is_chunk_below {
                sums = [f32::INFINITY; LANES];
                break;
            }
        }
        is_any_below |= is_chunk_below;
        errors.copy_from_slice(&sums[..errors.len()]);
    }
    is_any_below
}
