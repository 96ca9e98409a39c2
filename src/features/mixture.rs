//! A mixture of Gaussians per pixel: a background learnt from the pictures themselves (METHOD A5.1).

use image::RgbImage;
use rayon::prelude::*;
use serde::Deserialize;

use super::light::{GRID, Ratios};
use super::plate::split_row;
use super::shadow::ShadowSettings;
use crate::arithmetic::exp_of_negative;
use crate::files::choices;

choices! {
    /// How fast the matched component follows a pixel.
    "adaptation" pub enum Adaptation {
        /// rho = alpha / w_k: a component settles as fast as it has been seen often.
        "weight" Weight,
        /// rho = alpha N(X | mu, sigma), as first published. The density of a colour in cubic grey levels is some 1e-4, so means
        /// and variances practically stand still.
        "density" Density,
    }
}

/// The parameters of the mixture. Distances are Euclidean in RGB, in grey levels; a component's variance is that of the
/// distance, all three channels together.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MixtureSettings {
    /// Gaussians a pixel, K, 3 to 5.
    pub components: usize,
    /// The weights' learning rate alpha, a frame.
    pub learning_rate: f32,
    /// The first frames, over which the n-th frame's rate is at least 1/n: a plain average of what was seen so far.
    pub warm_up: u32,
    /// A component matches within this many standard deviations.
    pub match_sigma: f32,
    /// The most probable components up to this total weight are background.
    pub background_weight: f32,
    /// Standard deviation of a new component.
    pub initial_sigma: f32,
    /// Weight of a new component.
    pub initial_weight: f32,
    /// No component gets narrower: the camera's noise.
    pub min_sigma: f32,
    /// How fast the matched component follows.
    pub adaptation: Adaptation,
    /// Whether each picture's brightness is first fitted to the background's, channel by channel: for light that changes
    /// faster than the components follow.
    pub gain: bool,
}

impl Default for MixtureSettings {
    fn default() -> Self {
        Self {
            components: 3,
            learning_rate: 0.002,
            warm_up: 50,
            match_sigma: 2.5,
            background_weight: 0.7,
            initial_sigma: 20.0,
            initial_weight: 0.01,
            min_sigma: 8.0,
            adaptation: Adaptation::Weight,
            gain: false,
        }
    }
}

/// Pixels worked on together: a few of the widest vectors, and too many for the compiler to unroll the loop over them before
/// it makes vector code of it.
const LANES: usize = 32;

/// Values of a component: weight, mean red, green, blue, variance.
const FIELDS: usize = super::shaders::MIXTURE_FIELDS as usize;

/// Rows a task: enough work to be worth handing to another core.
const ROWS: usize = 16;

type Lanes = [f32; LANES];

/// The mixtures of all pixels of one view.
///
/// `state` is `[row][block of LANES pixels][component][field][lane]`, so that a block's numbers lie side by side.
#[derive(Clone, Debug)]
pub struct Mixture {
    settings: MixtureSettings,
    width: usize,
    blocks: usize,
    frames: u32,
    state: Vec<f32>,
}

/// The rates of one frame.
#[derive(Clone, Copy)]
struct Rates {
    alpha: f32,
    match_squared: f32,
    /// What to multiply the picture's channels with to have them in the background's light.
    dim: [f32; 3],
}

impl MixtureSettings {
    /// The weights' learning rate of a frame after `frames` others.
    pub(super) fn rate(&self, frames: u32) -> f32 {
        let average = if frames < self.warm_up { 1.0 / (frames as f32 + 1.0) } else { 0.0 };
        self.learning_rate.max(average)
    }
}

impl Mixture {
    /// Mixtures that have seen nothing, for pictures of `width` × `height` pixels.
    pub fn new(settings: MixtureSettings, width: u32, height: u32) -> Self {
        let blocks = (width as usize).div_ceil(LANES);
        let state = vec![0.0; height as usize * blocks * settings.components * FIELDS * LANES];
        Self { settings, width: width as usize, blocks, frames: 0, state }
    }

