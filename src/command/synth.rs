//! `pantin synth`.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::{Context, Result};

use super::belonging::refuse_without;
use super::draws::Draws;
use super::output::{say, tell};
use super::progress::ProgressBar;
use crate::files::{OutputFolder, Overwrite};
use crate::gpu::Device;
use crate::synth::{Lottery, LotterySettings, Scene, ScenePreset, SyntheticSequence};
use crate::track::{StartPose, UnseenSummary, write_unseen};

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
    let begin = Instant::now();
    let bar: Mutex<Option<ProgressBar>> = Mutex::new(None);
    let made = made(args, &|_, frames| {
        let mut bar = bar.lock().unwrap_or_else(PoisonError::into_inner);
        bar.get_or_insert_with(|| ProgressBar::new("making the sequence", frames)).advance();
        Ok(())
    })?;
    drop(bar);
    if let Some((person, measured)) = &made.unseen {
        say!("{person}");
        say!(
            "measured: body off by {:.1} mm in the T-pose, start pose by {:.1} mm{}",
            measured.body_error,
            measured.start_error,
            match measured.start {
                StartPose::Searched => "",
                StartPose::Improved => ", searched from a pose set by hand",
                StartPose::ByHand => ", set by hand",
            }
        );
    }
    let seconds = begin.elapsed().as_secs_f64();
    say!(
        "made {} frames in {} views in {seconds:.1} s, {:.3} s a frame of all views: {}",
        made.frames,
        made.views,
        seconds / made.frames as f64,
        made.folder.display()
    );
    Ok(())
}

/// A sequence that was made.
pub(super) struct Made {
    /// Its folder.
    pub(super) folder: PathBuf,
    frames: usize,
    views: usize,
    /// Who was drawn by lot, and how well a user's files fit.
    unseen: Option<(String, UnseenSummary)>,
}

/// Makes the sequence. `progress` is told how many of how many frames are done, from any thread; its error ends the work.
///
/// # Errors
/// As [`run`].
pub(super) fn made(args: &SynthArgs, progress: &(dyn Fn(usize, usize) -> Result<()> + Sync)) -> Result<Made> {
    if let Some(seed) = args.lottery {
        return drawn_by_lot(args, seed, progress);
    }
    // A requirement of the parser's own gives way to what conflicts with it.
    refuse_without("--lottery", &[("--motions", args.motions.is_some()), ("--people", args.people.is_some())])?;
    let mut scene = match (&args.scene, &args.preset) {
        (Some(path), _) => Scene::load(path)?,
        (None, preset) => Scene::preset(preset.unwrap_or(ScenePreset::Demo).name())?,
    };
    scene.frames = args.frames.unwrap_or(scene.frames);
    scene.seed = args.seed.unwrap_or(scene.seed);
    let synthetic = SyntheticSequence::new(&scene);
    let synthetic = match &args.scene {
        Some(path) => synthetic.with_context(|| path.display().to_string())?,
        None => synthetic?,
    };
    let device = device(args, &synthetic)?;
    let folder = folder(args)?;
    synthetic.write(&folder, args.resume, device.as_ref(), &|done| progress(done, scene.frames))?;
    let views = synthetic.cameras().len();
    Ok(Made { folder: folder.path().to_path_buf(), frames: scene.frames, views, unseen: None })
}

fn drawn_by_lot(args: &SynthArgs, seed: u64, progress: &(dyn Fn(usize, usize) -> Result<()> + Sync)) -> Result<Made> {
    let settings =
        LotterySettings { seed, motions: args.motions.clone(), people: args.people.clone(), frames: args.frames };
    let lottery = Lottery::draw(&settings)?;
    let synthetic = SyntheticSequence::new(&lottery.scene)?;
    let device = device(args, &synthetic)?;
    let folder = folder(args)?;
    let frames = lottery.scene.frames + lottery.t_pose.frames;
    let done = AtomicUsize::new(0);
    let measured = write_unseen(&lottery, &folder, args.resume, device.as_ref(), &|_| {
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, frames)
    })?;
    let unseen = Some((lottery.summary(), measured));
    Ok(Made { folder: folder.path().to_path_buf(), frames, views: synthetic.cameras().len(), unseen })
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
    let overwrite = Overwrite::forced(args.force || args.resume);
    OutputFolder::create(&args.output, overwrite)
}
