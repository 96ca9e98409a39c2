//! Recordings of reports made by hand: gaps, strange names, what is missing.

use std::path::PathBuf;

use glam::{DVec2, DVec3};
use pantin::files::Overwrite;
use pantin::geometry::{BrownConrady, Camera, Lens};
use pantin::report::{
    Headline, JointError, Player, RecordedView, ReportData, Series, Skeleton, StageTime, write_recording,
};
use re_sdk_types::archetypes::{LineStrips3D, Points3D, Scalars, TextDocument};
use re_sdk_types::components::{KeypointId, LineStrip3D, Position3D, Scalar, Text};

use super::read_back::Read;

const EVIL: &str = "a/b \"c\" **d** | ../e\n$origin/** {}";

fn report(fps: f64) -> ReportData {
    let evil = || EVIL.to_string();
    let walker = Skeleton {
        name: evil(),
        names: vec![evil(), "knee".to_string(), "foot".to_string()],
        bones: vec![[0, 1], [1, 2], [2, 7]],
        frames: vec![
            vec![Some(DVec3::new(1000.0, -20.0, 900.0)), Some(DVec3::ZERO), Some(DVec3::new(0.0, 0.0, -500.0))],
            vec![None, Some(DVec3::ONE), Some(DVec3::NAN)],
            vec![None, None, Some(DVec3::splat(1e300))],
        ],
    };
    ReportData {
        title: evil(),
        subtitle: evil(),
        headlines: vec![Headline { value: evil(), label: evil() }],
        warnings: vec![evil()],
        first_frame: 7,
        errors_per_frame: vec![Series {
            name: "mean".to_string(),
            colour: [1, 2, 3],
            values: vec![Some(12.5), None, Some(f64::NAN), Some(-0.25)],
            is_band: true,
        }],
        fitness_per_frame: vec![Series { name: evil(), colour: [9, 9, 9], values: Vec::new(), is_band: false }],
        joint_errors: vec![JointError { name: evil(), mean: 1.0, deviation: f64::NAN, largest: 3.0 }],
        player: Some(Player { fps, skeletons: vec![walker], cameras: Vec::new() }),
        stages: vec![StageTime { name: evil(), ms: f64::INFINITY }],
        settings: vec![(evil(), evil())],
        ..ReportData::default()
    }
}

fn camera() -> Camera {
    let centre = DVec2::new(99.5, 49.5);
    let lens = BrownConrady { focal: DVec2::splat(500.0), centre, radial: [0.0; 3], tangential: [0.0; 2] };
    Camera::from_rodrigues(EVIL, [200, 100], Lens::BrownConrady(lens), DVec3::ZERO, DVec3::ZERO)
}

fn recorded(data: &ReportData, views: &[RecordedView]) -> Read {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.rrd");
    write_recording(&path, data, views, Overwrite::Refuse).unwrap();
    Read::file(&path)
}

#[test]
fn what_is_missing_is_left_out() {
    let read = recorded(&report(25.0), &[]);
    let skeleton = read.entities().into_iter().find_map(|entity| Some(entity.strip_suffix("/joints")?.to_string()));
    let skeleton = skeleton.unwrap();

    let joints = format!("{skeleton}/joints");
    let positions = read.rows::<Position3D>(&joints, Points3D::descriptor_positions(), "frame");
    let first = [[1.0, -0.02, 0.9], [0.0, 0.0, 0.0], [0.0, 0.0, -0.5]].map(Position3D::from).to_vec();
    let second = vec![Position3D::from([0.001, 0.001, 0.001])];
    assert_eq!(positions, [(Some(7), first), (Some(8), second), (Some(9), Vec::new())]);
    let numbers = read.rows::<KeypointId>(&joints, Points3D::descriptor_keypoint_ids(), "time");
    let numbers: Vec<(Option<i64>, Vec<u16>)> =
        numbers.into_iter().map(|(time, row)| (time, row.into_iter().map(|id| id.0.0).collect())).collect();
    let moments = [280_000_000, 320_000_000, 360_000_000].map(Some);
    assert_eq!(numbers, [(moments[0], vec![0, 1, 2]), (moments[1], vec![1]), (moments[2], vec![])]);

    let strips = read.rows::<LineStrip3D>(&format!("{skeleton}/bones"), LineStrips3D::descriptor_strips(), "frame");
    assert_eq!(strips.iter().map(|(_, row)| row.len()).collect::<Vec<_>>(), [2, 0, 0], "bones with both ends");
    assert_eq!(strips[0].1[1], LineStrip3D::from([[0.0_f32, 0.0, 0.0], [0.0, 0.0, -0.5]]));

    let error = read.rows::<Scalar>("/plots/error/mean", Scalars::descriptor_scalars(), "frame");
    let error: Vec<(Option<i64>, Vec<f64>)> =
        error.into_iter().map(|(frame, row)| (frame, row.into_iter().map(|value| value.0.0).collect())).collect();
    assert_eq!(error, [(Some(7), vec![12.5]), (Some(8), vec![]), (Some(9), vec![]), (Some(10), vec![-0.25])]);
}

