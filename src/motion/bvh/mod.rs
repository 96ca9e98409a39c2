//! BVH: a tree of joints and one row of channel values a frame. The format has no unit and no fixed up axis: numbers are read as they
//! stand, but for files that say theirs, as those written here do ([`BvhStatement`]).

mod read;
mod statement;
mod write;

pub(super) use read::POINTS;
pub use read::parse_bvh;
pub use statement::BvhStatement;
pub use write::write_bvh;

use std::collections::HashSet;

use anyhow::{Result, bail, ensure};
use glam::{DAffine3, DMat3, DVec3};

use super::points::PointTrajectory;

/// What one number of a frame moves. Translations are in the file's unit, rotations in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BvhChannel {
    /// `Xposition`.
    XPosition,
    /// `Yposition`.
    YPosition,
    /// `Zposition`.
    ZPosition,
    /// `Xrotation`.
    XRotation,
    /// `Yrotation`.
    YRotation,
    /// `Zrotation`.
    ZRotation,
}

impl BvhChannel {
    /// Every channel with the word that stands for it in a file.
    pub const ALL: [(Self, &str); 6] = [
        (Self::XPosition, "Xposition"),
        (Self::YPosition, "Yposition"),
        (Self::ZPosition, "Zposition"),
        (Self::XRotation, "Xrotation"),
        (Self::YRotation, "Yrotation"),
        (Self::ZRotation, "Zrotation"),
    ];

    /// The word in a file.
    pub fn word(self) -> &'static str {
        Self::ALL[self as usize].1
    }
}

/// A joint of the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct BvhJoint {
    /// Its name, unique in the file.
    pub name: String,
    /// Index of the parent, always smaller than the joint's own; `None` for a root. So there can be no cycle.
    pub parent: Option<usize>,
    /// From the parent's origin, in the parent's axes, file's unit.
    pub offset: DVec3,
    /// Its channels in the order of the file, which is the order in which rotations are multiplied.
    pub channels: Vec<BvhChannel>,
    /// Offsets of the free ends (`End Site`).
    pub end_sites: Vec<DVec3>,
}

/// A skeleton and its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct BvhMotion {
    /// Parents before their children.
    pub joints: Vec<BvhJoint>,
    /// Seconds from one frame to the next.
    pub frame_time: f64,
    /// A row a frame: the values of all joints' channels, in the order of `joints`.
    pub frames: Vec<Vec<f64>>,
    /// What the file says of its unit, axes and frames; most say nothing.
    pub statement: Option<BvhStatement>,
}

/// A short file can describe a product of joints and frames that fills any memory: this many points are two gigabytes.
const MOST_POINTS: usize = 1 << 26;

impl BvhMotion {
    /// The same motion in another unit, of `millimetres`.
    ///
    /// # Errors
    /// When the motion does not say what its unit is.
    pub fn in_unit(self, millimetres: f64) -> Result<Self> {
        let Some(statement) = self.statement else {
            bail!("it says neither its unit nor its axes, expected a BVH that pantin wrote")
        };
        if statement.millimetres == millimetres {
            return Ok(self);
        }
        let mut motion = self.scaled(statement.millimetres / millimetres);
        motion.statement = Some(BvhStatement { millimetres, ..statement });
        Ok(motion)
    }

    /// The same motion with every length multiplied by `factor` (the format has no unit).
    pub fn scaled(mut self, factor: f64) -> Self {
        use BvhChannel::{XPosition, YPosition, ZPosition};
        for joint in &mut self.joints {
            joint.offset *= factor;
            joint.end_sites.iter_mut().for_each(|end| *end *= factor);
        }
        let lengths: Vec<bool> = self
            .joints
            .iter()
            .flat_map(|joint| joint.channels.iter().map(|c| matches!(c, XPosition | YPosition | ZPosition)))
            .collect();
        for row in &mut self.frames {
            row.iter_mut().zip(&lengths).filter(|(_, is_length)| **is_length).for_each(|(value, _)| *value *= factor);
        }
        self
    }

    /// The number of values in a frame.
    pub fn channel_count(&self) -> usize {
        self.joints.iter().map(|joint| joint.channels.len()).sum()
    }

