//! The recording of a track, against what the track itself says.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::OnceLock;

use glam::{DMat3, DVec3};
use pantin::files::OutputFolder;
use pantin::motion::{PointTrajectory, read_points};
use pantin::search::SearchSettings;
use pantin::sequence::Sequence;
use pantin::synth::{Scene, SyntheticSequence};
use pantin::track::{Silent, TrackSettings, TrackSummary, track};
use re_log_types::StoreKind;
use re_sdk_types::archetypes::{
    AnnotationContext, BarChart, EncodedImage, Pinhole, Points3D, Scalars, SeriesLines, TextDocument, Transform3D,
    ViewCoordinates,
};
use re_sdk_types::blueprint::archetypes::{TimePanelBlueprint, ViewBlueprint, ViewportBlueprint};
use re_sdk_types::blueprint::components::{TimelineName, ViewClass, ViewOrigin};
use re_sdk_types::components::{
    AnnotationContext as Names, Blob, Name, PinholeProjection, Position3D, Resolution, Scalar, TensorData, Text,
    TransformMat3x3, Translation3D, ViewCoordinates as Axes,
};
use re_sdk_types::datatypes::TensorBuffer;
use tempfile::TempDir;

use super::read_back::Read;
use crate::support::{program, refused, stderr, stdout, succeeded};

const FRAMES: usize = 8;
const FIRST: usize = 2;
const DRAWN: usize = 3;

/// A short walk and its track with a recording.
struct Tracked {
    folder: TempDir,
    sequence: Sequence,
    summary: TrackSummary,
    read: Read,
}

fn settings() -> TrackSettings {
    let search = SearchSettings { particles: 120, iterations: 6, ..SearchSettings::default() };
    let frames = format!("{FIRST}..{FRAMES}").parse().unwrap();
    TrackSettings { search, frames, overlay_every: DRAWN, recording: true, ..TrackSettings::default() }
}

fn tracked() -> &'static Tracked {
    static TRACKED: OnceLock<Tracked> = OnceLock::new();
    TRACKED.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let scene = Scene { frames: FRAMES, ..Scene::preset("demo").unwrap() };
        let made = OutputFolder::open(&folder.path().join("sequence")).unwrap();
        SyntheticSequence::new(&scene).unwrap().write(&made, false, None, &|_| Ok(())).unwrap();
        let sequence = Sequence::open(made.path()).unwrap();
        let output = OutputFolder::open(&folder.path().join("result")).unwrap();
        // The first frame to be tracked is not the sequence's first.
        let start = Some(made.path().join("truth_poses.csv"));
        let summary = track(&sequence, &TrackSettings { start, ..settings() }, &output, &mut Silent).unwrap();
        let read = Read::file(&folder.path().join("result/report.rrd"));
        Tracked { folder, sequence, summary, read }
    })
}

impl Tracked {
    fn points(&self, file: &str) -> PointTrajectory {
        read_points(&self.folder.path().join(file)).unwrap()
    }

    fn scalars(&self, entity: &str) -> Vec<(Option<i64>, f64)> {
        let rows = self.read.rows::<Scalar>(entity, Scalars::descriptor_scalars(), "frame");
        rows.into_iter().map(|(frame, row)| (frame, row[0].0.0)).collect()
    }
}

fn frame(index: usize) -> Option<i64> {
    Some(i64::try_from(index).unwrap())
}

