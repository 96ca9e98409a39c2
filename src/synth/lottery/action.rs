//! What somebody does: a window of a recorded motion, or a built-in gait. The ranges are frozen (docs/SCENES.md).

use anyhow::{Context, Result, bail};

use super::super::scene::{Gait, MotionSettings};
use super::draws::Draws;
use super::sources::Recording;
use crate::motion::read_skeletal_motion;

/// Frame rates with their weights.
const RATES: [(f64, f64); 4] = [(3.0, 25.0), (3.0, 30.0), (2.0, 50.0), (2.0, 60.0)];
/// Rates to go up to where a motion is short.
const FASTER: [f64; 5] = [25.0, 30.0, 40.0, 50.0, 60.0];
/// Recordings often begin with a calibration pose, which is no motion, s.
const BEGINNING: f64 = 0.1;
/// Recordings that are looked at before it is said that all are too short.
const TRIES: usize = 200;

/// A motion without its place, and the frames a second that it is seen at. Where a motion is shorter than the frames asked for at
/// the rate drawn, the rate is higher.
///
/// # Errors
/// When a recording cannot be read, or all are too short.
pub(super) fn action(draws: Draws, recordings: &[Recording], frames: usize) -> Result<(MotionSettings, f64)> {
    let rate = draws.one_of("motion/rate", &RATES).unwrap_or(25.0);
    if recordings.is_empty() || draws.chance("motion/built in", 0.12) {
        let gaits = [(3.0, Gait::Circle), (3.0, Gait::Straight), (2.0, Gait::Run), (1.5, Gait::Jump)];
        let settings = MotionSettings {
            gait: draws.one_of("motion/gait", &gaits),
            radius: draws.between("motion/radius", [650.0, 1300.0]),
            stride_time: draws.between("motion/stride time", [1.0, 1.5]),
            jump_height: draws.between("motion/jump height", [150.0, 400.0]),
            heading: Some(draws.between("motion/heading", [-180.0, 180.0])),
            start: draws.between("motion/start", [0.0, 5.0]),
            ..MotionSettings::default()
        };
        return Ok((settings, rate));
    }
    let speed = draws.between("motion/speed", [0.85, 1.15]);
    for attempt in 0..TRIES {
        let Some(recording) = draws.among(&format!("motion/file {attempt}"), recordings) else { break };
        let motion = read_skeletal_motion(&recording.file, recording.skeleton.as_deref(), None)
            .with_context(|| format!("the lottery's motion {}", recording.file.display()))?;
        let there = motion.duration() - BEGINNING;
        let lasts = |rate: f64| (frames - 1) as f64 / rate * speed;
        let faster = FASTER.into_iter().filter(|faster| *faster > rate);
        let fits = std::iter::once(rate).chain(faster).find(|rate| motion.wraps || lasts(*rate) <= there);
        let Some(rate) = fits else { continue };
        let start = if motion.wraps {
            0.0
        } else {
            ((BEGINNING + draws.unit("motion/window") * (there - lasts(rate))) * 1e4).round() / 1e4
        };
        let settings = MotionSettings {
            file: Some(recording.file.clone()),
            skeleton: recording.skeleton.clone(),
            heading: Some(draws.between("motion/heading", [-180.0, 180.0])),
            mirrored: draws.chance("motion/mirrored", 0.5),
            speed: Some(speed),
            start,
            ..MotionSettings::default()
        };
        return Ok((settings, rate));
    }
    bail!("no motion is long enough for {frames} frames at 60 Hz, expected fewer frames or longer motions")
}
