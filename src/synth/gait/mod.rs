//! Walking and running along a circle or a line: joint angles over the gait cycle, and a path on which the feet stay where
//! they step. [`Jump`] jumps on the spot.

mod jump;
mod style;

pub use jump::Jump;
pub use style::Style;

use std::f64::consts::TAU;

use anyhow::{Result, ensure};
use glam::{DMat3, DVec2, DVec3};

use crate::body::{Body, DofAxis};
use crate::geometry::EulerOrder;

/// How steady the pace is: 0 follows the joint angles, 1 is constant.
const STEADY: f64 = 0.75;

/// Finely sampled phases of the cycle on which the path is integrated.
const PHASES: usize = 240;

/// Where somebody walks on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// Counter-clockwise round a point, from its +x side.
    Circle {
        /// The middle, mm.
        middle: DVec2,
        /// The radius, mm.
        radius: f64,
    },
    /// Straight ahead.
    Line {
        /// Where it begins, mm.
        from: DVec2,
        /// Where it leads, radians to the left of +x.
        heading: f64,
    },
}

/// A walk (or run) for one body.
#[derive(Clone, Debug)]
pub struct Gait {
    body: Body,
    style: &'static Style,
    /// Seconds for two steps.
    stride_time: f64,
    way: Way,
    /// Radius of the circle, infinite on a line.
    radius: f64,
    /// Change of heading in a stride, radians.
    turn_per_stride: f64,
    /// Half the distance of the hips over the radius of the circle.
    inner_share: f64,
    /// Height of the hips over the floor, mm, roughly.
    leg_length: f64,
    /// Forward travel from phase 0 to each of the phases and to the next cycle's start, mm.
    travel: Vec<f64>,
    /// Height of the pelvis above the floor at each phase, mm.
    height: Vec<f64>,
}

/// Value of a periodic curve given at equal steps, smooth between them (Catmull-Rom). `phase` counts cycles.
fn periodic(samples: &[f64], phase: f64) -> f64 {
    let count = samples.len();
    let position = phase.rem_euclid(1.0) * count as f64;
    let index = position as usize % count;
    let t = position - position.floor();
    let at = |offset: usize| samples[(index + count + offset - 1) % count];
    let (a, b, c, d) = (at(0), at(1), at(2), at(3));
    b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
}

/// The pelvis turns with the leading leg, radians to the left.
fn pelvis_turn(phase: f64) -> f64 {
    (-5.0 * (TAU * phase).cos()).to_radians()
}

impl Gait {
    /// `body` going its `way`, a stride (two steps) in `stride_time` seconds.
    ///
    /// # Errors
    /// When the body has no legs to walk with.
    pub fn new(body: &Body, style: &'static Style, way: Way, stride_time: f64) -> Result<Self> {
        let radius = match way {
            Way::Circle { radius, .. } => radius,
            Way::Line { .. } => f64::INFINITY,
        };
        // Straight ahead nothing depends on the way yet; it is measured below.
        let even: Vec<f64> = (0..=PHASES).map(|i| i as f64).collect();
        let mut gait = Self {
            body: body.clone(),
            style,
            stride_time,
            way,
            radius,
            turn_per_stride: 0.0,
            inner_share: 0.0,
            leg_length: 1.0,
            travel: even,
            height: Vec::new(),
        };
        // Straight ahead from a pelvis at the origin: where are the points of the feet that can touch the floor?
        let feet: Vec<Vec<DVec3>> = (0..=PHASES)
            .map(|i| gait.sole_points(&gait.posture(i as f64 / PHASES as f64, 0.0)))
            .collect::<Result<_>>()?;
        let flight = |index: usize| style.flight(index as f64 / PHASES as f64);
        for (index, points) in feet.iter().take(PHASES).enumerate() {
            gait.height.push(flight(index) - soft_minimum(points));
        }
        let mut advances = Vec::with_capacity(PHASES);
        for pair in feet.windows(2) {
            // The lowest points carry the weight: they stand still, so the pelvis moves against them.
            let lowest = pair[0].iter().chain(&pair[1]).map(|p| p.z).fold(f64::INFINITY, f64::min);
            let (mut sum, mut weights) = (0.0, 0.0);
            for (before, after) in pair[0].iter().zip(&pair[1]) {
                let weight = (-(before.z.min(after.z) - lowest) / 6.0).exp();
                sum += weight * (before.x - after.x);
                weights += weight;
            }
            advances.push(if weights > 0.0 { sum / weights } else { 0.0 });
        }
        // In the air the pelvis keeps the pace that the feet have given it.
        let on_floor: Vec<f64> = (0..PHASES).filter(|&i| flight(i) == 0.0).map(|i| advances[i]).collect();
        let pace = on_floor.iter().sum::<f64>() / on_floor.len().max(1) as f64;
        let mut travelled = 0.0;
        let mut travel = vec![travelled];
        for (index, advance) in advances.into_iter().enumerate() {
            travelled += if flight(index) > 0.0 { pace } else { advance };
            travel.push(travelled);
        }
        ensure!(travelled > 1.0, "the body `{}` makes no way when its legs walk", body.name);
        gait.travel = travel;
        gait.turn_per_stride = travelled / radius;
        gait.leg_length = gait.height.iter().sum::<f64>() / PHASES as f64;
        gait.inner_share = body.bone_index("left_hip").map_or(0.0, |hip| body.bones[hip].offset.y) / radius;
        Ok(gait)
    }

