//! DeepMimic clips: JSON with a row of numbers a frame. A row is its duration in seconds, the root's place in metres and its
//! turn, then each joint's: a quaternion w x y z where it is spherical, an angle about z in radians where it is revolute.
//! y is up, at rest the person faces +x.

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::{DQuat, DVec3};
use serde::Deserialize;

use super::super::points::LARGEST_COORDINATE;
use super::{Placement, SkeletalJoint, SkeletalMotion, UpAxis, ensure_size};
use crate::files::shortened;

/// How a joint moves, and so how many numbers of a row are its.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Freedom {
    Root,
    Spherical,
    Revolute,
    Fixed,
}

impl Freedom {
    fn values(self) -> usize {
        match self {
            Self::Root => 7,
            Self::Spherical => 4,
            Self::Revolute => 1,
            Self::Fixed => 0,
        }
    }
}

/// The skeleton that a clip moves.
#[derive(Clone, Debug, PartialEq)]
pub struct DeepMimicSkeleton {
    joints: Vec<(String, Option<usize>, DVec3, Freedom)>,
}

impl DeepMimicSkeleton {
    /// The humanoid that the published clips are for: 15 joints, 1.6 m tall, metres.
    pub fn humanoid() -> Self {
        use Freedom::{Fixed, Revolute, Root, Spherical};
        let joint = |name: &str, parent, at: [f64; 3], freedom| (name.to_string(), parent, DVec3::from(at), freedom);
        let mut joints = vec![
            joint("root", None, [0.0; 3], Root),
            joint("chest", Some(0), [0.0, 0.236_151, 0.0], Spherical),
            joint("neck", Some(1), [0.0, 0.223_894, 0.0], Spherical),
        ];
        for (side, z) in [("right", 1.0), ("left", -1.0)] {
            let first = joints.len();
            joints.extend([
                joint(&format!("{side}_hip"), Some(0), [0.0, 0.0, z * 0.084_887], Spherical),
                joint(&format!("{side}_knee"), Some(first), [0.0, -0.421_546, 0.0], Revolute),
                joint(&format!("{side}_ankle"), Some(first + 1), [0.0, -0.409_870, 0.0], Spherical),
                joint(&format!("{side}_shoulder"), Some(1), [-0.024_05, 0.243_50, z * 0.183_11], Spherical),
                joint(&format!("{side}_elbow"), Some(first + 3), [0.0, -0.274_788, 0.0], Revolute),
                joint(&format!("{side}_wrist"), Some(first + 4), [0.0, -0.258_947, 0.0], Fixed),
            ]);
        }
        Self { joints }
    }

    fn values(&self) -> usize {
        self.joints.iter().map(|(_, _, _, freedom)| freedom.values()).sum()
    }
}

#[derive(Deserialize)]
struct CharacterFile {
    #[serde(rename = "Skeleton")]
    skeleton: SkeletonEntry,
}

#[derive(Deserialize)]
struct SkeletonEntry {
    #[serde(rename = "Joints")]
    joints: Vec<JointEntry>,
}

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct JointEntry {
    name: String,
    #[serde(rename = "Type")]
    kind: String,
    parent: i64,
    attach_x: f64,
    attach_y: f64,
    attach_z: f64,
    #[serde(default)]
    attach_theta_x: f64,
    #[serde(default)]
    attach_theta_y: f64,
    #[serde(default)]
    attach_theta_z: f64,
}

/// Reads the skeleton of a character file; `name` stands for the file in messages.
///
/// # Errors
/// One sentence with the file and the joint: no JSON, a parent after its child (which a cycle needs), a kind of joint that
/// is unknown, axes that are turned at rest.
pub fn parse_deepmimic_skeleton(text: &str, name: &str) -> Result<DeepMimicSkeleton> {
    let file: CharacterFile = serde_json::from_str(text).map_err(|error| anyhow!("{name}: {error}"))?;
    ensure!(!file.skeleton.joints.is_empty(), "{name} has no joints, expected at least a root");
    let mut joints: Vec<(String, Option<usize>, DVec3, Freedom)> = Vec::new();
    for entry in &file.skeleton.joints {
        let place = || format!("{name}, joint `{}`", shortened(&entry.name));
        ensure!(
            joints.iter().all(|(other, ..)| *other != entry.name),
            "{}: two joints have this name, expected every name once",
            place()
        );
        let parent = match usize::try_from(entry.parent) {
            Err(_) if joints.is_empty() => None,
            Ok(parent) if parent < joints.len() => Some(parent),
            _ => bail!(
                "{}: its parent is number {}, expected one of the joints before it (a cycle cannot be posed)",
                place(),
                entry.parent
            ),
        };
        let offset = DVec3::new(entry.attach_x, entry.attach_y, entry.attach_z);
        ensure!(
            offset.is_finite() && offset.abs().max_element() <= LARGEST_COORDINATE,
            "{}: it is attached at {offset}, expected metres",
            place()
        );
        let turned = DVec3::new(entry.attach_theta_x, entry.attach_theta_y, entry.attach_theta_z);
        ensure!(turned == DVec3::ZERO, "{}: its axes are turned at rest, expected AttachTheta of 0", place());
        let freedom = match (parent, entry.kind.as_str()) {
            (None, "none" | "root") => Freedom::Root,
            (Some(_), "spherical") => Freedom::Spherical,
            (Some(_), "revolute") => Freedom::Revolute,
            (Some(_), "fixed") => Freedom::Fixed,
            (_, other) => bail!(
                "{}: it is of type `{}`, expected spherical, revolute or fixed, and none for the root",
                place(),
                shortened(other)
            ),
        };
        joints.push((entry.name.clone(), parent, offset, freedom));
    }
    Ok(DeepMimicSkeleton { joints })
}

