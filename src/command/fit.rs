//! `pantin fit`.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Result, bail};

use super::objective_flags::ObjectiveFlags;
use super::output::{put, tell};
use super::progress::WorkBar;
use crate::files::{Overwrite, write_atomically};
use crate::observe::Advance;
use crate::sequence::Sequence;
use crate::track::{Fit, FitSettings, FrameRange, fit_with};

/// Measures the person in a sequence: adapts the proportions of the default body to the silhouettes of one or more frames
/// and finds the poses in them. Views without background and masks learn it from the whole recording. Silhouettes hardly tell front from back, nor
/// where a straight limb has its joint: give --heading if he came out backwards, and frames with bent limbs.
#[derive(clap::Args, Debug)]
pub(super) struct FitArgs {
    /// The sequence: its sequence.toml, or the folder that holds it. Its body and start need not exist yet.
    #[arg(value_name = "SEQUENCE")]
    sequence: PathBuf,
    /// The body.toml to write. Without it the sequence's body stays, and only poses are found.
    #[arg(short, long, value_name = "FILE", required_unless_present = "start_out")]
    output: Option<PathBuf>,
    /// The poses.csv to write, a row a frame used.
    #[arg(long, value_name = "FILE")]
    start_out: Option<PathBuf>,
    /// Height of the person, mm [default: the visual hull's].
    #[arg(long, value_name = "MM", requires = "output")]
    height: Option<f64>,
    /// Frames that may be used: A..B without B, A.., or ..B; counted from 0.
    #[arg(long, value_name = "A..B", default_value = "0..1")]
    frames: FrameRange,
    /// How many of them at most, evenly spread.
    #[arg(long, value_name = "N", default_value_t = FitSettings::default().samples)]
    samples: usize,
    /// A poses.csv to start from, with one pose or one for every frame used.
    #[arg(long, value_name = "FILE", conflicts_with = "heading")]
    start: Option<PathBuf>,
    /// Where the person stands in the first of the frames, where several people are seen: world x and y, mm [default: nearest to where the cameras
    /// look].
    #[arg(long, value_name = "X,Y", value_parser = floor_place, allow_hyphen_values = true)]
    at: Option<[f64; 2]>,
    /// Where the person faces: degrees, 0 along x, 90 along y [default: tries all round].
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    heading: Option<f64>,
    #[command(flatten)]
    objective: ObjectiveFlags,
    /// Poses scored at once.
    #[arg(long, value_name = "N", default_value_t = FitSettings::default().particles)]
    particles: usize,
    /// Times that many poses are scored in a round.
    #[arg(long, value_name = "K", default_value_t = FitSettings::default().iterations)]
    iterations: usize,
    /// Seed of all random numbers.
    #[arg(long, value_name = "S", default_value_t = FitSettings::default().seed)]
    seed: u64,
    /// Replace the files.
    #[arg(long)]
    force: bool,
}

/// `-1400,250`.
pub(super) fn floor_place(text: &str) -> Result<[f64; 2], String> {
    let numbers = text.split_once(',').map(|(x, y)| [x, y].map(|number| number.trim().parse::<f64>().ok()));
    match numbers {
        Some([Some(x), Some(y)]) if x.is_finite() && y.is_finite() => Ok([x, y]),
        _ => Err("expected two numbers in mm, X,Y".to_string()),
    }
}

/// Runs the command.
///
/// # Errors
/// As [`crate::track::fit`]; and when a file exists and may not be replaced, or cannot be written.
pub(super) fn run(args: &FitArgs) -> Result<()> {
    let mut bar = WorkBar::default();
    fitted(args, &mut |what, done, total| bar.show(what, done, total), |summary| put!("{summary}")).map(drop)
}

/// The person measured, which `told` hears of, and written where the arguments say.
///
/// # Errors
/// As [`run`].
pub(super) fn fitted(args: &FitArgs, progress: &mut Advance<'_>, told: impl FnOnce(&str)) -> Result<Fit> {
    let overwrite = Overwrite::forced(args.force);
    // Said before the work, not after it.
    for file in [&args.output, &args.start_out].into_iter().flatten() {
        overwrite.check(file)?;
    }
    if let Some(heading) = args.heading.filter(|heading| !(-360.0..=360.0).contains(heading)) {
        bail!("--heading is {heading}, expected -360 to 360 degrees");
    }
    let sequence =
        if args.output.is_some() { Sequence::open_unfitted(&args.sequence)? } else { Sequence::open(&args.sequence)? };
    if let Some(file) = args.output.as_ref().filter(|file| sequence.names_another_body(file)) {
        tell!(
            "note: {} names {} as its body, and {} is written",
            sequence.path.display(),
            sequence.body.display(),
            file.display()
        );
    }
    let settings = FitSettings {
        height: args.height.or(sequence.height),
        frames: args.frames,
        samples: args.samples,
        start: args.start.clone(),
        at: args.at,
        heading: args.heading,
        keep_body: args.output.is_none(),
        follow: false,
        objective: args.objective.choice(),
        particles: args.particles,
        iterations: args.iterations,
        seed: args.seed,
    };
    let fit = fit_with(&sequence, &settings, progress)?;
    let summary = summary(&fit);
    // Before anything is written: where that fails the numbers are not lost.
    told(&summary);
    for remark in fit.remarks.iter().chain(&fit.others) {
        tell!("note: {remark}");
    }
    if let Some(file) = &args.output {
        let comment: String = summary.lines().map(|line| format!("# {line}").trim_end().to_string() + "\n").collect();
        let text = format!("# Measured by `pantin fit` on {}.\n#\n{comment}\n{}", sequence.name, fit.body.to_toml());
        write_atomically(file, overwrite, |writer| Ok(writer.write_all(text.as_bytes())?))?;
    }
    if let Some(file) = &args.start_out {
        fit.poses.write(file, overwrite, &fit.body)?;
    }
    Ok(fit)
}

/// What the user sees.
pub(super) fn summary(fit: &Fit) -> String {
    let mut text = String::new();
    // Writing into a String cannot fail.
    let frames: Vec<String> = fit.poses.frames.iter().map(usize::to_string).collect();
    let _ = writeln!(text, "frames {}, fitness {:.3}", frames.join(" "), fit.fitness);
    let _ =
        writeln!(text, "silhouettes: seen ones covered by the model, the model's on seen ones (first pose -> fitted)");
    let [before, after] = &fit.coverage;
    for ((view, before), after) in fit.views.iter().zip(before).zip(after) {
        if after.is_of_nobody() {
            let _ = writeln!(text, "  {view}: nobody is seen there, nor expected");
            continue;
        }
        let percent = [before.seen, after.seen, before.drawn, after.drawn].map(|share| 100.0 * share);
        let [seen, seen_after, drawn, drawn_after] = percent;
        let _ = writeln!(text, "  {view}: {seen:.1} -> {seen_after:.1} %, {drawn:.1} -> {drawn_after:.1} %");
    }
    if let (Some(height), Some(proportions)) = (fit.height, &fit.proportions) {
        let _ = writeln!(text, "height {height:.0} mm; against an adult of that height:");
        let factors = proportions.0.iter().zip(&crate::body::Proportions::ALL);
        let factors: Vec<String> = factors.map(|(factor, known)| format!("{} {factor:.2}", known.name)).collect();
        for line in factors.chunks(5) {
            let _ = writeln!(text, "  {}", line.join(", "));
        }
    }
    text
}
