//! What an actor does: his pose at any time.

use anyhow::{Context, Result, bail};
use glam::DVec2;

use super::gait::{Gait, Jump, Style, Way};
use super::room::Room;
use super::scene::{self, MotionSettings, MotionUnit, Scene};
use crate::body::{Body, Dof, DofAxis, RetargetSettings};
use crate::motion::read_skeletal_motion;

/// How near an actor's root may come to a wall, mm.
const TO_WALL: f64 = 150.0;

/// An actor's motion.
#[derive(Clone, Debug)]
pub struct Performance {
    part: Part,
    /// Seconds into the motion at the first frame.
    start: f64,
}

#[derive(Clone, Debug)]
enum Part {
    Gait(Gait),
    Jump(Jump),
    Stand(Vec<f64>),
    TPose { body: Box<Body>, at: DVec2, heading: f64 },
    Recorded { rate: f64, poses: Vec<Vec<f64>> },
}

impl Performance {
    /// What `settings` ask of a body in a scene.
    ///
    /// # Errors
    /// When a motion file cannot be read or does not fit the body, or the body has no legs to walk with.
    pub fn new(body: &Body, settings: &MotionSettings, scene: &Scene, room: &Room) -> Result<Self> {
        let at = DVec2::from(settings.at);
        if let Some(file) = &settings.file {
            let poses = recorded(body, settings, scene).with_context(|| file.display().to_string())?;
            return Ok(Self { part: Part::Recorded { rate: scene.fps, poses }, start: 0.0 });
        }
        let heading = settings.heading.map(f64::to_radians);
        let line = |style: &'static Style, heading: f64, stride_time: f64| -> Result<Part> {
            // The way is as long as the scene; its middle is where it is asked to be.
            let pace = Gait::new(body, style, Way::Line { from: at, heading }, stride_time)?.pace();
            let middle = settings.start + 0.5 * (scene.frames - 1) as f64 / scene.fps;
            let from = at - DVec2::from_angle(heading) * (pace * middle);
            Ok(Part::Gait(Gait::new(body, style, Way::Line { from, heading }, stride_time)?))
        };
        let part = match settings.gait.unwrap_or_default() {
            scene::Gait::Circle => {
                let way = Way::Circle { middle: at, radius: settings.radius };
                Part::Gait(Gait::new(body, &Style::WALK, way, settings.stride_time)?)
            }
            scene::Gait::Straight => line(&Style::WALK, heading.unwrap_or(0.0), settings.stride_time)?,
            scene::Gait::Diagonal => {
                line(&Style::WALK, heading.unwrap_or_else(|| room.half_size.to_angle()), settings.stride_time)?
            }
            scene::Gait::Run => line(&Style::RUN, heading.unwrap_or(0.0), 0.6 * settings.stride_time)?,
            scene::Gait::Jump => {
                let period = 2.0 * settings.stride_time;
                Part::Jump(Jump::new(body, at, heading.unwrap_or(0.0), settings.jump_height, period))
            }
            scene::Gait::Stand => Part::Stand(standing(body, at, heading.unwrap_or(0.0))),
            scene::Gait::TPose => Part::TPose { body: Box::new(body.clone()), at, heading: heading.unwrap_or(0.0) },
        };
        Ok(Self { part, start: settings.start })
    }

    /// The state vector (mm, radians) at a time in seconds; before the first and after the last pose of a recording it is
    /// that one's.
    ///
    /// # Errors
    /// When the body cannot be posed.
    pub fn pose(&self, time: f64) -> Result<Vec<f64>> {
        let time = time + self.start;
        Ok(match &self.part {
            Part::Gait(gait) => gait.pose(time),
            Part::Jump(jump) => jump.pose(time)?,
            Part::Stand(pose) => pose.clone(),
            Part::TPose { body, at, heading } => t_pose(body, *at, *heading, time),
            Part::Recorded { rate, poses } => {
                let last = poses.len() - 1;
                let position = (time * rate).clamp(0.0, last as f64);
                // Frame times are whole numbers up to rounding.
                let position = if (position - position.round()).abs() < 1e-9 { position.round() } else { position };
                let (before, after) = (position.floor() as usize, position.ceil() as usize);
                let t = position - position.floor();
                poses[before].iter().zip(&poses[after]).map(|(a, b)| a + (b - a) * t).collect()
            }
        })
    }

    /// The poses of all frames of a scene.
    ///
    /// # Errors
    /// When the actor leaves the room; the frame is named.
    pub fn poses(&self, body: &Body, scene: &Scene, room: &Room) -> Result<Vec<Vec<f64>>> {
        let mut poses = Vec::with_capacity(scene.frames);
        for frame in 0..scene.frames {
            let pose = self.pose(frame as f64 / scene.fps)?;
            let root = body.world_from_bones(&pose)?[body.update_order[0]].translation;
            let limit = room.half_size - TO_WALL;
            if !root.truncate().abs().cmple(limit).all() {
                bail!(
                    "in frame {frame} he is at ({:.0}, {:.0}) mm, expected him within {:.0} x {:.0} mm of the room's middle: ask for fewer frames or another way",
                    root.x,
                    root.y,
                    limit.x,
                    limit.y
                );
            }
            poses.push(pose);
        }
        Ok(poses)
    }
}

