//! Running the program, how runs end, and what they run on.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use tempfile::TempDir;

use super::walk;

/// Variables under which the loader finds no driver, by its old and its new name for them.
pub(crate) const NO_DRIVER: [(&str, &str); 2] =
    [("VK_ICD_FILENAMES", "/nonexistent"), ("VK_DRIVER_FILES", "/nonexistent")];

/// What a track writes that must not depend on time, machine or interruption, but for the overlays.
pub(crate) const TRACK_FILES: [&str; 12] = [
    "poses.csv",
    "joints.csv",
    "joints.trc",
    "joints_opensim.trc",
    "markers.c3d",
    "motion.bvh",
    "motion.glb",
    "motion.mot",
    "motion_sd.mot",
    "coordinates.toml",
    "confidence.csv",
    "journal.txt",
];

/// The program.
pub(crate) fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_pantin"))
}

/// Runs it on these arguments.
pub(crate) fn pantin(arguments: &[&str]) -> Output {
    program().args(arguments).output().unwrap()
}

/// Runs it in a folder: exit status, standard output, standard error.
pub(crate) fn pantin_in(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = program().current_dir(folder).args(arguments).output().unwrap();
    (output.status.code().unwrap(), stdout(&output), stderr(&output))
}

pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[track_caller]
pub(crate) fn succeeded(output: &Output) {
    assert!(output.status.success(), "{}", stderr(output));
}

/// Runs that must fail with status 1 and one sentence that holds `parts`.
#[track_caller]
pub(crate) fn refused(output: &Output, parts: &[&str]) {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    let sentence = text.lines().last().unwrap_or_default();
    assert!(sentence.starts_with("pantin: ") && !text.contains("panicked"), "{text}");
    for part in parts {
        assert!(sentence.contains(part), "`{sentence}` lacks `{part}`");
    }
}

/// Runs in a folder that must fail with status 1 and one sentence, which alone is said and holds `part`.
#[track_caller]
pub(crate) fn refused_in(folder: &Path, arguments: &[&str], part: &str) {
    let (status, _, error) = pantin_in(folder, arguments);
    assert_eq!(status, 1, "{error}");
    assert!(error.contains(part), "{error}\nshould say: {part}");
    assert_eq!(error.trim_end().lines().count(), 1, "one sentence: {error}");
}

/// A file or folder of the recordings beside the repository, or a line that says that the test is skipped.
pub(crate) fn shared(test: &str, name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name);
    if !path.exists() {
        println!("SKIPPED {test}: ../shared/data is absent");
        return None;
    }
    Some(path)
}

/// Whether ffmpeg is there; says so where not, so that a skipped test is seen.
pub(crate) fn has_ffmpeg(test: &str) -> bool {
    let here = Command::new("ffmpeg").arg("-version").output().is_ok();
    if !here {
        println!("SKIPPED {test}: ffmpeg is not installed");
    }
    here
}

/// Whether there is a Vulkan device for the backends that need one; none is a failure in CI.
pub(crate) fn has_vulkan(test: &str) -> bool {
    let opened = pantin::evaluate::device::open_device();
    if let Err(error) = &opened {
        assert!(std::env::var_os("PANTIN_NEEDS_VULKAN").is_none(), "{error:#}");
        println!("SKIPPED {test}: {error:#}");
    }
    opened.is_ok()
}

/// The sequence that runs track, made once: six frames of pictures and masks, four cameras, 160x120.
pub(crate) fn sequence() -> &'static Path {
    static SEQUENCE: OnceLock<TempDir> = OnceLock::new();
    SEQUENCE
        .get_or_init(|| {
            let folder = tempfile::tempdir().unwrap();
            walk::write(folder.path());
            folder
        })
        .path()
}

/// The recording of the beam as a sequence (docs/BEAM.md): the fixture's manifest, body and start pose beside the recording's
/// files in `data`.
pub(crate) fn lay_out_beam(data: &Path, folder: &Path) {
    std::fs::create_dir_all(folder).unwrap();
    for name in ["sequence.toml", "body.toml", "start.csv"] {
        copy(&beam_fixture(name), &folder.join(name));
    }
    for camera in ["cam01", "cam02", "cam03", "cam04"] {
        copy(&data.join(format!("videos/{camera}.mp4")), &folder.join(format!("{camera}.mp4")));
        let plate = format!("bg_{camera}.png");
        copy(&data.join("background").join(&plate), &folder.join(&plate));
    }
    // The calibration does not say its unit.
    let cameras = std::fs::read_to_string(data.join("cameras.toml")).unwrap();
    std::fs::write(folder.join("cameras.toml"), format!("{cameras}\n[metadata]\nunits = \"mm\"\n")).unwrap();
}

/// A file that the repository has beside the recording of the beam.
pub(crate) fn beam_fixture(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/beam")).join(name)
}

/// Copies a file whatever its permissions are.
pub(crate) fn copy(from: &Path, to: &Path) {
    let bytes = std::fs::read(from).unwrap_or_else(|error| panic!("{}: {error}", from.display()));
    std::fs::write(to, bytes).unwrap_or_else(|error| panic!("{}: {error}", to.display()));
}