    /// Way made in a second, mm.
    pub fn pace(&self) -> f64 {
        self.travel[PHASES] / self.stride_time
    }

    /// The state vector (mm, radians) at a time in seconds.
    pub fn pose(&self, time: f64) -> Vec<f64> {
        let strides = time / self.stride_time;
        let phase = self.phase(strides.rem_euclid(1.0));
        let strides_made = strides.floor() + self.travelled(phase);
        let along = strides_made * self.turn_per_stride;
        let heading = match self.way {
            Way::Circle { .. } => along + TAU / 4.0,
            Way::Line { heading, .. } => heading,
        };

        let mut pose = self.posture(phase, heading);
        // Weight shifts over the standing leg: left heel strikes at phase 0, so the body is on the left around 0.25.
        let sway = 10.0 * (TAU * phase).sin();
        let place = match self.way {
            Way::Circle { middle, radius } => middle + DVec2::from_angle(along) * (radius - sway),
            Way::Line { from, heading } => {
                let ahead = DVec2::from_angle(heading);
                from + ahead * (strides_made * self.travel[PHASES]) + ahead.perp() * sway
            }
        };
        let place = place.extend(periodic(&self.height, phase));
        self.set(&mut pose, "pelvis", DofAxis::Tx, place.x);
        self.set(&mut pose, "pelvis", DofAxis::Ty, place.y);
        self.set(&mut pose, "pelvis", DofAxis::Tz, place.z);
        pose
    }

    /// The part of a stride's way that is done at a phase from 0 to 1.
    fn travelled(&self, phase: f64) -> f64 {
        let position = phase.clamp(0.0, 1.0) * PHASES as f64;
        let index = (position as usize).min(PHASES - 1);
        let way = self.travel[index] + (self.travel[index + 1] - self.travel[index]) * (position - index as f64);
        way / self.travel[PHASES]
    }

