//! The vector instructions the raster kernel is written in: sixteen 32-bit words, one an image row.
//!
//! A [`Simd`] value is a token: it can only be made where the processor has the instructions it stands for, so holding
//! one proves that using them is sound. Each instruction set is one file with one short function an operation.

/// Sixteen 32-bit lanes in memory, aligned to a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C, align(64))]
pub(super) struct Lanes(pub(super) [u32; 16]);

/// `BEFORE[other][lane]` is 1 where `other` comes before `lane` though their values are equal, else 0.
pub(super) const BEFORE: [Lanes; 16] = {
    let mut before = [Lanes([0; 16]); 16];
    let mut other = 0;
    while other < 16 {
        let mut lane = 0;
        while lane < other {
            before[other].0[lane] = 1;
            lane += 1;
        }
        other += 1;
    }
    before
};

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
    /// The place of each of sixteen values, none of them the largest there is, from the least up; equal ones come last first.
    #[inline(always)]
    fn places(self, values: &[i32; 16]) -> [u32; 16] {
        let mut places = [0; 16];
        for other in 0..16 {
            for lane in 0..16 {
                places[lane] += u32::from(values[other] < values[lane].wrapping_add(BEFORE[other].0[lane] as i32));
            }
        }
        places
    }
    /// The smallest of sixteen values.
    fn least(self, values: &[i32; 16]) -> i32;
    /// The largest of sixteen values.
    fn most(self, values: &[i32; 16]) -> i32;
    fn no_bits(self) -> Self::Sum;
    /// The sum plus the number of bits set in `words`.
    fn count(self, sum: Self::Sum, words: Self::Words) -> Self::Sum;
    fn total(self, sum: Self::Sum) -> u32;
    /// The totals of sums, and of seven that are the digits of a binary number, the lowest first.
    #[inline(always)]
    fn totals(self, sums: [Self::Sum; 3], digits: [Self::Sum; 7]) -> ([u32; 3], u32) {
        let number = digits.into_iter().enumerate().fold(0, |number, (bit, sum)| number + (self.total(sum) << bit));
        (sums.map(|sum| self.total(sum)), number)
    }

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

#[cfg(test)]
mod tests {
    use super::super::instruction_set::{Code, InstructionSet};
    use super::*;

    struct Places([i32; 16]);

    impl Task for Places {
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) {
            let Self(values) = self;
            let before = |other: usize, lane: usize| (values[other], lane) < (values[lane], other);
            let expected: Vec<u32> =
                (0..16).map(|lane| (0..16).filter(|&other| before(other, lane)).count() as u32).collect();
            assert_eq!(simd.places(&values).to_vec(), expected, "{values:?}");
        }
    }

    struct Totals([Lanes; 10]);

    impl Task for Totals {
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) {
            let bits = |at: usize| self.0[at].0.iter().map(|word| word.count_ones()).sum::<u32>();
            let sum = |at: usize| simd.count(simd.no_bits(), simd.load(&self.0[at]));
            let (sums, number) =
                simd.totals([sum(0), sum(1), sum(2)], [sum(3), sum(4), sum(5), sum(6), sum(7), sum(8), sum(9)]);
            assert_eq!(sums, [bits(0), bits(1), bits(2)]);
            assert_eq!(number, (0..7).map(|bit| bits(3 + bit) << bit).sum::<u32>());
        }
    }

    /// On every instruction set that is here; of values many are equal.
    #[test]
    fn places_and_totals_are_those_of_their_definitions() {
        let mut state = 5_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 8
        };
        let codes: Vec<Code> = InstructionSet::ALL.into_iter().filter_map(Code::of).collect();
        for range in [1, 2, 5, 40, 1 << 24] {
            let values = std::array::from_fn(|_| (random() % range) as i32);
            codes.iter().for_each(|code| code.run(Places(values)));
            let words = std::array::from_fn(|_| Lanes(std::array::from_fn(|_| random().wrapping_mul(range))));
            codes.iter().for_each(|code| code.run(Totals(words)));
        }
        codes.iter().for_each(|code| code.run(Places([i32::MAX - 1; 16])));
        codes.iter().for_each(|code| code.run(Places(std::array::from_fn(|lane| -(lane as i32)))));
    }
}
