//! The files of a finished track, all made from the journal: the same journal gives the same bytes.

use std::io::Write;

use anyhow::Result;

use super::confidence::{FrameConfidence, JointHints};
use super::journal::FrameResult;
use crate::body::{Body, PoseTable, PoseWriter};
use crate::files::{OutputFolder, Overwrite};
use crate::geometry::Camera;
use crate::motion::{
    Convention, PointTrajectory, write_bvh, write_points, write_points_by, write_points_csv_with_sigmas,
};

/// The poses of a track as its files hold them: where the person is lost, and such frames are to be gaps, the last sure pose
/// before stands in (the first after, where there is none), so that every frame has its row.
pub(super) struct Held {
    pub(super) table: PoseTable,
    /// Rows that are gaps.
    gaps: Vec<usize>,
}

impl Held {
    /// Of results and their confidence; without gaps when `has_gaps` says so.
    pub(super) fn new(results: &[FrameResult], confidences: &[FrameConfidence], has_gaps: bool) -> Self {
        let lost = |row: usize| has_gaps && confidences.get(row).is_some_and(|confidence| confidence.is_lost);
        let first_sure = (0..results.len()).find(|&row| !lost(row)).unwrap_or(0);
        let mut held = first_sure;
        let poses = (0..results.len()).map(|row| {
            held = if lost(row) { held } else { row };
            results[held].pose.iter().map(|value| f64::from(*value)).collect()
        });
        let table = PoseTable { poses: poses.collect(), frames: results.iter().map(|result| result.frame).collect() };
        Self { table, gaps: (0..results.len()).filter(|&row| lost(row)).collect() }
    }

    /// Takes the points of the gaps out of a trajectory of the table.
    pub(super) fn with_gaps(&self, mut points: PointTrajectory) -> PointTrajectory {
        for &row in &self.gaps {
            points.frames[row].fill(None);
        }
        points
    }

    /// Runs of frames that are gaps: the first and the last of each.
    pub(super) fn runs(&self) -> Vec<[usize; 2]> {
        let mut runs: Vec<[usize; 2]> = Vec::new();
        for frame in self.gaps.iter().map(|&row| self.table.frames[row]) {
            match runs.last_mut() {
                Some([_, last]) if *last + 1 == frame => *last = frame,
                _ => runs.push([frame, frame]),
            }
        }
        runs
    }
}

/// The table with every frame: one that was left out has the pose before it.
fn every_frame(table: &PoseTable) -> PoseTable {
    let mut all = PoseTable { frames: Vec::new(), poses: Vec::new() };
    let Some(&first) = table.frames.first() else { return all };
    for (&frame, pose) in table.frames.iter().zip(&table.poses) {
        while let (Some(before), true) = (all.poses.last(), first + all.frames.len() < frame) {
            let before = before.clone();
            all.frames.push(first + all.frames.len());
            all.poses.push(before);
        }
        all.frames.push(frame);
        all.poses.push(pose.clone());
    }
    all
}

/// Writes poses.csv, joints.csv, joints.trc, joints_opensim.trc, markers.c3d, motion.bvh and confidence.csv. Frames that real time left out are
/// gaps, but for BVH, which knows none: there the pose before is held.
pub(super) fn write(
    output: &OutputFolder,
    body: &Body,
    cameras: &[Camera],
    results: &[FrameResult],
    confidences: &[FrameConfidence],
    held: &Held,
    fps: f64,
) -> Result<()> {
    let table = &held.table;
    output.write("poses.csv", |writer| {
        let mut rows = PoseWriter::new(writer, body)?;
        for (frame, pose) in table.frames.iter().zip(&table.poses) {
            rows.write(*frame, pose)?;
        }
        rows.flush()
    })?;
    // One trajectory at a time: they are the largest things in memory.
    {
        let joints = held.with_gaps(body.joint_trajectory(table, fps)?);
        let sigmas = joint_sigmas(&joints, table, confidences);
        output.write("joints.csv", |writer| write_points_csv_with_sigmas(writer, &joints, &sigmas))?;
        write_points(&output.file("joints.trc")?, &joints, Overwrite::Replace)?;
        write_points_by(&output.file("joints_opensim.trc")?, joints, Convention::OpenSim, Overwrite::Replace)?;
    }
    if !body.markers.is_empty() {
        let markers = held.with_gaps(body.marker_trajectory(table, fps)?);
        write_points(&output.file("markers.c3d")?, &markers, Overwrite::Replace)?;
    }
    let motion = body.to_bvh(&every_frame(table), fps)?;
    output.write("motion.bvh", |writer| write_bvh(writer, &motion))?;
    output.write("confidence.csv", |writer| write_confidence(writer, body, cameras, results, confidences))
}

