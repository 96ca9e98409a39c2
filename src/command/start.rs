//! `pantin start`.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};

use super::fit::{floor_place, summary};
use super::name_pair::name_pair;
use super::output::{put, say, tell};
use super::progress::WorkBar;
use crate::files::{Overwrite, listed};
use crate::sequence::{DOUBTFUL, Orientation, check_scale};
use crate::track::{FirstPerson, FirstTry, FirstTrySettings, FirstView, FitSettings, FrameRange, first_try};

/// Makes all that a first track needs from your videos, their calibration and the person's height.
///
/// Writes sequence.toml, plates/ (the empty scene, learnt from each whole video), body.toml and start.csv (the person measured in frame
/// 0, where a T-pose shows most, or in the first in which somebody is seen) and look/ (pictures of what is taken for the person, and of the body over it), and says what it saw and
/// what to do next. Videos are matched to cameras by name: cam01.mp4, or walk_cam01.mp4, is camera cam01's.
#[derive(clap::Args, Debug)]
pub(super) struct StartArgs {
    /// A video a camera, or numbered pictures: frames/cam01_%04d.png.
    #[arg(value_name = "VIDEO", required = true, num_args = 2..)]
    videos: Vec<PathBuf>,
    /// The calibration: Pose2Sim, anipose or caliscope TOML, Qualisys .qca.txt, Vicon .xcp, OpenCV YAML or XML, EasyMocap's pair.
    #[arg(long, value_name = "FILE")]
    cameras: PathBuf,
    /// Height of the person, with shoes and hair, mm. With --people one for each, separated by commas: the largest is of who looks tallest.
    #[arg(long, value_name = "MM", required = true, value_delimiter = ',')]
    height: Vec<f64>,
    /// How many people are tracked together: those who stand nearest to where the cameras look, all to be seen by themselves in the first of the
    /// frames. Who is not tracked disturbs whom he overlaps in pictures.
    #[arg(long, value_name = "N", default_value_t = 1, conflicts_with_all = ["at", "heading"])]
    people: usize,
    /// Where the person stands in the first of the frames, where several people are seen: world x and y, mm [default: nearest to where the cameras
    /// look].
    #[arg(long, value_name = "X,Y", value_parser = floor_place, allow_hyphen_values = true)]
    at: Option<[f64; 2]>,
    /// The folder to make.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Pictures of the empty scene, DIR/CAMERA.png (or .jpg) each, or with the camera's name in theirs (bg_cam01.png) [default: learnt from
    /// the whole videos].
    #[arg(long, value_name = "DIR")]
    plates: Option<PathBuf>,
    /// Frames per second [default: what the videos say].
    #[arg(long, value_name = "FPS")]
    fps: Option<f64>,
    /// Working size over stored size [default: such that the person is some 220 pixels tall].
    #[arg(long, value_name = "S")]
    scale: Option<f64>,
    /// How a camera's stored pictures are turned when they are read: upright (as a video is marked), stored, 90, 180 or 270 (degrees
    /// clockwise), mirrored. Once a camera; it is written into the manifest.
    #[arg(long, value_name = "CAMERA=HOW", value_delimiter = ',', value_parser = camera_orientation)]
    orientation: Vec<(String, Orientation)>,
    /// Frames that the person is measured in: A..B without B, A.., or ..B; counted from 0 [default: the first, or where nobody can be measured there,
    /// the first in which somebody is seen].
    #[arg(long, value_name = "A..B")]
    frames: Option<FrameRange>,
    /// Where the person faces: degrees, 0 along x, 90 along y [default: tries all round].
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    heading: Option<f64>,
    /// Poses scored at once.
    #[arg(long, value_name = "N", default_value_t = FitSettings::default().particles)]
    particles: usize,
    /// Times that many poses are scored in a round.
    #[arg(long, value_name = "K", default_value_t = FitSettings::default().iterations)]
    iterations: usize,
    /// Replace sequence.toml, body.toml, start.csv and the learnt plates. What you wrote into sequence.toml stays: name, fps and scale unless
    /// they are given here, `background` of plates that were not learnt, and every key that this command does not write (delay, ignore,
    /// orientation, [features], …); comments do not.
    #[arg(long)]
    force: bool,
}

/// `cam3=180`.
fn camera_orientation(text: &str) -> Result<(String, Orientation), String> {
    let (camera, how) = name_pair(text)?;
    Ok((camera, Orientation::from_name(&how).map_err(|error| error.to_string())?))
}

