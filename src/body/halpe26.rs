//! The 22 points of Halpe26 that programs of networks' keypoints go by (nose, neck, mid-hip, heels, toes and all the limbs'), as points of
//! a body: where such a network marks a person, so far as it is known.
//!
//! They are no markers of the body's file: where they are follows from its joints and parts, so that any body of a person has them, one
//! that was measured too, and `fit` moves them with what they lie on.
//!
//! Shoulders, elbows, wrists, knees and ankles are the joints, the head is the crown. The others are fractions of the segment that they
//! lie on. Sources: heights and lengths as adult.toml has them (Drillis and Contini, in Winter); necks, noses and feet from the measures of
//! 1774 men in ANSUR (Gordon and others, 1989), heads also from Farkas (1994); and how Pose2Sim (BSD-3) places these points on its model of
//! the skeleton, which is that of Rajagopal and others (2016) and 1720 mm tall.

use anyhow::{Context, Result};
use glam::DVec3;

use super::{Body, Marker, PoseTable};
use crate::motion::PointTrajectory;

/// Names in the order in which Pose2Sim writes them: from the mid-hip down the right leg, the left one, up to the nose, and the arms.
pub const HALPE26: [&str; 22] = [
    "Hip",
    "RHip",
    "RKnee",
    "RAnkle",
    "RBigToe",
    "RSmallToe",
    "RHeel",
    "LHip",
    "LKnee",
    "LAnkle",
    "LBigToe",
    "LSmallToe",
    "LHeel",
    "Neck",
    "Head",
    "Nose",
    "RShoulder",
    "RElbow",
    "RWrist",
    "LShoulder",
    "LElbow",
    "LWrist",
];

/// How far a hip is marked below the joint's centre, a part of the thigh. The centre of adult.toml stands at 0.530 of the height; on
/// Pose2Sim's model the point divides the way from knee to shoulder at 0.414, which for our knee and shoulder is 0.498 of the height.
const HIP_BELOW_JOINT: f64 = 0.126;

/// How far up from the shoulders' level to the base of the skull the neck is marked: midway between the suprasternale (0.822 of the height)
/// and the cervicale (0.865).
const NECK_ABOVE_SHOULDERS: f64 = 0.77;

/// The tip of the nose from the crown, forwards and down, parts of the way from chin to crown (238 mm of 1750): half a head's length
/// (197 mm) and the nose's own 22 before it; crown to nasion 111 mm and most of the nose's height below.
const NOSE: [f64; 2] = [0.50, 0.65];

/// A point of the foot: along from the part's `a` to its `b`, outwards from its middle line, and below the ankle, all in lengths of it.
type OnFoot = [f64; 3];

/// In the heel bone, 13 mm before the skin's end and 23 mm above the sole.
const HEEL: OnFoot = [-0.072, 0.0, 0.191];
/// At the big toe's nail.
const BIG_TOE: OnFoot = [0.945, -0.077, 0.247];
/// At the small toe's, 0.8 of the foot's length from the heel's end.
const SMALL_TOE: OnFoot = [0.779, 0.153, 0.247];

impl Body {
    /// The points of [`HALPE26`] over the frames of a pose table, mm, z up, as [`Self::joint_trajectory`]. A virtual marker of the
    /// body that has the name of one stands for it.
    ///
    /// # Errors
    /// As [`Self::joint_trajectory`]; when the body lacks the joint or part that a point lies on.
    pub fn halpe26_trajectory(&self, poses: &PoseTable, rate: f64) -> Result<PointTrajectory> {
        let points = HALPE26.iter().map(|name| self.halpe26_point(name)).collect::<Result<Vec<Marker>>>()?;
        let names = HALPE26.iter().map(ToString::to_string).collect();
        self.trajectory(names, poses, rate, |_, bones| {
            points.iter().map(|point| bones[point.bone].transform_point3(point.at)).collect()
        })
    }

