//! Packed observations as bit planes: the form in which a comparison is a bit operation and a bit count.

/// Pixels of a word of a plane.
pub(crate) const WORD_PIXELS: usize = 32;

/// Up to 32 bytes of a row as eight words: bit `i` of word `p` is bit `p` of byte `i`. Planes 0..=6 are then the proximity bits,
/// plane 7 the silhouette.
pub(crate) fn bit_planes(pixels: &[u8]) -> [u32; 8] {
    let mut planes = [0; 8];
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_is_where_it_belongs() {
        for count in [0, 1, 8, 13, 31, 32] {
            let pixels: Vec<u8> =
                (0..count).map(|pixel: u32| pixel.wrapping_mul(2_654_435_761).to_be_bytes()[0]).collect();
            let planes = bit_planes(&pixels);
            for pixel in 0..WORD_PIXELS {
                let byte = (0..8).fold(0, |byte, plane| byte | ((planes[plane] >> pixel & 1) as u8) << plane);
                assert_eq!(byte, pixels.get(pixel).copied().unwrap_or(0), "pixel {pixel} of {count}");
            }
        }
    }
}
