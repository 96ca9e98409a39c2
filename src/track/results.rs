//! The files of a finished track, all made from the journal: the same journal gives the same bytes.

use std::fs;
use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result};

use super::confidence::Confidence;
use super::journal::{FrameResult, Journal};
use super::overlay;
use super::realtime;
use super::run_record;
use crate::body::{Body, PoseTable, PoseWriter};
use crate::files::{OutputFolder, Overwrite};
use crate::geometry::Camera;
use crate::motion::{write_bvh, write_points};

/// Everything a run writes but its overlays.
const FILES: [&str; 13] = [
    "poses.csv",
    "joints.csv",
    "joints.trc",
    "markers.c3d",
    "motion.bvh",
    "confidence.csv",
    "stages.json",
    "trace.json",
    "report.html",
    realtime::SUMMARY,
    realtime::TIMELINE,
    run_record::NAME,
    Journal::NAME,
];

/// Removes what an earlier run left in the folder, so that a new one never stands beside old results.
pub(super) fn clear(output: &OutputFolder) -> Result<()> {
    let remove = |path: &Path| fs::remove_file(path).with_context(|| format!("cannot replace {}", path.display()));
    for name in FILES {
        let path = output.path().join(name);
        if path.is_file() {
            remove(&path)?;
        }
    }
    let overlays = output.path().join(overlay::FOLDER);
    if overlays.is_dir() {
        let cannot = || format!("cannot read the folder {}", overlays.display());
        for entry in fs::read_dir(&overlays).with_context(cannot)? {
            let path = entry.with_context(cannot)?.path();
            if path.extension().is_some_and(|extension| extension == "png") {
                remove(&path)?;
            }
        }
    }
    Ok(())
}

/// The poses of a journal.
pub(super) fn pose_table(results: &[FrameResult]) -> PoseTable {
    PoseTable {
        frames: results.iter().map(|result| result.frame).collect(),
        poses: results.iter().map(|result| result.pose.iter().map(|v| f64::from(*v)).collect()).collect(),
    }
}

/// The table with every frame: one that was left out has the pose before it.
fn held(table: PoseTable) -> PoseTable {
    let Some(&first) = table.frames.first() else { return table };
    let mut all = PoseTable { frames: Vec::new(), poses: Vec::new() };
    for (frame, pose) in table.frames.into_iter().zip(table.poses) {
        while let (Some(before), true) = (all.poses.last(), first + all.frames.len() < frame) {
            let before = before.clone();
            all.frames.push(first + all.frames.len());
            all.poses.push(before);
        }
        all.frames.push(frame);
        all.poses.push(pose);
    }
    all
}

/// Writes poses.csv, joints.csv, joints.trc, markers.c3d, motion.bvh and confidence.csv. Frames that real time left out are
/// gaps, but for BVH, which knows none: there the pose before is held.
pub(super) fn write(
    output: &OutputFolder,
    body: &Body,
    cameras: &[Camera],
    results: &[FrameResult],
    fps: f64,
) -> Result<()> {
    let table = pose_table(results);
    output.write("poses.csv", |writer| {
        let mut rows = PoseWriter::new(writer, body)?;
        for (frame, pose) in table.frames.iter().zip(&table.poses) {
            rows.write(*frame, pose)?;
        }
        rows.flush()
    })?;
    // One trajectory at a time: they are the largest things in memory.
    {
        let joints = body.joint_trajectory(&table, fps)?;
        write_points(&output.file("joints.csv")?, &joints, Overwrite::Replace)?;
        write_points(&output.file("joints.trc")?, &joints, Overwrite::Replace)?;
    }
    if !body.markers.is_empty() {
        write_points(&output.file("markers.c3d")?, &body.marker_trajectory(&table, fps)?, Overwrite::Replace)?;
    }
    let motion = body.to_bvh(&held(table), fps)?;
    output.write("motion.bvh", |writer| write_bvh(writer, &motion))?;
    output.write("confidence.csv", |writer| write_confidence(writer, body, cameras, results))
}

/// `frame,fitness,<camera>.f1,<camera>.f2,…,position_spread,angle_spread,confidence`: spreads in mm and degrees, the rest
/// in [0, 1]; see [`Confidence`].
fn write_confidence(out: &mut dyn Write, body: &Body, cameras: &[Camera], results: &[FrameResult]) -> Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let views = cameras.iter().flat_map(|camera| [format!("{}.f1", camera.name), format!("{}.f2", camera.name)]);
    let header = ["frame", "fitness"].map(str::to_string).into_iter().chain(views);
    writer.write_record(header.chain(["position_spread", "angle_spread", "confidence"].map(str::to_string)))?;
    let mut confidence = Confidence::new(body);
    for result in results {
        let frame = confidence.next(result);
        let mut cells = vec![result.frame.to_string(), result.fitness.to_string()];
        cells.extend(result.views.as_flattened().iter().map(f32::to_string));
        let last = [frame.position_spread, frame.angle_spread, frame.confidence];
        cells.extend(last.map(|value| format!("{value:.6}")));
        writer.write_record(&cells)?;
    }
    Ok(writer.flush()?)
}