    fn halpe26_point(&self, name: &str) -> Result<Marker> {
        if let Some(own) = self.markers.iter().find(|marker| marker.name == name) {
            return Ok(own.clone());
        }
        let (side, outwards, what) = match name.split_at(1) {
            ("R", what) => ("right", -1.0, what),
            ("L", what) => ("left", 1.0, what),
            _ => ("", 0.0, name),
        };
        let (bone, at) = match what {
            "Hip" if side.is_empty() => {
                let [(bone, left), (_, right)] = [self.hip_point("left")?, self.hip_point("right")?];
                (bone, left.midpoint(right))
            }
            "Hip" => self.hip_point(side)?,
            "Neck" => self.neck_point()?,
            "Head" => self.landmark("head_top", name)?,
            "Nose" => self.nose_point()?,
            "Heel" => self.foot_point(side, outwards, HEEL)?,
            "BigToe" => self.foot_point(side, outwards, BIG_TOE)?,
            "SmallToe" => self.foot_point(side, outwards, SMALL_TOE)?,
            joint => self.landmark(&format!("{side}_{}", joint.to_lowercase()), name)?,
        };
        Ok(Marker { name: name.to_string(), bone, at })
    }

    /// A joint as joints.csv names it: the bone it is fixed to, and where in its frame.
    fn landmark(&self, joint: &str, point: &str) -> Result<(usize, DVec3)> {
        let end = || self.free_ends().into_iter().find(|end| end.name == joint).map(|end| (end.bone, end.at));
        self.bone_index(joint).map(|bone| (bone, DVec3::ZERO)).or_else(end).with_context(|| {
            format!("body {:?} has no joint {joint}, expected a person's, whose point {point} lies there", self.name)
        })
    }

    /// In the frame of the pelvis: it turns with that and not with the thigh.
    fn hip_point(&self, side: &str) -> Result<(usize, DVec3)> {
        let [hip, knee] = ["hip", "knee"].map(|joint| format!("{side}_{joint}"));
        let ((hip, _), (knee, _)) = (self.landmark(&hip, "Hip")?, self.landmark(&knee, "Hip")?);
        let thigh = self.bones[knee].offset.length();
        let (parent, at) = self.before_joint(hip);
        Ok((parent, at - DVec3::new(0.0, 0.0, HIP_BELOW_JOINT * thigh)))
    }

    /// A bone's origin in the frame of the nearest bone above it that moves.
    fn before_joint(&self, bone: usize) -> (usize, DVec3) {
        let (mut at, mut bone) = (self.bones[bone].offset, self.bones[bone].parent.unwrap_or(bone));
        while let (true, Some(parent)) = (self.bones[bone].dofs.is_empty(), self.bones[bone].parent) {
            (at, bone) = (at + self.bones[bone].offset, parent);
        }
        (bone, at)
    }

    fn neck_point(&self) -> Result<(usize, DVec3)> {
        let [head, shoulder, clavicle] =
            ["head", "left_shoulder", "left_clavicle"].map(|bone| self.landmark(bone, "Neck"));
        let ((head, _), (shoulder, _), (clavicle, _)) = (head?, shoulder?, clavicle?);
        let (thorax, base) = self.before_joint(head);
        let shoulders = self.bones[clavicle].offset.z + self.bones[shoulder].offset.z;
        let height = shoulders + NECK_ABOVE_SHOULDERS * (base.z - shoulders);
        Ok((thorax, DVec3::new(base.x, base.y, height)))
    }

    fn nose_point(&self) -> Result<(usize, DVec3)> {
        let (bone, crown) = self.landmark("head_top", "Nose")?;
        let head = self.parts.iter().find(|part| part.bone == bone);
        let height = head.map_or(0.0, |head| head.a.distance(head.b));
        let [forwards, down] = NOSE;
        Ok((bone, crown + DVec3::new(forwards * height, 0.0, -down * height)))
    }

