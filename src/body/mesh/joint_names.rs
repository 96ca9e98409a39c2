//! Which joint of a skinned file is which bone of a body, by the names that modelling programs give them.

use anyhow::{Result, anyhow, bail, ensure};
use glam::DVec3;

use super::gltf_file::Joint;
use crate::body::Body;
use crate::files::{expected, listed};

/// Names of joints by bone or free end, both without their side, words run together; the first that a file has counts.
/// Mixamo and CMU say Shoulder for the clavicle and Arm for the upper arm; SMPL says Collar and Shoulder.
const LIMBS: [(&str, &[&str]); 7] = [
    ("hip", &["upleg", "upperleg", "thigh", "hip", "femur"]),
    ("knee", &["leg", "lowerleg", "calf", "shin", "knee", "tibia"]),
    ("ankle", &["foot", "ankle"]),
    ("shoulder", &["arm", "upperarm", "uparm", "humerus", "shoulder"]),
    ("elbow", &["forearm", "lowerarm", "elbow"]),
    ("wrist", &["hand", "wrist"]),
    ("clavicle", &["clavicle", "collar", "collarbone", "shoulder"]),
];

/// The same for the trunk, where files cut a spine and a neck into any number of joints: the one nearest to where the body
/// bends counts.
const TRUNK: [(&str, &[&str]); 3] = [
    ("pelvis", &["hips", "pelvis", "hip", "root"]),
    (
        "thorax",
        &["lowerback", "spine", "spine0", "spine1", "spine2", "spine3", "chest", "upperchest", "abdomen", "torso"],
    ),
    ("head", &["neck", "neck0", "neck1", "neck2", "neck3", "head"]),
];

/// Words of names that only say whose rig it is.
const FILLERS: [&str; 14] = [
    "mixamorig",
    "bip",
    "bip01",
    "bip001",
    "j",
    "c",
    "def",
    "org",
    "cc",
    "base",
    "skeleton",
    "armature",
    "joint",
    "jnt",
];

/// The joints of bones and free ends.
#[derive(Clone, Debug)]
pub(super) struct JointMap {
    /// The joint of each bone of the body, in file order.
    pub(super) of_bone: Vec<Option<usize>>,
    /// The joint of each free end, in the order of [`Body::free_ends`].
    pub(super) of_end: Vec<Option<usize>>,
}

impl JointMap {
    /// Limbs, and whatever `asked` (`[mesh.bones]`: bone or free end, joint) names. A name that the file gives to several joints
    /// is taken by the first.
    ///
    /// # Errors
    /// When `asked` names a joint that is not there.
    pub(super) fn of_limbs<'a>(
        body: &Body,
        joints: &[Joint],
        asked: impl Iterator<Item = (&'a String, &'a String)>,
    ) -> Result<Self> {
        let ends = body.free_ends();
        let names: Vec<&str> =
            body.bones.iter().map(|bone| bone.name.as_str()).chain(ends.iter().map(|end| end.name)).collect();
        let mut found: Vec<Option<usize>> = vec![None; names.len()];
        for (name, joint) in asked {
            let known: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
            let index = known.iter().position(|known| known == joint);
            let index = index.ok_or_else(|| {
                anyhow!("`{name}` is given the joint `{joint}`, which is none, {}", expected(joint, &known))
            })?;
            if let Some(place) = names.iter().position(|known| known == name) {
                found[place] = Some(index);
            }
        }
        let plain: Vec<(Option<bool>, String)> = joints.iter().map(|joint| plain(&joint.name)).collect();
        // In the order of the table, so that a Shoulder which is the upper arm's is not the clavicle's too.
        for (core, aliases) in LIMBS {
            for (place, name) in names.iter().enumerate() {
                let (side, words) = self::plain(name);
                if found[place].is_some() || words != core {
                    continue;
                }
                found[place] = aliases.iter().find_map(|alias| {
                    let joint = plain.iter().position(|(other, words)| *other == side && words == alias)?;
                    (!found.contains(&Some(joint))).then_some(joint)
                });
            }
        }
        let of_end = found.split_off(body.bones.len());
        Ok(Self { of_bone: found, of_end })
    }

    /// The bones of the trunk, and those that have the very name of a joint. `places` are the joints' positions laid over
    /// the body at rest, `origins` those of its bones.
    ///
    /// # Errors
    /// When a bone that has a part is left without a joint, or two share one.
    pub(super) fn add_trunk(
        &mut self,
        body: &Body,
        joints: &[Joint],
        places: &[DVec3],
        origins: &[DVec3],
    ) -> Result<()> {
        for (index, bone) in body.bones.iter().enumerate() {
            if self.of_bone[index].is_some() {
                continue;
            }
            let (side, words) = plain(&bone.name);
            let aliases = TRUNK.iter().find(|(core, _)| *core == words).map_or(&[][..], |(_, aliases)| aliases);
            let is_named = |joint: usize| {
                let (other, name) = plain(&joints[joint].name);
                other == side && (name == words || aliases.contains(&name.as_str()))
            };
            let distance = |joint: &usize| places[*joint].distance_squared(origins[index]);
            self.of_bone[index] = (0..joints.len())
                .filter(|&joint| is_named(joint) && !self.of_bone.contains(&Some(joint)))
                .min_by(|l, r| distance(l).total_cmp(&distance(r)));
        }
        let has_part = |bone: usize| body.parts.iter().any(|part| part.bone == bone);
        let lost: Vec<String> = (0..body.bones.len())
            .filter(|&bone| self.of_bone[bone].is_none() && has_part(bone))
            .map(|bone| format!("`{}`", body.bones[bone].name))
            .collect();
        if !lost.is_empty() {
            let free = joints.iter().enumerate().filter(|(at, _)| !self.of_bone.contains(&Some(*at)));
            let known = listed(free.map(|(_, joint)| &joint.name));
            bail!(
                "no joint of it is known to be {}, expected [mesh.bones] or --bone to name it (other joints: {known})",
                listed(&lost)
            );
        }
        for (index, joint) in self.of_bone.iter().enumerate() {
            let twin = self.of_bone[..index].iter().position(|other| joint.is_some() && other == joint);
            if let (Some(twin), Some(joint)) = (twin, joint) {
                bail!(
                    "the bones `{}` and `{}` both have the joint `{}`, expected a joint of its own",
                    body.bones[twin].name,
                    body.bones[index].name,
                    joints[*joint].name
                );
            }
        }
        Ok(())
    }

    /// The bone that each joint moves with: that of the nearest joint at or above it which has one, else the root.
    pub(super) fn bone_of_joints(&self, joints: &[Joint], root: usize) -> Result<Vec<usize>> {
        (0..joints.len())
            .map(|joint| {
                let mut at = Some(joint);
                for _ in 0..=joints.len() {
                    let Some(joint) = at else { return Ok(root) };
                    if let Some(bone) = self.of_bone.iter().position(|own| *own == Some(joint)) {
                        return Ok(bone);
                    }
                    at = joints[joint].parent;
                }
                ensure!(at.is_none(), "its joints form a cycle, expected a tree");
                Ok(root)
            })
            .collect()
    }
}

