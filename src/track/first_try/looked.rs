//! Pictures of a first try to look at: what is taken for the person, and where the body lies on it.

use std::path::PathBuf;

use anyhow::Result;
use image::RgbImage;
use image::codecs::png::PngEncoder;

use super::super::fit::Fit;
use super::super::overlay::Overlay;
use crate::files::{OutputFolder, file_stem};
use crate::observe::{Observer, silhouette_settings};
use crate::report::{Canvas, side_by_side};
use crate::sequence::Sequence;

/// The silhouettes' outline.
const OUTLINE: [u8; 3] = [255, 0, 160];
/// White pixels between the pictures of the views.
const GAP: u32 = 6;
/// Pictures side by side.
const COLUMNS: usize = 2;

/// Writes the silhouettes of a frame over its pictures, and the bodies of people in their poses, where there are any: a picture a view, and all views in
/// one, which come first.
///
/// # Errors
/// When the frame cannot be read or a picture not be written.
pub(super) fn look(sequence: &Sequence, frame: usize, people: &[&Fit], output: &OutputFolder) -> Result<Vec<PathBuf>> {
    let mut observer = Observer::new(sequence, silhouette_settings(sequence)?, frame..frame + 1, frame)?;
    let Some(set) = observer.read()? else { return Ok(Vec::new()) };
    let Some(features) = observer.features(&set, true)? else { return Ok(Vec::new()) };
    let seen: Vec<RgbImage> = set
        .pictures
        .iter()
        .zip(&*features)
        .map(|(picture, features)| {
            let mut canvas = Canvas::new(picture, 1.0);
            let silhouette = &features.silhouette;
            let size = [silhouette.width(), silhouette.height()];
            canvas.silhouette(size, |x, y| silhouette.get(x, y), OUTLINE);
            canvas.into_picture()
        })
        .collect();
    let mut kinds = vec![("silhouettes", seen)];
    let mut bodies: Option<Vec<RgbImage>> = None;
    for fit in people {
        let Some(row) = fit.poses.frames.iter().position(|at| *at == frame) else { continue };
        let overlay = Overlay::new(&fit.body, None, &sequence.cameras)?;
        let pose: Vec<f32> = fit.poses.poses[row].iter().map(|value| *value as f32).collect();
        let views = bodies.as_ref().unwrap_or(&set.pictures).iter().enumerate();
        bodies = Some(views.map(|(view, picture)| overlay.draw(picture, view, &pose)).collect::<Result<_>>()?);
    }
    kinds.extend(bodies.map(|bodies| ("body", bodies)));
    let mut written = Vec::new();
    for (kind, pictures) in kinds {
        let single = pictures.iter().zip(&sequence.cameras);
        let single = single.map(|(picture, camera)| (format!("look/{kind}_{}.png", file_stem(&camera.name)), picture));
        let all = side_by_side(&pictures, COLUMNS, GAP)?;
        for (name, picture) in std::iter::once((format!("look/{kind}.png"), &all)).chain(single) {
            output.write(&name, |writer| Ok(picture.write_with_encoder(PngEncoder::new(writer))?))?;
            written.push(output.path().join(name));
        }
    }
    Ok(written)
}