    /// One number of a pixel's component `k`: weight, mean red, green, blue, variance.
    #[cfg(test)]
    pub(super) fn value(&self, x: usize, y: usize, k: usize, field: usize) -> f32 {
        let block = y * self.blocks + x / LANES;
        self.state[((block * self.settings.components + k) * FIELDS + field) * LANES + x % LANES]
    }

    /// Learns from a picture and flags (0 or 1, row-major) the pixels that are neither background nor its shadow. The
    /// first picture is all background.
    pub fn update(&mut self, picture: &RgbImage, shadow: &ShadowSettings, foreground: &mut [u8]) {
        match self.settings.components {
            3 => self.update_k::<3>(picture, shadow, foreground),
            4 => self.update_k::<4>(picture, shadow, foreground),
            // The settings' check lets nothing else through.
            _ => self.update_k::<5>(picture, shadow, foreground),
        }
    }

    /// The mean of the most probable component of every pixel; none before the first picture.
    pub(super) fn most_probable_colours(&self) -> Option<RgbImage> {
        let row = self.blocks * self.settings.components * FIELDS * LANES;
        let height = self.state.len().checked_div(row)?;
        let blocks = self.state.as_chunks::<LANES>().0;
        let fields = self.settings.components * FIELDS;
        (self.frames > 0).then(|| {
            RgbImage::from_fn(self.width as u32, height as u32, |x, y| {
                let block = y as usize * self.blocks + x as usize / LANES;
                image::Rgb(most_probable(&blocks[block * fields..][..fields], x as usize % LANES))
            })
        })
    }

    /// How much brighter a picture is than the most probable components.
    fn gain<const K: usize>(&self, picture: &RgbImage) -> [f32; 3] {
        let mut ratios = Ratios::new();
        let rows = self.state.chunks_exact(self.blocks * K * FIELDS * LANES);
        for (state, rgb) in rows.zip(picture.as_raw().chunks_exact(self.width * 3)).step_by(GRID) {
            let (blocks, _) = state.as_chunks::<LANES>();
            for (x, &seen) in rgb.as_chunks().0.iter().enumerate().step_by(GRID) {
                let block = &blocks[x / LANES * K * FIELDS..][..K * FIELDS];
                ratios.add(seen, most_probable(block, x % LANES));
            }
        }
        ratios.gains()
    }

    fn update_k<const K: usize>(&mut self, picture: &RgbImage, shadow: &ShadowSettings, foreground: &mut [u8]) {
        let (width, settings, first) = (self.width, self.settings, self.frames == 0);
        let rates = Rates {
            alpha: settings.rate(self.frames),
            match_squared: settings.match_sigma * settings.match_sigma,
            dim: if settings.gain && !first { self.gain::<K>(picture).map(|gain| 1.0 / gain) } else { [1.0; 3] },
        };
        self.frames = self.frames.saturating_add(1);
        let band_state = self.blocks * K * FIELDS * LANES * ROWS;
        let tasks = self
            .state
            .par_chunks_mut(band_state)
            .zip(picture.as_raw().par_chunks(width * 3 * ROWS))
            .zip(foreground.par_chunks_mut(width * ROWS));
        tasks.for_each_init(
            || [const { Vec::new() }; 3],
            |planes, ((state, rgb), foreground)| {
                update_rows(Rows { state, rgb, foreground, width, first }, rates, &settings, shadow, planes);
            },
        );
    }
}

/// Some rows of a picture, with their mixtures.
struct Rows<'a> {
    state: &'a mut [f32],
    rgb: &'a [u8],
    foreground: &'a mut [u8],
    width: usize,
    /// Whether nothing was seen before.
    first: bool,
}

