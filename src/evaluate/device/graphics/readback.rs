//! The framebuffer compared on the host: what hardware without compute had to do, kept as rows of the benchmark and to read
//! pictures back.

use std::borrow::Cow;

use anyhow::Result;

use super::byte_numbers::ByteNumbers;
use super::framebuffer::Framebuffer;
use super::settings::HostComparison;
use super::tiles::{CANDIDATES_A_TILE, TileLayout};
use crate::evaluate::SegmentSums;
use crate::evaluate::shaders::layout;
use crate::features::evidence::code;
use crate::features::{Evidence, Observation, PartClasses, Segments};
use crate::gpu::{Buffer, Device, Memory, Recorder};

/// Where the device copies a framebuffer and its placements to, for the host to read.
#[derive(Debug)]
pub(crate) struct FramebufferCopy {
    texels: Buffer,
    placements: Buffer,
}

/// The framebuffer of a batch as the host sees it.
#[derive(Debug)]
pub(crate) struct Pictures<'a> {
    layout: &'a TileLayout,
    texels: Vec<u32>,
    placements: Vec<layout::Placement>,
}

impl FramebufferCopy {
    /// For a framebuffer.
    ///
    /// # Errors
    /// When the device has no room.
    pub(crate) fn new(device: &Device, framebuffer: &Framebuffer) -> Result<Self> {
        let [width, height] = framebuffer.layout.size;
        let images = framebuffer.layout.candidates as usize * framebuffer.layout.views.len();
        Ok(Self {
            texels: device.buffer::<u32>("framebuffer readback", width as usize * height as usize, Memory::Readback)?,
            placements: device.buffer::<layout::Placement>("placements readback", images, Memory::Readback)?,
        })
    }

    /// Records the copies.
    pub(crate) fn record(&self, recorder: &mut Recorder, framebuffer: &Framebuffer) -> Result<()> {
        let [width, height] = framebuffer.layout.size;
        recorder.read_image("readback", &framebuffer.colour, [0, 0, width, height], (&self.texels, 0))?;
        let bytes = self.placements.size();
        recorder.copy("readback", (&framebuffer.placements, 0), (&self.placements, 0), bytes)
    }

    /// What a finished run drew of `candidates` candidates.
    pub(crate) fn read<'a>(&self, framebuffer: &'a Framebuffer, candidates: u32) -> Result<Pictures<'a>> {
        let layout = &framebuffer.layout;
        let [width, height] = layout.size;
        let mut texels = vec![0; width as usize * height as usize];
        self.texels.read(0, &mut texels)?;
        let mut placements: Vec<layout::Placement> = bytemuck::zeroed_vec(candidates as usize * layout.views.len());
        self.placements.read(0, &mut placements)?;
        Ok(Pictures { layout, texels, placements })
    }
}

/// Rows of one candidate's picture and of the observation behind them.
struct Window<'a, T> {
    texels: Cow<'a, [u32]>,
    /// Texels from a row to the next.
    pitch: usize,
    seen: &'a [T],
    seen_pitch: usize,
    width: usize,
    height: usize,
    /// Bits that bring the candidate's byte down.
    shift: u32,
}

