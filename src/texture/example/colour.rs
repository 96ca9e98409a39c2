//! Colours as errors measure them.

/// Weights of red, green and blue in an error.
pub const COLOUR_WEIGHTS: [f32; 3] = [0.299, 0.587, 0.114];

/// A colour as errors measure it: channels in [0, 1] times the roots of their weights.
pub type Weighted = [f32; 3];

/// The weighted colour of a pixel.
pub fn weighted(pixel: [f32; 3]) -> Weighted {
    std::array::from_fn(|c| pixel[c] / 255.0 * COLOUR_WEIGHTS[c].sqrt())
}

/// Squared difference of two colours, [0, 1].
pub fn squared_error(a: Weighted, b: Weighted) -> f32 {
    (0..3).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum()
}

/// A known pixel of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Column in the region.
    pub x: usize,
    /// Row in the region.
    pub y: usize,
    /// Its colour.
    pub colour: Weighted,
    /// What its squared error counts: 1, or less far from the middle of a neighbourhood.
    pub weight: f32,
}
