use glam::DVec3;

use super::*;
use crate::geometry::Lens;

/// A camera two metres above the origin, looking down, its picture's right along the world's x.
pub(super) const ONE: &str = r#"<?xml version='1.0' encoding='ASCII'?>
<calibration type="regular">
  <cameras>
    <camera active="1" serial="21001" viewrotation="0">
      <fov_video bottom="1079" left="0" right="1919" top="0"/>
      <transform r11="1.0" r12="0.0" r13="0.0" r21="0.0" r22="1.0" r23="0.0" r31="0.0" r32="0.0" r33="1.0" x="0.0" y="0.0" z="2000.0"/>
      <intrinsic centerPointU="61376.0" centerPointV="34528.0" focalLengthU="64000.0" focalLengthV="64640.0" radialDistortion1="-0.05" radialDistortion2="0.1" radialDistortion3="0.01" skew="0.0" tangentalDistortion1="0.001" tangentalDistortion2="0.002"/>
    </camera>
    <camera active="0" serial="21002"/>
  </cameras>
</calibration>
"#;

#[test]
fn a_camera_reads_in_pixels_and_millimetres() {
    let cameras = parse_qualisys(ONE, "c.qca.txt").unwrap();
    assert_eq!(cameras.len(), 1, "the inactive one is left out");
    let camera = &cameras[0];
    assert_eq!((camera.name.as_str(), camera.size), ("21001", [1920, 1080]));
    let Lens::BrownConrady(lens) = camera.lens else { panic!("{:?}", camera.lens) };
    assert_eq!((lens.focal.to_array(), lens.centre.to_array()), ([1000.0, 1010.0], [959.0, 539.5]));
    assert_eq!((lens.radial, lens.tangential), ([-0.05, 0.1, 0.01], [0.001, 0.002]));
    assert_eq!(camera.centre_in_world(), DVec3::new(0.0, 0.0, 2000.0));
    let origin = camera.project(DVec3::ZERO).unwrap();
    assert_eq!(origin, lens.centre);
    let right = camera.project(DVec3::new(100.0, 0.0, 0.0)).unwrap();
    let up = camera.project(DVec3::new(0.0, 100.0, 0.0)).unwrap();
    assert!(right.x > origin.x + 45.0 && up.y < origin.y - 45.0, "{right} {up}");
    assert_eq!(camera.project(DVec3::new(0.0, 0.0, 3000.0)), None, "behind");
    // A cropped view counts its pixels from its own corner.
    let cropped = ONE.replace("left=\"0\"", "left=\"100\"").replace("top=\"0\"", "top=\"50\"");
    let camera = &parse_qualisys(&cropped, "c.qca.txt").unwrap()[0];
    assert_eq!(camera.size, [1820, 1030]);
    assert_eq!(camera.project(DVec3::ZERO).unwrap(), lens.centre - glam::DVec2::new(100.0, 50.0));
}

#[test]
fn every_bad_value_is_named() {
    let bad = |from: &str, to: &str, expected: &[&str]| refused(parse_qualisys, ONE, from, to, expected);
    bad("<calibration", "<kalibration", &["not XML"]);
    bad("</calibration>", "", &["not XML"]);
    bad(" serial=\"21001\"", "", &["line 4", "serial is missing"]);
    bad("viewrotation=\"0\"", "viewrotation=\"90\"", &["line 4", "camera `21001`", "viewrotation is 90"]);
    bad("fov_video", "fov_marker", &["the element `fov_video` is missing"]);
    bad("right=\"1919\"", "right=\"-1\"", &["size is [0, 1080]"]);
    bad("right=\"1919\"", "right=\"wide\"", &["right of `fov_video` is \"wide\", expected a finite number"]);
    bad("<transform", "<transfer", &["the element `transform` is missing"]);
    bad("<intrinsic", "<extrinsic", &["the element `intrinsic` is missing"]);
    bad("r22=\"1.0\"", "r22=\"-1.0\"", &["expected a rotation matrix"]);
    bad("r22=\"1.0\"", "r22=\"0.9\"", &["expected a rotation matrix"]);
    bad("r22=\"1.0\"", "r22=\"nan\"", &["r22 of `transform` is \"nan\""]);
    bad("r22=\"1.0\"", "", &["r22 is missing from `transform`"]);
    bad("z=\"2000.0\"", "z=\"2e8\"", &["would stand 200000 m from the origin"]);
    bad("z=\"2000.0\"", "z=\"2\"", &["2.0 mm from the origin", "wrong units"]);
    bad("focalLengthU=\"64000.0\"", "focalLengthU=\"0\"", &["focal lengths 0"]);
    bad("skew=\"0.0\"", "skew=\"3\"", &["expected [[fx, 0, cx]"]);
    bad("radialDistortion3=\"0.01\"", "", &["radialDistortion3 is missing"]);
    bad("active=\"1\"", "active=\"0\"", &["holds no camera"]);
    bad("active=\"0\" serial=\"21002\"", "serial=\"21002\"", &["camera `21002`", "fov_video"]);
    let again = ONE.split_once("    <camera active=\"1\"").unwrap().1.split_once("</camera>").unwrap().0;
    let again = format!("<camera active=\"1\"{again}</camera>\n  </cameras>");
    bad("</cameras>", &again, &["two cameras are named `21001`"]);
    let other = sentence(parse_qualisys("<opencv_storage/>", "c.qca.txt"));
    assert!(other.contains("root element `opencv_storage`, expected `calibration`"), "{other}");
}

#[test]
fn the_recorded_calibration_reads() {
    let Some(path) = beam("Calib_original.qca.txt", "the_recorded_calibration_reads") else { return };
    let cameras = read_cameras(&path).unwrap();
    assert_eq!(cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["cam01", "cam02", "cam03", "cam04"]);
    let first = &cameras[0];
    // From the recording's own conversion of this file.
    assert_eq!(first.size, [1088, 1920]);
    let Lens::BrownConrady(lens) = first.lens else { panic!("{:?}", first.lens) };
    assert!((lens.focal - glam::DVec2::new(1681.244873046875, 1681.075439453125)).length() < 1e-9);
    assert!((lens.centre - glam::DVec2::new(532.973694, 948.137390140625)).length() < 1e-6);
    assert_eq!((lens.radial, lens.tangential), ([-0.046183, 0.139983, 0.0], [0.000608, 0.00069]));
    assert!((first.camera_from_world.translation - DVec3::new(321.10489, 956.33206, 2890.71305)).length() < 1e-6);
    assert!((first.camera_from_world.matrix3.row(1) - DVec3::new(0.43453, -0.059465, -0.898692)).length() < 1e-5);
    for camera in &cameras {
        let belly = camera.project(DVec3::new(-1000.0, -20.0, 1000.0)).unwrap();
        assert!((0.0..1088.0).contains(&belly.x) && (0.0..1920.0).contains(&belly.y), "{} {belly}", camera.name);
    }
}
