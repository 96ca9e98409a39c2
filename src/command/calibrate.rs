//! `pantin calibrate`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result, anyhow, bail, ensure};

use super::belonging::refuse_with;
use super::calibrate_board::{BoardFlags, tell_of};
use super::output::put;
use crate::calibrate::{
    BoardSettings, Calibration, CalibrationSettings, CameraPairs, Held, Layout, LensModel, ResidualSummary, calibrate,
    join_tracks, parse_pairs, parse_tracks,
};
use crate::files::{Limit, OutputFolder, Overwrite};
use crate::geometry::{Camera, LARGEST_SIDE, LengthUnit};
use crate::motion::read_points;
use crate::report::{Arrow, arrow_chart};
use crate::sequence::write_cameras_toml;

/// Outliers that are printed one by one.
const MOST_NAMED: usize = 20;

/// Calibrates cameras from points whose place is known in the world and in the pictures: a table with the columns camera,
/// x, y, z, u, v (and perhaps point, a name), or the markers of a wand in a C3D file with their tracks in the pictures.
/// Pixels count from the centre of the top-left one, u to the right, v down; the world is right-handed with z up.
/// At least 5 points in a plane or 7 in space a camera; a hundred all over the volume are good. Or, with --board, from videos
/// of a printed board.
#[derive(clap::Args, Debug)]
pub(super) struct CalibrateArgs {
    /// The table of points; with --board the videos, one a camera, which is called as its video is.
    #[arg(value_name = "POINTS.csv | VIDEOS", required_unless_present = "c3d", conflicts_with = "c3d")]
    points: Vec<PathBuf>,
    /// A C3D (or TRC) file with the markers' trajectories.
    #[arg(long, value_name = "FILE", requires = "tracks")]
    c3d: Option<PathBuf>,
    /// The markers in the pictures: camera, frame (from 0), marker, u, v.
    #[arg(long, value_name = "TRACKS.csv", requires = "c3d")]
    tracks: Option<PathBuf>,
    /// The cameras.toml to write.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Size of the pictures: 1920x1080 for all cameras, or cam01=1920x1080, once a camera.
    #[arg(long, value_name = "[NAME=]WxH", required_unless_present = "board", conflicts_with = "board")]
    size: Vec<PictureSize>,
    /// The lens [default: tsai; with --board brown-conrady].
    #[arg(long)]
    model: Option<LensModel>,
    /// Unit of x, y, z in the table.
    #[arg(long, default_value_t)]
    units: LengthUnit,
    /// How the points lie [default: as they do].
    #[arg(long)]
    layout: Option<Layout>,
    /// What is not estimated but kept at 0, 1 or the picture's middle: some of the names that an unknown one is answered with,
    /// or none [default: k3; for points in a plane aspect,centre,tangential,k3].
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    hold: Option<Vec<String>>,
    /// Side of a pixel, mm: gives f and kappa of Tsai's model their unit.
    #[arg(long, value_name = "MM", default_value_t = CalibrationSettings::default().pitch)]
    pitch: f64,
    /// Use every point. Without it those farther off than 4.5 robust standard deviations (the median residual / 1.1774)
    /// are left out and named.
    #[arg(long)]
    keep_outliers: bool,
    #[command(flatten)]
    board: BoardFlags,
    /// A folder for a picture a camera of its residuals as arrows, and residuals.csv.
    #[arg(long, value_name = "DIR")]
    residuals: Option<PathBuf>,
    /// Replace the files.
    #[arg(long)]
    force: bool,
}

#[derive(Clone, Debug)]
struct PictureSize {
    camera: Option<String>,
    size: [u32; 2],
}

impl FromStr for PictureSize {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let (camera, size) = match text.rsplit_once('=') {
            Some((camera, size)) => (Some(camera.to_string()), size),
            None => (None, text),
        };
        let sides = size.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
        let sane = sides.filter(|sides: &[u32; 2]| sides.iter().all(|side| (1..=LARGEST_SIDE).contains(side)));
        let size = sane.ok_or_else(|| anyhow!("{text:?} is no size, expected WIDTHxHEIGHT or NAME=WIDTHxHEIGHT"))?;
        Ok(Self { camera, size })
    }
}