#[derive(Deserialize)]
struct ClipFile {
    #[serde(rename = "Loop", default)]
    wraps: Option<String>,
    #[serde(rename = "Frames")]
    frames: Vec<Vec<f64>>,
}

/// Reads a clip that moves `skeleton`; `name` stands for the file in messages. A clip that wraps begins again where it ends.
///
/// # Errors
/// One sentence with the file and the frame: no JSON, a row of another length than the skeleton asks for, a duration that
/// is not positive, a quaternion that is none.
pub fn parse_deepmimic(text: &str, name: &str, skeleton: &DeepMimicSkeleton) -> Result<SkeletalMotion> {
    let file: ClipFile = serde_json::from_str(text).map_err(|error| anyhow!("{name}: {error}"))?;
    let wraps = match file.wraps.as_deref().unwrap_or("none") {
        "wrap" => true,
        "none" => false,
        other => bail!("{name}: Loop is `{}`, expected `wrap` or `none`", shortened(other)),
    };
    ensure!(!file.frames.is_empty(), "{name} holds no frames, expected at least one");
    ensure_size(skeleton.joints.len(), file.frames.len()).with_context(|| name.to_string())?;
    let expected = skeleton.values() + 1;
    let (mut times, mut frames, mut time) = (Vec::new(), Vec::new(), 0.0);
    for (frame, row) in file.frames.iter().enumerate() {
        let place = || format!("{name}, frame {frame}");
        ensure!(
            row.len() == expected,
            "{}: it holds {} numbers, expected {expected} for this skeleton",
            place(),
            row.len()
        );
        ensure!(
            row.iter().all(|value| value.is_finite() && value.abs() <= LARGEST_COORDINATE),
            "{}: it holds a number above {LARGEST_COORDINATE:e}",
            place()
        );
        times.push(time);
        // The last frame's duration says nothing: files have 0 there.
        let is_last = frame + 1 == file.frames.len();
        ensure!(
            is_last || (1e-6..=1e3).contains(&row[0]),
            "{}: it lasts {} s, expected a positive number of seconds",
            place(),
            row[0]
        );
        time += row[0];
        frames.push(placements(skeleton, &row[1..]).with_context(place)?);
    }
    let joints = skeleton
        .joints
        .iter()
        .map(|(name, parent, offset, freedom)| SkeletalJoint {
            name: name.clone(),
            parent: *parent,
            offset: *offset,
            is_end: *freedom == Freedom::Fixed,
        })
        .collect();
    let motion = SkeletalMotion { joints, unit: Some(1000.0), up: Some(UpAxis::Y), times, frames, wraps };
    motion.check().with_context(|| name.to_string())?;
    Ok(motion)
}

fn placements(skeleton: &DeepMimicSkeleton, mut values: &[f64]) -> Result<Vec<Placement>> {
    let mut placed = Vec::with_capacity(skeleton.joints.len());
    for (name, _, offset, freedom) in &skeleton.joints {
        let (own, rest) = values.split_at(freedom.values());
        values = rest;
        let (origin, rotation) = match freedom {
            Freedom::Root => (DVec3::new(own[0], own[1], own[2]), quaternion(name, &own[3..])?),
            Freedom::Spherical => (*offset, quaternion(name, own)?),
            Freedom::Revolute => (*offset, DQuat::from_rotation_z(own[0])),
            Freedom::Fixed => (*offset, DQuat::IDENTITY),
        };
        placed.push(Placement { rotation, origin });
    }
    Ok(placed)
}

