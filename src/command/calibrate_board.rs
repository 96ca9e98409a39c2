//! `pantin calibrate --board`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result, anyhow, bail, ensure};
use image::{DynamicImage, GrayImage};
use rayon::prelude::*;

use super::belonging::{refuse_with, refuse_without};
use super::output::{put, tell};
use super::progress::ProgressBar;
use crate::calibrate::{
    Board, BoardCalibration, BoardDetector, BoardKind, BoardMoment, BoardSettings, Floor, SeenCorner, calibrate_board,
};
use crate::sequence::{Footage, InStep, SAME_RATE, SpreadFrames, in_step, last_of_share};

/// A camera fitted with the others may have this many times the noise it has alone, and this much more, pixels, before the
/// videos are suspected.
const NOISIER: (f64, f64) = (2.5, 0.2);

/// The dictionary of most printed boards.
const DICTIONARY: &str = "DICT_4X4_50";
/// Frames a video.
const SAMPLES: usize = 240;

/// The board, and how its videos are looked at.
#[derive(clap::Args, Debug)]
pub(super) struct BoardFlags {
    /// Calibrate from a printed board that is carried through the room, lenses, places and floor: give a video (or numbered
    /// pictures) a camera, all from the same moment on, instead of points.
    #[arg(long)]
    board: Option<BoardKind>,
    /// A chessboard's inner corners, where four squares meet: across x down, an even and an odd number.
    #[arg(long, value_name = "WxH", requires = "board", conflicts_with = "squares")]
    corners: Option<Counts>,
    /// A ChArUco board's squares: across x down.
    #[arg(long, value_name = "WxH", requires = "board")]
    squares: Option<Counts>,
    /// Side of a square, mm, measured on the print.
    #[arg(long, value_name = "MM", requires = "board")]
    square: Option<f64>,
    /// Side of a ChArUco board's marker, mm.
    #[arg(long, value_name = "MM", requires = "board")]
    marker: Option<f64>,
    /// A ChArUco board's dictionary, as OpenCV calls it.
    #[arg(long, value_name = "NAME", default_value = DICTIONARY)]
    dictionary: String,
    /// Thickness of the board, mm: the floor is that far below its print.
    #[arg(long, value_name = "MM", default_value_t = 0.0)]
    thickness: f64,
    /// The frame in which the board lies on the floor, its print upwards; counted from 0 [default: where it lies lowest].
    #[arg(long, value_name = "FRAME", requires = "board")]
    floor: Option<usize>,
    /// Frames a video that the board is looked for in, evenly spread.
    #[arg(long, value_name = "N", default_value_t = SAMPLES)]
    samples: usize,
}

/// Two counts, `9x6`.
#[derive(Clone, Copy, Debug)]
struct Counts([u32; 2]);

impl FromStr for Counts {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let counts = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
        counts.map(Self).ok_or_else(|| anyhow!("{text:?} is no pair of numbers, expected one like 9x6"))
    }
}

impl BoardFlags {
    /// Whether a board was asked for.
    pub(super) fn is_given(&self) -> bool {
        self.board.is_some()
    }

    /// Refuses what is for a board alone where none was asked for.
    ///
    /// # Errors
    /// With the option.
    pub(super) fn refuse_without_board(&self) -> Result<()> {
        let options = [
            ("--corners", self.corners.is_some()),
            ("--squares", self.squares.is_some()),
            ("--square", self.square.is_some()),
            ("--marker", self.marker.is_some()),
            ("--dictionary", self.dictionary != DICTIONARY),
            ("--thickness", self.thickness != 0.0),
            ("--floor", self.floor.is_some()),
            ("--samples", self.samples != SAMPLES),
        ];
        refuse_without("--board", &options)
    }

