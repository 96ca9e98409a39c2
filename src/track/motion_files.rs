//! The motion of a finished track, for other programs: BVH, glTF and MOT.

use anyhow::{Context, Result};

use super::held::Held;
use super::journal::FrameResult;
use crate::body::{Body, Coordinates, Model, PoseTable};
use crate::files::OutputFolder;
use crate::motion::{write_bvh, write_mot};

/// Its files in a track's folder.
pub(super) const FILES: [&str; 5] = ["motion.bvh", "motion.glb", "motion.mot", "motion_sd.mot", "coordinates.toml"];

/// Writes them. Frames that are lost or that real time left out hold the pose before them in BVH, which knows no gaps, and in glTF, and
/// have no row in MOT; without a sure frame there is no MOT.
///
/// Gives a warning where the skin is not the body's own.
pub(super) fn write(
    output: &OutputFolder,
    body: &Body,
    held: &Held,
    results: &[FrameResult],
    fps: f64,
) -> Result<Option<String>> {
    let [bvh, glb, mot, deviations, names] = FILES;
    let table = every_frame(&held.table);
    let motion = body.to_bvh(&table, fps)?;
    output.write(bvh, |writer| write_bvh(writer, &motion))?;
    drop(motion);
    // A run with the flat model never needed the file of the body's mesh; that it is gone is no reason to have no results.
    let own = output.write(glb, |writer| body.write_gltf(writer, &table, fps));
    let warning = match (own, Model::Elliptic66.dressed(body)) {
        (Ok(()), _) => None,
        (Err(error), Some(dressed)) if body.mesh.is_some() => {
            output.write(glb, |writer| dressed.write_gltf(writer, &table, fps))?;
            Some(format!("{glb} has frusta for a skin: {error:#}"))
        }
        (Err(error), _) => return Err(error),
    };
    let sure = held.sure();
    if sure.is_empty() {
        return Ok(warning);
    }
    let of = |values: fn(&FrameResult) -> &[f32]| PoseTable {
        frames: sure.iter().map(|&row| results[row].frame).collect(),
        poses: sure.iter().map(|&row| values(&results[row]).iter().map(|value| f64::from(*value)).collect()).collect(),
    };
    let coordinates = Coordinates::of_body(body).context("the names of coordinates")?;
    output.write(names, |writer| Ok(writer.write_all(coordinates.to_toml().as_bytes())?))?;
    let motion = coordinates.of_poses(body, &of(|result| &result.pose), fps)?;
    output.write(mot, |writer| write_mot(writer, &motion, "motion"))?;
    let spreads = coordinates.of_deviations(body, &of(|result| &result.spread), fps)?;
    output.write(deviations, |writer| write_mot(writer, &spreads, "motion_sd"))?;
    Ok(warning)
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
