//! How far the pixels lie from where the calibrated camera puts their points.

use glam::DVec2;

/// One pair after calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// The pair's name.
    pub name: String,
    /// Where the point was seen, pixels.
    pub pixel: DVec2,
    /// Seen minus projected, pixels; None where the point has no image.
    pub offset: Option<DVec2>,
    /// Whether the pair was left out as an outlier.
    pub is_outlier: bool,
}

impl Residual {
    /// The offset's length, pixels; infinite where the point has no image.
    pub fn length(&self) -> f64 {
        self.offset.map_or(f64::INFINITY, DVec2::length)
    }
}

/// Residuals in three numbers, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualSummary {
    /// How many.
    pub count: usize,
    /// Mean length.
    pub mean: f64,
    /// Root of the mean squared length.
    pub rms: f64,
    /// The longest.
    pub max: f64,
}

impl ResidualSummary {
    /// Of the pairs that were used.
    pub fn of(residuals: &[Residual]) -> Self {
        let lengths: Vec<f64> = residuals.iter().filter(|r| !r.is_outlier).map(Residual::length).collect();
        let count = lengths.len();
        let over = count.max(1) as f64;
        Self {
            count,
            mean: lengths.iter().sum::<f64>() / over,
            rms: (lengths.iter().map(|length| length * length).sum::<f64>() / over).sqrt(),
            max: lengths.iter().copied().fold(0.0, f64::max),
        }
    }
}

/// The standard deviation of one coordinate from the median length, which half of the pairs may not move: the lengths
/// of two normal coordinates have their median at 1.1774 standard deviations.
pub(super) fn robust_deviation(lengths: &[f64]) -> f64 {
    let mut sorted = lengths.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).map_or(0.0, |median| median / 1.177_4)
}
