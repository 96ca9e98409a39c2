//! The default body.

use anyhow::{Context, Result, ensure};

use super::{Body, parse_body};

/// Height of the embedded body, mm.
pub const ADULT_HEIGHT: f64 = 1750.0;

impl Body {
    /// The default body of METHOD A3 and A4, scaled to a height in mm: 15 bones with 31 degrees of freedom, 16 truncated
    /// cones, the 39 markers of the Plug-in Gait set. Its file, `adult.toml`, states the sources of its measures.
    ///
    /// # Errors
    /// When the height is not between 500 and 2500 mm.
    pub fn adult(height: f64) -> Result<Self> {
        ensure!(
            (500.0..=2500.0).contains(&height),
            "a height of {height} mm was asked for, expected 500 to 2500: are the units right?"
        );
        let body = parse_body(include_str!("adult.toml"), "adult.toml").context("the embedded default body")?;
        body.scaled(height / ADULT_HEIGHT)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn it_is_the_table_of_the_specification() {
        let body = Body::adult(ADULT_HEIGHT).unwrap();
        let table: Vec<(&str, &str, String)> = body
            .bones
            .iter()
            .map(|bone| {
                let parent = bone.parent.map_or("-", |parent| &body.bones[parent].name);
                let dofs: Vec<&str> = bone.dofs.iter().map(|dof| dof.axis.name()).collect();
                (bone.name.as_str(), parent, dofs.join(" "))
            })
            .collect();
        let expected = [
            ("pelvis", "-", "tx ty tz rx ry rz"),
            ("thorax", "pelvis", "ry rz"),
            ("left_axis", "pelvis", ""),
            ("left_hip", "left_axis", "rx ry rz"),
            ("left_knee", "left_hip", "ry"),
            ("right_axis", "pelvis", ""),
            ("right_hip", "right_axis", "rx ry rz"),
            ("right_knee", "right_hip", "ry"),
            ("head", "thorax", "rx ry rz"),
            ("left_clavicle", "thorax", "rx ry"),
            ("left_shoulder", "left_clavicle", "rx ry rz"),
            ("left_elbow", "left_shoulder", "ry"),
            ("right_clavicle", "thorax", "rx ry"),
            ("right_shoulder", "right_clavicle", "rx ry rz"),
            ("right_elbow", "right_shoulder", "ry"),
        ];
        let expected: Vec<_> = expected.into_iter().map(|(bone, parent, dofs)| (bone, parent, dofs.into())).collect();
        assert_eq!(table, expected);
        assert_eq!((body.dof_count(), body.parts.len(), body.markers.len()), (31, 16, 39));
    }

    #[test]
    fn it_is_as_tall_as_asked_and_symmetric() {
        for height in [1200.0, ADULT_HEIGHT, 1980.0] {
            let body = Body::adult(height).unwrap();
            let pose = body.standing_pose();
            let bones = body.world_from_bones(&pose).unwrap();
            let joints: Vec<(String, DVec3)> =
                body.joint_names().into_iter().zip(body.joint_positions(&bones)).collect();
            let of = |name: &str| joints.iter().find(|(joint, _)| joint == name).unwrap().1;
            assert!((of("head_top").z - height).abs() < 0.005 * height, "{} for {height}", of("head_top").z);
            assert!((of("left_hip").z / height - 0.530).abs() < 0.005, "{}", of("left_hip").z);
            assert!((of("left_ankle").z / height - 0.039).abs() < 0.005, "{}", of("left_ankle").z);
            let markers: Vec<(String, DVec3)> =
                body.marker_names().into_iter().zip(body.marker_positions(&bones)).collect();
            let mut pairs = 0;
            for (name, at) in joints.iter().chain(&markers) {
                let (twin, plain) = match name.strip_prefix("left_") {
                    Some(rest) => (format!("right_{rest}"), false),
                    None => (format!("R{}", &name[1..]), true),
                };
                if plain && !(name.starts_with('L') && name.len() == 4) {
                    continue;
                }
                let twin = joints.iter().chain(&markers).find(|(other, _)| *other == twin).unwrap().1;
                assert_eq!(*at * DVec3::new(1.0, -1.0, 1.0), twin, "{name}");
                assert!(at.y > 0.0 || name == "left_axis", "{name} is on the left");
                pairs += 1;
            }
            assert_eq!(pairs, 8 + 17);
        }
        for height in [0.0, 1.75, f64::NAN, f64::INFINITY, -1750.0] {
            let error = Body::adult(height).unwrap_err().to_string();
            assert!(error.contains("expected 500 to 2500"), "{error}");
        }
    }

    #[test]
    fn joints_bend_the_way_people_do() {
        let body = Body::adult(ADULT_HEIGHT).unwrap();
        let moved = |dof: &str, joint: &str, end: usize| {
            let mut pose = vec![0.0; body.dof_count()];
            let index = body.dof_index(dof).unwrap();
            pose[index] = body.dofs().nth(index).unwrap().1.limits[end] * 0.5;
            let at = |pose: &[f64]| {
                let joints = body.joint_positions(&body.world_from_bones(pose).unwrap());
                joints[body.joint_index(joint).unwrap()]
            };
            at(&pose) - at(&vec![0.0; pose.len()])
        };
        assert!(moved("left_knee.ry", "left_ankle", 1).x < -100.0, "a knee flexes backwards");
        assert!(moved("right_elbow.ry", "right_wrist", 0).x > 100.0, "an elbow flexes forwards");
        assert!(moved("left_hip.ry", "left_knee", 0).x > 200.0, "the wide side of a hip is flexion, forwards");
        assert!(moved("left_hip.rx", "left_knee", 1).y > 100.0, "the wide side of a hip's rx leads outwards");
        assert!(moved("right_hip.rx", "right_knee", 0).y < -100.0);
        assert!(moved("left_shoulder.rx", "left_elbow", 1).y > 200.0);
        assert!(moved("right_shoulder.rx", "right_elbow", 0).y < -200.0);
        assert!(moved("left_clavicle.rx", "left_shoulder", 1).z > 30.0, "a shrug lifts");
        assert!(moved("right_clavicle.rx", "right_shoulder", 0).z > 30.0);
        assert!(moved("left_clavicle.ry", "left_shoulder", 1).x > 5.0, "a shoulder comes forward");
        assert!(moved("thorax.ry", "head", 1).x > 200.0, "the wide side of the trunk is a bow");
        for (bone, dof) in body.dofs() {
            let [low, high] = dof.limits;
            assert!(low <= 0.0 && high >= 0.0, "{}.{}: rest is a pose", body.bones[bone].name, dof.axis.name());
            assert!(dof.step > 0.0);
        }
    }
}
