use glam::{DVec2, DVec3};

use super::*;
use crate::geometry::Lens;

/// A video camera three metres before the origin at a height of one, looking along +y, between a marker camera and a video
/// camera that nobody calibrated.
pub(super) const XCP: &str = r#"<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<Cameras NAME="" VERSION="1.0">
  <Camera DEVICEID="2107" DISPLAY_TYPE="T40-S" SENSOR_SIZE="2336 1728" TYPE="DxCore41">
    <KeyFrames>
      <KeyFrame FOCAL_LENGTH="2600" ORIENTATION="0 0 0 1" POSITION="0 0 -4000" PRINCIPAL_POINT="1168 864" VICON_RADIAL="1e-08 0"/>
    </KeyFrames>
  </Camera>
  <Camera DEVICEID="2121041" DISPLAY_TYPE="Vue" PIXEL_ASPECT_RATIO="1" SENSOR_SIZE="1920 1080" SKEW="0" TYPE="VideoCamera">
    <ThresholdGrid BIT_DEPTH="1"/>
    <KeyFrames>
      <KeyFrame FOCAL_LENGTH="1600" FRAME="0" ORIENTATION="0.70710678118654752 0 0 0.70710678118654752" POSITION="0 -3000 1000" PRINCIPAL_POINT="966 552" VICON_RADIAL="3e-08 2e-15" VICON_RADIAL2="ViconRadial2 966 552 3e-08 2e-15 0" WORLD_ERROR="0.4"/>
    </KeyFrames>
  </Camera>
  <Camera DEVICEID="2121042" DISPLAY_TYPE="Vue" SENSOR_SIZE="1920 1080" TYPE="VideoCamera"><KeyFrames/></Camera>
</Cameras>
"#;

#[test]
fn the_calibrated_video_camera_reads() {
    let cameras = parse_vicon(XCP, "lab.xcp").unwrap();
    assert_eq!(cameras.len(), 1, "the marker camera and the one without a key frame are left out");
    let camera = &cameras[0];
    assert_eq!((camera.name.as_str(), camera.size), ("2121041", [1920, 1080]));
    assert!((camera.centre_in_world() - DVec3::new(0.0, -3000.0, 1000.0)).length() < 1e-9);
    let middle = camera.project(DVec3::new(0.0, 0.0, 1000.0)).unwrap();
    assert!((middle - DVec2::new(966.0, 552.0)).length() < 1e-9, "{middle}");
    // What stands to the right and above is right and above in the picture.
    let above = camera.project(DVec3::new(100.0, 0.0, 1200.0)).unwrap();
    assert!(above.x > middle.x + 50.0 && above.y < middle.y - 100.0, "{above}");
}

/// The file's polynomial, from distorted pixels to undistorted ones, gone through with a few points by hand.
#[test]
fn its_distortion_is_the_inverse_of_the_polynomial() {
    let moved = "VICON_RADIAL2=\"ViconRadial2 970.5 548.25 3e-08 2e-15 1e-21\"";
    let shifted = XCP.replace("VICON_RADIAL2=\"ViconRadial2 966 552 3e-08 2e-15 0\"", moved);
    let first_kind = XCP.replace("VICON_RADIAL2=\"ViconRadial2 966 552 3e-08 2e-15 0\"", "");
    let wide = XCP.replace("PIXEL_ASPECT_RATIO=\"1\"", "PIXEL_ASPECT_RATIO=\"1.25\"");
    for (text, centre, terms, aspect) in [
        (XCP, DVec2::new(966.0, 552.0), [3e-8, 2e-15, 0.0], 1.0),
        (&first_kind, DVec2::new(966.0, 552.0), [3e-8, 2e-15, 0.0], 1.0),
        (&shifted, DVec2::new(970.5, 548.25), [3e-8, 2e-15, 1e-21], 1.0),
        (&wide, DVec2::new(966.0, 552.0), [3e-8, 2e-15, 0.0], 1.25),
    ] {
        let camera = &parse_vicon(text, "lab.xcp").unwrap()[0];
        let Lens::BrownConrady(lens) = camera.lens else { panic!("{:?}", camera.lens) };
        for pixel in [[3.0, 5.0], [960.0, 1079.0], [1919.0, 0.0], [1400.0, 300.0]].map(DVec2::from_array) {
            let away = pixel - centre;
            let r2 = away.x * away.x + away.y * away.y * aspect * aspect;
            let undistorted = centre + away * (1.0 + terms[0] * r2 + terms[1] * r2 * r2 + terms[2] * r2 * r2 * r2);
            let ray = (undistorted - DVec2::new(966.0, 552.0)) / DVec2::new(1600.0, 1600.0 / aspect);
            let seen = lens.to_pixel(lens.distort(ray).unwrap());
            assert!((undistorted - pixel).length() > 0.3, "the lens does something");
            assert!((seen - pixel).length() < 0.05, "{pixel} is seen at {seen}");
        }
    }
}

