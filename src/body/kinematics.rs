//! Forward kinematics in double precision (METHOD A3): from a pose to the place of every bone, joint and marker. A whole
//! swarm is posed in single precision by the evaluators; this is the form everything else uses, and their yardstick.

use anyhow::{Result, ensure};
use glam::{DAffine3, DMat3, DVec3};

use super::{Body, Bone, PoseTable};
use crate::geometry::{EulerOrder, euler_matrix};
use crate::motion::PointTrajectory;

/// Longest trajectory that is filled up between the frames of a pose table; more is a mistaken frame number.
const LONGEST_TRAJECTORY: usize = 10_000_000;

impl Bone {
    /// The local matrix `parent_from_bone` for the values of this bone's own degrees of freedom, in their order (mm,
    /// radians): `T(offset + t) R`. For the order xyz, R = R_x(a) R_y(b) R_z(c) in closed form, with s and c for sine
    /// and cosine:
    ///
    /// ```text
    ///            cb cc              -cb sc        sb
    ///  ca sc + sa sb cc    ca cc - sa sb sc    -sa cb
    ///  sa sc - ca sb cc    sa cc + ca sb sc     ca cb
    /// ```
    pub fn parent_from_bone(&self, values: &[f64]) -> DAffine3 {
        let mut slots = [0.0; 6];
        for (dof, value) in self.dofs.iter().zip(values) {
            slots[dof.axis.slot()] = *value;
        }
        let [tx, ty, tz, rx, ry, rz] = slots;
        let rotation = match self.order {
            EulerOrder::Xyz => {
                let ((sa, ca), (sb, cb), (sc, cc)) = (rx.sin_cos(), ry.sin_cos(), rz.sin_cos());
                DMat3::from_cols(
                    DVec3::new(cb * cc, ca * sc + sa * sb * cc, sa * sc - ca * sb * cc),
                    DVec3::new(-cb * sc, ca * cc - sa * sb * sc, sa * cc + ca * sb * sc),
                    DVec3::new(sb, -sa * cb, ca * cb),
                )
            }
            order => euler_matrix(DVec3::new(rx, ry, rz), order),
        };
        DAffine3 { matrix3: rotation, translation: self.offset + DVec3::new(tx, ty, tz) }
    }
}

impl Body {
    /// The matrices `world_from_bone` of all bones, in file order, for a pose (mm, radians).
    ///
    /// # Errors
    /// When the pose has the wrong length or a value that is not finite.
    pub fn world_from_bones(&self, pose: &[f64]) -> Result<Vec<DAffine3>> {
        let mut matrices = Vec::new();
        self.world_from_bones_into(pose, &mut matrices)?;
        Ok(matrices)
    }

    /// [`Self::world_from_bones`] into a buffer that is used again, for loops over frames.
    ///
    /// # Errors
    /// As [`Self::world_from_bones`].
    pub fn world_from_bones_into(&self, pose: &[f64], matrices: &mut Vec<DAffine3>) -> Result<()> {
        self.check_pose(pose)?;
        matrices.clear();
        let mut rest = pose;
        for bone in &self.bones {
            let (own, others) = rest.split_at(bone.dofs.len());
            matrices.push(bone.parent_from_bone(own));
            rest = others;
        }
        // Parents come first, so a parent's matrix is global by the time its children need it.
        for &index in &self.update_order {
            if let Some(parent) = self.bones[index].parent {
                matrices[index] = matrices[parent] * matrices[index];
            }
        }
        Ok(())
    }

    /// World positions of the joints, mm, in the order of [`Self::joint_names`].
    pub fn joint_positions(&self, world_from_bones: &[DAffine3]) -> Vec<DVec3> {
        let origins = world_from_bones.iter().map(|matrix| matrix.translation);
        let ends = self.free_ends();
        origins.chain(ends.iter().map(|end| world_from_bones[end.bone].transform_point3(end.at))).collect()
    }

