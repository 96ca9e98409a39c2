//! Counter-based random numbers: Philox 4x32-10 (Salmon, Moraes, Dror, Shaw: "Parallel random numbers: as easy as 1, 2,
//! 3", 2011). A number is a pure function of its address, so any thread or device can draw it in any order.

use super::arithmetic::box_muller;

/// Philox's round multipliers.
const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
/// What the key grows by each round (Weyl sequence: golden ratio, square root of three minus one).
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];
const ROUNDS: usize = 10;

/// Blocks computed side by side. Dimension `d` takes its number from block `8 (d / 32) + d mod 8`, word `d / 8 mod 4`, so
/// that the eight blocks of a group fill 32 dimensions without a transposition.
const LANES: usize = 8;
/// Dimensions a group of blocks serves.
pub(super) const GROUP: usize = 4 * LANES;

/// The bijection itself: four words from a counter of four and a key of two.
pub fn philox4x32(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    let [a, b, c, d] = philox_lanes(counter.map(|word| [word; 1]), key);
    [a[0], b[0], c[0], d[0]]
}

/// [`philox4x32`] of `N` counters, a word of all of them in each array; written so that a compiler puts lanes in registers.
#[inline(always)]
fn philox_lanes<const N: usize>(counters: [[u32; N]; 4], key: [u32; 2]) -> [[u32; N]; 4] {
    // Words sit in the lower halves of 64-bit lanes, where the widening multiplication of vector units finds them.
    let [mut c0, mut c1, mut c2, mut c3] = counters;
    let [mut k0, mut k1] = key;
    for _ in 0..ROUNDS {
        for lane in 0..N {
            let first = u64::from(c0[lane]) * u64::from(MULTIPLIERS[0]);
            let second = u64::from(c2[lane]) * u64::from(MULTIPLIERS[1]);
            c0[lane] = (second >> 32) as u32 ^ c1[lane] ^ k0;
            c1[lane] = second as u32;
            c2[lane] = (first >> 32) as u32 ^ c3[lane] ^ k1;
            c3[lane] = first as u32;
        }
        k0 = k0.wrapping_add(WEYL[0]);
        k1 = k1.wrapping_add(WEYL[1]);
    }
    [c0, c1, c2, c3]
}

/// What a random number is for: numbers of one address but different purposes are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Draw {
    /// r1 of the swarm, towards the particle's own best.
    Cognitive = 0,
    /// r2 of the swarm, towards the swarm's best.
    Social = 1,
    /// Scatter around a pose: the swarm's start, the filter's propagation.
    Scatter = 2,
    /// The offset of systematic resampling.
    Resampling = 3,
}

/// The address of a row of random numbers; its dimensions are the row's entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stream {
    /// Frame of the sequence.
    pub frame: u32,
    /// Iteration within the frame.
    pub iteration: u32,
    /// Particle.
    pub particle: u32,
    /// Purpose.
    pub draw: Draw,
}

/// The random numbers of a seed.
///
/// Key: the seed's low and high word. Counter: word 0 the particle, word 1 the block of dimensions in bits 0..24 and the
/// [`Draw`] in bits 24..32, word 2 the iteration, word 3 the frame. Dimension `d` is word `(d / 8) mod 4` of block
/// `8 (d / 32) + d mod 8`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Random {
    key: [u32; 2],
}

impl Random {
    /// The generator of a seed.
    pub fn new(seed: u64) -> Self {
        Self { key: [seed as u32, (seed >> 32) as u32] }
    }

    #[inline(always)]
    fn group(&self, stream: Stream, group: usize) -> [[u32; LANES]; 4] {
        let mut blocks = [0; LANES];
        for (lane, block) in blocks.iter_mut().enumerate() {
            *block = (stream.draw as u32) << 24 | (group * LANES + lane) as u32;
        }
        let counters = [[stream.particle; LANES], blocks, [stream.iteration; LANES], [stream.frame; LANES]];
        philox_lanes(counters, self.key)
    }

    /// The numbers of dimensions `32 group ..` of a row, uniform in [0, 1): the upper 24 bits of a word times 2^-24.
    #[inline(always)]
    pub(super) fn uniform_group(&self, stream: Stream, group: usize) -> [f32; GROUP] {
        let words = self.group(stream, group);
        let mut out = [0.0; GROUP];
        for (row, words) in out.chunks_exact_mut(LANES).zip(&words) {
            for (value, word) in row.iter_mut().zip(words) {
                *value = (word >> 8) as i32 as f32 * (1.0 / 16_777_216.0);
            }
        }
        out
    }

    /// The numbers of dimensions `32 group ..` of a row, normal with mean 0 and variance 1: words 0 and 1 of a block make
    /// two of them by [`box_muller`], words 2 and 3 two more.
    #[inline(always)]
    pub(super) fn normal_group(&self, stream: Stream, group: usize) -> [f32; GROUP] {
        let words = self.group(stream, group);
        let mut out = [0.0; GROUP];
        for (row, words) in out.chunks_exact_mut(2 * LANES).zip(words.chunks_exact(2)) {
            let (first, second) = row.split_at_mut(LANES);
            for lane in 0..LANES {
                (first[lane], second[lane]) = box_muller(words[0][lane], words[1][lane]);
            }
        }
        out
    }

    /// The first word of a row.
    pub(super) fn first_word(&self, stream: Stream) -> u32 {
        self.group(stream, 0)[0][0]
    }

    /// A row of numbers uniform in [0, 1).
    pub fn uniforms(&self, stream: Stream, row: &mut [f32]) {
        for (group, values) in row.chunks_mut(GROUP).enumerate() {
            values.copy_from_slice(&self.uniform_group(stream, group)[..values.len()]);
        }
    }

