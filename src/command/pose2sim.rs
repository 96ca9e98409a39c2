//! `pantin pose2sim`.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use toml::Table;

use super::output::{say, tell};
use super::track::{TrackOptions, TrackProgress, print_summary};
use crate::files::{OutputFolder, Overwrite, write_atomically};
use crate::motion::write_pose2sim_trc;
use crate::sequence::{Pose2SimTrial, Sequence, pose2sim_trials};
use crate::track::{
    FrameRange, POSE2SIM_OWN, POSE2SIM_POINTS, Pose2SimGiven, Pose2SimPoints, TrackSettings, pose2sim_manifest,
    pose2sim_points, pose2sim_written, track,
};

/// Tracks a project of Pose2Sim as it is: reads its Config.toml (with what a trial inherits from its session), calibration/ and
/// videos/, and writes pose-3d/NAME_FIRST-LAST.trc with the 22 points of Halpe26, for its filtering, marker augmentation and
/// kinematics. Of a session, every trial. What is made on the way lies in the trial's folder `pantin`.
#[derive(clap::Args, Debug)]
pub(super) struct Pose2SimArgs {
    /// The folder of a trial, or of a session with trials below it.
    #[arg(value_name = "DIR")]
    project: PathBuf,
    /// Height of the person with shoes and hair, mm, instead of participant_height. The body is measured in the first second.
    #[arg(long, value_name = "MM", conflicts_with = "body")]
    height: Option<f64>,
    /// The person's body.toml, instead of measuring one: that of another trial is its pantin/track/refined_body.toml, else
    /// found_body.toml.
    #[arg(long, value_name = "FILE")]
    body: Option<PathBuf>,
    /// Pictures of the empty scene, DIR/CAMERA.png each (or by the video's name, or .jpg); of a trial of a session first in DIR/TRIAL.
    /// Without them it is learnt from the whole videos, in which the person must move.
    #[arg(long, value_name = "DIR")]
    plates: Option<PathBuf>,
    /// Frames a second, instead of frame_rate: needed where that is 'auto' and there are pictures instead of videos.
    #[arg(long, value_name = "HZ")]
    fps: Option<f64>,
    /// Size that is worked at, as a part of the pictures' [default: such that their longer side has 480 pixels].
    #[arg(long, value_name = "F")]
    scale: Option<f64>,
    #[command(flatten)]
    options: TrackOptions,
    /// Go on with a run that was stopped; trials that are done stay.
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Replace what an earlier run left in `pantin`, and files of the same name in `pose-3d`.
    #[arg(long)]
    force: bool,
}

/// Runs the command.
///
/// # Errors
/// As [`pose2sim_trials`] and [`track`]; when something is missing that no file says: the sentence names the option that gives it; when a
/// result is there already.
pub(super) fn run(args: &Pose2SimArgs) -> Result<()> {
    let settings = TrackSettings { resume: args.resume, ..args.options.settings()? };
    ensure!(settings.realtime.is_none(), "a project of Pose2Sim is recorded: leave out --realtime");
    args.options.threads.apply()?;
    let trials = pose2sim_trials(&args.project)?;
    let given = Pose2SimGiven {
        height: args.height,
        body: args.body.clone(),
        has_start: settings.start.is_some(),
        plates: args.plates.clone(),
        fps: args.fps,
        scale: args.scale,
    };
    // All of them before the first, which takes its time.
    let mut asked = Vec::new();
    for trial in trials {
        let [written, _] = pose2sim_written(&trial)?;
        if let (Some(file), false) = (written.first(), args.force) {
            if args.resume {
                say!("{}: {} is there", trial.name, file.display());
                continue;
            }
            bail!("{} exists: replace it with --force, or move it away", file.display());
        }
        let manifest = pose2sim_manifest(&trial, &given)?;
        asked.push((trial, manifest));
    }
    for (trial, manifest) in asked {
        run_trial(&trial, &manifest, &settings, args).with_context(|| trial.name.clone())?;
    }
    Ok(())
}

fn run_trial(trial: &Pose2SimTrial, manifest: &Table, settings: &TrackSettings, args: &Pose2SimArgs) -> Result<()> {
    say!("{}:", trial.name);
    tell!("{}", trial.told().trim_end());
    if trial.has_other_points() {
        tell!(
            "note: {} has the points of {} for its kinematics; those of Body_with_feet (Halpe26) are written",
            trial.config.display(),
            trial.pose_model
        );
    }
    let own = trial.dir.join(POSE2SIM_OWN);
    let overwrite = Overwrite::forced(args.force || args.resume);
    let is_begun = own.join("track/journal.txt").is_file();
    // The manifest is made anew as long as nothing was made of it: a first try may have failed at it.
    let results = OutputFolder::create(&own.join("track"), overwrite)?;
    OutputFolder::open(&own)?
        .write("sequence.toml", |out| Ok(out.write_all(toml::to_string(manifest)?.as_bytes())?))?;
    let sequence = Sequence::open(&own)?;
    let settings = TrackSettings {
        frames: if settings.frames == FrameRange::default() { frames(trial) } else { settings.frames },
        resume: settings.resume && is_begun,
        ..settings.clone()
    };
    let mut bar = TrackProgress::new()?;
    let summary = track(&sequence, &settings, &results, &mut bar);
    bar.clear();
    let summary = summary?;
    if let Some(next) = summary.stopped_before {
        bail!("stopped before frame {next}: run the same command with --resume to go on");
    }
    print_summary(&summary, results.path(), false);

    let Pose2SimPoints { points, filled, file_name } = pose2sim_points(trial, &sequence, results.path())?;
    if filled > 0 {
        tell!("note: {filled} frames without a find were filled as [triangulation] in the configuration says");
    }
    let folder = OutputFolder::open(&trial.dir.join(POSE2SIM_POINTS))?;
    let file = folder.path().join(&file_name);
    write_atomically(&file, overwrite, |out| write_pose2sim_trc(out, &points, &file_name))?;
    let others: Vec<String> =
        pose2sim_written(trial)?.concat().iter().filter(|other| **other != file).map(|other| shown(other)).collect();
    if !others.is_empty() {
        tell!(
            "note: {} holds {} too: Pose2Sim's kinematics take *_LSTM.trc first, then *_filt*.trc, then all",
            folder.path().display(),
            others.join(", ")
        );
    }
    say!("{} frames of 22 points: {}", points.frames.len(), file.display());
    Ok(())
}

/// A file's own name.
fn shown(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The frames that the configuration asks for.
fn frames(trial: &Pose2SimTrial) -> FrameRange {
    trial.frames.map_or_else(FrameRange::default, |[first, end]| FrameRange { start: Some(first), end: Some(end) })
}