impl Pictures<'_> {
    /// The sums of every image, `[candidate][view]`; none of an image that is not drawn here.
    pub(crate) fn compare(
        &self,
        observations: &[Observation],
        edge_bit: u32,
        how: HostComparison,
    ) -> Vec<Option<layout::Sums>> {
        (0..self.placements.len())
            .map(|image| {
                let observation = &observations[image % self.layout.views.len()];
                let window = self.window(image, &observation.bytes, observation)?;
                let [area_model, overlap, edges, proximity] = match how {
                    HostComparison::Scalar => compare_scalar(&window, edge_bit),
                    HostComparison::Simd => compare_simd(&window, edge_bit),
                };
                Some(layout::Sums { area_model, overlap, edges, proximity })
            })
            .collect()
    }

    /// How many images there are.
    pub(crate) fn count(&self) -> usize {
        self.placements.len()
    }

    /// The sums of the `segments` segments of every image, `[candidate][view][segment]`, without the observed areas; nothing for an
    /// image that is not drawn here. `numbers` tells an image's bytes apart; edges are counted where their bit is given.
    pub(crate) fn compare_segments(
        &self,
        observations: &[Observation],
        (segments, edge_bit): (usize, Option<u32>),
        numbers: impl Fn(usize) -> ByteNumbers,
        how: HostComparison,
    ) -> Vec<SegmentSums> {
        let mut all = vec![SegmentSums::default(); self.placements.len() * segments];
        for (image, sums) in all.chunks_exact_mut(segments).enumerate() {
            let observation = &observations[image % self.layout.views.len()];
            let Some(seen) = &observation.segmentation else { continue };
            let Some(window) = self.window(image, seen.numbers(), observation) else { continue };
            let numbers = numbers(image);
            let found = match how {
                HostComparison::Scalar => count_segments(&window, &numbers),
                HostComparison::Simd => count_segments_simd(&window, &numbers, segments),
            };
            let packed = edge_bit.and_then(|bit| Some((self.window(image, &observation.bytes, observation)?, bit)));
            let edges = match (packed, how) {
                (None, _) => [[0; 2]; Segments::MOST],
                (Some((window, edge_bit)), HostComparison::Scalar) => count_segment_edges(&window, &numbers, edge_bit),
                (Some((window, edge_bit)), HostComparison::Simd) => {
                    count_segment_edges_simd(&window, (&numbers, segments), edge_bit)
                }
            };
            for (sums, ([area_model, overlap], [edges, proximity])) in sums.iter_mut().zip(found.into_iter().zip(edges))
            {
                *sums = SegmentSums { area_obs: 0, area_model, overlap, edges, proximity };
            }
        }
        all
    }

    /// The evidence of every image, `[candidate][view]`; 0 of one that is not drawn here. `numbers` tells the class of an image's
    /// bytes.
    pub(crate) fn sum_evidence(
        &self,
        observations: &[Observation],
        numbers: impl Fn(usize, &PartClasses) -> ByteNumbers,
    ) -> Vec<i32> {
        let sum = |image: usize| {
            let observation = &observations[image % self.layout.views.len()];
            let seen = observation.evidence.as_ref()?;
            let window = self.window(image, seen.words(), observation)?;
            Some(sum_codes(&window, &numbers(image, seen.classes())))
        };
        (0..self.placements.len()).map(|image| sum(image).unwrap_or(0)).collect()
    }

    /// An image and what was observed behind it, a value a pixel; none of an image that is not drawn here. What the observation
    /// ignores is not drawn.
    fn window<'a, T>(&'a self, image: usize, seen: &'a [T], observation: &Observation) -> Option<Window<'a, T>> {
        let seen_pitch = observation.width as usize;
        let placement = &self.placements[image];
        if placement.low == placement.high {
            return None;
        }
        let pitch = self.layout.size[0] as usize;
        let [left, top] = place(placement.low);
        let [right, bottom] = place(placement.high);
        // The shift leads from the picture to the framebuffer; what is drawn lies in both.
        let seen_left = left.wrapping_add_signed(-placement.shift[0] as isize);
        let seen_top = top.wrapping_add_signed(-placement.shift[1] as isize);
        let (width, height) = (right - left, bottom - top);
        let mut texels = Cow::Borrowed(self.texels.get(top * pitch + left..)?);
        if observation.ignored.is_some() {
            let counted = |(at, &texel): (usize, &u32)| {
                let column = (seen_left + at % pitch) as u32;
                let row = (seen_top + at / pitch) as u32;
                texel & (0x0101_0101 * u32::from(observation.counts(column, row)))
            };
            texels = texels.iter().enumerate().take(pitch * height).map(counted).collect();
        }
        Some(Window {
            texels,
            pitch,
            seen: seen.get(seen_top * seen_pitch + seen_left..)?,
            seen_pitch,
            width,
            height,
            shift: 8 * ((image / self.layout.views.len()) as u32 % CANDIDATES_A_TILE),
        })
    }

    /// The bytes of one image in its picture of `size` pixels.
    pub(crate) fn image(&self, candidate: u32, view: usize, [width, height]: [u32; 2]) -> Vec<u8> {
        let mut bytes = vec![0; width as usize * height as usize];
        let placement = self.placements[candidate as usize * self.layout.views.len() + view];
        let [left, top] = place(placement.low);
        let [right, bottom] = place(placement.high);
        for y in top..bottom {
            for x in left..right {
                let texel = self.texels[y * self.layout.size[0] as usize + x];
                let at_x = x.wrapping_add_signed(-placement.shift[0] as isize);
                let at_y = y.wrapping_add_signed(-placement.shift[1] as isize);
                if let Some(byte) = bytes.get_mut(at_y * width as usize + at_x) {
                    *byte = (texel >> (8 * (candidate % CANDIDATES_A_TILE))) as u8;
                }
            }
        }
        bytes
    }
}

