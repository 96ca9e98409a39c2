//! What is known of a picture's light before its pixels are judged, and the constants that it makes of every slope of the background
//! (METHOD A12).

use std::sync::LazyLock;

use crate::features::shaders::{LIKELY_SLOPES, SHADOW_STEPS};

/// Standard deviation that a slope of the background adds, of luma and of the other two: a picture is never sampled twice at the same place.
const SLOPE: [f32; 2] = [0.35, 0.2];
/// Steps in which a slope is kept, one a grey level.
pub(super) const SLOPES: usize = LIKELY_SLOPES as usize;
/// The share of pixels that no hypothesis explains.
pub(super) const OUTLIERS: f32 = 0.002;
/// The share of pixels in shadow that is assumed before a picture is looked at, and how many pixels that is worth.
pub(super) const SHADOWED: f32 = 0.2;
const PRIOR_PIXELS: f32 = 200.0;
/// The smallest and the largest share that is believed.
const LEAST_SHADOWED: f32 = 0.02;
const MOST_SHADOWED: f32 = 0.5;

/// The darkest shadow and the brightest reflection, as multiples of the background's luma.
pub(super) const DARKEST: f32 = 0.45;
pub(super) const BRIGHTEST: f32 = 1.15;
/// How fast the density falls below 1 and above.
pub(super) const SHADOW_FALL: f32 = 0.12;
pub(super) const REFLECTION_FALL: f32 = 0.04;
/// The logarithms of the densities of brightness on both sides of 1: of (1 - 0.3) / 0.12 and of 0.3 / 0.04.
pub(super) const SHADOW_LOG: f32 = 1.763_588_6;
pub(super) const REFLECTION_LOG: f32 = 2.014_903;

/// The constants of one picture for a slope of the background.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Widths {
    /// 1 / variance of luma, and of the other two.
    pub(crate) y: f32,
    pub(crate) c: f32,
    /// Log density of the lit background's own colour, and that of a shadow but for its luma, over the uniform one.
    pub(crate) lit: f32,
    pub(crate) shadow: f32,
}

/// Noise and share of shadows of a picture, in steps so coarse that pictures taken one after the other have the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Light {
    /// Standard deviation a channel, grey levels.
    pub(super) noise: [f32; 3],
    pub(super) shadowed: f32,
    /// Whether neither the picture nor the background has any colour: then luma alone tells them apart.
    pub(super) is_grey: bool,
}

impl Light {
    pub(super) fn new(noise: [f32; 3], shadowed: f32, is_grey: bool) -> Self {
        Self { noise: coarse(noise), shadowed: share_of_step(step(shadowed)), is_grey }
    }
}

/// Noise in steps of an eighth of a grey level.
fn coarse(noise: [f32; 3]) -> [f32; 3] {
    noise.map(|noise| (8.0 * noise).round() / 8.0)
}

/// Shares of shadows in steps of a factor of 1.19, counted from 1 downwards: a whole number.
fn step(shadowed: f32) -> f32 {
    (4.0 * shadowed.log2()).round()
}

fn share_of_step(step: f32) -> f32 {
    2.0_f32.powf(step / 4.0)
}

/// The share of shadows where so many pixels more than the assumed ones look like background, so many of them in shadow.
pub(super) fn shadow_share(in_shadow: u32, all: u32) -> f32 {
    let [in_shadow, all] = [in_shadow, all].map(|count| count as f32);
    ((SHADOWED * PRIOR_PIXELS + in_shadow) / (PRIOR_PIXELS + all)).clamp(LEAST_SHADOWED, MOST_SHADOWED)
}

/// The constants for every slope, with this noise a channel and share of shadows.
pub(super) fn widths([y, b, r]: [f32; 3], shadowed: f32, is_grey: bool) -> [Widths; SLOPES] {
    // A colour's cube in luma and differences is as large as in red, green and blue times the weight of green.
    let uniform = (256.0_f32.powi(3) * 0.587).ln();
    let normal = 0.5 * std::f32::consts::TAU.ln();
    std::array::from_fn(|slope| {
        let slope = slope as f32;
        let [vy, vc] = [y * y + (SLOPE[0] * slope).powi(2), b * r + (SLOPE[1] * slope).powi(2)];
        if is_grey {
            // Over the uniform density of greys.
            return Widths {
                y: 1.0 / vy,
                c: 0.0,
                lit: 256.0_f32.ln() - normal - 0.5 * vy.ln() + (1.0 - shadowed - OUTLIERS).ln(),
                shadow: 256.0_f32.ln() + shadowed.ln(),
            };
        }
        Widths {
            y: 1.0 / vy,
            c: 1.0 / vc,
            lit: uniform - 3.0 * normal - 0.5 * vy.ln() - vc.ln() + (1.0 - shadowed - OUTLIERS).ln(),
            shadow: uniform - 2.0 * normal - vc.ln() + shadowed.ln(),
        }
    })
}

/// The constants of every share of shadows that a picture may turn out to have, by step and slope: what a device looks up, since it
/// takes no logarithms.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct WidthTables {
    noise: [f32; 3],
    is_grey: bool,
    pub(crate) of_steps: Vec<[Widths; SLOPES]>,
}

impl WidthTables {
    fn new(noise: [f32; 3], is_grey: bool) -> Self {
        let of_step = |step: &f32| widths(noise, share_of_step(*step), is_grey);
        Self { noise, is_grey, of_steps: SHADOWS.steps.iter().map(of_step).collect() }
    }
}

