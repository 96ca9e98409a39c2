//! The files of a finished track, all made from the journal: the same journal gives the same bytes.

use std::io::Write;

use anyhow::Result;

use super::confidence::{FrameConfidence, JointHints};
use super::held::Held;
use super::journal::FrameResult;
use super::motion_files;
use crate::body::{Body, PoseTable, PoseWriter};
use crate::files::{OutputFolder, Overwrite};
use crate::geometry::Camera;
use crate::motion::{Convention, PointTrajectory, write_points, write_points_by, write_points_csv_with_sigmas};

/// Writes poses.csv, joints.csv, joints.trc, joints_opensim.trc, markers.c3d, the files of [`motion_files`] and confidence.csv.
/// Frames that real time left out are gaps. Gives a warning for the user.
pub(super) fn write(
    output: &OutputFolder,
    body: &Body,
    cameras: &[Camera],
    results: &[FrameResult],
    confidences: &[FrameConfidence],
    held: &Held,
    fps: f64,
) -> Result<Option<String>> {
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
    let warning = motion_files::write(output, body, held, results, fps)?;
    output.write("confidence.csv", |writer| write_confidence(writer, body, cameras, results, confidences))?;
    Ok(warning)
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
const COLUMNS: [&str; 7] = ["spread", "seen", "confidence", "sigma", "looseness", "support", "ambiguity"];

/// `frame,fitness,<camera>.f1,<camera>.f2,…,position_spread,angle_spread,confidence,agreement,wrong,state`, then
/// `<joint>.spread,<joint>.seen,<joint>.confidence,<joint>.sigma,<joint>.looseness,<joint>.support,<joint>.ambiguity` a joint: spreads, looseness
/// and ambiguity in mm and degrees, the state `sure` or `lost`, support in [-1, 1], the rest in [0, 1]; see [`super::Confidence`].
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
        // Nothing of a view that was left out.
        let shown = |term: &f32| if term.is_nan() { String::new() } else { term.to_string() };
        cells.extend(result.views.as_flattened().iter().map(shown));
        let last = [frame.position_spread, frame.angle_spread, frame.confidence, frame.agreement, frame.wrong];
        cells.extend(last.map(|value| format!("{value:.6}")));
        cells.push(if frame.is_lost { "lost" } else { "sure" }.to_string());
        cells.extend(frame.joints.iter().zip(&result.joints).flat_map(|(joint, hints)| {
            let [spread, seen, confidence] = [joint.spread, joint.seen, joint.confidence];
            let JointHints { looseness, support, ambiguity, .. } = hints;
            let own = [format!("{spread:.3}"), format!("{seen:.3}"), format!("{confidence:.4}")];
            let sigma = format!("{:.2}", joint.sigma);
            let ambiguity = ambiguity.map_or_else(String::new, |it| format!("{it:.3}"));
            let hints = [format!("{looseness:.3}"), format!("{support:.4}"), ambiguity];
            own.into_iter().chain([sigma]).chain(hints)
        }));
        writer.write_record(&cells)?;
    }
    Ok(writer.flush()?)
}
