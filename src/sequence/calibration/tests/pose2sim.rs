use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::files::Overwrite;
use crate::geometry::{BrownConrady, Lens, Tsai, TsaiConstants};

/// As Pose2Sim writes it, with a Tsai camera added.
pub(super) const TWO: &str = r#"
[right]
name = "right"
size = [ 1088.0, 1920.0,]
matrix = [ [ 1681.2, 0.0, 532.9,], [ 0.0, 1681.1, 948.1,], [ 0.0, 0.0, 1.0,],]
distortions = [ -0.046, 0.139, 0.0006, 0.0007,]
rotation = [ 1.68, 1.05, -0.43,]
translation = [ 0.353, 0.956, 2.885,]
fisheye = false

[back]
size = [1080, 1920]
model = "tsai"
tsai = { f = 9.27, kappa = -1e-4, cx = 529.5, cy = 945.4, sx = 1.0, ncx = 768, nfx = 1080, dx = 0.0078, dy = 0.0055, rx = 1.1, ry = -0.2, rz = 0.3, tx = 0.35, ty = 0.96, tz = 2.88 }

[metadata]
adjusted = false
error = 0.0
units = "m"
"#;

#[test]
fn both_lenses_read() {
    let cameras = parse_cameras_toml(TWO, "calib.toml").unwrap();
    assert_eq!(cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["right", "back"], "in the file's order");
    assert_eq!((cameras[0].size, cameras[1].size), ([1088, 1920], [1080, 1920]));
    assert_eq!(cameras[0].camera_from_world.translation, DVec3::new(0.353, 0.956, 2.885) * 1000.0);
    let lens = BrownConrady {
        focal: DVec2::new(1681.2, 1681.1),
        centre: DVec2::new(532.9, 948.1),
        radial: [-0.046, 0.139, 0.0],
        tangential: [0.0006, 0.0007],
    };
    assert_eq!(cameras[0].lens, Lens::BrownConrady(lens));
    let pitch = DVec2::new(0.0078 * (768.0 / 1080.0), 0.0055);
    let lens = Tsai { f: 9.27, kappa: -1e-4, centre: DVec2::new(529.5, 945.4), sx: 1.0, pitch };
    assert_eq!(cameras[1].lens, Lens::Tsai(lens));
    assert_eq!(cameras[1].camera_from_world.translation, DVec3::new(0.35, 0.96, 2.88) * 1000.0);
    // A fifth distortion is k3; without units metres are assumed.
    let five = TWO.replace("0.0007,]", "0.0007, 0.02]").replace("units = \"m\"", "");
    let Lens::BrownConrady(lens) = parse_cameras_toml(&five, "calib.toml").unwrap()[0].lens else { panic!() };
    assert_eq!(lens.radial, [-0.046, 0.139, 0.02]);
}

