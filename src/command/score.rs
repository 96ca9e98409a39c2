//! `pantin score`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result};
use serde_json::json;

use super::name_pair::name_pair;
use super::output::{put, say, tell};
use crate::files::{Overwrite, write_atomically};
use crate::motion::{
    FARTHEST_SHIFT, Matching, PointFormat, PointPairs, TrajectoryError, best_shift, read_points, read_y_up_points,
    write_frame_errors,
};
use crate::track::tracked_points;

/// No recording is longer, seconds.
const LARGEST_SHIFT: f64 = 1e5;
/// A best shift this near to the farthest, seconds, may lie beyond it.
const AT_THE_END: f64 = 0.01;

/// Measures the error of tracked markers or joints against C3D, TRC or CSV truth, in mm: for every point its mean over
/// frames, then the mean over points; the standard deviation is that of all errors of all points in all frames. Points
/// are paired by name, without --map joints also by what other programs call them (`RKnee` is `right_knee`), frames by index, or by time
/// where the frame rates differ.
#[derive(clap::Args, Debug)]
pub(super) struct ScoreArgs {
    /// A track's folder (its markers.c3d or joints.csv, the first that shares a name with the truth), or a file of
    /// points.
    #[arg(value_name = "DIR")]
    track: PathBuf,
    /// The truth: .c3d, .trc, .csv or .bvh.
    #[arg(long, value_name = "FILE")]
    truth: PathBuf,
    /// Also report the error after removing each point's constant mean offset (joint definitions differ between
    /// systems).
    #[arg(long)]
    remove_offset: bool,
    /// Compare these points only, by the truth's or the track's name.
    #[arg(long, value_name = "A,B,…", value_delimiter = ',')]
    points: Vec<String>,
    /// Leave out every point whose name holds one of these words, in any case (`hips` leaves out `LHip` and
    /// `right_hip`).
    #[arg(long, value_name = "A,B,…", value_delimiter = ',')]
    exclude: Vec<String>,
    /// Pair a point of the truth with one of the track that has another name.
    #[arg(long, value_name = "TRUTH=OURS", value_delimiter = ',', num_args = 1.., value_parser = name_pair)]
    map: Vec<(String, String)>,
    /// The truth is y-up (OpenSim): turn it z-up, (x, y, z) becoming (z, x, y).
    #[arg(long)]
    truth_y_up: bool,
    /// Compare the track's moment t with the truth's moment t + SECONDS; `auto` finds the shift within 1 s that leaves the smallest error
    /// (with --remove-offset the smallest without offsets).
    #[arg(long, value_name = "SECONDS|auto", allow_negative_numbers = true)]
    shift: Option<Shift>,
    /// Write the errors of every frame (before removing offsets) as CSV.
    #[arg(long, value_name = "FILE.csv")]
    per_frame: Option<PathBuf>,
    /// Print one JSON object instead of the table.
    #[arg(long)]
    json: bool,
    /// Replace the --per-frame file when it is there.
    #[arg(long)]
    force: bool,
}

/// A shift in time that is asked for.
#[derive(Clone, Copy, Debug)]
enum Shift {
    Seconds(f64),
    Auto,
}

impl FromStr for Shift {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse::<f64>() {
            _ if text == "auto" => Ok(Self::Auto),
            Ok(seconds) if seconds.abs() <= LARGEST_SHIFT => Ok(Self::Seconds(seconds)),
            _ => Err(format!("expected `auto` or seconds, {LARGEST_SHIFT} at most")),
        }
    }
}

/// Runs the command.
///
/// # Errors
/// When a file cannot be read or written, or when track and truth share no points or frames; one sentence.
pub(super) fn run(args: &ScoreArgs) -> Result<()> {
    let truth = if args.truth_y_up { read_y_up_points(&args.truth)? } else { read_points(&args.truth)? };
    let (path, ours, mut pairs) = tracked_points(&args.track, &truth, &args.map)?;
    for (file, points, other) in [(&args.truth, &truth, &ours), (&path, &ours, &truth)] {
        if let Some(note) = points.same_labels() {
            tell!("note: {}: {note}", file.display());
        }
        // One of another program, or saved by one: it cannot say where it begins.
        if PointFormat::of(file)? == PointFormat::Bvh && points.first_frame == 0 && other.first_frame > 0 {
            let begins = other.first_frame;
            tell!(
                "note: {} is taken to begin at frame 0, and what it is compared with at frame {begins}",
                file.display()
            );
        }
    }
    if !args.points.is_empty() {
        pairs.keep(&ours, &truth, &args.points)?;
    }
    pairs.exclude(&ours, &truth, &args.exclude)?;
    let files = || format!("cannot compare {} with {}", path.display(), args.truth.display());
    let shift = match args.shift {
        None => 0.0,
        Some(Shift::Seconds(seconds)) => seconds,
        Some(Shift::Auto) => best_shift(&ours, &truth, &pairs, args.remove_offset).with_context(files)?,
    };
    if matches!(args.shift, Some(Shift::Auto)) && shift.abs() > FARTHEST_SHIFT - AT_THE_END {
        tell!(
            "note: the best shift, {shift:.3} s, lies at the end of what `--shift auto` looks at: state one that is nearer with --shift SECONDS"
        );
    }
    let compare =
        |remove_offset: bool| TrajectoryError::shifted(&ours, &truth, &pairs, remove_offset, shift).with_context(files);
    let error = compare(false)?;
    let without_offset = args.remove_offset.then(|| compare(true)).transpose()?;
    if let Some(file) = &args.per_frame {
        let overwrite = Overwrite::forced(args.force);
        write_atomically(file, overwrite, |out| write_frame_errors(out, &error))?;
    }
    if args.json {
        let mut object = as_json(&path, &args.truth, &pairs, &error, without_offset.as_ref());
        if args.shift.is_some() {
            object["shift"] = json!(error.shift);
        }
        say!("{object:#}");
    } else {
        print_table(&path, &args.truth, &pairs, &error, without_offset.as_ref());
    }
    Ok(())
}

