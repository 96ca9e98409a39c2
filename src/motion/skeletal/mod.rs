//! Skeletons in motion, whatever file they come from: a tree of joints and, for every frame, how each is turned and
//! shifted against its parent. BVH, ASF/AMC and DeepMimic clips are read into it; units and axes stay the file's, and are
//! stated where the format says them.

mod amc;
mod asf;
mod deepmimic;
mod file;

pub use amc::parse_amc;
pub use asf::{AsfBone, AsfSkeleton, parse_asf};
pub use deepmimic::{DeepMimicSkeleton, parse_deepmimic, parse_deepmimic_skeleton};
pub use file::{MotionFormat, read_skeletal_motion};

use std::collections::HashSet;

use anyhow::{Result, ensure};
use glam::{DQuat, DVec3};

use super::bvh::{BvhMotion, joint_placement};
use crate::files::choices;

choices! {
    /// Which way is up in a file.
    "axis that is up" pub enum UpAxis {
        /// +y
        "y" Y,
        /// +z
        "z" Z,
    }
}

/// A joint of the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletalJoint {
    /// Its name.
    pub name: String,
    /// Index of its parent, always smaller than its own; `None` for a root. So there can be no cycle.
    pub parent: Option<usize>,
    /// Its origin at rest from its parent's, in the file's axes and unit. At rest every joint has the file's axes.
    pub offset: DVec3,
    /// Whether it is only the free end of its parent: it has no motion of its own.
    pub is_end: bool,
}

/// A joint against its parent in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// `parent_from_joint`, of length 1.
    pub rotation: DQuat,
    /// The joint's origin in the parent's frame, file's unit.
    pub origin: DVec3,
}

/// A skeleton and its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletalMotion {
    /// Parents before their children.
    pub joints: Vec<SkeletalJoint>,
    /// Length of the file's unit, mm, where the format says it.
    pub unit: Option<f64>,
    /// Which way is up, where the format says it.
    pub up: Option<UpAxis>,
    /// Time of every frame from the first, seconds, rising.
    pub times: Vec<f64>,
    /// One placement a joint, a row a frame.
    pub frames: Vec<Vec<Placement>>,
    /// Whether the motion begins again where it ends, going on from the place it has reached.
    pub wraps: bool,
}

/// A short file can describe a product of joints and frames that fills any memory.
const MOST_PLACEMENTS: usize = 1 << 24;

impl SkeletalMotion {
    /// Holds what the readers promise.
    ///
    /// # Errors
    /// One sentence that names the joint or the frame.
    pub fn check(&self) -> Result<()> {
        ensure!(!self.joints.is_empty(), "there are no joints, expected at least a root");
        ensure!(!self.frames.is_empty(), "there are no frames, expected at least one");
        ensure!(
            self.times.len() == self.frames.len(),
            "there are {} times for {} frames",
            self.times.len(),
            self.frames.len()
        );
        let mut names = HashSet::new();
        for (index, joint) in self.joints.iter().enumerate() {
            let name = &joint.name;
            ensure!(names.insert(name), "two joints are named `{name}`, expected every name once");
            ensure!(joint.parent.is_none_or(|parent| parent < index), "joint `{name}` stands before its parent");
            ensure!(joint.offset.is_finite(), "joint `{name}` has an offset that is not finite");
        }
        if let Some(pair) = self.times.windows(2).find(|pair| pair[0].is_nan() || pair[1] <= pair[0]) {
            anyhow::bail!("a frame at {} s follows one at {} s, expected rising times", pair[1], pair[0]);
        }
        for (frame, row) in self.frames.iter().enumerate() {
            ensure!(row.len() == self.joints.len(), "frame {frame} places {} joints", row.len());
            let sound = |at: &Placement| at.origin.is_finite() && (at.rotation.length() - 1.0).abs() < 1e-6;
            ensure!(row.iter().all(sound), "frame {frame} holds a placement that is not finite");
        }
        Ok(())
    }

    /// Seconds from the first frame to the last.
    pub fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// The placements at a time, between two frames turned along the shortest way; before the first and after the last
    /// frame they stay.
    pub fn at(&self, time: f64) -> Vec<Placement> {
        let after = self.times.partition_point(|&t| t <= time);
        let (before, after) = (after.saturating_sub(1), after.min(self.frames.len() - 1));
        let span = self.times[after] - self.times[before];
        let t = if span > 0.0 { ((time - self.times[before]) / span).clamp(0.0, 1.0) } else { 0.0 };
        let mix = |(a, b): (&Placement, &Placement)| Placement {
            rotation: a.rotation.slerp(b.rotation, t).normalize(),
            origin: a.origin.lerp(b.origin, t),
        };
        self.frames[before].iter().zip(&self.frames[after]).map(mix).collect()
    }

    /// Placements in the file's world instead of the parents' frames.
    pub fn global(&self, local: &[Placement]) -> Vec<Placement> {
        let mut global: Vec<Placement> = Vec::with_capacity(local.len());
        for (joint, own) in self.joints.iter().zip(local) {
            global.push(match joint.parent {
                None => *own,
                Some(parent) => {
                    let above = global[parent];
                    Placement {
                        rotation: (above.rotation * own.rotation).normalize(),
                        origin: above.origin + above.rotation * own.origin,
                    }
                }
            });
        }
        global
    }

