//! `pantin synth`.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::Result;

use super::draws::Draws;
use super::output::{say, tell};
use super::progress::ProgressBar;
use crate::files::{OutputFolder, Overwrite};
use crate::gpu::Device;
use crate::synth::{Lottery, LotterySettings, Scene, ScenePreset, SyntheticSequence};
use crate::track::{StartPose, write_unseen};

/// Makes a synthetic sequence with exact truth from scene.toml: people who walk, run, jump or follow a recorded motion (BVH,
/// ASF/AMC, DeepMimic) in a room before any number of cameras. The folder can be tracked as it is; truth.trc holds the
/// joints, truth.c3d the markers, truth_poses.csv the poses.
#[derive(clap::Args, Debug)]
pub(super) struct SynthArgs {
    /// The scene.
    #[arg(value_name = "SCENE.toml", required_unless_present_any = ["preset", "lottery"])]
    #[arg(conflicts_with_all = ["preset", "lottery"])]
    scene: Option<PathBuf>,
    /// A built-in scene.
    #[arg(long, value_name = "NAME", conflicts_with = "lottery")]
    preset: Option<ScenePreset>,
    /// A scene drawn from this seed: person, motion, room, light, cameras; with a body measured in a T-pose second beside the
    /// actor's own.
    #[arg(long, value_name = "SEED", conflicts_with = "seed")]
    lottery: Option<u64>,
    /// The lottery's recorded motions: .bvh, .amc with .asf, DeepMimic clips; without them built-in gaits.
    #[arg(long, value_name = "DIR", requires = "lottery")]
    motions: Option<PathBuf>,
    /// The lottery's people: skinned .glb or .gltf; without them our own figures.
    #[arg(long, value_name = "DIR", requires = "lottery")]
    people: Option<PathBuf>,
    /// The folder to write.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Another number of frames than the scene's.
    #[arg(long, value_name = "N")]
    frames: Option<usize>,
    /// Another seed than the scene's.
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// What draws the pictures. A device's are nearly the processor's, not the same bytes; plates and truth are the same.
    #[arg(long, default_value_t)]
    backend: Draws,
    /// Replace what the folder holds.
    #[arg(long, conflicts_with = "resume")]
    force: bool,
    /// Go on with a folder that was begun with the same settings.
    #[arg(long)]
    resume: bool,
}

/// Runs the command.
///
/// # Errors
/// When the scene makes no sense, a file it names cannot be read, the folder is not empty (without `--force` or
/// `--resume`) or a file cannot be written; one sentence.
pub(super) fn run(args: &SynthArgs) -> Result<()> {
    if let Some(seed) = args.lottery {
        return run_lottery(args, seed);
    }
    let mut scene = match (&args.scene, &args.preset) {
        (Some(path), _) => Scene::load(path)?,
        (None, preset) => Scene::preset(preset.unwrap_or(ScenePreset::Demo).name())?,
    };
    scene.frames = args.frames.unwrap_or(scene.frames);
    scene.seed = args.seed.unwrap_or(scene.seed);
    let synthetic = SyntheticSequence::new(&scene)?;
    let device = device(args, &synthetic)?;
    let folder = folder(args)?;
    let begin = Instant::now();
    let bar = Mutex::new(ProgressBar::new("making the sequence", scene.frames));
    synthetic.write(&folder, args.resume, device.as_ref(), &|_| {
        bar.lock().unwrap_or_else(PoisonError::into_inner).advance()
    })?;
    drop(bar);
    let (seconds, views) = (begin.elapsed().as_secs_f64(), synthetic.cameras().len());
    say!(
        "made {} frames in {views} views in {seconds:.1} s, {:.3} s a frame of all views: {}",
        scene.frames,
        seconds / scene.frames as f64,
        folder.path().display()
    );
    Ok(())
}

/// What draws, if not the processor.
fn device(args: &SynthArgs, synthetic: &SyntheticSequence) -> Result<Option<Device>> {
    let device = args.backend.device()?;
    if device.is_some()
        && let Err(error) = synthetic.check_for_device()
    {
        if args.backend == Draws::Device {
            return Err(error);
        }
        tell!("on the processor: {error:#}");
        return Ok(None);
    }
    Ok(device)
}

fn folder(args: &SynthArgs) -> Result<OutputFolder> {
    let overwrite = if args.force || args.resume { Overwrite::Replace } else { Overwrite::Refuse };
    OutputFolder::create(&args.output, overwrite)
}

fn run_lottery(args: &SynthArgs, seed: u64) -> Result<()> {
    let settings =
        LotterySettings { seed, motions: args.motions.clone(), people: args.people.clone(), frames: args.frames };
    let lottery = Lottery::draw(&settings)?;
    let device = device(args, &SyntheticSequence::new(&lottery.scene)?)?;
    let folder = folder(args)?;
    say!("{}", lottery.summary());
    let begin = Instant::now();
    let frames = lottery.scene.frames + lottery.t_pose.frames;
    let bar = Mutex::new(ProgressBar::new("making the sequence", frames));
    let made = write_unseen(&lottery, &folder, args.resume, device.as_ref(), &|_| {
        bar.lock().unwrap_or_else(PoisonError::into_inner).advance()
    })?;
    drop(bar);
    say!(
        "measured: body off by {:.1} mm in the T-pose, start pose by {:.1} mm{}",
        made.body_error,
        made.start_error,
        match made.start {
            StartPose::Searched => "",
            StartPose::Improved => ", searched from a pose set by hand",
            StartPose::ByHand => ", set by hand",
        }
    );
    say!("made {frames} frames in {:.1} s: {}", begin.elapsed().as_secs_f64(), folder.path().display());
    Ok(())
}
