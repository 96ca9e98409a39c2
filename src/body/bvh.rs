//! A body's motion as BVH, for animation programs.

use anyhow::{Context, Result, bail, ensure};
use glam::{DAffine3, DVec3};

use super::{Body, Bone, DofAxis, PoseTable};
use crate::motion::{BvhChannel, BvhJoint, BvhMotion, BvhStatement, Convention, y_up};

const POSITIONS: [BvhChannel; 3] = [BvhChannel::XPosition, BvhChannel::YPosition, BvhChannel::ZPosition];
/// Turns about the body's x (forward), y (left) and z (up), which are the file's z, x and y.
const ROTATIONS: [BvhChannel; 3] = [BvhChannel::ZRotation, BvhChannel::XRotation, BvhChannel::YRotation];

impl Body {
    /// The motion of a pose table as BVH: a joint a bone, parents first, in centimetres with y up (x left, z
    /// forward), which it says of itself with the number of its first frame; a leaf's free end is the `b` end
    /// of its bone's first part.
    ///
    /// Every joint has its three rotations in the order in which this body multiplies them, whichever of them can move:
    /// programs expect that. The root has its three positions too, and no offset besides, so that programs that add an
    /// offset and those that replace it agree. So have other bones that can be shifted, with the offset in the position.
    ///
    /// # Errors
    /// When the table is empty, its frames are not consecutive (BVH knows no gaps), the rate is not positive, or a pose
    /// does not fit the body.
    pub fn to_bvh(&self, poses: &PoseTable, rate: f64) -> Result<BvhMotion> {
        ensure!(rate > 0.0 && rate.is_finite(), "the frame rate is {rate}, expected a positive number");
        ensure!(!poses.poses.is_empty(), "there are no poses to write as BVH");
        if let Some(pair) = poses.frames.windows(2).find(|pair| pair[0].checked_add(1) != Some(pair[1])) {
            bail!("frame {} follows frame {}, expected consecutive frames since BVH knows no gaps", pair[1], pair[0]);
        }
        let mut place = vec![0; self.bones.len()];
        for (joint, &bone) in self.update_order.iter().enumerate() {
            place[bone] = joint;
        }
        let joints = self.update_order.iter().map(|&index| self.bvh_joint(index, &place)).collect();
        // Where each bone's values begin in the state vector.
        let mut starts = Vec::with_capacity(self.bones.len());
        let mut next = 0;
        for bone in &self.bones {
            starts.push(next);
            next += bone.dofs.len();
        }
        let mut frames = Vec::with_capacity(poses.poses.len());
        for (frame, pose) in poses.frames.iter().zip(&poses.poses) {
            self.check_pose(pose).with_context(|| format!("the pose of frame {frame}"))?;
            let mut row = Vec::new();
            for &index in &self.update_order {
                let bone = &self.bones[index];
                bvh_values(bone, &pose[starts[index]..starts[index] + bone.dofs.len()], &mut row);
            }
            frames.push(row);
        }
        let statement = BvhStatement { millimetres: Convention::Pantin.bvh_unit(), first_frame: poses.frames[0] };
        Ok(BvhMotion { joints, frame_time: 1.0 / rate, frames, statement: Some(statement) })
    }

    fn bvh_joint(&self, index: usize, place: &[usize]) -> BvhJoint {
        let bone = &self.bones[index];
        let leaf = self.bones.iter().all(|other| other.parent != Some(index));
        let end = self.parts.iter().find(|part| part.bone == index).map(|part| part.b);
        let positions = if is_shifted(bone) { &POSITIONS[..] } else { &[] };
        let rotations = bone.order.axes().map(|axis| ROTATIONS[axis]);
        BvhJoint {
            name: bone.name.clone(),
            parent: bone.parent.map(|parent| place[parent]),
            offset: if bone.parent.is_none() { DVec3::ZERO } else { in_file(bone.offset) },
            channels: positions.iter().copied().chain(rotations).collect(),
            end_sites: end.filter(|_| leaf).into_iter().map(in_file).collect(),
        }
    }
}

/// A vector (mm, z up) in the file's unit and axes.
fn in_file(vector: DVec3) -> DVec3 {
    y_up(vector) / Convention::Pantin.bvh_unit()
}

/// Whether a joint has position channels.
fn is_shifted(bone: &Bone) -> bool {
    bone.parent.is_none() || bone.dofs.iter().any(|dof| !dof.axis.is_rotation())
}

