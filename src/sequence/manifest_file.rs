//! The manifest as it is written, and what can be said of it without the files it names.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

use super::footage::Footage;
use super::live_options;
use super::orientation::{Orientation, number_or_name};
use super::person::{PersonTable, check_names};
use super::synchrony::{MOST_DELAY, Stamps};
use crate::files::parse_toml;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ManifestFile {
    pub(super) name: String,
    pub(super) fps: f64,
    pub(super) cameras: PathBuf,
    pub(super) body: Option<PathBuf>,
    pub(super) height: Option<f64>,
    pub(super) measure_again: Option<bool>,
    pub(super) start: Option<PathBuf>,
    pub(super) truth: Option<PathBuf>,
    #[serde(default = "full_size")]
    pub(super) scale: f64,
    pub(super) timestamps: Option<Stamps>,
    #[serde(default)]
    pub(super) view: Vec<ViewTable>,
    #[serde(default)]
    pub(super) person: Vec<PersonTable>,
    pub(super) objective: Option<toml::Table>,
    pub(super) features: Option<toml::Table>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ViewTable {
    pub(super) camera: String,
    pub(super) source: PathBuf,
    pub(super) input: Option<Vec<String>>,
    pub(super) background: Option<PathBuf>,
    pub(super) background_doubtful: Option<f64>,
    pub(super) mask: Option<PathBuf>,
    pub(super) ignore: Option<PathBuf>,
    pub(super) delay: Option<f64>,
    #[serde(default, deserialize_with = "number_or_name")]
    pub(super) orientation: Option<Orientation>,
}

impl ViewTable {
    /// Pictures that it names, turned as it says or as they fit a size.
    pub(super) fn oriented(&self, footage: Footage, size: Option<[u32; 2]>) -> Footage {
        Orientation::orient(self.orientation, footage, size)
    }
}

/// The smallest working scale.
const SMALLEST_SCALE: f64 = 0.01;

fn full_size() -> f64 {
    1.0
}

impl ManifestFile {
    /// What can be said of a manifest without looking at the files it names.
    pub(super) fn check(&self, name: &str) -> Result<()> {
        check_fps(self.fps).with_context(|| name.to_string())?;
        check_scale(self.scale).with_context(|| name.to_string())?;
        let own = [
            ("body", self.body.is_some()),
            ("start", self.start.is_some()),
            ("truth", self.truth.is_some()),
            ("height", self.height.is_some()),
        ];
        let own = own.into_iter().find(|(_, is_there)| *is_there);
        if let (Some((key, _)), false) = (own, self.person.is_empty()) {
            bail!("{name} has `{key}` and [[person]], expected a `body` and `start` in each [[person]] alone");
        }
        check_names(&self.person, name)?;
        if self.body.is_none() && self.height.is_none() && self.person.is_empty() {
            bail!(
                "{name} has neither `body` nor `height`, expected the file of the person's body or how tall the person is, mm"
            );
        }
        if let Some(height) = self.height.filter(|height| !(500.0..=2500.0).contains(height)) {
            bail!("{name}: height is {height}, expected 500 to 2500 mm");
        }
        if self.view.is_empty() {
            bail!("{name} has no views, expected a [[view]] with `camera` and `source` for each camera");
        }
        for view in &self.view {
            let options = view.input.as_deref().unwrap_or_default();
            let checked = live_options::check(&view.source.to_string_lossy(), options);
            checked.with_context(|| format!("{name}: the source of camera {:?}", view.camera))?;
            if let Some(delay) = view.delay.filter(|delay| delay.is_nan() || delay.abs() > MOST_DELAY) {
                bail!(
                    "{name}: the delay of camera {:?} is {}, expected at most {MOST_DELAY} frames, whole or not",
                    view.camera,
                    shown_number(delay)
                );
            }
        }
        Ok(())
    }
}

/// Checks a manifest's text alone, without the files it names; `name` stands for the file in messages.
///
/// # Errors
/// As [`Sequence::open`], as far as the text goes.
pub fn check_manifest(text: &str, name: &str) -> Result<()> {
    parse_toml::<ManifestFile>(text, name)?.check(name)
}

/// Holds a frame rate to what cameras record: steps in time, and how far a person gets in one, follow from it.
///
/// # Errors
/// With the value and the range.
pub(crate) fn check_fps(fps: f64) -> Result<()> {
    let [lowest, highest] = [0.01, 1e5];
    if !(lowest..=highest).contains(&fps) {
        bail!("fps is {}, expected {lowest} to {highest} frames per second", shown_number(fps));
    }
    Ok(())
}

/// Holds the working scale to where a picture is left of a picture.
///
/// # Errors
/// With the value and the range.
pub(crate) fn check_scale(scale: f64) -> Result<()> {
    if !(SMALLEST_SCALE..=1.0).contains(&scale) {
        bail!("scale is {}, expected {SMALLEST_SCALE} to 1", shown_number(scale));
    }
    Ok(())
}

/// Without the hundreds of digits of the largest and the smallest.
fn shown_number(value: f64) -> String {
    if value != 0.0 && value.is_finite() && !(1e-6..1e9).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}