    /// World positions of the virtual markers, mm, in file order.
    pub fn marker_positions(&self, world_from_bones: &[DAffine3]) -> Vec<DVec3> {
        self.markers.iter().map(|marker| world_from_bones[marker.bone].transform_point3(marker.at)).collect()
    }

    /// The joints over the frames of a pose table; frames the table leaves out have no points.
    ///
    /// # Errors
    /// When the table is empty, its frames do not rise, or a pose does not fit the body.
    pub fn joint_trajectory(&self, poses: &PoseTable, rate: f64) -> Result<PointTrajectory> {
        self.trajectory(self.joint_names(), poses, rate, Self::joint_positions)
    }

    /// The virtual markers over the frames of a pose table, as [`Self::joint_trajectory`].
    ///
    /// # Errors
    /// As [`Self::joint_trajectory`].
    pub fn marker_trajectory(&self, poses: &PoseTable, rate: f64) -> Result<PointTrajectory> {
        self.trajectory(self.marker_names(), poses, rate, Self::marker_positions)
    }

    pub(super) fn trajectory(
        &self,
        names: Vec<String>,
        poses: &PoseTable,
        rate: f64,
        positions: impl Fn(&Self, &[DAffine3]) -> Vec<DVec3>,
    ) -> Result<PointTrajectory> {
        let (Some(&first), Some(&last)) = (poses.frames.first(), poses.frames.last()) else {
            anyhow::bail!("there are no poses to make a trajectory of");
        };
        if let Some(pair) = poses.frames.windows(2).find(|pair| pair[0] >= pair[1]) {
            anyhow::bail!("frame {} follows frame {}, expected rising frames in a trajectory", pair[1], pair[0]);
        }
        let length = last - first;
        ensure!(length < LONGEST_TRAJECTORY, "the frames {first} to {last} are too far apart for a trajectory");
        let mut frames = vec![vec![None; names.len()]; length + 1];
        let mut bones = Vec::new();
        for (frame, pose) in poses.frames.iter().zip(&poses.poses) {
            self.world_from_bones_into(pose, &mut bones)?;
            frames[frame - first] = positions(self, &bones).into_iter().map(Some).collect();
        }
        Ok(PointTrajectory { names, rate, first_frame: first, frames, smoothed: None })
    }

    /// The rest pose (every value 0, or the limit nearest to it) stood on the floor z = 0: where the root can move along
    /// z, so that the lowest end of a part touches the floor.
    pub fn standing_pose(&self) -> Vec<f64> {
        let mut pose: Vec<f64> = self.dofs().map(|(_, dof)| 0.0_f64.clamp(dof.limits[0], dof.limits[1])).collect();
        if let (Some(lift), Ok(bones)) = (self.root_dof(super::DofAxis::Tz), self.world_from_bones(&pose)) {
            let lowest = |at: DVec3, axis: DVec3, radius: f64| {
                // The disc of a cone's end reaches down by its radius times the sine of the axis with the vertical.
                at.z - radius * (1.0 - axis.z * axis.z).max(0.0).sqrt()
            };
            let floor = self.parts.iter().map(|part| {
                let (a, b) = (bones[part.bone].transform_point3(part.a), bones[part.bone].transform_point3(part.b));
                let axis = (b - a).normalize_or_zero();
                lowest(a, axis, part.radius_a).min(lowest(b, axis, part.radius_b))
            });
            let floor = floor.fold(f64::INFINITY, f64::min);
            let limits = self.dofs().nth(lift).map_or([0.0; 2], |(_, dof)| dof.limits);
            if floor.is_finite() {
                pose[lift] = (pose[lift] - floor).clamp(limits[0], limits[1]);
            }
        }
        pose
    }
}

#[cfg(test)]
pub(super) mod tests {
    use glam::{DMat4, DVec4};
    use proptest::prelude::*;

    use super::*;
    use crate::body::{Dof, DofAxis, Part, parse_body};

