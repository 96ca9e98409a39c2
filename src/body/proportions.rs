//! The proportions of a grown person: symmetric factors on the lengths and girths of the default body.

use std::collections::BTreeMap;

use anyhow::{Result, ensure};
use glam::DVec3;

use super::{Body, without_side};
use crate::files::unknown;

/// One factor of [`Proportions`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proportion {
    /// What it stretches.
    pub name: &'static str,
    /// Standard deviation among grown people of one stature, as a fraction. Lengths: the anthropometric tables give 4 to
    /// 6 %; girths, which clothes add to, vary far more.
    pub deviation: f64,
    /// Smallest and largest sensible value.
    pub limits: [f64; 2],
}

const fn length(name: &'static str) -> Proportion {
    Proportion { name, deviation: 0.06, limits: [0.75, 1.25] }
}

const fn girth(name: &'static str) -> Proportion {
    Proportion { name, deviation: 0.2, limits: [0.55, 1.7] }
}

/// Factors on a body that has the bones and parts of [`Body::adult`], 1 for its own measures, in the order of
/// [`Proportions::ALL`]. Left and right share theirs.
#[derive(Clone, Debug, PartialEq)]
pub struct Proportions(pub [f64; Proportions::COUNT]);

impl Default for Proportions {
    fn default() -> Self {
        Self([1.0; Self::COUNT])
    }
}

impl Proportions {
    /// The number of factors.
    pub const COUNT: usize = 20;

    /// What each factor stretches.
    pub const ALL: [Proportion; Self::COUNT] = [
        length("trunk"),
        length("neck length"),
        length("head length"),
        length("shoulder width"),
        length("hip width"),
        length("upper arm"),
        length("forearm"),
        length("hand"),
        length("thigh"),
        length("calf"),
        length("foot"),
        girth("belly girth"),
        girth("chest girth"),
        girth("neck girth"),
        girth("head girth"),
        girth("upper arm girth"),
        girth("forearm girth"),
        girth("thigh girth"),
        girth("calf girth"),
        girth("foot girth"),
    ];

    /// Factors by their names, 1 where none is given.
    ///
    /// # Errors
    /// When a name is unknown (the nearest is named) or a factor is out of its range.
    pub fn named(factors: &BTreeMap<String, f64>) -> Result<Self> {
        let known = Self::ALL.map(|proportion| proportion.name);
        let mut proportions = Self::default();
        for (name, &factor) in factors {
            let Some(index) = known.iter().position(|known| known == name) else {
                return Err(unknown("proportion", name, &known));
            };
            let [low, high] = Self::ALL[index].limits;
            ensure!((low..=high).contains(&factor), "`{name}` is {factor}, expected {low} to {high}");
            proportions.0[index] = factor;
        }
        Ok(proportions)
    }

    /// A factor by its name; 1 where there is none of it.
    pub fn of(&self, name: &str) -> f64 {
        Self::ALL.iter().position(|known| known.name == name).map_or(1.0, |index| self.0[index])
    }

