//! .qca.txt: cameras that are read project without a number that is none.
#![no_main]

use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use pantin::sequence::parse_qualisys;

fuzz_target!(|text: &str| {
    for camera in parse_qualisys(text, "fuzz.qca.txt").into_iter().flatten() {
        if let Some(pixel) = camera.project(DVec3::new(10.0, 20.0, 30.0)) {
            assert!(pixel.is_finite());
        }
    }
});
