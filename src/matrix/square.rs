//! Square matrices of two's complement integers, and their product as the integers say.

use anyhow::{Result, ensure};

/// Bits of an element at most.
pub const MOST_BITS: u32 = 32;
/// Rows at most.
pub const MOST_ROWS: usize = 4096;

/// An n x n matrix of integers of so many bits, two's complement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Square {
    n: usize,
    bits: u32,
    elements: Vec<i64>,
}

impl Square {
    /// A matrix from its elements, row by row.
    ///
    /// # Errors
    /// When there are not n x n elements, n is 0 or beyond 4096, the bits are not 2 to 32, an element does not fit them, or a sum
    /// of n products might not fit 64 bits.
    pub fn new(n: usize, bits: u32, elements: Vec<i64>) -> Result<Self> {
        ensure!((1..=MOST_ROWS).contains(&n), "matrices of {n} x {n} elements, expected 1 to {MOST_ROWS} rows");
        ensure!((2..=MOST_BITS).contains(&bits), "elements of {bits} bits, expected 2 to {MOST_BITS}");
        ensure!(
            sum_bits(n, bits) <= 64,
            "a product of {n} x {n} matrices of {bits} bits has elements of {} bits, expected at most 64: fewer rows or bits",
            sum_bits(n, bits)
        );
        ensure!(elements.len() == n * n, "{} elements, expected {n} x {n}", elements.len());
        let half = 1_i64 << (bits - 1);
        if let Some(wrong) = elements.iter().find(|element| !(-half..half).contains(*element)) {
            anyhow::bail!("the element {wrong}, expected {} to {} for {bits} bits", -half, half - 1);
        }
        Ok(Self { n, bits, elements })
    }

    /// Elements drawn from a seed, any of the range as likely; one in eight is the least or the largest.
    ///
    /// # Errors
    /// As [`Square::new`].
    pub fn drawn(n: usize, bits: u32, seed: u64) -> Result<Self> {
        let count = if n <= MOST_ROWS { n * n } else { 0 };
        let half = 1_i64 << (bits.clamp(1, MOST_BITS) - 1);
        let element = |index: usize| {
            let word = scrambled(seed ^ (index as u64) << 20);
            match word >> 61 {
                0 if word & 1 == 0 => -half,
                0 => half - 1,
                _ => (word % (2 * half as u64)) as i64 - half,
            }
        };
        Self::new(n, bits, (0..count).map(element).collect())
    }

    /// The same element everywhere.
    ///
    /// # Errors
    /// As [`Square::new`].
    pub fn filled(n: usize, bits: u32, element: i64) -> Result<Self> {
        let count = if n <= MOST_ROWS { n * n } else { 0 };
        Self::new(n, bits, vec![element; count])
    }

    /// Rows and columns.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Bits of an element.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// A row.
    pub fn row(&self, row: usize) -> &[i64] {
        &self.elements[row * self.n..][..self.n]
    }

    /// A column.
    pub fn column(&self, column: usize) -> Vec<i64> {
        (0..self.n).map(|row| self.elements[row * self.n + column]).collect()
    }

    /// All elements, row by row.
    pub fn elements(&self) -> &[i64] {
        &self.elements
    }
}

/// Bits of a sum of n products of two numbers of so many bits.
pub(super) fn sum_bits(n: usize, bits: u32) -> u32 {
    2 * bits + n.next_power_of_two().trailing_zeros()
}

/// A well mixed word of a number: two multiplications with shifts between.
fn scrambled(number: u64) -> u64 {
    let mut word = number.wrapping_add(0x632B_E59B_D9B4_E019);
    for _ in 0..2 {
        word = (word ^ (word >> 32)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    }
    word ^ (word >> 32)
}

/// Two matrices belong together: as many rows, and elements of as many bits.
pub(super) fn check_pair(a: &Square, b: &Square) -> Result<()> {
    ensure!(
        a.n == b.n && a.bits == b.bits,
        "a matrix of {0} x {0} elements of {1} bits and one of {2} x {2} of {3} bits, expected the same size and bits",
        a.n,
        a.bits,
        b.n,
        b.bits
    );
    Ok(())
}

/// The product by multiplying and adding integers, row by row.
///
/// # Errors
/// When the matrices are of unlike size or bits.
pub fn integer_product(a: &Square, b: &Square) -> Result<Vec<i64>> {
    check_pair(a, b)?;
    let n = a.n;
    let mut product = vec![0_i64; n * n];
    for (i, out) in product.chunks_mut(n).enumerate() {
        for (k, &factor) in a.row(i).iter().enumerate() {
            out.iter_mut().zip(b.row(k)).for_each(|(sum, &element)| *sum = sum.wrapping_add(factor * element));
        }
    }
    Ok(product)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_by_hand() {
        let a = Square::new(2, 8, vec![1, -2, 3, 4]).unwrap();
        let b = Square::new(2, 8, vec![5, 6, -128, 127]).unwrap();
        assert_eq!(integer_product(&a, &b).unwrap(), [261, -248, -497, 526]);
        assert_eq!(a.column(1), [-2, 4]);
    }

    #[test]
    fn what_is_no_matrix_is_named() {
        let message = |result: Result<Square>| result.unwrap_err().to_string();
        assert!(message(Square::new(2, 4, vec![0, 0, 8, 0])).contains("the element 8, expected -8 to 7 for 4 bits"));
        assert!(message(Square::new(2, 4, vec![0; 3])).contains("3 elements, expected 2 x 2"));
        assert!(message(Square::drawn(0, 4, 1)).contains("0 x 0"));
        assert!(message(Square::drawn(usize::MAX, 4, 1)).contains("expected 1 to 4096 rows"));
        assert!(message(Square::drawn(4, 40, 1)).contains("40 bits, expected 2 to 32"));
        assert!(message(Square::drawn(2, 32, 1)).contains("elements of 65 bits, expected at most 64"));
        let (a, b) = (Square::filled(2, 4, 1).unwrap(), Square::filled(2, 5, 1).unwrap());
        assert!(integer_product(&a, &b).unwrap_err().to_string().contains("expected the same size and bits"));
    }

    #[test]
    fn drawn_elements_cover_their_range() {
        let drawn = Square::drawn(64, 5, 3).unwrap();
        for value in -16..16 {
            let count = drawn.elements().iter().filter(|&&element| element == value).count();
            assert!(count > 60, "{value} is drawn {count} times of 4096");
        }
        assert_ne!(drawn, Square::drawn(64, 5, 4).unwrap());
    }
}
