//! OpenCV FileStorage, YAML and XML: cameras that are read project without a number that is none.
#![no_main]

use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use pantin::sequence::{parse_opencv_xml, parse_opencv_yaml};

fuzz_target!(|text: &str| {
    let cameras = [parse_opencv_yaml(text, "fuzz.yml"), parse_opencv_xml(text, "fuzz.xml")];
    for camera in cameras.into_iter().flatten().flatten() {
        if let Some(pixel) = camera.project(DVec3::new(10.0, 20.0, 30.0)) {
            assert!(pixel.is_finite());
        }
    }
});