fn recorded(body: &Body, settings: &MotionSettings, scene: &Scene) -> Result<Vec<Vec<f64>>> {
    let Some(file) = &settings.file else { bail!("no motion file is named") };
    let motion = read_skeletal_motion(file, settings.skeleton.as_deref(), settings.rate)?;
    let motion = motion.cut(settings.start, settings.until.unwrap_or(f64::INFINITY))?;
    // Mirrored, what goes to the left goes to the right.
    let side = if settings.mirrored { -1.0 } else { 1.0 };
    let retarget = RetargetSettings {
        joints: settings.joints.clone(),
        unit: settings.unit.map(MotionUnit::mm),
        up: settings.up,
        at: Some(DVec2::from(settings.at) * DVec2::new(1.0, side)),
        heading: settings.heading.map(|heading| side * heading.to_radians()),
        repeats: settings.repeats,
    };
    let rate = scene.fps / settings.speed.unwrap_or(1.0);
    let poses = body.retarget(&motion, &retarget, rate, scene.frames)?.poses;
    Ok(if settings.mirrored { poses.iter().map(|pose| mirrored(body, pose)).collect() } else { poses })
}

/// The pose in a mirror along the x axis: bones change sides.
fn mirrored(body: &Body, pose: &[f64]) -> Vec<f64> {
    let twin = |name: &str| match (name.strip_prefix("left_"), name.strip_prefix("right_")) {
        (Some(rest), _) => format!("right_{rest}"),
        (_, Some(rest)) => format!("left_{rest}"),
        _ => name.to_string(),
    };
    let of_twin = |(bone, dof): (usize, &Dof)| {
        let from = twin(&body.bones[bone].name);
        let mut dofs = body.dofs().zip(pose);
        let value = dofs.find(|((other, found), _)| found.axis == dof.axis && body.bones[*other].name == from);
        let sign = if matches!(dof.axis, DofAxis::Ty | DofAxis::Rx | DofAxis::Rz) { -1.0 } else { 1.0 };
        (sign * value.map_or(0.0, |(_, value)| *value)).clamp(dof.limits[0], dof.limits[1])
    };
    body.dofs().map(of_twin).collect()
}

