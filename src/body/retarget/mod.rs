//! Retargeting: a recorded skeleton's motion given to a body of other proportions, axes and joints.
//!
//! Joints are matched to bones by name. Both at rest, a limb's bone is laid along the recording's by the smallest turn (swing),
//! on top of that of the bone above; so every bone has a wanted orientation in every frame, and the body's angles are those
//! that come nearest to all of them within their limits, where the direction of a limb counts far more than its twist. The
//! root goes the recording's way, scaled by the length of the legs; its height follows from the lowest point of the body,
//! which stands on the floor unless the recorded person is in the air, and feet on the floor do not slide.

mod ground;
mod names;
mod solver;
mod source;

use anyhow::{Context, Result, bail, ensure};
use glam::{DMat3, DQuat, DVec2, DVec3};

use self::ground::Ground;
use self::solver::{Solver, Wanted};
pub use self::source::RetargetSettings;
use self::source::Source;
use super::{Body, DofAxis, PoseTable};
use crate::motion::SkeletalMotion;

/// No joint turns faster, radians a second: where a bone passes a place at which two of its angles turn about one axis, they
/// would swap in an instant.
const FASTEST: f64 = 21.0;

impl Body {
    /// The poses of this body that follow a recorded motion: `frames` of them, `rate` a second, from the motion's first frame.
    ///
    /// # Errors
    /// One sentence: a bone for which the motion has no joint, a person of an unbelievable size (units), one that does not
    /// stand upright at rest, or a motion shorter than the frames asked for that does not repeat.
    pub fn retarget(
        &self,
        motion: &SkeletalMotion,
        settings: &RetargetSettings,
        rate: f64,
        frames: usize,
    ) -> Result<PoseTable> {
        ensure!(rate.is_finite() && rate > 0.0, "the frame rate is {rate}, expected a positive number");
        ensure!(frames > 0, "no frames are asked for, expected at least one");
        motion.check()?;
        let mut source = Source::new(self, motion, settings)?;
        let needed = (frames - 1) as f64 / rate;
        if source.cycle.is_none() && needed > motion.duration() + 1.0 / rate + 1e-9 {
            bail!(
                "the motion lasts {:.2} s, {frames} frames at {rate} Hz last {needed:.2} s: ask for fewer frames, or let it repeat",
                motion.duration()
            );
        }
        source.align_heading(settings.heading);
        let align = self.aligned_at_rest(&source);
        let scale = self.leg_length(&source)? / (source.leg_length(self)? * source.unit);
        let solver = Solver::new(self, &source.names.of_bone, &align.directions);
        let mut ground = Ground::new(self, &source, scale)?;

        let mut pose: Option<Vec<f64>> = None;
        let mut poses = Vec::with_capacity(frames);
        for frame in 0..frames {
            let placed = source.at(frame as f64 / rate);
            let wanted = |bone: usize| {
                let joint = source.names.of_bone[bone]?;
                Some(DMat3::from_quat(placed[joint].rotation * align.turns[bone]))
            };
            let wanted: Vec<Option<Wanted>> = (0..self.bones.len()).map(wanted).collect();
            let mut next = solver.solve(&wanted, pose.as_deref())?;
            if let Some(before) = &pose {
                let most = FASTEST / rate;
                for ((value, before), (_, dof)) in next.iter_mut().zip(before).zip(self.dofs()) {
                    if dof.axis.is_rotation() {
                        *value = value.clamp(before - most, before + most);
                    }
                }
            }
            ground.note(&placed);
            pose = Some(next.clone());
            poses.push(next);
        }
        ground.stand(&mut poses, rate)?;
        let mut table = PoseTable { frames: (0..frames).collect(), poses };
        if let Some(root) = self.root_shift() {
            centre(&mut table, root, settings.at.unwrap_or(DVec2::ZERO));
        }
        for pose in &mut table.poses {
            self.clamp_to_limits(pose);
        }
        Ok(table)
    }

    /// Indices of the root's tx, ty, tz in the state vector, where it has all three.
    fn root_shift(&self) -> Option<[usize; 3]> {
        Some([self.root_dof(DofAxis::Tx)?, self.root_dof(DofAxis::Ty)?, self.root_dof(DofAxis::Tz)?])
    }

    /// Origins of all bones and free ends at rest, root at its offset.
    fn rest_points(&self) -> Result<(Vec<DVec3>, Vec<DVec3>)> {
        let bones = self.world_from_bones(&vec![0.0; self.dof_count()])?;
        let origins = bones.iter().map(|bone| bone.translation).collect();
        let ends = self.free_ends().iter().map(|end| bones[end.bone].transform_point3(end.at)).collect();
        Ok((origins, ends))
    }

    fn leg_length(&self, source: &Source) -> Result<f64> {
        let (origins, ends) = self.rest_points()?;
        source.names.leg(self, &origins, &ends).context("the body's legs")
    }

    /// The turn of each bone at rest that lays it along the recording's, and the direction of each limb's bone.
    fn aligned_at_rest(&self, source: &Source) -> Alignment {
        let mut turns = vec![DQuat::IDENTITY; self.bones.len()];
        let mut directions = vec![None; self.bones.len()];
        let Ok((origins, ends)) = self.rest_points() else { return Alignment { turns, directions } };
        let joints: Vec<DVec3> = source.motion.rest_origins().iter().map(|at| source.turn * *at).collect();
        for &bone in &self.update_order {
            let above = self.bones[bone].parent.map_or(DQuat::IDENTITY, |parent| turns[parent]);
            turns[bone] = above;
            let Some((end, next)) = source.names.follower(self, bone, &origins, &ends) else { continue };
            let Some(joint) = source.names.of_bone[bone] else { continue };
            let direction = (end - origins[bone]).normalize_or_zero();
            let found = (joints[next] - joints[joint]).normalize_or_zero();
            if direction != DVec3::ZERO && found != DVec3::ZERO {
                turns[bone] = DQuat::from_rotation_arc(above * direction, found) * above;
                directions[bone] = Some(direction);
            }
        }
        Alignment { turns, directions }
    }
}

struct Alignment {
    /// `joint_from_bone` at rest.
    turns: Vec<DQuat>,
    /// Along the bone at rest, for bones of limbs.
    directions: Vec<Option<DVec3>>,
}

/// Moves the middle of the way's bounding rectangle to `at`.
fn centre(table: &mut PoseTable, root: [usize; 3], at: DVec2) {
    let way = |pose: &Vec<f64>| DVec2::new(pose[root[0]], pose[root[1]]);
    let low = table.poses.iter().map(way).reduce(DVec2::min).unwrap_or_default();
    let high = table.poses.iter().map(way).reduce(DVec2::max).unwrap_or_default();
    let shift = at - 0.5 * (low + high);
    for pose in &mut table.poses {
        pose[root[0]] += shift.x;
        pose[root[1]] += shift.y;
    }
}

#[cfg(test)]
mod tests;