/// Updates some rows; `planes` is room for one row's channels. Compiled for the wider vectors too: no operation is fused, so that
/// every version gives the same numbers.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn update_rows(
    rows: Rows<'_>,
    rates: Rates,
    settings: &MixtureSettings,
    shadow: &ShadowSettings,
    planes: &mut [Vec<f32>; 3],
) {
    match (settings.components, settings.adaptation) {
        (3, Adaptation::Weight) => update_rows_k::<3, false>(rows, rates, settings, shadow, planes),
        (4, Adaptation::Weight) => update_rows_k::<4, false>(rows, rates, settings, shadow, planes),
        // The settings' check lets no other number through.
        (_, Adaptation::Weight) => update_rows_k::<5, false>(rows, rates, settings, shadow, planes),
        (3, Adaptation::Density) => update_rows_k::<3, true>(rows, rates, settings, shadow, planes),
        (4, Adaptation::Density) => update_rows_k::<4, true>(rows, rates, settings, shadow, planes),
        (_, Adaptation::Density) => update_rows_k::<5, true>(rows, rates, settings, shadow, planes),
    }
}

#[inline(always)]
fn update_rows_k<const K: usize, const DENSITY: bool>(
    rows: Rows<'_>,
    rates: Rates,
    settings: &MixtureSettings,
    shadow: &ShadowSettings,
    planes: &mut [Vec<f32>; 3],
) {
    let Rows { state, rgb, foreground, width, first } = rows;
    let row_state = width.div_ceil(LANES) * K * FIELDS * LANES;
    let rows = state.chunks_exact_mut(row_state).zip(rgb.chunks_exact(width * 3));
    for ((state, rgb), foreground) in rows.zip(foreground.chunks_exact_mut(width)) {
        split_row(rgb, planes);
        let blocks = state.as_chunks_mut::<LANES>().0.as_chunks_mut::<FIELDS>().0.as_chunks_mut::<K>().0;
        for (block, (lanes, flags)) in blocks.iter_mut().zip(foreground.chunks_mut(LANES)).enumerate() {
            let at = block * LANES..(block * LANES + flags.len());
            let mut seen = [[0.0; LANES]; 3];
            for ((seen, plane), dim) in seen.iter_mut().zip(planes.iter()).zip(rates.dim) {
                for (seen, value) in seen.iter_mut().zip(&plane[at.clone()]) {
                    *seen = value * dim;
                }
            }
            let result = if first {
                start_block(lanes, &seen, settings);
                [0; LANES]
            } else {
                update_block::<K, DENSITY>(lanes, &seen, rates, settings, shadow)
            };
            for (flag, result) in flags.iter_mut().zip(result) {
                *flag = result as u8;
            }
        }
    }
}

/// The mean of the most probable component of one lane of a block.
fn most_probable(lanes: &[Lanes], lane: usize) -> [u8; 3] {
    let (mut mean, mut greatest) = ([0; 3], -1.0);
    for component in lanes.chunks_exact(FIELDS) {
        let rank = component[0][lane] * component[0][lane] / component[4][lane];
        if rank > greatest {
            greatest = rank;
            mean = [1, 2, 3].map(|field: usize| component[field][lane].round().clamp(0.0, 255.0) as u8);
        }
    }
    mean
}

/// The first picture: one component at the colour, the others without weight and out of every colour's reach.
fn start_block(lanes: &mut [[Lanes; FIELDS]], seen: &[Lanes; 3], settings: &MixtureSettings) {
    for (k, component) in lanes.iter_mut().enumerate() {
        component[0] = [if k == 0 { 1.0 } else { 0.0 }; LANES];
        for channel in 0..3 {
            component[1 + channel] = if k == 0 { seen[channel] } else { [-1e4; LANES] };
        }
        component[4] = [settings.initial_sigma * settings.initial_sigma; LANES];
    }
}