/// A picture's light as a device is told of it.
#[derive(Clone, Debug)]
pub(crate) struct LightTables {
    /// What to multiply the picture's channels with to have them in the background's light.
    pub(crate) dim: [f32; 3],
    /// Whether the camera sees in grey.
    pub(crate) is_grey: bool,
    /// The constants by which shadows are counted.
    pub(crate) counting: [Widths; SLOPES],
    noise: [f32; 3],
}

impl LightTables {
    pub(super) fn new(dim: [f32; 3], noise: [f32; 3], is_grey: bool) -> Self {
        Self { dim, is_grey, counting: widths(noise, SHADOWED, is_grey), noise: coarse(noise) }
    }

    /// Makes `tables` those of this light; whether they were others.
    pub(crate) fn update(&self, tables: &mut Option<WidthTables>) -> bool {
        let is_known = tables.as_ref().is_some_and(|old| old.noise == self.noise && old.is_grey == self.is_grey);
        if !is_known {
            *tables = Some(WidthTables::new(self.noise, self.is_grey));
        }
        !is_known
    }
}

/// What every picture's light shares on a device.
pub(crate) struct Shadows {
    /// The steps that a share of shadows may be of, from the smallest share on.
    steps: Vec<f32>,
    /// The smallest share of each but the first.
    pub(crate) from: Vec<f32>,
    pub(crate) falls: Falls,
    /// Pixels in shadow and pixels that are assumed before any is counted, and the smallest and largest share that is believed.
    pub(crate) assumed: [f32; 2],
    pub(crate) believed: [f32; 2],
}

/// The constants of every picture, for a device that judges alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Falls {
    /// The log density of an outlier.
    pub(crate) outlier: f32,
    /// The darkest shadow and the brightest reflection.
    pub(crate) range: [f32; 2],
    /// The logarithms of the densities below 1 and above, and how fast they fall.
    pub(crate) logs: [f32; 2],
    pub(crate) falls: [f32; 2],
}

impl Default for Falls {
    fn default() -> Self {
        Self {
            outlier: OUTLIERS.ln(),
            range: [DARKEST, BRIGHTEST],
            logs: [SHADOW_LOG, REFLECTION_LOG],
            falls: [1.0 / SHADOW_FALL, 1.0 / REFLECTION_FALL],
        }
    }
}

/// [`Shadows`] of this processor's own logarithms.
pub(crate) static SHADOWS: LazyLock<Shadows> = LazyLock::new(|| {
    let first = step(LEAST_SHADOWED);
    let steps: Vec<f32> = (0..SHADOW_STEPS).map(|at| first + at as f32).collect();
    // Shares are positive numbers, whose bits have their order.
    let smallest = |wanted: &f32| {
        let (mut below, mut from) = (LEAST_SHADOWED.to_bits(), MOST_SHADOWED.to_bits());
        while from - below > 1 {
            let middle = below.midpoint(from);
            if step(f32::from_bits(middle)) < *wanted { below = middle } else { from = middle }
        }
        f32::from_bits(from)
    };
    let from = steps.iter().skip(1).map(smallest).collect();
    Shadows {
        from,
        steps,
        falls: Falls::default(),
        assumed: [SHADOWED * PRIOR_PIXELS, PRIOR_PIXELS],
        believed: [LEAST_SHADOWED, MOST_SHADOWED],
    }
});

#[cfg(test)]
mod tests {
    use super::*;

    /// What a device does: counts the steps that a share reaches.
    fn looked_up(share: f32) -> f32 {
        SHADOWS.steps[SHADOWS.from.iter().filter(|from| share >= **from).count()]
    }

    #[test]
    fn steps_of_shadows_are_looked_up_as_they_are_computed() {
        assert_eq!((SHADOWS.steps[0], *SHADOWS.steps.last().unwrap()), (step(LEAST_SHADOWED), step(MOST_SHADOWED)));
        for in_shadow in (0..9000).step_by(7) {
            for all in (in_shadow..20_000).step_by(131) {
                let share = shadow_share(in_shadow, all);
                assert_eq!(looked_up(share), step(share), "{in_shadow} of {all}");
            }
        }
        // Round every border, where logarithms round one way or the other.
        for from in &SHADOWS.from {
            for bits in from.to_bits() - 3000..from.to_bits() + 3000 {
                let share = f32::from_bits(bits);
                assert_eq!(looked_up(share), step(share), "{share}");
            }
        }
    }

    #[test]
    fn tables_hold_the_constants_of_every_share() {
        let mut tables = None;
        let light = LightTables::new([1.0; 3], [2.03, 1.2, 1.0], false);
        assert!(light.update(&mut tables) && !light.update(&mut tables));
        assert!(LightTables::new([1.0; 3], [2.03, 1.2, 1.0], true).update(&mut tables.clone()));
        for (in_shadow, all) in [(0, 0), (0, 4000), (900, 1000), (100, 900)] {
            let share = shadow_share(in_shadow, all);
            let light = Light::new([2.03, 1.2, 1.0], share, false);
            let place = SHADOWS.from.iter().filter(|from| share >= **from).count();
            let found = tables.as_ref().unwrap().of_steps[place];
            assert_eq!(found, widths(light.noise, light.shadowed, light.is_grey), "{in_shadow} of {all}");
        }
    }
}
