//! Colours of a map taken from a picture.

use image::RgbImage;

use super::materials::{Band, Texel};

/// Colours of a palette.
const COLOURS: usize = 16;

/// The bands of a map in a picture's colours: its pixels from the darkest to the brightest in sixteen parts of as many pixels, each
/// part's mean light a colour, from height 0 to 1 in equal steps. A common colour takes many heights, as it takes many pixels.
pub fn palette(picture: &RgbImage) -> Vec<Band> {
    let mut pixels: Vec<[u8; 3]> = picture.pixels().map(|pixel| pixel.0).collect();
    // Ties by their colour, so that the order of pixels says nothing.
    pixels.sort_unstable_by_key(|&[r, g, b]| (299 * u32::from(r) + 587 * u32::from(g) + 114 * u32::from(b), r, g, b));
    (0..COLOURS)
        .map(|part| {
            let edge = |part: usize| part * pixels.len() / COLOURS;
            // Of a picture with fewer pixels than colours some are taken again.
            let (from, to) = (edge(part), edge(part + 1).max(edge(part) + 1).min(pixels.len()));
            let own = &pixels[from..to];
            let mut sum = [0.0_f64; 3];
            for pixel in own {
                let light = Texel { colour: pixel.map(|c| f32::from(c) / 255.0), height: 0.0 }.linear();
                sum.iter_mut().zip(light).for_each(|(sum, c)| *sum += f64::from(c));
            }
            let mean = sum.map(|sum| super::picture::encoded((sum / own.len().max(1) as f64) as f32));
            Band { from: part as f32 / (COLOURS - 1) as f32, colour: mean }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_palette_goes_from_dark_to_bright_in_the_picture_s_colours() {
        let colours = [[200, 220, 255], [20, 40, 90], [60, 120, 40], [60, 120, 40]];
        let picture = RgbImage::from_fn(20, 8, |x, _| image::Rgb(colours[x as usize % 4]));
        let bands = palette(&picture);
        assert_eq!(bands.len(), COLOURS);
        assert_eq!((bands[0].from, bands[COLOURS - 1].from), (0.0, 1.0));
        // A quarter is dark, half of them green, a quarter bright.
        let of = |band: usize| bands[band].colour.map(|c| (c * 255.0).round() as u8);
        let found = [0, 3, 4, 11, 12, 15].map(of);
        assert_eq!(found, [colours[1], colours[1], colours[2], colours[2], colours[0], colours[0]]);
        assert_eq!(palette(&RgbImage::from_pixel(1, 1, image::Rgb([9, 9, 9]))).len(), COLOURS);
    }
}
