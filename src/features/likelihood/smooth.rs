//! Smoothing of ratios: 1 2 1 both ways, close to a Gauss bell of 0.8 pixel.

/// Gives `take` every row of the 3 x 3 sums, weights of sum 16, of rows that `make` fills in; pixels at the border count for those beyond.
/// Values are at most 2047 either way.
pub(crate) fn smooth_rows(
    width: usize,
    height: usize,
    mut make: impl FnMut(usize, &mut [i16]),
    mut take: impl FnMut(usize, &[i16]),
) {
    if width == 0 || height == 0 {
        return;
    }
    let mut raw = vec![0; width];
    let mut across = [vec![0_i16; width], vec![0; width], vec![0; width]];
    let mut sums = vec![0_i16; width];
    let mut fill = |y: usize, row: &mut [i16]| {
        make(y, &mut raw);
        sum_across(&raw, row);
    };
    fill(0, &mut across[1]);
    let (first, second) = across.split_at_mut(1);
    first[0].copy_from_slice(&second[0]);
    for y in 0..height {
        if y + 1 < height {
            fill(y + 1, &mut across[2]);
        } else {
            let (above, below) = across.split_at_mut(2);
            below[0].copy_from_slice(&above[1]);
        }
        let [above, here, below] = &across;
        sum_down([above, here, below], &mut sums);
        take(y, &sums);
        across.rotate_left(1);
    }
}

/// Sums of three of a row that is not empty, compiled for the wider vectors too.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn sum_across(row: &[i16], sums: &mut [i16]) {
    let last = row.len() - 1;
    sums[0] = 3 * row[0] + row[1.min(last)];
    for (sum, three) in sums[1..].iter_mut().zip(row.windows(3)) {
        *sum = three[0] + 2 * three[1] + three[2];
    }
    sums[last] = row[last.saturating_sub(1)] + 3 * row[last];
}

/// Sums of three rows, likewise.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn sum_down([above, here, below]: [&[i16]; 3], sums: &mut [i16]) {
    for (((sum, above), here), below) in sums.iter_mut().zip(above).zip(here).zip(below) {
        *sum = above + 2 * here + below;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_the_definition() {
        for (width, height) in [(1, 1), (1, 4), (5, 1), (2, 2), (7, 5)] {
            let value = |x: usize, y: usize| ((x * 7919 + y * 104_729 + x * y * 31) % 641) as i16 - 320;
            let mut rows = 0;
            smooth_rows(
                width,
                height,
                |y, row| row.iter_mut().enumerate().for_each(|(x, v)| *v = value(x, y)),
                |y, sums| {
                    for (x, &sum) in sums.iter().enumerate() {
                        let mut expected = 0;
                        for (dy, wy) in [(-1, 1), (0, 2), (1, 1)] {
                            for (dx, wx) in [(-1, 1), (0, 2), (1, 1)] {
                                let near = |at: usize, d: isize, len: usize| at.saturating_add_signed(d).min(len - 1);
                                expected += wx * wy * value(near(x, dx, width), near(y, dy, height));
                            }
                        }
                        assert_eq!(sum, expected, "({x}, {y}) of {width} x {height}");
                    }
                    rows += 1;
                },
            );
            assert_eq!(rows, height);
        }
    }
}
