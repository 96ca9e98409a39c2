//! The report of a track: report.html, and report.rrd where it is asked for.

use std::path::Path;

use anyhow::{Context, Result};
use glam::{DVec2, DVec3};
use image::RgbImage;

use super::confidence::FrameConfidence;
use super::held::Held;
use super::overlay::{file_name, joint_lines};
use super::truth::{Compared, Truth};
use super::{FrameResult, TrackSummary};
use crate::body::Body;
use crate::files::{OutputFolder, Overwrite};
use crate::geometry::Camera;
use crate::motion::PointTrajectory;
use crate::report::{
    CameraFrame, Headline, JointError, OverlayFrame, Player, RecordedView, ReportData, Series, Skeleton, StageTime,
    write_page, write_recording,
};
use crate::sequence::Sequence;

/// The recording's name in a track's folder.
pub(super) const RECORDING: &str = "report.rrd";
/// Overlays that a page holds at most, in frames: more would make it heavy.
const OVERLAY_FRAMES: usize = 12;
const BLUE: [u8; 3] = [31, 111, 178];
const ORANGE: [u8; 3] = [217, 119, 6];
const GREEN: [u8; 3] = [22, 140, 90];
const RED: [u8; 3] = [200, 40, 60];

/// Writes report.html, and the recording if it is asked for; `settings` are names and values.
pub(super) fn write_report(
    output: &OutputFolder,
    sequence: &Sequence,
    body: &Body,
    summary: &TrackSummary,
    confidences: &[FrameConfidence],
    held: &Held,
    truth: Option<&Truth>,
    settings: Vec<(String, String)>,
    has_recording: bool,
) -> Result<()> {
    let frames = &summary.frames;
    let drawn = drawn_frames(output.path(), &sequence.cameras, frames);
    let joints = held.with_gaps(body.joint_trajectory(&held.table, sequence.fps)?);
    let (notes, warnings) = summary.warnings.iter().cloned().partition(|told| sequence.notes().contains(told));
    let mut data = ReportData {
        title: sequence.name.clone(),
        subtitle: format!(
            "{} frames from {} at {} frames/s, {} cameras, tracked with {} ({})",
            frames.len(),
            summary.first_frame,
            sequence.fps,
            sequence.cameras.len(),
            summary.backend[0],
            summary.backend[1]
        ),
        headlines: headlines(summary),
        warnings,
        notes,
        first_frame: summary.first_frame,
        errors_per_frame: vec![expected_errors(confidences)],
        fitness_per_frame: fitness_curves(confidences, frames),
        overlays: overlays(output.path(), &sequence.cameras, &drawn)?,
        player: Some(player(sequence, body, &joints, truth)),
        settings,
        ..ReportData::default()
    };
    if let Some(error) = &summary.error {
        let mut values = vec![None; frames.len()];
        for frame in &error.error.frames {
            if let Some(value) = values.get_mut(frame.frame.wrapping_sub(summary.first_frame)) {
                *value = frame.mean;
            }
        }
        let name = format!("mean over the {}", error.compared);
        data.errors_per_frame.push(Series { name, colour: BLUE, values, is_band: false });
        let points = error.error.points.iter();
        data.joint_errors = points
            .map(|p| JointError { name: p.name.clone(), mean: p.mean, deviation: p.std, largest: p.max })
            .collect();
    }
    data.stages = summary.timings.iter().map(|it| StageTime { name: it.name.clone(), ms: it.mean() }).collect();
    write_page(&output.file("report.html")?, &data, Overwrite::Replace)?;
    if has_recording {
        let views = recorded_views(output.path(), &sequence.cameras, &drawn);
        write_recording(&output.file(RECORDING)?, &data, &views, Overwrite::Replace)?;
    }
    Ok(())
}

fn headlines(summary: &TrackSummary) -> Vec<Headline> {
    let headline = |value: String, label: &str| Headline { value, label: label.to_string() };
    let mut all = Vec::new();
    if let Some(error) = &summary.error {
        all.push(headline(format!("{:.1} mm", error.error.mean), &format!("mean error of the {}", error.compared)));
    }
    all.push(headline(format!("{:.3}", summary.mean_fitness), "mean fitness"));
    all.push(headline(format!("{:.2}", summary.mean_confidence), "mean confidence"));
    if summary.new_frames > 0 {
        all.push(headline(format!("{:.1}", summary.frames_per_second), "frames a second"));
    }
    all
}

/// What the joints are expected to be off: the mean over them, a band from 0.
fn expected_errors(confidences: &[FrameConfidence]) -> Series {
    let mean = |frame: &FrameConfidence| {
        let sum: f64 = frame.joints.iter().map(|joint| joint.sigma).sum();
        (!frame.joints.is_empty()).then(|| sum / frame.joints.len() as f64)
    };
    let name = "expected, mean over the joints".to_string();
    Series { name, colour: ORANGE, values: confidences.iter().map(mean).collect(), is_band: true }
}

