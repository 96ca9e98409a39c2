//! What a recording holds: cameras, pictures, skeletons, curves and texts.

use std::fs;
use std::io::Write;

use anyhow::{Context, Result};
use glam::{DMat3, DVec2, DVec3};
use re_chunk::{EntityPath, TimePoint};
use re_log_types::{StoreId, StoreKind, TimeCell};
use re_sdk_types::archetypes::{
    AnnotationContext, BarChart, EncodedImage, LineStrips3D, Pinhole, Points3D, RecordingInfo, Scalars, SeriesLines,
    TextDocument, Transform3D, ViewCoordinates,
};
use re_sdk_types::components::{Color, MediaType};
use re_sdk_types::datatypes::{AnnotationInfo, ClassDescription};

use super::layout::{Windows, write_layout};
use super::markdown::{settings, summary};
use super::stream::{Stream, entity};
use super::view::RecordedView;
use crate::geometry::Camera;
use crate::report::html::{ReportData, Skeleton};
use crate::report::plot::Series;

/// Recordings of one application share what the viewer remembers of its windows.
const APPLICATION: &str = "pantin";
/// Metres in a millimetre.
const MM: f64 = 1e-3;
/// The tracked skeleton in blue, the reference in orange, as in the page.
const COLOURS: [[u8; 3]; 2] = [[31, 111, 178], [224, 138, 46]];
/// Half the width of a bone and of a joint, and how far before a camera its picture stands, m.
const BONE_RADIUS: f32 = 0.012;
const JOINT_RADIUS: f32 = 0.018;
const PICTURE_DISTANCE: f32 = 0.42;

/// Writes the whole file.
pub(super) fn write(writer: &mut dyn Write, data: &ReportData, views: &[RecordedView]) -> Result<()> {
    let mut stream = Stream::new(writer, StoreId::random(StoreKind::Recording, APPLICATION))?;
    stream.always(&EntityPath::properties(), &RecordingInfo::new().with_name(data.title.as_str()))?;
    let clock = Clock { fps: data.player.as_ref().map_or(0.0, |player| player.fps) };
    let windows = Windows { cameras: world(&mut stream, data, views, clock)?, plots: plots(&mut stream, data, clock)? };
    let text = |text: String| TextDocument::new(text).with_media_type(MediaType::MARKDOWN);
    stream.always(&entity(&["report", "summary"]), &text(summary(data)?))?;
    stream.always(&entity(&["report", "settings"]), &text(settings(data)))?;
    stream.turn_to(StoreId::random(StoreKind::Blueprint, APPLICATION))?;
    write_layout(&mut stream, &windows, clock.main_timeline())?;
    stream.finish()
}

/// Frames to moments on both time-lines.
#[derive(Clone, Copy)]
struct Clock {
    /// Frames a second; 0 where the rate is unknown.
    fps: f64,
}

impl Clock {
    fn at(self, frame: usize) -> TimePoint {
        let at = TimePoint::default().with_index("frame", TimeCell::from_sequence(whole(frame)));
        if !self.has_time() {
            return at;
        }
        // A cast of a number too large ends at the largest.
        let nanoseconds = (frame as f64 / self.fps * 1e9).round() as i64;
        at.with_index("time", TimeCell::from_duration_nanos(nanoseconds))
    }

    fn has_time(self) -> bool {
        self.fps > 0.0 && self.fps.is_finite()
    }

    fn main_timeline(self) -> &'static str {
        if self.has_time() { "time" } else { "frame" }
    }
}

fn whole(number: usize) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}

fn colour([red, green, blue]: [u8; 3]) -> Color {
    Color::from_rgb(red, green, blue)
}