    fn foot_point(&self, side: &str, outwards: f64, on_foot: OnFoot) -> Result<(usize, DVec3)> {
        let name = format!("{side}_foot");
        let foot = self.parts.iter().find(|part| part.name == name).with_context(|| {
            format!("body {:?} has no part {name}, expected a person's foot, on which heel and toes lie", self.name)
        })?;
        let [along, aside, below] = on_foot;
        let length = foot.a.distance(foot.b);
        let line = foot.a.lerp(foot.b, along);
        // Above the foot, where its bone is the leg's; a foot of its own begins in the ankle.
        let ends = self.free_ends();
        let ankle = ends.iter().find(|end| end.bone == foot.bone).map_or(0.0, |end| end.at.z);
        Ok((foot.bone, DVec3::new(line.x, line.y + outwards * aside * length, ankle - below * length)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{ADULT_HEIGHT, Proportions};

    fn standing(body: &Body) -> Vec<(&'static str, DVec3)> {
        let poses = PoseTable { frames: vec![0], poses: vec![body.standing_pose()] };
        let points = body.halpe26_trajectory(&poses, 60.0).unwrap();
        assert_eq!(points.names, HALPE26);
        HALPE26.into_iter().zip(points.frames[0].iter().map(|point| point.unwrap())).collect()
    }

    fn of(points: &[(&str, DVec3)], name: &str) -> DVec3 {
        points.iter().find(|(point, _)| *point == name).unwrap().1
    }

    /// Heights and distances of Pose2Sim's model (1720 mm), of ANSUR's men (1756 mm) and of the tables, parts of the height.
    #[test]
    fn they_are_where_anatomy_has_them_at_every_height() {
        for height in [1200.0, ADULT_HEIGHT, 1980.0] {
            let points = standing(&Body::adult(height).unwrap());
            let at = |name: &str| of(&points, name) / height;
            for (name, expected) in [
                ("Head", 1.0),
                ("Nose", 1.0 - 156.0 / 1756.0),
                ("Neck", (0.822 + 0.865) / 2.0),
                ("RShoulder", 0.80),
                ("Hip", 859.0 / 1720.0),
                ("RKnee", 0.285),
                ("LAnkle", 0.039),
                ("LHeel", 28.0 / 1720.0),
                ("RBigToe", 12.0 / 1720.0),
            ] {
                assert!((at(name).z - expected).abs() < 0.008, "{name} at {} of the height", at(name).z);
            }
            let foot = (at("LHeel") - at("LBigToe")).length();
            assert!((foot - 230.0 / 1720.0).abs() < 0.008, "heel to big toe {foot}");
            assert!(at("LSmallToe").y > at("LHeel").y && at("LBigToe").y < at("LHeel").y);
            assert!(at("LSmallToe").x < at("LBigToe").x && at("Nose").x > at("Head").x);
            assert_eq!(of(&points, "Hip"), of(&points, "RHip").midpoint(of(&points, "LHip")));
            for (name, point) in &points {
                let Some(rest) = name.strip_prefix('L') else { continue };
                let twin = of(&points, &format!("R{rest}"));
                assert!((*point * DVec3::new(1.0, -1.0, 1.0)).distance(twin) < 1e-9, "{name}");
            }
        }
    }

    #[test]
    fn they_follow_the_proportions_that_are_fitted() {
        let body = Body::adult(ADULT_HEIGHT).unwrap();
        let before = standing(&body);
        for (factor, [a, b]) in [
            ("foot", ["RHeel", "RBigToe"]),
            ("head length", ["Head", "Nose"]),
            ("calf", ["LKnee", "LAnkle"]),
            ("thigh", ["LHip", "LKnee"]),
        ] {
            let factors = [(factor.to_string(), 1.1)].into_iter().collect();
            let after = standing(&Proportions::named(&factors).unwrap().apply(&body));
            let ratio = of(&after, a).distance(of(&after, b)) / of(&before, a).distance(of(&before, b));
            assert!((ratio - 1.1).abs() < 0.01, "{factor}: {a} to {b} grew by {ratio}");
        }
    }

    #[test]
    fn a_marker_of_the_name_stands_for_the_point() {
        let mut body = Body::adult(ADULT_HEIGHT).unwrap();
        let bone = body.bone_index("head").unwrap();
        body.markers.push(Marker { name: "Nose".into(), bone, at: DVec3::new(200.0, 0.0, 50.0) });
        let [nose, head] = ["Nose", "Head"].map(|name| of(&standing(&body), name));
        assert!((nose - head).distance(DVec3::new(185.0, 0.0, -200.0)) < 1e-9, "{}", nose - head);
    }

    #[test]
    fn a_body_that_is_no_person_is_named_with_what_it_lacks() {
        let whole = Body::adult(ADULT_HEIGHT).unwrap();
        let mut body = whole.clone();
        body.parts.retain(|part| part.name != "left_foot");
        let poses = PoseTable { frames: vec![0], poses: vec![whole.standing_pose()] };
        let refused = body.halpe26_trajectory(&poses, 60.0).unwrap_err().to_string();
        assert!(refused.contains("no part left_foot"), "{refused}");
        let mut body = whole.clone();
        body.bones[whole.bone_index("right_knee").unwrap()].name = "spring".into();
        let refused = body.halpe26_trajectory(&poses, 60.0).unwrap_err().to_string();
        assert!(refused.contains("no joint right_knee"), "{refused}");
    }
}
