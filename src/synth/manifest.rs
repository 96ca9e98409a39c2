//! sequence.toml as synthetic sequences write it.

use serde::Serialize;

use super::recording::source_of;
use super::scene::{PictureForm, Scene};
use crate::geometry::Camera;

/// Names of a sequence's manifest, and of the body and the start pose that it names.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FileNames<'a> {
    pub(crate) manifest: &'a str,
    pub(crate) body: &'a str,
    pub(crate) start: &'a str,
    /// Whether the manifest names the exact silhouettes, where there are any.
    pub(crate) masks: bool,
    /// Whether the body was measured in one posture.
    pub(crate) measure_again: bool,
}

impl Default for FileNames<'_> {
    fn default() -> Self {
        Self { manifest: "sequence.toml", body: "body.toml", start: "start.csv", masks: true, measure_again: false }
    }
}

/// What is written.
#[derive(Serialize)]
pub(super) struct Manifest<'a> {
    name: &'a str,
    fps: f64,
    cameras: &'a str,
    body: &'a str,
    start: &'a str,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    measure_again: bool,
    truth: &'a str,
    view: Vec<ManifestView<'a>>,
    features: Option<&'a toml::Table>,
}

#[derive(Serialize)]
struct ManifestView<'a> {
    camera: &'a str,
    source: String,
    background: String,
    mask: Option<String>,
}

impl<'a> Manifest<'a> {
    /// Of a scene that was filmed by these cameras.
    pub(super) fn new(scene: &'a Scene, cameras: &'a [Camera], names: &FileNames<'a>) -> Self {
        let masks = names.masks && scene.output.masks;
        Self {
            name: &scene.name,
            fps: scene.fps,
            cameras: "cameras.toml",
            body: names.body,
            start: names.start,
            measure_again: names.measure_again,
            truth: "truth.trc",
            view: cameras.iter().map(|camera| ManifestView::of(camera, scene.output.pictures, masks)).collect(),
            features: scene.features.as_ref(),
        }
    }
}

impl<'a> ManifestView<'a> {
    fn of(camera: &'a Camera, pictures: PictureForm, masks: bool) -> Self {
        let name = &camera.name;
        Self {
            camera: name,
            source: source_of(camera, pictures),
            background: format!("plates/{name}.png"),
            mask: masks.then(|| format!("masks/{name}_%04d.png")),
        }
    }
}