    /// Moves rows by normal numbers of the given standard deviations and holds them within limits; row `i` has the numbers
    /// of particle `stream.particle + i`.
    pub fn scatter(&self, stream: Stream, spread: &[f32], limits: [&[f32]; 2], rows: &mut [f32]) {
        scatter_rows(*self, stream, spread, limits, rows);
    }

    /// A row of normal numbers with mean 0 and variance 1.
    pub fn normals(&self, stream: Stream, row: &mut [f32]) {
        for (group, values) in row.chunks_mut(GROUP).enumerate() {
            values.copy_from_slice(&self.normal_group(stream, group)[..values.len()]);
        }
    }
}

/// [`Random::scatter`], compiled for several instruction sets with the same results.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn scatter_rows(random: Random, stream: Stream, spread: &[f32], limits: [&[f32]; 2], rows: &mut [f32]) {
    let dofs = spread.len();
    for (index, row) in rows.chunks_exact_mut(dofs).enumerate() {
        let stream = Stream { particle: stream.particle.wrapping_add(index as u32), ..stream };
        for group in 0..dofs.div_ceil(GROUP) {
            let normals = random.normal_group(stream, group);
            let from = group * GROUP;
            let count = GROUP.min(dofs - from);
            let range = from..from + count;
            let (row, spread) = (&mut row[range.clone()], &spread[range.clone()]);
            let (low, high) = (&limits[0][range.clone()], &limits[1][range]);
            for d in 0..count {
                row[d] = (row[d] + normals[d] * spread[d]).max(low[d]).min(high[d]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_known_answers() {
        // Random123's file of known answers, philox4x32 with 10 rounds.
        let cases = [
            ([0; 4], [0; 2], [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]),
            ([!0; 4], [!0; 2], [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]),
            (
                [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344],
                [0xa409_3822, 0x299f_31d0],
                [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1],
            ),
        ];
        for (counter, key, expected) in cases {
            assert_eq!(philox4x32(counter, key), expected);
        }
    }

    #[test]
    fn rows_follow_the_documented_layout() {
        let random = Random::new(0x0123_4567_89AB_CDEF);
        let stream = Stream { frame: 7, iteration: 3, particle: 500, draw: Draw::Social };
        let mut row = [0.0; 75];
        random.uniforms(stream, &mut row);
        let mut normals = [0.0; 75];
        random.normals(stream, &mut normals);
        for d in 0..75_usize {
            let block = 8 * (d / 32) + d % 8;
            let words = philox4x32([500, 1 << 24 | block as u32, 3, 7], [0x89AB_CDEF, 0x0123_4567]);
            let word = d / 8 % 4;
            assert_eq!(row[d], (words[word] >> 8) as f32 / 16_777_216.0, "dimension {d}");
            let pair = box_muller(words[word & 2], words[word | 1]);
            assert_eq!(normals[d], if word & 1 == 0 { pair.0 } else { pair.1 }, "dimension {d}");
        }
    }

    #[test]
    fn every_part_of_the_address_and_the_seed_counts() {
        let base = Stream { frame: 1, iteration: 1, particle: 1, draw: Draw::Cognitive };
        let draw = |seed: u64, stream: Stream| {
            let mut row = [0.0; 31];
            Random::new(seed).uniforms(stream, &mut row);
            row
        };
        let all = [
            draw(1, base),
            draw(2, base),
            draw(1 << 32 | 1, base),
            draw(1, Stream { frame: 2, ..base }),
            draw(1, Stream { iteration: 2, ..base }),
            draw(1, Stream { particle: 2, ..base }),
            draw(1, Stream { draw: Draw::Scatter, ..base }),
        ];
        let mut numbers: Vec<u32> = all.iter().flatten().map(|value| value.to_bits()).collect();
        numbers.sort_unstable();
        let before = numbers.len();
        numbers.dedup();
        assert!(before - numbers.len() <= 1, "numbers repeat between streams or dimensions");
    }

    #[test]
    fn moments_and_correlations() {
        let random = Random::new(11);
        let (count, dims) = (8192, 32);
        let mut uniform = vec![0.0; count * dims];
        let mut normal = vec![0.0; count * dims];
        for particle in 0..count {
            let stream = Stream { frame: 0, iteration: 0, particle: particle as u32, draw: Draw::Scatter };
            random.uniforms(stream, &mut uniform[particle * dims..][..dims]);
            random.normals(stream, &mut normal[particle * dims..][..dims]);
        }
        assert!(uniform.iter().all(|value| (0.0..1.0).contains(value)));
        let total = (count * dims) as f64;
        let moment =
            |values: &[f32], power: i32| values.iter().map(|value| f64::from(*value).powi(power)).sum::<f64>() / total;
        assert!((moment(&uniform, 1) - 0.5).abs() < 3e-3);
        assert!((moment(&uniform, 2) - 1.0 / 3.0).abs() < 3e-3);
        for (power, expected, tolerance) in [(1, 0.0, 0.01), (2, 1.0, 0.015), (3, 0.0, 0.05), (4, 3.0, 0.12)] {
            assert!(
                (moment(&normal, power) - expected).abs() < tolerance,
                "moment {power}: {}",
                moment(&normal, power)
            );
        }
        // No two dimensions go together: 5 standard deviations of a correlation of that many samples.
        for a in 0..dims {
            for b in 0..a {
                let products =
                    (0..count).map(|row| f64::from(normal[row * dims + a]) * f64::from(normal[row * dims + b]));
                let correlation = products.sum::<f64>() / count as f64;
                assert!(correlation.abs() < 5.0 / (count as f64).sqrt(), "dimensions {a} and {b}: {correlation}");
            }
        }
    }
}
