//! The framebuffer compared on the host: what hardware without compute had to do, kept as rows of the benchmark and to read
//! pictures back.

use anyhow::Result;

use crate::evaluate::stages::layout;
use crate::features::Observation;
use crate::gpu::{Buffer, Device, Memory, Recorder};

use super::tiles::CANDIDATES_A_TILE;
use super::{Framebuffer, TileLayout};

/// How the host compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HostComparison {
    /// A pixel after the other.
    Scalar,
    /// Rows in the widest vectors of the processor.
    Simd,
}

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
struct Window<'a> {
    texels: &'a [u32],
    /// Texels from a row to the next.
    pitch: usize,
    seen: &'a [u8],
    seen_pitch: usize,
    width: usize,
    height: usize,
    /// Bits that bring the candidate's byte down.
    shift: u32,
    edge_bit: u32,
}

impl Pictures<'_> {
    /// The sums of every image, `[candidate][view]`; none of an image that is not drawn here.
    pub(crate) fn compare(
        &self,
        observations: &[Observation],
        edge_bit: u32,
        how: HostComparison,
    ) -> Vec<Option<layout::Sums>> {
        let views = self.layout.views.len();
        let pitch = self.layout.size[0] as usize;
        self.placements
            .iter()
            .enumerate()
            .map(|(image, placement)| {
                if placement.low == placement.high {
                    return None;
                }
                let [left, top] = place(placement.low);
                let [right, bottom] = place(placement.high);
                let observation = &observations[image % views];
                let seen_pitch = observation.width as usize;
                // The shift leads from the picture to the framebuffer; what is drawn lies in both.
                let seen_left = left.wrapping_add_signed(-placement.shift[0] as isize);
                let seen_top = top.wrapping_add_signed(-placement.shift[1] as isize);
                let window = Window {
                    texels: self.texels.get(top * pitch + left..)?,
                    pitch,
                    seen: observation.bytes.get(seen_top * seen_pitch + seen_left..)?,
                    seen_pitch,
                    width: right - left,
                    height: bottom - top,
                    shift: 8 * ((image / views) as u32 % CANDIDATES_A_TILE),
                    edge_bit,
                };
                let [area_model, overlap, edges, proximity] = match how {
                    HostComparison::Scalar => compare_scalar(&window),
                    HostComparison::Simd => compare_simd(&window),
                };
                Some(layout::Sums { area_model, overlap, edges, proximity })
            })
            .collect()
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
fn compare_scalar(window: &Window<'_>) -> [u32; 4] {
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
                if drawn >> window.edge_bit & 1 != 0 {
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
fn compare_simd(window: &Window<'_>) -> [u32; 4] {
    let mut sums = [0; 4];
    let (shift, edge_bit) = (window.shift, window.edge_bit);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn window<'a>(
        texels: &'a [u32],
        seen: &'a [u8],
        [width, height]: [usize; 2],
        [shift, edge_bit]: [u32; 2],
    ) -> Window<'a> {
        Window { texels, pitch: 200, seen, seen_pitch: 150, width, height, shift, edge_bit }
    }

    #[test]
    fn both_ways_count_the_same_and_a_changed_pixel_shows() {
        let mut state = 3_u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 32) as u32
        };
        for (width, height, edge_bit) in [(1, 1, 0), (37, 5, 7), (64, 9, 0), (130, 3, 7)] {
            let mut texels: Vec<u32> = (0..200 * height).map(|_| random() & random()).collect();
            let seen: Vec<u8> = (0..150 * height).map(|_| random() as u8).collect();
            for shift in [0, 8, 16, 24] {
                let expected = compare_scalar(&window(&texels, &seen, [width, height], [shift, edge_bit]));
                assert_eq!(compare_simd(&window(&texels, &seen, [width, height], [shift, edge_bit])), expected);
                let place = 200 * (height - 1) + width - 1;
                let before = texels[place];
                texels[place] ^= if before >> shift & 0xff == 0 { 1 << shift } else { before & 0xff << shift };
                assert_ne!(compare_simd(&window(&texels, &seen, [width, height], [shift, edge_bit])), expected);
                texels[place] = before;
            }
        }
    }
}