    /// The phase at a fraction of the stride's time. Joint angles over equal phases would make the body dash over the toe
    /// and linger on the heel; time follows the way instead, so that the pelvis goes at a nearly steady pace.
    fn phase(&self, time: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let clock = (1.0 - STEADY) * middle + STEADY * self.travelled(middle);
            *(if clock < time { &mut low } else { &mut high }) = middle;
        }
        0.5 * (low + high)
    }

    /// How far, in strides, the body's heading runs ahead of a leg at a phase of that leg: while the foot stands it keeps
    /// its direction in the world and on a circle the body turns over it; in swing the leg catches up.
    fn lead(&self, phase: f64) -> f64 {
        let phase = phase.rem_euclid(1.0);
        let lift = self.style.lift;
        let middle = self.travelled(self.style.over);
        if phase < lift {
            return self.travelled(phase) - middle;
        }
        let t = (phase - lift) / (1.0 - lift);
        let ahead = self.travelled(lift) - middle;
        ahead + (-middle - ahead) * t * t * (3.0 - 2.0 * t)
    }

    /// Turns the pelvis: with the leading leg, a little down on the swinging side and into the circle.
    fn turn_pelvis(&self, pose: &mut [f64], phase: f64, heading: f64) {
        let list = (-2.5 * (TAU * phase).sin() - if self.radius.is_finite() { 1.5 } else { 0.0 }).to_radians();
        let rotation = DMat3::from_rotation_z(heading + pelvis_turn(phase)) * DMat3::from_rotation_x(list);
        let [rx, ry, rz] = EulerOrder::Xyz.angles(&rotation);
        // Unwrapped next to the heading, which goes round and round.
        let rz = rz + TAU * ((heading - rz) / TAU).round();
        self.set(pose, "pelvis", DofAxis::Rx, rx);
        self.set(pose, "pelvis", DofAxis::Ry, ry);
        self.set(pose, "pelvis", DofAxis::Rz, rz);
    }

    /// All joints and the pelvis' rotation at a phase of the cycle; the pelvis stays at the origin.
    fn posture(&self, phase: f64, heading: f64) -> Vec<f64> {
        let style = self.style;
        let mut pose = vec![0.0; self.body.dof_count()];
        self.turn_pelvis(&mut pose, phase, heading);
        let mut degrees = |bone: &str, axis, value: f64| self.set(&mut pose, bone, axis, value.to_radians());
        for (side, sign, shift) in [("left", 1.0, 0.0), ("right", -1.0, 0.5)] {
            let own = phase + shift;
            let (hip, knee) = (format!("{side}_hip"), format!("{side}_knee"));
            // Flexion lifts the limb forward: a negative turn about y for the hip, a positive one for the knee.
            let lead = self.turn_per_stride * self.lead(own);
            // The path bends away from the line on which the foot stands, to the left of it before and after.
            let aside = if self.radius.is_finite() { self.radius * (1.0 - lead.cos()) / self.leg_length } else { 0.0 };
            // The inner leg has the shorter way.
            let reach = 1.0 - sign * self.inner_share;
            let leg = DMat3::from_rotation_z(-pelvis_turn(phase) - lead)
                * DMat3::from_rotation_x((sign * (2.0 + 2.0 * (TAU * own).sin())).to_radians() - aside)
                * DMat3::from_rotation_y(-(reach * periodic(&style.hip, own)).to_radians())
                * DMat3::from_rotation_z((sign * 5.0f64).to_radians());
            for (axis, angle) in [DofAxis::Rx, DofAxis::Ry, DofAxis::Rz].into_iter().zip(EulerOrder::Xyz.angles(&leg)) {
                degrees(&hip, axis, angle.to_degrees());
            }
            degrees(&knee, DofAxis::Ry, periodic(&style.knee, own));
            // Arms swing against the leg of their side.
            let swing = -(TAU * (own - 0.02)).cos();
            let (clavicle, shoulder, elbow) =
                (format!("{side}_clavicle"), format!("{side}_shoulder"), format!("{side}_elbow"));
            degrees(&clavicle, DofAxis::Rx, sign * -2.0);
            degrees(&shoulder, DofAxis::Rx, sign * 9.0);
            degrees(&shoulder, DofAxis::Ry, -(4.0 + style.arm_swing * swing));
            degrees(&shoulder, DofAxis::Rz, sign * -8.0);
            degrees(&elbow, DofAxis::Ry, -(style.elbow[0] + style.elbow[1] * (TAU * (own + 0.45)).cos()));
        }
        degrees("thorax", DofAxis::Ry, style.lean + 1.5 * (2.0 * TAU * phase).cos());
        degrees("thorax", DofAxis::Rz, 10.0 * (TAU * phase).cos());
        degrees("head", DofAxis::Ry, -2.0);
        // On a circle one looks where one goes.
        let aside = if self.radius.is_finite() { 8.0 } else { 0.0 };
        degrees("head", DofAxis::Rz, -5.0 * (TAU * phase).cos() + aside);
        pose
    }

    fn set(&self, pose: &mut [f64], bone: &str, axis: DofAxis, value: f64) {
        set(&self.body, pose, bone, axis, value);
    }

    fn sole_points(&self, pose: &[f64]) -> Result<Vec<DVec3>> {
        sole_points(&self.body, pose)
    }
}

/// Sets a degree of freedom within its limits; a body without it keeps still there.
fn set(body: &Body, pose: &mut [f64], bone: &str, axis: DofAxis, value: f64) {
    for (index, (of, dof)) in body.dofs().enumerate() {
        if dof.axis == axis && body.bones[of].name == bone {
            pose[index] = value.clamp(dof.limits[0], dof.limits[1]);
        }
    }
}

/// The under side of heels and toes in the world.
fn sole_points(body: &Body, pose: &[f64]) -> Result<Vec<DVec3>> {
    let frames = body.world_from_bones(pose)?;
    let mut points = Vec::new();
    for side in ["left", "right"] {
        let Some(knee) = body.bone_index(&format!("{side}_knee")) else { continue };
        for part in body.parts.iter().filter(|part| part.bone == knee).skip(1) {
            for (at, radius) in [(part.a, part.radius_a), (part.b, part.radius_b)] {
                points.push(frames[knee].transform_point3(at) - DVec3::Z * radius);
            }
        }
    }
    Ok(points)
}

