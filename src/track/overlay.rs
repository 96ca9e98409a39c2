//! The estimated model drawn over what the cameras saw.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Result;
use glam::DVec2;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, RgbImage};

use crate::body::{Body, Mesh};
use crate::evaluate::{CandidateImage, PartQuad, Projector, Reference};
use crate::files::{OutputFolder, file_stem};
use crate::geometry::Camera;
use crate::report::{Canvas, OverlayPolygon, part_colour};

/// The folder of a track's overlays.
pub(super) const FOLDER: &str = "overlay";
const OPACITY: f64 = 0.35;
const EDGE_OPACITY: f64 = 0.9;

/// Draws poses of a body over the pictures of its cameras.
pub(super) struct Overlay<'a> {
    body: &'a Body,
    cameras: &'a [Camera],
    drawing: Drawing,
}

/// What of the body is laid over the pictures.
enum Drawing {
    Flat(Projector),
    Mesh(Reference),
}

impl<'a> Overlay<'a> {
    /// With the flat model, or with a mesh that is bound to the body.
    pub(super) fn new(body: &'a Body, mesh: Option<&Mesh>, cameras: &'a [Camera]) -> Result<Self> {
        let drawing = match mesh {
            None => Drawing::Flat(Projector::new(body, cameras)),
            Some(mesh) => Drawing::Mesh(Reference::of_mesh(body, mesh.clone(), cameras)?),
        };
        Ok(Self { body, cameras, drawing })
    }

    /// The picture of a view with the parts, nearer over farther, and the skeleton on it.
    pub(super) fn draw(&self, picture: &RgbImage, view: usize, pose: &[f32]) -> Result<RgbImage> {
        let mut canvas = match &self.drawing {
            Drawing::Flat(projector) => self.flat(picture, &projector.quads(pose, view)),
            Drawing::Mesh(reference) => Canvas::new(&self.tinted(picture, &reference.draw(pose, view)), 1.0),
        };
        let values: Vec<f64> = pose.iter().map(|value| f64::from(*value)).collect();
        canvas.skeleton(&self.bones(view, &values)?);
        Ok(canvas.into_picture())
    }

    fn flat(&self, picture: &RgbImage, quads: &[PartQuad]) -> Canvas {
        let mut canvas = Canvas::new(picture, 1.0);
        let mut farthest_first: Vec<usize> = (0..quads.len()).filter(|&part| quads[part].drawn).collect();
        farthest_first.sort_by(|&l, &r| quads[r].depth_squared.total_cmp(&quads[l].depth_squared));
        for index in farthest_first {
            let part = &self.body.parts[index];
            let corners = quads[index].corners.map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)) / 256.0);
            canvas.polygon(&OverlayPolygon { corners, colour: part_colour(&part.name, part.label) }, OPACITY);
        }
        canvas
    }

    /// The picture with the colour of its part on every pixel that a candidate covers, edges strongest.
    fn tinted(&self, picture: &RgbImage, drawn: &CandidateImage) -> RgbImage {
        let mut tinted = picture.clone();
        let names = self.body.parts.iter().map(|part| (part.label, part_colour(&part.name, part.label)));
        let colours: BTreeMap<u8, [u8; 3]> = names.collect();
        for (pixel, byte) in tinted.pixels_mut().zip(&drawn.bytes) {
            let Some(colour) = colours.get(&(byte & 0x7f)) else { continue };
            let opacity = if byte & 0x80 != 0 { EDGE_OPACITY } else { OPACITY };
            for (channel, colour) in pixel.0.iter_mut().zip(colour) {
                let mixed = f64::from(*channel) * (1.0 - opacity) + f64::from(*colour) * opacity;
                *channel = mixed.round() as u8;
            }
        }
        tinted
    }

    /// Lines from every joint to its parent, in pixels.
    fn bones(&self, view: usize, pose: &[f64]) -> Result<Vec<[DVec2; 2]>> {
        let joints = self.body.joint_positions(&self.body.world_from_bones(pose)?);
        let camera = &self.cameras[view];
        let lines = joint_lines(self.body).into_iter();
        Ok(lines.filter_map(|[a, b]| Some([camera.project(joints[a])?, camera.project(joints[b])?])).collect())
    }

    /// Writes the overlays of a frame, one a view.
    pub(super) fn write(&self, output: &OutputFolder, frame: usize, pictures: &[RgbImage], pose: &[f32]) -> Result<()> {
        for (view, picture) in pictures.iter().enumerate() {
            let drawn = self.draw(picture, view, pose)?;
            output.write(&file_name(&self.cameras[view].name, frame), |writer| {
                let (width, height) = drawn.dimensions();
                Ok(PngEncoder::new(writer).write_image(&drawn, width, height, ExtendedColorType::Rgb8)?)
            })?;
        }
        Ok(())
    }
}

/// `overlay/<camera>_%06d.png`. A camera may carry any name, a file may not.
pub(super) fn file_name(camera: &str, frame: usize) -> String {
    format!("{FOLDER}/{}_{frame:06}.png", file_stem(camera))
}

/// Whether a file has a name that a run gives to an overlay.
pub(super) fn is_one(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let number = name.strip_suffix(".png").and_then(|stem| stem.rsplit_once('_')).map(|(_, number)| number);
    number.is_some_and(|number| number.len() >= 6 && number.bytes().all(|byte| byte.is_ascii_digit()))
}

/// Pairs of joints (indices of [`Body::joint_names`]) that a line is drawn between: a bone and its parent, a free end and
/// its bone.
pub(super) fn joint_lines(body: &Body) -> Vec<[usize; 2]> {
    let bones = body.bones.iter().enumerate().filter_map(|(index, bone)| Some([bone.parent?, index]));
    let ends = body.free_ends().into_iter().enumerate().map(|(end, at)| [at.bone, body.bones.len() + end]);
    bones.chain(ends).collect()
}
