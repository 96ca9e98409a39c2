//! Sound files of every kind, which cases spoil one of.

use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::support::{has_ffmpeg, pantin_in, program, stdout};

/// A folder of sound files.
pub(super) struct Ground {
    folder: TempDir,
}

/// As little of a track as there is that goes from a frame to the next.
pub(super) const TRACK: &[&str] =
    &["track", "made", "-o", "out", "--particles", "4", "--iterations", "1", "--backend", "cpu", "--frames", "0..2"];

const FIT: &[&str] =
    &["fit", "made", "-o", "out.toml", "--height", "1750", "--particles", "4", "--iterations", "1", "--frames", "0..1"];

const BATCH: &[&str] = &[
    "batch",
    "made",
    "-o",
    "out",
    "--particles",
    "4",
    "--iterations",
    "1",
    "--backend",
    "cpu",
    "--overlay-every",
    "0",
];

const START: &[&str] = &[
    "start",
    "film/videos/cam1.mp4",
    "film/videos/cam2.mp4",
    "--cameras",
    "film/cameras.toml",
    "--height",
    "1750",
    "-o",
    "out",
    "--plates",
    "made/plates",
    "--particles",
    "4",
    "--iterations",
    "1",
];

const POSE2SIM: &[&str] = &[
    "pose2sim",
    "session",
    "--plates",
    "made/plates",
    "--particles",
    "4",
    "--iterations",
    "1",
    "--backend",
    "cpu",
    "--overlay-every",
    "0",
];

/// A command that a case spoils, as it goes well.
pub(super) struct Sound {
    /// The arguments, of which `OUT` stands for what is written.
    pub(super) arguments: &'static [&'static str],
    /// The file or folder that it writes, if any.
    pub(super) output: Option<&'static str>,
}

const SCENE: &str = "name = 'small'\nframes = 4\n[rig]\nsize = [64, 48]\n[output]\nmasks = true\n\
    [features.silhouette]\nmin_area = 4\n[[actor]]\nheight = 1750.0\nmotion = { gait = 'stand' }\n[[camera]]\nname = 'cam2'\nshift = 0.5\n";

/// The same rig filmed.
const FILM: &str = "name = 'film'\nframes = 12\n[rig]\nsize = [64, 48]\n[output]\npictures = 'video'\n\
    [features.silhouette]\nmin_area = 4\n[[actor]]\nheight = 1750.0\nmotion = { gait = 'straight' }\n";

/// A project of Pose2Sim.
const SESSION: &str = "[project]\nmulti_person = false\nparticipant_height = 1.75\nframe_rate = 25\nframe_range = [0, 2]\n\
    [pose]\npose_model = 'Body_with_feet'\n";

const STUDY: &str = "name = 'two'\nseeds = [1, 2]\nparticles = [8]\niterations = [1]\nsearches = ['pso']\nbackends = ['cpu']\nspread = 0.5\n\
    [[sequence]]\npath = 'made'\ntruth = 'truth.trc'\nframes = '0..2'\nname = 'made'\n[[table]]\nname = 'error'\nvalue = 'error'\nrows = ['particles']\n\
    columns = ['sequence']\n[[plot]]\nname = 'rate'\nvalue = 'frames_per_second'\nx = 'particles'\n[[shares]]\nname = 'stages'\nbars = ['model']\n";

/// A scene of files.
const RECORDED: &str = "name = 'recorded'\n[rig]\ncameras = 'made/cameras.toml'\n[[actor]]\nmotion = { file = 'walk.bvh', repeats = true }\n";

/// A table of points of one camera.
const PAIRS: &str = include_str!("../../fuzz/seeds/pairs/wand.csv");

