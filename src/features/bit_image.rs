//! A binary picture with one bit a pixel: sixty-four pixels an instruction for everything that asks "in or out".

use std::ops::Range;

use image::{GrayImage, Luma};

use super::Region;

/// A binary picture; bit `x % 64` of word `x / 64` of a row is pixel `x`. Bits past the width are always zero, so that
/// whole-word operations and counts need no special last word.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct BitImage {
    width: u32,
    height: u32,
    stride: usize,
    words: Vec<u64>,
}

impl BitImage {
    /// An empty picture of `width` × `height` pixels.
    pub fn new(width: u32, height: u32) -> Self {
        let stride = (width as usize).div_ceil(64);
        Self { width, height, stride, words: vec![0; stride * height as usize] }
    }

    /// The picture of the pixels for which `inside(x, y)` holds.
    pub fn from_fn(width: u32, height: u32, mut inside: impl FnMut(u32, u32) -> bool) -> Self {
        let mut image = Self::new(width, height);
        for y in 0..height {
            for x in 0..width {
                if inside(x, y) {
                    image.set(x, y, true);
                }
            }
        }
        image
    }

    /// Takes the pixels of a grey mask that are 128 or brighter. The sizes must agree; the caller has checked them.
    pub(super) fn copy_from_gray(&mut self, mask: &GrayImage) {
        debug_assert_eq!((self.width, self.height), mask.dimensions());
        let mut flags = vec![0_u8; self.width as usize];
        for (y, row) in mask.as_raw().chunks_exact(self.width.max(1) as usize).enumerate() {
            for (flag, &value) in flags.iter_mut().zip(row) {
                *flag = value >> 7;
            }
            self.pack_row(y, &flags);
        }
    }

    /// The pixels of a grey mask that are 128 or brighter.
    pub fn of_gray(mask: &GrayImage) -> Self {
        let mut image = Self::new(mask.width(), mask.height());
        image.copy_from_gray(mask);
        image
    }

    /// White where set, black elsewhere.
    pub fn to_gray(&self) -> GrayImage {
        GrayImage::from_fn(self.width, self.height, |x, y| Luma([if self.get(x, y) { 255 } else { 0 }]))
    }

    /// Width, pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height, pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Whether a pixel is set; one outside the picture is not.
    pub fn get(&self, x: u32, y: u32) -> bool {
        x < self.width && y < self.height && self.words[y as usize * self.stride + x as usize / 64] >> (x % 64) & 1 != 0
    }

    /// Sets or clears a pixel; one outside the picture is ignored.
    pub fn set(&mut self, x: u32, y: u32, value: bool) {
        if x >= self.width || y >= self.height {
            return;
        }
        let word = &mut self.words[y as usize * self.stride + x as usize / 64];
        let bit = 1 << (x % 64);
        *word = if value { *word | bit } else { *word & !bit };
    }

