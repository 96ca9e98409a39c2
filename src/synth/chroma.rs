//! Colour at half the resolution of brightness, as videos keep it.

/// The RGB picture with the colour of every four pixels made one; brightness stays. A grey picture stays as it is.
pub(super) fn with_half_chroma(bytes: &mut [u8], size: [u32; 2]) {
    let [width, height] = size.map(|side| side as usize);
    if bytes.len() != width * height * 3 {
        return;
    }
    let brightness = |rgb: &[u8]| 0.299 * f32::from(rgb[0]) + 0.587 * f32::from(rgb[1]) + 0.114 * f32::from(rgb[2]);
    for top in (0..height).step_by(2) {
        for left in (0..width).step_by(2) {
            let pixels = (top..(top + 2).min(height)).flat_map(|y| {
                let row = y * width;
                (left..(left + 2).min(width)).map(move |x| 3 * (row + x))
            });
            let (mut colour, mut count) = ([0.0f32; 3], 0.0f32);
            for at in pixels.clone() {
                let rgb = &bytes[at..at + 3];
                let level = brightness(rgb);
                colour.iter_mut().zip(rgb).for_each(|(sum, value)| *sum += f32::from(*value) - level);
                count += 1.0;
            }
            for at in pixels {
                let level = brightness(&bytes[at..at + 3]);
                for (value, sum) in bytes[at..at + 3].iter_mut().zip(colour) {
                    *value = (level + sum / count + 0.5).clamp(0.0, 255.0) as u8;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brightness_stays_and_colour_is_shared() {
        // Red beside grey, of different brightness; the odd last column has itself alone.
        let mut picture = [200, 20, 20, 90, 90, 90, 10, 20, 30, 200, 20, 20, 90, 90, 90, 10, 20, 30];
        let before = picture;
        with_half_chroma(&mut picture, [3, 2]);
        let level = |rgb: &[u8]| 0.299 * f32::from(rgb[0]) + 0.587 * f32::from(rgb[1]) + 0.114 * f32::from(rgb[2]);
        for (a, b) in picture.chunks(3).zip(before.chunks(3)) {
            assert!((level(a) - level(b)).abs() < 1.5, "{a:?} {b:?}");
        }
        assert!(picture[3] > picture[4] + 40, "the grey pixel takes half of its neighbour's red: {picture:?}");
        assert_eq!(picture[6..9], before[6..9]);
        let mut grey = [7; 6];
        with_half_chroma(&mut grey, [3, 2]);
        assert_eq!(grey, [7; 6]);
    }
}
