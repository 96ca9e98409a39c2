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
    /// Sixteen row numbers in single precision.
    type ShortRows: Copy;
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
    fn sub(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// Signed.
    fn min(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// Signed.
    fn max(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// `value << count`, 0 where the unsigned count is 32 or more.
    fn shift_left(self, value: Self::Words, count: Self::Words) -> Self::Words;
    /// Unsigned `a < b`.
    fn below(self, a: Self::Words, b: Self::Words) -> Self::Mask;
    /// The smaller of both where the mask holds, else `a`; signed.
    fn min_where(self, mask: Self::Mask, a: Self::Words, b: Self::Words) -> Self::Words;
    /// The larger of both where the mask holds, else `a`; signed.
    fn max_where(self, mask: Self::Mask, a: Self::Words, b: Self::Words) -> Self::Words;
    /// `1 << count` where the mask holds and the unsigned count is under 32, else 0.
    fn bit(self, mask: Self::Mask, count: Self::Words) -> Self::Words;
    /// Whether every bit is zero.
    fn is_zero(self, words: Self::Words) -> bool;
    /// The row numbers `first, first + 1, …` as words.
    fn row_words(self, first: u32) -> Self::Words;
    /// The row numbers `first, first + 1, …` in double precision.
    fn rows(self, first: u32) -> Self::Rows;
    /// floor(slope * row + offset) as signed words; any value where that does not fit 32 bits.
    fn line(self, rows: Self::Rows, slope: f64, offset: f64) -> Self::Words;
    /// The row numbers `first, first + 1, …` in single precision.
    fn short_rows(self, first: u32) -> Self::ShortRows;
    /// [`Self::line`] in single precision.
    fn short_line(self, rows: Self::ShortRows, slope: f32, offset: f32) -> Self::Words;
    fn no_bits(self) -> Self::Sum;
    /// The sum plus the number of bits set in `words`.
    fn count(self, sum: Self::Sum, words: Self::Words) -> Self::Sum;
    fn total(self, sum: Self::Sum) -> u32;
}