    /// Bone matrices from the definition: a product of elementary 4x4 matrices up to the root, written out by entries.
    fn naive(body: &Body, bone: usize, pose: &[f64]) -> DMat4 {
        let first: usize = body.bones[..bone].iter().map(|bone| bone.dofs.len()).sum();
        let value = |axis: DofAxis| {
            body.bones[bone].dofs.iter().position(|dof| dof.axis == axis).map_or(0.0, |index| pose[first + index])
        };
        let o = body.bones[bone].offset;
        let t = [o.x + value(DofAxis::Tx), o.y + value(DofAxis::Ty), o.z + value(DofAxis::Tz)];
        let mut local = rows([[1.0, 0.0, 0.0, t[0]], [0.0, 1.0, 0.0, t[1]], [0.0, 0.0, 1.0, t[2]]]);
        for axis in body.bones[bone].order.axes() {
            let angle = value(DofAxis::ALL[3 + axis]);
            let (s, c) = (angle.sin(), angle.cos());
            local *= match axis {
                0 => rows([[1.0, 0.0, 0.0, 0.0], [0.0, c, -s, 0.0], [0.0, s, c, 0.0]]),
                1 => rows([[c, 0.0, s, 0.0], [0.0, 1.0, 0.0, 0.0], [-s, 0.0, c, 0.0]]),
                _ => rows([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]),
            };
        }
        match body.bones[bone].parent {
            Some(parent) => naive(body, parent, pose) * local,
            None => local,
        }
    }

    fn rows(m: [[f64; 4]; 3]) -> DMat4 {
        DMat4::from_cols(
            DVec4::new(m[0][0], m[1][0], m[2][0], 0.0),
            DVec4::new(m[0][1], m[1][1], m[2][1], 0.0),
            DVec4::new(m[0][2], m[1][2], m[2][2], 0.0),
            DVec4::new(m[0][3], m[1][3], m[2][3], 1.0),
        )
    }

    /// Any tree, any degrees of freedom, any order of the bones in the file; written and read so that the loader's work
    /// is part of it. The pose comes with it.
    pub(crate) fn any_body() -> impl Strategy<Value = (Body, Vec<f64>)> {
        let bone = (any::<prop::sample::Index>(), prop::array::uniform3(-400.0..400.0), 0_u8..64, 0_usize..6);
        (prop::collection::vec(bone, 1..12), any::<u64>()).prop_flat_map(|(entries, shuffle)| {
            let count = entries.len();
            // Where each bone stands in the file: a permutation made from the shuffle's bits.
            let mut place: Vec<usize> = (0..count).collect();
            let mut state = shuffle;
            for index in (1..count).rev() {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                place.swap(index, (state >> 33) as usize % (index + 1));
            }
            let mut bones = vec![None; count];
            for (index, (parent, offset, mask, order)) in entries.into_iter().enumerate() {
                let dofs = DofAxis::ALL.into_iter().filter(|axis| mask >> axis.slot() & 1 == 1);
                let dofs = dofs.map(|axis| Dof { axis, limits: [-3.0, 3.0], step: 0.1 }).collect();
                bones[place[index]] = Some(Bone {
                    name: format!("bone_{index}"),
                    parent: (index > 0).then(|| place[parent.index(index)]),
                    offset: DVec3::from_array(offset),
                    order: EulerOrder::ALL[order],
                    dofs,
                });
            }
            let part = Part {
                name: "part".into(),
                bone: 0,
                a: DVec3::ZERO,
                b: DVec3::Z * 9.0,
                radius_a: 1.0,
                radius_b: 2.0,
                label: 5,
            };
            let bones = bones.into_iter().flatten().collect();
            let body = Body {
                name: "any".into(),
                bones,
                parts: vec![part],
                markers: vec![],
                mesh: None,
                update_order: vec![],
            };
            let body = parse_body(&body.to_toml(), "any.toml").unwrap();
            let dof_count = body.dof_count();
            (Just(body), prop::collection::vec(-3.0..3.0, dof_count))
        })
    }

