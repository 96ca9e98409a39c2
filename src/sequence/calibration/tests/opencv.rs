use glam::{DVec2, DVec3};

use super::*;
use crate::geometry::Lens;

/// As OpenCV's calibration sample writes it, with a pose added.
pub(super) const YAML: &str = "%YAML:1.0
---
calibration_time: \"Tue 04 Mar 2014 10:00:00\"
image_width: 1280
image_height: 720
units: mm
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1.0e+03, 0., 6.4e+02, 0., 1010., 360.5,
       0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -.2, 5.e-02, 1e-3, 0., 0. ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 0., -1., 0., 1., 0. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ 10., 20., 3000. ]
";

pub(super) const XML: &str = r#"<?xml version="1.0"?>
<opencv_storage>
<calibration_time>"Tue 04 Mar 2014"</calibration_time>
<imageSize>
  1280 720</imageSize>
<units>mm</units>
<cameraMatrix type_id="opencv-matrix">
  <rows>3</rows>
  <cols>3</cols>
  <dt>d</dt>
  <data>
    1.0e+03 0. 6.4e+02 0. 1010. 360.5
    0. 0. 1.</data></cameraMatrix>
<distCoeffs type_id="opencv-matrix">
  <rows>1</rows>
  <cols>5</cols>
  <dt>d</dt>
  <data>
    -.2 5.e-02 1e-3 0. 0.</data></distCoeffs>
<rvec type_id="opencv-matrix">
  <rows>3</rows>
  <cols>1</cols>
  <dt>d</dt>
  <data>
    1.5707963267948966 0. 0.</data></rvec>
<tvec type_id="opencv-matrix">
  <rows>3</rows>
  <cols>1</cols>
  <dt>d</dt>
  <data>
    10. 20. 3000.</data></tvec>
</opencv_storage>
"#;

fn is_the_camera(camera: &Camera) {
    assert_eq!(camera.size, [1280, 720]);
    let Lens::BrownConrady(lens) = camera.lens else { panic!("{:?}", camera.lens) };
    assert_eq!((lens.focal, lens.centre), (DVec2::new(1000.0, 1010.0), DVec2::new(640.0, 360.5)));
    assert_eq!((lens.radial, lens.tangential), ([-0.2, 0.05, 0.0], [0.001, 0.0]));
    // z up in the world is up in the picture.
    let (low, high) = (camera.project(DVec3::ZERO).unwrap(), camera.project(DVec3::Z * 100.0).unwrap());
    assert!(high.y < low.y - 30.0 && (high.x - low.x).abs() < 1.0, "{low} {high}");
    assert_eq!(camera.camera_from_world.translation, DVec3::new(10.0, 20.0, 3000.0));
}

#[test]
fn one_camera_a_file_reads() {
    for cameras in [parse_opencv_yaml(YAML, "a/left.yml").unwrap(), parse_opencv_xml(XML, "a/left.xml").unwrap()] {
        assert_eq!(cameras.len(), 1);
        assert_eq!(cameras[0].name, "left", "called by the file");
        is_the_camera(&cameras[0]);
    }
    // Metres where nothing is said; plain YAML as people write it by hand; a name of its own.
    let plain = "camera_name: back\nimage_size: [1280, 720]\nK: [[1000, 0, 640], [0, 1010, 360.5], [0, 0, 1]]\n\
                 D: [-0.2, 0.05, 0.001, 0]\nrvec: [1.5707963267948966, 0, 0]\ntvec: [0.01, 0.02, 3.0]\n";
    let cameras = parse_opencv_yaml(plain, "a/left.yaml").unwrap();
    assert_eq!(cameras[0].name, "back");
    is_the_camera(&cameras[0]);
}

#[test]
fn several_cameras_a_file_read() {
    let one = |ending: &str, x: f64| {
        format!(
            "K{ending}: [[1000, 0, 640], [0, 1010, 360.5], [0, 0, 1]]\nD{ending}: [0, 0, 0, 0]\n\
             R{ending}: [0, 0, 0]\nT{ending}: [{x}, 0, 3]\n"
        )
    };
    let text = format!("image_width: 1280\nimage_height: 720\n{}{}", one("1", 0.5), one("_side", 0.25));
    let cameras = parse_opencv_yaml(&text, "all.yml").unwrap();
    assert_eq!(cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["cam1", "side"]);
    assert_eq!(cameras[1].camera_from_world.translation, DVec3::new(250.0, 0.0, 3000.0));

    // A stereo pair: M1 D1 M2 D2 and what lies between; R1 and R2 only rectify.
    let pair = "size: [1280, 720]\nM1: [[1000, 0, 640], [0, 1010, 360], [0, 0, 1]]\nD1: [0, 0, 0, 0]\n\
                M2: [[900, 0, 640], [0, 910, 360], [0, 0, 1]]\nD2: [0, 0, 0, 0]\nR: [0, 0.1, 0]\nT: [-0.3, 0, 0]\n\
                R1: [0, 0.05, 0]\nR2: [0, -0.05, 0]\n";
    let cameras = parse_opencv_yaml(pair, "stereo.yml").unwrap();
    assert_eq!(cameras[0].camera_from_world, glam::DAffine3::IDENTITY);
    assert_eq!(cameras[1].camera_from_world.translation, DVec3::new(-300.0, 0.0, 0.0));
}

