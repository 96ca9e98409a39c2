//! Products of bit planes on a processor: an element of Y is a sum of counted ones, y = sum over p, q of +-2^(p+q) |a_p & b_q|
//! (METHOD B5), in vectors of columns and threads of rows.

use anyhow::Result;
use rayon::prelude::*;

use super::square::{Square, check_pair};

/// Columns that are counted side by side: a vector of 512 bits.
const LANES: usize = 8;

/// The bits of a matrix's rows or columns: of each, plane by plane from the lowest, 64 elements a word.
#[derive(Clone, Debug)]
struct Planes {
    words: usize,
    bits: Vec<u64>,
}

/// Bit `plane` of some elements, packed.
fn packed(elements: &[i64], plane: u32) -> u64 {
    elements.iter().enumerate().fold(0, |word, (place, &element)| word | (element as u64 >> plane & 1) << place)
}

impl Planes {
    /// Of lines of elements, in their order.
    fn new<'a>(lines: impl Iterator<Item = &'a [i64]>, n: usize, planes: u32) -> Self {
        let words = n.div_ceil(64);
        let mut bits = Vec::with_capacity(n * planes as usize * words);
        for line in lines {
            for plane in 0..planes {
                bits.extend(line.chunks(64).map(|chunk| packed(chunk, plane)));
            }
        }
        Self { words, bits }
    }

    /// The same with the words of neighbouring lines beside each other, so that a vector has a word of each.
    fn interleaved(&self, n: usize, planes: usize) -> Vec<[u64; LANES]> {
        let line = planes * self.words;
        let mut vectors = vec![[0; LANES]; n.div_ceil(LANES) * line];
        for index in 0..n {
            for (word, &bits) in self.bits[index * line..][..line].iter().enumerate() {
                vectors[index / LANES * line + word][index % LANES] = bits;
            }
        }
        vectors
    }
}

/// The product, by bit planes: the same integers as [`super::integer_product`].
///
/// # Errors
/// When the matrices are of unlike size or bits.
pub fn bit_plane_product(a: &Square, b: &Square) -> Result<Vec<i64>> {
    check_pair(a, b)?;
    let (n, planes) = (a.n(), a.bits() as usize);
    let columns: Vec<Vec<i64>> = (0..n).map(|column| b.column(column)).collect();
    let rows = Planes::new((0..n).map(|row| a.row(row)), n, a.bits());
    let columns = Planes::new(columns.iter().map(Vec::as_slice), n, a.bits()).interleaved(n, planes);
    let line = planes * rows.words;
    let mut product = vec![0_i64; n * n];
    product
        .par_chunks_mut(n)
        .zip(rows.bits.par_chunks(line))
        .for_each(|(out, row)| row_of_product(row, &columns, [planes, rows.words], out));
    Ok(product)
}

#[multiversion::multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512vl+avx512vpopcntdq+popcnt",
    "x86_64+avx2+popcnt",
    "x86_64+popcnt"
))]
fn row_of_product(row: &[u64], columns: &[[u64; LANES]], [planes, words]: [usize; 2], out: &mut [i64]) {
    for (out, column) in out.chunks_mut(LANES).zip(columns.chunks_exact(planes * words)) {
        let mut sums = [0_u64; LANES];
        for (p, a) in row.chunks_exact(words).enumerate() {
            for (q, b) in column.chunks_exact(words).enumerate() {
                let mut counts = [0_u64; LANES];
                for (&a, b) in a.iter().zip(b) {
                    for lane in 0..LANES {
                        counts[lane] += u64::from((a & b[lane]).count_ones());
                    }
                }
                // Minus where one of the two planes is the sign's: the complement and one.
                let flip = if (p + 1 == planes) == (q + 1 == planes) { 0 } else { u64::MAX };
                for lane in 0..LANES {
                    let weighted = counts[lane] << (p + q);
                    sums[lane] = sums[lane].wrapping_add((weighted ^ flip).wrapping_sub(flip));
                }
            }
        }
        out.iter_mut().zip(sums).for_each(|(out, sum)| *out = sum as i64);
    }
}

/// Bits of a matrix's rows (or columns) as the device's stage takes them: 32 elements a word.
pub(super) fn device_words(of: &Square, columns: bool) -> Vec<u32> {
    let n = of.n();
    let mut words = Vec::with_capacity(n * of.bits() as usize * n.div_ceil(32));
    for index in 0..n {
        let line = if columns { of.column(index) } else { of.row(index).to_vec() };
        for plane in 0..of.bits() {
            words.extend(line.chunks(32).map(|chunk| packed(chunk, plane) as u32));
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::integer_product;
    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn bit_planes_have_the_product_of_the_integers(n in 1_usize..150, bits in 2_u32..28, seed: u64) {
            let (a, b) = (Square::drawn(n, bits, seed).unwrap(), Square::drawn(n, bits, !seed).unwrap());
            prop_assert_eq!(bit_plane_product(&a, &b).unwrap(), integer_product(&a, &b).unwrap());
        }
    }

    #[test]
    fn extremes_use_every_bit() {
        for (n, bits) in [(1, 32), (2, 31), (64, 29), (65, 2), (200, 28)] {
            let (least, largest) = (-(1_i64 << (bits - 1)), (1_i64 << (bits - 1)) - 1);
            for [x, y] in [[least, least], [least, largest], [largest, largest], [-1, least]] {
                let (a, b) = (Square::filled(n, bits, x).unwrap(), Square::filled(n, bits, y).unwrap());
                assert_eq!(bit_plane_product(&a, &b).unwrap(), integer_product(&a, &b).unwrap(), "{n} {bits} {x} {y}");
            }
        }
    }

    #[test]
    fn a_turned_bit_is_seen() {
        let (a, b) = (Square::filled(70, 5, 3).unwrap(), Square::filled(70, 5, -16).unwrap());
        let mut elements = a.elements().to_vec();
        elements[69] ^= 8;
        let other = Square::new(70, 5, elements).unwrap();
        assert_ne!(bit_plane_product(&other, &b).unwrap(), bit_plane_product(&a, &b).unwrap());
    }
}
