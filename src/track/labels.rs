//! Which part of the tracked body shows at each pixel of the videos (`track --labels`): masks that segment every frame.

use std::path::Path;

use anyhow::Result;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use rayon::prelude::*;

use super::held::Held;
use super::overlay;
use super::progress::Progress;
use crate::body::{Body, Mesh};
use crate::evaluate::{CandidateImage, Reference};
use crate::files::{OutputFolder, file_stem};
use crate::geometry::Camera;
use crate::sequence::Sequence;

/// Their folder in a track's folder.
pub(super) const FOLDER: &str = "labels";
/// Which label is which part, in that folder.
pub(super) const LEGEND: &str = "labels.csv";
/// Frames that are drawn at once.
const TOGETHER: usize = 8;
/// What says which part a pixel of a drawn candidate shows; the other bit says that it is an edge.
const LABEL: u8 = 0x7f;
/// What the drawing is called.
const WORK: &str = "drawing the labels";

/// Draws the labels of every frame that is no gap into every view, in the pictures' own size, whatever size was worked at: by the reference,
/// whose integers all backends have. Gives a sentence where it was stopped before the last.
pub(super) fn write(
    output: &OutputFolder,
    sequence: &Sequence,
    body: &Body,
    mesh: Option<&Mesh>,
    held: &Held,
    progress: &mut dyn Progress,
) -> Result<Option<String>> {
    let views = sequence.cameras.iter().zip(&sequence.views);
    let cameras: Vec<Camera> = views.map(|(camera, view)| camera.scaled(view.size)).collect();
    let reference = match mesh {
        None => Reference::new(body, &cameras),
        Some(mesh) => Reference::of_mesh(body, mesh.clone(), &cameras)?,
    };
    output.write(&format!("{FOLDER}/{LEGEND}"), |writer| {
        let mut rows = csv::Writer::from_writer(writer);
        rows.write_record(["label", "part", "bone"])?;
        for part in &body.parts {
            rows.write_record([&part.label.to_string(), &part.name, &body.bones[part.bone].name])?;
        }
        Ok(rows.flush()?)
    })?;
    let rows = held.sure();
    for (done, rows) in rows.chunks(TOGETHER).enumerate() {
        let drawn = done * TOGETHER;
        if progress.should_stop() {
            let first = held.table.frames[rows[0]];
            return Ok(Some(format!(
                "{FOLDER}/ ends before frame {first}: the same command with --resume draws the rest"
            )));
        }
        progress.preparing(WORK, drawn, held.table.frames.len());
        let each: Vec<(usize, usize)> =
            rows.iter().flat_map(|&row| (0..cameras.len()).map(move |view| (row, view))).collect();
        each.into_par_iter().try_for_each(|(row, view)| {
            let pose: Vec<f32> = held.table.poses[row].iter().map(|value| *value as f32).collect();
            let CandidateImage { width, height, mut bytes } = reference.draw(&pose, view);
            bytes.iter_mut().for_each(|byte| *byte &= LABEL);
            output.write(&file_name(&cameras[view].name, held.table.frames[row]), |writer| {
                Ok(PngEncoder::new(writer).write_image(&bytes, width, height, ExtendedColorType::L8)?)
            })
        })?;
    }
    Ok(None)
}

/// `labels/<camera>_%06d.png`.
fn file_name(camera: &str, frame: usize) -> String {
    format!("{FOLDER}/{}_{frame:06}.png", file_stem(camera))
}

/// Whether a file of that folder is one that a run writes.
pub(super) fn is_one(path: &Path) -> bool {
    overlay::is_one(path) || path.file_name().is_some_and(|name| name == LEGEND)
}
