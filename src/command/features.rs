//! `pantin features`: what the tracker would see of a sequence, as pictures to look at.

use std::path::PathBuf;

use anyhow::Result;
use image::RgbImage;
use image::codecs::png::PngEncoder;
use rayon::prelude::*;

use super::output::{say, tell};
use super::progress::{ProgressBar, WorkBar};
use crate::evaluate::device::open_device;
use crate::features::ViewFeatures;
use crate::files::{OutputFolder, Overwrite, choices};
use crate::observe::{Observer, feature_settings, with_plates};
use crate::sequence::{Sequence, View};
use crate::track::FrameRange;

/// Writes silhouettes, edges, distance maps and packed observations as PNG.
///
/// For every frame and camera, CAMERA/STAGE_NNNNNN.png with the stages input, foreground, silhouette, edges, distance,
/// proximity, observation and region (and segments, where the sequence has [[features.segment]]), and frame_NNNNNN/CAMERA.png, the packed observations of a frame in one folder
/// as `evaluate --observations` reads them.
#[derive(clap::Args, Debug)]
pub(super) struct FeaturesArgs {
    /// The sequence: its sequence.toml, or the folder that holds it. Its body and start need not exist yet, but for segments of its parts.
    sequence: PathBuf,
    /// Frames A to B - 1, counted from 0; all without it
    #[arg(long, value_name = "A..B", default_value = "..")]
    frames: FrameRange,
    /// The folder to write into
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// What makes the features, to the same bits
    #[arg(long, default_value_t)]
    backend: FeatureBackend,
    /// Write into a folder that is not empty, replacing its files
    #[arg(long)]
    force: bool,
}

choices! {
    /// What makes the features, to the same bits.
    #[derive(Default)]
    "place to make features" enum FeatureBackend {
        /// The processor (the default).
        "cpu" #[default] Cpu,
        /// A Vulkan device.
        "device" Device,
    }
}

/// Runs the command.
///
/// # Errors
/// When the sequence cannot be read, its `[features]` make no sense, or a picture cannot be written.
pub(super) fn run(args: &FeaturesArgs) -> Result<()> {
    let sequence = Sequence::open_unfitted(&args.sequence)?;
    let frames = args.frames.within(sequence.frame_count, &sequence.path.display().to_string())?;
    let mut bar = WorkBar::default();
    let plated = with_plates(&sequence, &mut |what, done, total| bar.show(what, done, total))?;
    drop(bar);
    for remark in sequence.remarks().into_iter().chain(plated.remarks()) {
        tell!("note: {remark}");
    }
    let sequence = plated.sequence.as_ref();
    let mut observer = Observer::new(sequence, feature_settings(sequence)?, frames.clone(), frames.start)?;
    if args.backend == FeatureBackend::Device
        && let Err(error) = observer.move_to(&open_device()?)
    {
        tell!("note: the processor makes the features: {error:#}");
    }
    let overwrite = Overwrite::forced(args.force);
    OutputFolder::filled(&args.output, overwrite, |output| {
        let mut progress = ProgressBar::new("features", frames.len());
        while let Some(set) = observer.read()? {
            let Some(features) = observer.features(&set, true)? else { continue };
            let views = sequence.views.par_iter().zip(&set.pictures).zip(&*features);
            views.try_for_each(|((view, picture), features)| write(output, set.index, view, picture, features))?;
            progress.advance();
        }
        Ok(())
    })?;
    say!(
        "wrote the features of {} frames in {} views to {}",
        frames.len(),
        sequence.views.len(),
        args.output.display()
    );
    Ok(())
}

/// Writes the stages of one view of a frame, and the observation that `evaluate` reads.
fn write(output: &OutputFolder, frame: usize, view: &View, picture: &RgbImage, features: &ViewFeatures) -> Result<()> {
    for (stage, picture) in features.pictures(picture) {
        output.write(&format!("{}/{stage}_{frame:06}.png", view.camera), |writer| {
            Ok(picture.write_with_encoder(PngEncoder::new(writer))?)
        })?;
    }
    let path = output.file(&format!("frame_{frame:06}/{}.png", view.camera))?;
    features.observation.write_png(&path, Overwrite::Replace)
}