/// One picture's step for [`LANES`] pixels; returns their foreground flags.
///
/// One loop over lanes, long enough not to be unrolled, and every choice made by comparing and selecting values, never by a
/// branch: so the compiler turns it into vector code.
#[inline(always)]
fn update_block<const K: usize, const DENSITY: bool>(
    lanes: &mut [[Lanes; FIELDS]; K],
    seen: &[Lanes; 3],
    rates: Rates,
    settings: &MixtureSettings,
    shadow: &ShadowSettings,
) -> [u32; LANES] {
    let (initial_variance, least_variance) =
        (settings.initial_sigma * settings.initial_sigma, settings.min_sigma * settings.min_sigma);
    let mut flags = [0; LANES];
    for l in 0..LANES {
        let seen = [seen[0][l], seen[1][l], seen[2][l]];
        let mut weight = [0.0_f32; K];
        let mut variance = [0.0_f32; K];
        let mut mean = [[0.0_f32; 3]; K];
        // Squared distance, and the rank (w / sigma)² by which components are more or less probable.
        let (mut distance, mut rank) = ([0.0_f32; K], [0.0_f32; K]);
        for k in 0..K {
            weight[k] = lanes[k][0][l];
            mean[k] = [lanes[k][1][l], lanes[k][2][l], lanes[k][3][l]];
            variance[k] = lanes[k][4][l];
            let (dr, dg, db) = (seen[0] - mean[k][0], seen[1] - mean[k][1], seen[2] - mean[k][2]);
            distance[k] = dr * dr + dg * dg + db * db;
            rank[k] = weight[k] * weight[k] / variance[k];
        }

        // The most probable component that matches, and the least and most probable of all.
        let (mut best, mut best_rank, mut best_weight) = (K as u32, -1.0_f32, 0.0);
        let (mut least, mut least_rank) = (0, f32::INFINITY);
        let (mut top, mut top_rank) = ([0.0; 3], -1.0_f32);
        for k in 0..K {
            let matches = (distance[k] <= rates.match_squared * variance[k]) & (rank[k] > best_rank);
            best = if matches { k as u32 } else { best };
            best_rank = if matches { rank[k] } else { best_rank };
            best_weight = if matches { weight[k] } else { best_weight };
            let lesser = rank[k] < least_rank;
            least = if lesser { k as u32 } else { least };
            least_rank = if lesser { rank[k] } else { least_rank };
            let greater = rank[k] > top_rank;
            top_rank = if greater { rank[k] } else { top_rank };
            for channel in 0..3 {
                top[channel] = if greater { mean[k][channel] } else { top[channel] };
            }
        }

        // Background: the weight of everything more probable than the matched component has not yet reached the fraction.
        let mut before = 0.0_f32;
        for k in 0..K {
            before += if rank[k] > best_rank { weight[k] } else { 0.0 };
        }
        let unmatched = best == K as u32;
        let unexplained = unmatched | (before >= settings.background_weight);
        flags[l] = u32::from(unexplained & !shadow.covers(seen, top));

        // The update. A component that is replaced takes the pixel's colour, a large variance and a small weight.
        let followed = best_weight * (1.0 - rates.alpha) + rates.alpha;
        let follow = (rates.alpha / followed.max(1e-6)).min(1.0);
        let mut total = 0.0;
        for k in 0..K {
            let matched = best == k as u32;
            let new_weight = weight[k] * (1.0 - rates.alpha) + if matched { rates.alpha } else { 0.0 };
            let rate = if DENSITY { (rates.alpha * normal_density(distance[k], variance[k])).min(1.0) } else { follow };
            let rho = if matched { rate } else { 0.0 };
            let replaced = unmatched & (least == k as u32);
            for channel in 0..3 {
                let moved = mean[k][channel] + rho * (seen[channel] - mean[k][channel]);
                lanes[k][1 + channel][l] = if replaced { seen[channel] } else { moved };
            }
            // The distance from the mean as it is after the move.
            let left = (1.0 - rho) * (1.0 - rho) * distance[k];
            let spread = variance[k] + rho * (left - variance[k]);
            let spread = if spread > least_variance { spread } else { least_variance };
            lanes[k][4][l] = if replaced { initial_variance } else { spread };
            weight[k] = if replaced { settings.initial_weight } else { new_weight };
            total += weight[k];
        }
        for k in 0..K {
            lanes[k][0][l] = weight[k] / total;
        }
    }
    flags
}

