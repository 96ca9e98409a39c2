//! `pantin evaluate`.

use std::path::PathBuf;

use anyhow::{Result, anyhow};

use super::drawing_flags::DrawingFlags;
use super::objective_flags::ObjectiveFlags;
use super::output::{Output, say, tell};
use crate::body::{Body, Model, PoseTable};
use crate::files::{OutputFolder, Overwrite};
use crate::sequence::{Sequence, read_cameras};
use crate::track::{ScoredFrame, score_poses, write_fitness};

/// Scores given poses against one frame: components.csv (counts of pixels a pose and view) and fitness.csv, segments.csv where body
/// parts are told apart, evidence.csv where there is soft evidence, and with --images every candidate as it was drawn. Without -o
/// the fitness goes to the standard output. The frame is one of a sequence, or packed observations (`<camera>.png`: bit 7 the
/// silhouette, bits 0-6 the edge proximity) with their cameras and body.
#[derive(clap::Args, Debug)]
pub(super) struct EvaluateArgs {
    /// The sequence: its sequence.toml, or the folder that holds it.
    #[arg(long, value_name = "SEQ", requires = "frame", required_unless_present = "observations")]
    sequence: Option<PathBuf>,
    /// The frame of the sequence, from 0.
    #[arg(long, value_name = "K", requires = "sequence")]
    frame: Option<usize>,
    /// A folder with a packed observation a camera, instead of a sequence.
    #[arg(long, value_name = "DIR", requires_all = ["cameras", "body"], conflicts_with = "sequence")]
    observations: Option<PathBuf>,
    /// The cameras of the observations.
    #[arg(long, value_name = "cameras.toml", requires = "observations")]
    cameras: Option<PathBuf>,
    /// The body of the poses.
    #[arg(long, value_name = "body.toml", requires = "observations")]
    body: Option<PathBuf>,
    /// The poses.
    #[arg(long, value_name = "poses.csv")]
    poses: PathBuf,
    #[command(flatten)]
    drawing: DrawingFlags,
    /// What the body is drawn as.
    #[arg(long, value_name = "NAME", default_value_t)]
    model: Model,
    #[command(flatten)]
    objective: ObjectiveFlags,
    /// The folder for the results.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Also write every candidate image, images/pose_%06d_<camera>.png: bits 0-6 the label, bit 7 an edge. The backends
    /// reference and graphics write what they drew, and so does cpu with a mesh; of the flat model cpu and compute keep no picture, so the
    /// reference draws for them.
    #[arg(long, requires = "output")]
    images: bool,
    /// Replace what the folder holds.
    #[arg(long)]
    force: bool,
}

/// Runs the command.
///
/// # Errors
/// When an input cannot be read or does not fit the others, or a result not be written; one sentence.
pub(super) fn run(args: &EvaluateArgs) -> Result<()> {
    let choice = args.objective.choice();
    let (drawing, devices) = (args.drawing.drawing(args.model)?, &args.drawing.devices);
    let (frame, objective) = match (&args.sequence, &args.observations) {
        (Some(sequence), _) => {
            let sequence = Sequence::open(sequence)?;
            let objective = choice.resolve(sequence.objective.as_ref(), &sequence.path.display().to_string())?;
            let frame = args.frame.ok_or_else(|| anyhow!("--frame is missing"))?;
            (ScoredFrame::of_sequence(&sequence, frame, &objective)?, objective)
        }
        (None, Some(folder)) => {
            let objective = choice.resolve(None, "")?;
            let cameras = args.cameras.as_deref().ok_or_else(|| anyhow!("--cameras is missing"))?;
            let body = args.body.as_deref().ok_or_else(|| anyhow!("--body is missing"))?;
            let frame = ScoredFrame::of_observations(folder, read_cameras(cameras)?, Body::load(body)?)?;
            (frame, objective)
        }
        (None, None) => return Err(anyhow!("--sequence or --observations is missing")),
    };
    objective.check_segments(frame.observations.iter().all(|view| view.segmentation.is_some()))?;
    let poses = PoseTable::read(&args.poses, &frame.body)?;
    let overwrite = Overwrite::forced(args.force);
    let score = |output: Option<&OutputFolder>| {
        score_poses(&frame, &poses, drawing, devices, args.model, &objective, output, args.images)
    };
    let scores = match &args.output {
        Some(path) => OutputFolder::filled(path, overwrite, |output| score(Some(output)))?,
        None => score(None)?,
    };
    tell!("{}", scores.backend);
    if scores.drawn_by_reference {
        tell!("the images are drawn by the reference: this backend keeps no picture of a candidate");
    }
    match &args.output {
        Some(path) => {
            say!(
                "{} poses scored in {} views, results in {}",
                scores.fitness.len(),
                frame.cameras.len(),
                path.display()
            )
        }
        None => write_fitness(&mut Output, &scores.fitness)?,
    }
    Ok(())
}
