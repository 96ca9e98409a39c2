//! The parameters of all feature stages: the optional `[features]` table of a sequence.

use std::fmt::Display;
use std::ops::RangeInclusive;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

use super::distance::Metric;
use super::edges::{EdgeSettings, Operator};
use super::mixture::MixtureSettings;
use super::morphology::{Element, Shape};
use super::plate::PlateSettings;
use super::proximity::{Normalisation, ProximitySettings};
use super::segment::SegmentSettings;
use super::shadow::ShadowSettings;
use crate::files::{choices, parse_table};

choices! {
    /// How a pixel is told from the background.
    #[derive(Default)]
    "foreground" pub enum ForegroundKind {
        /// By its distance from the plate, or by what the mixture explains, each beyond a threshold (the default).
        "difference" #[default] Difference,
        /// By how likely its colour is as background, lit or in shadow, with the picture's own noise.
        "likelihood" Likelihood,
    }
}

/// How raw foreground becomes a silhouette.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SilhouetteSettings {
    /// The shape of the elements of `open` and `close`.
    pub element: Shape,
    /// Size of the opening that removes specks, pixels, odd; 1 for none.
    pub open: u32,
    /// Size of the closing that joins what belongs together, pixels, odd; 1 for none.
    pub close: u32,
    /// At most this many of the largest blobs are kept.
    pub blobs: usize,
    /// A smaller blob is dropped, pixels.
    pub min_area: u32,
    /// A blob smaller than this fraction of the largest is dropped too: a reflection, a bystander's hand.
    pub min_share: f32,
    /// A hole of at most this size is filled, pixels.
    pub max_hole: u32,
    /// A view that is foreground over more than this share of its picture shows nobody: its camera is off or covered, or the
    /// light has changed all over. Not asked of ready masks.
    pub max_cover: f32,
    /// By how much the region of interest is larger than the silhouette, pixels: the motion expected in one frame.
    pub motion: u32,
}

impl Default for SilhouetteSettings {
    fn default() -> Self {
        Self {
            element: Shape::Disc,
            open: 3,
            close: 5,
            blobs: 4,
            min_area: 60,
            min_share: 0.03,
            max_hole: 30,
            max_cover: 0.75,
            motion: 16,
        }
    }
}

/// How distances from edges are measured.
#[derive(Clone, Copy, Debug, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DistanceSettings {
    /// Which distance.
    pub metric: Metric,
}

/// All parameters of the features. Every length is in pixels of the working pictures.
#[derive(Clone, Debug, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FeatureSettings {
    /// How a view without ready masks is told from its background.
    pub foreground: ForegroundKind,
    /// The background model of a view that has neither mask nor plate.
    pub mixture: MixtureSettings,
    /// The difference from a plate.
    pub plate: PlateSettings,
    /// What is a shadow, for both.
    pub shadow: ShadowSettings,
    /// From foreground to silhouette.
    pub silhouette: SilhouetteSettings,
    /// The edge detector.
    pub edges: EdgeSettings,
    /// The distance map.
    pub distance: DistanceSettings,
    /// From distance to proximity.
    pub proximity: ProximitySettings,
    /// The body parts that are told apart; none by default.
    pub segment: Vec<SegmentSettings>,
    /// Whether the likelihoods of soft evidence are wanted: no key, but what whoever compares by evidence asks for.
    #[serde(skip)]
    pub likelihoods: bool,
}

impl FeatureSettings {
    /// Reads a `[features]` table; `name` stands for the file in messages.
    ///
    /// # Errors
    /// An unknown key (the nearest known one is named), a value of the wrong type, or one that [`Self::check`] refuses.
    pub fn from_table(table: &toml::Table, name: &str) -> Result<Self> {
        let place = format!("{name}, table [features]");
        let settings: Self = parse_table(table, &place)?;
        settings.check().context(place)?;
        Ok(settings)
    }

    /// The settings without segments, for what asks for silhouettes and edges alone.
    #[must_use]
    pub fn without_segments(self) -> Self {
        Self { segment: Vec::new(), ..self }
    }

    /// Whether likelihoods are made, to be given out or to find the foreground.
    pub(crate) fn needs_likelihoods(&self) -> bool {
        self.likelihoods || self.foreground == ForegroundKind::Likelihood
    }

