//! The kernel's operations on AVX2: sixteen lanes are two registers.

use std::arch::x86_64::*;

use super::instruction_set::Avx2;
use super::simd::{Lanes, Ramp, Sides, Simd, Spans, with_token};

/// Two registers, the first eight lanes and the others.
type Pair = [__m256i; 2];

impl Simd for Avx2 {
    const SKIPS_EDGES: bool = true;
    type Words = Pair;
    type Rows = [__m256d; 4];
    type ShortRows = [__m256; 2];
    type Mask = Pair;
    type Sum = __m256i;

    #[inline(always)]
    fn load(self, lanes: &Lanes) -> Pair {
        with_token!([_mm256_load_si256(lanes.0.as_ptr().cast()), _mm256_load_si256(lanes.0.as_ptr().add(8).cast())])
    }
    #[inline(always)]
    fn store(self, words: Pair, lanes: &mut Lanes) {
        with_token!({
            _mm256_store_si256(lanes.0.as_mut_ptr().cast(), words[0]);
            _mm256_store_si256(lanes.0.as_mut_ptr().add(8).cast(), words[1]);
        });
    }
    #[inline(always)]
    fn splat(self, value: u32) -> Pair {
        with_token!([_mm256_set1_epi32(value as i32); 2])
    }
    #[inline(always)]
    fn and(self, a: Pair, b: Pair) -> Pair {
        with_token!([_mm256_and_si256(a[0], b[0]), _mm256_and_si256(a[1], b[1])])
    }
    #[inline(always)]
    fn or(self, a: Pair, b: Pair) -> Pair {
        with_token!([_mm256_or_si256(a[0], b[0]), _mm256_or_si256(a[1], b[1])])
    }
    #[inline(always)]
    fn and_not(self, a: Pair, b: Pair) -> Pair {
        with_token!([_mm256_andnot_si256(b[0], a[0]), _mm256_andnot_si256(b[1], a[1])])
    }
    #[inline(always)]
    fn min(self, a: Pair, b: Pair) -> Pair {
        with_token!([_mm256_min_epi32(a[0], b[0]), _mm256_min_epi32(a[1], b[1])])
    }
    #[inline(always)]
    fn max(self, a: Pair, b: Pair) -> Pair {
        with_token!([_mm256_max_epi32(a[0], b[0]), _mm256_max_epi32(a[1], b[1])])
    }
    #[inline(always)]
    fn sub_to_zero(self, a: Pair, b: Pair) -> Pair {
        with_token!([_mm256_subs_epu16(a[0], b[0]), _mm256_subs_epu16(a[1], b[1])])
    }
    #[inline(always)]
    fn ones_from(self, count: Pair) -> Pair {
        with_token!({
            let ones = _mm256_set1_epi32(-1);
            [_mm256_sllv_epi32(ones, count[0]), _mm256_sllv_epi32(ones, count[1])]
        })
    }
    #[inline(always)]
    fn shift_left(self, words: Pair, count: u32) -> Pair {
        with_token!({
            let count = _mm_cvtsi32_si128(count as i32);
            [_mm256_sll_epi32(words[0], count), _mm256_sll_epi32(words[1], count)]
        })
    }
    #[inline(always)]
    fn shift_right(self, words: Pair, count: u32) -> Pair {
        with_token!({
            let count = _mm_cvtsi32_si128(count as i32);
            [_mm256_srl_epi32(words[0], count), _mm256_srl_epi32(words[1], count)]
        })
    }
    #[inline(always)]
    fn mask(self, bits: u64) -> Pair {
        with_token!({
            let bits = _mm256_set1_epi32(bits as i32);
            let low = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let high = _mm256_setr_epi32(256, 512, 1024, 2048, 4096, 8192, 16384, 32768);
            [
                _mm256_cmpeq_epi32(_mm256_and_si256(bits, low), low),
                _mm256_cmpeq_epi32(_mm256_and_si256(bits, high), high),
            ]
        })
    }
    #[inline(always)]
    fn add_where(self, mask: Pair, a: Pair, b: Pair, c: Pair) -> Pair {
        self.or(a, self.and(mask, self.and_not(b, c)))
    }
    #[inline(always)]
    fn first_rows(self) -> ([__m256d; 4], [__m256; 2]) {
        with_token!((
            [
                _mm256_setr_pd(0.0, 1.0, 2.0, 3.0),
                _mm256_setr_pd(4.0, 5.0, 6.0, 7.0),
                _mm256_setr_pd(8.0, 9.0, 10.0, 11.0),
                _mm256_setr_pd(12.0, 13.0, 14.0, 15.0),
            ],
            [
                _mm256_setr_ps(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0),
                _mm256_setr_ps(8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0),
            ],
        ))
    }
    #[inline(always)]
    fn next_rows(self, (rows, short): ([__m256d; 4], [__m256; 2])) -> ([__m256d; 4], [__m256; 2]) {
        with_token!({
            let (double, single) = (_mm256_set1_pd(16.0), _mm256_set1_ps(16.0));
            (
                [
                    _mm256_add_pd(rows[0], double),
                    _mm256_add_pd(rows[1], double),
                    _mm256_add_pd(rows[2], double),
                    _mm256_add_pd(rows[3], double),
                ],
                [_mm256_add_ps(short[0], single), _mm256_add_ps(short[1], single)],
            )
        })
    }
    #[inline(always)]
    fn min_where(self, mask: Pair, a: Pair, b: Pair) -> Pair {
        with_token!([
            _mm256_blendv_epi8(a[0], _mm256_min_epi32(a[0], b[0]), mask[0]),
            _mm256_blendv_epi8(a[1], _mm256_min_epi32(a[1], b[1]), mask[1]),
        ])
    }
    #[inline(always)]
    fn max_where(self, mask: Pair, a: Pair, b: Pair) -> Pair {
        with_token!([
            _mm256_blendv_epi8(a[0], _mm256_max_epi32(a[0], b[0]), mask[0]),
            _mm256_blendv_epi8(a[1], _mm256_max_epi32(a[1], b[1]), mask[1]),
        ])
    }
    #[inline(always)]
    fn is_zero(self, words: Pair) -> bool {
        with_token!({
            let any = _mm256_or_si256(words[0], words[1]);
            _mm256_testz_si256(any, any)
        }) != 0
    }
    #[inline(always)]
    fn line(self, rows: [__m256d; 4], slope: f64, offset: f64) -> Pair {
        with_token!({
            let (slope, offset) = (_mm256_set1_pd(slope), _mm256_set1_pd(offset));
            let a = _mm256_cvttpd_epi32(_mm256_floor_pd(_mm256_fmadd_pd(slope, rows[0], offset)));
            let b = _mm256_cvttpd_epi32(_mm256_floor_pd(_mm256_fmadd_pd(slope, rows[1], offset)));
            let c = _mm256_cvttpd_epi32(_mm256_floor_pd(_mm256_fmadd_pd(slope, rows[2], offset)));
            let d = _mm256_cvttpd_epi32(_mm256_floor_pd(_mm256_fmadd_pd(slope, rows[3], offset)));
            [_mm256_set_m128i(b, a), _mm256_set_m128i(d, c)]
        })
    }
    #[inline(always)]
    fn short_line(self, rows: [__m256; 2], slope: f32, offset: f32) -> Pair {
        with_token!({
            let (slope, offset) = (_mm256_set1_ps(slope), _mm256_set1_ps(offset));
            [
                _mm256_cvttps_epi32(_mm256_floor_ps(_mm256_fmadd_ps(slope, rows[0], offset))),
                _mm256_cvttps_epi32(_mm256_floor_ps(_mm256_fmadd_ps(slope, rows[1], offset))),
            ]
        })
    }
    #[inline(always)]
    fn least(self, values: &[i32; 16]) -> i32 {
        with_token!({
            let first = values.as_ptr();
            let eight = _mm256_min_epi32(_mm256_loadu_si256(first.cast()), _mm256_loadu_si256(first.add(8).cast()));
            let four = _mm_min_epi32(_mm256_castsi256_si128(eight), _mm256_extracti128_si256::<1>(eight));
            let two = _mm_min_epi32(four, _mm_shuffle_epi32::<0b1110>(four));
            _mm_cvtsi128_si32(_mm_min_epi32(two, _mm_shuffle_epi32::<0b01>(two)))
        })
    }
    #[inline(always)]
    fn most(self, values: &[i32; 16]) -> i32 {
        with_token!({
            let first = values.as_ptr();
            let eight = _mm256_max_epi32(_mm256_loadu_si256(first.cast()), _mm256_loadu_si256(first.add(8).cast()));
            let four = _mm_max_epi32(_mm256_castsi256_si128(eight), _mm256_extracti128_si256::<1>(eight));
            let two = _mm_max_epi32(four, _mm_shuffle_epi32::<0b1110>(four));
            _mm_cvtsi128_si32(_mm_max_epi32(two, _mm_shuffle_epi32::<0b01>(two)))
        })
    }
    #[inline(always)]
    fn no_bits(self) -> __m256i {
        with_token!(_mm256_setzero_si256())
    }
    #[inline(always)]
    fn count(self, sum: __m256i, words: Pair) -> __m256i {
        // Bits of each nibble by table, bytes summed into four 64-bit lanes.
        with_token!({
            let table = _mm256_setr_epi8(
                0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4, 0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,
            );
            let nibble = _mm256_set1_epi8(0x0f);
            let [w, v] = words;
            let bytes = _mm256_add_epi8(
                _mm256_add_epi8(
                    _mm256_shuffle_epi8(table, _mm256_and_si256(w, nibble)),
                    _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi32::<4>(w), nibble)),
                ),
                _mm256_add_epi8(
                    _mm256_shuffle_epi8(table, _mm256_and_si256(v, nibble)),
                    _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi32::<4>(v), nibble)),
                ),
            );
            _mm256_add_epi64(sum, _mm256_sad_epu8(bytes, _mm256_setzero_si256()))
        })
    }
    #[inline(always)]
    fn total(self, sum: __m256i) -> u32 {
        with_token!({
            let halves = _mm_add_epi64(_mm256_castsi256_si128(sum), _mm256_extracti128_si256::<1>(sum));
            (_mm_cvtsi128_si64(halves) + _mm_extract_epi64::<1>(halves)) as u32
        })
    }
    #[inline(always)]
    fn spans(self, sides: &Sides, ramp: &Ramp, first: i32, spans: &mut Spans) -> u32 {
        let Sides { slopes, offsets, length } = sides;
        let mut some = 0;
        for half in 0..2 {
            with_token!({
                let rows = _mm256_add_pd(_mm256_set1_pd(f64::from(first)), self.first_rows().0[half]);
                let a = _mm256_fmadd_pd(_mm256_set1_pd(slopes[0]), rows, _mm256_set1_pd(offsets[0]));
                let b = _mm256_fmadd_pd(_mm256_set1_pd(slopes[1]), rows, _mm256_set1_pd(offsets[1]));
                let c = _mm256_fmadd_pd(_mm256_set1_pd(slopes[2]), rows, _mm256_set1_pd(offsets[2]));
                let d = _mm256_fmadd_pd(_mm256_set1_pd(slopes[3]), rows, _mm256_set1_pd(offsets[3]));
                // The floor of the larger is the larger floor.
                let start = _mm256_floor_pd(_mm256_max_pd(_mm256_max_pd(a, b), _mm256_setzero_pd()));
                let end = _mm256_floor_pd(_mm256_min_pd(_mm256_min_pd(c, d), _mm256_set1_pd(*length)));
                let depth = _mm256_fmadd_pd(_mm256_set1_pd(ramp.across), rows, _mm256_set1_pd(ramp.depth));
                let depth = _mm256_floor_pd(_mm256_fmadd_pd(_mm256_set1_pd(ramp.along), start, depth));
                let steps = _mm_slli_epi32::<8>(_mm256_cvttpd_epi32(depth));
                let keys = _mm_add_epi32(steps, _mm_set1_epi32(ramp.base as i32));
                // Half of eight aligned words each.
                _mm_store_si128(spans.starts.as_mut_ptr().add(4 * half).cast(), _mm256_cvttpd_epi32(start));
                _mm_store_si128(spans.ends.as_mut_ptr().add(4 * half).cast(), _mm256_cvttpd_epi32(end));
                _mm_store_si128(spans.keys.as_mut_ptr().add(4 * half).cast(), keys);
                some |= (_mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(start, end)) as u32) << (4 * half);
            });
        }
        some
    }
    #[inline(always)]
    fn nearer(self, keys: &mut [u32], count: usize, ramp: &Ramp, [place, row]: [i32; 2]) {
        with_token!({
            let along = _mm256_set1_pd(ramp.along);
            let depth = _mm256_set1_pd(ramp.across * f64::from(row) + ramp.depth);
            let base = _mm256_set1_epi32(ramp.base as i32);
            let mut places = _mm256_add_pd(_mm256_set1_pd(f64::from(place)), self.first_rows().0[0]);
            let mut left = _mm256_sub_epi32(_mm256_set1_epi32(count as i32), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
            for eight in keys[..count.next_multiple_of(8)].chunks_exact_mut(8) {
                let low = _mm256_cvttpd_epi32(_mm256_floor_pd(_mm256_fmadd_pd(along, places, depth)));
                places = _mm256_add_pd(places, _mm256_set1_pd(4.0));
                let high = _mm256_cvttpd_epi32(_mm256_floor_pd(_mm256_fmadd_pd(along, places, depth)));
                places = _mm256_add_pd(places, _mm256_set1_pd(4.0));
                let new = _mm256_add_epi32(_mm256_slli_epi32::<8>(_mm256_set_m128i(high, low)), base);
                let old = _mm256_loadu_si256(eight.as_ptr().cast());
                let within = _mm256_cmpgt_epi32(left, _mm256_setzero_si256());
                let both = _mm256_blendv_epi8(old, _mm256_min_epu32(old, new), within);
                _mm256_storeu_si256(eight.as_mut_ptr().cast(), both);
                left = _mm256_sub_epi32(left, _mm256_set1_epi32(8));
            }
        });
    }
    /// Into the first sum: bits of a nibble, by table times what they count, come to 240 a byte at most.
    #[inline(always)]
    fn count_codes(self, sums: [__m256i; 4], bits: [Pair; 4]) -> [__m256i; 4] {
        with_token!({
            let nibble = _mm256_set1_epi8(0x0f);
            let mut table = _mm256_setr_epi8(
                0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4, 0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,
            );
            let mut bytes = _mm256_setzero_si256();
            for [w, v] in bits {
                let first = _mm256_add_epi8(
                    _mm256_shuffle_epi8(table, _mm256_and_si256(w, nibble)),
                    _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi32::<4>(w), nibble)),
                );
                let second = _mm256_add_epi8(
                    _mm256_shuffle_epi8(table, _mm256_and_si256(v, nibble)),
                    _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi32::<4>(v), nibble)),
                );
                bytes = _mm256_add_epi8(bytes, _mm256_add_epi8(first, second));
                table = _mm256_add_epi8(table, table);
            }
            let sum = _mm256_add_epi64(sums[0], _mm256_sad_epu8(bytes, _mm256_setzero_si256()));
            [sum, sums[1], sums[2], sums[3]]
        })
    }
    #[inline(always)]
    fn total_codes(self, sums: [__m256i; 4]) -> u32 {
        self.total(sums[0])
    }
}
