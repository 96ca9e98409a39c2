//! A pose as Unity's humanoid bones have it: which of our joints each is, how it stands in a T-pose, and its local rotation from there.

use anyhow::{Result, ensure};
use glam::{DAffine3, DQuat, DVec3};

use crate::body::Body;
use crate::files::listed;

/// Where a limb points in a T-pose, in our axes (x forward, y left, z up).
const DOWN: DVec3 = DVec3::NEG_Z;
const LEFT: DVec3 = DVec3::Y;
const RIGHT: DVec3 = DVec3::NEG_Y;

/// A bone of Unity: its name among the `HumanBodyBones`, our joint, the bone that it hangs on, and of a limb the joint at its other end
/// and where it points in a T-pose.
struct Row(&'static str, &'static str, &'static str, Option<(&'static str, DVec3)>);

/// Parents first. Unity's Chest, UpperChest, Neck and toes have nothing of their own here, so they are left as the avatar has them.
const ROWS: [Row; 17] = [
    Row("Hips", "pelvis", "", None),
    Row("Spine", "thorax", "Hips", None),
    Row("Head", "head", "Spine", None),
    Row("LeftUpperLeg", "left_hip", "Hips", Some(("left_knee", DOWN))),
    Row("LeftLowerLeg", "left_knee", "LeftUpperLeg", Some(("left_ankle", DOWN))),
    Row("LeftFoot", "left_ankle", "LeftLowerLeg", None),
    Row("RightUpperLeg", "right_hip", "Hips", Some(("right_knee", DOWN))),
    Row("RightLowerLeg", "right_knee", "RightUpperLeg", Some(("right_ankle", DOWN))),
    Row("RightFoot", "right_ankle", "RightLowerLeg", None),
    Row("LeftShoulder", "left_clavicle", "Spine", None),
    Row("LeftUpperArm", "left_shoulder", "LeftShoulder", Some(("left_elbow", LEFT))),
    Row("LeftLowerArm", "left_elbow", "LeftUpperArm", Some(("left_wrist", LEFT))),
    Row("LeftHand", "left_wrist", "LeftLowerArm", None),
    Row("RightShoulder", "right_clavicle", "Spine", None),
    Row("RightUpperArm", "right_shoulder", "RightShoulder", Some(("right_elbow", RIGHT))),
    Row("RightLowerArm", "right_elbow", "RightUpperArm", Some(("right_wrist", RIGHT))),
    Row("RightHand", "right_wrist", "RightLowerArm", None),
];

/// A bone of Unity's at a pose, in Unity's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UnityBone {
    /// Its name among the `HumanBodyBones`.
    pub(super) name: &'static str,
    /// Its origin from its parent's in the parent's axes, m; in the world for a bone without one.
    pub(super) position: [f64; 3],
    /// Its rotation against its parent, the identity in a T-pose: x, y, z, w.
    pub(super) rotation: [f64; 4],
}

/// A bone that a body has.
#[derive(Clone, Copy, Debug)]
struct Mapped {
    name: &'static str,
    /// Index of the joint in [`Body::joint_names`].
    joint: usize,
    /// Index of the bone that turns with it.
    bone: usize,
    /// Index of its parent among the mapped.
    parent: Option<usize>,
    /// What turns our rest pose, arms hanging, to the T-pose.
    t_pose: DQuat,
}

/// The bones of Unity that a body has.
pub(super) struct UnityBones {
    body: Body,
    mapped: Vec<Mapped>,
}

impl UnityBones {
    /// Those of a body, found by the names of its joints.
    ///
    /// # Errors
    /// When it has none of them.
    pub(super) fn of(body: &Body) -> Result<Self> {
        let ends = body.free_ends();
        let rest = body.joint_positions(&body.world_from_bones(&vec![0.0; body.dof_count()])?);
        let mut mapped: Vec<Mapped> = Vec::new();
        for Row(name, joint, parent, limb) in &ROWS {
            let Some(joint) = body.joint_index(joint) else { continue };
            let parent = nearest_parent(parent, &mapped);
            let bone = joint.checked_sub(body.bones.len()).map_or(joint, |end| ends[end].bone);
            let before = parent.map_or(DQuat::IDENTITY, |parent| mapped[parent].t_pose);
            let t_pose = match limb {
                Some((tip, towards)) => {
                    let along = body.joint_index(tip).map(|tip| rest[tip] - rest[joint]).and_then(DVec3::try_normalize);
                    turned(along, *towards)
                }
                None if is_end(name) => before,
                None => DQuat::IDENTITY,
            };
            mapped.push(Mapped { name, joint, bone, parent, t_pose });
        }
        let known: Vec<&str> = ROWS.iter().map(|row| row.1).collect();
        ensure!(
            !mapped.is_empty(),
            "the body `{}` has no joint that VMC has a bone for, expected some of {}",
            body.name,
            listed(&known)
        );
        Ok(Self { body: body.clone(), mapped })
    }