    /// Holds what the reader promises and the writer needs.
    ///
    /// # Errors
    /// One sentence that names the joint or the frame.
    pub fn check(&self) -> Result<()> {
        ensure!(!self.joints.is_empty(), "there are no joints, expected at least a root");
        ensure!(!self.frames.is_empty(), "there are no frames, expected at least one");
        ensure!(
            self.frame_time.is_finite() && self.frame_time > 0.0,
            "the frame time is {} s, expected a positive number",
            self.frame_time
        );
        let mut names = HashSet::new();
        for (index, joint) in self.joints.iter().enumerate() {
            let name = &joint.name;
            ensure!(
                !name.is_empty()
                    && name.trim() == name
                    && !name.contains(['{', '}'])
                    && !name.chars().any(char::is_control),
                "the name of joint {} is {name:?}, expected printable text without blanks around it",
                index + 1
            );
            ensure!(names.insert(name), "two joints are named `{name}`, expected every name once");
            ensure!(
                joint.parent.is_none_or(|parent| parent < index),
                "joint `{name}` stands before its parent, expected parents first"
            );
            let offsets_finite = joint.offset.is_finite() && joint.end_sites.iter().all(|end| end.is_finite());
            ensure!(offsets_finite, "joint `{name}` has an offset that is not finite");
        }
        let channels = self.channel_count();
        for (frame, row) in self.frames.iter().enumerate() {
            ensure!(
                row.len() == channels,
                "frame {frame} holds {} values, expected {channels} as there are channels",
                row.len()
            );
            ensure!(row.iter().all(|value| value.is_finite()), "frame {frame} holds a value that is not finite");
        }
        Ok(())
    }

    /// Where every joint's origin and every free end is in every frame, in mm and z up where the motion says its unit and axes, else in
    /// the file's: joints under their names, free ends as `<joint>_end`. A joint's rotations multiply in the order of its channels; a position channel
    /// takes the place of that coordinate of the offset (the usage of Blender and MotionBuilder; the two readings
    /// differ only in files whose moving joints have an offset that the positions do not repeat).
    ///
    /// # Errors
    /// When the motion breaks [`Self::check`], or describes more points than memory should hold.
    pub fn to_points(&self) -> Result<PointTrajectory> {
        self.check()?;
        let names = self.to_point_names();
        ensure!(
            names.len().saturating_mul(self.frames.len()) <= MOST_POINTS,
            "{} joints and ends in {} frames are too many, expected at most {MOST_POINTS} points in all",
            names.len(),
            self.frames.len()
        );
        let mut global = vec![DAffine3::IDENTITY; self.joints.len()];
        let frames = self.frames.iter().map(|row| self.pose(row, &mut global)).collect();
        let rate = super::points::meant_rate(1.0 / self.frame_time);
        let mut points = PointTrajectory { names, rate, first_frame: 0, frames, smoothed: None };
        if let Some(BvhStatement { millimetres, first_frame }) = self.statement {
            points = PointTrajectory { first_frame, ..points.scaled(millimetres).y_up_to_z_up() };
        }
        points.check()?;
        Ok(points)
    }

    /// Names of [`Self::to_points`]: the joints', then `<joint>_end` for every free end.
    pub(super) fn to_point_names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.joints.iter().map(|joint| joint.name.clone()).collect();
        let mut taken: HashSet<String> = names.iter().cloned().collect();
        for joint in &self.joints {
            let mut candidate = format!("{}_end", joint.name);
            let mut number = 2;
            for _ in &joint.end_sites {
                while !taken.insert(candidate.clone()) {
                    candidate = format!("{}_end{number}", joint.name);
                    number += 1;
                }
                names.push(candidate.clone());
            }
        }
        names
    }

    /// The points of one frame; `global` is scratch, one transform a joint.
    fn pose(&self, row: &[f64], global: &mut [DAffine3]) -> Vec<Option<DVec3>> {
        let mut values = row.iter();
        for (index, joint) in self.joints.iter().enumerate() {
            let local = joint_placement(joint.offset, &joint.channels, &mut values);
            global[index] = joint.parent.map_or(local, |parent| global[parent] * local);
        }
        let origins = global.iter().map(|transform| transform.translation);
        let ends = self
            .joints
            .iter()
            .zip(global.iter())
            .flat_map(|(joint, transform)| joint.end_sites.iter().map(|end| transform.transform_point3(*end)));
        origins.chain(ends).map(Some).collect()
    }
}