fn fitness_curves(confidences: &[FrameConfidence], frames: &[FrameResult]) -> Vec<Series> {
    let curve = |name: &str, colour, values: Vec<f64>| Series {
        name: name.to_string(),
        colour,
        values: values.into_iter().map(Some).collect(),
        is_band: false,
    };
    vec![
        curve("fitness", BLUE, frames.iter().map(|result| f64::from(result.fitness)).collect()),
        curve("silhouette (mean f1)", GREEN, frames.iter().map(FrameResult::mean_f1).collect()),
        curve("confidence", ORANGE, confidences.iter().map(|frame| frame.confidence).collect()),
        curve("probability that it is wrong", RED, confidences.iter().map(|frame| frame.wrong).collect()),
    ]
}

/// Frames whose overlays the folder holds: an earlier run may have drawn them.
fn drawn_frames(folder: &Path, cameras: &[Camera], frames: &[FrameResult]) -> Vec<usize> {
    let Some(first) = cameras.first() else { return Vec::new() };
    let frames = frames.iter().map(|result| result.frame);
    frames.filter(|frame| folder.join(file_name(&first.name, *frame)).is_file()).collect()
}

/// All overlays that there are, where they lie.
fn recorded_views<'a>(folder: &Path, cameras: &'a [Camera], drawn: &[usize]) -> Vec<RecordedView<'a>> {
    let pictures = |camera: &Camera| {
        let all = drawn.iter().map(|&frame| (frame, folder.join(file_name(&camera.name, frame))));
        all.filter(|(_, path)| path.is_file()).collect()
    };
    cameras.iter().map(|camera| RecordedView { camera, pictures: pictures(camera) }).collect()
}

/// Overlays of frames evenly over the track, read back from the folder.
fn overlays(folder: &Path, cameras: &[Camera], there: &[usize]) -> Result<Vec<OverlayFrame>> {
    let count = there.len().min(OVERLAY_FRAMES);
    let mut chosen = Vec::with_capacity(count);
    for index in 0..count {
        // The first, the last, and equal steps between.
        let frame = there[index * (there.len() - 1) / (count - 1).max(1)];
        let mut views: Vec<(String, RgbImage)> = Vec::new();
        for camera in cameras {
            let path = folder.join(file_name(&camera.name, frame));
            if path.is_file() {
                let picture = image::open(&path).with_context(|| format!("cannot read {}", path.display()))?;
                views.push((camera.name.clone(), picture.into_rgb8()));
            }
        }
        chosen.push(OverlayFrame { frame, views });
    }
    Ok(chosen)
}

fn player(sequence: &Sequence, body: &Body, joints: &PointTrajectory, truth: Option<&Truth>) -> Player {
    let lines = joint_lines(body);
    let mut skeletons = vec![skeleton("tracked", body, lines.clone(), joints.frames.clone())];
    if let Some(truth) = truth {
        skeletons.extend(true_skeleton(body, joints, truth, &lines));
    }
    Player { fps: sequence.fps, skeletons, cameras: sequence.cameras.iter().filter_map(camera_frame).collect() }
}

/// The player of a run at work: the cameras, and a skeleton without frames yet.
pub(super) fn live_player(sequence: &Sequence, body: &Body) -> Player {
    let cameras = sequence.cameras.iter().filter_map(camera_frame).collect();
    Player { fps: sequence.fps, skeletons: vec![skeleton("tracked", body, joint_lines(body), Vec::new())], cameras }
}

/// A skeleton of the body's joints.
fn skeleton(name: &str, body: &Body, bones: Vec<[usize; 2]>, frames: Vec<Vec<Option<DVec3>>>) -> Skeleton {
    Skeleton { name: name.to_string(), names: body.joint_names(), bones, frames }
}

/// The truth with lines between the joints that it has under our names; markers have no lines to draw.
fn true_skeleton(body: &Body, joints: &PointTrajectory, truth: &Truth, lines: &[[usize; 2]]) -> Option<Skeleton> {
    let points = truth.points();
    if truth.compared != Compared::Joints || points.rate > 0.0 && (points.rate - joints.rate).abs() > 1e-3 * joints.rate
    {
        return None;
    }
    let columns: Vec<Option<usize>> = body.joint_names().iter().map(|name| points.column(name)).collect();
    let row = |frame: usize| frame.checked_sub(points.first_frame).and_then(|row| points.frames.get(row));
    let frames = (0..joints.frames.len()).map(|at| {
        let row = row(joints.first_frame + at);
        columns.iter().map(|column| *row?.get((*column)?)?).collect()
    });
    Some(skeleton("reference", body, lines.to_vec(), frames.collect()))
}

/// A camera with the directions of its picture's corners; none where its lens has no ray for one.
fn camera_frame(camera: &Camera) -> Option<CameraFrame> {
    let [width, height] = camera.size.map(f64::from);
    let corner = |x: f64, y: f64| Some(camera.ray(DVec2::new(x * width - 0.5, y * height - 0.5))?.1);
    Some(CameraFrame {
        name: camera.name.clone(),
        centre: camera.centre_in_world(),
        corners: [corner(0.0, 0.0)?, corner(1.0, 0.0)?, corner(1.0, 1.0)?, corner(0.0, 1.0)?],
    })
}
