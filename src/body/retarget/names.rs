//! Which joint of a recording is which bone of a body.

use std::collections::BTreeMap;

use anyhow::{Result, anyhow, bail};
use glam::DVec3;

use crate::body::Body;
use crate::body::mesh::plain_name;
use crate::files::{expected, listed};
use crate::motion::SkeletalMotion;

/// Names of joints by bone or free end, without their side, words run together; the first that a recording has counts.
/// The limbs come first, so that a Shoulder which is the upper arm's is not the clavicle's too.
const ALIASES: [(&str, &[&str]); 9] = [
    ("hip", &["upleg", "upperleg", "thigh", "femur", "hip"]),
    ("knee", &["leg", "lowerleg", "calf", "shin", "tibia", "knee"]),
    ("ankle", &["foot", "ankle"]),
    ("shoulder", &["arm", "upperarm", "uparm", "humerus", "shldr", "shoulder"]),
    ("elbow", &["forearm", "lowerarm", "radius", "elbow"]),
    ("wrist", &["wrist", "hand"]),
    ("clavicle", &["clavicle", "collar", "collarbone", "shoulder"]),
    ("pelvis", &["hips", "pelvis", "hip", "root"]),
    ("head", &["head", "neck", "neck1", "neck2"]),
];

/// Joints that touch the floor before anything else does.
const FEET: [&str; 8] = ["foot", "ankle", "toe", "toes", "toebase", "ball", "foot_end", "toes_end"];

/// Bones of the trunk, which keep the recording's turns as they are: at rest trunks are all upright.
const TRUNK: [&str; 4] = ["pelvis", "thorax", "clavicle", "head"];

/// The joints of a body's bones and free ends.
pub(super) struct JointNames {
    /// The joint of each bone, in file order.
    pub(super) of_bone: Vec<Option<usize>>,
    /// The joint of each free end, in the order of [`Body::free_ends`].
    of_end: Vec<Option<usize>>,
    /// The joint that the root follows.
    pub(super) pelvis: usize,
    /// Joints of the feet.
    pub(super) feet: Vec<usize>,
}

/// A name's side and words; `lfemur` too is the left femur.
fn sided(name: &str) -> (Option<bool>, String) {
    let (side, words) = plain_name(name);
    if side.is_none() {
        for (letter, is_left) in [("l", true), ("r", false)] {
            let rest = words.strip_prefix(letter).unwrap_or_default();
            let known = ALIASES.iter().flat_map(|(_, names)| *names).chain(&FEET).any(|alias| *alias == rest);
            if known {
                return (Some(is_left), rest.to_string());
            }
        }
    }
    (side, words)
}

impl JointNames {
    pub(super) fn find(body: &Body, motion: &SkeletalMotion, asked: &BTreeMap<String, String>) -> Result<Self> {
        let ends = body.free_ends();
        let places: Vec<&str> =
            body.bones.iter().map(|bone| bone.name.as_str()).chain(ends.iter().map(|end| end.name)).collect();
        let known: Vec<&str> = motion.joints.iter().map(|joint| joint.name.as_str()).collect();
        let mut found: Vec<Option<usize>> = vec![None; places.len()];
        for (place, joint) in asked {
            let index = known.iter().position(|name| name == joint).ok_or_else(|| {
                anyhow!(
                    "`{place}` is given the joint `{joint}`, which the motion does not have, {}",
                    expected(joint, &known)
                )
            })?;
            let place = places.iter().position(|name| name == place).ok_or_else(|| {
                anyhow!("a joint is given to `{place}`, which is no bone, {}", expected(place, &places))
            })?;
            found[place] = Some(index);
        }
        let plain: Vec<(Option<bool>, String)> = motion.joints.iter().map(|joint| sided(&joint.name)).collect();
        // The very name first: a body's own motion has all of them.
        for (place, name) in places.iter().enumerate() {
            found[place] = found[place].or_else(|| known.iter().position(|other| other == name));
        }
        for (core, aliases) in ALIASES {
            for (place, name) in places.iter().enumerate() {
                let (side, words) = plain_name(name);
                if found[place].is_some() || words != core {
                    continue;
                }
                found[place] = aliases.iter().find_map(|alias| {
                    let is_it = |joint: usize| plain[joint].0 == side && plain[joint].1 == *alias;
                    (0..plain.len()).find(|&joint| is_it(joint) && !found.contains(&Some(joint)))
                });
            }
        }
        let of_end = found.split_off(body.bones.len());
        let mut names = Self { of_bone: found, of_end, pelvis: 0, feet: Vec::new() };
        names.add_ends(body, motion);
        names.add_thorax(body, motion);
        names.check(body, motion)?;
        names.pelvis = body.update_order.first().and_then(|&root| names.of_bone[root]).unwrap_or(0);
        names.feet = (0..plain.len())
            .filter(|&joint| plain[joint].0.is_some() && FEET.contains(&plain[joint].1.as_str()))
            .collect();
        if names.feet.is_empty() {
            names.feet = names.of_end.iter().flatten().copied().collect();
        }
        Ok(names)
    }

    /// A limb that ends without a name for its end ends where its last joint's free end is.
    fn add_ends(&mut self, body: &Body, motion: &SkeletalMotion) {
        for (end, joint) in body.free_ends().iter().zip(&mut self.of_end) {
            if let (None, Some(last)) = (&joint, self.of_bone[end.bone]) {
                *joint = motion.joints.iter().position(|other| other.is_end && other.parent == Some(last));
            }
        }
    }