/// A name as (side, words run together in lower case): left is `Some(true)`. `mixamorig:LeftUpLeg`, `J_Bip_L_UpperLeg` and
/// `upper_leg.L` are all left and end as `upleg` or `upperleg`.
pub(crate) fn plain(name: &str) -> (Option<bool>, String) {
    let mut words: Vec<String> = Vec::new();
    let mut before = ' ';
    let mut characters = name.rsplit([':', '|']).next().unwrap_or(name).chars().peekable();
    while let Some(character) = characters.next() {
        let next_is_small = characters.peek().is_some_and(char::is_ascii_lowercase);
        let begins = !before.is_alphanumeric()
            || (character.is_ascii_uppercase() && (before.is_ascii_lowercase() || next_is_small));
        if character.is_alphanumeric() {
            if begins {
                words.push(String::new());
            }
            if let Some(word) = words.last_mut() {
                word.extend(character.to_lowercase());
            }
        }
        before = character;
    }
    let mut side = None;
    words.retain(|word| {
        match word.as_str() {
            "l" | "left" => side = Some(true),
            "r" | "right" => side = Some(false),
            word => return !FILLERS.contains(&word),
        }
        false
    });
    // spine_01 is spine1.
    let words = words.iter().map(|word| if word.len() > 1 { word.trim_start_matches('0') } else { word });
    (side, words.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_programs_are_the_same_words() {
        for (name, side, words) in [
            ("mixamorig:LeftUpLeg", Some(true), "upleg"),
            ("J_Bip_L_UpperLeg", Some(true), "upperleg"),
            ("thigh.L", Some(true), "thigh"),
            ("upper_arm.R", Some(false), "upperarm"),
            ("calf_r", Some(false), "calf"),
            ("L_Hip", Some(true), "hip"),
            ("LHipJoint", Some(true), "hip"),
            ("RightForeArm", Some(false), "forearm"),
            ("Armature|spine_01", None, "spine1"),
            ("Hips", None, "hips"),
            ("left_clavicle", Some(true), "clavicle"),
            ("", None, ""),
        ] {
            assert_eq!(plain(name), (side, words.to_string()), "{name}");
        }
    }

    /// Joints of the limbs by the names of a program, in the order hip, knee, ankle, clavicle, shoulder, elbow, wrist.
    #[test]
    fn limbs_are_found_by_the_names_of_four_programs() {
        let body = Body::adult(1750.0).unwrap();
        for names in [
            ["LeftUpLeg", "LeftLeg", "LeftFoot", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"],
            ["L_Hip", "L_Knee", "L_Ankle", "L_Collar", "L_Shoulder", "L_Elbow", "L_Wrist"],
            ["thigh.L", "shin.L", "foot.L", "shoulder.L", "upper_arm.L", "forearm.L", "hand.L"],
            ["thigh_l", "calf_l", "foot_l", "clavicle_l", "upperarm_l", "lowerarm_l", "hand_l"],
        ] {
            let joints = names.map(|name| Joint { name: name.to_string(), parent: None, at: DVec3::ZERO });
            let map = JointMap::of_limbs(&body, &joints, std::iter::empty()).unwrap();
            let of = |name: &str| map.of_bone[body.bone_index(name).unwrap()];
            let ends = body.free_ends();
            let end = |name: &str| map.of_end[ends.iter().position(|end| end.name == name).unwrap()];
            let found = [
                of("left_hip"),
                of("left_knee"),
                end("left_ankle"),
                of("left_clavicle"),
                of("left_shoulder"),
                of("left_elbow"),
                end("left_wrist"),
            ];
            assert_eq!(found, [0, 1, 2, 3, 4, 5, 6].map(Some), "{names:?}");
            assert_eq!(of("right_hip"), None);
        }
    }
}