#[test]
fn strange_names_stay_names() {
    let camera = camera();
    let read = recorded(&report(25.0), &[RecordedView { camera: &camera, pictures: Vec::new() }]);
    // Each such name is one step of a path, whatever it holds.
    let depths: Vec<usize> = ["/world/cameras/", "/plots/stages/"]
        .iter()
        .flat_map(|prefix| read.chunks.iter().filter(move |chunk| chunk.entity_path().to_string().starts_with(prefix)))
        .map(|chunk| chunk.entity_path().len())
        .collect();
    assert_eq!(depths, [3, 3]);
    let unescaped = read.chunks.iter().filter_map(|chunk| chunk.entity_path().last()).map(|part| part.unescaped_str());
    assert_eq!(unescaped.filter(|part| *part == EVIL).count(), 4, "camera, skeleton, curve, stage");
    let text = read.always::<Text>("/report/summary", TextDocument::descriptor_text());
    let text = text[0].as_str();
    assert!(text.contains(r"\*\*d\*\* \| \.\.\/e") && !text.contains(EVIL), "{text}");
}

#[test]
fn an_empty_report_and_one_without_a_rate_are_recordings() {
    let read = recorded(&ReportData::default(), &[]);
    assert_eq!(read.entities(), ["/__properties", "/report/settings", "/report/summary", "/world"]);
    for fps in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let read = recorded(&report(fps), &[]);
        let timelines = read.chunks.iter().flat_map(|chunk| chunk.timelines().keys());
        let timelines: Vec<String> = timelines.map(|name| name.to_string()).collect();
        assert!(!timelines.is_empty() && timelines.iter().all(|name| name == "frame"), "{fps}: {timelines:?}");
    }
    // Times past the end of the clock stay at its end.
    let slow = recorded(&report(1e-300), &[]);
    let rows = slow.rows::<Scalar>("/plots/error/mean", Scalars::descriptor_scalars(), "time");
    assert_eq!(rows[0].0, Some(i64::MAX));
}

#[test]
fn a_file_that_cannot_be_read_or_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.rrd");
    let camera = camera();
    let views = [RecordedView { camera: &camera, pictures: vec![(3, PathBuf::from("absent/cam_000003.png"))] }];
    let write = |overwrite| write_recording(&path, &report(25.0), &views, overwrite);
    let error = format!("{:#}", write(Overwrite::Refuse).unwrap_err());
    assert!(error.contains("cannot read absent/cam_000003.png: No such file"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "no half file is left");

    let nowhere = folder.path().join("absent/report.rrd");
    let error = format!("{:#}", write_recording(&nowhere, &report(25.0), &[], Overwrite::Refuse).unwrap_err());
    assert!(error.starts_with(&format!("cannot write {}: No such file", nowhere.display())), "{error}");

    write_recording(&path, &report(25.0), &[], Overwrite::Refuse).unwrap();
    let error = format!("{:#}", write_recording(&path, &report(25.0), &[], Overwrite::Refuse).unwrap_err());
    assert!(error.contains("report.rrd exists already"), "{error}");
}