    /// The body so stretched; bones and parts of other names stay as they are.
    pub fn apply(&self, body: &Body) -> Body {
        let [
            trunk,
            neck,
            head,
            shoulders,
            hips,
            upper_arm,
            forearm,
            hand,
            thigh,
            calf,
            foot,
            belly_girth,
            chest_girth,
            neck_girth,
            head_girth,
            upper_arm_girth,
            forearm_girth,
            thigh_girth,
            calf_girth,
            foot_girth,
        ] = self.0;
        // Where one segment of a rigid pair ends and the next one begins, before stretching.
        let offset_z = |name: &str| body.bone_index(name).map_or(0.0, |bone| body.bones[bone].offset.z);
        let end_z = |name: &str| body.parts.iter().find(|part| part.name == name).map_or(0.0, |part| part.b.z);
        let (shoulder_z, wrist_z, ankle_z) = (offset_z("left_clavicle"), end_z("left_forearm"), end_z("left_calf"));
        let above = |z: f64, joint: f64, below: f64, beyond: f64| {
            if z.abs() <= joint.abs() { z * below } else { joint * below + (z - joint) * beyond }
        };
        let stretched = |bone: &str, at: DVec3| match without_side(bone) {
            "pelvis" => DVec3::new(at.x, at.y, at.z * trunk),
            "thorax" => DVec3::new(at.x, at.y, above(at.z, shoulder_z, trunk, neck)),
            "head" => DVec3::new(at.x, at.y, at.z * head),
            "clavicle" => DVec3::new(at.x, at.y * shoulders, at.z),
            "shoulder" => DVec3::new(at.x, at.y, at.z * upper_arm),
            "elbow" => DVec3::new(at.x, at.y, above(at.z, wrist_z, forearm, hand)),
            "hip" => DVec3::new(at.x, at.y, at.z * thigh),
            "knee" => DVec3::new(
                if at.z.abs() > ankle_z.abs() { at.x * foot } else { at.x },
                at.y,
                above(at.z, ankle_z, calf, 1.0),
            ),
            _ => at,
        };
        let mut result = body.clone();
        for bone in &mut result.bones {
            if let Some(parent) = bone.parent {
                bone.offset = match without_side(&bone.name) {
                    "hip" => bone.offset * DVec3::new(1.0, hips, 1.0),
                    "clavicle" => bone.offset * DVec3::new(1.0, shoulders, trunk),
                    _ => stretched(&body.bones[parent].name, bone.offset),
                };
            }
        }
        for part in &mut result.parts {
            let bone = &body.bones[part.bone].name;
            (part.a, part.b) = (stretched(bone, part.a), stretched(bone, part.b));
            let girth = match without_side(&part.name) {
                "belly" => belly_girth,
                "chest" => chest_girth,
                "neck" => neck_girth,
                "head" => head_girth,
                "upper_arm" => upper_arm_girth,
                "forearm" | "hand" => forearm_girth,
                "thigh" => thigh_girth,
                "calf" => calf_girth,
                "foot" => foot_girth,
                _ => 1.0,
            };
            part.radius_a *= girth;
            part.radius_b *= girth;
        }
        for marker in &mut result.markers {
            marker.at = stretched(&body.bones[marker.bone].name, marker.at);
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lengths(body: &Body) -> Vec<(String, f64)> {
        let bones = body.world_from_bones(&vec![0.0; body.dof_count()]).unwrap();
        let joints = body.joint_positions(&bones);
        let at = |name: &str| joints[body.joint_index(name).unwrap()];
        let pairs = [
            ("thorax", "pelvis"),
            ("head", "left_clavicle"),
            ("head_top", "head"),
            ("left_shoulder", "right_shoulder"),
            ("left_hip", "right_hip"),
            ("left_elbow", "left_shoulder"),
            ("right_wrist", "right_elbow"),
            ("right_knee", "right_hip"),
            ("left_ankle", "left_knee"),
        ];
        pairs.iter().map(|(a, b)| (format!("{a} {b}"), at(a).distance(at(b)))).collect()
    }

    #[test]
    fn factors_of_one_change_nothing_and_each_other_changes_its_own() {
        let body = Body::adult(1750.0).unwrap();
        assert_eq!(Proportions::default().apply(&body), body);
        for index in 0..Proportions::COUNT {
            let mut proportions = Proportions::default();
            proportions.0[index] = 1.1;
            let stretched = proportions.apply(&body);
            assert_ne!(stretched, body, "{}", Proportions::ALL[index].name);
            let read = crate::body::parse_body(&stretched.rounded().to_toml(), "stretched").unwrap();
            for (part, exact) in read.parts.iter().zip(&stretched.parts) {
                assert!(part.b.distance(exact.b) < 0.1 && (part.radius_a - exact.radius_a).abs() <= 0.05);
            }
        }
    }

    #[test]
    fn lengths_of_segments_are_those_asked_for() {
        let body = Body::adult(1750.0).unwrap();
        let mut proportions = Proportions::default();
        for (name, factor) in
            [("upper arm", 1.1), ("forearm", 0.9), ("thigh", 0.92), ("calf", 0.85), ("hip width", 1.2)]
        {
            let index = Proportions::ALL.iter().position(|proportion| proportion.name == name).unwrap();
            proportions.0[index] = factor;
        }
        let expected = [1.0, 1.0, 1.0, 1.0, 1.2, 1.1, 0.9, 0.92, 0.85];
        let pairs = lengths(&body).into_iter().zip(lengths(&proportions.apply(&body)));
        for (((name, before), (_, after)), factor) in pairs.zip(expected) {
            assert!((after / before - factor).abs() < 1e-2, "{name}: {before} became {after}");
        }
    }
}