/// Appends the channel values of a bone.
fn bvh_values(bone: &Bone, values: &[f64], row: &mut Vec<f64>) {
    if is_shifted(bone) {
        let DAffine3 { translation, .. } = bone.parent_from_bone(values);
        row.extend(in_file(translation).to_array());
    }
    for axis in bone.order.axes() {
        let slot = DofAxis::Rx.slot() + axis;
        let value = bone.dofs.iter().zip(values).find(|(dof, _)| dof.axis.slot() == slot);
        row.push(value.map_or(0.0, |(_, angle)| angle.to_degrees()));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::body::kinematics::tests::any_body;
    use crate::motion::{parse_bvh, write_bvh};

    proptest! {
        #[test]
        fn a_reader_finds_every_bone_where_the_body_has_it((body, pose) in any_body()) {
            let table = PoseTable { frames: vec![4, 5], poses: vec![vec![0.25; pose.len()], pose] };
            let mut text = Vec::new();
            write_bvh(&mut text, &body.to_bvh(&table, 60.0).unwrap()).unwrap();
            let points = parse_bvh(std::str::from_utf8(&text).unwrap(), "any.bvh").unwrap().to_points().unwrap();
            prop_assert_eq!(points.first_frame, 4);
            for (row, pose) in points.frames.iter().zip(&table.poses) {
                let bones = body.world_from_bones(pose).unwrap();
                for (bone, matrix) in body.bones.iter().zip(&bones) {
                    let at = row[points.column(&bone.name).unwrap()].unwrap();
                    // Six digits in the file, along at most twelve bones.
                    prop_assert!((at - matrix.translation).length() < 1e-3, "{} {} {}", bone.name, at, matrix);
                }
            }
        }
    }

    #[test]
    fn the_free_ends_are_those_of_the_body() {
        let body = Body::adult(1750.0).unwrap();
        let table = PoseTable { frames: vec![0], poses: vec![body.standing_pose()] };
        let motion = body.to_bvh(&table, 25.0).unwrap();
        assert_eq!(motion.frame_time, 0.04);
        let points = motion.to_points().unwrap();
        let joints = body.joint_trajectory(&table, 25.0).unwrap();
        for (end, name) in
            [("left_knee_end", "left_ankle"), ("right_elbow_end", "right_wrist"), ("head_end", "head_top")]
        {
            let at = |points: &crate::motion::PointTrajectory, name: &str| {
                points.frames[0][points.column(name).unwrap()].unwrap()
            };
            assert!((at(&points, end) - at(&joints, name)).length() < 1e-9, "{end}");
        }
    }

    #[test]
    fn the_file_is_y_up_in_centimetres() {
        let body = Body::adult(1750.0).unwrap();
        let mut pose = body.standing_pose();
        pose[..2].copy_from_slice(&[1000.0, 200.0]);
        let height = pose[2];
        let motion = body.to_bvh(&PoseTable { frames: vec![0], poses: vec![pose] }, 25.0).unwrap();
        use BvhChannel::*;
        assert_eq!(motion.joints[0].channels, [XPosition, YPosition, ZPosition, ZRotation, XRotation, YRotation]);
        let [left, up, forward] = [motion.frames[0][0], motion.frames[0][1], motion.frames[0][2]];
        assert!((left - 20.0).abs() < 1e-9 && (forward - 100.0).abs() < 1e-9, "{left} {forward}");
        assert!((up - height / 10.0).abs() < 1e-9 && (80.0..110.0).contains(&up), "{up}");
        let knee = motion.joints.iter().find(|joint| joint.name == "left_knee").unwrap();
        assert!(knee.offset.y < -35.0 && knee.end_sites[0].y < -35.0, "{knee:?}");
        let hip = motion.joints.iter().find(|joint| joint.name == "left_hip").unwrap();
        assert!(hip.offset.x > 5.0, "{hip:?}");
    }

    #[test]
    fn what_bvh_cannot_hold_is_refused() {
        let body = Body::adult(1750.0).unwrap();
        let pose = body.standing_pose();
        let error = |frames: Vec<usize>, rate| {
            let poses = vec![pose.clone(); frames.len()];
            body.to_bvh(&PoseTable { frames, poses }, rate).unwrap_err().to_string()
        };
        assert!(error(vec![1, 3], 25.0).contains("frame 3 follows frame 1, expected consecutive frames"));
        assert!(error(vec![], 25.0).contains("no poses"));
        assert!(error(vec![0], f64::NAN).contains("frame rate is NaN"));
        let broken = PoseTable { frames: vec![9], poses: vec![vec![0.0; 3]] };
        let error = format!("{:#}", body.to_bvh(&broken, 25.0).unwrap_err());
        assert!(error.contains("frame 9") && error.contains("3 values"), "{error}");
    }
}