#[test]
fn there_is_one_recording_with_a_layout_of_its_own() {
    let Tracked { sequence, read, .. } = tracked();
    let kinds: Vec<StoreKind> = read.stores.iter().map(|store| store.store_id.kind()).collect();
    assert_eq!(kinds, [StoreKind::Recording, StoreKind::Blueprint]);
    assert!(read.stores.iter().all(|store| store.application_id().as_str() == "pantin"));
    assert_eq!(read.activations.len(), 1);
    assert_eq!(read.activations[0].blueprint_id, read.stores[1].store_id);

    let mut expected = vec!["/__properties", "/report/settings", "/report/summary", "/world"];
    for skeleton in ["/world/tracked", "/world/reference"] {
        expected.push(skeleton);
    }
    let mut expected: Vec<String> = expected.into_iter().map(str::to_string).collect();
    for skeleton in ["tracked", "reference"] {
        expected.extend(["joints", "bones"].map(|part| format!("/world/{skeleton}/{part}")));
    }
    for camera in &sequence.cameras {
        expected.extend(["", "/overlay"].map(|part| format!("/world/cameras/{}{part}", camera.name)));
    }
    let curves = ["error/mean\\ over\\ the\\ joints", "fitness/fitness", "fitness/silhouette\\ \\(mean\\ f1\\)"];
    expected.extend(curves.map(|curve| format!("/plots/{curve}")));
    let more = [
        "error/expected\\,\\ mean\\ over\\ the\\ joints",
        "fitness/confidence",
        "fitness/probability\\ that\\ it\\ is\\ wrong",
    ];
    expected.extend(more.map(|curve| format!("/plots/{curve}")));
    let entities = read.entities();
    let found: Vec<String> = entities.iter().filter(|name| !name.starts_with("/plots/stages/")).cloned().collect();
    expected.sort();
    assert_eq!(found, expected);

    let mut windows: Vec<(String, String)> = Vec::new();
    for chunk in &read.layout {
        let classes = chunk.iter_component::<ViewClass>(ViewBlueprint::descriptor_class_identifier().component);
        let origins = chunk.iter_component::<ViewOrigin>(ViewBlueprint::descriptor_space_origin().component);
        windows.extend(classes.zip(origins).map(|(class, origin)| (class[0].to_string(), origin[0].to_string())));
    }
    // What a window looks at is there.
    for (class, origin) in &windows {
        assert!(entities.iter().any(|entity| entity.starts_with(origin.as_str())), "{class} on {origin}");
    }
    let count = |class: &str| windows.iter().filter(|(found, _)| found == class).count();
    assert_eq!(["3D", "2D", "TimeSeries", "BarChart", "TextDocument"].map(count), [1, sequence.cameras.len(), 2, 1, 2]);
    let has = |component| read.layout.iter().any(|chunk| chunk.components().contains_component(component));
    assert!(has(ViewportBlueprint::descriptor_root_container().component));
    let timeline = TimePanelBlueprint::descriptor_timeline().component;
    let timeline = read.layout.iter().find_map(|chunk| chunk.iter_component::<TimelineName>(timeline).next());
    assert_eq!(timeline.unwrap()[0].as_str(), "time");
}

#[test]
fn skeletons_move_as_their_files_say() {
    let tracked = tracked();
    let axes = tracked.read.always::<Axes>("/world", ViewCoordinates::descriptor_xyz());
    assert_eq!(axes, [Axes::RIGHT_HAND_Z_UP]);
    let truth = tracked.points("sequence/truth.trc");
    let joints = tracked.points("result/joints.csv");
    for (name, file, first) in [("tracked", &joints, 0), ("reference", &truth, FIRST)] {
        let names = tracked.read.always::<Names>(&format!("/world/{name}"), AnnotationContext::descriptor_context());
        let class = &names[0].0[0].class_description;
        let labels = class.keypoint_annotations.iter().map(|point| point.label.as_ref().unwrap().as_str());
        let labels: Vec<&str> = labels.collect();
        assert_eq!(labels, joints.names);

        let entity = format!("/world/{name}/joints");
        let rows = tracked.read.rows::<Position3D>(&entity, Points3D::descriptor_positions(), "frame");
        assert_eq!(rows.iter().map(|(at, _)| *at).collect::<Vec<_>>(), (FIRST..FRAMES).map(frame).collect::<Vec<_>>());
        let times = tracked.read.rows::<Position3D>(&entity, Points3D::descriptor_positions(), "time");
        for ((_, row), (time, _)) in rows.iter().zip(&times) {
            assert_eq!(row.len(), labels.len());
            assert_eq!(time.unwrap() % 40_000_000, 0, "25 frames a second");
        }
        assert_eq!(times[0].0, Some(FIRST as i64 * 40_000_000));
        for (at, (_, row)) in rows.iter().enumerate() {
            for (label, position) in labels.iter().zip(row) {
                let Some(column) = file.column(label) else { panic!("{label} is not in the file of {name}") };
                let expected = file.frames[first + at][column].unwrap();
                let found = DVec3::from_array(position.0.0.map(f64::from)) * 1e3;
                assert!(found.distance(expected) < 2e-3, "{name} {label}: {found} mm, {expected} in the file");
            }
        }
    }
}