#[test]
fn every_bad_value_is_named() {
    let bad = |from: &str, to: &str, expected: &[&str]| refused(parse_cameras_toml, TWO, from, to, expected);
    bad("fisheye", "fishey", &["line 9", "`fishey`", "nearest known key is `fisheye`"]);
    bad("kappa", "kapa", &["line 14", "`kapa`", "nearest known key is `kappa`"]);
    bad("units", "unit", &["`unit`", "nearest known key is `units`"]);
    bad("[metadata]", "[metdata]", &["unknown key"]);
    bad("\"m\"", "\"cm\"", &["[metadata]", "units is \"cm\", expected \"m\" or \"mm\""]);
    bad("[right]", "right = 3\n[other]", &["line 2", "expected a camera's table"]);
    bad("name = \"right\"", "name = \"back\"", &["two cameras are named `back`"]);
    bad("name = \"right\"", "name = \"\"", &["camera name \"\""]);
    bad("name = \"right\"", "name = \"../right\"", &["without slashes"]);
    bad("name = \"right\"", "name = \"metadata\"", &["`metadata`", "another name"]);
    bad("1088.0, 1920.0,", "0, 1920", &["camera `right`", "size is [0, 1920]", "from 1 to 16384"]);
    bad("1088.0, 1920.0,", "1088.5, 1920", &["size is [1088.5, 1920]"]);
    bad("1088.0, 1920.0,", "1088, nan", &["size is [1088, NaN]"]);
    bad("1088.0, 1920.0,", "1088", &["line 4", "expected an array of length 2"]);
    bad("size = [ 1088.0, 1920.0,]", "", &["missing field `size`"]);
    bad("[ 0.0, 0.0, 1.0,],", "", &["line 5", "expected an array of length 3"]);
    bad("[ 0.0, 0.0, 1.0,]", "[0, 1]", &["line 5", "expected an array of length 3"]);
    bad("1681.2", "nan", &["camera `right`", "matrix is", "expected finite numbers"]);
    bad("1681.2", "inf", &["matrix is", "finite"]);
    bad("1681.2", "-1681.2", &["focal lengths -1681.2", "more than 0"]);
    bad("1681.2", "0", &["focal lengths 0"]);
    bad("1681.2, 0.0", "1681.2, 3.0", &["expected [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]"]);
    bad("532.9", "1e300", &["principal point"]);
    bad("1681.2", "\"wide\"", &["line 5", "string"]);
    bad("-0.046, 0.139, 0.0006, 0.0007,", "-0.046, 0.139", &["distortions holds 2 numbers", "k1, k2, p1, p2"]);
    bad("-0.046,", "nan,", &["distortions is [NaN"]);
    bad("0.0007,", "0.0007, 0, 1, 0, 0", &["terms after k3"]);
    bad("rotation = [ 1.68, 1.05, -0.43,]", "", &["camera `right`", "rotation is missing"]);
    bad("translation = [ 0.353, 0.956, 2.885,]", "", &["translation is missing"]);
    bad("1.68, 1.05", "nan, 1.05", &["rotation is [NaN"]);
    bad("1.68, 1.05", "95.0, 1.05", &["radians", "full turn"]);
    bad("1.68, 1.05", "1e200, 1.05", &["radians", "full turn"]);
    bad("1.68, 1.05,", "1.68,", &["line 7", "expected an array of length 3"]);
    bad("0.353,", "nan,", &["translation is [NaN", "finite"]);
    bad("0.353,", "353.0,", &["camera `right` would stand 353 m", "wrong units", "[metadata] units = \"mm\""]);
    bad("fisheye = false", "fisheye = true", &["camera `right`", "fisheye lenses are not supported"]);
    bad("model = \"tsai\"", "model = \"zhang\"", &["camera `back`", "\"zhang\"", "expected \"tsai\""]);
    bad("model = \"tsai\"", "", &["without model = \"tsai\""]);
    bad("model = \"tsai\"", "model = \"tsai\"\nrotation = [0, 0, 0]", &["rotation stands beside model"]);
    bad("f = 9.27", "f = 0", &["tsai.f is 0.0, expected a number more than 0"]);
    bad("dx = 0.0078", "dx = nan", &["tsai.dx is NaN"]);
    bad("kappa = -1e-4", "kappa = inf", &["tsai.kappa is inf"]);
    bad("rx = 1.1", "rx = 63.0", &["tsai.rx is 63.0, expected radians"]);
    bad("tz = 2.88", "tz = nan", &["tsai: translation is"]);
    bad("f = 9.27, ", "", &["missing field `f`"]);
    bad("[metadata]", "[metadata", &["line 16"]);
    let only_metadata = sentence(parse_cameras_toml("[metadata]\nunits = \"mm\"\n", "calib.toml"));
    assert!(only_metadata.contains("calib.toml: holds no camera"), "{only_metadata}");
    let millimetres = TWO.replace("units = \"m\"", "units = \"mm\"");
    let message = sentence(parse_cameras_toml(&millimetres, "calib.toml"));
    assert!(message.contains("3.1 mm from the origin") && message.contains("[metadata] units = \"m\""), "{message}");
    // One camera in its own origin is a world like any other.
    let alone = millimetres.split("[back]").next().unwrap().replace("0.353, 0.956, 2.885", "0, 0, 0");
    parse_cameras_toml(&format!("{alone}[metadata]\nunits = \"mm\""), "calib.toml").unwrap();
}

#[test]
fn the_recorded_cameras_need_their_unit() {
    let Some(path) = beam("cameras.toml", "the_recorded_cameras_need_their_unit") else { return };
    let text = fs::read_to_string(&path).unwrap();
    let stated = format!("{}\n[metadata]\nunits = \"mm\"\n", text.split("[metadata]").next().unwrap());
    let unstated = text.split("[metadata]").next().unwrap();
    let message = sentence(parse_cameras_toml(unstated, "cameras.toml"));
    assert!(message.contains("camera `cam01`") && message.contains("add `[metadata] units = \"mm\"`"), "{message}");

    let cameras = parse_cameras_toml(&stated, "cameras.toml").unwrap();
    assert_eq!(cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["cam01", "cam02", "cam03", "cam04"]);
    // The centre from the recording's own notes, and the middle of the walk well inside every picture.
    assert!((cameras[0].centre_in_world() - DVec3::new(1460.8275, -1908.3296, 1894.7596)).length() < 1e-3);
    for camera in &cameras {
        let [width, height] = camera.size.map(f64::from);
        let belly = camera.project(DVec3::new(-1000.0, -20.0, 1000.0)).unwrap();
        assert!((0.0..width).contains(&belly.x) && (0.0..height).contains(&belly.y), "{} {belly}", camera.name);
        let head = camera.project(DVec3::new(-1000.0, -20.0, 1600.0)).unwrap();
        assert!(head.y < belly.y - 100.0, "{}: up is up", camera.name);
    }
}

