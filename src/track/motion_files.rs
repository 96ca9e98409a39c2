//! The motion of a finished track, for other programs: BVH and glTF.

use anyhow::Result;

use super::held::Held;
use crate::body::{Body, Model, PoseTable};
use crate::files::OutputFolder;
use crate::motion::write_bvh;

/// Its files in a track's folder.
pub(super) const FILES: [&str; 2] = ["motion.bvh", "motion.glb"];

/// Writes them. Frames that are lost or that real time left out hold the pose before them in BVH, which knows no gaps, and in glTF.
///
/// Gives a warning where the skin is not the body's own.
pub(super) fn write(output: &OutputFolder, body: &Body, held: &Held, fps: f64) -> Result<Option<String>> {
    let [bvh, glb] = FILES;
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
