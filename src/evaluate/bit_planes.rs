//! Packed observations as bit planes: the form in which a comparison is a bit operation and a bit count.

/// Pixels of a word of a plane.
pub(crate) const WORD_PIXELS: usize = 32;

/// Up to 32 bytes of a row as eight words: bit `i` of word `p` is bit `p` of byte `i`. Planes 0..=6 are then the proximity bits,
/// plane 7 the silhouette.
pub(crate) fn bit_planes(pixels: &[u8]) -> [u32; 8] {
    let mut planes = [0; 8];
    if let Some(all) = one_value(pixels) {
        planes.iter_mut().enumerate().for_each(|(bit, plane)| *plane = everywhere(u32::from(all), bit));
        return planes;
    }
    for (group, eight) in pixels.chunks(8).take(WORD_PIXELS / 8).enumerate() {
        let mut bytes = [0; 8];
        bytes[..eight.len()].copy_from_slice(eight);
        let transposed = transpose_bits(u64::from_le_bytes(bytes)).to_le_bytes();
        for (plane, byte) in planes.iter_mut().zip(transposed) {
            *plane |= u32::from(byte) << (8 * group);
        }
    }
    planes
}

/// The transpose of an 8x8 bit matrix, one byte a row: bit i of byte j becomes bit j of byte i. By swapping ever larger
/// blocks across the diagonal.
fn transpose_bits(mut m: u64) -> u64 {
    let swap = (m ^ (m >> 7)) & 0x00aa_00aa_00aa_00aa;
    m ^= swap ^ (swap << 7);
    let swap = (m ^ (m >> 14)) & 0x0000_cccc_0000_cccc;
    m ^= swap ^ (swap << 14);
    let swap = (m ^ (m >> 28)) & 0x0000_0000_f0f0_f0f0;
    m ^ swap ^ (swap << 28)
}

/// What all pixels of a whole word are, as most words away from the person are of one value.
fn one_value<T: Copy + PartialEq>(pixels: &[T]) -> Option<T> {
    let pixels = pixels.first_chunk::<WORD_PIXELS>()?;
    // Without an early end, so that it is a few comparisons of vectors.
    pixels.iter().fold(true, |alike, pixel| alike & (*pixel == pixels[0])).then_some(pixels[0])
}

/// The plane of a bit that all pixels have as `value` has it.
fn everywhere(value: u32, bit: usize) -> u32 {
    (value >> bit & 1).wrapping_neg()
}

/// Up to 32 words of a row as 32: bit `i` of word `p` is bit `p` of word `i`, by the same swaps.
pub(crate) fn word_planes(pixels: &[u32]) -> [u32; WORD_PIXELS] {
    let mut planes = [0; WORD_PIXELS];
    if let Some(all) = one_value(pixels) {
        planes.iter_mut().enumerate().for_each(|(bit, plane)| *plane = everywhere(all, bit));
        return planes;
    }
    for (plane, pixel) in planes.iter_mut().zip(pixels) {
        *plane = *pixel;
    }
    for (width, mask) in [(16, 0x0000_ffff_u32), (8, 0x00ff_00ff), (4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)]
    {
        for block in planes.chunks_exact_mut(2 * width) {
            let (low, high) = block.split_at_mut(width);
            for (low, high) in low.iter_mut().zip(high) {
                let swap = (*low >> width ^ *high) & mask;
                *high ^= swap;
                *low ^= swap << width;
            }
        }
    }
    planes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_transposed() {
        for (count, factor) in [(0, 1), (1, 1), (31, 1), (32, 1), (31, 0), (32, 0)] {
            // With the factor 0 all are alike.
            let pixels: Vec<u32> =
                (1..=count).map(|pixel: u32| (77 + pixel * factor).wrapping_mul(2_654_435_761)).collect();
            let planes = word_planes(&pixels);
            for pixel in 0..WORD_PIXELS {
                let word = (0..32).fold(0, |word, bit| word | (planes[bit] >> pixel & 1) << bit);
                assert_eq!(word, pixels.get(pixel).copied().unwrap_or(0), "pixel {pixel} of {count}");
            }
        }
    }

    #[test]
    fn every_bit_is_where_it_belongs() {
        for (count, factor) in [(0, 1), (1, 1), (8, 1), (13, 1), (31, 1), (32, 1), (31, 0), (32, 0)] {
            let pixels: Vec<u8> = (0..count)
                .map(|pixel: u32| (77 + pixel * factor).wrapping_mul(2_654_435_761).to_be_bytes()[0])
                .collect();
            let planes = bit_planes(&pixels);
            for pixel in 0..WORD_PIXELS {
                let byte = (0..8).fold(0, |byte, plane| byte | ((planes[plane] >> pixel & 1) as u8) << plane);
                assert_eq!(byte, pixels.get(pixel).copied().unwrap_or(0), "pixel {pixel} of {count}");
            }
        }
    }
}
