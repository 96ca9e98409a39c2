//! Distance to proximity: 1 on an edge, 0 far away, in 127ths (METHOD A5.4).

use serde::Deserialize;

use super::distance::Metric;
use crate::files::choices;

choices! {
    /// How a distance d (pixels) becomes a proximity.
    "normalisation" pub enum Normalisation {
        /// 1 where d = 0, else 0.
        "impulse" Impulse,
        /// 1 up to `d_min`, then `1 - n_range (d - d_min) / (d_max - d_min)`, 0 from `d_max` on.
        "proportional" Proportional,
        /// 1 up to `d_min`, then `n_range exp(-decay d) + 1 - n_range`, 0 from `d_max` on.
        "exponential" Exponential,
    }
}

/// The parameters of the normalisation.
///
/// The thesis's example (`d_min = 10, d_max = 100, n_range = 0.25`) gives 1 within ten pixels of an edge and three
/// quarters just short of a hundred. At a working height of some 300 to 500 pixels a limb is 8 to 20 pixels wide, and such
/// a proximity is nearly the same all over a person; the defaults here fall to nothing within a limb's width.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ProximitySettings {
    /// The function.
    pub normalisation: Normalisation,
    /// Up to this distance the proximity is 1, pixels.
    pub d_min: u8,
    /// From this distance on the proximity is 0, pixels.
    pub d_max: u8,
    /// By how much the proximity has fallen just before `d_max`, in (0, 1].
    pub n_range: f32,
    /// The `decay` of the exponential function, per pixel.
    pub decay: f32,
}

impl Default for ProximitySettings {
    fn default() -> Self {
        Self { normalisation: Normalisation::Proportional, d_min: 1, d_max: 16, n_range: 1.0, decay: 0.1 }
    }
}

impl ProximitySettings {
    /// The distance from which on every pixel is alike.
    pub fn limit(&self) -> u8 {
        match self.normalisation {
            Normalisation::Impulse => 1,
            Normalisation::Proportional | Normalisation::Exponential => self.d_max,
        }
    }

    /// The packed proximity, 0..=127, of every code of a map by `metric`, up to the code of the limit.
    pub fn table(&self, metric: Metric) -> Vec<u8> {
        let last = metric.code(self.limit());
        (0..=last).map(|code| (self.proximity(metric.distance(code)) * 127.0).round().clamp(0.0, 127.0) as u8).collect()
    }

    /// The proximity at a distance, pixels.
    fn proximity(&self, d: f32) -> f32 {
        let (d_min, d_max) = (f32::from(self.d_min), f32::from(self.d_max));
        match self.normalisation {
            Normalisation::Impulse => f32::from(d == 0.0),
            _ if d >= d_max => 0.0,
            _ if d <= d_min => 1.0,
            Normalisation::Proportional => 1.0 - self.n_range * (d - d_min) / (d_max - d_min),
            Normalisation::Exponential => self.n_range * (-self.decay * d).exp() + 1.0 - self.n_range,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_thesis_example() {
        let mut settings = ProximitySettings { d_min: 10, d_max: 100, n_range: 0.25, ..Default::default() };
        let table = settings.table(Metric::Chessboard);
        assert_eq!((table[0], table[10], table[100], table.len()), (127, 127, 0, 101));
        // 1 - 0.25 * 45 / 90 = 0.875, times 127 is 111.1; 1 - 0.25 * 89 / 90 = 0.7528, times 127 is 95.6.
        assert_eq!((table[55], table[99]), (111, 96));
        settings.normalisation = Normalisation::Exponential;
        // 0.25 exp(-0.1 * 20) + 0.75 = 0.78383, times 127 is 99.5.
        let table = settings.table(Metric::Chessboard);
        assert_eq!((table[10], table[20], table[100]), (127, 100, 0));
        settings.normalisation = Normalisation::Impulse;
        assert_eq!(settings.table(Metric::Euclidean), [127, 0]);
        assert_eq!(settings.limit(), 1);
    }

    proptest! {
        #[test]
        fn never_rises_and_ends_at_the_limit(
            kind in 0..3, metric in 0..4, d_min in 0_u8..100, span in 1_u8..100, n_range in 0.01_f32..1.0, decay in 0.0_f32..2.0,
        ) {
            let normalisation =
                [Normalisation::Impulse, Normalisation::Proportional, Normalisation::Exponential][kind as usize];
            let settings = ProximitySettings { normalisation, d_min, d_max: d_min + span, n_range, decay };
            let metric =
                [Metric::Chessboard, Metric::CityBlock, Metric::Euclidean, Metric::QuasiEuclidean][metric as usize];
            let table = settings.table(metric);
            prop_assert_eq!((table[0], table.last()), (127, Some(&0)));
            let straight = (0..=settings.limit()).map(|distance| table[metric.code(distance) as usize]);
            prop_assert!(straight.is_sorted_by(|a, b| a >= b));
            let euclidean = settings.table(Metric::Euclidean);
            prop_assert!(euclidean.is_sorted_by(|a, b| a >= b));
        }
    }
}