#[test]
fn every_bad_value_is_named() {
    let yaml = |from: &str, to: &str, expected: &[&str]| refused(parse_opencv_yaml, YAML, from, to, expected);
    yaml(
        "camera_matrix",
        "kamera_matrix",
        &["holds no camera", "camera_matrix, cameraMatrix, CameraMatrix, Camera_Matrix, K, M"],
    );
    yaml("distortion_coefficients", "distort", &["camera `calib`", "distortion_coefficients is missing"]);
    yaml("image_width", "image_wide", &["image_width and image_height are missing"]);
    yaml("1280", "0", &["size is [0, 720]"]);
    yaml("1280", "wide", &["image_width on line 4 is no row of numbers"]);
    yaml("R: !!", "S: !!", &["R is missing, expected one of the keys R, Rot, Rotation, rvec"]);
    yaml("T: !!", "S: !!", &["T is missing, expected one of the keys T, Translation, tvec"]);
    yaml("units: mm", "", &["camera `calib` would stand 3000 m", "add `units: \"mm\"`"]);
    yaml("units: mm", "units: inch", &["units is \"inch\", expected \"m\" or \"mm\""]);
    yaml("units: mm", "units: 3", &["expected \"m\" or \"mm\""]);
    yaml("3000.", "3.", &["mm from the origin", "wrong units"]);
    yaml("1.0e+03", ".Nan", &["matrix is [[NaN", "finite"]);
    yaml("1.0e+03", "-.Inf", &["matrix is [[-inf", "finite"]);
    yaml("1.0e+03", "abc", &["line 7", "camera_matrix is a matrix with a part missing"]);
    yaml("1.0e+03,", "", &["line 7", "camera_matrix holds 8 numbers, expected 3 rows of 3"]);
    yaml("rows: 3", "rows: 1e300", &["line 7", "whole numbers"]);
    yaml("-.2,", ".nan,", &["distortions is [NaN"]);
    yaml("data: [ 1., 0., 0., 0., 0., -1.", "data: [ 1., 0., 0., 0., 0., 1.", &["expected a rotation matrix"]);
    yaml("image_width: 1280", "image_width: 1280\nimage_width: 1280", &["line 5", "there already on line 4"]);
    yaml("image_width: 1280", "image_width: [1280", &["line", "not YAML"]);
    yaml("image_width: 1280", "fisheye_model: 1", &["line 4", "fisheye lenses are not supported"]);
    yaml("image_width: 1280", "distortion_model: equidistant", &["\"equidistant\", expected \"plumb_bob\""]);
    let bad = |text: &str| sentence(parse_opencv_yaml(text, "c.yml"));
    assert!(bad("- 1\n- 2\n").contains("expected `key: value` lines"));
    assert!(bad("a: 1\n---\nb: 2\n").contains("a second document"));
    assert!(bad("[1, 2]: 3\n").contains("structure as a key"));
    assert!(bad("%YAML:1.0").contains("no camera"));
    let missing = "size: [9, 9]\nK_a: [[9, 0, 4], [0, 9, 4], [0, 0, 1]]\nD_a: [0, 0, 0, 0]\nT_a: [0, 0, 1]\n";
    assert!(bad(missing).contains("camera `a`: R_a is missing"), "{}", bad(missing));

    let xml = |from: &str, to: &str, expected: &[&str]| refused(parse_opencv_xml, XML, from, to, expected);
    xml("</opencv_storage>", "", &["not XML"]);
    xml("<cols>3</cols>", "", &["line 7", "cameraMatrix is a matrix with a part missing"]);
    xml("<rows>3</rows>", "<rows>4</rows>", &["line 7", "expected 4 rows of 3"]);
    xml("1280 720", "1280", &["size holds 1 numbers"]);
    xml("<units>mm</units>", "", &["add `<units>mm</units>`"]);
    xml("1.5707963267948966", "nan", &["rotation is [NaN"]);
    xml("1.5707963267948966", "90", &["radians"]);
    let other = sentence(parse_opencv_xml("<calibration/>", "c.xml"));
    assert!(other.contains("root element `calibration`, expected `opencv_storage`"), "{other}");
}

