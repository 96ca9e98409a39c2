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

use std::collections::BTreeMap;

use anyhow::{Context, Result, bail, ensure};
use glam::{DMat3, DQuat, DVec2, DVec3};

use self::ground::Ground;
use self::names::JointNames;
use self::solver::{Solver, Wanted};
use super::{Body, DofAxis, PoseTable};
use crate::motion::{SkeletalMotion, UpAxis};

/// How a motion is given to a body. Everything that is `None` is found out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RetargetSettings {
    /// Names of the motion's joints by bones and free ends of the body, where the names themselves do not tell.
    pub joints: BTreeMap<String, String>,
    /// Length of the motion's unit, mm.
    pub unit: Option<f64>,
    /// Which way is up.
    pub up: Option<UpAxis>,
    /// The middle of the way on the floor, mm; else the origin.
    pub at: Option<DVec2>,
    /// Where the person faces in the first frame, radians to the left of +x; else as in the file, where a person at rest
    /// faces +x.
    pub heading: Option<f64>,
    /// Begin again where the motion ends, from the place it has reached, also where the file does not say so.
    pub repeats: bool,
}

/// No joint turns faster, radians a second: where a bone passes a place at which two of its angles turn about one axis, they
/// would swap in an instant.
const FASTEST: f64 = 21.0;

/// Height of a grown person over the length of the leg from hip to ankle (Drillis and Contini: 0.530 - 0.039 of stature).
const STATURE_OF_LEG: f64 = 1.0 / 0.491;
/// Heights that are believed of a person, mm.
const BELIEVED: std::ops::RangeInclusive<f64> = 500.0..=2600.0;
/// Units that files without one are in: mm, cm, inches, those of CMU's collection, metres.
const UNITS: [(&str, f64); 5] =
    [("mm", 1.0), ("cm", 10.0), ("inch", 25.4), ("inch / 0.45", 25.4 / 0.45), ("m", 1000.0)];

/// The recording in the body's world: mm, z up, the person at rest facing +x.
struct Source<'a> {
    motion: &'a SkeletalMotion,
    names: JointNames,
    /// From the file's axes.
    turn: DQuat,
    unit: f64,
    /// By how much everything is turned about z, radians.
    heading: f64,
    /// The root's advance over the whole motion, for repeats: turn about z and way.
    cycle: Option<(f64, DVec2)>,
}

/// A joint in the body's world.
#[derive(Clone, Copy)]
struct Placed {
    rotation: DQuat,
    origin: DVec3,
}

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
        let find = |axis| self.dofs().position(|(bone, dof)| self.bones[bone].parent.is_none() && dof.axis == axis);
        Some([find(DofAxis::Tx)?, find(DofAxis::Ty)?, find(DofAxis::Tz)?])
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