    proptest! {
        #[test]
        fn closed_form_is_the_product_of_elementary_matrices((body, pose) in any_body()) {
            let bones = body.world_from_bones(&pose).unwrap();
            for (index, matrix) in bones.iter().enumerate() {
                let expected = naive(&body, index, &pose);
                prop_assert!(DMat4::from(*matrix).abs_diff_eq(expected, 1e-9), "bone {index}: {matrix} {expected}");
            }
        }

        #[test]
        fn parents_precede_children((body, _) in any_body()) {
            let mut done = vec![false; body.bones.len()];
            for &index in &body.update_order {
                prop_assert!(body.bones[index].parent.is_none_or(|parent| done[parent]));
                done[index] = true;
            }
            prop_assert!(done.into_iter().all(|done| done));
        }
    }

    #[test]
    fn a_wrong_angle_is_noticed() {
        // The sabotage of the comparison above: one angle off by a hair must be outside its tolerance.
        let body = Body::adult(1750.0).unwrap();
        let mut pose = body.standing_pose();
        let good = naive(&body, 4, &pose);
        pose[4] += 1e-6;
        assert!(!DMat4::from(body.world_from_bones(&pose).unwrap()[4]).abs_diff_eq(good, 1e-9));
    }

    #[test]
    fn poses_that_do_not_fit_are_refused() {
        let body = Body::adult(1750.0).unwrap();
        let error = body.world_from_bones(&[0.0; 30]).unwrap_err().to_string();
        assert!(error.contains("30 values") && error.contains("expected 31"), "{error}");
        let mut pose = body.standing_pose();
        pose[7] = f64::NAN;
        let error = body.world_from_bones(&pose).unwrap_err().to_string();
        assert!(error.contains("thorax.rz") && error.contains("NaN"), "{error}");
    }

    #[test]
    fn trajectories_have_the_names_and_the_gaps() {
        let body = Body::adult(1750.0).unwrap();
        let pose = body.standing_pose();
        let mut table = PoseTable { frames: vec![3, 5], poses: vec![pose.clone(), pose] };
        let joints = body.joint_trajectory(&table, 25.0).unwrap();
        assert_eq!((joints.first_frame, joints.frames.len(), joints.names.len()), (3, 3, 20));
        assert!(joints.frames[1].iter().all(Option::is_none), "frame 4 was never posed");
        assert!(joints.frames[2].iter().all(Option::is_some));
        assert_eq!(joints.names[15..], ["left_ankle", "right_ankle", "left_wrist", "right_wrist", "head_top"]);
        assert_eq!(body.marker_trajectory(&table, 25.0).unwrap().names[4], "C7");
        table.frames = vec![5, 5];
        let error = body.joint_trajectory(&table, 25.0).unwrap_err().to_string();
        assert!(error.contains("frame 5 follows frame 5"), "{error}");
        table.frames = vec![0, usize::MAX];
        assert!(body.joint_trajectory(&table, 25.0).unwrap_err().to_string().contains("too far apart"));
        let none = PoseTable::default();
        assert!(body.joint_trajectory(&none, 25.0).unwrap_err().to_string().contains("no poses"));
    }

    #[test]
    fn a_body_with_ankles_keeps_its_own() {
        let mut text = Body::adult(1750.0).unwrap().to_toml();
        text.push_str("[[bone]]\nname = \"left_ankle\"\nparent = \"left_knee\"\noffset = [0, 0, -400]\n");
        let body = parse_body(&text, "ankles.toml").unwrap();
        assert_eq!(body.joint_names().iter().filter(|name| *name == "left_ankle").count(), 1);
        let bones = body.world_from_bones(&vec![0.0; 31]).unwrap();
        let joints = body.joint_positions(&bones);
        assert_eq!(joints.len(), body.joint_names().len());
        assert_eq!(joints[15].z, -829.0, "the bone's origin, not the end of the calf");
    }
}
