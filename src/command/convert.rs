//! `pantin convert`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::convert_poses::{PoseFlags, tell_smoothed};
use super::name_pair::name_pair;
use super::output::{say, tell};
use crate::body::{ADULT_HEIGHT, Body};
use crate::files::{Overwrite, write_atomically};
use crate::motion::{
    Convention, LowPass, PointFormat, read_bvh, read_points, read_y_up_points, write_bvh, write_points_by,
};

/// Converts a recording between C3D, TRC, BVH and CSV, each known by its extension. Lengths become millimetres (BVH has
/// no unit: but for a file that pantin wrote, its numbers are taken as millimetres, see --scale). A BVH becomes the points of its joints and free ends;
/// points do not become a BVH, which needs the joint angles of a skeleton. Poses and their body (--body) become any of these, a skinned
/// motion (.glb) or OpenSim's (.mot). A skinned person (.glb, .gltf) becomes a
/// body.toml: the default body's bones with the person's lengths, parts as thick as the skin, and the file as its mesh.
#[derive(clap::Args, Debug)]
pub(super) struct ConvertArgs {
    /// The file to read: .c3d, .trc, .csv (frame,time,<name>.x,…) or .bvh; .glb or .gltf for a body.
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// The file to write: .c3d, .trc, .csv, or .bvh from a .bvh; .toml from a .glb or .gltf; .bvh, .glb, .mot and points from poses.csv.
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
    /// Whose axes and units OUT has; OpenSim's (metres, y up) in .trc, and in .bvh from one that pantin wrote.
    #[arg(long, value_name = "NAME", default_value_t)]
    convention: Convention,
    /// The height of a skinned person in mm, for files that are not in metres.
    #[arg(long, value_name = "MM")]
    height: Option<f64>,
    /// Name the joint of a skinned person that a bone (or left_wrist, head_top, …) stands for, where its name does not tell.
    #[arg(long, value_name = "BONE=JOINT", value_delimiter = ',', num_args = 1.., value_parser = name_pair)]
    bone: Vec<(String, String)>,
    #[command(flatten)]
    poses: PoseFlags,
    /// Smooth points, or poses with --body: a low-pass without delay, Butterworth, of the fourth order in all, with this cut-off (-3 dB) in
    /// Hz. Each stretch between gaps by itself.
    #[arg(long, value_name = "HZ")]
    smooth: Option<f64>,
    /// Replace OUT when it is there.
    #[arg(long)]
    force: bool,
}

/// Runs the command.
///
/// # Errors
/// When a file cannot be read or written, or when the conversion is not possible; one sentence.
pub(super) fn run(args: &ConvertArgs) -> Result<()> {
    let sane = |value: f64| (1e-6..=1e6).contains(&value);
    ensure!(sane(args.scale), "--scale is {:?}, expected a positive number, 1e-6 to 1e6", args.scale);
    if let Some(rate) = args.rate {
        ensure!(sane(rate), "--rate is {rate:?}, expected a positive number of frames a second, 1e-6 to 1e6");
    }
    let overwrite = Overwrite::forced(args.force);
    if is_skinned_file(&args.input) {
        return import(args, overwrite);
    }
    ensure!(args.height.is_none() && args.bone.is_empty(), "--height and --bone are for .glb and .gltf files alone");
    let is_plain = args.scale == 1.0 && !args.y_up;
    ensure!(
        is_plain || !args.poses.is_asked(),
        "--scale and --y-up are for recordings, expected neither beside --body"
    );
    if args.poses.convert(&args.input, &args.output, args.rate, args.smooth, args.convention, overwrite)? {
        return Ok(());
    }
    let formats = (PointFormat::of_input(&args.input)?, PointFormat::of(&args.output)?);
    let (points, frames, what) = if formats == (PointFormat::Bvh, PointFormat::Bvh) {
        ensure!(
            args.smooth.is_none(),
            "--smooth is for points and poses, expected another ending than .bvh, or poses.csv with --body"
        );
        ensure!(!args.y_up, "--y-up turns points, but a BVH stays a skeleton here: write .c3d, .trc or .csv instead");
        let mut motion = read_bvh(&args.input)?.scaled(args.scale);
        if motion.statement.is_some() || args.convention != Convention::Pantin {
            let millimetres = args.convention.bvh_unit();
            motion = motion.in_unit(millimetres).with_context(|| args.input.display().to_string())?;
        }
        motion.frame_time = args.rate.map_or(motion.frame_time, |rate| 1.0 / rate);
        write_atomically(&args.output, overwrite, |out| write_bvh(out, &motion))?;
        (motion.joints.len(), motion.frames.len(), "joints")
    } else {
        let points = if args.y_up { read_y_up_points(&args.input)? } else { read_points(&args.input)? };
        if let Some(note) = points.same_labels() {
            tell!("note: {}: {note}", args.input.display());
        }
        let mut points = points.scaled(args.scale);
        points.rate = args.rate.unwrap_or(points.rate);
        if let Some(cutoff) = args.smooth {
            let low_pass = LowPass::new(cutoff, points.rate).with_context(|| args.input.display().to_string())?;
            let left = low_pass.smooth_points(&mut points).with_context(|| args.input.display().to_string())?;
            tell_smoothed(&low_pass, left);
        }
        let counts = (points.names.len(), points.frames.len(), "points");
        write_points_by(&args.output, points, args.convention, overwrite)?;
        counts
    };
    say!("{}: {points} {what}, {frames} frames", args.output.display());
    Ok(())
}

fn is_skinned_file(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("glb") || end.eq_ignore_ascii_case("gltf"))
}

fn import(args: &ConvertArgs, overwrite: Overwrite) -> Result<()> {
    ensure!(
        args.scale == 1.0 && args.rate.is_none() && args.smooth.is_none() && !args.y_up,
        "--scale, --rate, --smooth and --y-up are for recordings, expected --height to give the size of a skinned person"
    );
    ensure!(
        args.output.extension().is_some_and(|end| end == "toml"),
        "{} is no body file, expected a name that ends in .toml: a skinned person becomes a body",
        args.output.display()
    );
    let names: BTreeMap<String, String> = args.bone.iter().cloned().collect();
    let body = Body::from_gltf(&args.input, &Body::adult(ADULT_HEIGHT)?, args.height, &names)?;
    body.save(&args.output, overwrite)?;
    say!("{}: {} bones, {} parts", args.output.display(), body.bones.len(), body.parts.len());
    Ok(())
}
