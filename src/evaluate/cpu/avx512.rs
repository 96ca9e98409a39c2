//! The kernel's operations on AVX-512: sixteen lanes are one register, masks are mask registers.

use std::arch::x86_64::*;

use super::instruction_set::Avx512;
use super::simd::{BEFORE, Lanes, Ramp, Sides, Simd, Spans, with_token};

impl Simd for Avx512 {
    const SKIPS_EDGES: bool = false;
    type Words = __m512i;
    type Rows = (__m512d, __m512d);
    type ShortRows = __m512;
    type Mask = __mmask16;
    type Sum = __m512i;

    #[inline(always)]
    fn load(self, lanes: &Lanes) -> __m512i {
        with_token!(_mm512_load_si512(lanes.0.as_ptr().cast()))
    }
    #[inline(always)]
    fn store(self, words: __m512i, lanes: &mut Lanes) {
        with_token!(_mm512_store_si512(lanes.0.as_mut_ptr().cast(), words));
    }
    #[inline(always)]
    fn splat(self, value: u32) -> __m512i {
        with_token!(_mm512_set1_epi32(value as i32))
    }
    #[inline(always)]
    fn and(self, a: __m512i, b: __m512i) -> __m512i {
        with_token!(_mm512_and_si512(a, b))
    }
    #[inline(always)]
    fn or(self, a: __m512i, b: __m512i) -> __m512i {
        with_token!(_mm512_or_si512(a, b))
    }
    #[inline(always)]
    fn and_not(self, a: __m512i, b: __m512i) -> __m512i {
        with_token!(_mm512_andnot_si512(b, a))
    }
    #[inline(always)]
    fn min(self, a: __m512i, b: __m512i) -> __m512i {
        with_token!(_mm512_min_epi32(a, b))
    }
    #[inline(always)]
    fn max(self, a: __m512i, b: __m512i) -> __m512i {
        with_token!(_mm512_max_epi32(a, b))
    }
    #[inline(always)]
    fn sub_to_zero(self, a: __m512i, b: __m512i) -> __m512i {
        with_token!(_mm512_subs_epu16(a, b))
    }
    #[inline(always)]
    fn ones_from(self, count: __m512i) -> __m512i {
        with_token!(_mm512_sllv_epi32(_mm512_set1_epi32(-1), count))
    }
    #[inline(always)]
    fn shift_left(self, words: __m512i, count: u32) -> __m512i {
        with_token!(_mm512_sll_epi32(words, _mm_cvtsi32_si128(count as i32)))
    }
    #[inline(always)]
    fn shift_right(self, words: __m512i, count: u32) -> __m512i {
        with_token!(_mm512_srl_epi32(words, _mm_cvtsi32_si128(count as i32)))
    }
    #[inline(always)]
    fn mask(self, bits: u64) -> __mmask16 {
        bits as __mmask16
    }
    #[inline(always)]
    fn add_where(self, mask: __mmask16, a: __m512i, b: __m512i, c: __m512i) -> __m512i {
        // The table of a | (b & !c), indexed by the bits of a, b and c.
        with_token!(_mm512_mask_ternarylogic_epi32::<0b1111_0100>(a, mask, b, c))
    }
    #[inline(always)]
    fn first_rows(self) -> ((__m512d, __m512d), __m512) {
        with_token!((
            (
                _mm512_setr_pd(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0),
                _mm512_setr_pd(8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0),
            ),
            _mm512_setr_ps(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0),
        ))
    }
    #[inline(always)]
    fn next_rows(self, ((low, high), short): ((__m512d, __m512d), __m512)) -> ((__m512d, __m512d), __m512) {
        with_token!({
            let sixteen = _mm512_set1_pd(16.0);
            ((_mm512_add_pd(low, sixteen), _mm512_add_pd(high, sixteen)), _mm512_add_ps(short, _mm512_set1_ps(16.0)))
        })
    }
    #[inline(always)]
    fn min_where(self, mask: __mmask16, a: __m512i, b: __m512i) -> __m512i {
        with_token!(_mm512_mask_min_epi32(a, mask, a, b))
    }
    #[inline(always)]
    fn max_where(self, mask: __mmask16, a: __m512i, b: __m512i) -> __m512i {
        with_token!(_mm512_mask_max_epi32(a, mask, a, b))
    }
    #[inline(always)]
    fn is_zero(self, words: __m512i) -> bool {
        with_token!(_mm512_test_epi32_mask(words, words)) == 0
    }
    #[inline(always)]
    fn line(self, (low, high): (__m512d, __m512d), slope: f64, offset: f64) -> __m512i {
        const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
        with_token!({
            let (slope, offset) = (_mm512_set1_pd(slope), _mm512_set1_pd(offset));
            let low = _mm512_cvt_roundpd_epi32::<DOWN>(_mm512_fmadd_pd(slope, low, offset));
            let high = _mm512_cvt_roundpd_epi32::<DOWN>(_mm512_fmadd_pd(slope, high, offset));
            _mm512_inserti64x4::<1>(_mm512_castsi256_si512(low), high)
        })
    }
    #[inline(always)]
    fn short_line(self, rows: __m512, slope: f32, offset: f32) -> __m512i {
        const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
        with_token!(_mm512_cvt_roundps_epi32::<DOWN>(_mm512_fmadd_ps(
            _mm512_set1_ps(slope),
            rows,
            _mm512_set1_ps(offset)
        )))
    }
    #[inline(always)]
    fn places(self, values: &[i32; 16]) -> [u32; 16] {
        // In memory, or the compiler makes gathers of it.
        static TABLE: [Lanes; 16] = BEFORE;
        let mut places = Lanes::default();
        with_token!({
            let all = _mm512_loadu_si512(values.as_ptr().cast());
            let mut sum = _mm512_setzero_si512();
            for other in 0..16 {
                let bound = _mm512_add_epi32(all, _mm512_load_si512(TABLE[other].0.as_ptr().cast()));
                let comes_before = _mm512_cmpgt_epi32_mask(bound, _mm512_set1_epi32(values[other]));
                sum = _mm512_mask_add_epi32(sum, comes_before, sum, _mm512_set1_epi32(1));
            }
            _mm512_store_si512(places.0.as_mut_ptr().cast(), sum);
        });
        places.0
    }
    #[inline(always)]
    fn least(self, values: &[i32; 16]) -> i32 {
        with_token!(_mm512_reduce_min_epi32(_mm512_loadu_si512(values.as_ptr().cast())))
    }
    #[inline(always)]
    fn most(self, values: &[i32; 16]) -> i32 {
        with_token!(_mm512_reduce_max_epi32(_mm512_loadu_si512(values.as_ptr().cast())))
    }
    #[inline(always)]
    fn no_bits(self) -> __m512i {
        with_token!(_mm512_setzero_si512())
    }
    #[inline(always)]
    fn count(self, sum: __m512i, words: __m512i) -> __m512i {
        with_token!(_mm512_add_epi32(sum, _mm512_popcnt_epi32(words)))
    }
    #[inline(always)]
    fn spans(self, sides: &Sides, ramp: &Ramp, first: i32, spans: &mut Spans) -> u32 {
        const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
        let Sides { slopes, offsets, length } = sides;
        with_token!({
            let rows = _mm512_add_pd(_mm512_set1_pd(f64::from(first)), self.first_rows().0.0);
            let a = _mm512_fmadd_pd(_mm512_set1_pd(slopes[0]), rows, _mm512_set1_pd(offsets[0]));
            let b = _mm512_fmadd_pd(_mm512_set1_pd(slopes[1]), rows, _mm512_set1_pd(offsets[1]));
            let c = _mm512_fmadd_pd(_mm512_set1_pd(slopes[2]), rows, _mm512_set1_pd(offsets[2]));
            let d = _mm512_fmadd_pd(_mm512_set1_pd(slopes[3]), rows, _mm512_set1_pd(offsets[3]));
            // The floor of the larger is the larger floor.
            let start = _mm512_roundscale_pd::<DOWN>(_mm512_max_pd(_mm512_max_pd(a, b), _mm512_setzero_pd()));
            let end = _mm512_roundscale_pd::<DOWN>(_mm512_min_pd(_mm512_min_pd(c, d), _mm512_set1_pd(*length)));
            let depth = _mm512_fmadd_pd(_mm512_set1_pd(ramp.across), rows, _mm512_set1_pd(ramp.depth));
            let depth = _mm512_fmadd_pd(_mm512_set1_pd(ramp.along), start, depth);
            let steps = _mm256_slli_epi32::<8>(_mm512_cvt_roundpd_epi32::<DOWN>(depth));
            let keys = _mm256_add_epi32(steps, _mm256_set1_epi32(ramp.base as i32));
            _mm256_store_si256(spans.starts.as_mut_ptr().cast(), _mm512_cvttpd_epi32(start));
            _mm256_store_si256(spans.ends.as_mut_ptr().cast(), _mm512_cvttpd_epi32(end));
            _mm256_store_si256(spans.keys.as_mut_ptr().cast(), keys);
            u32::from(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(start, end))
        })
    }
    #[inline(always)]
    fn nearer(self, keys: &mut [u32], count: usize, ramp: &Ramp, [place, row]: [i32; 2]) {
        const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
        with_token!({
            let along = _mm512_set1_pd(ramp.along);
            let depth = _mm512_set1_pd(ramp.across * f64::from(row) + ramp.depth);
            let base = _mm256_set1_epi32(ramp.base as i32);
            let mut places = _mm512_add_pd(_mm512_set1_pd(f64::from(place)), self.first_rows().0.0);
            for eight in keys[..count].chunks_mut(8) {
                let mask = (0xff_u32 >> (8 - eight.len())) as __mmask8;
                let steps = _mm512_cvt_roundpd_epi32::<DOWN>(_mm512_fmadd_pd(along, places, depth));
                let new = _mm256_add_epi32(_mm256_slli_epi32::<8>(steps), base);
                // The mask leaves out what lies behind the last key.
                let old = _mm256_maskz_loadu_epi32(mask, eight.as_ptr().cast());
                _mm256_mask_storeu_epi32(eight.as_mut_ptr().cast(), mask, _mm256_min_epu32(old, new));
                places = _mm512_add_pd(places, _mm512_set1_pd(8.0));
            }
        });
    }
    #[inline(always)]
    fn total(self, sum: __m512i) -> u32 {
        with_token!(_mm512_reduce_add_epi32(sum)) as u32
    }
    #[inline(always)]
    fn totals(self, [a, b, c]: [__m512i; 3], [first, digits @ ..]: [__m512i; 7]) -> ([u32; 3], u32) {
        let mut totals = [0; 4];
        with_token!({
            let mut number = _mm512_setzero_si512();
            for digit in digits.into_iter().rev() {
                number = _mm512_slli_epi32::<1>(_mm512_add_epi32(number, digit));
            }
            let number = _mm512_add_epi32(number, first);
            // Each step adds halves and puts what is left of two sums side by side.
            let ab = _mm512_add_epi32(_mm512_unpacklo_epi32(a, b), _mm512_unpackhi_epi32(a, b));
            let cn = _mm512_add_epi32(_mm512_unpacklo_epi32(c, number), _mm512_unpackhi_epi32(c, number));
            let all = _mm512_add_epi32(_mm512_unpacklo_epi64(ab, cn), _mm512_unpackhi_epi64(ab, cn));
            let all = _mm256_add_epi32(_mm512_castsi512_si256(all), _mm512_extracti64x4_epi64::<1>(all));
            let all = _mm_add_epi32(_mm256_castsi256_si128(all), _mm256_extracti128_si256::<1>(all));
            _mm_storeu_si128(totals.as_mut_ptr().cast(), all);
        });
        let [a, b, c, number] = totals;
        ([a, b, c], number)
    }
}