/// A joint's frame in its parent's, its channel values taken from `values`.
pub(super) fn joint_placement<'a>(
    offset: DVec3,
    channels: &[BvhChannel],
    values: &mut impl Iterator<Item = &'a f64>,
) -> DAffine3 {
    let (mut origin, mut rotation) = (offset, DMat3::IDENTITY);
    for (channel, &value) in channels.iter().zip(values) {
        let angle = value.to_radians();
        match channel {
            BvhChannel::XPosition => origin.x = value,
            BvhChannel::YPosition => origin.y = value,
            BvhChannel::ZPosition => origin.z = value,
            BvhChannel::XRotation => rotation *= DMat3::from_rotation_x(angle),
            BvhChannel::YRotation => rotation *= DMat3::from_rotation_y(angle),
            BvhChannel::ZRotation => rotation *= DMat3::from_rotation_z(angle),
        }
    }
    DAffine3 { matrix3: rotation, translation: origin }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::motion::test_points::real_data;
    use proptest::prelude::*;

    pub(crate) fn arm() -> BvhMotion {
        use BvhChannel::*;
        let joint = |name: &str, parent, offset, channels: &[BvhChannel], ends: &[DVec3]| BvhJoint {
            name: name.into(),
            parent,
            offset,
            channels: channels.to_vec(),
            end_sites: ends.to_vec(),
        };
        BvhMotion {
            joints: vec![
                joint(
                    "hip",
                    None,
                    DVec3::ZERO,
                    &[XPosition, YPosition, ZPosition, ZRotation, XRotation, YRotation],
                    &[],
                ),
                joint("arm", Some(0), DVec3::new(0.0, 10.0, 0.0), &[ZRotation, XRotation], &[]),
                joint("hand", Some(1), DVec3::new(5.0, 0.0, 0.0), &[], &[DVec3::new(1.0, 0.0, 0.0), DVec3::Z]),
                joint("leg", Some(0), DVec3::new(0.0, -10.0, 0.0), &[YRotation], &[DVec3::NEG_Y]),
            ],
            frame_time: 0.01,
            frames: vec![
                vec![1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                vec![0.0, 0.0, 0.0, 90.0, 0.0, 0.0, 90.0, 90.0, 30.0],
            ],
            statement: None,
        }
    }

    #[test]
    fn forward_kinematics() {
        let points = arm().to_points().unwrap();
        assert_eq!(points.names, ["hip", "arm", "hand", "leg", "hand_end", "hand_end2", "leg_end"]);
        assert_eq!(points.rate, 100.0);
        let at = |frame: usize, name: &str| points.frames[frame][points.column(name).unwrap()].unwrap();
        assert_eq!(at(0, "hand_end"), DVec3::new(7.0, 12.0, 3.0));
        let near = |p: DVec3, q: [f64; 3]| assert!((p - DVec3::from(q)).length() < 1e-9, "{p} {q:?}");
        // The hip turns y to -x; the arm turns a further quarter about z, then about its own x.
        near(at(1, "arm"), [-10.0, 0.0, 0.0]);
        near(at(1, "hand"), [-15.0, 0.0, 0.0]);
        near(at(1, "hand_end"), [-16.0, 0.0, 0.0]);
        // Rz(180) Rx(90) takes z to Rz(180)(-y) = +y.
        near(at(1, "hand_end2"), [-15.0, 1.0, 0.0]);
    }

    #[test]
    fn scaling_a_motion_scales_its_points() {
        let (scaled, points) = (arm().scaled(10.0).to_points().unwrap(), arm().to_points().unwrap().scaled(10.0));
        for (p, q) in scaled.frames.iter().flatten().flatten().zip(points.frames.iter().flatten().flatten()) {
            assert!((*p - *q).length() < 1e-9, "{p} {q}");
        }
    }

    #[test]
    fn what_a_motion_says_makes_its_points_ours() {
        let silent = arm();
        let said = BvhMotion { statement: Some(BvhStatement { millimetres: 10.0, first_frame: 100 }), ..arm() };
        let points = said.to_points().unwrap();
        assert_eq!(points.first_frame, 100);
        let expected = silent.to_points().unwrap().scaled(10.0).y_up_to_z_up();
        assert_eq!(points.frames, expected.frames);
        let metres = said.clone().in_unit(1000.0).unwrap();
        assert_eq!(metres.joints[1].offset.y, 0.1);
        for (p, q) in metres.to_points().unwrap().frames.iter().flatten().zip(points.frames.iter().flatten()) {
            assert!(p.unwrap().distance(q.unwrap()) < 1e-9);
        }
        assert_eq!(said.clone().in_unit(10.0).unwrap(), said);
        assert!(silent.in_unit(10.0).unwrap_err().to_string().contains("neither its unit nor its axes"));
        let mut text = Vec::new();
        write_bvh(&mut text, &said).unwrap();
        assert_eq!(parse_bvh(std::str::from_utf8(&text).unwrap(), "a.bvh").unwrap(), said);
        let skeletal = said.to_skeletal().unwrap();
        assert_eq!((skeletal.unit, skeletal.up.map(|up| up.name())), (Some(10.0), Some("y")));
    }

    #[test]
    fn an_end_that_is_named_like_a_joint() {
        let mut motion = arm();
        motion.joints[3].name = "hand_end".into();
        let points = motion.to_points().unwrap();
        assert_eq!(&points.names[4..], ["hand_end2", "hand_end3", "hand_end_end"]);
    }

    #[test]
    fn what_cannot_be_is_named() {
        type Change = fn(&mut BvhMotion);
        let broken: [(&str, Change); 8] = [
            ("no joints", |m| m.joints.clear()),
            ("no frames", |m| m.frames.clear()),
            ("frame time is 0", |m| m.frame_time = 0.0),
            ("two joints are named `hip`", |m| m.joints[1].name = "hip".into()),
            ("joint `arm` stands before its parent", |m| m.joints[1].parent = Some(2)),
            ("joint `arm` has an offset", |m| m.joints[1].offset.x = f64::NAN),
            ("frame 1 holds 8 values, expected 9", |m| m.frames[1].truncate(8)),
            ("frame 0 holds a value that is not finite", |m| m.frames[0][0] = f64::INFINITY),
        ];
        for (expected, change) in broken {
            let mut motion = arm();
            change(&mut motion);
            let message = motion.to_points().unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn more_points_than_memory_are_refused() {
        let mut motion = arm();
        motion.joints.truncate(1);
        motion.joints[0].channels.clear();
        motion.joints[0].end_sites = vec![DVec3::ZERO; 100_000];
        motion.frames = vec![Vec::new(); 1000];
        assert!(motion.to_points().unwrap_err().to_string().contains("too many"));
    }

    #[test]
    fn the_recordings_of_cmu() {
        let Some(folder) = real_data("the_recordings_of_cmu", "motion/cmu_bvh") else { return };
        for (file, frames) in [("02_01", 344), ("02_03", 174), ("02_04", 484), ("13_30", 2466)] {
            let text = std::fs::read_to_string(folder.join(format!("{file}.bvh"))).unwrap();
            let motion = parse_bvh(&text, file).unwrap();
            assert_eq!(motion.frames.len(), frames, "{file}");
            let points = motion.to_points().unwrap();
            assert_eq!(points.rate, 120.0);
            // Bones keep their lengths: the shin is as long in every frame as its offset says.
            let (knee, foot) = (points.column("lShin").unwrap(), points.column("lFoot").unwrap());
            let shin = motion.joints[motion.joints.iter().position(|j| j.name == "lFoot").unwrap()].offset.length();
            for row in &points.frames {
                assert!(((row[knee].unwrap() - row[foot].unwrap()).length() - shin).abs() < 1e-9);
            }
            // The feet stay near the floor and below the head, which only the right rotation order gives.
            let head = points.column("head").unwrap();
            assert!(points.frames.iter().skip(8).all(|row| row[head].unwrap().y > row[foot].unwrap().y), "{file}");
        }
    }

    proptest! {
        #[test]
        fn written_and_read_again(
            values in proptest::collection::vec(proptest::collection::vec(-1000.0..1000.0f64, 9), 1..5),
            frame_time in 0.001..1.0f64,
            offset in [-500.0..500.0f64, -500.0..500.0, -500.0..500.0],
            order in Just(BvhChannel::ALL.to_vec()).prop_shuffle(),
        ) {
            let mut motion = arm();
            motion.frames = values;
            motion.frame_time = frame_time;
            motion.joints[1].offset = offset.into();
            motion.joints[0].channels = order.into_iter().map(|(channel, _)| channel).collect();
            let mut bytes = Vec::new();
            write_bvh(&mut bytes, &motion).unwrap();
            let again = parse_bvh(std::str::from_utf8(&bytes).unwrap(), "p.bvh").unwrap();
            prop_assert_eq!(&again.joints.iter().map(|j| (&j.name, j.parent, &j.channels)).collect::<Vec<_>>(),
                &motion.joints.iter().map(|j| (&j.name, j.parent, &j.channels)).collect::<Vec<_>>());
            prop_assert!((again.frame_time - motion.frame_time).abs() < 1e-8);
            let (a, b) = (motion.to_points().unwrap(), again.to_points().unwrap());
            for (p, q) in a.frames.iter().flatten().flatten().zip(b.frames.iter().flatten().flatten()) {
                prop_assert!((*p - *q).length() < 1e-3, "{p} {q}");
            }
        }
    }
}
