//! What making evidence does to every pixel, a row at a time: compiled for the wider vectors too. All numbers are whole ones, so that every
//! version gives the same.

use super::MOST;
use crate::features::Evidence;
use crate::features::likelihood::{ColourBin, LOG_STEPS};

/// How likely each pixel's colour is as a part of the body's, less how likely it is as background; `known` is what the colour inside of a ready
/// mask is the person's by anyway, where there is a mask.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn ratios(
    densities: &[i16],
    colours: &[ColourBin],
    part: &[i16],
    known: Option<&[i16]>,
    ratios: &mut [i16],
) {
    let most = MOST as i16;
    // So long, that no colour is looked up beyond.
    let part = &part[..ColourBin::COUNT];
    let pixels = ratios.iter_mut().zip(densities).zip(colours);
    match known {
        None => pixels.for_each(|((ratio, &background), &colour)| {
            *ratio = part[colour.index() % ColourBin::COUNT].saturating_sub(background).clamp(-most, most);
        }),
        // Inside of a ready mask it is the person's, and only which part is asked.
        Some(known) => pixels.for_each(|((ratio, &background), &colour)| {
            let known = if background < 0 { known[colour.index()] } else { 0 };
            let of_part = part[colour.index() % ColourBin::COUNT].saturating_sub(known);
            *ratio = of_part.saturating_sub(background).clamp(-most, most);
        }),
    }
}

/// Puts the codes of sixteen times the ratios into the words, for a class.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn put(sums: &[i16], class: usize, words: &mut [u32]) {
    let shift = (Evidence::BITS * class) as u32;
    words.iter_mut().zip(sums).for_each(|(word, &sum)| *word |= code(i32::from(sum)) << shift);
}

/// The words of pixels away from what may be the person, where nothing speaks for her; `classes` has a one in the place of every class.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn far(densities: &[i16], classes: u32, words: &mut [u32]) {
    let [least, most] = [LOG_STEPS as i16, MOST as i16];
    words.iter_mut().zip(densities).for_each(|(word, &density)| {
        *word = classes * code(-16 * i32::from(density.clamp(least, most)));
    });
}

/// The code of sixteen times a ratio in steps, which is at most [`MOST`] either way: 7 codes for 5 units, of 16 [`LOG_STEPS`] each, rounded.
#[inline(always)]
fn code(sum: i32) -> u32 {
    let neutral = Evidence::NEUTRAL as i32;
    // None is negative, so that dividing rounds down.
    (neutral * sum + (8 + 16 * neutral) * MOST) as u32 / (16 * MOST) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_rounded_ratios() {
        // A little beyond the largest too, where they stay the outermost.
        for sum in -16 * 330..=16 * 330 {
            let expected = (f64::from(sum) / (16.0 * 64.0) * 1.4 + 7.0 + 0.5).floor().clamp(0.0, 14.0) as u32;
            assert_eq!(code(sum), expected, "{sum}");
        }
    }

    /// By the definition, one pixel after the other; more pixels than the widest vector holds.
    #[test]
    fn rows_are_made_as_pixels_are() {
        let bins: Vec<ColourBin> = ColourBin::all().collect();
        let table = |seed: usize| -> Vec<i16> { (0..bins.len()).map(|at| (at * seed % 701) as i16 - 200).collect() };
        let (part, person) = (table(37), table(53));
        let colours: Vec<ColourBin> = (0..203).map(|at| bins[at * 977 % bins.len()]).collect();
        let densities: Vec<i16> = (0..203).map(|at| [-192, 16_383, -1500, 0, 63, 64, 300, 321][at % 8]).collect();
        for known in [None, Some(&person[..])] {
            let mut found = vec![0; 203];
            ratios(&densities, &colours, &part, known, &mut found);
            for (at, found) in found.into_iter().enumerate() {
                let (colour, background) = (colours[at].index(), i32::from(densities[at]));
                let known = known.filter(|_| background < 0).map_or(0, |known| i32::from(known[colour]));
                let expected = (i32::from(part[colour]) - known - background).clamp(-MOST, MOST);
                assert_eq!(i32::from(found), expected, "pixel {at}");
            }
        }
        let mut words = vec![3; 203];
        let sums: Vec<i16> = (0..203).map(|at| (at * 51) as i16 - 5120).collect();
        put(&sums, 2, &mut words);
        assert!(words.iter().zip(&sums).all(|(word, sum)| *word == (3 | code(i32::from(*sum)) << 8)));
        far(&densities, 0x11, &mut words);
        for (word, density) in words.into_iter().zip(densities) {
            assert_eq!(word, 0x11 * code(-16 * i32::from(density.clamp(64, 320))));
        }
    }
}