    /// All of them at a pose (mm, radians).
    ///
    /// # Errors
    /// When the pose does not fit the body.
    pub(super) fn at(&self, pose: &[f64]) -> Result<Vec<UnityBone>> {
        let bones = self.body.world_from_bones(pose)?;
        let joints = self.body.joint_positions(&bones);
        let world = |mapped: &Mapped| {
            let turned: &DAffine3 = &bones[mapped.bone];
            (joints[mapped.joint], DQuat::from_mat3(&turned.matrix3) * mapped.t_pose.inverse())
        };
        let local = |mapped: &Mapped| {
            let (at, turn) = world(mapped);
            let (at, turn) = match mapped.parent.map(|parent| world(&self.mapped[parent])) {
                Some((from, parent)) => (parent.inverse() * (at - from), parent.inverse() * turn),
                None => (at, turn),
            };
            UnityBone { name: mapped.name, position: unity_position(at), rotation: unity_rotation(turn) }
        };
        Ok(self.mapped.iter().map(local).collect())
    }
}

/// The first of a bone's ancestors that is there.
fn nearest_parent(parent: &str, mapped: &[Mapped]) -> Option<usize> {
    let mut name = parent;
    loop {
        if let Some(at) = mapped.iter().position(|bone| bone.name == name) {
            return Some(at);
        }
        name = ROWS.iter().find(|row| row.0 == name)?.2;
    }
}

/// Whether a bone is the end of a limb, which it follows into the T-pose.
fn is_end(name: &str) -> bool {
    name.ends_with("Hand") || name.ends_with("Foot")
}

/// What turns a limb of the rest pose, which points `along`, to where it points in a T-pose. Arms are lifted about the axis forward, so that
/// palms that face the thighs face the floor; what is left, where a limb does not hang straight, is the shortest way.
fn turned(along: Option<DVec3>, towards: DVec3) -> DQuat {
    let lift = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2 * towards.y);
    let rest = along.map_or(DQuat::IDENTITY, |along| DQuat::from_rotation_arc(lift * along, towards));
    rest * lift
}

/// mm, x forward, y left, z up; to m, x right, y up, z forward.
fn unity_position(at: DVec3) -> [f64; 3] {
    [-at.y, at.z, at.x].map(|value| value / 1e3)
}