impl Ground {
    /// Makes them with the program.
    pub(super) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("scene.toml"), SCENE).unwrap();
        std::fs::write(at("study.toml"), STUDY).unwrap();
        std::fs::write(at("recorded.toml"), RECORDED).unwrap();
        std::fs::write(at("pairs.csv"), PAIRS).unwrap();
        std::fs::write(at("kick.amc"), include_str!("../../fuzz/seeds/amc/kick.amc")).unwrap();
        let made = |arguments: &[&str]| {
            let (status, _, error) = pantin_in(folder.path(), arguments);
            assert_eq!(status, 0, "{arguments:?}: {error}");
        };
        made(&["synth", "scene.toml", "-o", "made"]);
        made(&["convert", "made/truth_poses.csv", "walk.bvh", "--body", "made/body.toml", "--rate", "25"]);
        made(&["convert", "made/truth.trc", "joints.csv"]);
        if has_ffmpeg("hostile videos") {
            std::fs::write(at("film.toml"), FILM).unwrap();
            made(&["synth", "film.toml", "-o", "film"]);
            for folder in ["session/calibration", "session/videos"] {
                std::fs::create_dir_all(at(folder)).unwrap();
            }
            std::fs::write(at("session/Config.toml"), SESSION).unwrap();
            std::fs::copy(at("film/cameras.toml"), at("session/calibration/Calib.toml")).unwrap();
            copy(&at("film/videos"), &at("session/videos"));
        }
        for file in ["truth.trc", "truth.c3d"] {
            std::fs::copy(at("made").join(file), at(file)).unwrap();
        }
        Self { folder }
    }

    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// A sound file's bytes.
    pub(super) fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path().join(name)).unwrap()
    }

    /// A sound file's text.
    pub(super) fn text(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).unwrap()
    }

    /// Copies all into another folder.
    pub(super) fn copy_to(&self, folder: &Path) {
        copy(self.path(), folder);
    }

    /// The options of a command that take a value, as its help lists them.
    pub(super) fn options(command: &str) -> Vec<String> {
        let help = stdout(&program().args([command, "-h"]).output().unwrap());
        let option = |line: &str| {
            let (flag, rest) = line.trim_start().split_once("--")?;
            let (name, rest) = rest.split_once(' ')?;
            let is_flag = flag.is_empty() || flag.ends_with(", ");
            (is_flag && rest.trim_start().starts_with('<')).then(|| format!("--{name}"))
        };
        help.lines().filter_map(option).collect()
    }

    /// Every command on sound files.
    pub(super) fn commands() -> Vec<Sound> {
        let mut commands = Self::commands_on_pictures();
        if has_ffmpeg("hostile videos") {
            commands.extend(Self::commands_on_videos());
        }
        commands
    }

    /// Those that read videos.
    pub(super) fn commands_on_videos() -> Vec<Sound> {
        let sound = |arguments, output| Sound { arguments, output };
        vec![
            sound(START, Some("out")),
            sound(&["plate", "film/videos/cam1.mp4", "-o", "out.png"], Some("out.png")),
            sound(POSE2SIM, Some("session")),
            sound(&["check", "film", "--samples", "2"], None),
        ]
    }

    fn commands_on_pictures() -> Vec<Sound> {
        let sound = |arguments, output| Sound { arguments, output };
        vec![
            sound(FIT, Some("out.toml")),
            sound(BATCH, Some("out")),
            sound(&["check", "made", "--samples", "2"], None),
            sound(&["convert", "truth.c3d", "out.csv"], Some("out.csv")),
            sound(&["convert", "truth.trc", "out.c3d"], Some("out.c3d")),
            sound(&["convert", "joints.csv", "out.trc"], Some("out.trc")),
            sound(&["convert", "walk.bvh", "out.csv"], Some("out.csv")),
            sound(
                &["convert", "made/truth_poses.csv", "out.bvh", "--body", "made/body.toml", "--rate", "25"],
                Some("out.bvh"),
            ),
            sound(&["score", "joints.csv", "--truth", "truth.trc"], None),
            sound(&["score", "truth.trc", "--truth", "truth.c3d", "--map", "LKNE=left_knee"], None),
            sound(&["score", "walk.bvh", "--truth", "truth.trc"], None),
            sound(
                &["evaluate", "--sequence", "made", "--frame", "1", "--poses", "made/start.csv", "-o", "out"],
                Some("out"),
            ),
            sound(&["features", "made", "-o", "out", "--frames", "0..1"], Some("out")),
            sound(TRACK, Some("out")),
            sound(&["synth", "scene.toml", "-o", "out", "--frames", "1"], Some("out")),
            sound(&["synth", "recorded.toml", "-o", "out", "--frames", "1"], Some("out")),
            sound(&["study", "study.toml", "-o", "out"], Some("out")),
            sound(&["study", "study.toml", "-o", "out", "--plan"], None),
            sound(
                &["calibrate", "pairs.csv", "-o", "out.toml", "--size", "640x480", "--residuals", "out"],
                Some("out"),
            ),
            sound(&["texture", "marble", "-o", "out.png", "--size", "16x16"], Some("out.png")),
            sound(
                &["texture", "--example", "made/plates/cam1.png", "-o", "out.png", "--size", "16x16", "--patch", "8"],
                Some("out.png"),
            ),
            sound(&["matrix", "--n", "2"], None),
        ]
    }
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target: PathBuf = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}