fn any_camera() -> impl Strategy<Value = Camera> {
    let lens = prop_oneof![
        (
            prop::array::uniform2(1.0..5000.0_f64),
            prop::array::uniform2(-100.0..5000.0_f64),
            prop::array::uniform5(-1.0..1.0_f64)
        )
            .prop_map(|(focal, centre, [k1, k2, k3, p1, p2])| Lens::BrownConrady(BrownConrady {
                focal: focal.into(),
                centre: centre.into(),
                radial: [k1, k2, k3],
                tangential: [p1, p2],
            })),
        (
            0.1..100.0_f64,
            -0.1..0.1_f64,
            prop::array::uniform2(-100.0..5000.0_f64),
            prop::array::uniform2(1e-4..0.1_f64)
        )
            .prop_map(|(f, kappa, centre, pitch)| Lens::Tsai(Tsai {
                f,
                kappa,
                centre: centre.into(),
                sx: 1.01,
                pitch: pitch.into(),
            })),
    ];
    let place = (prop::array::uniform3(-1.8..1.8_f64), prop::array::uniform3(100.0..9000.0_f64));
    (lens, place, 1..9000_u32, 1..9000_u32, "[a-zA-Z0-9 _.,\"'äß-]{1,12}").prop_map(
        |(lens, (r, t), width, height, name)| {
            Camera::from_rodrigues(&format!("c{name}"), [width, height], lens, r.into(), t.into())
        },
    )
}

proptest! {
    #[test]
    fn written_cameras_read_back(first in any_camera(), second in any_camera()) {
        prop_assume!(first.name != second.name);
        let cameras = [first, second];
        let back = parse_cameras_toml(&cameras_toml(&cameras), "cameras.toml").unwrap();
        prop_assert_eq!(back.len(), 2);
        for (mut back, camera) in back.into_iter().zip(&cameras) {
            let difference = back.camera_from_world.matrix3 - camera.camera_from_world.matrix3;
            let worst = difference.to_cols_array().into_iter().fold(0.0, |worst: f64, d| worst.max(d.abs()));
            prop_assert!(worst < 1e-13, "{worst}");
            back.camera_from_world.matrix3 = camera.camera_from_world.matrix3;
            prop_assert_eq!(&back, camera);
        }
    }
}

#[test]
fn a_camera_of_the_name_of_the_units_table_is_refused_by_its_name() {
    let mut cameras = parse_cameras_toml(TWO, "calib.toml").unwrap();
    cameras[0].name = "metadata".into();
    let message = sentence(parse_cameras_toml(&cameras_toml(&cameras), "cameras.toml"));
    assert!(message.contains("a camera is named `metadata`, expected another name"), "{message}");
}

#[test]
fn writing_keeps_to_the_rules_of_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cameras.toml");
    let cameras = parse_cameras_toml(TWO, "calib.toml").unwrap();
    write_cameras_toml(&path, &cameras, Overwrite::Refuse).unwrap();
    assert_eq!(read_cameras(&path).unwrap().len(), 2);
    let message = format!("{:#}", write_cameras_toml(&path, &cameras, Overwrite::Refuse).unwrap_err());
    assert!(message.contains("exists already"), "{message}");
    write_cameras_toml(&path, &cameras[..1], Overwrite::Replace).unwrap();
    assert_eq!(read_cameras(&path).unwrap().len(), 1);
    // What could not be read again is not written.
    let mut broken = cameras.clone();
    broken[0].camera_from_world.translation.x = f64::NAN;
    let doubled = [cameras[0].clone(), cameras[0].clone()];
    for (cameras, expected) in [(&broken[..], "cannot write"), (&[][..], "no camera"), (&doubled[..], "right")] {
        let message = format!("{:#}", write_cameras_toml(&path, cameras, Overwrite::Replace).unwrap_err());
        assert!(message.contains("cannot write") && message.contains(expected), "{message}");
    }
    assert_eq!(read_cameras(&path).unwrap().len(), 1, "the old file stays");
    assert!(TsaiConstants::of(&cameras[1]).is_some());
}