/// The change of axes mirrors, so turns go the other way round.
fn unity_rotation(turn: DQuat) -> [f64; 4] {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    [turn.y, -turn.z, -turn.x, turn.w]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn body() -> Body {
        Body::adult(1750.0).unwrap()
    }

    fn set(body: &Body, pose: &mut [f64], name: &str, degrees: f64) {
        pose[body.dof_index(name).unwrap()] = degrees.to_radians();
    }

    fn bone(bones: &[UnityBone], name: &str) -> UnityBone {
        *bones.iter().find(|bone| bone.name == name).unwrap_or_else(|| panic!("no {name}"))
    }

    #[track_caller]
    fn near(found: &[f64], expected: &[f64]) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} is not {expected:?}");
    }

    #[test]
    fn a_t_pose_has_no_rotation_and_arms_to_the_sides() {
        let body = body();
        let unity = UnityBones::of(&body).unwrap();
        let mut pose = body.standing_pose();
        set(&body, &mut pose, "left_shoulder.rx", 90.0);
        set(&body, &mut pose, "right_shoulder.rx", -90.0);
        let bones = unity.at(&pose).unwrap();
        assert_eq!(bones.len(), ROWS.len());
        for bone in &bones {
            near(&bone.rotation, &[0.0, 0.0, 0.0, 1.0]);
        }
        // Left is negative x in Unity, up is y.
        near(&bone(&bones, "LeftLowerArm").position, &[-0.294, 0.0, 0.0]);
        near(&bone(&bones, "RightHand").position, &[bone(&bones, "RightHand").position[0], 0.0, 0.0]);
        assert!(bone(&bones, "RightHand").position[0] > 0.2);
        near(&bone(&bones, "LeftUpperLeg").position, &[-0.095, 0.0, 0.0]);
        near(&bone(&bones, "LeftLowerLeg").position, &[0.0, -0.429, 0.0]);
        let hips = bone(&bones, "Hips").position;
        assert!(hips[0] == 0.0 && hips[1] > 0.8 && hips[2] == 0.0, "{hips:?}");
    }

    #[test]
    fn turns_are_unitys() {
        let body = body();
        let unity = UnityBones::of(&body).unwrap();
        let half = std::f64::consts::FRAC_1_SQRT_2;
        // Arms hanging: in Unity, where z points forward and turns are left-handed, the left upper arm is turned by +90 degrees about z
        // (from -x down to -y), the right one by -90.
        let bones = unity.at(&body.standing_pose()).unwrap();
        near(&bone(&bones, "LeftUpperArm").rotation, &[0.0, 0.0, half, half]);
        near(&bone(&bones, "RightUpperArm").rotation, &[0.0, 0.0, -half, half]);
        near(&bone(&bones, "LeftLowerArm").rotation, &[0.0, 0.0, 0.0, 1.0]);
        // A quarter turn to the left is -90 degrees about Unity's y: its forward, z, goes to -x. A metre forward is z, to the left -x.
        let mut pose = body.standing_pose();
        (pose[0], pose[1]) = (1000.0, 500.0);
        set(&body, &mut pose, "pelvis.rz", 90.0);
        set(&body, &mut pose, "left_knee.ry", 90.0);
        let bones = unity.at(&pose).unwrap();
        let hips = bone(&bones, "Hips");
        near(&hips.rotation, &[0.0, -half, 0.0, half]);
        near(&[hips.position[0], hips.position[2]], &[-0.5, 1.0]);
        // A knee that is flexed by 90 degrees takes the shank from down to backwards: about x by +90, left-handed (-y to -z).
        near(&bone(&bones, "LeftLowerLeg").rotation, &[half, 0.0, 0.0, half]);
        near(&bone(&bones, "LeftFoot").rotation, &[0.0, 0.0, 0.0, 1.0]);
    }

    /// Turns a vector by a quaternion, both in Unity's frame: the formula is the same for either hand.
    fn turn(rotation: [f64; 4], at: DVec3) -> DVec3 {
        DQuat::from_array(rotation) * at
    }

    proptest! {
        /// Whoever chains positions and rotations as Unity does finds every joint where the body has it.
        #[test]
        fn a_receiver_finds_every_joint(values in prop::collection::vec(-1.0f64..1.0, 31)) {
            let body = body();
            let unity = UnityBones::of(&body).unwrap();
            let mut pose: Vec<f64> =
                body.dofs().zip(values).map(|((_, dof), v)| if dof.axis.is_rotation() { v } else { 1000.0 * v }).collect();
            body.clamp_to_limits(&mut pose);
            let joints = body.joint_positions(&body.world_from_bones(&pose).unwrap());
            let mut chained: Vec<(DVec3, DQuat)> = Vec::new();
            for (bone, mapped) in unity.at(&pose).unwrap().iter().zip(&unity.mapped) {
                let (at, rotation) = (DVec3::from_array(bone.position), DQuat::from_array(bone.rotation));
                let world = match mapped.parent.map(|parent| chained[parent]) {
                    Some((from, parent)) => (from + turn(parent.to_array(), at), parent * rotation),
                    None => (at, rotation),
                };
                let expected = DVec3::from_array(unity_position(joints[mapped.joint]));
                prop_assert!((world.0 - expected).length() < 1e-9, "{}: {} is not {expected}", bone.name, world.0);
                chained.push(world);
            }
        }
    }

    #[test]
    fn bodies_of_other_bones_send_those_they_have() {
        let load = |name: &str| Body::load(&std::path::Path::new("docs/bodies").join(name)).unwrap();
        let names =
            |body: &Body| -> Vec<&str> { UnityBones::of(body).unwrap().mapped.iter().map(|it| it.name).collect() };
        assert_eq!(names(&load("legs.toml"))[..3], ["Hips", "LeftUpperLeg", "LeftLowerLeg"]);
        let upper = load("upper_body.toml");
        assert_eq!(names(&upper)[..2], ["Spine", "Head"]);
        let unity = UnityBones::of(&upper).unwrap();
        assert!(unity.mapped[0].parent.is_none() && unity.mapped[1].parent == Some(0));
        let hand = load("hand.toml");
        let Err(error) = UnityBones::of(&hand) else { panic!("a hand has no bone of Unity's body") };
        assert!(
            error.to_string().contains("no joint that VMC has a bone for, expected some of pelvis, thorax"),
            "{error}"
        );
    }
}