/// Runs the command.
///
/// # Errors
/// When a file cannot be read or makes no sense, a camera cannot be calibrated from its points, or the result cannot be
/// written.
pub(super) fn run(args: &CalibrateArgs) -> Result<()> {
    let overwrite = Overwrite::forced(args.force);
    // Said before the work, not after it.
    overwrite.check(&args.output)?;
    let settings = settings(args)?;
    let calibrations = if args.board.is_given() { from_board(args, settings)? } else { from_points(args, &settings)? };
    let calibrated: Vec<Camera> = calibrations.iter().map(|found| found.camera.clone()).collect();
    write_cameras_toml(&args.output, &calibrated, overwrite)?;
    if let Some(folder) = &args.residuals {
        write_residuals(&OutputFolder::create(folder, overwrite)?, &calibrations)?;
    }
    Ok(())
}

fn from_board(args: &CalibrateArgs, settings: CalibrationSettings) -> Result<Vec<Calibration>> {
    // A board is a plane at many places, and wrong views of it are always left out.
    refuse_with("--board", &[("--layout", args.layout.is_some()), ("--keep-outliers", args.keep_outliers)])?;
    let lens = BoardSettings::default();
    let model = args.model.unwrap_or(lens.model);
    let found = args
        .board
        .calibrate(&args.points, BoardSettings { model, held: settings.held, pitch: settings.pitch, ..lens })?;
    found.cameras.iter().for_each(|camera| put!("{}", summary(camera)));
    tell_of(&found);
    Ok(found.cameras)
}

fn from_points(args: &CalibrateArgs, settings: &CalibrationSettings) -> Result<Vec<Calibration>> {
    args.board.refuse_without_board()?;
    let (source, cameras) = pairs(args)?;
    let mut calibrations = Vec::new();
    for pairs in &cameras {
        let found = calibrate(pairs, size_of(&args.size, &pairs.camera)?, settings).with_context(|| source.clone())?;
        put!("{}", summary(&found));
        calibrations.push(found);
    }
    Ok(calibrations)
}

fn settings(args: &CalibrateArgs) -> Result<CalibrationSettings> {
    ensure!(
        args.pitch > 1e-6 && args.pitch < 1e3,
        "--pitch is {}, expected the side of a pixel in mm, say 0.01",
        args.pitch
    );
    let held = args.hold.as_deref().map(|names| {
        let names = names.iter().map(|name| name.trim()).filter(|name| *name != "none" && !name.is_empty());
        names.map(|name| Held::from_name(name).context("--hold")).collect::<Result<Vec<_>>>()
    });
    Ok(CalibrationSettings {
        model: args.model.unwrap_or(CalibrationSettings::default().model),
        layout: args.layout,
        held: held.transpose()?,
        pitch: args.pitch,
        keep_outliers: args.keep_outliers,
    })
}

/// The pairs, and what messages call their source.
fn pairs(args: &CalibrateArgs) -> Result<(String, Vec<CameraPairs>)> {
    if let (Some(markers), Some(tracks)) = (&args.c3d, &args.tracks) {
        let source = format!("{} and {}", markers.display(), tracks.display());
        let tracks = parse_tracks(&text(tracks)?, &tracks.display().to_string())?;
        let joined = join_tracks(&tracks, &read_points(markers)?).with_context(|| source.clone())?;
        return Ok((source, joined));
    }
    let [table] = &args.points[..] else {
        bail!(
            "{} tables of points were given, expected one; videos of a printed board need --board",
            args.points.len()
        );
    };
    let source = table.display().to_string();
    let pairs = parse_pairs(&text(table)?, &source, args.units.mm())?;
    Ok((source, pairs))
}

