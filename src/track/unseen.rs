//! The folder of a scene that was drawn by lot: its pictures and truth, and what a user would have beside them, measured by [`fit`] and
//! not known.

use anyhow::{Context, Result};

use super::{Fit, FitSettings, FrameRange, fit};
use crate::body::{Body, PoseTable};
use crate::files::{OutputFolder, Overwrite};
use crate::gpu::Device;
use crate::motion::{PointPairs, TrajectoryError};
use crate::sequence::Sequence;
use crate::synth::{Advance, FileNames, Lottery, SyntheticSequence};

/// Names of the files that hold what nobody would know.
const TRUE: FileNames<'_> = FileNames {
    manifest: "true_sequence.toml",
    body: "true_body.toml",
    start: "true_start.csv",
    masks: false,
    measure_again: false,
};
/// The folder of the T-pose second.
const T_POSE: &str = "t_pose";
/// Frames of it that the body is measured in.
const SAMPLES: usize = 3;
/// Headings are told to a twelfth of a turn, degrees.
const HEADING: f64 = 30.0;
/// Error of a joint above which whoever looks at the overlay sees that a pose is wrong, mm.
const SEEN_TO_BE_WRONG: f64 = 150.0;
/// A pose set by hand is told to so many degrees and mm.
const BY_HAND: [f64; 2] = [15.0, 50.0];

/// How well a user's files fit a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnseenSummary {
    /// Mean joint error of the measured body in the frames it was measured in, mm.
    pub body_error: f64,
    /// Mean joint error of start.csv, mm.
    pub start_error: f64,
    /// How start.csv came to be.
    pub start: StartPose,
}

/// How a start pose came to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartPose {
    /// Searched from nothing but the rough heading.
    Searched,
    /// That went wrong, as one sees: searched from a pose set by hand.
    Improved,
    /// That went wrong too: as set by hand.
    ByHand,
}

/// Writes a lottery's scene: pictures, plates, exact silhouettes (masks/), cameras.toml and the truth; `t_pose/`, the T-pose
/// second; body.toml, measured in it with the height that the person states, from the T-pose as a hand sets it; start.csv, the pose
/// of frame 0 as searched with that body, knowing roughly where he faces ([`StartPose`] says what where that went wrong). `true_sequence.toml` names the actor's own bones and pose, `exact.toml` the exact silhouettes; sequence.toml, which
/// has neither, comes last.
///
/// # Errors
/// As [`SyntheticSequence::write`] and [`fit`].
pub fn write_unseen(
    lottery: &Lottery,
    folder: &OutputFolder,
    resume: bool,
    device: Option<&Device>,
    progress: &Advance<'_>,
) -> Result<UnseenSummary> {
    let synthetic = SyntheticSequence::new(&lottery.scene)?;
    synthetic.write_as(&TRUE, folder, resume, device, progress)?;
    let t_pose = SyntheticSequence::new(&lottery.t_pose).context("the T-pose")?;
    let its_folder = OutputFolder::open(&folder.path().join(T_POSE))?;
    let is_begun = resume && its_folder.path().join("scene.toml").exists();
    t_pose.write_as(&TRUE, &its_folder, is_begun, device, progress)?;

    let measured = measure(lottery, &t_pose, &its_folder)?;
    let mut body = measured.body.clone();
    body.name.clone_from(&lottery.scene.name);
    let text = format!(
        "# Measured in {T_POSE} by `pantin fit`, with a stated height of {:.0} mm.\n{}",
        lottery.stated_height,
        body.to_toml()
    );
    folder.write("body.toml", |writer| Ok(writer.write_all(text.as_bytes())?))?;
    let body_error = error_of(&t_pose, &body, &measured.poses)?.mean;
    let first = PoseTable { frames: measured.poses.frames[..1].to_vec(), poses: measured.poses.poses[..1].to_vec() };
    first.write(&its_folder.file("start.csv")?, Overwrite::Replace, &body)?;
    let names = FileNames { body: "../body.toml", masks: false, ..FileNames::default() };
    t_pose.write_manifest(&names, &its_folder)?;

    let (pose, start) = start(&synthetic, &body, folder)?;
    pose.write(&folder.file("start.csv")?, Overwrite::Replace, &body)?;
    let start_error = error_of(&synthetic, &body, &pose)?.mean;
    let exact = FileNames { manifest: "exact.toml", measure_again: true, ..FileNames::default() };
    synthetic.write_manifest(&exact, folder)?;
    synthetic.write_manifest(&FileNames { masks: false, measure_again: true, ..FileNames::default() }, folder)?;
    Ok(UnseenSummary { body_error, start_error, start })
}