/// The density of a spherical Gaussian in three dimensions at a squared distance from its mean.
fn normal_density(distance: f32, variance: f32) -> f32 {
    let norm = std::f32::consts::TAU * variance;
    exp_of_negative(-0.5 * distance / variance) / (norm * norm.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    /// Small deterministic noise, -7 to 7 a channel.
    fn noise(x: u32, y: u32, frame: u32, channel: u32) -> i32 {
        let mut h = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca6b) ^ frame.wrapping_mul(0xc2b2_ae35);
        h = (h ^ channel.wrapping_mul(0x27d4_eb2f)).wrapping_mul(0x2c1b_3c6d);
        h ^= h >> 15;
        h = h.wrapping_mul(0x297a_2d39);
        (h >> 16) as i32 % 8 - (h >> 20) as i32 % 8
    }

    const SIZE: (u32, u32) = (67, 21);

    /// A noisy room with a lamp that flickers between two colours, and from frame 60 on a block that moves.
    fn scene(frame: u32) -> (RgbImage, Vec<u8>) {
        let block = |x: u32, y: u32| frame >= 60 && (frame - 60..frame - 52).contains(&x) && (6..15).contains(&y);
        let picture = RgbImage::from_fn(SIZE.0, SIZE.1, |x, y| {
            let base = match (block(x, y), x >= 50) {
                (true, _) => [210, 60, 40],
                (false, true) if frame.is_multiple_of(3) => [60, 160, 60],
                (false, true) => [60, 60, 160],
                (false, false) => [90 + x as i32, 120, 80 + y as i32],
            };
            Rgb([0, 1, 2].map(|c: usize| (base[c] + noise(x, y, frame, c as u32)).clamp(0, 255) as u8))
        });
        let mask = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| u8::from(block(x, y)))).collect();
        (picture, mask)
    }

    fn errors(mixture: &mut Mixture, frame: u32) -> usize {
        let (picture, expected) = scene(frame);
        let mut found = vec![9; expected.len()];
        mixture.update(&picture, &ShadowSettings::default(), &mut found);
        found.iter().zip(&expected).filter(|(a, b)| a != b).count()
    }

    #[test]
    fn a_block_before_a_flickering_room_is_found_exactly() {
        for components in 3..=5 {
            let settings = MixtureSettings { components, background_weight: 0.8, ..Default::default() };
            let mut mixture = Mixture::new(settings, SIZE.0, SIZE.1);
            assert_eq!(errors(&mut mixture, 0), 0, "the first picture is background");
            (1..60).for_each(|frame| _ = errors(&mut mixture, frame));
            for frame in 60..100 {
                assert_eq!(errors(&mut mixture, frame), 0, "K {components}, frame {frame}");
            }
        }
    }

    #[test]
    fn the_published_rate_follows_the_formula() {
        // One pixel, one step by hand: alpha N(X | mu, sigma) with X = mu + (6, 0, 0).
        let settings = MixtureSettings {
            adaptation: Adaptation::Density,
            learning_rate: 0.5,
            warm_up: 0,
            initial_sigma: 3.0,
            min_sigma: 0.1,
            ..Default::default()
        };
        let mut mixture = Mixture::new(settings, 1, 1);
        let shadow = ShadowSettings::default();
        let mut flag = [7];
        mixture.update(&RgbImage::from_pixel(1, 1, Rgb([100; 3])), &shadow, &mut flag);
        mixture.update(&RgbImage::from_pixel(1, 1, Rgb([106, 100, 100])), &shadow, &mut flag);
        let rho = 0.5 * (-0.5_f64 * 36.0 / 9.0).exp() / ((2.0 * std::f64::consts::PI).powf(1.5) * 27.0);
        let value = |field: usize| f64::from(mixture.state[field * LANES]);
        assert_eq!(flag, [0]);
        assert!((value(1) - (100.0 + 6.0 * rho)).abs() < 1e-5, "{}", value(1));
        let left = 6.0 * (1.0 - rho);
        assert!((value(4) - ((1.0 - rho) * 9.0 + rho * left * left)).abs() < 1e-5, "{}", value(4));
    }

    #[test]
    fn weights_follow_the_formula() {
        let settings = MixtureSettings { learning_rate: 0.1, warm_up: 0, ..Default::default() };
        let mut mixture = Mixture::new(settings, 1, 1);
        let (shadow, mut flag) = (ShadowSettings::default(), [0]);
        let weights = |mixture: &Mixture| [0, 1, 2].map(|k: usize| mixture.state[k * FIELDS * LANES]);
        mixture.update(&RgbImage::from_pixel(1, 1, Rgb([100; 3])), &shadow, &mut flag);
        assert_eq!(weights(&mixture), [1.0, 0.0, 0.0]);
        // Far away: the first of the two without weight is replaced; weights are (0.9, 0.01, 0) made to sum to 1.
        mixture.update(&RgbImage::from_pixel(1, 1, Rgb([250; 3])), &shadow, &mut flag);
        assert_eq!(flag, [1]);
        assert!((weights(&mixture)[0] - 0.9 / 0.91).abs() < 1e-6);
        let before = weights(&mixture);
        mixture.update(&RgbImage::from_pixel(1, 1, Rgb([250; 3])), &shadow, &mut flag);
        assert!((weights(&mixture)[1] - (0.9 * before[1] + 0.1)).abs() < 1e-6);
        assert!((weights(&mixture)[0] - 0.9 * before[0]).abs() < 1e-6);
    }

    #[test]
    fn black_pictures_are_background_and_finite() {
        let mut mixture = Mixture::new(MixtureSettings::default(), 9, 2);
        let mut flags = [1; 18];
        for _ in 0..300 {
            mixture.update(&RgbImage::new(9, 2), &ShadowSettings::default(), &mut flags);
            assert_eq!(flags, [0; 18]);
        }
        assert!(mixture.state.iter().all(|value| value.is_finite()));
    }

    /// Precision and recall of the flags over frames 60 to 99 of the scene, with noise and light of `light(frame)`.
    fn precision_and_recall(settings: MixtureSettings, light: impl Fn(u32) -> f32) -> (f64, f64) {
        let mut mixture = Mixture::new(settings, SIZE.0, SIZE.1);
        let (mut hits, mut flagged, mut there) = (0_u32, 0_u32, 0_u32);
        for frame in 0..100 {
            let (mut picture, mask) = scene(frame);
            picture.iter_mut().for_each(|value| *value = (f32::from(*value) * light(frame)).min(255.0) as u8);
            let mut found = vec![0; mask.len()];
            mixture.update(&picture, &ShadowSettings::default(), &mut found);
            if frame >= 60 {
                hits += found.iter().zip(&mask).map(|(&found, &mask)| u32::from(found & mask)).sum::<u32>();
                flagged += found.iter().map(|&flag| u32::from(flag)).sum::<u32>();
                there += mask.iter().map(|&flag| u32::from(flag)).sum::<u32>();
            }
        }
        (f64::from(hits) / f64::from(flagged.max(1)), f64::from(hits) / f64::from(there))
    }

    #[test]
    fn light_that_falls_at_once_is_made_good_by_the_gain() {
        let settings = MixtureSettings { background_weight: 0.8, ..Default::default() };
        let steady = precision_and_recall(settings, |_| 1.0);
        assert_eq!(steady, (1.0, 1.0));
        // Half the light goes out as the block comes in: darker than what counts as shadow.
        let falls = |frame: u32| if frame < 62 { 1.0 } else { 0.52 };
        let without = precision_and_recall(settings, falls);
        let with = precision_and_recall(MixtureSettings { gain: true, ..settings }, falls);
        assert!(without.0 < 0.5, "{without:?}");
        assert!(with.0 > 0.95 && with.1 > 0.98, "{with:?}");
    }
}