    /// A thorax is what both arms hang on, however many joints a spine is cut into.
    fn add_thorax(&mut self, body: &Body, motion: &SkeletalMotion) {
        let Some(thorax) = body.bone_index("thorax").filter(|&bone| self.of_bone[bone].is_none()) else { return };
        let arm = |side: &str| {
            let arm = ["clavicle", "shoulder"]
                .iter()
                .find_map(|bone| body.bone_index(&format!("{side}_{bone}")).and_then(|bone| self.of_bone[bone]))?;
            Some(std::iter::successors(Some(arm), |&joint| motion.joints[joint].parent).skip(1).collect::<Vec<_>>())
        };
        if let (Some(left), Some(right)) = (arm("left"), arm("right")) {
            self.of_bone[thorax] = left.into_iter().find(|joint| right.contains(joint));
        }
    }

    /// Every bone that turns needs a joint, but clavicles, which many recordings do without.
    fn check(&self, body: &Body, motion: &SkeletalMotion) -> Result<()> {
        let can_do_without = |name: &str| name.ends_with("clavicle");
        let lost: Vec<&str> = body
            .bones
            .iter()
            .zip(&self.of_bone)
            .filter(|(bone, joint)| joint.is_none() && !bone.dofs.is_empty() && !can_do_without(&bone.name))
            .map(|(bone, _)| bone.name.as_str())
            .collect();
        if !lost.is_empty() {
            let is_free = |at: usize| !self.of_bone.contains(&Some(at));
            let all = motion.joints.iter().enumerate().filter(|(_, joint)| !joint.is_end);
            let known = all.filter(|(at, _)| is_free(*at)).map(|(_, joint)| &joint.name);
            bail!(
                "the motion has no joint that is known to be {}, expected `joints` to name it (other joints: {})",
                listed(lost.iter().map(|name| format!("`{name}`"))),
                listed(known)
            );
        }
        Ok(())
    }

    fn joint(&self, body: &Body, name: &str) -> Result<usize> {
        let ends = body.free_ends();
        let bone = body.bone_index(name).and_then(|bone| self.of_bone[bone]);
        let end = || ends.iter().position(|end| end.name == name).and_then(|end| self.of_end[end]);
        bone.or_else(end).ok_or_else(|| anyhow!("the motion has no joint that is known to be `{name}`"))
    }

    /// The middle of the hips and the head among points of the recording's joints.
    pub(super) fn trunk(&self, body: &Body, points: &[DVec3]) -> Result<(DVec3, DVec3)> {
        let at = |name| Ok::<_, anyhow::Error>(points[self.joint(body, name)?]);
        Ok((0.5 * (at("left_hip")? + at("right_hip")?), at("head")?))
    }

    /// From the right hip to the left one.
    pub(super) fn across(&self, body: &Body, points: &[DVec3]) -> Result<DVec3> {
        Ok(points[self.joint(body, "left_hip")?] - points[self.joint(body, "right_hip")?])
    }

    /// Length of the left leg from hip to ankle among points of the recording's joints.
    pub(super) fn leg_of_joints(&self, body: &Body, points: &[DVec3]) -> Result<f64> {
        let [hip, knee, ankle] =
            [self.joint(body, "left_hip")?, self.joint(body, "left_knee")?, self.joint(body, "left_ankle")?]
                .map(|j| points[j]);
        long(hip.distance(knee) + knee.distance(ankle))
    }

    /// The same of the body.
    pub(super) fn leg(&self, body: &Body, origins: &[DVec3], ends: &[DVec3]) -> Result<f64> {
        let bone = |name: &str| body.bone_index(name).map(|bone| origins[bone]);
        let end = body.free_ends().iter().position(|end| end.name == "left_ankle").map(|end| ends[end]);
        match (bone("left_hip"), bone("left_knee"), end.or_else(|| bone("left_ankle"))) {
            (Some(hip), Some(knee), Some(ankle)) => long(hip.distance(knee) + knee.distance(ankle)),
            _ => bail!("the body `{}` lacks a left_hip, left_knee or left_ankle", body.name),
        }
    }

    /// Where a limb's bone ends in the body at rest, and the joint there.
    pub(super) fn follower(
        &self,
        body: &Body,
        bone: usize,
        origins: &[DVec3],
        ends: &[DVec3],
    ) -> Option<(DVec3, usize)> {
        let (_, words) = plain_name(&body.bones[bone].name);
        if TRUNK.contains(&words.as_str()) || body.bones[bone].parent.is_none() {
            return None;
        }
        let above = |index: usize| {
            std::iter::successors(body.bones[index].parent, |&at| body.bones[at].parent)
                .find(|&at| self.of_bone[at].is_some())
        };
        let bones = (0..body.bones.len())
            .filter(|&index| above(index) == Some(bone))
            .filter_map(|index| Some((origins[index], self.of_bone[index]?)));
        let free = body.free_ends();
        let free = free.iter().enumerate().filter(|(_, end)| end.bone == bone);
        let all: Vec<(DVec3, usize)> =
            bones.chain(free.filter_map(|(index, _)| Some((ends[index], self.of_end[index]?)))).collect();
        if let [one] = all[..] { Some(one) } else { None }
    }
}

fn long(length: f64) -> Result<f64> {
    if length.is_finite() && length > 1e-6 { Ok(length) } else { bail!("a leg is {length} long, expected more than 0") }
}