#[test]
fn keys_of_other_programs_and_matrices_of_one_dimension_read() {
    let text = "image_Width: 1280\nimage_Height: 720\nCameraMatrix: [[1000, 0, 640], [0, 1010, 360.5], [0, 0, 1]]\n\
                DistCoeffs: [-0.2, 0.05, 0.001, 0]\nRotation: [[1, 0, 0], [0, 0, -1], [0, 1, 0]]\n\
                Translation: [0.01, 0.02, 3]\n";
    is_the_camera(&parse_opencv_yaml(text, "left.yml").unwrap()[0]);
    let vectors = text
        .replace("Rotation: [[1, 0, 0], [0, 0, -1], [0, 1, 0]]", "rotation_vectors: [[1.5707963267948966, 0, 0]]")
        .replace("Translation: ", "translation_vectors: !!opencv-nd-matrix\n   sizes: [3]\n   dt: d\n   data: ");
    is_the_camera(&parse_opencv_yaml(&vectors, "left.yml").unwrap()[0]);
    let xml =
        XML.replace("opencv-matrix\">\n  <rows>3</rows>\n  <cols>1</cols>", "opencv-nd-matrix\">\n  <sizes>3</sizes>");
    assert!(xml.contains("<sizes>"));
    is_the_camera(&parse_opencv_xml(&xml, "left.xml").unwrap()[0]);

    // The poses of a board in several pictures are no place of the camera.
    let several = vectors.replace("[[1.5707963267948966, 0, 0]]", "[[1, 0, 0], [0, 1, 0]]");
    let message = sentence(parse_opencv_yaml(&several, "left.yml"));
    assert!(message.contains("rotation_vectors on line 5 holds 2 vectors, expected one"), "{message}");
    let volume = vectors.replace("sizes: [3]", "sizes: [1, 1, 3]");
    assert!(sentence(parse_opencv_yaml(&volume, "left.yml")).contains("translation_vectors on line 6"));
}

/// EasyMocap's pair, whichever of the two is named; sizes come from the pictures.
#[test]
fn easymocaps_pair_reads() {
    let folder = tempfile::tempdir().unwrap();
    let matrix = |rows: usize, columns: usize, data: &str| {
        format!("!!opencv-matrix\n  rows: {rows}\n  cols: {columns}\n  dt: d\n  data: [{data}]\n")
    };
    let lenses = format!(
        "%YAML:1.0\n---\nnames:\n  - \"01\"\n  - \"02\"\nK_01: {k}dist_01: {d}K_02: {k}dist_02: {d}",
        k = matrix(3, 3, "1000., 0., 640., 0., 1010., 360.5, 0., 0., 1."),
        d = matrix(1, 5, "-0.2, 0.05, 0.001, 0., 0.")
    );
    let turn = matrix(3, 1, "1.5707963267948966, 0., 0.");
    let places = format!(
        "%YAML:1.0\n---\nnames:\n  - \"01\"\n  - \"02\"\nR_01: {turn}Rot_01: {rot}T_01: {at}Rot_02: {rot}T_02: {at}",
        rot = matrix(3, 3, "1., 0., 0., 0., 0., -1., 0., 1., 0."),
        at = matrix(3, 1, "0.01, 0.02, 3.")
    );
    fs::write(folder.path().join("intri.yml"), &lenses).unwrap();
    let alone = sentence(read_cameras(&folder.path().join("intri.yml")));
    assert!(alone.contains("intri.yml: camera `01`: R_01 is missing"), "{alone}");
    fs::write(folder.path().join("extri.yml"), places).unwrap();
    let unsized_ones = sentence(read_cameras(folder.path()));
    assert!(
        unsized_ones.contains("intri.yml with") && unsized_ones.contains("image_width and image_height are missing"),
        "{unsized_ones}"
    );
    let size = |_: &str| Ok(Some([1280, 720]));
    for path in [folder.path().join("intri.yml"), folder.path().join("extri.yml"), folder.path().to_path_buf()] {
        let cameras = read_cameras_sized(&path, &size).unwrap();
        assert_eq!(cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["01", "02"]);
        cameras.iter().for_each(is_the_camera);
    }
    // Stated sizes win.
    let stated = lenses.replace("K_02", "H_01: 480\nW_01: 640\nK_02");
    fs::write(folder.path().join("intri.yml"), stated).unwrap();
    assert_eq!(read_cameras_sized(folder.path(), &size).unwrap()[0].size, [640, 480]);
}

#[test]
fn a_folder_reads_file_by_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let none = sentence(read_cameras(folder.path()));
    assert!(none.contains("holds no calibration, expected files whose names end in one of .toml"), "{none}");
    fs::write(path("right.yml"), YAML).unwrap();
    fs::write(path("left.xml"), XML).unwrap();
    fs::write(path(".left.yml"), "hidden").unwrap();
    fs::write(path("notes.txt"), "not a calibration").unwrap();
    let cameras = read_cameras(folder.path()).unwrap();
    assert_eq!(cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["left", "right"]);
    cameras.iter().for_each(is_the_camera);
    fs::write(path("left.yml"), YAML).unwrap();
    let twice = sentence(read_cameras(folder.path()));
    assert!(twice.contains("two cameras are named `left`"), "{twice}");
    fs::write(path("left.yml"), "bad: [").unwrap();
    assert!(sentence(read_cameras(folder.path())).contains("left.yml"), "the file is named");
}