/// Height of the lowest points, blended where two are nearly equal so that the pelvis does not jerk.
fn soft_minimum(points: &[DVec3]) -> f64 {
    const BLEND: f64 = 5.0;
    let lowest = points.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    if !lowest.is_finite() {
        return 0.0;
    }
    lowest - BLEND * points.iter().map(|p| (-(p.z - lowest) / BLEND).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walk() -> (Body, Gait) {
        let body = Body::adult(1750.0).unwrap();
        let gait = Gait::new(&body, &Style::WALK, Way::Circle { middle: DVec2::ZERO, radius: 950.0 }, 1.2).unwrap();
        (body, gait)
    }

    #[test]
    fn the_walk_goes_on_at_a_walking_pace() {
        let (_, gait) = walk();
        let stride = gait.travel[PHASES];
        assert!((1000.0..1600.0).contains(&stride), "a stride of {stride} mm");
        let (low, high) = gait.height.iter().fold((f64::MAX, 0.0f64), |(l, h), &z| (l.min(z), h.max(z)));
        assert!(low > 870.0 && high < 980.0 && high - low < 70.0, "the pelvis bobs between {low} and {high}");
    }

    #[test]
    fn feet_on_the_floor_stand_still() {
        let (_, gait) = walk();
        let points = |time: f64| gait.sole_points(&gait.pose(time)).unwrap();
        let mut standing = 0;
        let mut slip = 0.0;
        for step in 0..300 {
            let time = f64::from(step) * 0.01;
            let (before, after) = (points(time), points(time + 0.01));
            let lowest = before.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
            assert!((-30.0..30.0).contains(&lowest), "the lowest point is at {lowest}");
            for (a, b) in before.iter().zip(&after).filter(|(a, _)| a.z < lowest + 2.0) {
                standing += 1;
                slip += a.truncate().distance(b.truncate());
            }
        }
        // The walk is worked out straight ahead, so that on the circle feet turn a little under the body.
        let slip = slip / f64::from(standing) / 0.01;
        assert!(slip < 200.0, "{slip} mm/s");
    }

    #[test]
    fn poses_are_within_limits_smooth_and_on_the_circle() {
        let (body, gait) = walk();
        let mut last: Option<Vec<f64>> = None;
        for frame in 0..200 {
            let pose = gait.pose(f64::from(frame) / 25.0);
            body.check_limits(&pose).unwrap();
            let radius = pose[0].hypot(pose[1]);
            assert!((radius - 950.0).abs() < 25.0, "{radius}");
            if let Some(last) = last {
                for ((a, b), (name, (_, dof))) in pose.iter().zip(&last).zip(body.dof_names().iter().zip(body.dofs())) {
                    let most = if dof.axis.is_rotation() { 22.0f64.to_radians() } else { 90.0 };
                    assert!((a - b).abs() < most, "{name} jumps from {b} to {a}");
                }
            }
            last = Some(pose);
        }
    }

    #[test]
    fn a_line_is_kept_and_a_run_leaves_the_floor() {
        let body = Body::adult(1750.0).unwrap();
        let way = Way::Line { from: DVec2::new(-1000.0, 500.0), heading: 0.6 };
        for (style, stride_time, least, most) in
            [(&Style::WALK, 1.2, 900.0, 1500.0), (&Style::RUN, 0.72, 1900.0, 4500.0)]
        {
            let gait = Gait::new(&body, style, way, stride_time).unwrap();
            assert!((least..most).contains(&gait.pace()), "{} mm/s", gait.pace());
            let (mut highest, mut slip, mut standing) = (0.0f64, 0.0, 0);
            for step in 0..400 {
                let time = f64::from(step) * 0.005;
                let pose = gait.pose(time);
                body.check_limits(&pose).unwrap();
                let off = (DVec2::new(pose[0], pose[1]) - DVec2::new(-1000.0, 500.0)).perp_dot(DVec2::from_angle(0.6));
                assert!(off.abs() < 12.0, "{off} mm off the line");
                let (before, after) =
                    (gait.sole_points(&pose).unwrap(), gait.sole_points(&gait.pose(time + 0.005)).unwrap());
                let lowest = before.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
                highest = highest.max(lowest);
                assert!(lowest > -30.0, "{lowest}");
                for (a, b) in before.iter().zip(&after).filter(|(a, b)| a.z < 3.0 && b.z < 3.0) {
                    standing += 1;
                    slip += a.truncate().distance(b.truncate());
                }
            }
            assert_eq!(highest > 30.0, style.lift < 0.5, "the feet are {highest} mm above the floor");
            let slip = slip / f64::from(standing.max(1)) / 0.005;
            assert!(slip < 250.0, "{slip} mm/s");
        }
    }

    #[test]
    fn the_curve_passes_through_its_samples_and_closes() {
        for (index, sample) in Style::WALK.knee.iter().enumerate() {
            assert!((periodic(&Style::WALK.knee, index as f64 / 10.0 + 3.0) - sample).abs() < 1e-9);
        }
        assert!((periodic(&Style::WALK.hip, -1e-9) - periodic(&Style::WALK.hip, 1e-9)).abs() < 1e-5);
    }
}