/// Runs the command.
///
/// # Errors
/// As [`first_try`]; and when nobody could be measured.
pub(super) fn run(args: &StartArgs) -> Result<()> {
    if let Some(heading) = args.heading.filter(|heading| !(-360.0..=360.0).contains(heading)) {
        bail!("--heading is {heading}, expected -360 to 360 degrees");
    }
    if args.people != args.height.len() {
        bail!(
            "--people is {} and --height names {}, expected a height for each, in mm and separated by commas",
            args.people,
            args.height.len()
        );
    }
    args.scale.map_or(Ok(()), check_scale).context("--scale")?;
    let name = args.output.file_name().map_or_else(|| "walk".into(), |name| name.to_string_lossy().into_owned());
    let settings = FirstTrySettings {
        videos: args.videos.clone(),
        cameras: args.cameras.clone(),
        plates: args.plates.clone(),
        name,
        fps: args.fps,
        scale: args.scale,
        orientations: args.orientation.clone(),
        frames: args.frames,
        fit: FitSettings {
            at: args.at,
            heading: args.heading,
            particles: args.particles,
            iterations: args.iterations,
            ..FitSettings::default()
        },
        heights: args.height.clone(),
        overwrite: Overwrite::forced(args.force),
    };
    let mut bar = WorkBar::default();
    let made = first_try(&settings, &args.output, &mut |what, done, total| bar.show(what, done, total))?;
    drop(bar);
    told(&made, args)
}

/// What was made, and what to do next.
fn told(made: &FirstTry, args: &StartArgs) -> Result<()> {
    let folder = args.output.display();
    say!("{}: {} frames, {:.2} a second, scale {}", made.manifest.display(), made.frame_count, made.fps, made.scale);
    for FirstView { camera, video, size: [width, height], person, learnt_from, .. } in &made.views {
        let person = person.map(|tall| format!(", a person some {tall:.0} pixels tall")).unwrap_or_default();
        let video = video.display();
        let plate = learnt_from.map_or_else(|| "filmed".to_string(), |pictures| format!("from {pictures} pictures"));
        say!("  {camera}: {video}, {width}x{height}{person}, plate {plate}");
    }
    for remark in &made.remarks {
        tell!("note: {remark}");
    }
    let [others, heading] = if args.people > 1 {
        ["the same line with --frames A..B --force".to_string(), String::new()]
    } else {
        [
            format!("pantin fit {folder} -o {folder}/body.toml --start-out {folder}/start.csv --frames A..B --force"),
            ", with --heading if back and front are exchanged".to_string(),
        ]
    };
    let people = match &made.people {
        Ok(people) => people,
        Err(why) => bail!(
            "nobody could be measured ({why}); the rest is made: look at {folder}/look/silhouettes.png, whether the person and nothing \
             else is outlined, and where it is not film the empty scene, or try other frames: {others}"
        ),
    };
    for FirstPerson { name, fit } in people {
        if let Some(name) = name {
            say!("{name}, {folder}/{name}:");
        }
        put!("{}", summary(fit));
    }
    say!("look at {folder}/look/silhouettes.png: the outline should hold the person and nothing else");
    let ghosts: Vec<&str> =
        made.views.iter().filter(|view| view.doubtful > DOUBTFUL).map(|view| view.camera.as_str()).collect();
    if !ghosts.is_empty() {
        say!(
            "look at {folder}/plates: the plates of {} may hold the person, who then loses limbs. If so, film the empty scene and give it with \
             --plates, or take a longer video in which the person leaves that place",
            listed(&ghosts)
        );
    }
    if made.fits() {
        say!("look at {folder}/look/body.png: the body should lie on the person in every view");
    } else {
        let skin = if ghosts.is_empty() {
            " Where bare skin is missing before a light wall, write [features.shadow] with chroma = 5 into the manifest, then pantin fit."
        } else {
            ""
        };
        say!(
            "look at {folder}/look/body.png: the body and the outline differ by more than a third in a view. Is the outline the person's?{skin} \
             Are arms and legs apart in that frame? Else measure another one: {others}{heading}"
        );
    }
    // The pose is where a track begins.
    let first = people.first().and_then(|person| person.fit.poses.frames.first().copied()).filter(|first| *first > 0);
    let first = first.map(|first| format!(" --frames {first}..")).unwrap_or_default();
    say!("then: pantin check {folder}{first}");
    say!("      pantin track {folder} -o {folder}-track{first}");
    Ok(())
}