    /// The places of the set pixels in the picture's rows, in reading order.
    pub fn pixels(&self) -> impl Iterator<Item = usize> + '_ {
        let rows = (0..self.height as usize).flat_map(|y| self.row(y).iter().enumerate().map(move |word| (y, word)));
        rows.flat_map(move |(y, (index, &word))| {
            let first = y * self.width as usize + index * 64;
            (0..64).filter(move |bit| word >> bit & 1 != 0).map(move |bit| first + bit)
        })
    }

    /// The number of set pixels.
    pub fn count(&self) -> u32 {
        self.words.iter().map(|word| word.count_ones()).sum()
    }

    /// The smallest region that holds every set pixel; `None` when none is set.
    pub fn bounds(&self) -> Option<Region> {
        let (mut top, mut bottom) = (None, 0);
        let mut columns = vec![0_u64; self.stride];
        for y in 0..self.height as usize {
            let row = self.row(y);
            if row.iter().any(|&word| word != 0) {
                top.get_or_insert(y);
                bottom = y + 1;
                columns.iter_mut().zip(row).for_each(|(all, word)| *all |= word);
            }
        }
        let first = columns.iter().position(|&word| word != 0)?;
        let last = columns.iter().rposition(|&word| word != 0)?;
        let x0 = first * 64 + columns[first].trailing_zeros() as usize;
        let x1 = last * 64 + 64 - columns[last].leading_zeros() as usize;
        Some(Region { x0: x0 as u32, y0: top? as u32, x1: x1 as u32, y1: bottom as u32 })
    }

    /// Words a row.
    pub(super) fn stride(&self) -> usize {
        self.stride
    }

    /// The words of a row.
    pub(super) fn row(&self, y: usize) -> &[u64] {
        &self.words[y * self.stride..][..self.stride]
    }

    /// The words of a row, to be written; bits past the width must stay zero ([`Self::last_word`]).
    pub(super) fn row_mut(&mut self, y: usize) -> &mut [u64] {
        &mut self.words[y * self.stride..][..self.stride]
    }

    /// All words.
    pub(super) fn words(&self) -> &[u64] {
        &self.words
    }

    /// All words, to be written; bits past the width must stay zero.
    pub(super) fn words_mut(&mut self) -> &mut [u64] {
        &mut self.words
    }

    /// The bits of a row's last word that lie inside the picture.
    pub(super) fn last_word(&self) -> u64 {
        match self.width % 64 {
            0 => u64::MAX,
            used => (1 << used) - 1,
        }
    }

    /// Clears every pixel.
    pub(super) fn clear(&mut self) {
        self.words.fill(0);
    }

    /// Takes another picture's size and pixels, keeping its own memory.
    pub(super) fn copy_from(&mut self, other: &Self) {
        (self.width, self.height, self.stride) = (other.width, other.height, other.stride);
        self.words.clone_from(&other.words);
    }

    /// Becomes an empty picture of that size, keeping its memory.
    pub(super) fn resize(&mut self, width: u32, height: u32) {
        (self.width, self.height, self.stride) = (width, height, (width as usize).div_ceil(64));
        self.words.clear();
        self.words.resize(self.stride * height as usize, 0);
    }

    /// Sets what is set in either.
    pub(crate) fn or(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(a, b)| *a |= b);
    }

    /// Keeps what is set in both.
    pub(super) fn and(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(a, b)| *a &= b);
    }

    /// Clears what is set in the other, which is of the same size.
    pub(crate) fn and_not(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(a, b)| *a &= !b);
    }

    /// The pixels of a row, 32 a word, the first in the lowest bit.
    pub(crate) fn row_words(&self, y: usize) -> impl Iterator<Item = u32> + '_ {
        let words = self.row(y).iter().flat_map(|&word| [word as u32, (word >> 32) as u32]);
        words.take((self.width as usize).div_ceil(32))
    }

    /// Swaps set and clear.
    pub(super) fn invert(&mut self) {
        let (stride, last) = (self.stride, self.last_word());
        for row in self.words.chunks_exact_mut(stride.max(1)) {
            row.iter_mut().for_each(|word| *word = !*word);
            if let Some(word) = row.last_mut() {
                *word &= last;
            }
        }
    }

    /// Writes a row from one byte a pixel, each 0 or 1.
    pub(super) fn pack_row(&mut self, y: usize, flags: &[u8]) {
        let width = self.width as usize;
        pack_flags(&flags[..width], self.row_mut(y));
    }

    /// Sets the pixels `columns` of a row.
    pub(super) fn set_run(&mut self, y: usize, columns: Range<usize>) {
        for (word, bits) in run_words(columns) {
            self.words[y * self.stride + word] |= bits;
        }
    }

    /// Whether any pixel of `columns` in a row is set.
    pub(super) fn any_in_run(&self, y: usize, columns: Range<usize>) -> bool {
        run_words(columns).any(|(word, bits)| self.words[y * self.stride + word] & bits != 0)
    }

    /// Calls `found(y, columns)` for every maximal run of set pixels, in reading order.
    pub(super) fn for_each_run(&self, mut found: impl FnMut(usize, Range<usize>)) {
        for y in 0..self.height as usize {
            let mut open: Option<usize> = None;
            for (index, &word) in self.row(y).iter().enumerate() {
                // Within the word, alternate between looking for the next set and the next clear bit.
                let mut at = 0;
                while at < 64 {
                    let rest = if open.is_some() { !word >> at } else { word >> at };
                    if rest == 0 {
                        break;
                    }
                    at += rest.trailing_zeros();
                    let x = index * 64 + at as usize;
                    match open.take() {
                        Some(start) => found(y, start..x),
                        None => open = Some(x),
                    }
                }
            }
            if let Some(start) = open {
                found(y, start..self.width as usize);
            }
        }
    }
}