fn matched_by(matching: Matching) -> &'static str {
    match matching {
        Matching::FrameIndex => "frame index",
        Matching::Time => "time, the truth interpolated",
    }
}

fn print_table(
    path: &Path,
    truth: &Path,
    pairs: &PointPairs,
    error: &TrajectoryError,
    without_offset: Option<&TrajectoryError>,
) {
    say!("{} against {}", path.display(), truth.display());
    let shift = match error.shift {
        0.0 => String::new(),
        shift if shift > 0.0 => format!(", the truth taken {shift:.4} s later (--shift {shift:.4})"),
        shift => format!(", the truth taken {:.4} s earlier (--shift {shift:.4})", -shift),
    };
    say!("{} frames matched by {}{shift}, errors in mm\n", error.frames.len(), matched_by(error.matching));
    let label = |name: &str, ours: &str| if name == ours { name.to_string() } else { format!("{name} = {ours}") };
    let labels: Vec<String> = error.points.iter().map(|point| label(&point.name, &point.ours)).collect();
    let width = labels.iter().map(|label| label.chars().count()).max().unwrap_or(0).max("point".len());
    let more = if without_offset.is_some() { "  offset x,y,z               without it" } else { "" };
    say!("{:<width$}  frames     mean      std      max{more}", "point");
    for (index, (point, label)) in error.points.iter().zip(&labels).enumerate() {
        put!("{label:<width$}  {:6} {:8.2} {:8.2} {:8.2}", point.frames, point.mean, point.std, point.max);
        if let Some(rest) = without_offset.and_then(|without| without.points.get(index)) {
            let o = point.offset;
            put!("  {:8.2},{:8.2},{:8.2}  {:8.2}", o.x, o.y, o.z, rest.mean);
        }
        say!("");
    }
    say!("");
    if error.missing > 0 || error.frames_without_truth > 0 {
        say!(
            "missing: {} points in compared frames; {} frames of the track lie outside the truth",
            error.missing,
            error.frames_without_truth
        );
    }
    for (names, what) in [
        (&pairs.missing_in_ours, "not in the track"),
        (&pairs.missing_in_truth, "not in the truth"),
        (&error.never_seen, "never seen in both"),
    ] {
        if !names.is_empty() {
            say!("{what} ({}): {}", names.len(), names.join(", "));
        }
    }
    say!("error {:.2} ± {:.2} mm over {} points", error.mean, error.std, error.points.len());
    if let Some(without) = without_offset {
        say!("error {:.2} ± {:.2} mm without each point's mean offset", without.mean, without.std);
    }
}

fn as_json(
    path: &Path,
    truth: &Path,
    pairs: &PointPairs,
    error: &TrajectoryError,
    without_offset: Option<&TrajectoryError>,
) -> serde_json::Value {
    let summary = |error: &TrajectoryError| {
        let points: Vec<serde_json::Value> = error
            .points
            .iter()
            .map(|p| {
                json!({
                    "name": p.name, "ours": p.ours, "frames": p.frames, "mean": p.mean, "std": p.std, "max": p.max,
                    "offset": p.offset.to_array(),
                })
            })
            .collect();
        json!({ "mean": error.mean, "std": error.std, "points": points })
    };
    let mut object = summary(error);
    object["track"] = json!(path.display().to_string());
    object["truth"] = json!(truth.display().to_string());
    object["matched_by"] = json!(match error.matching {
        Matching::FrameIndex => "frame",
        Matching::Time => "time",
    });
    object["frames"] = json!(error.frames.len());
    object["frames_without_truth"] = json!(error.frames_without_truth);
    object["missing"] = json!(error.missing);
    object["not_in_track"] = json!(pairs.missing_in_ours);
    object["not_in_truth"] = json!(pairs.missing_in_truth);
    object["never_seen"] = json!(error.never_seen);
    if let Some(without) = without_offset {
        object["without_offset"] = summary(without);
    }
    object
}