    /// Why observations cannot stay on a device that makes them; none where they can.
    pub fn kept_from_device(&self) -> Option<&'static str> {
        (!self.segment.is_empty()).then_some("body parts are told apart")
    }

    /// Turns the parts that segments name into their labels; `parts` are the body's, each with its label.
    ///
    /// # Errors
    /// When a segment names a part that is not there; the nearest one is named.
    pub fn take_labels(&mut self, parts: &[(&str, u8)]) -> Result<()> {
        self.segment.iter_mut().try_for_each(|segment| segment.take_labels(parts))
    }

    /// Checks that every value makes sense.
    ///
    /// # Errors
    /// One sentence with the key, the value, and what was expected.
    pub fn check(&self) -> Result<()> {
        let m = &self.mixture;
        within("mixture.components", m.components, 3..=5)?;
        within("mixture.learning_rate", m.learning_rate, 0.0..=1.0)?;
        within("mixture.match_sigma", m.match_sigma, 0.1..=100.0)?;
        within("mixture.background_weight", m.background_weight, 0.01..=1.0)?;
        within("mixture.initial_sigma", m.initial_sigma, 0.1..=441.0)?;
        within("mixture.min_sigma", m.min_sigma, 0.1..=441.0)?;
        within("mixture.initial_weight", m.initial_weight, 0.0001..=1.0)?;
        ordered("mixture.min_sigma", m.min_sigma, "mixture.initial_sigma", m.initial_sigma)?;
        within("plate.weak", self.plate.weak, 0.0..=442.0)?;
        within("plate.strong", self.plate.strong, 0.0..=442.0)?;
        within("plate.faint", self.plate.faint, 0.0..=442.0)?;
        odd("plate.bridge", self.plate.bridge)?;
        ordered("plate.weak", self.plate.weak, "plate.strong", self.plate.strong)?;
        within("shadow.darkest", self.shadow.darkest, 0.0..=1.0)?;
        within("shadow.brightest", self.shadow.brightest, 1.0..=100.0)?;
        within("shadow.chroma", self.shadow.chroma, 0.0..=442.0)?;
        odd("silhouette.open", self.silhouette.open)?;
        odd("silhouette.close", self.silhouette.close)?;
        within("silhouette.min_share", self.silhouette.min_share, 0.0..=1.0)?;
        within("silhouette.max_cover", self.silhouette.max_cover, 0.0..=1.0)?;
        within("silhouette.blobs", self.silhouette.blobs, 1..=4)?;
        within("edges.threshold", self.edges.threshold, 1..=4080)?;
        within("edges.low", self.edges.low, 1..=4080)?;
        if self.edges.operator == Operator::Canny {
            ordered("edges.low", self.edges.low, "edges.threshold", self.edges.threshold)?;
        }
        odd("edges.dilate", self.edges.dilate)?;
        let p = &self.proximity;
        within("proximity.n_range", p.n_range, 0.001..=1.0)?;
        within("proximity.decay", p.decay, 0.0..=100.0)?;
        if p.normalisation != Normalisation::Impulse && p.d_min >= p.d_max {
            bail!(
                "[features] proximity.d_min is {} and proximity.d_max {}, expected d_min smaller than d_max",
                p.d_min,
                p.d_max
            );
        }
        self.segment.iter().try_for_each(SegmentSettings::check)
    }

    pub(super) fn opening(&self) -> Element {
        Element { shape: self.silhouette.element, radius: self.silhouette.open / 2 }
    }

    pub(super) fn bridge(&self) -> Element {
        Element { shape: Shape::Disc, radius: self.plate.bridge / 2 }
    }

    pub(super) fn closing(&self) -> Element {
        Element { shape: self.silhouette.element, radius: self.silhouette.close / 2 }
    }

    pub(super) fn dilation(&self) -> Element {
        Element { shape: Shape::Disc, radius: self.edges.dilate / 2 }
    }
}

/// Larger elements are no cleaning any more, and their time grows with the size.
const LARGEST_ELEMENT: u32 = 255;