/// The person as measured in the T-pose second, whose pose everybody knows: it is set by hand.
fn measure(lottery: &Lottery, t_pose: &SyntheticSequence, folder: &OutputFolder) -> Result<Fit> {
    let sequence = Sequence::open_unfitted(&folder.path().join(TRUE.manifest))?;
    let adult = Body::adult(lottery.stated_height)?;
    let by_hand = folder.file("start.csv")?;
    set_by_hand(t_pose, &adult)?.write(&by_hand, Overwrite::Replace, &adult)?;
    let settings = FitSettings {
        height: Some(lottery.stated_height),
        frames: FrameRange { start: Some(0), end: None },
        samples: SAMPLES,
        start: Some(by_hand),
        ..FitSettings::default()
    };
    fit(&sequence, &settings).context("measuring the person")
}

/// Where the person faces in the first frame, as someone who was there tells it, degrees.
fn told_heading(scene: &SyntheticSequence) -> Result<f64> {
    let bones = scene.body().world_from_bones(&scene.poses().poses[0])?;
    let forward = scene.body().update_order.first().map(|root| bones[*root].matrix3.x_axis);
    let degrees = forward.map_or(0.0, |forward| forward.y.atan2(forward.x).to_degrees());
    Ok((degrees / HEADING).round() * HEADING)
}

/// The pose of the first frame, searched with the measured body, and how it came to be.
fn start(scene: &SyntheticSequence, body: &Body, folder: &OutputFolder) -> Result<(PoseTable, StartPose)> {
    let mut sequence = Sequence::open_unfitted(&folder.path().join(TRUE.manifest))?;
    sequence.body = folder.path().join("body.toml");
    let looks_right = |poses: &PoseTable| -> Result<bool> {
        Ok(error_of(scene, body, poses)?.points.iter().all(|point| point.max <= SEEN_TO_BE_WRONG))
    };
    let once = FitSettings { keep_body: true, samples: 1, ..FitSettings::default() };
    let heading = Some(told_heading(scene)?);
    let searched = fit(&sequence, &FitSettings { heading, ..once.clone() })?.poses;
    if looks_right(&searched)? {
        return Ok((searched, StartPose::Searched));
    }
    // As someone poses a puppet after a picture, and lets the search have another go from there.
    let by_hand = set_by_hand(scene, body)?;
    let file = folder.file("start.csv")?;
    by_hand.write(&file, Overwrite::Replace, body)?;
    let improved = fit(&sequence, &FitSettings { start: Some(file), ..once })?.poses;
    Ok(if looks_right(&improved)? { (improved, StartPose::Improved) } else { (by_hand, StartPose::ByHand) })
}

/// The true pose of the first frame, as roughly as a hand sets it.
fn set_by_hand(scene: &SyntheticSequence, body: &Body) -> Result<PoseTable> {
    body.check_pose(&scene.poses().poses[0])?;
    let rough = body.dofs().zip(&scene.poses().poses[0]).map(|((_, dof), value)| {
        let step = if dof.axis.is_rotation() { BY_HAND[0].to_radians() } else { BY_HAND[1] };
        (value / step).round() * step
    });
    let mut rough: Vec<f64> = rough.collect();
    body.clamp_to_limits(&mut rough);
    Ok(PoseTable { frames: vec![0], poses: vec![rough] })
}

/// Distances of the joints that the measured and the true body name alike, mm.
fn error_of(scene: &SyntheticSequence, body: &Body, poses: &PoseTable) -> Result<TrajectoryError> {
    let truth = scene.joints()?;
    let ours = body.joint_trajectory(poses, truth.rate)?;
    let pairs = PointPairs::find(&ours, &truth, &[])?;
    TrajectoryError::between(&ours, &truth, &pairs, false)
}