/// The words a run of columns touches, with its bits in each.
fn run_words(columns: Range<usize>) -> impl Iterator<Item = (usize, u64)> {
    let (start, end) = (columns.start, columns.end.max(columns.start));
    (start / 64..end.div_ceil(64)).map(move |word| {
        let from = start.saturating_sub(word * 64);
        let to = (end - word * 64).min(64);
        let below_to = if to == 64 { u64::MAX } else { (1 << to) - 1 };
        (word, below_to & u64::MAX.checked_shl(from as u32).unwrap_or(0))
    })
}

/// Packs bytes of 0 or 1 into words, the first byte in the lowest bit.
fn pack_flags(flags: &[u8], words: &mut [u64]) {
    for (word, chunk) in words.iter_mut().zip(flags.chunks(64)) {
        *word = 0;
        let mut octets = chunk.chunks_exact(8);
        let mut at = 0;
        for octet in &mut octets {
            let mut bytes = [0; 8];
            bytes.copy_from_slice(octet);
            // The product gathers bit 0 of byte i into bit 56 + i: eight flags in one multiplication.
            *word |= (u64::from_le_bytes(bytes).wrapping_mul(0x0102_0408_1020_4080) >> 56) << at;
            at += 8;
        }
        for &flag in octets.remainder() {
            *word |= u64::from(flag) << at;
            at += 1;
        }
    }
}

#[cfg(test)]
pub(super) use tests::any_bit_image;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Random pictures of widths around the word size.
    pub(crate) fn any_bit_image() -> impl Strategy<Value = BitImage> {
        (1_u32..140, 1_u32..24).prop_flat_map(|(width, height)| {
            let density = prop_oneof![Just(0.03), Just(0.5), Just(0.97)];
            let pixels = density.prop_flat_map(move |p| {
                proptest::collection::vec(proptest::bool::weighted(p), (width * height) as usize)
            });
            pixels.prop_map(move |pixels| BitImage::from_fn(width, height, |x, y| pixels[(y * width + x) as usize]))
        })
    }

    proptest! {
        #[test]
        fn packing_matches_single_bits(flags in proptest::collection::vec(0_u8..2, 1..200)) {
            let width = flags.len() as u32;
            let mut packed = BitImage::new(width, 1);
            packed.pack_row(0, &flags);
            prop_assert_eq!(packed, BitImage::from_fn(width, 1, |x, _| flags[x as usize] == 1));
        }

        #[test]
        fn gray_round_trip(image in any_bit_image()) {
            let mut back = BitImage::new(image.width(), image.height());
            back.copy_from_gray(&image.to_gray());
            prop_assert_eq!(back, image);
        }

        #[test]
        fn runs_rebuild_the_picture_and_are_maximal(image in any_bit_image()) {
            let mut back = BitImage::new(image.width(), image.height());
            let mut maximal = true;
            image.for_each_run(|y, columns| {
                let (x0, x1) = (columns.start as u32, columns.end as u32);
                maximal &= x1 > x0 && !image.get(x1, y as u32) && (x0 == 0 || !image.get(x0 - 1, y as u32));
                back.set_run(y, columns);
            });
            prop_assert!(maximal);
            prop_assert_eq!(back, image);
        }

        #[test]
        fn counts_bounds_and_complement(image in any_bit_image()) {
            let (width, height) = (image.width(), image.height());
            let set: Vec<(u32, u32)> =
                (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&(x, y)| image.get(x, y)).collect();
            prop_assert_eq!(image.count() as usize, set.len());
            let bounds = set.iter().fold(None, |bounds: Option<Region>, &(x, y)| {
                let b = bounds.unwrap_or(Region { x0: x, y0: y, x1: x, y1: y });
                let (x0, y0) = (b.x0.min(x), b.y0.min(y));
                Some(Region { x0, y0, x1: b.x1.max(x + 1), y1: b.y1.max(y + 1) })
            });
            prop_assert_eq!(image.bounds(), bounds);
            let mut inverse = image.clone();
            inverse.invert();
            prop_assert_eq!(inverse.count(), width * height - image.count());
            for y in 0..height as usize {
                let expected = (3..9.min(width)).any(|x| image.get(x, y as u32));
                prop_assert_eq!(image.any_in_run(y, 3..9.min(width as usize)), expected);
            }
        }
    }
}