fn odd(key: &str, size: u32) -> Result<()> {
    if size.is_multiple_of(2) || size > LARGEST_ELEMENT {
        bail!("[features] {key} is {size}, expected an odd number of pixels from 1 to {LARGEST_ELEMENT}");
    }
    Ok(())
}

fn within<T: PartialOrd + Display>(key: &str, value: T, range: RangeInclusive<T>) -> Result<()> {
    // NaN is in no range.
    if !range.contains(&value) {
        bail!("[features] {key} is {value}, expected a value from {} to {}", range.start(), range.end());
    }
    Ok(())
}

fn ordered<T: PartialOrd + Display>(small_key: &str, small: T, large_key: &str, large: T) -> Result<()> {
    if small > large {
        bail!("[features] {small_key} is {small} and {large_key} {large}, expected the first to be no larger");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::Magnitude;
    use super::*;

    fn read(text: &str) -> Result<FeatureSettings> {
        FeatureSettings::from_table(&text.parse().unwrap(), "sequence.toml")
    }

    #[test]
    fn an_empty_table_is_the_defaults_and_they_pass() {
        assert_eq!(read("").unwrap(), FeatureSettings::default());
        let settings = read(
            "edges = { magnitude = \"sum\", threshold = 50 }\n[proximity]\nnormalisation = \"exponential\"\nd_max = 100",
        )
        .unwrap();
        assert_eq!((settings.edges.magnitude, settings.edges.threshold), (Magnitude::Sum, 50));
        assert_eq!(settings.proximity.d_max, 100);
    }

    #[test]
    fn wrong_settings_are_clear_sentences() {
        for (text, parts) in [
            ("egdes = {}", &["sequence.toml", "`egdes`", "`edges`"][..]),
            ("[plate]\nweek = 3.0", &["`week`", "`weak`"]),
            ("[edges]\nthreshold = \"high\"", &["sequence.toml", "high"]),
            ("[edges]\nmagnitude = \"cubic\"", &["cubic", "exact"]),
            ("[mixture]\ncomponents = 2", &["mixture.components is 2", "3 to 5"]),
            ("[mixture]\ncomponents = 6", &["mixture.components is 6", "3 to 5"]),
            ("[mixture]\nlearning_rate = nan", &["mixture.learning_rate is NaN"]),
            ("[mixture]\nmatch_sigma = inf", &["mixture.match_sigma is inf"]),
            ("[mixture]\nmin_sigma = 50.0", &["mixture.min_sigma is 50", "initial_sigma 20"]),
            ("[plate]\nweak = 90.0\nstrong = 30.0", &["plate.weak is 90", "plate.strong 30"]),
            ("[silhouette]\nopen = 4", &["silhouette.open is 4", "odd"]),
            ("[silhouette]\nclose = 0", &["silhouette.close is 0", "odd"]),
            ("[silhouette]\nblobs = 9", &["silhouette.blobs is 9", "1 to 4"]),
            ("[edges]\ndilate = 1001", &["edges.dilate is 1001", "255"]),
            ("[edges]\nthreshold = 0", &["edges.threshold is 0"]),
            ("[proximity]\nd_min = 20\nd_max = 10", &["d_min is 20", "d_max 10", "smaller"]),
            ("[proximity]\nn_range = 2.0", &["proximity.n_range is 2"]),
            ("[proximity]\nd_max = 300", &["300"]),
            ("[shadow]\ndarkest = -0.5", &["shadow.darkest is -0.5"]),
            ("[edges]\noperator = \"soble\"", &["soble", "sobel", "laplace-product"]),
            ("[edges]\noperator = \"canny\"\nlow = 90", &["edges.low is 90", "edges.threshold 70"]),
            ("[distance]\nmetric = \"manhattan\"", &["manhattan", "city-block"]),
            ("[distance]\nmetrik = 1", &["`metrik`", "`metric`"]),
            ("[[segment]]\nname = \"a\"\nweight = 1\ncue = \"skin\"\ncolors = []", &["`colors`", "`colours`"]),
            ("[[segment]]\nname = \"a\"\nweight = 1", &["`cue`"]),
        ] {
            let error = format!("{:#}", read(text).unwrap_err());
            for part in parts {
                assert!(error.contains(part), "{text:?} gave {error:?}, without {part:?}");
            }
        }
    }
}
