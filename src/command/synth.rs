//! `pantin synth`.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::Result;

use super::draws::Draws;
use super::progress::ProgressBar;
use crate::files::{OutputFolder, Overwrite};
use crate::synth::{Scene, ScenePreset, SyntheticSequence};

/// Makes a synthetic sequence with exact truth from scene.toml: people who walk, run, jump or follow a recorded motion (BVH,
/// ASF/AMC, DeepMimic) in a room before any number of cameras. The folder can be tracked as it is; truth.trc holds the
/// joints, truth.c3d the markers, truth_poses.csv the poses.
#[derive(clap::Args, Debug)]
pub(super) struct SynthArgs {
    /// The scene.
    #[arg(value_name = "SCENE.toml", required_unless_present = "preset", conflicts_with = "preset")]
    scene: Option<PathBuf>,
    /// A built-in scene.
    #[arg(long, value_name = "NAME")]
    preset: Option<ScenePreset>,
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
    let mut scene = match (&args.scene, &args.preset) {
        (Some(path), _) => Scene::load(path)?,
        (None, preset) => Scene::preset(preset.unwrap_or(ScenePreset::Demo).name())?,
    };
    scene.frames = args.frames.unwrap_or(scene.frames);
    scene.seed = args.seed.unwrap_or(scene.seed);
    let synthetic = SyntheticSequence::new(&scene)?;
    let mut device = args.backend.device()?;
    if device.is_some()
        && let Err(error) = synthetic.check_for_device()
    {
        if args.backend == Draws::Device {
            return Err(error);
        }
        eprintln!("on the processor: {error:#}");
        device = None;
    }
    let overwrite = if args.force || args.resume { Overwrite::Replace } else { Overwrite::Refuse };
    let folder = OutputFolder::create(&args.output, overwrite)?;
    let begin = Instant::now();
    let bar = Mutex::new(ProgressBar::new("making the sequence", scene.frames));
    synthetic.write(&folder, args.resume, device.as_ref(), &|_| {
        bar.lock().unwrap_or_else(PoisonError::into_inner).advance()
    })?;
    drop(bar);
    let (seconds, views) = (begin.elapsed().as_secs_f64(), synthetic.cameras().len());
    println!(
        "made {} frames in {views} views in {seconds:.1} s, {:.3} s a frame of all views: {}",
        scene.frames,
        seconds / scene.frames as f64,
        folder.path().display()
    );
    Ok(())
}
