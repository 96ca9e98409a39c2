//! Which distance is measured, and the whole numbers that stand for it.

use crate::files::choices;

choices! {
    /// A distance between pixels, of |dx| and |dy|.
    #[derive(Default)]
    "metric" pub enum Metric {
        /// max(|dx|, |dy|).
        "chessboard" #[default] Chessboard,
        /// |dx| + |dy|.
        "city-block" CityBlock,
        /// √(dx² + dy²).
        "euclidean" Euclidean,
        /// (√2 - 1) min(|dx|, |dy|) + max(|dx|, |dy|): the shortest way by steps of 1 and diagonal steps of √2.
        "quasi-euclidean" QuasiEuclidean,
    }
}

impl Metric {
    /// What stands for one straight step of the quasi-Euclidean distance.
    pub(crate) const STRAIGHT: u32 = 408;
    /// What stands for one diagonal step. 577/408 is so near √2 that for ways of up to 255 pixels sums of these two numbers
    /// are ordered as the distances are and differ where those differ: two such distances a + b√2 are at least 1/478 apart,
    /// 0.85 in these units, and 255 diagonal steps are 0.22 off together.
    pub(crate) const DIAGONAL: u32 = 577;

    /// The number that stands for a straight distance: itself, its square for [`Self::Euclidean`], or its 408-fold for
    /// [`Self::QuasiEuclidean`].
    pub fn code(self, distance: u8) -> u32 {
        let distance = u32::from(distance);
        match self {
            Self::Chessboard | Self::CityBlock => distance,
            Self::Euclidean => distance * distance,
            Self::QuasiEuclidean => distance * Self::STRAIGHT,
        }
    }

    /// The distance a number stands for, pixels.
    pub fn distance(self, code: u32) -> f32 {
        match self {
            Self::Chessboard | Self::CityBlock => code as f32,
            Self::Euclidean => f64::from(code).sqrt() as f32,
            Self::QuasiEuclidean => {
                // 169 is the inverse of the diagonal step, modulo the straight one.
                let diagonal = code % Self::STRAIGHT * 169 % Self::STRAIGHT;
                let straight = code.saturating_sub(diagonal * Self::DIAGONAL) / Self::STRAIGHT;
                (f64::from(straight) + f64::from(diagonal) * std::f64::consts::SQRT_2) as f32
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_of_the_quasi_euclidean_distance_keep_its_order() {
        let mut all: Vec<(f64, u32)> = Vec::new();
        for straight in 0..=255_u32 {
            for diagonal in 0..=255_u32 {
                let distance = f64::from(straight) + f64::from(diagonal) * std::f64::consts::SQRT_2;
                if distance <= 255.0 {
                    let code = straight * Metric::STRAIGHT + diagonal * Metric::DIAGONAL;
                    assert_eq!(Metric::QuasiEuclidean.distance(code), distance as f32, "{straight} and {diagonal}");
                    all.push((distance, code));
                }
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(all.windows(2).all(|pair| pair[0].1 < pair[1].1));
        assert_eq!(Metric::QuasiEuclidean.code(255), all[all.len() - 1].1);
    }

    #[test]
    fn straight_distances_come_back() {
        for metric in Metric::ALL {
            assert!(
                (0..=255).all(|distance| metric.distance(metric.code(distance)) == f32::from(distance)),
                "{metric:?}"
            );
        }
    }
}