    /// Origins of all joints at rest in the file's axes, roots at their offset.
    pub fn rest_origins(&self) -> Vec<DVec3> {
        let mut origins: Vec<DVec3> = Vec::with_capacity(self.joints.len());
        for joint in &self.joints {
            origins.push(joint.parent.map_or(DVec3::ZERO, |parent| origins[parent]) + joint.offset);
        }
        origins
    }

    /// The frames from `first` to `last` seconds alone (those nearest to the ends included), beginning at time 0.
    ///
    /// # Errors
    /// When no time is left.
    pub fn cut(mut self, first: f64, last: f64) -> Result<Self> {
        ensure!(
            first >= 0.0 && first <= last && first <= self.duration(),
            "the motion is {:.3} s long, so there is nothing from {first} s to {last} s",
            self.duration()
        );
        let begin = self.times.partition_point(|&t| t < first - 1e-9);
        let end = self.times.partition_point(|&t| t <= last + 1e-9).max(begin + 1);
        self.times = self.times[begin..end].iter().map(|t| t - self.times[begin]).collect();
        self.frames = self.frames[begin..end].to_vec();
        Ok(self)
    }
}

impl BvhMotion {
    /// The motion as joints turned against their parents; free ends become joints named `<joint>_end`.
    ///
    /// # Errors
    /// When the motion breaks [`Self::check`], or is too large.
    pub fn to_skeletal(&self) -> Result<SkeletalMotion> {
        self.check()?;
        ensure_size(
            self.joints.len() + self.joints.iter().map(|j| j.end_sites.len()).sum::<usize>(),
            self.frames.len(),
        )?;
        let names = self.to_point_names();
        let mut joints: Vec<SkeletalJoint> = self
            .joints
            .iter()
            .map(|joint| SkeletalJoint {
                name: joint.name.clone(),
                parent: joint.parent,
                offset: joint.offset,
                is_end: false,
            })
            .collect();
        let ends = self
            .joints
            .iter()
            .enumerate()
            .flat_map(|(parent, joint)| joint.end_sites.iter().map(move |end| (parent, *end)));
        for ((parent, offset), name) in ends.zip(&names[self.joints.len()..]) {
            joints.push(SkeletalJoint { name: name.clone(), parent: Some(parent), offset, is_end: true });
        }
        let frames = self
            .frames
            .iter()
            .map(|row| {
                let mut values = row.iter();
                let mut placed: Vec<Placement> = Vec::with_capacity(joints.len());
                for joint in &self.joints {
                    let local = joint_placement(joint.offset, &joint.channels, &mut values);
                    placed.push(Placement {
                        rotation: DQuat::from_mat3(&local.matrix3).normalize(),
                        origin: local.translation,
                    });
                }
                let ends = joints[self.joints.len()..].iter();
                placed.extend(ends.map(|end| Placement { rotation: DQuat::IDENTITY, origin: end.offset }));
                placed
            })
            .collect();
        let times = (0..self.frames.len()).map(|frame| frame as f64 * self.frame_time).collect();
        let unit = self.statement.map(|said| said.millimetres);
        let up = self.statement.map(|_| UpAxis::Y);
        let motion = SkeletalMotion { joints, unit, up, times, frames, wraps: false };
        motion.check()?;
        Ok(motion)
    }
}

/// Refuses products of joints and frames that no memory should hold.
fn ensure_size(joints: usize, frames: usize) -> Result<()> {
    ensure!(
        joints.saturating_mul(frames) <= MOST_PLACEMENTS,
        "{joints} joints in {frames} frames are too many, expected at most {MOST_PLACEMENTS} placements in all"
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::motion::bvh::tests::arm;

    #[test]
    fn a_bvh_has_its_points_where_its_joints_are() {
        let (motion, points) = (arm().to_skeletal().unwrap(), arm().to_points().unwrap());
        assert_eq!(motion.joints.iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), points.names);
        for (local, row) in motion.frames.iter().zip(&points.frames) {
            for (placed, point) in motion.global(local).iter().zip(row) {
                assert!(placed.origin.distance(point.unwrap()) < 1e-9);
            }
        }
    }

    #[test]
    fn between_frames_joints_turn_half_the_way() {
        let motion = arm().to_skeletal().unwrap();
        let middle = motion.at(0.005);
        let (angle, whole) = (
            middle[1].rotation.angle_between(motion.frames[0][1].rotation),
            motion.frames[1][1].rotation.angle_between(motion.frames[0][1].rotation),
        );
        assert!((angle - 0.5 * whole).abs() < 1e-9, "{angle} {whole}");
        assert_eq!(motion.at(-3.0), motion.frames[0]);
        assert_eq!(motion.at(99.0), motion.frames[1]);
        let cut = motion.clone().cut(0.01, 9.0).unwrap();
        assert_eq!((cut.times.as_slice(), cut.frames.len()), (&[0.0][..], 1));
        assert!(motion.cut(0.5, 9.0).unwrap_err().to_string().contains("0.010 s long"));
    }
}
