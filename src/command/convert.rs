//! `pantin convert`.

use std::path::PathBuf;

use anyhow::{Result, ensure};

use crate::files::{Overwrite, write_atomically};
use crate::motion::{PointFormat, read_bvh, read_points, write_bvh, write_points};

/// Converts a recording between C3D, TRC, BVH and CSV, each known by its extension. Lengths become millimetres (BVH has
/// no unit: its numbers are taken as millimetres, see --scale). A BVH becomes the points of its joints and free ends;
/// points do not become a BVH, which needs the joint angles of a skeleton.
#[derive(clap::Args, Debug)]
pub struct ConvertArgs {
    /// The file to read: .c3d, .trc, .csv (frame,time,<name>.x,…) or .bvh.
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// The file to write: .c3d, .trc, .csv, or .bvh from a .bvh.
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Multiply every length, for files without a unit (10 for a BVH in centimetres).
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    scale: f64,
    /// Set the frame rate, for files that do not say it. Frames are not resampled.
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// The input is y-up (BVH, OpenSim): turn it z-up, (x, y, z) becoming (z, x, y).
    #[arg(long)]
    y_up: bool,
    /// Replace OUT when it is there.
    #[arg(long)]
    force: bool,
}

/// Runs the command.
///
/// # Errors
/// When a file cannot be read or written, or when the conversion is not possible; one sentence.
pub fn run(args: &ConvertArgs) -> Result<()> {
    let positive = |value: f64| value.is_finite() && value > 0.0;
    ensure!(positive(args.scale), "--scale is {}, expected a positive number", args.scale);
    if let Some(rate) = args.rate {
        ensure!(positive(rate), "--rate is {rate}, expected a positive number of frames a second");
    }
    let overwrite = if args.force { Overwrite::Replace } else { Overwrite::Refuse };
    let formats = (PointFormat::of(&args.input)?, PointFormat::of(&args.output)?);
    let (points, frames, what) = if formats == (PointFormat::Bvh, PointFormat::Bvh) {
        ensure!(!args.y_up, "--y-up turns points, but a BVH stays a skeleton here: write .c3d, .trc or .csv instead");
        let mut motion = read_bvh(&args.input)?.scaled(args.scale);
        motion.frame_time = args.rate.map_or(motion.frame_time, |rate| 1.0 / rate);
        write_atomically(&args.output, overwrite, |out| write_bvh(out, &motion))?;
        (motion.joints.len(), motion.frames.len(), "joints")
    } else {
        let mut points = read_points(&args.input)?.scaled(args.scale);
        if args.y_up {
            points = points.y_up_to_z_up();
        }
        points.rate = args.rate.unwrap_or(points.rate);
        write_points(&args.output, &points, overwrite)?;
        (points.names.len(), points.frames.len(), "points")
    };
    println!("{}: {points} {what}, {frames} frames", args.output.display());
    Ok(())
}