/// The joints' expected errors, mm, a row a frame of the trajectory: a frame that was left out, which has no points, has none either.
fn joint_sigmas(joints: &PointTrajectory, table: &PoseTable, confidences: &[FrameConfidence]) -> Vec<Vec<f64>> {
    let mut sigmas = vec![vec![0.0; joints.names.len()]; joints.frames.len()];
    for (frame, confidence) in table.frames.iter().zip(confidences) {
        if let Some(row) = frame.checked_sub(joints.first_frame).and_then(|at| sigmas.get_mut(at)) {
            row.iter_mut().zip(&confidence.joints).for_each(|(sigma, joint)| *sigma = joint.sigma);
        }
    }
    sigmas
}

/// What confidence.csv says of a joint.
const COLUMNS: [&str; 6] = ["spread", "seen", "confidence", "sigma", "looseness", "support"];

/// `frame,fitness,<camera>.f1,<camera>.f2,…,position_spread,angle_spread,confidence,agreement,wrong,state`, then
/// `<joint>.spread,<joint>.seen,<joint>.confidence,<joint>.sigma,<joint>.looseness,<joint>.support` a joint: spreads and looseness in mm and degrees,
/// the state `sure` or `lost`, support in [-1, 1], the rest in [0, 1]; see [`super::Confidence`].
fn write_confidence(
    out: &mut dyn Write,
    body: &Body,
    cameras: &[Camera],
    results: &[FrameResult],
    confidences: &[FrameConfidence],
) -> Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let views = cameras.iter().flat_map(|camera| [format!("{}.f1", camera.name), format!("{}.f2", camera.name)]);
    let header = ["frame", "fitness"].map(str::to_string).into_iter().chain(views);
    let whole = ["position_spread", "angle_spread", "confidence", "agreement", "wrong", "state"].map(str::to_string);
    let joints = body.joint_names();
    let joints = joints.iter().flat_map(|joint| COLUMNS.map(|what| format!("{joint}.{what}")));
    writer.write_record(header.chain(whole).chain(joints))?;
    for (result, frame) in results.iter().zip(confidences) {
        let mut cells = vec![result.frame.to_string(), result.fitness.to_string()];
        cells.extend(result.views.as_flattened().iter().map(f32::to_string));
        let last = [frame.position_spread, frame.angle_spread, frame.confidence, frame.agreement, frame.wrong];
        cells.extend(last.map(|value| format!("{value:.6}")));
        cells.push(if frame.is_lost { "lost" } else { "sure" }.to_string());
        cells.extend(frame.joints.iter().zip(&result.joints).flat_map(|(joint, hints)| {
            let [spread, seen, confidence] = [joint.spread, joint.seen, joint.confidence];
            let JointHints { looseness, support, .. } = hints;
            let own = [format!("{spread:.3}"), format!("{seen:.3}"), format!("{confidence:.4}")];
            own.into_iter().chain([format!("{:.2}", joint.sigma), format!("{looseness:.3}"), format!("{support:.4}")])
        }));
        writer.write_record(&cells)?;
    }
    Ok(writer.flush()?)
}
