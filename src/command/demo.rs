//! `pantin demo`.

use std::cmp::Ordering;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use image::RgbImage;

use super::output::say;
use super::progress::ProgressBar;
use super::track::{TrackProgress, print_summary};
use crate::files::{OutputFolder, Overwrite};
use crate::report::side_by_side;
use crate::search::SearchSettings;
use crate::sequence::Sequence;
use crate::synth::{Scene, SyntheticSequence};
use crate::track::{TrackSettings, track};

/// Shows the whole thing at work: makes a synthetic four-camera sequence of a person walking in a circle, tracks it,
/// prints the error against its exact truth, and writes pictures and a report. Needs no data and no network.
#[derive(clap::Args, Debug)]
pub(super) struct DemoArgs {
    /// The folder for the sequence and the results.
    #[arg(short, long, value_name = "DIR", default_value = "pantin-demo")]
    output: PathBuf,
    /// Replace what the folder holds.
    #[arg(long)]
    force: bool,
    /// Length of the sequence, at 25 frames a second.
    #[arg(long, value_name = "N", default_value_t = 100)]
    frames: usize,
    /// Poses scored at once.
    #[arg(long, value_name = "N", default_value_t = 600)]
    particles: usize,
    /// Times that many poses are scored a frame.
    #[arg(long, value_name = "K", default_value_t = 20)]
    iterations: usize,
    /// Seed of the search and of the cameras' noise.
    #[arg(long, value_name = "S", default_value_t = SearchSettings::default().seed)]
    seed: u64,
    /// Write the report as report.rrd too, a recording for the viewer of rerun.io: the same in space and time. Only in builds
    /// with the feature `rerun`.
    #[arg(long)]
    rerun: bool,
}

/// The picture of all views side by side.
const PICTURE: &str = "demo.png";
/// The model is drawn over the pictures every so many frames.
const OVERLAY_EVERY: usize = 10;

/// Runs the command.
///
/// # Errors
/// When a number makes no sense, the folder is not empty (without `--force`) or a file cannot be written.
pub(super) fn run(args: &DemoArgs) -> Result<()> {
    let scene = Scene { frames: args.frames, seed: args.seed, ..Scene::preset("demo")? };
    let search = SearchSettings {
        particles: args.particles,
        iterations: args.iterations,
        seed: args.seed,
        ..SearchSettings::default()
    };
    let settings =
        TrackSettings { search, overlay_every: OVERLAY_EVERY, recording: args.rerun, ..TrackSettings::default() };
    settings.check()?;
    let synthetic = SyntheticSequence::new(&scene)?;
    let output = OutputFolder::create(&args.output, Overwrite::forced(args.force))?;

    let folder = OutputFolder::open(&args.output.join("sequence"))?;
    let begin = Instant::now();
    let bar = Mutex::new(ProgressBar::new("making the sequence", scene.frames));
    synthetic.write(&folder, false, None, &|_| {
        bar.lock().unwrap_or_else(PoisonError::into_inner).advance();
        Ok(())
    })?;
    drop(bar);
    let views = synthetic.cameras().len();
    let made = begin.elapsed().as_secs_f64();
    say!("made {} frames in {views} views in {made:.1} s: {}", scene.frames, folder.path().display());

    let sequence = Sequence::open(folder.path())?;
    let mut bar = TrackProgress::new()?;
    let summary = track(&sequence, &settings, &output, &mut bar);
    bar.clear();
    let summary = summary?;
    if let Some(next) = summary.stopped_before {
        bail!("stopped before frame {next}: run `pantin demo --force` to begin again");
    }
    print_summary(&summary, &args.output, args.rerun);
    // Of the frames that were drawn, the one that fits best; the first starts from the truth and shows little.
    let drawn = summary.frames.iter().filter(|result| result.frame.is_multiple_of(OVERLAY_EVERY));
    let best =
        drawn.max_by(|a, b| (a.frame > 0, a.fitness).partial_cmp(&(b.frame > 0, b.fitness)).unwrap_or(Ordering::Equal));
    let Some(best) = best.map(|result| result.frame) else { return Ok(()) };
    let pictures: Vec<RgbImage> = synthetic
        .cameras()
        .iter()
        .map(|camera| {
            let path = args.output.join(format!("overlay/{}_{best:06}.png", camera.name));
            Ok(image::open(&path).with_context(|| format!("cannot read {}", path.display()))?.to_rgb8())
        })
        .collect::<Result<_>>()?;
    let path = output.file(PICTURE)?;
    side_by_side(&pictures, 2, 6)?.save(&path).with_context(|| format!("cannot write {}", path.display()))?;
    say!("the model over frame {best}: {}", path.display());
    Ok(())
}

#[cfg(all(test, not(feature = "rerun")))]
mod tests {
    use std::process::ExitCode;

    use clap::Parser;

    use super::super::{Arguments, dispatch, run};

    #[test]
    fn a_build_without_recordings_says_so_before_anything_is_written() {
        let temporary = tempfile::tempdir().unwrap();
        let folder = temporary.path().join("demo");
        let arguments = ["pantin", "demo", "--rerun", "-o", folder.to_str().unwrap()];
        let command = Arguments::try_parse_from(arguments).unwrap().command;
        let message = format!("{:#}", dispatch(command).unwrap_err());
        assert_eq!(run(arguments.map(Into::into)), ExitCode::FAILURE, "{message}");
        assert!(message.contains("cargo build --release --features rerun"), "{message}");
        assert!(message.trim().lines().count() == 1 && !folder.exists(), "{message}");
    }
}
