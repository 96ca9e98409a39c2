//! `pantin plate`.

use std::path::PathBuf;

use anyhow::Result;
use image::codecs::png::PngEncoder;

use super::output::{say, tell};
use super::progress::WorkBar;
use crate::features::clean_plate::FEWEST_PICTURES;
use crate::files::{Overwrite, png_name, write_atomically};
use crate::observe::{PlateLesson, learn_plate};
use crate::sequence::Footage;

/// Learns the picture of the empty scene from a video in which somebody moves about.
///
/// Looks at pictures spread over the whole file: each pixel's most frequent colour, then again without all that differs from what was
/// found. Who stands somewhere for less than about half of the time leaves nothing behind. Places that are never seen empty are said
/// and filled in from around. Who never moves at all cannot be told from the scene: film it empty.
#[derive(clap::Args, Debug)]
pub(super) struct PlateArgs {
    /// A video, or numbered pictures: frames/cam01_%04d.png.
    #[arg(value_name = "VIDEO")]
    video: PathBuf,
    /// The picture to write, PNG.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// A grey picture to write beside it: how often each pixel was seen empty, white for always.
    #[arg(long, value_name = "FILE")]
    sure: Option<PathBuf>,
    /// Pictures looked at, at most; they take 768 MiB at most, so of 3840x2160 pixels there are 32.
    #[arg(long, value_name = "N", default_value_t = PlateLesson::default().pictures,
          value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(FEWEST_PICTURES as u64..=10_000))]
    samples: usize,
    /// Replace the files.
    #[arg(long)]
    force: bool,
}

/// Runs the command.
///
/// # Errors
/// As [`learn_plate`]; and when a file exists and may not be replaced, or cannot be written.
pub(super) fn run(args: &PlateArgs) -> Result<()> {
    let overwrite = Overwrite::forced(args.force);
    for file in [Some(&args.output), args.sure.as_ref()].into_iter().flatten() {
        png_name(file)?;
        overwrite.check(file)?;
    }
    let footage = Footage::open(&args.video)?;
    if let Some(turned) = footage.turned() {
        tell!("note: {turned}");
    }
    let lesson = PlateLesson { pictures: args.samples, ..PlateLesson::default() };
    let mut bar = WorkBar::default();
    let plate = learn_plate(&footage, &lesson, &mut |done, total| bar.show("learning the background", done, total))?;
    drop(bar);
    write_atomically(&args.output, overwrite, |writer| {
        Ok(plate.picture.write_with_encoder(PngEncoder::new(writer))?)
    })?;
    if let Some(file) = &args.sure {
        write_atomically(file, overwrite, |writer| Ok(plate.sure.write_with_encoder(PngEncoder::new(writer))?))?;
    }
    for remark in plate.remarks() {
        tell!("note: {remark}");
    }
    say!(
        "learnt the empty scene from {} of {} pictures, {} of them with somebody: {}",
        plate.pictures,
        footage.frame_count,
        plate.busy,
        args.output.display()
    );
    Ok(())
}
