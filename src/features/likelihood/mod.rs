//! How likely each pixel's colour is as background, and which colour it is: what soft evidence is made from (METHOD A12).
//!
//! Nothing here looks at other frames, so a frame's likelihoods are the same wherever a run began. What is learnt about the person's
//! colours comes in later, where it is known which part of the body shows where.

mod background;
mod colour;
mod foreground;
mod picture_light;
mod smooth;

pub(super) use background::BackgroundColours;
pub use colour::ColourBin;
pub(super) use foreground::{LikelySilhouette, Lit};
pub(super) use picture_light::{LightTables, SHADOWS, WidthTables, Widths};

pub(crate) use smooth::smooth_rows;

use super::Region;
use super::shaders::{LIKELIHOOD_MASKED, LIKELIHOOD_MOST, LIKELIHOOD_STEPS, LIKELIHOOD_SURE};

/// Steps of a logarithm in [`Likelihood`], a unit.
pub const LOG_STEPS: f32 = LIKELIHOOD_STEPS as f32;
/// The largest log-likelihood ratio that is believed, in steps.
pub(crate) const MOST_RATIO: i32 = LIKELIHOOD_MOST as i32;

/// What one picture says of each of its pixels. Densities are relative to the uniform one of all colours, natural logarithms in steps
/// of 1/[`LOG_STEPS`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Likelihood {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// The log density of the pixel's colour as background, row-major. In a view with a ready mask -[`Self::MASKED`] inside of the
    /// mask, and more than any colour can outweigh outside.
    pub background: Vec<i16>,
    /// The colour of each pixel.
    pub colours: Vec<ColourBin>,
    /// Whether a ready mask decides what is foreground: then colours only tell parts of the person apart.
    pub is_masked: bool,
    /// Whether the camera sees in grey: densities are then those of luma, relative to the uniform one of all greys.
    pub is_grey: bool,
    /// Where the person may be: the bounding box of what does not look like background, enlarged for motion; empty where nothing does.
    pub region: Region,
}

impl Likelihood {
    /// How surely a pixel inside of a ready mask is the person's, in steps.
    pub const MASKED: i16 = LIKELIHOOD_MASKED as i16;
    /// The log density of what is surely background, in steps.
    pub const SURE: i16 = LIKELIHOOD_SURE as i16;
}