/// With the arms out sideways, as people do it: elbows not quite straight, swaying a little with the time in seconds.
fn t_pose(body: &Body, at: DVec2, heading: f64, time: f64) -> Vec<f64> {
    let mut pose = body.standing_pose();
    let sway = |period: f64, phase: f64| (std::f64::consts::TAU * (time / period + phase)).sin();
    for ((index, dof), value) in body.dofs().zip(&mut pose) {
        let name = body.bones[index].name.as_str();
        let (sign, phase) = if name.starts_with("right") { (-1.0, 0.4) } else { (1.0, 0.0) };
        let asked = match (name, dof.axis.name()) {
            ("pelvis", "tx") => at.x,
            ("pelvis", "ty") => at.y,
            ("pelvis", "rz") => heading,
            ("thorax", "ry") => (1.0 + 1.5 * sway(1.7, 0.2)).to_radians(),
            ("left_shoulder" | "right_shoulder", "rx") => sign * (84.0 + 4.0 * sway(1.3, phase)).to_radians(),
            ("left_elbow" | "right_elbow", "ry") => -(9.0 + 4.0 * sway(1.1, phase)).to_radians(),
            ("left_hip" | "right_hip", "rx") => sign * 6f64.to_radians(),
            _ => continue,
        };
        *value = asked.clamp(dof.limits[0], dof.limits[1]);
    }
    pose
}

/// Standing at ease: arms a little off the body, elbows and knees a little bent.
pub(super) fn standing(body: &Body, at: DVec2, heading: f64) -> Vec<f64> {
    let mut pose = body.standing_pose();
    for ((index, dof), value) in body.dofs().zip(&mut pose) {
        let sign = if body.bones[index].name.starts_with("right") { -1.0 } else { 1.0 };
        let asked = match (body.bones[index].name.as_str(), dof.axis.name()) {
            ("pelvis", "tx") => at.x,
            ("pelvis", "ty") => at.y,
            ("pelvis", "rz") => heading,
            ("left_shoulder" | "right_shoulder", "rx") => sign * 9f64.to_radians(),
            ("left_elbow" | "right_elbow", "ry") => -14f64.to_radians(),
            ("left_hip" | "right_hip", "rx") => sign * 3f64.to_radians(),
            _ => continue,
        };
        *value = asked.clamp(dof.limits[0], dof.limits[1]);
    }
    pose
}

#[cfg(test)]
mod tests {
    use super::super::scene::RoomSettings;
    use super::*;

    fn perform(settings: MotionSettings, frames: usize) -> Result<Vec<Vec<f64>>> {
        let body = Body::adult(1750.0).unwrap();
        let room = Room::new(&RoomSettings::default()).unwrap();
        let scene = Scene { frames, ..Scene::default() };
        Performance::new(&body, &settings, &scene, &room)?.poses(&body, &scene, &room)
    }

    #[test]
    fn every_gait_is_performed_within_limits_round_its_middle() {
        let body = Body::adult(1750.0).unwrap();
        for gait in scene::Gait::ALL {
            let settings =
                MotionSettings { gait: Some(gait), at: [200.0, -100.0], radius: 600.0, ..MotionSettings::default() };
            let frames = if gait == scene::Gait::Run { 25 } else { 60 };
            let poses = perform(settings, frames).unwrap();
            poses.iter().for_each(|pose| body.check_limits(pose).unwrap());
            if [scene::Gait::Straight, scene::Gait::Diagonal, scene::Gait::Run].contains(&gait) {
                let middle = [0, 1].map(|axis| 0.5 * (poses[0][axis] + poses[frames - 1][axis]));
                assert!((middle[0] - 200.0).abs() < 120.0 && (middle[1] + 100.0).abs() < 60.0, "{gait}: {middle:?}");
            }
        }
    }

    #[test]
    fn who_leaves_the_room_is_noticed() {
        let far = MotionSettings { gait: Some(scene::Gait::Straight), ..MotionSettings::default() };
        let error = perform(far, 400).unwrap_err().to_string();
        assert!(error.contains("in frame 0 he is at (-") && error.contains("fewer frames"), "{error}");
        let none = MotionSettings { file: Some("nowhere.bvh".into()), ..MotionSettings::default() };
        assert!(format!("{:#}", perform(none, 4).unwrap_err()).contains("nowhere.bvh"));
    }
}