/// Everything in space; the cameras' names and entities.
fn world(
    stream: &mut Stream,
    data: &ReportData,
    views: &[RecordedView],
    clock: Clock,
) -> Result<Vec<(String, EntityPath)>> {
    let root = entity(&["world"]);
    stream.always(&root, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    let mut cameras = Vec::with_capacity(views.len());
    for view in views {
        let at = entity(&["world", "cameras", &view.camera.name]);
        stream.always(&at, &[&placed(view.camera) as &dyn re_sdk_types::AsComponents, &pinhole(view.camera)])?;
        let overlay = entity(&["world", "cameras", &view.camera.name, "overlay"]);
        for (frame, path) in &view.pictures {
            let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
            let picture = EncodedImage::new(bytes).with_media_type(MediaType::PNG);
            stream.rows(&overlay, [(clock.at(*frame), picture)])?;
        }
        cameras.push((view.camera.name.clone(), at));
    }
    for (index, skeleton) in data.player.iter().flat_map(|player| &player.skeletons).enumerate() {
        moving(stream, skeleton, COLOURS[index % COLOURS.len()], data.first_frame, clock)?;
    }
    Ok(cameras)
}

fn single(matrix: DMat3) -> [[f32; 3]; 3] {
    matrix.as_mat3().to_cols_array_2d()
}

/// Where a camera stands: its frame (x right, y down, z along the view) in the world.
fn placed(camera: &Camera) -> Transform3D {
    let turn = camera.camera_from_world.matrix3.transpose();
    let centre = (camera.centre_in_world() * MM).as_vec3();
    Transform3D::from_translation_mat3x3(centre.to_array(), single(turn))
}

/// How a camera would draw without distortion: the lens maps distorted coordinates to pixels linearly.
fn pinhole(camera: &Camera) -> Pinhole {
    let [x, y, origin] = [DVec2::X, DVec2::Y, DVec2::ZERO].map(|at| camera.lens.to_pixel(at));
    // The viewer's pixels begin at their corner, ours in their middle.
    let centre = origin + 0.5;
    let matrix = DMat3::from_cols((x - origin).extend(0.0), (y - origin).extend(0.0), centre.extend(1.0));
    Pinhole::new(single(matrix))
        .with_resolution(camera.size.map(|side| side as f32))
        .with_camera_xyz(re_sdk_types::components::ViewCoordinates::RDF)
        .with_image_plane_distance(PICTURE_DISTANCE)
}

/// Joints and bones, frame by frame; the names of the joints belong to their numbers.
fn moving(stream: &mut Stream, skeleton: &Skeleton, tint: [u8; 3], first_frame: usize, clock: Clock) -> Result<()> {
    let within = |name: &str| entity(&["world", &skeleton.name, name]);
    let label = |id: u16, name: &str| AnnotationInfo { id, label: Some(name.into()), color: Some(colour(tint).0) };
    let class = ClassDescription {
        info: label(0, &skeleton.name),
        keypoint_annotations: (0..).zip(&skeleton.names).map(|(id, name)| label(id, name)).collect(),
        keypoint_connections: Vec::new(),
    };
    stream.always(&entity(&["world", &skeleton.name]), &AnnotationContext::new([class]))?;
    let (joints, bones) = (within("joints"), within("bones"));
    stream.always(&joints, &Points3D::update_fields().with_radii([JOINT_RADIUS]).with_colors([colour(tint)]))?;
    stream.always(&bones, &LineStrips3D::update_fields().with_radii([BONE_RADIUS]).with_colors([colour(tint)]))?;
    let frames = || (first_frame..).zip(&skeleton.frames);
    stream.rows(&joints, frames().map(|(frame, row)| (clock.at(frame), points(row))))?;
    stream.rows(&bones, frames().map(|(frame, row)| (clock.at(frame), strips(row, &skeleton.bones))))
}

/// A point in metres, where there is one.
fn metres(point: Option<DVec3>) -> Option<[f32; 3]> {
    let point = (point? * MM).as_vec3();
    point.is_finite().then_some(point.to_array())
}

fn points(row: &[Option<DVec3>]) -> Points3D {
    let there = (0_u16..).zip(row).filter_map(|(id, point)| Some((id, metres(*point)?)));
    let (ids, positions): (Vec<u16>, Vec<[f32; 3]>) = there.unzip();
    Points3D::update_fields().with_positions(positions).with_keypoint_ids(ids)
}

fn strips(row: &[Option<DVec3>], bones: &[[usize; 2]]) -> LineStrips3D {
    let end = |index: usize| metres(*row.get(index)?);
    let strips = bones.iter().filter_map(|[a, b]| Some([end(*a)?, end(*b)?]));
    LineStrips3D::update_fields().with_strips(strips)
}

/// Curves and bars; the windows they are seen in.
fn plots(stream: &mut Stream, data: &ReportData, clock: Clock) -> Result<Vec<[&'static str; 3]>> {
    let mut windows = Vec::new();
    for (group, heading, curves) in
        [("error", "Error, mm", &data.errors_per_frame), ("fitness", "Fitness", &data.fitness_per_frame)]
    {
        if !curves.is_empty() {
            windows.push(["TimeSeries", heading, group]);
        }
        for curve in curves {
            let path = entity(&["plots", group, &curve.name]);
            let style = SeriesLines::new().with_colors([colour(curve.colour)]).with_names([curve.name.as_str()]);
            stream.always(&path, &style)?;
            stream.rows(&path, scalars(curve, data.first_frame, clock))?;
        }
    }
    if !data.stages.is_empty() {
        windows.push(["BarChart", "Time a frame, ms", "stages"]);
    }
    // A bar each, so that each has its name.
    for (index, stage) in data.stages.iter().enumerate() {
        let bar = BarChart::new(vec![stage.ms]).with_abscissa(vec![whole(index)]);
        stream.always(&entity(&["plots", "stages", &stage.name]), &bar)?;
    }
    Ok(windows)
}

/// A value a frame; none, which breaks the curve, where there is no number.
fn scalars(curve: &Series, first_frame: usize, clock: Clock) -> impl Iterator<Item = (TimePoint, Scalars)> {
    let values = (first_frame..).zip(&curve.values);
    values.map(move |(frame, value)| (clock.at(frame), Scalars::new(value.filter(|value| value.is_finite()))))
}
