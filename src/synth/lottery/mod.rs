//! Scenes that nobody chose: person, motion, room, light, cameras and sensors drawn from a seed, for tracking what no setting was
//! tuned on (docs/SCENES.md). What may be drawn is frozen: another range is another lottery.

mod action;
mod draws;
mod person;
mod place;
mod sources;
mod stage;

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};

use self::draws::Draws;
use super::build::body_of;
use super::scene::{ActorSettings, RigSettings, Scene};

/// Frames of a scene where nobody asks for another number.
const FRAMES: usize = 75;
/// The T-pose second: frames, and frames a second.
const T_POSE: usize = 12;

/// What a scene is drawn from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LotterySettings {
    /// The seed of everything.
    pub seed: u64,
    /// A folder with recorded motions; the built-in gaits without one.
    pub motions: Option<PathBuf>,
    /// A folder with skinned people; our own figures without one.
    pub people: Option<PathBuf>,
    /// Number of frames, if another than 75.
    pub frames: Option<usize>,
}

/// A scene drawn from a seed, and what a user would record and say of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Lottery {
    /// The scene.
    pub scene: Scene,
    /// The same person before the same cameras, standing with the arms out for a second.
    pub t_pose: Scene,
    /// The height that the person states, mm.
    pub stated_height: f64,
}

impl Lottery {
    /// Draws a scene. Each of its quantities is a hash of the seed and the quantity's name.
    ///
    /// # Errors
    /// When a folder cannot be read or holds nothing of use, a motion or a mesh cannot be read, or a motion does not fit; one
    /// sentence.
    pub fn draw(settings: &LotterySettings) -> Result<Self> {
        let seed = settings.seed;
        let draws = Draws::new(seed);
        let frames = settings.frames.unwrap_or(FRAMES);
        ensure!((1..=100_000).contains(&frames), "frames is {frames}, expected 1 to 100000");
        let motions = settings.motions.as_deref().map(sources::recordings).transpose()?.unwrap_or_default();
        let people = settings.people.as_deref().map(sources::people).transpose()?.unwrap_or_default();
        let stage = stage::stage(draws);
        let (motion, fps) = action::action(draws, &motions, frames)?;
        let actor = ActorSettings { motion, ..person::person(draws, &people, stage.wall, stage.floor) };
        let body = body_of(&actor)?;
        let stated_height = (actor.height / 10.0).round() * 10.0;
        let sensor = stage::sensor(draws, fps);
        let mut scene = Scene {
            name: format!("lottery{seed}"),
            frames,
            fps,
            seed,
            room: stage.room,
            rig: RigSettings::default(),
            output: stage::output(draws),
            actor: vec![actor],
            ..Scene::default()
        };
        let t_pose = place::place(draws, &mut scene, &body).with_context(|| format!("the lottery of seed {seed}"))?;
        scene.light = stage::light(draws, &scene.room);
        scene.camera = stage::cameras(draws, &sensor, scene.rig.station.len());
        scene.sensor = sensor;
        let mut t_pose = Scene {
            name: "t_pose".to_string(),
            frames: T_POSE,
            fps: T_POSE as f64,
            seed: !seed,
            actor: vec![ActorSettings { motion: t_pose, ..scene.actor[0].clone() }],
            ..scene.clone()
        };
        t_pose.output.masks = false;
        Ok(Self { scene, t_pose, stated_height })
    }

    /// What was drawn, in one line.
    pub fn summary(&self) -> String {
        let Scene { actor, fps, frames, rig, sensor, light, output, .. } = &self.scene;
        let [width, height] = rig.size;
        let person = actor.first().map(|actor| {
            let kind = if actor.mesh.is_some() { "a skinned person" } else { "a person of ellipsoids" };
            let named = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
            let motion = match (&actor.motion.file, actor.motion.gait) {
                (Some(file), _) => format!(
                    "{} from {:.2} s at {:.2} speed{}",
                    named(file).unwrap_or_default(),
                    actor.motion.start,
                    actor.motion.speed.unwrap_or(1.0),
                    if actor.motion.mirrored { ", mirrored" } else { "" }
                ),
                (None, gait) => gait.unwrap_or_default().to_string(),
            };
            format!("{kind} of {:.0} mm, {motion}", actor.height)
        });
        format!(
            "{}, {frames} frames at {fps} Hz, {} cameras of {width}x{height}{}, {} lamps, noise {:.1}, gain {:.2}, exposure {:.1} ms, {}{}",
            person.unwrap_or_default(),
            rig.station.len(),
            if sensor.grey { " in grey" } else { "" },
            light.lamps.len(),
            sensor.noise,
            sensor.gain,
            sensor.exposure,
            output.pictures,
            if output.pictures == super::scene::PictureForm::Jpeg {
                format!(" {}", output.quality)
            } else {
                String::new()
            }
        )
    }
}

#[cfg(test)]
mod tests;