fn place(word: u32) -> [usize; 2] {
    [(word & 0xffff) as usize, (word >> 16) as usize]
}

/// A pixel after the other, branch by branch.
fn compare_scalar(window: &Window<'_, u8>, edge_bit: u32) -> [u32; 4] {
    let mut sums = [0; 4];
    for y in 0..window.height {
        for x in 0..window.width {
            let drawn = (window.texels[y * window.pitch + x] >> window.shift) as u8;
            let seen = window.seen[y * window.seen_pitch + x];
            if drawn != 0 {
                sums[0] += 1;
                if seen & Observation::SILHOUETTE != 0 {
                    sums[1] += 1;
                }
                if drawn >> edge_bit & 1 != 0 {
                    sums[2] += 1;
                    sums[3] += u32::from(seen & Observation::PROXIMITY);
                }
            }
        }
    }
    sums
}

/// The same without branches, in words for the compiler to take many at a time.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn compare_simd(window: &Window<'_, u8>, edge_bit: u32) -> [u32; 4] {
    let mut sums = [0; 4];
    let shift = window.shift;
    for y in 0..window.height {
        let texels = &window.texels[y * window.pitch..][..window.width];
        let seen = &window.seen[y * window.seen_pitch..][..window.width];
        let mut row = [0_u32; 4];
        for (&texel, &seen) in texels.iter().zip(seen) {
            let (drawn, seen) = ((texel >> shift) & 0xff, u32::from(seen));
            let filled = u32::from(drawn != 0);
            let edge = (drawn >> edge_bit) & 1;
            row[0] += filled;
            row[1] += filled & (seen >> 7);
            row[2] += edge;
            row[3] += edge.wrapping_neg() & seen & 0x7f;
        }
        for (sum, row) in sums.iter_mut().zip(row) {
            *sum += row;
        }
    }
    sums
}

/// Drawn pixels and common pixels of each segment, a pixel after the other.
fn count_segments(window: &Window<'_, u8>, numbers: &ByteNumbers) -> [[u32; 2]; Segments::MOST] {
    let mut sums = [[0; 2]; Segments::MOST];
    for y in 0..window.height {
        for x in 0..window.width {
            let drawn = numbers[(window.texels[y * window.pitch + x] >> window.shift) as usize & 0xff];
            if let Some(segment) = usize::from(drawn).checked_sub(1) {
                sums[segment][0] += 1;
                if window.seen[y * window.seen_pitch + x] == drawn {
                    sums[segment][1] += 1;
                }
            }
        }
    }
    sums
}

/// The same, the counts of a row without branches, for the compiler to take many pixels at a time.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn count_segments_simd(window: &Window<'_, u8>, numbers: &ByteNumbers, segments: usize) -> [[u32; 2]; Segments::MOST] {
    let number = |drawn: u32| numbers[drawn as usize & 0xff];
    sum_segments(window, segments, number, |seen, number| u32::from(seen == number))
}

/// Pixels of each segment and the sum of their values, row by row: `number` tells the segment of what is drawn, in the lowest byte of its
/// word, and `value` what a pixel with this behind it is worth to a segment.
#[inline(always)]
fn sum_segments(
    window: &Window<'_, u8>,
    segments: usize,
    number: impl Fn(u32) -> u8,
    value: impl Fn(u8, u8) -> u32,
) -> [[u32; 2]; Segments::MOST] {
    let mut sums = [[0; 2]; Segments::MOST];
    let mut shown = vec![0_u8; window.width];
    for y in 0..window.height {
        let texels = &window.texels[y * window.pitch..][..window.width];
        let seen = &window.seen[y * window.seen_pitch..][..window.width];
        for (shown, texel) in shown.iter_mut().zip(texels) {
            *shown = number(texel >> window.shift);
        }
        for (number, sums) in (1..).zip(&mut sums[..segments]) {
            for (&shown, &seen) in shown.iter().zip(seen) {
                let own = u32::from(shown == number);
                sums[0] += own;
                sums[1] += own.wrapping_neg() & value(seen, number);
            }
        }
    }
    sums
}