    fn board(&self) -> Result<Board> {
        let Some(kind) = self.board else { bail!("--board is missing, expected chessboard or charuco") };
        let square =
            self.square.context("--square is missing, expected the side of a square in mm, measured on the print")?;
        let board = match kind {
            BoardKind::Chessboard => {
                refuse_with("--board chessboard", &[("--marker", self.marker.is_some())])?;
                let corners = self.corners.context(
                    "--corners is missing, expected the chessboard's inner corners, where four squares meet, like 9x6",
                )?;
                Board { kind, corners: corners.0, square, markers: None }
            }
            BoardKind::Charuco => {
                let squares =
                    self.squares.context("--squares is missing, expected the ChArUco board's squares, like 7x5")?;
                let marker = self.marker.context("--marker is missing, expected the side of a marker in mm")?;
                let corners = squares.0.map(|count| count.saturating_sub(1));
                Board { kind, corners, square, markers: Some((marker, self.dictionary.clone())) }
            }
        };
        board.check()?;
        Ok(board)
    }

    /// Finds the board in the videos and calibrates their cameras; `settings` are those of the lens.
    ///
    /// # Errors
    /// When something about the board is missing or makes no sense, a video cannot be read, or the cameras cannot be
    /// calibrated from what they see.
    pub(super) fn calibrate(&self, videos: &[PathBuf], settings: BoardSettings) -> Result<BoardCalibration> {
        ensure!((0.0..1000.0).contains(&self.thickness), "--thickness is {}, expected 0 or more, mm", self.thickness);
        ensure!(self.samples > 0, "--samples is 0, expected the number of frames to look at");
        let board = self.board()?;
        let detector = BoardDetector::new(&board)?;
        let names = names(videos)?;
        let footage = videos.iter().map(|video| Footage::open(video)).collect::<Result<Vec<_>>>()?;
        for turned in footage.iter().filter_map(Footage::turned) {
            tell!("note: {turned}");
        }
        let InStep { mut footage, picked_at } = in_step(footage)?;
        match picked_at {
            Some(rate) => tell!(
                "note: the videos have several frame rates or lack pictures: they are taken in step at {rate:.3} frames a second by their \
                 time stamps, and frames are counted so"
            ),
            None => tell_of_times(&footage),
        }
        let shortest = footage.iter().map(|footage| footage.frame_count).min().unwrap_or(0);
        if let Some(longer) = footage.iter().find(|footage| footage.frame_count > shortest) {
            tell!(
                "{} has {} frames and another {shortest}: all are used up to there",
                longer.shown,
                longer.frame_count
            );
        }
        footage.iter_mut().for_each(|footage| footage.frame_count = shortest);
        if let Some(frame) = self.floor {
            ensure!(frame < shortest, "--floor is {frame}, and the videos have {shortest} frames, counted from 0");
        }
        let sizes: Vec<[u32; 2]> = footage.iter().map(|footage| footage.size).collect();
        let moments = moments(&footage, &detector, self.samples.min(shortest), self.floor)?;
        let floor = self.floor.map_or(Floor::Lowest, Floor::Frame);
        let settings = BoardSettings { floor, thickness: self.thickness, ..settings };
        calibrate_board(&board, &names, &sizes, &moments, &settings)
    }
}

/// Says which videos lack pictures where one of them has no time stamps: frames of one number are taken for one moment.
fn tell_of_times(footage: &[Footage]) {
    for one in footage {
        if let Some(times) = one.times.as_ref().filter(|times| !times.is_regular()) {
            tell!(
                "note: the pictures of {} did not come at a constant rate, {} are missing: frames of one number are taken for one moment, so \
                 move the board slowly or re-encode it (ffmpeg -i IN -vf fps={:.3} OUT)",
                one.shown,
                times.missing(),
                times.usual_rate()
            );
        }
    }
    let rates: Vec<(&str, f64)> = footage.iter().filter_map(|one| Some((one.shown.as_str(), one.fps?))).collect();
    let Some((first, rate)) = rates.first() else { return };
    if let Some((other, another)) = rates.iter().find(|(_, other)| (other / rate - 1.0).abs() > SAME_RATE) {
        tell!(
            "note: {first} has {rate:.3} frames a second and {other} {another:.3}: frames of one number are taken for one moment, expected one rate"
        );
    }
}