fn text(path: &Path) -> Result<String> {
    /// A hundred thousand points a camera take less; anything larger is a mistake.
    const TABLE: Limit = Limit { what: "a table of points", most: 256 << 20 };
    TABLE.read_text(path)
}

fn size_of(sizes: &[PictureSize], camera: &str) -> Result<[u32; 2]> {
    let named = sizes.iter().find(|size| size.camera.as_deref() == Some(camera));
    let found = named.or_else(|| sizes.iter().find(|size| size.camera.is_none()));
    found
        .map(|size| size.size)
        .ok_or_else(|| anyhow!("camera `{camera}` has no --size, expected {camera}=WIDTHxHEIGHT"))
}

/// What the user sees of one camera.
fn summary(found: &Calibration) -> String {
    let mut text = String::new();
    let layout = match found.layout {
        Layout::Coplanar => "in a plane",
        Layout::General => "in space",
    };
    let ResidualSummary { count, mean, rms, max } = ResidualSummary::of(&found.residuals);
    // Writing into a String cannot fail.
    let _ = writeln!(
        text,
        "{}: {count} points {layout}, residuals mean {mean:.3}, rms {rms:.3}, max {max:.3} px; noise {:.3} px",
        found.camera.name, found.noise
    );
    let centre = found.camera.centre_in_world();
    let _ = writeln!(text, "  stands at ({:.1}, {:.1}, {:.1}) mm", centre.x, centre.y, centre.z);
    for estimates in found.estimates.chunks(3) {
        let shown = estimates.iter().map(|estimate| match estimate.deviation {
            Some(deviation) => format!("{} {:.6} ± {:.2e}", estimate.name, estimate.value, deviation),
            None => format!("{} {:.6} (held)", estimate.name, estimate.value),
        });
        let _ = writeln!(text, "  {}", shown.collect::<Vec<_>>().join(", "));
    }
    let outliers: Vec<_> = found.residuals.iter().filter(|residual| residual.is_outlier).collect();
    if !outliers.is_empty() {
        let _ = writeln!(text, "  {} outliers left out:", outliers.len());
    }
    for residual in outliers.iter().take(MOST_NAMED) {
        let _ = writeln!(
            text,
            "    {} at ({:.1}, {:.1}): {:.2} px off",
            residual.name,
            residual.pixel.x,
            residual.pixel.y,
            residual.length()
        );
    }
    text
}

fn write_residuals(folder: &OutputFolder, calibrations: &[Calibration]) -> Result<()> {
    for found in calibrations {
        let summary = ResidualSummary::of(&found.residuals);
        let arrow = |residual: &crate::calibrate::Residual| {
            let colour = if residual.is_outlier { [210, 60, 40] } else { [40, 90, 160] };
            Some(Arrow { at: residual.pixel.to_array(), offset: residual.offset?.to_array(), colour })
        };
        let arrows: Vec<Arrow> = found.residuals.iter().filter_map(arrow).collect();
        let name = &found.camera.name;
        let title = format!("{name}: {} points, rms {:.3} px", summary.count, summary.rms);
        let svg = arrow_chart(&title, found.camera.size, &arrows)?;
        folder.write(&format!("{name}.svg"), |writer| Ok(writer.write_all(svg.as_bytes())?))?;
    }
    folder.write("residuals.csv", |writer| {
        let mut table = csv::Writer::from_writer(writer);
        table.write_record(["camera", "point", "u", "v", "du", "dv", "outlier"])?;
        for found in calibrations {
            for residual in &found.residuals {
                let offset =
                    residual.offset.map_or([const { String::new() }; 2], |o| o.to_array().map(|o| format!("{o:.4}")));
                let [u, v] = residual.pixel.to_array().map(|place| place.to_string());
                let [du, dv] = offset;
                let is_outlier = u8::from(residual.is_outlier).to_string();
                table.write_record([&found.camera.name, &residual.name, &u, &v, &du, &dv, &is_outlier])?;
            }
        }
        Ok(table.flush()?)
    })
}
