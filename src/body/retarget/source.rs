//! A recorded motion in the body's world.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};
use glam::{DQuat, DVec2, DVec3};

use super::names::JointNames;
use crate::body::Body;
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

/// Height of a grown person over the length of the leg from hip to ankle (Drillis and Contini: 0.530 - 0.039 of stature).
const STATURE_OF_LEG: f64 = 1.0 / 0.491;
/// Heights that are believed of a person, mm.
const BELIEVED: std::ops::RangeInclusive<f64> = 500.0..=2600.0;
/// Units that files without one are in: mm, cm, inches, those of CMU's collection, metres.
const UNITS: [(&str, f64); 5] =
    [("mm", 1.0), ("cm", 10.0), ("inch", 25.4), ("inch / 0.45", 25.4 / 0.45), ("m", 1000.0)];

/// The recording in the body's world: mm, z up, the person at rest facing +x.
pub(super) struct Source<'a> {
    pub(super) motion: &'a SkeletalMotion,
    pub(super) names: JointNames,
    /// From the file's axes.
    pub(super) turn: DQuat,
    pub(super) unit: f64,
    /// By how much everything is turned about z, radians.
    pub(super) heading: f64,
    /// The root's advance over the whole motion, for repeats: turn about z and way.
    pub(super) cycle: Option<(f64, DVec2)>,
}

/// A joint in the body's world.
#[derive(Clone, Copy)]
pub(super) struct Placed {
    pub(super) rotation: DQuat,
    pub(super) origin: DVec3,
}

impl<'a> Source<'a> {
    pub(super) fn new(body: &Body, motion: &'a SkeletalMotion, settings: &RetargetSettings) -> Result<Self> {
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

    pub(super) fn leg_length(&self, body: &Body) -> Result<f64> {
        let rest = self.motion.rest_origins();
        self.names.leg_of_joints(body, &rest).context("the motion's legs")
    }

    /// Turns the whole recording so that its first frame faces `heading`.
    pub(super) fn align_heading(&mut self, heading: Option<f64>) {
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
    pub(super) fn at(&self, time: f64) -> Vec<Placed> {
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