#[test]
fn a_pinhole_draws_as_its_camera_without_distortion() {
    let Tracked { sequence, read, .. } = tracked();
    for camera in &sequence.cameras {
        let entity = format!("/world/cameras/{}", camera.name);
        let resolution = read.always::<Resolution>(&entity, Pinhole::descriptor_resolution())[0];
        assert_eq!(resolution.0.0, camera.size.map(|side| side as f32));
        let matrix = |columns: [f32; 9]| DMat3::from_cols_array(&columns.map(f64::from));
        let image = matrix(read.always::<PinholeProjection>(&entity, Pinhole::descriptor_image_from_camera())[0].0.0);
        let turn = matrix(read.always::<TransformMat3x3>(&entity, Transform3D::descriptor_mat3x3())[0].0.0);
        let centre = read.always::<Translation3D>(&entity, Transform3D::descriptor_translation())[0].0.0;
        let centre = DVec3::from_array(centre.map(f64::from));
        for point in [DVec3::new(0.0, 0.0, 900.0), DVec3::new(-400.0, 300.0, 1700.0)] {
            let seen = image * (turn.transpose() * (point * 1e-3 - centre));
            let at = camera.camera_from_world.transform_point3(point);
            let expected = camera.lens.to_pixel(at.truncate() / at.z) + 0.5;
            assert!(at.z > 0.0 && (seen.truncate() / seen.z).distance(expected) < 0.01, "{}: {seen}", camera.name);
        }
    }
}

#[test]
fn pictures_are_those_of_the_folder() {
    let Tracked { sequence, read, folder, .. } = tracked();
    for camera in &sequence.cameras {
        let entity = format!("/world/cameras/{}/overlay", camera.name);
        let rows = read.rows::<Blob>(&entity, EncodedImage::descriptor_blob(), "frame");
        assert_eq!(rows.iter().map(|(at, _)| *at).collect::<Vec<_>>(), [3, 6].map(frame), "every {DRAWN} frames");
        for (at, row) in rows {
            let name = format!("result/overlay/{}_{:06}.png", camera.name, at.unwrap());
            let bytes: &[u8] = &row[0].0.0;
            assert!(bytes == fs::read(folder.path().join(name)).unwrap());
            let picture = image::load_from_memory(bytes).unwrap();
            assert_eq!([picture.width(), picture.height()], camera.size);
        }
    }
}

#[test]
fn curves_stages_and_texts_are_the_report_s() {
    let tracked = tracked();
    let Tracked { sequence, summary, read, .. } = tracked;
    let error = summary.error.as_ref().unwrap();
    let name = "/plots/error/mean\\ over\\ the\\ joints";
    let expected = error.error.frames.iter().map(|at| (frame(at.frame), at.mean.unwrap()));
    assert_eq!(tracked.scalars(name), expected.collect::<Vec<_>>());
    let shown = read.always::<Name>(name, SeriesLines::descriptor_names());
    assert_eq!(shown[0].as_str(), "mean over the joints");
    let fitness = summary.frames.iter().map(|result| (frame(result.frame), f64::from(result.fitness)));
    assert_eq!(tracked.scalars("/plots/fitness/fitness"), fitness.collect::<Vec<_>>());
    let confidences = tracked.scalars("/plots/fitness/confidence");
    let mean = confidences.iter().map(|(_, value)| value).sum::<f64>() / confidences.len() as f64;
    assert!((mean - summary.mean_confidence).abs() < 1e-12, "{mean}");

    for stage in summary.timings.iter().filter(|stage| stage.count > 0) {
        let entity = format!("/plots/stages/{}", stage.name.replace(' ', "\\ "));
        let values = read.always::<TensorData>(&entity, BarChart::descriptor_values());
        let TensorBuffer::F64(values) = &values[0].0.buffer else { panic!("{entity}: {values:?}") };
        assert_eq!(values.to_vec(), [stage.total / stage.count as f64], "{entity}");
    }
    let text = |name: &str| {
        let rows = read.always::<Text>(&format!("/report/{name}"), TextDocument::descriptor_text());
        rows[0].as_str().replace('\\', "")
    };
    let told = text("summary");
    for part in
        [&format!("# {}", sequence.name), &format!("{:.1} mm", error.error.mean), "| left_wrist |", "| search |"]
    {
        assert!(told.contains(part), "{part} is not in {told}");
    }
    assert!(text("settings").contains("| particles | 120 |"), "{}", text("settings"));
}