impl<'a> Source<'a> {
    fn new(body: &Body, motion: &'a SkeletalMotion, settings: &RetargetSettings) -> Result<Self> {
        let names = JointNames::find(body, motion, &settings.joints)?;
        let rest = motion.rest_origins();
        let (hips, head) = names.trunk(body, &rest)?;
        let trunk = head - hips;
        let up = settings.up.or(motion.up).unwrap_or(if trunk.y.abs() > trunk.z.abs() { UpAxis::Y } else { UpAxis::Z });
        let upright = match up {
            UpAxis::Y => DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2),
            UpAxis::Z => DQuat::IDENTITY,
        };
        ensure!(
            (upright * trunk).normalize_or_zero().z > 0.5,
            "at rest its head is not above its hips (from one to the other: {trunk}), expected a person upright: is the up axis right?"
        );
        let across = (upright * names.across(body, &rest)?).truncate();
        ensure!(across.length() > 0.0, "its left and right hip are in one place, expected them side by side");
        let turn = DQuat::from_rotation_z(across.x.atan2(across.y)) * upright;
        let mut source = Self { motion, names, turn, unit: 1.0, heading: 0.0, cycle: None };
        source.unit = source.believed_unit(body, settings.unit.or(motion.unit))?;
        if motion.wraps || settings.repeats {
            let root = source.names.pelvis;
            let [first, last] =
                [&motion.frames[0], &motion.frames[motion.frames.len() - 1]].map(|row| source.placed(row)[root]);
            let turned = yaw(last.rotation) - yaw(first.rotation);
            let way = last.origin.truncate() - DVec2::from_angle(turned).rotate(first.origin.truncate());
            source.cycle = Some((turned, way));
        }
        Ok(source)
    }

    /// The unit in mm, if a person in it has a believable size.
    fn believed_unit(&self, body: &Body, known: Option<f64>) -> Result<f64> {
        let leg = self.leg_length(body)?;
        let stature = |unit: f64| leg * unit * STATURE_OF_LEG;
        match known {
            Some(unit) => {
                ensure!(
                    BELIEVED.contains(&stature(unit)),
                    "with a unit of {unit:.4} mm its person is {:.2} m tall, expected {:.1} to {:.1} m: is the unit right?",
                    stature(unit) / 1000.0,
                    BELIEVED.start() / 1000.0,
                    BELIEVED.end() / 1000.0
                );
                Ok(unit)
            }
            None => {
                let likely = |unit: &f64| (1000.0..2300.0).contains(&stature(*unit));
                let found = UNITS.iter().map(|(_, unit)| *unit).find(likely);
                found.ok_or_else(|| {
                    let heights: Vec<String> = UNITS
                        .iter()
                        .map(|(name, unit)| format!("{:.3} m in {name}", stature(*unit) / 1000.0))
                        .collect();
                    anyhow::anyhow!("its person is {}, expected 1 to 2.3 m: name the unit", heights.join(", "))
                })
            }
        }
    }

    fn leg_length(&self, body: &Body) -> Result<f64> {
        let rest = self.motion.rest_origins();
        self.names.leg_of_joints(body, &rest).context("the motion's legs")
    }

    /// Turns the whole recording so that its first frame faces `heading`.
    fn align_heading(&mut self, heading: Option<f64>) {
        if let Some(heading) = heading {
            let first = self.placed(&self.motion.frames[0])[self.names.pelvis];
            self.world_turn(heading - yaw(first.rotation));
        }
    }

    /// Turns the world about z: rotations are conjugated by `turn`, so that the person's own axes stay.
    fn world_turn(&mut self, angle: f64) {
        self.heading += angle;
        if let Some((_, way)) = &mut self.cycle {
            *way = DVec2::from_angle(angle).rotate(*way);
        }
    }

    fn placed(&self, local: &[crate::motion::Placement]) -> Vec<Placed> {
        let heading = DQuat::from_rotation_z(self.heading);
        self.motion
            .global(local)
            .into_iter()
            .map(|at| Placed {
                rotation: heading * self.turn * at.rotation * self.turn.inverse(),
                origin: heading * (self.turn * at.origin) * self.unit,
            })
            .collect()
    }

    /// The joints at a time, repeated as often as needed.
    fn at(&self, time: f64) -> Vec<Placed> {
        let duration = self.motion.duration();
        let (Some((turned, way)), true) = (self.cycle, time > duration && duration > 0.0) else {
            return self.placed(&self.motion.at(time));
        };
        let rounds = (time / duration).floor();
        let mut placed = self.placed(&self.motion.at(time - rounds * duration));
        for _ in 0..rounds.min(1e6) as usize {
            let turn = DQuat::from_rotation_z(turned);
            for joint in &mut placed {
                joint.rotation = turn * joint.rotation;
                joint.origin = turn * joint.origin + way.extend(0.0);
            }
        }
        placed
    }
}

/// Where a rotation takes the x axis, seen from above.
fn yaw(rotation: DQuat) -> f64 {
    let x = rotation * DVec3::X;
    x.y.atan2(x.x)
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
