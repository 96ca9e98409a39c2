//! The vector instructions the raster kernel is written in: sixteen 32-bit words, one an image row.
//!
//! A [`Simd`] value is a token: it can only be made where the processor has the instructions it stands for, so holding
//! one proves that using them is sound. Each instruction set is one file with one short function an operation.

/// Sixteen 32-bit lanes in memory, aligned to a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C, align(64))]
pub(super) struct Lanes(pub(super) [u32; 16]);

/// What is compiled anew for every instruction set.
pub(super) trait Task {
    /// Does it with the operations of `simd`; has to be inlined into a function that is compiled for these.
    fn run<S: Simd>(self, simd: S);
}

/// Lines that bound what lies between them, in a row or in a column: its first pixel there is the larger of the floors of the first two,
/// the one after its last the smaller of those of the others.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sides {
    /// Pixels from one row to the next, and in row 0.
    pub(super) slopes: [f64; 4],
    pub(super) offsets: [f64; 4],
    /// Pixels that a row has.
    pub(super) length: f64,
}

/// Spans of eight rows, from `starts` to before `ends`, and the keys of their first pixels.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub(super) struct Spans {
    pub(super) starts: [i32; 8],
    pub(super) ends: [i32; 8],
    pub(super) keys: [u32; 8],
}

/// Keys in a plane: `base` plus 256 times the floor of `along * place + (across * row + depth)`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ramp {
    pub(super) along: f64,
    pub(super) across: f64,
    pub(super) depth: f64,
    pub(super) base: u32,
}

impl Ramp {
    /// The key of a pixel.
    #[inline(always)]
    pub(super) fn key(&self, place: i32, row: i32) -> u32 {
        let depth = self.along * f64::from(place) + (self.across * f64::from(row) + self.depth);
        self.base.wrapping_add((depth.floor() as i32 as u32) << 8)
    }
}

/// An instruction set, by the operations the kernel needs. Lanes hold rows of one image, two's complement where signed.
pub(super) trait Simd: Copy + Send + Sync + 'static {
    /// Whether a test for an edge that has no row in a block costs less than drawing nothing.
    const SKIPS_EDGES: bool;
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
    /// Signed.
    fn min(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// Signed.
    fn max(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// `a - b`, 0 where that is negative; any value where one is 65536 or more.
    fn sub_to_zero(self, a: Self::Words, b: Self::Words) -> Self::Words;
    /// `u32::MAX << count`, 0 where the unsigned count is 32 or more.
    fn ones_from(self, count: Self::Words) -> Self::Words;
    /// `words << count`, 0 where the count is 32 or more.
    fn shift_left(self, words: Self::Words, count: u32) -> Self::Words;
    /// `words >> count`, 0 where the count is 32 or more.
    fn shift_right(self, words: Self::Words, count: u32) -> Self::Words;
    /// The mask that holds in the lanes of the set bits, of the lowest sixteen.
    fn mask(self, bits: u64) -> Self::Mask;
    /// The smaller of both where the mask holds, else `a`; signed.
    fn min_where(self, mask: Self::Mask, a: Self::Words, b: Self::Words) -> Self::Words;
    /// The larger of both where the mask holds, else `a`; signed.
    fn max_where(self, mask: Self::Mask, a: Self::Words, b: Self::Words) -> Self::Words;
    /// `a | (b & !c)` where the mask holds, else `a`.
    fn add_where(self, mask: Self::Mask, a: Self::Words, b: Self::Words, c: Self::Words) -> Self::Words;
    /// Whether every bit is zero.
    fn is_zero(self, words: Self::Words) -> bool;
    /// The rows 0 to 15.
    fn first_rows(self) -> (Self::Rows, Self::ShortRows);
    /// The sixteen rows below.
    fn next_rows(self, rows: (Self::Rows, Self::ShortRows)) -> (Self::Rows, Self::ShortRows);
    /// floor(slope * row + offset) as signed words; any value where that does not fit 32 bits.
    fn line(self, rows: Self::Rows, slope: f64, offset: f64) -> Self::Words;
    /// [`Self::line`] in single precision.
    fn short_line(self, rows: Self::ShortRows, slope: f32, offset: f32) -> Self::Words;
    /// The smallest of sixteen values.
    fn least(self, values: &[i32; 16]) -> i32;
    /// The largest of sixteen values.
    fn most(self, values: &[i32; 16]) -> i32;
    fn no_bits(self) -> Self::Sum;
    /// The sum plus the number of bits set in `words`.
    fn count(self, sum: Self::Sum, words: Self::Words) -> Self::Sum;
    fn total(self, sum: Self::Sum) -> u32;

    /// The spans of the eight rows from `first` on between the floors of the lines of `sides`; a bit for each row that has a pixel. Those
    /// of the others are anything.
    fn spans(self, sides: &Sides, ramp: &Ramp, first: i32, spans: &mut Spans) -> u32;
    /// The smaller of `keys` and those of a ramp from a place in a row on, for the first `count` of them. There are at least as many as
    /// the next multiple of eight.
    fn nearer(self, keys: &mut [u32], count: usize, ramp: &Ramp, place_and_row: [i32; 2]);

    /// The sums plus those of codes whose bits are the words', the lowest first.
    #[inline(always)]
    fn count_codes(self, mut sums: [Self::Sum; 4], bits: [Self::Words; 4]) -> [Self::Sum; 4] {
        for bit in 0..4 {
            sums[bit] = self.count(sums[bit], bits[bit]);
        }
        sums
    }

    /// The sum that [`Self::count_codes`] has come to.
    #[inline(always)]
    fn total_codes(self, sums: [Self::Sum; 4]) -> u32 {
        (0..4).fold(0, |total, bit| total + (self.total(sums[bit]) << bit))
    }
}

/// An intrinsic called on behalf of a token.
#[cfg(target_arch = "x86_64")]
macro_rules! with_token {
    ($call:expr) => {
        // SAFETY: `self` exists, so `detect` found every instruction its file uses; the pointers come from references to sixteen
        // aligned words, of which a register takes eight or all, or to as many as it takes.
        unsafe { $call }
    };
}
#[cfg(target_arch = "x86_64")]
pub(super) use with_token;