fn quaternion(joint: &str, wxyz: &[f64]) -> Result<DQuat> {
    let found = DQuat::from_xyzw(wxyz[1], wxyz[2], wxyz[3], wxyz[0]);
    // Published clips hold mixtures of quaternions that are shorter than 1.
    ensure!(
        (0.5..=1.5).contains(&found.length()),
        "joint `{joint}` is turned by a quaternion of length {}, expected 1",
        found.length()
    );
    Ok(found.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::test_points::real_data;

    const CHARACTER: &str = r#"{"Skeleton": {"Joints": [
        {"Name": "root", "Type": "none", "Parent": -1, "AttachX": 0, "AttachY": 0, "AttachZ": 0},
        {"Name": "knee", "Type": "revolute", "Parent": 0, "AttachX": 0, "AttachY": -0.4, "AttachZ": 0.1},
        {"Name": "foot", "Type": "fixed", "Parent": 1, "AttachX": 0, "AttachY": -0.4, "AttachZ": 0}]}}"#;
    const CLIP: &str = r#"{"Loop": "wrap", "Frames": [[0.5, 1, 2, 3, 1, 0, 0, 0, -1.5707963267948966],
        [0, 1, 2, 3, 1, 0, 0, 0, 0]]}"#;

    #[test]
    fn a_clip_is_where_it_should_be() {
        let skeleton = parse_deepmimic_skeleton(CHARACTER, "man.txt").unwrap();
        let motion = parse_deepmimic(CLIP, "kick.txt", &skeleton).unwrap();
        assert!(motion.wraps && motion.unit == Some(1000.0));
        assert_eq!(motion.times, [0.0, 0.5]);
        let placed = motion.global(&motion.frames[0]);
        assert!(placed[1].origin.distance(DVec3::new(1.0, 1.6, 3.1)) < 1e-12);
        assert!(placed[2].origin.distance(DVec3::new(0.6, 1.6, 3.1)) < 1e-12, "a knee bends backwards with -z");
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let skeleton = parse_deepmimic_skeleton(CHARACTER, "man.txt").unwrap();
        let clips = [
            (String::new(), "EOF"),
            ("[1, 2]".into(), "invalid"),
            (CLIP.replace("wrap", "bounce"), "Loop is `bounce`"),
            (r#"{"Frames": []}"#.into(), "holds no frames"),
            (CLIP.replace(", 3, 1,", ", 3,"), "frame 0: it holds 8 numbers, expected 9"),
            (CLIP.replace("[0.5, 1", "[-0.5, 1"), "frame 0: it lasts -0.5 s"),
            (CLIP.replace("3, 1, 0", "3, 0, 0"), "joint `root` is turned by a quaternion of length 0"),
            (CLIP.replace("[0.5, 1, 2", "[0.5, 1e99, 2"), "a number above"),
        ];
        for (text, expected) in clips {
            let error = format!("{:#}", parse_deepmimic(&text, "kick.txt", &skeleton).unwrap_err());
            assert!(error.starts_with("kick.txt") && error.contains(expected) && !error.contains('\n'), "{error}");
        }
        let characters = [
            (CHARACTER.replace("\"Parent\": 0", "\"Parent\": 2"), "its parent is number 2"),
            (CHARACTER.replace("revolute", "planar"), "type `planar`"),
            (CHARACTER.replace("\"foot\"", "\"knee\""), "two joints have this name"),
            (CHARACTER.replace("\"AttachZ\": 0.1", "\"AttachZ\": 0.1, \"AttachThetaX\": 1"), "turned at rest"),
            (CHARACTER.replace("AttachY", "AttachQ"), "AttachY"),
        ];
        for (text, expected) in characters {
            let error = format!("{:#}", parse_deepmimic_skeleton(&text, "man.txt").unwrap_err());
            assert!(error.starts_with("man.txt") && error.contains(expected), "{error}");
        }
    }

    #[test]
    fn the_published_clips_fit_the_built_in_humanoid() {
        let Some(folder) = real_data("the_published_clips_fit_the_built_in_humanoid", "motion/deepmimic") else {
            return;
        };
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
        let humanoid = DeepMimicSkeleton::humanoid();
        let published = parse_deepmimic_skeleton(&read("character_humanoid3d.txt"), "humanoid").unwrap();
        assert_eq!(published, humanoid);
        for clip in ["humanoid3d_walk.txt", "humanoid3d_kick.txt", "humanoid3d_dance_a.txt"] {
            let motion = parse_deepmimic(&read(clip), clip, &humanoid).unwrap();
            let ankle = motion.joints.iter().position(|joint| joint.name == "left_ankle").unwrap();
            for row in &motion.frames {
                let height = motion.global(row)[ankle].origin.y;
                assert!((-0.1..2.0).contains(&height), "{clip}: an ankle at {height} m");
            }
        }
    }
}