#[test]
fn marker_cameras_serve_where_no_camera_films() {
    let markers = XCP.replace("Vue", "T10").replace("VideoCamera", "DxCore");
    let cameras = parse_vicon(&markers, "lab.xcp").unwrap();
    assert_eq!(cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["2107", "2121041"]);
    assert_eq!(cameras[0].size, [2336, 1728]);
}

#[test]
fn every_bad_value_is_named() {
    let bad = |from: &str, to: &str, expected: &[&str]| refused(parse_vicon, XCP, from, to, expected);
    bad("</Cameras>", "", &["not XML"]);
    bad("DEVICEID=\"2121041\"", "", &["line 8", "DEVICEID is missing"]);
    bad(
        "SENSOR_SIZE=\"1920 1080\"",
        "SENSOR_SIZE=\"1920\"",
        &["camera `2121041`", "SENSOR_SIZE", "expected 2 finite numbers"],
    );
    bad("SENSOR_SIZE=\"1920 1080\"", "SENSOR_SIZE=\"1920 0\"", &["size is [1920, 0]"]);
    bad("SKEW=\"0\"", "SKEW=\"2\"", &["matrix is [[1600.0, 2.0"]);
    bad("PIXEL_ASPECT_RATIO=\"1\"", "PIXEL_ASPECT_RATIO=\"0\"", &["PIXEL_ASPECT_RATIO is 0"]);
    bad("FOCAL_LENGTH=\"1600\"", "FOCAL_LENGTH=\"far\"", &["line 8", "FOCAL_LENGTH of `KeyFrame` is \"far\""]);
    bad("FOCAL_LENGTH=\"1600\"", "FOCAL_LENGTH=\"-1\"", &["focal lengths"]);
    bad("ORIENTATION=\"0.70710678118654752 0 0 0.7", "ORIENTATION=\"0.5 0 0 0.7", &["quaternion of length 1"]);
    bad("POSITION=\"0 -3000 1000\"", "POSITION=\"0 -3 1\"", &["wrong units"]);
    bad("POSITION=\"0 -3000 1000\"", "POSITION=\"0 nan 1\"", &["POSITION of `KeyFrame` is \"0 nan 1\""]);
    bad("ViconRadial2 966", "ViconRadial2", &["VICON_RADIAL2", "five finite numbers"]);
    bad("3e-08 2e-15 0\"", "1e-05 2e-15 0\"", &["is beyond k1, k2, k3, p1, p2 by"]);
    let key = XCP.find("<KeyFrame FOCAL_LENGTH=\"1600\"").unwrap();
    let frame = &XCP[key..key + XCP[key..].find("/>").unwrap() + 2];
    bad(frame, &frame.repeat(2), &["2 key frames, expected one: moving cameras"]);
    bad(frame, "", &["none of its video cameras is calibrated"]);
    let none = sentence(parse_vicon("<Cameras/>", "c.xcp"));
    assert!(none.contains("holds no camera"), "{none}");
    let other = sentence(parse_vicon("<calibration/>", "c.xcp"));
    assert!(other.contains("root element `calibration`, expected `Cameras`"), "{other}");
}