fn pantin(arguments: &[&str], sequence: &Path, output: &Path) -> Output {
    let mut command = program();
    command.arg("track").arg(sequence).arg("-o").arg(output);
    command.args(["--particles", "40", "--iterations", "3", "--backend", "cpu"]).args(arguments).output().unwrap()
}

#[test]
fn the_program_records_when_asked_and_says_why_it_cannot() {
    let folder = tempfile::tempdir().unwrap();
    let sequence = tracked().folder.path().join("sequence");
    let output = folder.path().join("result");
    let recording = output.join("report.rrd");
    let few = ["--frames", "0..2", "--overlay-every", "1"];
    let run = |more: &[&str]| pantin(&[&few, more].concat(), &sequence, &output);

    let done = run(&[]);
    assert!(done.status.success() && !recording.exists(), "{}", stderr(&done));
    // A finished run gets its recording later.
    let done = run(&["--resume", "--rerun"]);
    let told = stdout(&done);
    assert!(done.status.success() && told.contains(&format!("rerun {}", recording.display())), "{told}");
    assert_eq!(
        Read::file(&recording)
            .rows::<Blob>("/world/cameras/cam1/overlay", EncodedImage::descriptor_blob(), "frame")
            .len(),
        2
    );
    let done = run(&["--force"]);
    assert!(done.status.success() && !recording.exists(), "a new run's folder holds nothing of an old one");

    refused(&run(&["--force", "--realtime", "--rerun"]), &["a run in real time writes no report"]);
    fs::create_dir(&recording).unwrap();
    refused(&run(&["--resume", "--rerun"]), &["report.rrd is a folder", "expected a regular file"]);
    fs::remove_dir(&recording).unwrap();
    assert!(output.join("report.html").exists(), "the rest is there");
}

/// A limit on the size of files stands for a full disk: writes past it fail.
#[cfg(unix)]
#[test]
fn no_room_is_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let sequence = tracked().folder.path().join("sequence");
    let output = folder.path().join("result");
    let few = ["--frames", "0..6", "--overlay-every", "1"];
    let done = pantin(&[&few[..], &["--rerun"]].concat(), &sequence, &output);
    succeeded(&done);
    let size = |name: &str| fs::metadata(output.join(name)).unwrap().len();
    let (recording, page) = (size("report.rrd"), size("report.html"));
    // Room for the page and not for the recording, which has no stage times this time.
    let room = recording.midpoint(page);
    assert!(page + 8192 < room, "the recording has {recording} bytes, the page {page}");
    fs::remove_file(output.join("report.rrd")).unwrap();
    let program = format!("trap '' XFSZ; ulimit -f {}; exec \"$0\" \"$@\"", room / 1024);
    let mut shell = Command::new("bash");
    shell.args(["-c", &program, env!("CARGO_BIN_EXE_pantin"), "track"]).arg(&sequence).arg("-o").arg(&output);
    shell.args(["--particles", "40", "--iterations", "3", "--backend", "cpu", "--resume", "--rerun"]).args(few);
    let full = shell.output().unwrap();
    let sentence = format!("cannot write {}: File too large", output.join("report.rrd").display());
    refused(&full, &[&sentence]);
    let left = fs::read_dir(&output)
        .unwrap()
        .filter(|entry| entry.as_ref().unwrap().file_name().to_string_lossy().starts_with("report.rrd"));
    assert_eq!(left.count(), 0, "no half file is left");
}