/// Edge pixels of each segment and their proximity, a pixel after the other; behind the picture the packed bytes.
fn count_segment_edges(window: &Window<'_, u8>, numbers: &ByteNumbers, edge_bit: u32) -> [[u32; 2]; Segments::MOST] {
    let mut sums = [[0; 2]; Segments::MOST];
    for y in 0..window.height {
        for x in 0..window.width {
            let drawn = (window.texels[y * window.pitch + x] >> window.shift) as u8;
            if drawn >> edge_bit & 1 != 0
                && let Some(segment) = usize::from(numbers[usize::from(drawn)]).checked_sub(1)
            {
                sums[segment][0] += 1;
                sums[segment][1] += u32::from(window.seen[y * window.seen_pitch + x] & Observation::PROXIMITY);
            }
        }
    }
    sums
}

/// The same, the counts of a row without branches, for the compiler to take many pixels at a time.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn count_segment_edges_simd(
    window: &Window<'_, u8>,
    (numbers, segments): (&ByteNumbers, usize),
    edge_bit: u32,
) -> [[u32; 2]; Segments::MOST] {
    let number = |drawn: u32| numbers[drawn as usize & 0xff] * (drawn >> edge_bit & 1) as u8;
    sum_segments(window, segments, number, |seen, _| u32::from(seen & Observation::PROXIMITY))
}

/// The evidence of what is drawn, a pixel after the other.
fn sum_codes(window: &Window<'_, u32>, classes: &ByteNumbers) -> i32 {
    let mut sum = 0;
    for y in 0..window.height {
        for x in 0..window.width {
            let drawn = (window.texels[y * window.pitch + x] >> window.shift) as u8;
            if drawn != 0 {
                let word = window.seen[y * window.seen_pitch + x];
                sum += code(word, usize::from(classes[usize::from(drawn)])) as i32 - Evidence::NEUTRAL as i32;
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window<'a>(texels: &'a [u32], seen: &'a [u8], [width, height]: [usize; 2], shift: u32) -> Window<'a, u8> {
        Window { texels: Cow::Borrowed(texels), pitch: 200, seen, seen_pitch: 150, width, height, shift }
    }

    #[test]
    fn both_ways_count_the_same_and_a_changed_pixel_shows() {
        // Five segments, of which every byte but that of nothing has one.
        let numbers: ByteNumbers = std::array::from_fn(|byte| if byte == 0 { 0 } else { byte as u8 % 5 + 1 });
        let mut state = 3_u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 32) as u32
        };
        for (width, height, edge_bit) in [(1, 1, 0), (37, 5, 7), (64, 9, 0), (130, 3, 7)] {
            let mut texels: Vec<u32> = (0..200 * height).map(|_| random() & random()).collect();
            let seen: Vec<u8> = (0..150 * height).map(|_| random() as u8).collect();
            let numbered: Vec<u8> = seen.iter().map(|byte| byte % 6).collect();
            for shift in [0, 8, 16, 24] {
                let whole = |texels: &[u32]| compare_simd(&window(texels, &seen, [width, height], shift), edge_bit);
                let parts = |texels: &[u32]| {
                    count_segments_simd(&window(texels, &numbered, [width, height], shift), &numbers, 5)
                };
                let expected = compare_scalar(&window(&texels, &seen, [width, height], shift), edge_bit);
                assert_eq!(whole(&texels), expected);
                let in_parts = count_segments(&window(&texels, &numbered, [width, height], shift), &numbers);
                assert_eq!(parts(&texels), in_parts);
                let borders = |texels: &[u32]| {
                    count_segment_edges_simd(&window(texels, &seen, [width, height], shift), (&numbers, 5), edge_bit)
                };
                let at_borders =
                    count_segment_edges(&window(&texels, &seen, [width, height], shift), &numbers, edge_bit);
                assert_eq!(borders(&texels), at_borders);
                // Every byte but that of nothing has a segment, so they share all edges.
                let all = at_borders.iter().fold([0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
                assert_eq!(all, [expected[2], expected[3]]);
                let place = 200 * (height - 1) + width - 1;
                let before = texels[place];
                texels[place] ^= if before >> shift & 0xff == 0 { 1 << shift } else { before & 0xff << shift };
                assert_ne!(whole(&texels), expected);
                assert_ne!(parts(&texels), in_parts);
                texels[place] = before ^ 1 << (shift + edge_bit);
                assert_ne!(borders(&texels), at_borders);
                texels[place] = before;
            }
        }
    }
}
