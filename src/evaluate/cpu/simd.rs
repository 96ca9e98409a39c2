//! The vector instructions the raster kernel is written in: sixteen 32-bit words, one an image row.
//!
//! A [`Simd`] value is a token: it can only be made where the processor has the instructions it stands for, so holding
//! one proves that using them is sound. Each instruction set is one file with one short function an operation.

/// Sixteen 32-bit lanes in memory, aligned to a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C, align(64))]
pub(super) struct Lanes(pub(super) [u32; 16]);

/// An instruction set, by the operations the kernel needs. Lanes hold rows of one image, two's complement where signed.
pub(super) trait Simd: Copy + Send + Sync + 'static {
    /// Sixteen 32-bit words.
    type Words: Copy;
    /// Sixteen row numbers in double precision.
    type Rows: Copy;
    /// Sixteen truth values.
    type Mask: Copy;
    /// A running sum of bit counts.
    type Sum: Copy;

    fn load(self, lanes: &Lanes) -> Self::Words;
    fn store(self, words: Self::Words, lanes: &mut Lanes);
    fn splat(self, value: u32) -> Self::Words;
    fn and(self, a: Self::Words, b: Self::Words) -> Self::Words;
    fn or(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// `a & !b`
    fn and_not(self, a: Self::Words, b: Self::Words) -> Self::Words;
    fn add(self, a: Self::Words, b: Self::Words) -> Self::Words;
    fn sub(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// Signed.
    fn min(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// Signed.
    fn max(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// `value << count`, 0 where the unsigned count is 32 or more.
    fn shift_left(self, value: Self::Words, count: Self::Words) -> Self::Words;
    /// Unsigned `a < b`.
    fn below(self, a: Self::Words, b: Self::Words) -> Self::Mask;
    /// `a` where the mask holds, else `b`.
    fn select(self, mask: Self::Mask, a: Self::Words, b: Self::Words) -> Self::Words;
    /// Whether every bit is zero.
    fn is_zero(self, words: Self::Words) -> bool;
    /// The row numbers `first, first + 1, …` as words.
    fn row_words(self, first: u32) -> Self::Words;
    /// The row numbers `first, first + 1, …` in double precision.
    fn rows(self, first: u32) -> Self::Rows;
    /// floor(slope * row + offset) as signed words; any value where that does not fit 32 bits.
    fn line(self, rows: Self::Rows, slope: f64, offset: f64) -> Self::Words;
    fn no_bits(self) -> Self::Sum;
    /// The sum plus the number of bits set in `words`.
    fn count(self, sum: Self::Sum, words: Self::Words) -> Self::Sum;
    fn total(self, sum: Self::Sum) -> u32;
}