/// What the user sees of all cameras together; each is told of by itself.
pub(super) fn tell_of(found: &BoardCalibration) {
    for (camera, (seen, alone)) in found.cameras.iter().zip(&found.alone) {
        let name = &camera.camera.name;
        put!("{name}: the board is found in {seen} frames; noise {alone:.3} px alone, {:.3} px with all", camera.noise);
        if camera.noise > NOISIER.0 * alone + NOISIER.1 {
            tell!(
                "{name} fits the board by itself and not together with the others: its video may begin at another moment, or the \
                 board was moved too fast"
            );
        }
        for estimate in &camera.estimates {
            let is_focal = ["f", "fy"].contains(&estimate.name);
            let share = estimate.deviation.map_or(0.0, |deviation| 100.0 * deviation / estimate.value);
            if is_focal && share > 1.0 {
                tell!("{name}: its focal length is known to {share:.1} % only: show it the board tilted, and near");
            }
        }
    }
    let floor = &found.floor;
    let frames = match &floor.frames[..] {
        [] => String::new(),
        [only] => format!("frame {only}"),
        [first, .., last] => format!("{} frames from {first} to {last}", floor.frames.len()),
    };
    put!(
        "{} moments were fitted together, {} views left out; the floor is where the board lies in {frames}, {:.1} \
         degrees from the mean upward direction of the pictures",
        found.moments,
        found.left_out,
        floor.tilt
    );
}

/// The cameras are called as their videos are.
fn names(videos: &[PathBuf]) -> Result<Vec<String>> {
    let mut names: Vec<String> = Vec::new();
    for video in videos {
        let name = camera_name(video);
        ensure!(!name.is_empty(), "{} says no camera's name, expected one like cam01.mp4", video.display());
        if let Some(same) = names.iter().position(|known| *known == name) {
            bail!(
                "{} and {} are both called `{name}`, expected names of their own",
                videos[same].display(),
                video.display()
            );
        }
        names.push(name);
    }
    Ok(names)
}

/// `cam01` of `cam01.mp4`, `cam01_%04d.png` and `cam01/%04d.png`.
fn camera_name(video: &Path) -> String {
    let stem = video.file_stem().unwrap_or_default().to_string_lossy();
    let before = stem.split('%').next().unwrap_or_default();
    let name = before.trim_end_matches(['_', '-', '.', ' ']);
    if name.is_empty() {
        return video.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy().into_owned();
    }
    name.to_string()
}

/// Looks for the board in frames that are evenly spread, in all videos at once; and in one frame more.
fn moments(
    footage: &[Footage],
    detector: &BoardDetector,
    samples: usize,
    also: Option<usize>,
) -> Result<Vec<BoardMoment>> {
    let mut progress = ProgressBar::new("looking for the board", samples);
    let mut moments = look(footage, detector, samples, &mut || progress.advance())?;
    if let Some(frame) = also.filter(|frame| moments.iter().all(|moment| moment.frame != *frame)) {
        // The last frame of the footage up to there.
        let upto: Vec<Footage> =
            footage.iter().map(|footage| Footage { frame_count: frame + 1, ..footage.clone() }).collect();
        moments.extend(look(&upto, detector, 1, &mut || {})?);
    }
    Ok(moments)
}

fn look(
    footage: &[Footage],
    detector: &BoardDetector,
    samples: usize,
    advance: &mut dyn FnMut(),
) -> Result<Vec<BoardMoment>> {
    let mut frames =
        footage.iter().map(|footage| footage.spread(samples, footage.size)).collect::<Result<Vec<SpreadFrames>>>()?;
    let total = footage.first().map_or(0, |footage| footage.frame_count);
    let mut moments = Vec::with_capacity(samples);
    for sample in 1..=samples {
        let pictures: Option<Result<Vec<_>>> =
            frames.iter_mut().map(Iterator::next).collect::<Option<Vec<_>>>().map(|all| all.into_iter().collect());
        let Some(pictures) = pictures else { break };
        let grey: Vec<GrayImage> =
            pictures?.into_iter().map(|picture| DynamicImage::ImageRgb8(picture).into_luma8()).collect();
        let views: Vec<Vec<SeenCorner>> = grey.par_iter().map(|picture| detector.find(picture)).collect();
        moments.push(BoardMoment { frame: last_of_share(sample, total, samples), views });
        advance();
    }
    Ok(moments)
}
